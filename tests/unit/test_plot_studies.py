import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex
from scipy.optimize import minimize
from typer.testing import CliRunner

import rockflex as rf
from drawing import drawn, notes
from rockflex.cli import app
from rockflex.fragility import fit_clouds, fit_stripes
from rockflex.plot._style import BLACK, BLUE, RED
from rockflex.study.plans import load_study, population_statistics, run_cloud, run_incremental, run_population

SUITE = rf.load_suite("fema-p695-far-field")
FRAMES = {
    "#1": rf.Frame(5, 3.0, 40e3, 40e3, np.inf, 1.0, 10.0, 0.02),
    "#5": rf.Frame(5, 3.0, 40e3, 40e3, np.inf, 1.0, 5.0, 0.02),
    "a$b": rf.Frame(5, 3.0, 40e3, 40e3, 0.0, 1.0, 5.0, 0.02),
}
MODELS = ["MDOF-S", "2DOF-S"]
COLORS = {"MDOF-S": BLACK, "2DOF-S": RED}


@pytest.fixture(scope="module")
def cloud():
    return run_cloud(FRAMES, list(SUITE)[:16], MODELS, [0.3, 1.0, 2.5])


@pytest.fixture(scope="module")
def pairs():
    return run_population(SUITE, 120, 7)


@pytest.fixture(scope="module")
def ladders():
    return run_incremental({"#1": FRAMES["#1"]}, list(SUITE)[:8], "2DOF-S", 0.2, 12.0, 1.2)


@pytest.fixture(scope="module")
def stripes():
    """Made-up outcomes: of ten runs at each level 0, 2, 5 and 9 overturn."""
    rows = [
        {"level": level, "structure": "#1", "model": "MDOF-S", "status": "overturned" if i < falls else "rocking"}
        for level, falls in ((0.5, 0), (1.0, 2), (1.5, 5), (2.5, 9))
        for i in range(10)
    ]
    table = pd.DataFrame(rows)
    table["max_rotation"] = np.where(table["status"] == "overturned", np.pi / 2, 0.01)
    return table.assign(nominal_overturning=table["status"] == "overturned")


def lines(axes, label):
    return [line for line in axes.get_lines() if line.get_label() == label]


def points(lines):
    found = np.concatenate([np.column_stack(line.get_data()) for line in lines])
    return found[np.lexsort(found.T)]


def of(table, structure, model):
    return table[(table["structure"] == structure) & (table["model"] == model)]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


# Fig. 5


def test_fragility_curves_are_the_most_likely_logistic_ones(cloud):
    figure = drawn(rf.plot_fragility(cloud))
    assert [axes.get_title() for axes in figure.axes] == ["#1", "#5", r"a\$b"]
    assert legend(figure) == [*MODELS, "no runs"]
    for axes, structure in zip(figure.axes, FRAMES, strict=True):
        for model in MODELS:
            runs = of(cloud, structure, model)
            x, rocks = np.log(runs["pgv"].to_numpy()), (runs["max_rotation"] > 1e-4).to_numpy()

            def cost(b, x=x, rocks=rocks):
                return np.logaddexp(0.0, np.where(rocks, -1.0, 1.0) * (b[0] + b[1] * x)).sum()

            b0, b1 = minimize(cost, (1.0, 1.0), method="BFGS", options={"gtol": 1e-9}).x
            (line,) = lines(axes, model)
            assert to_hex(line.get_color()) == COLORS[model]
            im, p = line.get_data()
            np.testing.assert_allclose(p, 1.0 / (1.0 + np.exp(-(b0 + b1 * np.log(im)))), atol=1e-5)
        (shade,) = [patch for patch in axes.patches if patch.get_label() == "_no runs"]
        assert shade.get_extents().transformed(axes.transData.inverted()).x1 == pytest.approx(cloud["pgv"].min())


