"""Alternatives side by side: their demands, differences, figure, report and command."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app
from rockflex.plot._comparison import draw_alternatives

SLENDER, WIDE = (make_frame(n_stories=2, period=0.5, aspect_ratio=ratio) for ratio in (8.0, 5.0))
TIED = rf.Restrained(SLENDER, rf.Tendon(1e5, 5e6, yield_force=4e5))
PULSES = [rf.one_sine_pulse(amplitude=size, period=0.8) for size in (2.0, 3.0, 4.0, 5.0)]
RECORDS = {f"pulse {k}": pulse for k, pulse in enumerate(PULSES, 1)}
BED = rf.Ground(springs=rf.Springs([-0.5, 0.5], 2e8, 1e6), base_inertia=2e4)


@pytest.fixture(scope="module")
def several():
    return rf.compare({"slender": SLENDER, "wide": WIDE, "tied": TIED}, RECORDS, scale=0.9)


@pytest.fixture(scope="module")
def one():
    return rf.compare([SLENDER, WIDE], PULSES[1], "2DOF-S", ground={"B": BED})


def test_demands_are_those_of_single_runs(several):
    for statistic, of in (("median", np.median), ("max", np.max), ("mean", np.mean)):
        found = several.demands(statistic)
        assert list(found.columns) == ["slender", "wide", "tied"]
        for name, structure in (("slender", SLENDER), ("wide", WIDE), ("tied", TIED)):
            runs = [rf.simulate(structure, pulse.scaled(0.9)) for pulse in PULSES]
            for demand in ("max_rotation", "max_base_moment", "tendon_utilisation", "max_edge_uplift"):
                values = [getattr(run, demand) for run in runs]
                # The same runs, in another batch: rounding of sums of matrices only.
                assert found.loc[demand, name] == pytest.approx(of(values), rel=1e-10)
            drifts = [run.floors.story_drift.max() for run in runs]
            assert found.loc["max_story_drift", name] == pytest.approx(of(drifts), rel=1e-10)
    assert several.n_records == 4
    assert repr(several) == "Comparison('slender', 'wide', 'tied' under 4 records)"


def test_four_of_five_records_stay_below_84_percent():
    both = rf.compare([SLENDER, WIDE], [PULSES[1].scaled(factor) for factor in np.linspace(0.6, 1.0, 26)])
    rotations = np.sort(both.runs["max_rotation"].to_numpy()[:26])
    assert both.demands("p84").loc["max_rotation", "A"] == pytest.approx(rotations[21], rel=1e-12)  # 0.84 of 25 steps


def test_differences_are_in_percent_of_the_first(several):
    values, found = several.demands("mean"), several.differences("mean")
    assert list(found.columns) == ["wide", "tied"]
    for demand in ("max_rotation", "max_base_shear"):
        expected = 100.0 * (values.loc[demand, "tied"] - values.loc[demand, "slender"]) / values.loc[demand, "slender"]
        assert found.loc[demand, "tied"] == pytest.approx(expected, rel=1e-12)
    assert np.isnan(found.loc["tendon_utilisation", "tied"])  # the first has no tendon


def test_the_governing_record_is_that_of_the_largest_rotation(several, one):
    rotations = [rf.simulate(SLENDER, pulse).max_rotation for pulse in PULSES]
    assert several.motion.name == f"pulse {1 + int(np.argmax(rotations))}"
    governing = RECORDS[several.motion.name].scaled(0.9)
    assert several.motion.pga == pytest.approx(governing.pga, rel=1e-15)
    for run, structure in zip(several.responses, (SLENDER, WIDE, TIED), strict=True):
        alone = rf.simulate(structure, governing).max_rotation
        assert run.max_rotation == pytest.approx(alone, rel=1e-10)
    assert one.motion.name == PULSES[1].name


def test_options_of_each_alternative(one):
    soft = rf.simulate(WIDE, PULSES[1], "2DOF-S", ground=BED)
    assert one.responses[1].max_rotation == pytest.approx(soft.max_rotation, rel=1e-10)
    assert one.demands().loc["max_edge_settlement", "A"] == 0.0
    assert one.demands().loc["max_edge_settlement", "B"] == pytest.approx(soft.max_edge_settlement, rel=1e-10)
    assert "max_slip" not in one.demands().index
    fixed = rf.compare({"a": SLENDER, "b": SLENDER}, PULSES[1], {"a": "MDOF-S", "b": "fixed"})
    assert [run.model for run in fixed.responses] == ["MDOF-S", "fixed"]
    assert fixed.differences().loc["max_rotation", "b"] == -100.0


def test_a_rotation_is_left_only_at_rest():
    fuse = rf.Restrained(SLENDER, rf.YieldingDissipator(1e9, 2e6))  # stronger than the weight
    moving = rf.compare([fuse, SLENDER], PULSES[2])
    settled = rf.compare([fuse, SLENDER], PULSES[2], free_vibration="settle")
    left = abs(rf.simulate(fuse, PULSES[2], free_vibration="settle").residual_rotation)
    assert "residual_rotation" not in moving.demands().index
    assert settled.demands().loc["residual_rotation", "A"] == pytest.approx(left, rel=1e-9)


def test_what_rounding_leaves_is_no_demand_to_compare_with():
    """Springs without fuses bring the base back: what is left there is rounding, and no percentage of it means much."""
    fused = rf.Restrained(SLENDER, rf.YieldingDissipator(2e7, 150e3, 0.02, 0.3))
    settled = rf.compare([SLENDER, fused], PULSES[2], ground=BED, free_vibration="settle")
    assert settled.demands().loc["residual_rotation", "A"] == 0.0 < settled.demands().loc["residual_rotation", "B"]
    assert math.isnan(settled.differences().loc["residual_rotation", "B"])


def test_overturned_runs_count_as_infinite():
    both = rf.compare([SLENDER, WIDE], [PULSES[0], PULSES[0], PULSES[3].scaled(20.0)], free_vibration=5.0)
    assert both.overturned == (1, 1)
    rotations = [both.demands(each).loc["max_rotation", "A"] for each in ("median", "p84", "max", "mean")]
    assert rotations[0] == pytest.approx(rf.simulate(SLENDER, PULSES[0], free_vibration=5.0).max_rotation, rel=1e-10)
    assert rotations[1:] == [math.inf] * 3
    assert np.isnan(both.differences("max").loc["max_rotation", "B"])


@pytest.mark.parametrize(
    ("make", "said", "field"),
    [
        (lambda: rf.compare([SLENDER], PULSES), "2 to 6", "alternatives"),
        (lambda: rf.compare([SLENDER] * 7, PULSES), "7 structures", "alternatives"),
        (lambda: rf.compare([SLENDER, 3.0], PULSES), "structure", None),
        (lambda: rf.compare([SLENDER, WIDE], []), "empty", None),
        (lambda: rf.compare([SLENDER, WIDE], PULSES, ground={"C": BED}), "A, B", "ground"),
        (lambda: rf.compare([SLENDER, WIDE], PULSES, {"A": "2DOF-S"}), "none for 'B'", "model"),
    ],
)
def test_bad_arguments(make, said, field):
    with pytest.raises(rf.InputError, match=said) as raised:
        make()
    assert field is None or raised.value.field == field


def test_a_run_that_fails_is_named():
    with pytest.raises(rf.SolverError, match=r"A under .*5DOF-S"):
        rf.compare([SLENDER, WIDE], PULSES, "5DOF-S")


def test_an_unknown_statistic(one):
    with pytest.raises(rf.InputError, match="median, p84") as raised:
        one.demands("average")
    assert raised.value.field == "statistic"


def test_the_figure_overlays_the_alternatives(several):
    figure = rf.plot_comparison(several, panels=["rotation", "base_shear"])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][:3] == ["slender", "wide", "tied"]
    assert "of 4" in legend.get_title().get_text()
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    looks = {(lines[name].get_color(), str(lines[name].get_linestyle())) for name in several.names}
    dashes = {str(lines[name]._dash_pattern) for name in several.names}
    assert len(looks) == len(dashes) == 3
    run = several.responses[2]
    np.testing.assert_array_equal(lines["tied"].get_ydata(), run.rotation)
    with pytest.raises(rf.InputError, match="Comparison"):
        rf.plot_comparison(run)


@pytest.mark.parametrize(
    ("units", "size", "name"),
    [("kip-in", 1.0, "rad"), ("kN", 1e-3, "mrad"), (None, 1e-3, "mrad")],
)
def test_the_drawn_alternatives_tell_their_rotation_in_the_units_of_the_report(one, units, size, name):
    with rf.figure_style(units=units):
        drawn = draw_alternatives(one, width=150.0, height=48.0)
    (axes,) = drawn.axes
    told = [text.get_text().split() for text in axes.texts if text.get_text().startswith("θ = ")]
    turns = [run.at(max(one.responses, key=lambda it: it.max_rotation).time_of_max_rotation).rotation[0]
             for run in one.responses]  # fmt: skip
    assert [each[3] for each in told] == [name, name]
    found = [float(each[2].replace("−", "-")) * size for each in told]
    np.testing.assert_allclose(found, turns, rtol=0.0, atol=5.1e-5)  # the last digit


@pytest.mark.slow
def test_the_report_has_all_alternatives(several, one, tmp_path):
    page = rf.write_report(several, tmp_path / "all.html", title="Three piers", notes="for the appendix")
    text = page.read_text("utf-8")
    for said in (
        "Three piers",
        "for the appendix",
        "of 4 records: median / 84 %",
        "Governing record",
        "tied to slender",
    ):
        assert said in text
    first, last = several.demands(), several.demands("p84")
    for name in several.names:
        for shown in (first.loc["max_rotation", name], last.loc["max_rotation", name]):
            assert f"{1e3 * shown:.3g}" in text
    single = rf.write_report(one, tmp_path / "one.html").read_text("utf-8")
    assert "A, B under" in single
    assert "Governing" not in single
    assert "2 springs" in single
    for given in ({"structure": SLENDER}, {"motion": PULSES[1]}, {"friction": 0.5}):
        with pytest.raises(rf.InputError, match="comparison") as raised:
            rf.write_report(one, tmp_path / "no.html", **given)
        assert raised.value.field == next(iter(given))
    assert not (tmp_path / "no.html").exists()


STRUCTURE = """
name = "{name}"
[frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = 1.0
period = 0.5
aspect_ratio = {ratio}
damping_ratio = 0.02
"""
GROUND = "[ground]\nmat_mass = 40e3\n[ground.bed]\nbreadth = 3.0\nsubgrade_modulus = 8e7\nheave_damping_ratio = 0.2\n"


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.toml").write_text(STRUCTURE.format(name="slender", ratio=8.0))
    (tmp_path / "b.toml").write_text(STRUCTURE.format(name="wide", ratio=5.0) + GROUND)
    return tmp_path


def invoke(*arguments):
    return CliRunner().invoke(app, ["compare", *arguments], env={"COLUMNS": "160"})


@pytest.mark.slow
def test_the_command_compares_files(files):
    result = invoke("a.toml", "b.toml", "el-centro-1940", "--report", "both.html")
    assert result.exit_code == 0, result.stderr
    assert "wide to slender" in result.stdout
    frames = [rf.read_structure(files / name) for name in ("a.toml", "b.toml")]
    bed = rf.winkler_bed(frames[1].rocking().half_width, 3.0, 8e7).damped(0.2, frames[1].rocking().m_tot)
    inertia = 40e3 * (2.0 * frames[1].rocking().half_width) ** 2 / 12.0
    own = {"wide": rf.Ground(springs=bed, base_inertia=inertia)}
    record = rf.load_suite("el-centro-1940")[0]
    expected = rf.compare(dict(zip(("slender", "wide"), frames, strict=True)), record, ground=own)
    found = json.loads(invoke("a.toml", "b.toml", "el-centro-1940", "--json").stdout)
    for demand, values in expected.demands("max").to_dict("index").items():
        assert found["demands"]["max"][demand] == pytest.approx(values, rel=1e-9)
    assert "wide to slender" in (files / "both.html").read_text("utf-8")
    assert invoke("a.toml", "b.toml", "el-centro-1940", "--report", "both.html").exit_code == 2  # exists


def test_the_command_tells_statistics_of_several_records(files):
    (files / "c.toml").write_text(STRUCTURE.format(name="slender", ratio=8.0))
    names = [f"fema-p695-far-field/FF-{k}-a" for k in (1, 2, 3)]
    result = invoke("a.toml", "c.toml", *names, "--model", "2DOF-S", "--scale", "1.5")
    assert result.exit_code == 0, result.stderr
    assert "3 records" in result.stdout
    assert "84 %" in result.stdout
    assert "c to a" in result.stdout  # files with the same name inside go by their own


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["a.toml", "el-centro-1940"], "2 to 6"),
        (["a.toml", "b.toml", "b.toml", "el-centro-1940"], "b.toml was given twice"),
        (["a.toml", "b.toml"], "No ground motion"),
        (["a.toml", "b.toml", "el-centro-1940", "--report", "x.txt"], "--report"),
        (["a.toml", "b.toml", "el-centro-1940", "--model", "XDOF"], "XDOF"),
        (["a.toml", "b.toml", "el-centro-1940", "--model", "MDOF-S,2DOF-S"], "one model"),
    ],
)
def test_wrong_commands(files, arguments, said):
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr


def test_no_share_of_alpha_where_tendons_leave_none():
    stiff = rf.Restrained(SLENDER, rf.Tendon(1e5, 5e7))
    found = rf.compare({"free": SLENDER, "tied": stiff}, PULSES[2], "2DOF-S")
    shares = found.demands().loc["balance_ratio"]
    assert shares["free"] > 0.0
    assert math.isnan(shares["tied"])
