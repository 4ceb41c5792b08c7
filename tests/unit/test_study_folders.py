"""A study's folder: made, refused, filled, read; damaged parts; and its overview."""

import json
import os
import pickle
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from pyarrow import parquet

import rockflex as rf
from builders import frame_values
from rockflex import InputError
from rockflex.foundation import files
from rockflex.studies.folders import StudyFolder, _folder
from rockflex.studies.folders._parts import PartError, encode_part, part_at, part_of_content
from toy_study import SPEC, VERSIONS, ToyPlan, opened, run_study

PLAN = ToyPlan(n_chunks=4, rows=30)


@pytest.fixture
def done(tmp_path: Path) -> Path:
    run_study(str(tmp_path / "study"), PLAN)
    return tmp_path / "study"


def test_a_new_folder_says_what_it_is(tmp_path: Path) -> None:
    with opened(str(tmp_path / "deep" / "study"), PLAN) as folder:
        assert folder.missing() == [0, 1, 2, 3]
        assert not folder.finished
    manifest = json.loads((folder.path / "manifest.json").read_text())
    assert manifest["format"] == "rockflex-study-2"
    assert manifest["versions"] == VERSIONS
    assert manifest["checksums"] == {"record": "abc"}
    assert (manifest["seed"], manifest["n_chunks"]) == (7, 4)
    assert manifest["created"].endswith("+00:00")
    assert json.loads((folder.path / "spec.json").read_text()) == SPEC
    assert sorted(path.name for path in folder.path.iterdir()) == ["manifest.json", "parts", "spec.json"]


def test_the_table_comes_back_in_order_and_with_its_types(done: Path) -> None:
    folder = StudyFolder.load(done)
    assert folder.finished
    assert folder.spec == SPEC
    assert sorted(path.name for path in (done / "parts").iterdir()) == [f"part-0000{i}.parquet" for i in range(4)]
    pd.testing.assert_frame_equal(folder.frame(), PLAN.whole())
    assert folder.table().column_names == list(PLAN.whole())


