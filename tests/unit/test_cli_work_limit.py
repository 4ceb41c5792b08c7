"""``--work-limit``: what takes too long is refused on the command line, and the limit can be raised and lifted."""

import json

import pytest
from typer.testing import CliRunner

from rockflex.cli import _batch, app

STRUCTURE = """
[frame]
n_stories = 5
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = {period}
aspect_ratio = 10.0
damping_ratio = 0.02
"""
STUDY = 'study = "{kind}"\nmodels = ["MDOF-S"]\n{head}[records]\nsuites = ["el-centro-1940"]\n[[structures]]\n'


def invoke(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "220"})


def structure_file(folder, period=1.0):
    file = folder / "structure.toml"
    file.write_text(STRUCTURE.format(period=period))
    return file


def test_a_run_that_takes_too_long_is_refused(tmp_path) -> None:
    result = invoke("run", structure_file(tmp_path, 1e-6), "el-centro-1940", "--model", "MDOF-S")
    assert result.exit_code == 2
    assert "MDOF-S would take about" in result.stderr
    assert 'work_limit=None ("none" in a file and on the command line).' in result.stderr


def test_beside_others_it_is_a_run_that_could_not_be_solved(tmp_path) -> None:
    file = structure_file(tmp_path)
    result = invoke("run", file, "el-centro-1940", "--model", "MDOF-S,MDOF-C", "--work-limit", "0.0022", "--json")
    errors = {run["model"]: run["error"] for run in json.loads(result.stdout)["runs"]}
    assert errors["MDOF-S"] is None
    assert "MDOF-C would take about 0.0" in errors["MDOF-C"]


def test_in_batches_too(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 1)
    options = ["--model", "MDOF-S,2DOF-S-BW", "--yield-displacement", "0.01", "--work-limit", "0.001", "--json"]
    result = invoke("run", structure_file(tmp_path), "el-centro-1940", *options)
    errors = {run["model"]: run["error"] for run in json.loads(result.stdout)["runs"]}
    assert errors["MDOF-S"] is None
    assert "2DOF-S-BW would take about 0.0" in errors["2DOF-S-BW"]


def test_none_lifts_the_limit(tmp_path, monkeypatch) -> None:
    found = []
    perform = _batch.run_batch
    monkeypatch.setattr(_batch, "run_batch", lambda plan: (found.append(plan.options.work_limit), perform(plan))[1])
    file = structure_file(tmp_path)
    for given in ([], ["--work-limit", "7"], ["--work-limit", "none"]):
        assert invoke("run", file, "el-centro-1940", "--model", "fixed", *given).exit_code == 0
    assert found == [30.0, 7.0, None]


@pytest.mark.parametrize(("given", "shown"), [("0", "0.0"), ("-3", "-3.0"), ("soon", "'soon'"), ("nan", "nan")])
def test_a_limit_that_is_none_is_refused(tmp_path, given, shown) -> None:
    result = invoke("run", structure_file(tmp_path), "el-centro-1940", "--work-limit", given)
    assert result.exit_code == 2
    assert "--work-limit must be a positive number of seconds of computing for one run" in result.stderr
    assert f"but {shown} was given." in result.stderr


@pytest.mark.parametrize(
    ("command", "kind", "head"), [("cloud", "cloud", ""), ("ida", "incremental", "largest_scale = 0.2\ngrowth = 2.0\n")]
)
def test_a_study_that_takes_too_long_is_refused_and_the_limit_goes_before_the_file(
    tmp_path, command, kind, head
) -> None:
    file = tmp_path / "study.toml"
    usual = STRUCTURE.replace("[frame]", "[structures.frame]")
    file.write_text(STUDY.format(kind=kind, head=head) + usual.format(period=1e-6))
    for more in ([], ["--dry-run"]):
        result = invoke(command, file, *more)
        assert result.exit_code == 2
        assert "MDOF-S would take about" in result.stderr
    file.write_text(STUDY.format(kind=kind, head="work_limit = 1e-6\n" + head) + usual.format(period=1.0))
    assert "work_limit is 1e-06 s" in invoke(command, file).stderr
    assert invoke(command, file, "--work-limit", "none", "--dry-run").exit_code == 0