def test_fragility_with_bands_overturning_and_observed_fractions(cloud):
    runs = cloud[cloud["structure"] == "#1"]
    figure = drawn(rf.plot_fragility(runs, "sa_t1", level=0.8, overturning=True, bins=5))
    (axes,) = figure.axes
    assert axes.get_xlabel() == r"$S_a(T_1)$ [m/s²]"
    assert axes.get_xlim()[1] == pytest.approx(runs["sa_t1"].max())
    assert legend(figure) == [*MODELS, "observed", "overturning", "no runs"]
    fit = fit_clouds(runs, "sa_t1")[0]
    im = lines(axes, "MDOF-S")[0].get_xdata()
    fallen = lines(axes, "_overturning")[0].get_ydata()
    np.testing.assert_array_equal(fallen, fit.outcomes.overturning.probability(im))
    low, high = fit.outcomes.overturning.band(im, 0.8)
    bands = [area for area in axes.collections if area.get_label() == "_band"]
    assert len(bands) == 4
    extent = bands[1].get_paths()[0].get_extents()
    assert (extent.y0, extent.y1) == pytest.approx((low.min(), high.max()))
    for mark, model in zip(lines(axes, "_observed"), MODELS, strict=True):
        mine = of(runs, "#1", model).sort_values("sa_t1")
        groups = np.array_split(np.arange(len(mine)), 5)
        expected = [(mine["max_rotation"].iloc[group] > 1e-4).mean() for group in groups]
        np.testing.assert_allclose(mark.get_ydata(), expected)
        inside = mark.get_xdata()[1]
        assert mine["sa_t1"].iloc[groups[1][0]] < inside < mine["sa_t1"].iloc[groups[1][-1]]


def test_fragility_of_fits_alone_with_another_threshold(cloud):
    fits = fit_clouds(cloud, "pga", threshold=2.5e-3)
    figure = drawn(rf.plot_fragility(fits, overturning=True))
    assert figure.axes[0].get_ylabel() == "probability"
    figure = drawn(rf.plot_fragility(fits))
    assert figure.axes[0].get_ylabel() == r"$P(θ_{\mathrm{max}}>2.5\times10^{-3}\ \mathrm{rad})$"
    assert figure.axes[0].get_xlabel() == "PGA [m/s²]"
    assert legend(figure) == MODELS
    reached = [line.get_ydata()[-1] for axes in figure.axes for line in axes.get_lines()]
    assert max(reached) >= min(reached) >= 0.99


def test_where_none_rocks_the_line_is_flat_and_the_cloud_empty(cloud):
    still = cloud[cloud["max_rotation"] <= 1e-4]
    axes = drawn(rf.plot_fragility(still, level=0.9, overturning=True, bins=3)).axes[0]
    assert not lines(axes, "MDOF-S")[0].get_ydata().any()
    for quantity in ("max_rotation", "max_top_displacement"):
        figure = drawn(rf.plot_clouds(still, quantity))
        axes = figure.axes[0]
        assert not lines(axes, "MDOF-S")
        assert notes(axes)[1].split() == ["MDOF-S", "–", "–", "–", "0", "0"]
        assert legend(figure) == MODELS


# Figs. 6 and 7


@pytest.mark.parametrize("quantity", ["max_rotation", "max_top_displacement"])
def test_clouds_hold_the_runs_that_rocked_and_stand(cloud, quantity):
    figure = drawn(rf.plot_clouds(cloud, quantity))
    assert cloud["status"].eq("overturned").any()
    assert legend(figure) == [*MODELS, "overturned"]
    for axes, structure in zip(figure.axes, FRAMES, strict=True):
        assert axes.get_xscale() == axes.get_yscale() == "log"
        crosses = lines(axes, "_overturned")
        for model, cross in zip(MODELS, crosses, strict=True):
            runs = of(cloud, structure, model)
            rocked = runs[(runs["status"] == "rocking") & (runs["max_rotation"] > 1e-4)]
            expected = rocked[["pgv", quantity]].to_numpy()
            np.testing.assert_array_equal(points(lines(axes, f"_{model}")), expected[np.lexsort(expected.T)])
            c2, c1 = np.polyfit(np.log(rocked["pgv"]), np.log(rocked[quantity]), 1)
            (line,) = lines(axes, model)
            np.testing.assert_allclose(line.get_ydata(), np.exp(c1) * line.get_xdata() ** c2, rtol=1e-9)
            fallen = runs[runs["status"] == "overturned"]
            np.testing.assert_array_equal(cross.get_xdata(), fallen["pgv"])
            residuals = np.log(rocked[quantity]) - c1 - c2 * np.log(rocked["pgv"])
            sigma = np.sqrt((residuals**2).sum() / (len(rocked) - 2))
            written = [text.split() for text in notes(axes) if text.split()[0] == model]
            assert written == [[model, f"{c1:.2f}", f"{c2:.2f}", f"{sigma:.2f}", str(len(rocked)), str(len(fallen))]]
        inside = axes.get_ylim()
        shown = np.concatenate([line.get_ydata() for model in MODELS for line in lines(axes, f"_{model}")])
        assert inside[0] < shown.min() <= shown.max() < inside[1]
        # the highest point stays below the lowest row of crosses
        lowest = axes.transAxes.transform((0.0, crosses[-1].get_ydata().min(initial=1.0)))[1]
        assert axes.transData.transform((1.0, shown.max()))[1] < lowest


