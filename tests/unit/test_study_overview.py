"""The overview of a study's folder: what it is, how far it is, and what came out."""

import json
import xml.etree.ElementTree as ET

import pyarrow as pa
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.store import _overview

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
    monkeypatch.setattr(_overview, "MOST_READ", 1)
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
