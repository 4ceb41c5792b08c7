"""The figure of a design search, and its command."""

import json
import math

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from drawing import drawn, notes
from rockflex.cli._app import app

HEIGHT = 10.0
B = np.array([1.0, 1.5, 2.0, 2.5])
P = {"no tendon": [0.8, 0.4, 0.2, 0.1], "held": [0.5, 0.1, 0.02, 0.0]}


def designs(values=None, models=("MDOF-S",), limit=0.02, value="probability"):
    rows = []
    for model in models:
        for tendon, curve in (values or P).items():
            for b, p in zip(B, curve, strict=True):
                rows.append(
                    {
                        "model": model,
                        "tendon": tendon,
                        "half_width": b,
                        "aspect_ratio": HEIGHT / b,
                        "prestress_ratio": 0.0,
                        "stiffness_ratio": 0.0,
                        "limit": limit if isinstance(limit, float) else limit[1] * 0.7 * math.atan(b / HEIGHT),
                        value: p,
                        "low": 0.8 * p,
                        "high": 1.25 * p,
                    }
                )
    return pd.DataFrame(rows)


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


def test_curves_bands_and_answers():
    figure = drawn(rf.plot_design(designs(), 0.2))
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_title()) == ("half width $B$ [m]", "MDOF-S")
    assert axes.get_ylabel() == r"P($θ_{\mathrm{max}}>0.02\ \mathrm{rad}$)"
    for tendon, curve in P.items():
        ((line,),) = (lines(axes, tendon),)
        np.testing.assert_array_equal(np.column_stack(line.get_data()), np.column_stack((B, curve)))
    assert len(axes.collections) == 2
    box = axes.collections[0].get_paths()[0].get_extents()
    assert (box.y0, box.y1) == pytest.approx((0.08, 1.0))
    found = rf.smallest_width(designs(), 0.2)["half_width"].tolist()
    assert found[0] == pytest.approx(2.0)
    rings = [(line.get_xdata()[0], line.get_ydata()[0]) for line in lines(axes, "_answer")]
    assert rings == [(found[0], 0.2), (found[1], 0.2)]
    assert notes(axes) == ["B = 2 m", f"B = {found[1]:.3g} m"]
    (target,) = lines(axes, "_target")
    assert set(target.get_ydata()) == {0.2}
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.texts] == ["no tendon", "held", "target 0.2"]
    (top,) = axes.child_axes
    assert top.get_xlabel() == "$h^*_1/B$"
    assert [tick for tick in top.get_xticks() if tick in (4.0, 5.0, 10.0)] == [4.0, 5.0, 10.0]


def test_answers_that_are_none():
    values = {"never": [0.8, 0.7, 0.6, 0.5], "always": [0.1, 0.05, 0.02, 0.01], "twice": [0.4, 0.1, 0.3, 0.05]}
    (axes,) = drawn(rf.plot_design(designs(values), 0.2)).axes
    found = rf.smallest_width(designs(values), 0.2)["half_width"]
    assert notes(axes) == ["not met", "B ≤ 1 m", f"B = {found[2]:.3g} m (met more than once)"]
    assert len(lines(axes, "_answer")) == 1
    (axes,) = drawn(rf.plot_design(designs(values))).axes
    assert not notes(axes)
    assert not lines(axes, "_target")


@pytest.mark.slow
def test_rates_are_drawn_in_logarithms():
    table = designs(value="rate")
    (axes,) = drawn(rf.plot_design(table, 0.05)).axes
    assert axes.get_yscale() == "log"
    assert axes.get_ylabel() == r"annual rate of $θ_{\mathrm{max}}>0.02\ \mathrm{rad}$"
    (line,) = lines(axes, "held")
    np.testing.assert_array_equal(line.get_ydata(), P["held"][:3])  # no logarithm of zero
    assert axes.get_ylim()[0] == pytest.approx(0.01)
    (axes,) = drawn(rf.plot_design(table, logarithmic=False)).axes
    assert axes.get_yscale() == "linear"
    tiny = designs({"x": [1e-2, 1e-4, 1e-9, 1e-12]}, value="rate")
    assert drawn(rf.plot_design(tiny, 1e-3)).axes[0].get_ylim()[0] == pytest.approx(0.5e-7)


def test_limits_by_their_names_and_a_panel_a_model():
    figure = drawn(rf.plot_design(designs(limit=("nominal", 0.5), models=("MDOF-S", "2DOF-S")), 0.2))
    assert [axes.get_title() for axes in figure.axes] == ["MDOF-S", "2DOF-S"]
    assert figure.axes[0].get_ylabel() == r"P($θ_{\mathrm{max}}>0.5\cdot0.7\,\mathrm{atan}(B/h^*_1)$)"
    table = designs(limit=("nominal", 1.0))
    assert r"}>0.7\,\mathrm{atan}" in drawn(rf.plot_design(table)).axes[0].get_ylabel()
    assert drawn(rf.plot_design(designs(limit=math.pi / 2))).axes[0].get_ylabel() == "P(overturning)"