def test_nominal_overturning_and_failed_runs_are_counted(cloud):
    runs = of(cloud, "#1", "2DOF-S").copy()
    rocking = runs.index[runs["status"] == "rocking"]
    results = ["status", "max_rotation", "max_top_displacement", "nominal_overturning"]
    runs.loc[rocking[:2], results] = pd.NA
    axes = drawn(rf.plot_clouds(runs, nominal=True)).axes[0]
    (numbers,) = [text.split() for text in notes(axes) if "2DOF-S" in text]
    assert numbers[5:] == [str(int(runs["nominal_overturning"].sum())), "(2", "failed)"]
    axes = drawn(rf.plot_fragility(runs)).axes[0]
    assert notes(axes) == ["2 failed"]


# Fig. 8


def test_population_bars_count_the_pairs(pairs):
    figure = drawn(rf.plot_population(pairs))
    shear, flexure = ((pairs["behaviour"] == name).sum() for name in ("shear", "flexure"))
    assert legend(figure) == [rf"shear, $ρ=\infty$ ({shear})", rf"flexure, $ρ=0$ ({flexure})"]
    names = ["n_stories", "aspect_ratio", "base_mass_ratio", "period", "height", "pgv"]
    for axes, name in zip(figure.axes, names, strict=True):
        tops = {}
        for bars, behaviour in zip(axes.containers, ("shear", "flexure"), strict=True):
            values = pairs[name][pairs["behaviour"] == behaviour].to_numpy(float)
            assert sum(bar.get_height() for bar in bars) == len(values)
            for bar in bars:
                middle = bar.get_x() + 0.5 * bar.get_width()
                if name not in ("period", "pgv"):
                    assert bar.get_height() == np.isclose(values, middle).sum()
                assert bar.get_y() == tops.get(round(middle, 9), 0)
                tops[round(middle, 9)] = bar.get_height()
    drawn(rf.plot_population(pairs[:1]))


# Fig. 9


def test_agreement_shows_every_pair_that_stands(pairs):
    figure = drawn(rf.plot_agreement(pairs))
    statistics = population_statistics(pairs, n_resamples=20).agreement
    resting = pairs[pairs["status_mdof"] == "no_uplift"]
    rocking = pairs[(pairs["status_mdof"] == "rocking") & (pairs["status_2dof"] != "overturned")]
    shown = [("no_uplift", resting, "top_displacement")]
    shown += [("rocking", rocking, name) for name in ("top_displacement", "rotation")]
    for axes, (group, rows, quantity) in zip(figure.axes[:3], shown, strict=True):
        drawn_of = {marks.get_label(): marks for marks in axes.collections}
        for (behaviour, ratio), some in rows.groupby(["behaviour", "aspect_ratio"], observed=True):
            marks = drawn_of.pop(f"_{behaviour} {ratio:g}")
            expected = some[[f"max_{quantity}_2dof", f"max_{quantity}_mdof"]]
            np.testing.assert_array_equal(marks.get_offsets(), expected)
            np.testing.assert_array_equal(marks.get_array(), some["period"])
            assert marks.cmap.name == {"shear": "Reds", "flexure": "Blues"}[behaviour]
            assert (marks.norm.vmin, marks.norm.vmax) == (pairs["period"].min(), pairs["period"].max())
            np.testing.assert_array_equal(np.argsort(marks.get_sizes()), np.argsort(some["n_stories"]))
        assert not drawn_of
        told = statistics[(statistics["group"] == group) & (statistics["quantity"] == quantity)].set_index("behaviour")
        assert notes(axes)[0] == (
            f"R² = {told['r2']['all']:.2f}, n = {len(rows)}\n$c_1$ = {told['slope']['shear']:.2f}, shear\n"
            f"$c_1$ = {told['slope']['flexure']:.2f}, flexure"
        )
        ((x, y),) = [line.get_data() for line in lines(axes, "_equal")]
        np.testing.assert_array_equal(x, y)
    key = figure.axes[3]
    titles = [artist.get_title().get_text() for artist in key.artists]
    assert titles == [r"$h^*_1/B$", "stories"]
    assert [text.get_text() for text in key.artists[0].get_texts()] == ["5", "6", "7", "8", "9", "10"]


