"""Fragility: clouds, curves, and incremental dynamic analyses."""

import re

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex
from scipy.optimize import minimize

import rockflex as rf
from drawing import drawn, legend, notes
from drawn_studies import COLORS, FRAMES, MODELS, lines, of, points
from rockflex.fragility import fit_clouds, fit_stripes

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
    figure = drawn(rf.plot_fragility(runs, "sa_t1", confidence=0.8, overturning=True, bins=5))
    (axes,) = figure.axes
    assert axes.get_xlabel() == r"$S_a(T_1,ζ_1)$ [m/s²]"
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


def test_structures_can_share_a_panel(cloud):
    figure = drawn(rf.plot_fragility(cloud, together=[("#5", "#1"), ["a$b"]]))
    both, alone = figure.axes
    assert both.get_title() == "#5, #1"
    apart = drawn(rf.plot_fragility(cloud)).axes
    for model in MODELS:
        thick, thin = lines(both, model)
        assert thick.get_linewidth() > thin.get_linewidth()
        np.testing.assert_array_equal(thick.get_ydata(), lines(apart[1], model)[0].get_ydata())
        np.testing.assert_array_equal(thin.get_ydata(), lines(apart[0], model)[0].get_ydata())
        assert len(lines(alone, model)) == 1
    assert {"#1", "#5"} <= set(notes(both))
    for wrong in ([("#1", "#5")], [("#1", "#5"), ("#1", "a$b")]):
        with pytest.raises(rf.InputError, match="together must have each structure once"):
            rf.plot_fragility(cloud, together=wrong)


def test_fragility_of_fits_alone_with_another_threshold(cloud):
    fits = fit_clouds(cloud, "pga", threshold=2.5e-3)
    figure = drawn(rf.plot_fragility(fits, overturning=True))
    assert figure.axes[0].get_ylabel() == "probability"
    figure = drawn(rf.plot_fragility(fits))
    assert figure.axes[0].get_ylabel() == r"$P(\mathrm{uplift},\ θ_{\mathrm{max}}>2.5\times10^{-3}\ \mathrm{rad})$"
    assert figure.axes[0].get_xlabel() == "PGA [m/s²]"
    assert legend(figure) == [*MODELS, "no runs"]
    reached = [line.get_ydata()[-1] for axes in figure.axes for line in axes.get_lines()]
    assert max(reached) >= min(reached) >= 0.99


@pytest.mark.slow
def test_where_none_rocks_the_line_is_flat_and_the_cloud_empty(cloud):
    still = cloud[cloud["max_rotation"] <= 1e-4]
    axes = drawn(rf.plot_fragility(still, confidence=0.9, overturning=True, bins=3)).axes[0]
    assert not lines(axes, "MDOF-S")[0].get_ydata().any()
    for quantity in ("max_rotation", "max_top_displacement"):
        figure = drawn(rf.plot_clouds(still, quantity))
        axes = figure.axes[0]
        assert not lines(axes, "MDOF-S")
        assert notes(axes)[1].split() == ["MDOF-S", "–", "–", "–", "0", "0"]
        assert legend(figure) == MODELS


# Figs. 6 and 7


@pytest.mark.slow
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


def test_a_plain_cloud_ends_at_its_points(cloud):
    kept = cloud[(cloud["status"] == "rocking") & (cloud["max_rotation"] > 1e-4)]
    full, plain = (drawn(rf.plot_clouds(cloud, plain=each)) for each in (False, True))
    low, high = np.log(plain.axes[0].get_ylim())
    least, most = np.log(kept["max_rotation"].agg(["min", "max"]))
    assert low < least < most < high
    assert (most - least) / (high - low) > 0.85
    assert np.ptp(np.log(full.axes[0].get_ylim())) > 1.3 * (high - low)
    assert "overturned" not in legend(plain)
    for axes, model in ((axes, model) for axes in plain.axes for model in MODELS):
        assert not lines(axes, "_overturned")[MODELS.index(model)].get_xdata().size
    assert not any("σ" in text for axes in plain.axes for text in notes(axes))


def test_a_cloud_without_a_fit_is_points_and_says_so(cloud):
    """Of one motion, no line; a model without any solved run has its row alone."""
    one = of(cloud, "#1", "MDOF-S").nlargest(1, "pgv").assign(status="rocking", max_rotation=0.02)
    none = of(cloud, "#1", "2DOF-S")[:3].assign(status=pd.NA, max_rotation=np.nan)
    axes = drawn(rf.plot_clouds(pd.concat([one, none]))).axes[0]
    assert points(lines(axes, "_MDOF-S")).tolist() == [[one["pgv"].iloc[0], 0.02]]
    assert not lines(axes, "MDOF-S")
    assert [text.rstrip() for text in notes(axes)] == [
        "   2DOF-S     –     –     –    0   0 (3 failed, no fit)",
        "   MDOF-S     –     –     –    1   0 (no fit)",
        "             c₁    c₂     σ    n  OV",
    ]
    assert len({len(text) for text in notes(axes)}) == 1  # the columns stand below each other
    left, right = axes.get_xlim()
    assert right / left == pytest.approx(4.0)  # wide enough for a label of 1, 2 or 5


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