@pytest.mark.slow
def test_gaps_and_single_designs():
    table = designs().assign(low=np.nan, high=np.nan)
    table.loc[1, "probability"] = np.nan
    (axes,) = drawn(rf.plot_design(table, 0.3)).axes
    assert len(lines(axes, "no tendon")[0].get_xdata()) == 3
    (axes,) = drawn(rf.plot_design(designs()[:1], 0.9)).axes
    assert notes(axes) == ["B ≤ 1 m"]
    drawn(rf.plot_design(designs({"none": [0.0] * 4}, value="rate")))
    drawn(rf.plot_design(designs().assign(probability=np.nan, low=np.nan, high=np.nan, limit=np.nan)))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (designs().drop(columns="low"), "The table lacks low"),
        (designs()[:0], "has no rows. Give what design_table returned"),
        (designs({f"T{i}": [0.1] * 4 for i in range(16)}), "16 tendons are too many"),
        (designs().assign(limit=[0.01, 0.02] * 4), "limits of several kinds"),
    ],
)
def test_what_cannot_be_drawn(table, said):
    with pytest.raises(rf.InputError, match=said):
        rf.plot_design(table)


# The command line

STUDY = """
study = "design"
half_widths = [0.8, 1.2, 1.8]
scales = [1.0, 2.0]
limits = ["0.3 nominal", 0.02]
{question}
[records]
suites = ["fema-p695-far-field"]
include = ["FF-1-*", "FF-2-*", "FF-3-*"]
{hazard}
[[structures]]
frame = {{n_stories = 2, story_height = 3.0, story_mass = 40e3, base_mass = 40e3, stiffness_ratio = inf, period = 0.5, \
aspect_ratio = 8, damping_ratio = 0.02}}
[[tendons]]
name = "free"
[[tendons]]
prestress_ratio = 0.3
stiffness_ratio = 0.5
yield_ratio = 0.6
name = "held"
"""
HAZARD = "[hazard]\nim = [0.05, 0.2, 0.8]\nrate = [0.1, 1e-2, 2e-4]"


def invoke(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "240"})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("question", "hazard", "words", "target"),
    [
        ("level = 0.5\ntarget = 0.3", "", "P at pgv = 0.5", 0.3),
        ("target = 1e-3", HAZARD, "annual rate", 1e-3),
        ("level = 0.5", "", "P at pgv = 0.5", None),
    ],
)
def test_a_design_study_is_run_kept_told_and_drawn(tmp_path, question, hazard, words, target):
    file, folder = tmp_path / "design.toml", tmp_path / "kept"
    file.write_text(STUDY.format(question=question, hazard=hazard), "utf-8")
    done = invoke("design", file, "--out", folder)
    assert done.exit_code == 0, done.stderr
    assert f"Designs, and the {words} of exceeding each limit; medians of all runs" in done.stdout
    assert "72 rows in" in done.stdout
    document = json.loads(invoke("design", file, "--json").stdout)
    (rows, *widths) = (value for key, value in document.items() if key.startswith(("Designs", "Least")))
    table = rf.run_study(file)
    curve = rf.HazardCurve([0.05, 0.2, 0.8], [0.1, 1e-2, 2e-4]) if hazard else None
    for limit, word in (("0.3 nominal", "0.3 nominal"), (0.02, "0.02 rad")):
        expected = rf.design_table(table, limit, at=None if hazard else 0.5, hazard=curve)
        values = expected["rate" if hazard else "probability"]
        assert [row[word] for row in rows] == values.tolist()
        assert [row[f"{word}, high"] for row in rows] == expected["high"].tolist()
        if target is not None:
            least = rf.smallest_width(expected, target)
            mine = [row for row in widths[0] if row["limit"] == word]
            assert [row["outcome"] for row in mine] == least["outcome"].tolist()
            found = [math.nan if row["B [m]"] is None else row["B [m]"] for row in mine]
            np.testing.assert_array_equal(found, least["half_width"])
    assert bool(widths) == (target is not None)
    figures = invoke("figures", folder)
    assert figures.exit_code == 0, figures.stderr
    names = sorted(path.name for path in (folder / "figures").iterdir())
    assert names == ["design_0.02_rad.png", "design_0.3_nominal.png", "summary.json"]


def test_the_command_of_another_study(tmp_path):
    file = tmp_path / "design.toml"
    file.write_text(STUDY.format(question="level = 0.5", hazard=""), "utf-8")
    done = invoke("cloud", file)
    assert done.exit_code == 2
    assert f'{file} has study = "design". Use rockflex design {file}.' in done.stderr
    assert "72 runs in 1 part, 6 records; about" in invoke("design", file, "--dry-run").stdout
    assert "rockflex design study.toml --dry-run" in invoke("design", "--help").stdout