def test_pairs_without_results_are_told_and_empty_groups_drawn(pairs):
    some = pairs[:8].copy()
    some["status_mdof"] = ["rocking"] * 5 + ["overturned"] * 2 + [None]
    some["status_2dof"] = ["rocking"] * 4 + ["overturned", "rocking", "rocking", "rocking"]
    figure = drawn(rf.plot_agreement(some))
    assert notes(figure.axes[3]) == ["left out: 3 overturned, 1 failed"]
    assert notes(figure.axes[0])[0].startswith("R² = –, n = 0\n$c_1$ = –, shear")
    figure = drawn(rf.plot_modal_combination(some))
    assert figure.legends[0].get_title().get_text() == "4 rocking pairs; left out: 3 overturned, 1 failed"
    none = drawn(rf.plot_modal_combination(some[4:7]))
    assert none.legends[0].get_title().get_text() == "0 rocking pairs; left out: 3 overturned"
    assert not lines(none.axes[0], "_regression")
    one = drawn(rf.plot_agreement(pairs[pairs["behaviour"] == "shear"]))
    assert "$c_1$ = –, flexure" in notes(one.axes[1])[0]


# Fig. 13


def test_modal_combination_is_the_root_of_the_sum_of_squares(pairs):
    figure = drawn(rf.plot_modal_combination(pairs))
    rows = pairs[(pairs["status_mdof"] == "rocking") & (pairs["status_2dof"] != "overturned")]
    weight, moment = rows["structure_mass"] * 9.81, rows["l0r_g"]
    second = rows["effective_mass_2"] * rows["sa_2"]
    one = {name: rows[f"max_{name}_2dof"] for name in ("top_displacement", "base_shear", "base_moment")}
    expected = [
        (rows["sd_2"], rows["max_second_displacement_mdof"], None),
        (
            np.hypot(one["top_displacement"], rows["top_ordinate_2"] * rows["sd_2"]),
            rows["max_top_displacement_mdof"],
            one["top_displacement"],
        ),
        (
            np.hypot(one["base_shear"], second) / weight,
            rows["max_base_shear_mdof"] / weight,
            one["base_shear"] / weight,
        ),
        (
            np.hypot(one["base_moment"], rows["effective_height_2"] * second) / moment,
            rows["max_base_moment_mdof"] / moment,
            one["base_moment"] / moment,
        ),
    ]
    for axes, (x, y, alone) in zip(figure.axes, expected, strict=True):
        for behaviour in ("shear", "flexure"):
            mine = rows["behaviour"] == behaviour
            found = np.column_stack(lines(axes, f"_{behaviour}")[0].get_data())
            np.testing.assert_allclose(found, np.column_stack((x[mine], y[mine])), rtol=1e-12)
        c1 = float(np.linalg.lstsq(np.asarray(x)[:, None], np.asarray(y))[0][0])
        (line,) = lines(axes, "_regression")
        assert to_hex(line.get_color()) == BLUE
        np.testing.assert_allclose(line.get_ydata(), c1 * line.get_xdata())
        told = [f"R² = {1.0 - ((y - x) ** 2).sum() / ((y - y.mean()) ** 2).sum():.2f}".replace("-", "−")]
        if alone is not None:
            r2 = 1.0 - ((y - alone) ** 2).sum() / ((y - y.mean()) ** 2).sum()
            told.append(f"(2DOF-S alone: {r2:.2f})".replace("-0", "−0"))
        assert notes(axes)[0] == "\n".join([*told, f"$y$ = {c1:.2f} $x$"])


# Incremental analysis and stripes


