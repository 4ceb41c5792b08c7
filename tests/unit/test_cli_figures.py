import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli import app
from rockflex.kinds import load_study

FRAME = """
[[structures]]
frame = {n_stories = 5, story_height = 3.0, story_mass = 40e3, base_mass = 40e3, stiffness_ratio = inf, period = 1.0,
         aspect_ratio = 10, damping_ratio = 0.02}
""".replace(",\n        ", ",")
RECORDS = 'records = {suites = ["fema-p695-far-field"], include = ["FF-1*"]}\n'
STUDIES = {
    "cloud": (
        "scales = [0.2, 1.0]\n" + RECORDS + FRAME,
        ["fragility", "rotation", "top_displacement", "total_top_displacement"],
    ),
    "incremental": ('models = ["2DOF-S"]\ngrowth = 1.5\ntolerance = 0.1\n' + RECORDS + FRAME, ["capacities"]),
    "stripes": ('levels = [0.5, 1.0, 2.0]\nmeasure = "pgv"\n' + RECORDS + FRAME, ["stripes"]),
    "population": ("pairs = 12\n" + RECORDS, ["agreement", "modal_combination", "population"]),
    "monte_carlo": (
        "count = 12\nvariables.b = { uniform = [0.1, 0.2] }\nscales = [0.5, 1.5]\nmodels = ['rigid']\n"
        + RECORDS
        + "structure = { block = { slenderness = '= b', half_diagonal = 3.0 } }\n",
        ["fragility", "rotation", "top_displacement", "total_top_displacement"],
    ),
}


def invoke(*arguments):
    return CliRunner().invoke(app, ["figures", *map(str, arguments)], env={"COLUMNS": "200"})


def kept(folder, kind, extra=""):
    """A study of a kind, run and stored in a folder."""
    file = folder / f"{kind}.toml"
    file.write_text(f'study = "{kind}"\n{extra}{STUDIES[kind][0]}', "utf-8")
    study = load_study(file)
    plan = study.plan()
    with rf.StudyFolder.open(folder / kind, study.document(), plan.n_chunks, {"rockflex": "0"}) as kept:
        for number in range(plan.n_chunks):
            kept.write(number, plan.chunk(number))
    return folder / kind


@pytest.mark.parametrize("kind", STUDIES)
def test_figures_of_a_kept_study(tmp_path, kind):
    folder = kept(tmp_path, kind)
    result = invoke(folder)
    assert result.exit_code == 0, result.stderr
    assert result.stderr.strip() == f"Written to {folder / 'figures'}"
    files = sorted(path.name for path in (folder / "figures").iterdir())
    assert files == sorted([*(f"{stem}.png" for stem in STUDIES[kind][1]), "summary.json"])
    assert json.loads((folder / "figures" / "summary.json").read_text("utf-8"))["study"]["study"] == kind
    assert rf.StudyFolder.load(folder).finished


def test_figures_of_an_unfinished_study_elsewhere(tmp_path):
    folder = kept(tmp_path, "cloud", "runs_per_chunk = 3\n")
    next((folder / "parts").iterdir()).unlink()
    result = invoke(folder, "--out", tmp_path / "there", "--format", "svg", "--measure", "sa_t1")
    assert result.exit_code == 0, result.stderr
    total = rf.StudyFolder.load(folder).n_chunks
    assert result.stderr.splitlines() == [
        f"1 of {total} parts are missing: the figures show the others",
        f"Written to {tmp_path / 'there'}",
    ]
    assert (tmp_path / "there" / "fragility.svg").read_text("utf-8").startswith("<?xml")


def test_figures_replace_nothing_unless_told_to(tmp_path):
    folder = kept(tmp_path, "stripes")
    out = tmp_path / "there"
    assert invoke(folder, "--out", out).exit_code == 0
    refused = invoke(folder, "--out", out, "--format", "pdf")
    assert refused.exit_code == 2
    assert refused.stderr.strip() == (
        f"Error: The folder {out} is not empty. Give another one, or --force to replace the results in it."
    )
    assert invoke(folder, "--out", out, "--format", "pdf", "--force").exit_code == 0
    assert sorted(path.name for path in out.iterdir()) == ["stripes.pdf", "summary.json"]
    for arguments, message in (
        (("--format", "jpg"), "--format must be one of png, svg, pdf, but 'jpg' was given."),
        (
            ("--measure", "pga"),
            f"--measure is for cloud, incremental and monte_carlo studies, but the study in {folder} is of kind "
            "stripes. Leave it out.",
        ),
    ):
        refused = invoke(folder, *arguments)
        assert refused.exit_code == 2
        assert refused.stderr.strip() == f"Error: {message}"
    assert not Path(folder / "figures").exists()


def test_figures_of_no_study(tmp_path):
    refused = invoke(tmp_path)
    assert refused.exit_code == 2
    assert refused.stderr.startswith(f"Error: There is no study at {tmp_path}")
