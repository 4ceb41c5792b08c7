"""Every output of the catalogue: one symbol and one unit in tables, reports, the page and the nomenclature."""

import dataclasses
import inspect
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from typer.testing import CliRunner

import rockflex as rf
from report_case import HELD, PULSE, SPRINGS, runs
from report_page import read
from rockflex.cli import _console
from rockflex.cli._app import app
from rockflex.foundation.units import KN
from rockflex.plot._history import PANELS
from rockflex.response._outputs import (
    ALL_RESULTS,
    COLUMNS,
    COMPARED_DEMANDS,
    DEMANDS_OF_SET,
    HISTORY,
    OF_MOTION,
    OUTPUTS,
    REACTIONS,
    described_output,
    outputs_of,
)
from rockflex.response._response import PEAKS
from rockflex.response._tables import history_columns
from rockflex.studies._result_tables import result_columns
from rockflex.web._app import _answer_about_page

ROOT = Path(__file__).parents[2]
SHOWN = (*OF_MOTION, *REACTIONS, *outputs_of("sliding", "springs"))
OF_TENDONS = ("max_tendon_force", "tendon_utilisation")
GROUND = ["--breadth", 3, "--subgrade-modulus", 2e8, "--base-inertia", 2e6, "--heave-damping-ratio", 0.2]


@pytest.fixture(scope="module")
def run():
    """A pier with tendons and dissipators that slides on springs."""
    ground = dataclasses.replace(SPRINGS, friction=0.1)
    (found,) = runs(HELD, PULSE.scaled(2.0), ["2DOF-S"], ground=ground)
    assert found.max_slip > 0.0
    return found


def heading(name, value):
    """What heads a column in the usual units."""
    return OUTPUTS[name].unit_in(KN, largest=abs(value)).heading(OUTPUTS[name].symbol)


@pytest.fixture(scope="module")
def printed():
    """The headings of the tables that the command line prints of such a run."""
    heads = set()
    given, kept = ["examples/restrained_pier.toml", "el-centro-1940", "--model", "2DOF-S", "--scale", 2], _console.table

    def table(names, *rest):
        heads.update(names)
        return kept(names, *rest)

    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        patch.setattr(_console, "table", table)
        done = CliRunner().invoke(app, ["run", *map(str, [*given, "--ground-friction", 0.1, *GROUND])])
    assert done.exit_code == 0, done.output
    return heads, done.output


@pytest.mark.slow
@pytest.mark.parametrize("name", [*SHOWN, *OF_TENDONS, "residual_rotation"])
def test_the_command_line_shows_symbol_and_unit_and_says_what_they_are(printed, name):
    heads, text = printed
    assert {heading(name, 0.0), heading(name, 1e9)} & heads
    assert f"\n{OUTPUTS[name].symbol}: {OUTPUTS[name].words}\n" in text


@pytest.mark.slow
def test_a_report_shows_the_same(run, tmp_path):
    reader = read(rf.write_report(run, tmp_path / "r.html", structure=HELD, motion=PULSE))
    heads, row = reader.tables["peaks"]
    found = {of: (head[0], value) for head, (_, of, value) in zip(heads, row, strict=True)}
    for name in (*SHOWN, "max_floor_acceleration"):
        text, value = found[name]
        assert text.replace("\xa0", " ") == heading(name, value).replace("_", "").replace(" [", "[")
        if name in PEAKS:
            assert value == getattr(run, name)


@pytest.mark.slow
def test_axes_have_the_symbols(run):
    figure = rf.plot_history(run, panels=[*PANELS])
    for name, axes in zip(PANELS, figure.axes, strict=True):
        label, _, unit = axes.get_ylabel().partition(" [")
        assert re.sub(r"[${}]|\\mathrm", "", label) == HISTORY[name].symbol
        assert unit.rstrip("]").removeprefix("k").removeprefix("M").replace("²", "2") == HISTORY[name].si


@pytest.mark.parametrize("name", [*OUTPUTS, *HISTORY])
def test_the_page_is_told_the_same(name):
    about, known = _answer_about_page(), (HISTORY | OUTPUTS)[name]
    told = (about["histories"] | about["outputs"])[name]
    assert (told["symbol"], told["words"]) == (known.symbol, known.words)
    if known.quantity in about["units"]["kN"] and known.quantity != "acceleration":  # the page has those in m/s²
        assert about["units"]["kN"][told["quantity"]]["name"] == known.unit_in(KN).name


@pytest.mark.parametrize("name", [name for name, each in OUTPUTS.items() if each.symbol])
def test_the_nomenclature_lists_it(name):
    known = OUTPUTS[name]
    if known.quantity in ("flag", "count"):
        return
    words, si = known.words.replace("|", r"\|"), known.si.replace("2", "²")
    row = f"| {known.symbol} | {words} | `{name}` | {known.unit_in(KN).name} | {si} |"
    assert row in (ROOT / "docs" / "nomenclature.md").read_text("utf-8").splitlines()


def test_the_catalogue_has_every_number_of_a_response_and_its_docstring_too():
    times = {name for name in PEAKS if name.startswith("time_of_")}
    named = {"model", "motion", "status"}
    assert set(PEAKS) - named - times == set(OUTPUTS) - {"max_story_drift", "max_floor_acceleration"}
    assert {f"time_of_{name}" for name in (*OF_MOTION, *REACTIONS, "min_joint_force")} == times
    entries = re.findall(r"^(\w+(?:, \w+)*)\n {4}\S", inspect.getdoc(rf.Response), re.MULTILINE)
    assert {name for entry in entries for name in entry.split(", ")} >= set(PEAKS)
    for name in set(OUTPUTS) & set(PEAKS):
        assert OUTPUTS[name].words[1:] in " ".join(inspect.getdoc(rf.Response).split())


def test_tables_list_only_outputs_and_no_symbol_means_two(run):
    assert set(DEMANDS_OF_SET) | set(COMPARED_DEMANDS) <= set(OUTPUTS)
    assert set(COLUMNS) <= set(HISTORY)
    symbols = [each.symbol for each in OUTPUTS.values() if each.symbol]
    assert len(set(symbols)) == len(symbols)
    for name in history_columns(run.history):
        assert described_output(name) is not None
    columns = result_columns([run.history.model.properties], with_ground=True)
    assert [name for name in columns if name != "status" and described_output(name) is None] == []


@pytest.mark.slow
def test_saved_runs_give_every_output_back(run, tmp_path):
    back = rf.Response.load(run.save(tmp_path / "run.npz"))
    for name in OUTPUTS.keys() & set(PEAKS):
        assert getattr(back, name) == getattr(run, name)
    for name in filter(lambda each: hasattr(run, each), HISTORY):
        np.testing.assert_array_equal(getattr(back, name), getattr(run, name))


@pytest.mark.slow
def test_files_for_other_programs_have_its_unit_and_words(run, tmp_path):
    import pandas as pd

    file = loadmat(rf.to_matlab(pd.DataFrame([run.peaks()]), tmp_path / "peaks.mat"), simplify_cells=True)
    history = loadmat(run.to_matlab(tmp_path / "history.mat"), simplify_cells=True)
    for found, catalogue in ((file, {n: ALL_RESULTS[n] for n in OUTPUTS.keys() & set(PEAKS)}), (history, HISTORY)):
        for name in catalogue.keys() & found["units"].keys():
            known = catalogue[name]
            assert (found["units"][name] if known.si else "", found["descriptions"][name]) == (known.si, known.words)
    assert {*OUTPUTS} & {*PEAKS} <= file["units"].keys()