def test_ida_curves_break_where_runs_overturn(ladders):
    figure = drawn(rf.plot_ida(ladders, "pgv"))
    left, right = figure.axes
    assert (left.get_title(), right.get_xlabel()) == ("#1, 2DOF-S", "PGV [m/s]")
    curves, again, first = lines(left, "_record"), [], []
    by_record = list(ladders.groupby("record", observed=True, sort=False))
    for curve, (_, rows) in zip(curves, by_record, strict=True):
        fell = rows["overturned"].to_numpy(bool)
        np.testing.assert_array_equal(curve.get_xdata()[1:], rows["pgv"])
        np.testing.assert_array_equal(curve.get_ydata()[1:], np.where(fell, np.nan, rows["max_rotation"]))
        pgv = rows["pgv"] / rows["scale"]
        if fell.any():
            first.append((pgv * rows["first_overturning_scale"]).iloc[0])
            later = rows[~fell & (rows["scale"] > rows["first_overturning_scale"])]
            again.append(later[["pgv", "max_rotation"]].to_numpy())
    again = np.concatenate(again)
    assert len(again)
    np.testing.assert_array_equal(points(lines(left, "_resurrected")), again[np.lexsort(again.T)])
    assert all(line.get_markerfacecolor() == "white" for line in lines(left, "_resurrected"))
    found = np.sort([line.get_xdata()[0] for line in lines(left, "_overturned")])
    np.testing.assert_allclose(found, np.sort(first))

    assert len(first) == len(by_record), "the steps below are those of a sample without censoring"
    (steps,) = lines(right, "_ecdf")
    np.testing.assert_allclose(steps.get_xdata()[1:], np.sort(first))
    np.testing.assert_allclose(steps.get_ydata()[1:], np.arange(1, len(first) + 1) / len(first))
    (fit,) = lines(right, "_fit")
    median, beta = np.exp(np.mean(np.log(first))), np.std(np.log(first), ddof=1)
    assert np.interp(median, *fit.get_data()) == pytest.approx(0.5, abs=1e-3)
    resurrected = sum(rows["resurrections"].iloc[0] > 0 for _, rows in by_record)
    assert notes(right)[0].splitlines() == [
        f"{len(first)} records",
        f"median {median:.3g}, β = {beta:.2f}",
        f"{resurrected} with resurrections",
    ]


def test_ida_of_records_that_never_overturn(ladders):
    weak = ladders[ladders["scale"] < 0.5].copy()
    weak["overturned"], weak["status"] = pd.array([False] * len(weak), dtype="boolean"), "rocking"
    weak["first_overturning_scale"], weak["resurrections"] = np.nan, 0
    weak.loc[weak.index[:1], "overturned"] = pd.NA
    left, right = drawn(rf.plot_ida(weak, level=None)).axes
    assert not lines(left, "_overturned")
    assert not lines(right, "_fit")
    assert notes(right)[0].splitlines() == [
        "8 records, 8 never overturned",
        "0 with resurrections",
        "1 runs failed",
    ]


def test_censored_records_count_as_long_as_they_stood(ladders):
    """Kaplan-Meier by hand: each step is the fraction still standing times 1 over those at risk."""
    names = list(dict.fromkeys(ladders["record"]))
    rows = ladders.copy()
    stopped = rows["record"].isin(names[:2]) & rows["overturned"]
    rows = rows[~stopped & ~(rows["record"].isin(names[:2]) & (rows["scale"] > rows["first_overturning_scale"]))]
    right = drawn(rf.plot_ida(rows)).axes[1]
    ends = []
    for name in names:
        mine = rows[rows["record"] == name]
        falls = mine[mine["overturned"]]
        ends.append((falls["pga"].iloc[0], True) if len(falls) else (mine["pga"].iloc[-1], False))
    standing, fraction, steps = len(ends), 1.0, []
    for end, fell in sorted(ends):
        fraction *= 1.0 - fell / standing
        standing -= 1
        steps.append((end, 1.0 - fraction))
    (line,) = lines(right, "_ecdf")
    drawn_at = np.column_stack(line.get_data())[1:]
    np.testing.assert_allclose(drawn_at, [step for step in steps if step[0] in drawn_at[:, 0]])
    assert drawn_at[-1, 1] == pytest.approx(steps[-1][1])
    assert notes(right)[0].startswith("8 records, 2 never overturned")