def renamed(table, column, count):
    """As many copies of the first rows, each with another name."""
    return pd.concat([table[:6].assign(**{column: f"n{i}"}) for i in range(count)], ignore_index=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda cloud, *_: rf.plot_fragility([]), "or at least one fit of it from fit_clouds"),
        (lambda cloud, *_: rf.plot_fragility(cloud[:0]), "has no rows. Give what run_cloud returned"),
        (lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), "pga"), "of pgv, but 'pga' is to be shown"),
        (
            lambda cloud, *_: rf.plot_fragility([*fit_clouds(cloud), *fit_clouds(cloud, "pga")]),
            "of pgv, pga, but one measure is to be shown",
        ),
        (lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), bins=4), "bins counts runs, but only fits were given"),
        (lambda cloud, *_: rf.plot_fragility(renamed(cloud, "structure", 13)), "13 structures are too many"),
        (lambda cloud, *_: rf.plot_clouds(cloud, "max_base_shear"), "quantity must be one of max_rotation, "),
        (lambda cloud, *_: rf.plot_clouds(cloud, measure="pgw"), "The table lacks pgw"),
        (lambda cloud, pairs, _: rf.plot_population(pairs.drop(columns="pgv")), "The table lacks pgv"),
        (lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(status_mdof=None)), "No pair was solved"),
        (
            lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(aspect_ratio=np.arange(120.0))),
            "120 aspect ratios were given, but there are 15 symbols",
        ),
        (
            lambda cloud, pairs, _: rf.plot_modal_combination(pairs.drop(columns=["sd_2", "srss_base_shear"])),
            "The table lacks sd_2, srss_base_shear. Give what run_population returned.",
        ),
        (lambda cloud, *_: rf.plot_ida(cloud), "lacks overturned, resurrections, first_overturning_scale"),
        (
            lambda cloud, pairs, ladders: rf.plot_ida(renamed(ladders, "structure", 7)),
            "7 structures and models are too many",
        ),
        (lambda cloud, *_: rf.plot_stripes(cloud), "The table lacks level"),
        (lambda cloud, *_: rf.plot_stripes(cloud.assign(level=1.0, status=None)), "No run was solved"),
        (lambda cloud, *_: rf.plot_clouds(cloud.assign(status=pd.NA)), "No run was solved"),
        (lambda cloud, *_: rf.plot_clouds(cloud.assign(pgv=0.0)), "keep the rows with pgv > 0"),
    ],
)
def test_what_cannot_be_drawn_is_named(cloud, pairs, ladders, call, said):
    with pytest.raises(rf.InputError, match=re.escape(said)):
        call(cloud, pairs, ladders)


@pytest.mark.slow
def test_ida_curves_break_where_runs_overturn(ladders):
    figure = drawn(rf.plot_ida(ladders, "pgv"))
    left, right = figure.axes
    assert (left.get_title(), right.get_xlabel()) == ("#1, 2DOF-S", "PGV [m/s]")
    curves, again, first = lines(left, "_record"), [], []
    by_record = list(ladders.groupby("motion", observed=True, sort=False))
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
    left, right = drawn(rf.plot_ida(weak, confidence=None)).axes
    assert not lines(left, "_overturned")
    assert not lines(right, "_fit")
    assert notes(right)[0].splitlines() == [
        "8 records, 8 never reached the limit",
        "0 with resurrections",
        "1 run failed",
    ]


def test_censored_records_count_as_long_as_they_stood(ladders):
    """Kaplan-Meier by hand: each step is the fraction still standing times 1 over those at risk."""
    names = list(dict.fromkeys(ladders["motion"]))
    rows = ladders.copy()
    stopped = rows["motion"].isin(names[:2]) & rows["overturned"]
    rows = rows[~stopped & ~(rows["motion"].isin(names[:2]) & (rows["scale"] > rows["first_overturning_scale"]))]
    right = drawn(rf.plot_ida(rows)).axes[1]
    ends = []
    for name in names:
        mine = rows[rows["motion"] == name]
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
    assert notes(right)[0].startswith("8 records, 2 never reached the limit")


def test_stripes_with_their_curve(stripes):
    figure = drawn(rf.plot_stripes(stripes, measure="pgv"))
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("PGV [m/s]", "P(overturning)")
    (marks,) = lines(axes, "_MDOF-S")
    np.testing.assert_allclose(np.column_stack(marks.get_data()), [(0.5, 0.0), (1.0, 0.2), (1.5, 0.5), (2.5, 0.9)])
    fit = fit_stripes([0.5, 1.0, 1.5, 2.5], [0, 2, 5, 9], [10] * 4)
    (curve,) = lines(axes, "MDOF-S")
    np.testing.assert_allclose(curve.get_ydata(), fit.probability(curve.get_xdata()), rtol=1e-4)  # of its iterations
    assert notes(axes) == [f"median {fit.median:.3g}, β = {fit.beta:.2f}"]
    assert len(axes.collections) == 1
    (shade,) = axes.patches
    assert shade.get_extents().transformed(axes.transData.inverted()).x1 == pytest.approx(0.5)
    axes = drawn(rf.plot_stripes(stripes[stripes["level"] < 1.0], 0.005, confidence=None)).axes[0]
    assert axes.get_ylabel() == r"$P(θ_{\mathrm{max}}>0.005\ \mathrm{rad})$"
    assert notes(axes) == ["no curve fits"]
    assert not axes.collections


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "draw"), [("stripes", rf.plot_stripes), ("ladders", rf.plot_ida)])
def test_bands_count_recordings_not_runs(kind, draw, request):
    """Nine copies of each run under its recording: as independent ones they make a band three times as narrow."""
    runs = request.getfixturevalue(kind)
    if kind == "stripes":
        runs = runs.assign(group=np.arange(len(runs)) % 10, motion="m")
    copies = [runs.assign(motion=runs["motion"].astype(str) + f" {number}") for number in range(9)]
    areas = []
    for table in (runs, pd.concat(copies, ignore_index=True)):
        (band,) = [each for each in drawn(draw(table)).axes[-1].collections if each.get_label() == "_band"]
        x, y = band.get_paths()[0].vertices.T
        areas.append(abs(np.sum(x * np.roll(y, 1) - y * np.roll(x, 1))))
    assert areas[1] == pytest.approx(areas[0], rel=0.15)  # the β of few capacities depends on their number
