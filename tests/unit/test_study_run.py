"""Kinds of study, and running them: here, in a folder, resumed, in shares."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

import rockflex as rf
from builders import frame_values
from rockflex import InputError
from rockflex.engine.loops import LEVEL as VECTOR_LEVEL
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.studies import _run_plan
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._study_kind import KINDS, StudyFindings
from rockflex.studies.spec import StudySpec


@pytest.mark.parametrize("name", KINDS)
def test_a_record_describes_its_kind(name):
    kind = KINDS[name]
    spec = kind.spec()
    assert issubclass(spec, StudySpec)
    assert (kind.name, spec.model_fields["study"].default) == (name, name)
    assert kind.summary.endswith(".")


def test_commands_differ():
    assert len({kind.command for kind in KINDS.values()}) == len(KINDS)


def test_the_page_shows_kinds_of_the_registry():
    from rockflex.web._downloads import PAGES

    assert PAGES.keys() - {"record_set", "tornado"} <= KINDS.keys()  # these are no studies


def test_a_fit_that_fails_is_named():
    found = StudyFindings()

    def fit():
        raise rf.InputError("No run rocks.")

    assert found.fitted(lambda: 1.0, "A") == 1.0
    assert found.fitted(fit, "B") is None
    assert found.unfitted == ["B: No run rocks."]


def test_the_registry_loads_no_heavy_library():
    heavy = {"numpy", "scipy", "numba", "pydantic", "pandas", "matplotlib", "pyarrow"}
    program = f"import sys; from rockflex.studies import KINDS; print(len(KINDS), *({heavy!r} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["6"]


FRAME = frame_values(n_stories=3, stiffness_ratio=0.0, period=0.6, aspect_ratio=8.0)
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]}
STUDY = rf.CloudStudy(
    structures=[{"name": "A", "frame": FRAME}],
    records=RECORDS,
    models=["2DOF-S", "2DOF-C", "5DOF-S"],  # the last has more modes than the structure: rows with errors
    scales=[0.5, 1.5],
    runs_per_chunk=5,
)


def test_in_memory_and_in_a_folder_alike(tmp_path):
    seen: list[rf.Progress] = []
    table = rf.run_study(STUDY, progress=seen.append)
    assert len(table) == STUDY.plan().n_runs == 24
    assert [each.done for each in seen] == [0, 1, 2, 3, 4, 5]
    assert (seen[-1].parts, seen[-1].kept, seen[-1].runs) == (5, 0, 24)
    assert table["error"].notna().sum() == 8
    pd.testing.assert_frame_equal(rf.run_study(STUDY, tmp_path / "kept", workers=1), table)
    single = rf.simulate(rf.Frame(**FRAME), rf.load_suite("fema-p695-far-field")["FF-1-b"].scaled(1.5), "2DOF-C")
    row = table[(table["motion"] == "FF-1-b") & (table["model"] == "2DOF-C") & (table["scale"] == 1.5)].iloc[0]
    assert row["max_rotation"] == single.max_rotation


def test_nothing_is_computed_twice(tmp_path, monkeypatch):
    folder = tmp_path / "study"
    whole = rf.run_study(STUDY, folder)
    kept = {path.name: path.read_bytes() for path in (folder / "parts").iterdir()}
    (folder / "parts" / "part-00001.parquet").unlink()
    damaged = folder / "parts" / "part-00003.parquet"
    damaged.write_bytes(damaged.read_bytes()[:-100])
    computed: list[int] = []
    real = ChunkedPlan.chunk
    monkeypatch.setattr(ChunkedPlan, "chunk", lambda plan, number: computed.append(number) or real(plan, number))
    seen: list[rf.Progress] = []
    pd.testing.assert_frame_equal(rf.run_study(STUDY, folder, progress=seen.append), whole)
    assert sorted(computed) == [1, 3]
    assert (seen[0].kept, seen[-1].done, seen[-1].runs) == (3, 5, 10)
    assert {path.name: path.read_bytes() for path in (folder / "parts").iterdir()} == kept


def test_a_file_is_a_study(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        'study = "population"\npairs = 6\nseed = 3\nruns_per_chunk = 4\n[records]\nsuites = ["el-centro-1940"]\n'
    )
    table = rf.run_study(file, tmp_path / "kept")
    assert len(table) == 6
    assert len(list((tmp_path / "kept" / "parts").iterdir())) == 3
    assert pq.ParquetDataset(tmp_path / "kept" / "parts").read().num_rows == 6
    pd.testing.assert_frame_equal(rf.run_study(str(file)), table)


def test_a_changed_study_is_refused(tmp_path):
    rf.run_study(STUDY, tmp_path / "kept")
    other = rf.CloudStudy(**STUDY.document() | {"scales": [0.5, 2.0]})
    with pytest.raises(rf.InputError, match=r"scales\[1\].*1\.5.*2\.0"):
        rf.run_study(other, tmp_path / "kept")
    assert rf.StudyFolder.load(tmp_path / "kept").finished


def test_workers_and_a_cluster_exclude_each_other():
    with pytest.raises(rf.InputError, match=r"workers is for this machine, but 2 was given together with the cluster"):
        rf.run_study(STUDY, workers=2, dask="tcp://127.0.0.1:1")


def test_shares_are_the_whole_study(tmp_path):
    seen: list[rf.Progress] = []
    for place in (1, 2):
        share = rf.fill_study(STUDY, tmp_path / str(place), share=(place, 2), progress=seen.append)
        assert share.missing() == [[1, 3], [0, 2, 4]][place - 1]
    assert [(each.parts, each.done) for each in seen] == [(3, 0), (3, 1), (3, 2), (3, 3), (2, 0), (2, 1), (2, 2)]
    for part in (tmp_path / "2" / "parts").iterdir():
        part.rename(tmp_path / "1" / "parts" / part.name)
    seen.clear()
    whole = rf.fill_study(STUDY, tmp_path / "1", progress=seen.append)
    assert [(each.kept, each.done) for each in seen] == [(5, 5)]
    assert whole.finished
    pd.testing.assert_frame_equal(rf.run_study(STUDY, tmp_path / "1"), rf.run_study(STUDY))
    with pytest.raises(InputError, match="was opened for reading"):
        whole.write(0, whole.table())


def test_filling_a_folder_reads_no_table(tmp_path, monkeypatch):
    def refuse(*_: object, **__: object) -> None:
        raise AssertionError

    with monkeypatch.context() as patch:
        patch.setattr(rf.StudyFolder, "table", refuse)
        folder = rf.fill_study(STUDY, tmp_path / "study")
    assert folder.table().num_rows == 24


@pytest.mark.parametrize(
    ("share", "message"),
    [
        ((0, 2), "the number of the share must be a whole number from 1 to 2, but 0 was given"),
        ((3, 2), "the number of the share must be a whole number from 1 to 2, but 3 was given"),
        ((1, 0), "the number of shares must be a whole number of at least 1, but 0 was given"),
        ((1,), r"share must be two whole numbers, such as \(3, 10\), but \(1,\) was given"),
        (2, r"share must be two whole numbers, such as \(3, 10\), but 2 was given"),
    ],
)
def test_what_is_no_share_is_refused(tmp_path, share, message):
    with pytest.raises(InputError, match=message):
        rf.fill_study(STUDY, tmp_path / "study", share=share)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_cluster_gives_the_same_bits(tmp_path, cluster):
    here, there, spec = tmp_path / "here", tmp_path / "there", tmp_path / "study.toml"
    spec.write_text(
        'study = "cloud"\nmodels = ["2DOF-S", "2DOF-C", "MDOF-S"]\nscales = [0.5, 1.5]\nruns_per_chunk = 5\n'
        '[records]\nsuites = ["fema-p695-far-field"]\ninclude = ["FF-1-*", "FF-2-*"]\n'
        "[[structures]]\n[structures.frame]\n" + "\n".join(f"{name} = {value}" for name, value in FRAME.items())
    )
    # In a process of its own, which takes the kernels from the cache as the workers do: two processes that compile at
    # the same time may differ in how they fuse multiplications.
    rf.run_study(spec)  # compiles what is not there yet
    command = [sys.executable, "-m", "rockflex", "cloud", str(spec), "--out", str(here)]
    subprocess.run(command, check=True, capture_output=True)
    rf.run_study(spec, there, dask=cluster.address)
    parts = [{path.name: path.read_bytes() for path in (folder / "parts").iterdir()} for folder in (here, there)]
    assert len(parts[0]) == 5
    assert parts[0] == parts[1]


def test_time_is_estimated_from_a_sample():
    one, two = rf.estimate_time(STUDY, workers=1), rf.estimate_time(STUDY, workers=2)
    assert two > 0.0
    assert one > 0.0
    with pytest.raises(rf.InputError, match="workers must be a whole number of at least 1"):
        rf.estimate_time(STUDY, workers=0)


MATRICES = {"mass": [20e3, 90e3], "stiffness": [[2e7, -1e7], [-1e7, 1e7]], "heights": [3.0, 6.0]}
BASE = {"base_mass": 10e3, "half_width": 1.0, "damping_ratio": 0.02}


def of_files(folder: Path, **stiffness: float) -> rf.CloudStudy:
    np.savez(folder / "all.npz", mass=MATRICES["mass"])
    k = stiffness.get("k", 1e7)
    np.savetxt(folder / "k.csv", [[2e7, -k], [-k, 1e7]], delimiter=",")
    given = MATRICES | BASE | {"mass": "all.npz", "stiffness": "k.csv"}
    return rf.CloudStudy(
        structures=[{"frame": FRAME}, {"matrices": given}], records=RECORDS | {"include": ["FF-1-a"]}
    ).read_from(folder)


def test_a_changed_matrix_is_another_study(tmp_path):
    folder = tmp_path / "kept"
    rf.run_study(of_files(tmp_path), folder)
    manifest = json.loads((folder / "manifest.json").read_text())
    assert [len(manifest["checksums"][key]) for key in ("structures[1].matrices.mass", "FF-1-a")] == [64, 64]
    again = of_files(tmp_path)
    np.savez_compressed(tmp_path / "all.npz", mass=np.float64(MATRICES["mass"]))  # other bytes, the same numbers
    rf.run_study(again, folder)
    with pytest.raises(InputError) as caught:
        rf.run_study(of_files(tmp_path, k=0.9e7), folder)
    first, second, last = str(caught.value).splitlines()
    assert (
        first == f"{folder} holds this study with another record, matrix, source or impact law. Checksums that differ:"
    )
    assert second.startswith('  structures[1].matrices.stiffness: "')
    assert last == "Use the same files, or give another folder."


def test_a_changed_shape_is_another_study(tmp_path):
    """Two modes by two freedoms and their transpose hold the same numbers in another order; shapes count too."""
    names = {"omega": [5.0, 20.0], "shapes": [[1.0, 1.0], [2.0, -0.5]], "mass": [20e3, 20e3], "heights": [3.0, 6.0]}
    for name, values in names.items():
        np.savetxt(tmp_path / f"{name}.csv", values, delimiter=",")
    entry = StructureEntry(modes=BASE | {name: f"{name}.csv" for name in names})
    sums = entry.checksums(tmp_path)
    assert list(sums) == ["modes.mass", "modes.heights", "modes.omega", "modes.shapes"]
    assert len(set(sums.values())) == 4
    np.savetxt(tmp_path / "shapes.csv", np.transpose(names["shapes"]), delimiter=",")
    assert entry.checksums(tmp_path)["modes.shapes"] != sums["modes.shapes"]
    assert StructureEntry(frame=FRAME).checksums(tmp_path) == {}


def test_a_folder_records_the_level_of_vector_instructions(tmp_path, monkeypatch):
    level = rf.fill_study(STUDY, tmp_path, share=(1, 2)).manifest.versions["vector instructions"]
    assert level == VECTOR_LEVEL
    monkeypatch.setattr(_run_plan, "VECTOR_LEVEL", "v9")
    with pytest.raises(InputError, match=rf'vector instructions: "{level}" in the folder, "v9" now\n.*ROCKFLEX_SIMD'):
        rf.fill_study(STUDY, tmp_path)
    assert rf.fill_study(STUDY, tmp_path, any_version=True).finished


def test_a_manifest_without_the_level_of_vector_instructions_resumes(tmp_path):
    rf.fill_study(STUDY, tmp_path, share=(1, 2))
    manifest = json.loads((tmp_path / "manifest.json").read_text("utf-8"))
    del manifest["versions"]["vector instructions"]
    (tmp_path / "manifest.json").write_text(json.dumps(manifest), "utf-8")
    assert rf.fill_study(STUDY, tmp_path).finished
