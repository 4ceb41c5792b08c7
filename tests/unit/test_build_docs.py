"""The build of the documentation keeps what it computed as long as its inputs are the same."""

import importlib.util
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "scripts" / "build_docs.py"
SPEC = importlib.util.spec_from_file_location("build_docs", SOURCE)
build = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(build)


@pytest.fixture
def inputs(tmp_path, monkeypatch):
    monkeypatch.setattr(build, "ROOT", tmp_path)
    files = [tmp_path / "a.py", tmp_path / "b.npz"]
    for file in files:
        file.write_bytes(b"1")
    return files


@pytest.mark.parametrize("changed", [0, 1])
def test_a_changed_input_is_seen(inputs, changed):
    before = build.fingerprint(inputs)
    assert build.fingerprint(inputs) == before
    inputs[changed].write_bytes(b"2")
    assert build.fingerprint(inputs) != before


def test_a_renamed_input_is_seen(inputs, tmp_path):
    before = build.fingerprint(inputs)
    assert build.fingerprint([inputs[0], inputs[1].rename(tmp_path / "c.npz")]) != before


def test_a_folder_of_other_inputs_or_unfinished_is_removed(tmp_path):
    folder = tmp_path / "made"
    for stamp, kept in (("now", True), ("before", False), (None, False)):
        folder.mkdir()
        if stamp:
            (folder / build.STAMP).write_text(stamp, "utf-8")
        assert build.is_kept(folder, "now") is kept
        assert folder.exists() is kept
        if kept:
            (folder / build.STAMP).unlink()
            folder.rmdir()


def test_the_package_is_an_input_but_for_its_faces():
    names = {str(file.relative_to(build.PACKAGE)) for file in build.package_files()}
    assert {"engine/march.c", "structure/_frames.py", "motion/data/el-centro-1940.npz"} <= names
    assert not any(name.startswith(("web/", "cli/")) for name in names)
    assert all(file.is_file() for file in build.REPRODUCE)
    assert len(build.REPRODUCE) >= 3