def test_stripes_with_their_curve(stripes):
    figure = drawn(rf.plot_stripes(stripes, measure="pgv"))
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("PGV [m/s]", "P(overturning)")
    (marks,) = lines(axes, "_MDOF-S")
    np.testing.assert_allclose(np.column_stack(marks.get_data()), [(0.5, 0.0), (1.0, 0.2), (1.5, 0.5), (2.5, 0.9)])
    fit = fit_stripes([0.5, 1.0, 1.5, 2.5], [0, 2, 5, 9], [10] * 4)
    (curve,) = lines(axes, "MDOF-S")
    np.testing.assert_allclose(curve.get_ydata(), fit.probability(curve.get_xdata()))
    assert notes(axes) == [f"median {fit.median:.3g}, β = {fit.beta:.2f}"]
    assert len(axes.collections) == 1
    axes = drawn(rf.plot_stripes(stripes[stripes["level"] < 1.0], 0.005, level=None)).axes[0]
    assert axes.get_ylabel() == r"$P(θ_{\mathrm{max}}>0.005\ \mathrm{rad})$"
    assert notes(axes) == ["no curve fits"]
    assert not axes.collections


# What cannot be drawn


def renamed(table, column, count):
    """As many copies of the first rows, each with another name."""
    return pd.concat([table[:6].assign(**{column: f"n{i}"}) for i in range(count)], ignore_index=True)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda cloud, *_: rf.plot_fragility([]),
            "clouds must be the table of a cloud study, or at least one fit of it from fit_clouds.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(cloud[:0]),
            "The table has no rows. Give what run_cloud returned.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), "pga"),
            "The fits are of pgv, but 'pga' is to be shown. Fit the clouds with that one.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility([*fit_clouds(cloud), *fit_clouds(cloud, "pga")]),
            "The fits are of pgv, pga, but one measure is to be shown. Fit the clouds with that one.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), bins=4),
            "bins counts runs, but only fits were given. Give the table of the study.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(renamed(cloud, "structure", 13)),
            "13 structures are too many for one figure; 12 fit. Plot fewer at a time.",
        ),
        (
            lambda cloud, *_: rf.plot_clouds(cloud, "max_base_shear"),
            "quantity must be one of max_rotation, max_top_displacement, but 'max_base_shear' was given.",
        ),
        (
            lambda cloud, *_: rf.plot_clouds(cloud, measure="pgw"),
            "The table lacks pgw. Give what run_cloud returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_population(pairs.drop(columns="pgv")),
            "The table lacks pgv. Give what run_population returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(status_mdof=None)),
            "No pair was solved. See the column error of the table.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(aspect_ratio=np.arange(120.0))),
            "120 aspect ratios were given, but there are 15 symbols. Plot some of them.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_modal_combination(pairs.drop(columns=["sd_2", "srss_base_shear"])),
            "The table lacks sd_2, srss_base_shear. Give what run_population returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_ida(cloud),
            "The table lacks overturned, resurrections, first_overturning_scale, last_survival_scale. "
            "Give what run_incremental returned.",
        ),
        (
            lambda cloud, pairs, ladders: rf.plot_ida(renamed(ladders, "structure", 7)),
            "7 structures and models are too many for one figure; 6 fit. Plot fewer at a time.",
        ),
        (
            lambda cloud, *_: rf.plot_stripes(cloud),
            "The table lacks level. Give the table of a stripe study.",
        ),
        (
            lambda cloud, *_: rf.plot_stripes(cloud.assign(level=1.0, status=None)),
            "No run was solved. See the column error of the table.",
        ),
    ],
)
def test_what_cannot_be_drawn_is_named(cloud, pairs, ladders, call, message):
    with pytest.raises(rf.InputError) as caught:
        call(cloud, pairs, ladders)
    assert str(caught.value) == message


# The command line

FRAME = """
[[structures]]
frame = {n_stories = 5, story_height = 3.0, story_mass = 40e3, base_mass = 40e3, stiffness_ratio = inf, period = 1.0,
         aspect_ratio = 10, damping_ratio = 0.02}
""".replace(",\n        ", ",")
RECORDS = 'records = {suites = ["fema-p695-far-field"], include = ["FF-1*"]}\n'
STUDIES = {
    "cloud": ("scales = [0.2, 1.0]\n" + RECORDS + FRAME, ["fragility", "rotation", "top_displacement"]),
    "incremental": ('models = ["2DOF-S"]\ngrowth = 1.5\ntolerance = 0.1\n' + RECORDS + FRAME, ["capacities"]),
    "stripes": ('levels = [0.5, 1.0, 2.0]\nmeasure = "pgv"\n' + RECORDS + FRAME, ["stripes"]),
    "population": ("pairs = 12\n" + RECORDS, ["agreement", "modal_combination", "population"]),
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
            f"--measure is for cloud and incremental studies, but {folder} holds one of stripes. Leave it out.",
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
