"""The commits that a study's folder records: of the code, and of the file of the study."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

import rockflex as rf
from rockflex.foundation import versions
from rockflex.foundation.versions import git_commit

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="there is no Git")
TEXT = 'study = "population"\npairs = 3\nruns_per_chunk = 2\nrecords.suites = ["el-centro-1940"]\n'


def git(folder: Path, *arguments: str) -> str:
    who = ("-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
    command = ["git", "-C", str(folder), *who, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def repository(tmp_path):
    """A repository with a study, committed."""
    folder = tmp_path / "repository"
    folder.mkdir()
    git(folder, "init", "-q")
    (folder / "study.toml").write_text(TEXT, "utf-8")
    git(folder, "add", "study.toml")
    git(folder, "commit", "-q", "-m", "A study")
    return folder


def head(folder: Path) -> str:
    return git(folder, "rev-parse", "--short=12", "HEAD")


def test_the_commit_of_a_file(repository):
    file = repository / "study.toml"
    assert git_commit(file, known=True) == git_commit(file, known=False) == head(repository)
    (repository / "notes.txt").write_text("not known to Git", "utf-8")
    assert git_commit(file, known=True) == head(repository)
    file.write_text(TEXT + "seed = 1\n", "utf-8")
    assert git_commit(file, known=True) == f"{head(repository)}+changes"


def test_a_file_that_git_does_not_know(repository):
    other = repository / "other.toml"
    other.write_text(TEXT, "utf-8")
    assert git_commit(other, known=True) is None  # an installation in a folder of someone else's repository
    assert git_commit(other, known=False) == f"{head(repository)}+changes"


def test_no_program_of_the_repository_runs(repository, tmp_path):
    marker = tmp_path / "marker"
    (repository / ".gitattributes").write_text("*.toml filter=evil\n", "utf-8")
    git(repository, "config", "filter.evil.clean", f"touch {marker}; cat")
    (repository / "study.toml").write_text(TEXT + "seed = 2\n", "utf-8")
    assert git_commit(repository / "study.toml", known=True) == f"{head(repository)}+changes"
    assert not marker.exists()


def test_names_with_wildcards_are_names(repository):
    file = repository / "*.toml"
    file.write_text(TEXT, "utf-8")
    assert git_commit(file, known=True) is None


def test_without_a_repository_or_a_commit_or_git(tmp_path, repository, monkeypatch):
    assert git_commit(tmp_path / "study.toml", known=False) is None
    empty = tmp_path / "empty"
    empty.mkdir()
    git(empty, "init", "-q")
    assert git_commit(empty / "study.toml", known=False) is None
    monkeypatch.setenv("PATH", str(tmp_path))
    assert git_commit(repository / "study.toml", known=True) is None


def test_a_variable_of_git_does_not_lead_elsewhere(repository, tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "nowhere"))
    right = git_commit(repository / "study.toml", known=True)
    monkeypatch.delenv("GIT_DIR")
    assert right == head(repository)


def test_a_folder_records_the_commits_and_resumes_with_others(repository, tmp_path):
    file, out = repository / "study.toml", tmp_path / "out"
    rf.fill_study(file, out, share=(1, 2))
    first = head(repository)
    assert rf.StudyFolder.load(out).manifest.versions["study commit"] == first
    assert f"study commit {first}" in repr(rf.StudyFolder.load(out))
    (repository / "more.txt").write_text("more", "utf-8")
    git(repository, "add", "more.txt")
    git(repository, "commit", "-q", "-m", "More")
    folder = rf.fill_study(file, out)  # another commit is no reason to refuse
    assert folder.finished
    assert folder.manifest.versions["study commit"] == first
    assert {commits_of(path) for path in (out / "parts").iterdir()} == {first, head(repository)}


def commits_of(part: Path) -> str:
    import pyarrow.parquet as pq

    return json.loads(pq.read_metadata(part).metadata[b"rockflex.versions"])["study commit"]


def test_a_study_without_a_file_or_a_repository_resumes_too(repository, tmp_path, monkeypatch):
    file, out = repository / "study.toml", tmp_path / "out"
    rf.fill_study(file, out, share=(1, 2))
    monkeypatch.setattr(versions, "_git_output", lambda *_: None)
    assert "study commit" not in rf.fill_study(rf.PopulationStudy(**content()), tmp_path / "new").manifest.versions
    assert rf.fill_study(file, out).finished


def content() -> dict[str, object]:
    return {"pairs": 3, "runs_per_chunk": 2, "records": {"suites": ["el-centro-1940"]}}
