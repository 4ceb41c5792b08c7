import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from drawing import drawn, notes
from drawn_studies import lines, points
from rockflex.fragility import fit_stripes


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
        "8 records, 8 never overturned",
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
    assert notes(right)[0].startswith("8 records, 2 never overturned")


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
