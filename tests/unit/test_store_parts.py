"""Damaged and foreign parts: found, named, computed anew; the others kept."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pyarrow import parquet

from rockflex import InputError
from rockflex.store import StudyFolder
from rockflex.store._parts import PartError, check, encode, read, verify
from toy_study import SPEC, VERSIONS, ToyPlan, opened, run_study

PLAN = ToyPlan(n_chunks=4, rows=30)


@pytest.fixture
def done(tmp_path: Path) -> Path:
    run_study(str(tmp_path / "study"), PLAN)
    return tmp_path / "study"


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
    path.write_bytes(encode(PLAN.chunk(1), "0" * 32, 1, VERSIONS))


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
    content = encode(ToyPlan(rows=3).chunk(0), "s", 0, VERSIONS)
    path.write_bytes(content)
    assert verify(path, "s", 0) == content
    for place in np.random.default_rng(1).integers(0, 8 * len(content), 1000):
        damaged = bytearray(content)
        damaged[place // 8] ^= 1 << (place % 8)
        path.write_bytes(damaged)
        with pytest.raises(PartError):
            verify(path, "s", 0)


def test_every_cut_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "part"
    content = encode(ToyPlan(rows=3).chunk(0), "s", 0, VERSIONS)
    for length in range(0, len(content), 7):
        for padding in (b"", bytes(len(content) - length)):
            path.write_bytes(content[:length] + padding)
            with pytest.raises(PartError):
                verify(path, "s", 0)


def test_data_that_look_like_the_checksum_do_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "part"
    table = pa.table({"rockflex-crc32:00000000": ["rockflex-crc32:00000000"] * 3})
    path.write_bytes(encode(table, "s", 0, {"a": "rockflex-crc32:00000000"}))
    assert read(path, "s", 0).equals(table)


def test_an_empty_chunk_keeps_its_columns(tmp_path: Path) -> None:
    with opened(str(tmp_path), ToyPlan(n_chunks=2)) as study:
        study.write(0, PLAN.chunk(0).slice(0, 0))
        study.write(1, PLAN.chunk(1))
        pd.testing.assert_frame_equal(study.frame(), PLAN.frame(1))


def test_parts_with_other_columns_are_refused_on_reading(done: Path) -> None:
    study = StudyFolder.load(done)
    content = encode(PLAN.chunk(1).drop_columns(["error"]), study.manifest.study, 1, VERSIONS)
    (done / "parts" / "part-00001.parquet").write_bytes(content)
    assert "error" not in check(content, study.manifest.study, 1).names
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
