import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex
from scipy.optimize import minimize

import rockflex as rf
from drawing import drawn, notes
from drawn_studies import COLORS, FRAMES, MODELS, legend, lines, of, points
from rockflex.fragility import fit_clouds

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


def test_clouds_that_cannot_be_drawn(cloud):
    runs = of(cloud, "#1", "MDOF-S")
    with pytest.raises(rf.InputError, match=r"^No run was solved\. See the column error of the table\.$"):
        rf.plot_clouds(runs.assign(status=pd.NA))
    with pytest.raises(rf.InputError) as refused:
        rf.plot_clouds(runs.assign(pgv=0.0))
    assert str(refused.value) == (
        f"pgv must be positive, as its axis is logarithmic, but {len(runs)} of {len(runs)} values are not. Leave those "
        "runs out: keep the rows with pgv > 0."
    )


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
