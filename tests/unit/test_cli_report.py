"""``rockflex run --report``: the page of the runs, and what it refuses."""

import sys

import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import app

FLAGS = [
    *("--stories", "5", "--story-height", "3", "--story-mass", "40e3", "--base-mass", "40e3"),
    *("--stiffness-ratio", "inf", "--period", "1", "--aspect-ratio", "10", "--damping-ratio", "0.02"),
]
RUN = ["run", *FLAGS, "el-centro-1940"]


def invoke(*arguments):
    return CliRunner().invoke(app, [*RUN, *map(str, arguments)], env={"COLUMNS": "200"})


def refused(words, *arguments):
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.split())


def test_the_page_has_the_peaks_of_the_runs(tmp_path, monkeypatch):
    page = tmp_path / "new" / "run.html"
    arguments = ["--scale", "1.5", "--model", "2DOF-S,fixed", "--friction", "0.4", "--report", str(page)]
    monkeypatch.setattr(sys, "argv", ["rockflex", *RUN, *arguments])
    result = invoke(*arguments)
    assert result.exit_code == 0, result.output
    assert f"Written to {page}" in result.stderr
    text = page.read_text("utf-8")
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    for model in ("2DOF-S", "fixed"):
        response = rf.simulate(make_frame(), motion, model)
        assert f'data-of="max_base_moment" data-value="{response.max_base_moment}"' in text
        assert f'data-of="required_friction" data-value="{response.required_friction_excluding_impacts()}"' in text
    assert "<title>5-story frame under EL-CENTRO-1940-NS × 1.5</title>" in text
    assert "Command: rockflex run --stories 5" in text
    assert "≤ 0.4" in text or "&gt; 0.4" in text


def test_a_page_that_cannot_be_written_does_not_cost_the_results(tmp_path):
    (tmp_path / "file").write_text("no folder")
    result = invoke("--model", "2DOF-S", "--report", tmp_path / "file" / "run.html")
    assert result.exit_code == 2
    assert "EL-CENTRO-1940-NS" in result.stdout
    assert "Cannot write to" in result.stderr


def test_with_out_each_has_its_own_files(tmp_path):
    page, out = tmp_path / "run.html", tmp_path / "out"
    assert invoke("--report", page, "--out", out, "--figures", "0").exit_code == 0
    assert page.is_file()
    assert sorted(each.name for each in out.iterdir()) == ["results.csv", "summary.json"]


def test_an_earlier_page_stays_without_force(tmp_path):
    page = tmp_path / "run.html"
    page.write_text("mine")
    refused(f"--report {page} exists. Give another name, or --force to replace it.", "--report", page)
    assert page.read_text() == "mine"
    assert invoke("--report", page, "--force").exit_code == 0
    assert page.read_text("utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--scale", "1", "--scale", "2"], "but there are 1 motion at 2 scales. Name one record, such as SUITE/NAME"),
        (["fema-p695-far-field/FF-1-a"], "but there are 2 motions at 1 scale."),
        (
            ["--model", "2DOF-S,3DOF-S,4DOF-S,5DOF-S,MDOF-S,fixed,rigid"],
            "--report has room for 6 models, but there are 7. Choose the ones that matter with --model.",
        ),
    ],
)
def test_what_does_not_fit_on_a_page(more, words, tmp_path):
    refused(words, *more, "--report", tmp_path / "run.html")
    assert list(tmp_path.iterdir()) == []


def test_a_path_that_is_no_page(tmp_path):
    refused("the --report", "--report", tmp_path / "run.pdf")
    refused("is a folder. Give a file in it", "--report", tmp_path)
    refused("--force was given without --out", "--force")
    assert list(tmp_path.iterdir()) == []