def test_a_written_order_does_not_matter(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as folder:
        for number in (2, 0, 3, 1):
            path = folder.write(np.int64(number), PLAN.chunk(number))
            assert path == tmp_path / "parts" / f"part-0000{number}.parquet"
        pd.testing.assert_frame_equal(folder.frame(), PLAN.whole())


def test_pandas_polars_and_duckdb_read_the_parts(done: Path) -> None:
    files, whole = str(done / "parts" / "*.parquet"), PLAN.whole()
    pandas = pd.read_parquet(done / "parts")
    pd.testing.assert_frame_equal(pandas, whole)
    polars = pl.read_parquet(files)
    assert polars["max_rotation"].to_numpy().tobytes() == whole["max_rotation"].to_numpy().tobytes()
    assert polars["n_impacts"].null_count() == whole["n_impacts"].isna().sum()
    assert polars["status"].to_list() == [None if pd.isna(each) else each for each in whole["status"]]
    query = f"select status, count(*) n, sum(n_impacts) s from '{files}' group by status order by status nulls last"
    counted = whole.groupby("status", observed=True)["n_impacts"].agg(["size", "sum"])
    rows = duckdb.sql(query).fetchall()
    assert rows[:-1] == [(name, *map(int, counted.loc[name])) for name in counted.index]
    assert rows[-1] == (None, int(whole["status"].isna().sum()), None)


def test_an_index_of_pandas_and_a_plain_table_are_read_too(tmp_path: Path) -> None:
    with StudyFolder.open(tmp_path / "a", {}, 2, VERSIONS) as folder:
        for number in range(2):
            frame = pd.DataFrame({"x": [1.0, 2.0]}, index=pd.RangeIndex(2 * number, 2 * number + 2))
            folder.write(number, pa.Table.from_pandas(frame))
        pd.testing.assert_frame_equal(folder.frame(), pd.DataFrame({"x": [1.0, 2.0, 1.0, 2.0]}))
    with StudyFolder.open(tmp_path / "b", {}, 2, VERSIONS) as folder:
        folder.write(0, pa.table({"n": pa.array([1, None], pa.int32()), "f": pa.array([True, None])}))
        folder.write(1, pa.table({"n": pa.array([1, 2], pa.int32()), "f": pa.array([True, False])}))
        assert [str(kind) for kind in folder.frame().dtypes] == ["Int32", "boolean"]


def test_a_finished_study_computes_nothing_again(done: Path) -> None:
    assert run_study(str(done), PLAN) == []


def test_an_unfinished_study_is_partial(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as folder:
        with pytest.raises(InputError, match=r"4 of 4 parts of .* are missing. Run the study to its end\.$"):
            folder.table(partial=True)
        folder.write(2, PLAN.chunk(2))
        with pytest.raises(InputError, match=r"3 of 4 parts of .* are missing. .* by partial=True"):
            folder.table()
        pd.testing.assert_frame_equal(folder.frame(partial=True), PLAN.frame(2))
        assert folder.missing() == [0, 1, 3]


def test_another_spec_is_refused_with_what_differs(done: Path) -> None:
    spec = {"seed": 8, "structure": {"period": 1.25, "base": "stiff"}, "scales": [0.5, 1.0, 2.0]}
    with pytest.raises(InputError) as caught:
        StudyFolder.open(done, spec, 5, VERSIONS, {"record": "abc"})
    assert str(caught.value).splitlines()[1:-1] == [
        "  seed: 7 in the folder, 8 now",
        "  structure.period: 1.0 in the folder, 1.25 now",
        "  structure.stiffness_ratio: Infinity in the folder, not given now",
        '  structure.base: not in the folder, "stiff" now',
        "  scales: 2 entries in the folder, 3 now",
        "  number of chunks: 4 in the folder, 5 now",
    ]
    assert "holds another study" in str(caught.value)
    opened(str(done), PLAN).close()  # the refusal left no lock


def test_equal_numbers_are_no_difference(tmp_path: Path) -> None:
    spec = {"a": 1, "b": [2.0, float("nan")], "c": (True, None)}
    StudyFolder.open(tmp_path, spec, 1, VERSIONS).close()
    StudyFolder.open(tmp_path, {"c": [True, None], "a": 1.0, "b": (2, float("nan"))}, 1, VERSIONS).close()
    with pytest.raises(InputError, match=r"c\[0\]: true in the folder, 1 now"):
        StudyFolder.open(tmp_path, spec | {"c": [1, None]}, 1, VERSIONS)


def test_many_and_long_differences_are_cut(tmp_path: Path) -> None:
    StudyFolder.open(tmp_path, {"v": [0] * 30, "t": "x" * 100}, 1, VERSIONS).close()
    with pytest.raises(InputError) as caught:
        StudyFolder.open(tmp_path, {"v": [1] * 30, "t": "y"}, 1, VERSIONS)
    lines = str(caught.value).splitlines()
    assert lines[10:12] == ["  v[9]: 0 in the folder, 1 now", "  and 21 more"]


def test_other_records_are_refused(done: Path) -> None:
    with pytest.raises(InputError, match=r'with another record, .*\n  record: "abc" in the folder, "abd" now'):
        StudyFolder.open(done, SPEC, 4, VERSIONS, {"record": "abd"})


def test_other_versions_are_refused_unless_they_may_mix(done: Path) -> None:
    newer = VERSIONS | {"rockflex": "0.2.0"}
    with pytest.raises(InputError, match=r'rockflex: "0.1.0" in the folder, "0.2.0" now\n.*any_version=True'):
        StudyFolder.open(done, SPEC, 4, newer, {"record": "abc"})
    part = done / "parts" / "part-00001.parquet"
    part.unlink()
    with StudyFolder.open(done, SPEC, 4, newer, {"record": "abc"}, any_version=True) as folder:
        folder.write(1, PLAN.chunk(1))
    origin = pa.parquet.read_metadata(part).metadata
    assert json.loads(origin[b"rockflex.versions"]) == newer
    assert json.loads((done / "manifest.json").read_text())["versions"] == VERSIONS
    pd.testing.assert_frame_equal(StudyFolder.load(done).frame(), PLAN.whole())


def test_what_is_no_study_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.tex").write_text("x")
    with pytest.raises(InputError, match=r"file is a file\. Give a folder"):
        opened(str(tmp_path / "file"), PLAN)
    with pytest.raises(InputError, match=r"cannot be used: Not a directory"):
        opened(str(tmp_path / "file" / "below"), PLAN)
    with pytest.raises(InputError, match=r"is not a study, and not empty \('thesis.tex' is in it\)"):
        opened(str(tmp_path / "other"), PLAN)
    assert [path.name for path in (tmp_path / "other").iterdir()] == ["thesis.tex"]
    for name in ("other", "file", "nothing"):
        with pytest.raises(InputError, match=r"There is no study at .*: it has no manifest.json"):
            StudyFolder.load(tmp_path / name)


def test_a_folder_without_permission_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "mkdir", refuse)
    with pytest.raises(InputError, match=r"cannot be used: Permission denied\. Give a folder that you may write into"):
        opened(str(tmp_path / "study"), PLAN)


def nested(depth: int) -> list:
    value: list = []
    for _ in range(depth):
        value = [value]
    return value


ENDLESS: dict = {}
ENDLESS["itself"] = ENDLESS


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"spec": {"a": {"b": [1, np.float32(2)]}}}, r"spec\.a\.b\[1\] is of type float32, .* \.tolist\(\)"),
        ({"spec": {1: 2}}, r"keys of spec must be strings, but 1 was given"),
        ({"spec": [1]}, r"spec must be a mapping, but list was given"),
        ({"n_chunks": 0}, r"n_chunks must be a whole number of at least 1"),
        ({"n_chunks": 10**12}, r"n_chunks must be at most 100000, because each chunk is a file, but 1000000000000 was"),
        ({"spec": {"a": nested(5000)}}, r"^spec\.a\[0\]\[0\].*\[0\] is nested more than 50 deep, which no"),
        ({"spec": {"a": [ENDLESS]}}, r"is nested more than 50 deep"),
        ({"versions": None}, r"versions must be a mapping"),
        ({"checksums": {"a": {1}}}, r"checksums\.a is of type set"),
    ],
)
def test_bad_arguments_leave_nothing(tmp_path: Path, given: dict, message: str) -> None:
    arguments = {"spec": SPEC, "n_chunks": 2, "versions": VERSIONS} | given
    with pytest.raises(InputError, match=message):
        StudyFolder.open(tmp_path / "study", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_bad_chunks_are_refused(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as folder:
        with pytest.raises(InputError, match=r"number must be a whole number from 0 to 3, but 4 was given"):
            folder.write(4, PLAN.chunk(3))
        with pytest.raises(InputError, match=r"must be a pyarrow.Table, but DataFrame was given"):
            folder.write(0, PLAN.frame(0))
        folder.write(1, PLAN.chunk(1))
        other = PLAN.chunk(0)
        retyped = other.set_column(0, "structure", other["structure"].cast(pa.int64()))
        retyped = retyped.append_column("y", other["error"])
        with pytest.raises(InputError) as caught:
            folder.write(0, retyped.drop_columns(["error"]))
        lines = str(caught.value).splitlines()
        assert lines[0] == f"Chunk 0 has other columns than {tmp_path / 'parts' / 'part-00001.parquet'}:"
        assert lines[1:4] == ["  structure: int32, int64", "  error: large_string, None", "  y: None, large_string"]
        with pytest.raises(InputError, match="the order of the columns"):
            folder.write(0, other.select(list(reversed(other.column_names))))
        assert folder.missing() == [0, 2, 3]
        folder.write(1, retyped)  # the only part may be replaced
    with pytest.raises(InputError, match="was opened for reading"):
        StudyFolder.load(tmp_path).write(0, other)


def test_a_part_made_elsewhere_is_the_same_file(tmp_path: Path) -> None:
    with opened(str(tmp_path / "one"), PLAN) as folder, opened(str(tmp_path / "other"), PLAN) as other:
        maker = pickle.loads(pickle.dumps(folder.maker))  # as on its way to a worker
        part = maker.make(2, PLAN.chunk(2))
        assert (part.number, part.rows) == (2, 30)
        assert folder.add(part).read_bytes() == other.write(2, PLAN.chunk(2)).read_bytes() == part.content


def test_parts_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as folder:
        part = folder.maker.make(0, PLAN.chunk(0))
        for wrong, message in (
            (replace(part, number=1), r"Chunk 1 cannot be stored in .*: it holds chunk 0\. Make it by the maker"),
            (replace(part, number=9), "number must be a whole number from 0 to 3, but 9 was given"),
            (replace(part, content=part.content[:-9]), r"Chunk 0 cannot be stored in .*: it is no whole Parquet file"),
            (replace(folder.maker, study="x").make(0, PLAN.chunk(0)), "it belongs to another study"),
        ):
            with pytest.raises(InputError, match=message):
                folder.add(wrong)
        assert folder.missing() == [0, 1, 2, 3]


def test_the_columns_to_compare_with_are_looked_for_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = ToyPlan(n_chunks=40, rows=2)
    run_study(str(tmp_path), plan)
    (tmp_path / "parts" / "part-00000.parquet").unlink()
    seen: list[int] = []
    real = _folder.part_at
    with opened(str(tmp_path), plan) as folder:
        monkeypatch.setattr(_folder, "part_at", lambda path, *rest: seen.append(rest[1]) or real(path, *rest))
        for number in (0, 7, 8, 7):
            folder.write(number, plan.chunk(number))
    assert seen == [1]


def test_changed_files_are_seen(done: Path) -> None:
    spec, manifest = done / "spec.json", done / "manifest.json"
    kept = spec.read_text(), manifest.read_text()
    spec.write_text(kept[0].replace("1.0", "2.0"))
    with pytest.raises(InputError, match=r"spec.json was changed after the study started\. Undo"):
        StudyFolder.load(done)
    spec.write_text(kept[0][:-5])
    with pytest.raises(InputError, match=r"spec.json beside it is damaged \(JSONDecodeError"):
        StudyFolder.load(done)
    spec.write_text(kept[0])
    for content in ("", "[]", "{}", '{"format": "rockflex-study-2"}', kept[1][:50]):
        manifest.write_text(content)
        with pytest.raises(InputError, match=r"damaged \(.*Restore both from a copy"):
            StudyFolder.load(done)
    for count in ("0", "1e9", "4000000000", '"4"'):
        manifest.write_text(kept[1].replace('"n_chunks": 4', f'"n_chunks": {count}'))
        with pytest.raises(InputError, match=r"damaged \(InputError: n_chunks must be .*Restore both from a copy"):
            StudyFolder.load(done)
    manifest.write_text(kept[1])
    for depth in (60, 900, 5000, 10**6):
        spec.write_text(f'{{"a": {"[" * depth}{"]" * depth}}}')
        for attempt in (StudyFolder.load, lambda path: opened(str(path), PLAN)):
            with pytest.raises(InputError, match=r"damaged \((RecursionError|InputError: .* list that holds itself)"):
                attempt(done)
    spec.write_text(kept[0])
    manifest.write_text(kept[1].replace("study-2", "study-9"))
    with pytest.raises(InputError, match=r"has the format 'rockflex-study-9', but .* reads 'rockflex-study-2'"):
        opened(str(done), PLAN)
    # A folder from before the runs had total displacements: refused whole, and nothing of it is touched.
    manifest.write_text(kept[1].replace("study-2", "study-1"))
    before = {path: path.read_bytes() for path in (done / "parts").iterdir()}
    for attempt in (StudyFolder.load, lambda path: opened(str(path), PLAN)):
        with pytest.raises(InputError) as refused:
            attempt(done)
        assert str(refused.value) == (
            f"{manifest} has the format 'rockflex-study-1', but this version of rockflex reads 'rockflex-study-2'. Use "
            "the version that wrote it, or run the study again in another folder; the results in "
            f"{done / 'parts'} can still be read as Parquet."
        )
    assert {path: path.read_bytes() for path in (done / "parts").iterdir()} == before
    manifest.write_text(kept[1])
    (done / "parts" / "part-00004.parquet").write_bytes(b"")
    for attempt in (StudyFolder.load, lambda path: opened(str(path), PLAN)):
        with pytest.raises(InputError, match=r"not parts of the study:\n  part-00004.parquet\nMove them"):
            attempt(done)


def test_what_a_kill_left_is_swept(done: Path) -> None:
    (done / "parts" / ".part-00002.parquet.12-abc").write_bytes(b"half")
    (done / ".spec.json.12-abc").write_bytes(b"half")
    (done / "manifest.json").unlink()  # killed before the folder became a study
    opened(str(done), PLAN).close()
    assert list(done.rglob(".*")) == []
    assert StudyFolder.load(done).finished


def test_a_full_disk_leaves_nothing_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with opened(str(tmp_path), PLAN) as folder:
        folder.write(0, PLAN.chunk(0))

        def full(_: int) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(files.os, "fsync", full)
        with pytest.raises(InputError, match=r"No room on the disk of .*: 0\.\d+ MB .* MB are free \(No space left on"):
            folder.write(1, PLAN.chunk(1))
        monkeypatch.undo()
        assert [path.name for path in (tmp_path / "parts").iterdir()] == ["part-00000.parquet"]
        assert folder.missing() == [1, 2, 3]


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="limits of resources are of POSIX")
def test_a_limit_on_the_size_of_files_is_met_like_a_full_disk(tmp_path: Path) -> None:
    program = (
        "import resource, sys; from toy_study import *\n"
        "with opened(sys.argv[1], ToyPlan(4)) as folder:\n"
        "    folder.write(0, ToyPlan(4).chunk(0))\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))\n"
        "    folder.write(1, ToyPlan(4, rows=3000).chunk(1))\n"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path)], capture_output=True, text=True, env=environment, check=False
    )
    assert "InputError: No room on the disk" in done.stderr
    assert "(File too large). The parts already written are kept." in done.stderr
    assert [path.name for path in (tmp_path / "parts").iterdir()] == ["part-00000.parquet"]
    assert sorted(run_study(str(tmp_path), replace(PLAN, rows=50))) == [1, 2, 3]


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def empty(path: Path) -> None:
    path.write_bytes(b"")


