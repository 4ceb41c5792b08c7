"""Commands whose stderr is a file: lines now and then, and none for what is short."""

import re
from itertools import pairwise
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rockflex.cli import app
from rockflex.progress import _lines

ROOT = Path(__file__).parents[2]

STUDY = """
study = "cloud"
name = "towers"
models = ["2DOF-S"]
scales = [0.5, 1.0]
runs_per_chunk = 4
records = {suites = ["fema-p695-far-field"], include = ["FF-1*"]}

[[structures]]
[structures.frame]
n_stories = 5
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 1.0
aspect_ratio = 10
damping_ratio = 0.02
"""
LINE = re.compile(r"^(.*): (\d+) of (\d+) \(\d+ %\), [\d.]+ s elapsed(?:, about [\d.]+ s left)?(?:, [\d.]+ rows/s)?$")


@pytest.fixture
def study(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(STUDY, "utf-8")
    return file


@pytest.fixture
def impatient(monkeypatch):
    """Lines that wait for a tenth more, but not for half a minute."""
    monkeypatch.setattr(_lines, "SOON", 0.0)


def lines_of(*arguments: object) -> list[re.Match[str]]:
    """The lines of progress that a command writes to stderr."""
    done = CliRunner().invoke(app, [str(each) for each in arguments])
    assert done.exit_code == 0, done.output
    assert "\x1b" not in done.stderr
    assert not any(map(LINE.match, done.stdout.splitlines()))
    return list(filter(None, map(LINE.match, done.stderr.splitlines())))


def test_a_study_writes_a_line_for_each_tenth(study, tmp_path, impatient):
    lines = lines_of("cloud", study, "--out", tmp_path / "out")
    done = [int(line[2]) for line in lines]
    assert {line[1] for line in lines} == {"towers"}
    assert {int(line[3]) for line in lines} == {11}
    assert done == sorted(set(done))
    assert len(done) <= 11
    assert all(later - sooner > 1 for sooner, later in pairwise(done))
    assert "left" in lines[0][0]
    assert "rows/s" in lines[0][0]


def test_a_share_of_a_study_does_so_too(study, tmp_path, impatient):
    assert {int(line[3]) for line in lines_of("cloud", study, "--out", tmp_path / "out", "--share", "1/2")} == {6}


def test_many_runs_and_the_paper_do_so_too(tmp_path, impatient):
    lines = lines_of("run", ROOT / "examples" / "wall.toml", "fema-p695-far-field", "--model", "2DOF-S,MDOF-S")
    assert {(line[1], int(line[3])) for line in lines} == {("Simulating", 88)}
    lines = lines_of("reproduce", "figure-12", "--out", tmp_path / "paper")
    assert {line[1] for line in lines} <= {"Computing", "Drawing"}
    assert lines


def test_what_is_short_writes_none(study, tmp_path):
    assert lines_of("cloud", study, "--out", tmp_path / "out") == []