def zeros(path: Path) -> None:
    path.write_bytes(bytes(path.stat().st_size))


def flip(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[500] ^= 1
    path.write_bytes(content)


def plain(path: Path) -> None:
    parquet.write_table(PLAN.chunk(1), path)


def swapped(path: Path) -> None:
    shutil.copy(path.with_name("part-00002.parquet"), path)


def of_another_study(path: Path) -> None:
    path.write_bytes(encode_part(PLAN.chunk(1), "0" * 32, 1, VERSIONS))


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (cut, r"no whole Parquet file, but \d+ bytes"),
        (empty, "no whole Parquet file, but 0 bytes"),
        (zeros, "no whole Parquet file"),
        (flip, "its bytes do not agree with their checksum"),
        (plain, "carries no checksum, so that no study wrote it"),
        (swapped, "it holds chunk 2"),
        (of_another_study, "it belongs to another study"),
    ],
)
def test_a_damaged_part_is_named_and_computed_anew(done: Path, damage, reason: str) -> None:
    path = done / "parts" / "part-00001.parquet"
    before = {each.name: each.stat().st_mtime_ns for each in path.parent.iterdir()}
    damage(path)
    study = StudyFolder.load(done)
    (found,) = study.damaged()
    assert (found.number, found.path) == (1, path)
    assert str(found).startswith(f"{path}: it")
    with pytest.raises(InputError, match=rf"part-00001.parquet is damaged: .*{reason}.*Run the study again"):
        study.table(partial=True)
    assert study.missing() == [1]
    assert run_study(str(done), PLAN) == [1]
    assert study.damaged() == []
    pd.testing.assert_frame_equal(study.frame(), PLAN.whole())
    after = {each.name: each.stat().st_mtime_ns for each in path.parent.iterdir()}
    assert [name for name in before if before[name] != after[name]] == [path.name]


def test_every_flipped_bit_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "part"
    content = encode_part(ToyPlan(rows=3).chunk(0), "s", 0, VERSIONS)
    path.write_bytes(content)
    part_at(path, "s", 0)
    for place in np.random.default_rng(1).integers(0, 8 * len(content), 1000):
        damaged = bytearray(content)
        damaged[place // 8] ^= 1 << (place % 8)
        path.write_bytes(damaged)
        with pytest.raises(PartError):
            part_at(path, "s", 0)


def test_every_cut_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "part"
    content = encode_part(ToyPlan(rows=3).chunk(0), "s", 0, VERSIONS)
    for length in range(0, len(content), 7):
        for padding in (b"", bytes(len(content) - length)):
            path.write_bytes(content[:length] + padding)
            with pytest.raises(PartError):
                part_at(path, "s", 0)


def test_data_that_look_like_the_checksum_do_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "part"
    table = pa.table({"rockflex-crc32:00000000": ["rockflex-crc32:00000000"] * 3})
    path.write_bytes(encode_part(table, "s", 0, {"a": "rockflex-crc32:00000000"}))
    assert part_at(path, "s", 0).read().equals(table)


def test_an_empty_chunk_keeps_its_columns(tmp_path: Path) -> None:
    with opened(str(tmp_path), ToyPlan(n_chunks=2)) as study:
        study.write(0, PLAN.chunk(0).slice(0, 0))
        study.write(1, PLAN.chunk(1))
        pd.testing.assert_frame_equal(study.frame(), PLAN.frame(1))


def test_parts_with_other_columns_are_refused_on_reading(done: Path) -> None:
    study = StudyFolder.load(done)
    content = encode_part(PLAN.chunk(1).drop_columns(["error"]), study.manifest.study, 1, VERSIONS)
    (done / "parts" / "part-00001.parquet").write_bytes(content)
    assert "error" not in part_of_content(content, study.manifest.study, 1).schema_arrow.names
    message = r"part-00001.parquet and the first part have other columns:\n  error: large_string, None\nAll chunks"
    with pytest.raises(InputError, match=message):
        study.table()


def test_categories_of_the_parts_are_joined(tmp_path: Path) -> None:
    with StudyFolder.open(tmp_path, SPEC, 2, VERSIONS) as study:
        for number, names in enumerate((["b", "a"], ["c", "a"])):
            frame = pd.DataFrame({"motion": pd.Categorical([names[1], None, names[0]], categories=names)})
            study.write(number, pa.Table.from_pandas(frame))
        motion = study.frame()["motion"]
    assert motion.astype(object).where(motion.notna(), None).to_list() == ["a", None, "b", "a", None, "c"]
    assert motion.cat.categories.to_list() == ["b", "a", "c"]


STUDY = rf.CloudStudy(
    name="two <scales>",
    structures=[{"name": "A", "frame": frame_values(n_stories=3, stiffness_ratio=0.0, period=0.6, aspect_ratio=8.0)}],
    records={"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]},
    models=["2DOF-S", "5DOF-S"],  # the second has more modes than the structure: rows with errors
    scales=[0.5, 1.5],
    runs_per_chunk=5,
)


def rows_of(folder: rf.StudyFolder) -> dict[str, str]:
    """The lines of the overview by their headings."""
    head, *lines = repr(folder).splitlines()
    assert head == f"StudyFolder({str(folder.path)!r})"
    assert len(lines) < 24
    assert max(map(len, lines)) <= 100
    found = dict(line.strip().split("  ", 1) for line in lines)
    return {name: text.strip() for name, text in found.items()}


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    path = tmp_path_factory.mktemp("study")
    return rf.fill_study(STUDY, path), rf.run_study(STUDY)


def test_a_complete_study(complete):
    folder, table = complete
    rows = rows_of(folder)
    assert rows["study"] == "cloud, two <scales>"
    assert rows["state"] == "complete: all 4 parts"
    assert rows["rows"] == "16"
    counts = table["status"].value_counts()
    assert rows["status"] == ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in counts.items())
    assert rows["errors"] == "8 failed"
    assert rows["models"] == "2DOF-S, 5DOF-S"
    assert rows["structures"] == "A"
    assert rows["inputs"].startswith("4 with checksums: FF-1-a, ")
    assert f"rockflex {folder.manifest.versions['rockflex']}" in rows["versions"]
    assert rows["started"].endswith(" UTC")


def test_a_table_in_a_notebook(complete):
    folder, _ = complete
    tree = ET.fromstring(folder._repr_html_())
    rows = {row.findtext("th"): row.findtext("td") for row in tree.iter("tr")}
    assert rows["study"] == "cloud, two <scales>"
    assert rows["folder"] == str(folder.path)


def test_a_study_from_planned_to_stopped(tmp_path):
    with rf.StudyFolder.open(tmp_path, {"seed": 1}, 3, {"rockflex": "1"}) as folder:
        assert rows_of(folder)["state"].startswith("running: 0 of 3 parts, by process ")
        assert "last part" not in rows_of(folder)
        folder.write(1, pa.table({"run": [1, 2]}))
        assert rows_of(folder)["state"].startswith("running: 1 of 3 parts, by process ")
        assert rows_of(folder)["rows"] == "2"
    assert rows_of(folder)["state"] == "stopped: 1 of 3 parts"
    assert rows_of(folder)["study"] == "without a name"
    (tmp_path / "parts" / "part-00001.parquet").unlink()
    assert rows_of(folder)["state"] == "planned: none of 3 parts"


def test_damage_does_not_prevent_an_overview(tmp_path, monkeypatch):
    with rf.StudyFolder.open(tmp_path, {"seed": 1}, 3, {}) as folder:
        for number in range(3):
            folder.write(number, pa.table({"run": [number]}))
        part = tmp_path / "parts" / "part-00001.parquet"
        part.write_bytes(part.read_bytes()[:-20])
    assert rows_of(folder)["rows"] == "2; 1 part cannot be read, see damaged()"
    assert [each.number for each in folder.damaged()] == [1]
    monkeypatch.setattr(_folder, "MAX_PARTS_READ", 1)
    assert rows_of(folder)["rows"] == "1 in the first 1 parts"


@pytest.mark.parametrize("changed", [{"created": 5}, {"created": ""}, {"versions": "x"}])
def test_a_manifest_that_says_no_time_or_no_versions_is_damaged(changed, tmp_path):
    folder = rf.fill_study(STUDY, tmp_path / "study")
    manifest = folder.path / "manifest.json"
    manifest.write_text(json.dumps(json.loads(manifest.read_text("utf-8")) | changed), "utf-8")
    with pytest.raises(rf.InputError, match=r"manifest\.json or the .* is damaged \("):
        rf.StudyFolder.load(folder.path)


def test_columns_of_anyone(tmp_path):
    with rf.StudyFolder.open(tmp_path / "own", {"name": "own"}, 1, {}) as folder:
        column = pa.array([["a"], ["a"]])
        folder.write(
            0, pa.table([column, pa.array([1, 2]), pa.array([3, 4])], names=["status_list", "status", "status"])
        )
        assert rows_of(folder)["status_list"] == "2 ['a']"
