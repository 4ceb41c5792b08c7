"""Incremental dynamic analysis: curves of all records, and their capacities."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array, Bools
from rockflex._cases import rows_of
from rockflex._errors import InputError
from rockflex._shown import counted
from rockflex.fragility import LognormalFragility, fit_capacities
from rockflex.plot._study_tables import check_columns, measure_name, names_in
from rockflex.plot._style import BLACK, BLUE, GRAY, RED, SMALL, Size, letter, literal, narrow, new_figure, styled
from rockflex.plot._units import short

if TYPE_CHECKING:
    import pandas as pd


_NEEDED = (
    *("structure", "model", "motion", "group", "scale", "status", "max_rotation", "overturned", "resurrections"),
    *("first_overturning_scale", "last_survival_scale"),
)
_MOST = 6  # rows of panels
_POINTS = 400
_SOURCE = "what run_incremental returned"


class _Capacities(NamedTuple):
    """Capacities of the records of one structure and model, which of them are only bounds, and the fitted curve."""

    reached: Array
    censored: Bools
    resurrected: int
    fit: LognormalFragility | None


def plot_ida(
    runs: "pd.DataFrame", measure: str = "pga", *, confidence: float | None = 0.9, size: Size | None = None
) -> Figure:
    r"""Plot θ_max over an intensity measure, one curve per record, next to the capacities.

    Each structure and model has a row of two panels.

    Curves are interrupted where a run overturns, by the limit of the study; the first such run is a red cross at the
    top. Runs that do not overturn at a larger scale than one that did ("resurrections", Vamvatsikos & Cornell 2002)
    are open symbols. The right panel has the fraction of overturned records as steps (the Kaplan-Meier estimate if
    some never overturned), and the lognormal curve of `fit_capacities` with its band, by recording.

    Parameters
    ----------
    runs
        The table of an incremental study, such as that of `run_incremental`.
    measure
        Column of the intensity measure.
    confidence
        Confidence of the band around the lognormal curve, between 0 and 1; None for no band.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes per structure and model, over the measure in its unit: θ_max in rad, and probability.

    Raises
    ------
    InputError
        If the table lacks a column or has no rows, the measure is unknown, or there are too many structures and models;
        or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_incremental(structure, motions, "rigid", growth=1.5)
    >>> figure = rf.plot_ida(runs)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$θ_{\\mathrm{max}}$ [rad]')
    """
    check_columns(runs, (*_NEEDED, measure), _SOURCE)
    from rockflex.study.incremental import incremental_capacities

    capacities = incremental_capacities(runs, measure)
    groups = [(name, model) for name in names_in(runs["structure"]) for model in names_in(runs["model"])]
    groups = [group for group in groups if len(rows_of(runs, *group))]
    if len(groups) > _MOST:
        raise InputError(
            f"{len(groups)} structures and models are too many for one figure; {_MOST} fit. Plot fewer at a time."
        )
    with styled(size=size):
        across = 1 if narrow() else 2
        figure = new_figure(6.3, 0.9 + 2.1 * len(groups) * 2 // across)
        grid = figure.subplots(2 * len(groups) // across, across, sharex=True, squeeze=False).reshape(-1, 2)
        for row, (structure, model) in enumerate(groups):
            left, right = grid[row]
            found = _capacities(rows_of(capacities, structure, model))
            failed = _draw_curves(left, rows_of(runs, structure, model), measure)
            _draw_capacities(right, found, confidence, failed)
            left.set(title=literal(f"{structure}, {model}"), ylabel=r"$θ_{\mathrm{max}}$ [rad]")
            right.set_ylabel("P(overturning)")
            letter(left, chr(ord("A") + 2 * row))
            letter(right, chr(ord("B") + 2 * row))
        grid[0, 0].set_xlim(0.0, _limit(runs, capacities, measure))
        for axes in grid[-1, -across:]:
            axes.set_xlabel(measure_name(measure))
        figure.legend(
            handles=_handles(),
            loc="outside upper center",
            ncols=2 if narrow() else 5,
            columnspacing=1.2,
            handlelength=1.6,
        )
    return figure


def _capacities(rows: "pd.DataFrame") -> _Capacities:
    known = rows[rows["capacity"].notna()]
    values, censored = known["capacity"].to_numpy(dtype=float), known["censored"].to_numpy(dtype=bool)
    try:
        fit = fit_capacities(values, censored, known["group"])
    except InputError:
        fit = None
    return _Capacities(values, censored, int((known["resurrections"] > 0).sum()), fit)


def _limit(runs: "pd.DataFrame", capacities: "pd.DataFrame", measure: str) -> float:
    """End of the axis: a little beyond the last capacity and the last run that did not overturn."""
    stood = runs[runs["overturned"].notna() & ~runs["overturned"].fillna(True).astype(bool)]
    ends = [float(values.max()) for values in (stood[measure], capacities["capacity"]) if values.notna().any()]
    return 1.05 * max(ends, default=1.0)


def _draw_curves(axes: Axes, runs: "pd.DataFrame", measure: str) -> int:
    """Draw one curve per record; return how many runs failed."""
    top = 0.0
    for _, ladder in runs.groupby("motion", observed=True, sort=False):
        solved = ladder[ladder["overturned"].notna()].sort_values("scale", kind="stable")
        if not len(solved):
            continue
        fell = solved["overturned"].to_numpy(dtype=bool)
        im, rotation = solved[measure].to_numpy(dtype=float), solved["max_rotation"].to_numpy(dtype=float)
        axes.plot(
            np.append(0.0, im), np.append(0.0, np.where(fell, np.nan, rotation)), color=GRAY, linewidth=0.5,
            alpha=0.8, label="_record",
        )  # fmt: skip
        top = max(top, float(rotation[~fell].max(initial=0.0)))
        if not fell.any():
            continue
        first = int(np.argmax(fell))
        axes.plot(
            [im[first]], [0.965], "x", color=RED, markersize=3.0, markeredgewidth=0.7,
            transform=axes.get_xaxis_transform(), label="_overturned",
        )  # fmt: skip
        again = ~fell & (np.arange(fell.size) > first)
        axes.plot(
            im[again], rotation[again], "o", color=BLUE, markersize=2.6, markerfacecolor="white",
            markeredgewidth=0.6, label="_resurrected", zorder=2.5,
        )  # fmt: skip
    axes.set_ylim(0.0, 1.12 * top or 0.1)
    return int(runs["overturned"].isna().sum())


def _draw_capacities(axes: Axes, found: _Capacities, confidence: float | None, failed: int) -> None:
    """Draw steps of the observed fraction, the lognormal curve, and the numbers."""
    axes.set_ylim(-0.03, 1.03)
    lines = [counted(found.reached.size, "record")]
    if found.censored.any():
        lines[0] += f", {int(found.censored.sum())} never overturned"
    if (~found.censored).any():
        at, fraction = _observed(found)
        axes.step(np.append(0.0, at), np.append(0.0, fraction), where="post", color=BLACK, linewidth=0.9, label="_ecdf")
    if found.fit is not None:
        end = float(found.reached.max()) * 1.3
        im = np.linspace(end / _POINTS, end, _POINTS)
        axes.plot(im, found.fit.probability(im), color=RED, linestyle="--", linewidth=1.1, label="_fit")
        if confidence is not None and found.fit.covariance is not None:
            axes.fill_between(im, *found.fit.band(im, confidence), color=RED, alpha=0.13, linewidth=0.0, label="_band")
        lines.append(f"median {short(found.fit.median)}, β = {found.fit.beta:.2f}")
    lines.append(f"{found.resurrected} with resurrections")
    if failed:
        lines.append(f"{counted(failed, 'run')} failed")
    axes.text(
        0.97, 0.05, "\n".join(lines), transform=axes.transAxes, ha="right", fontsize=SMALL, linespacing=1.3,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
    )  # fmt: skip


def _observed(found: _Capacities) -> tuple[Array, Array]:
    """Capacities and the fraction of records up to each; records that never overturned are censored."""
    from scipy.stats import CensoredData, ecdf

    sample = CensoredData(uncensored=found.reached[~found.censored], right=found.reached[found.censored])
    estimate = ecdf(sample).cdf
    return np.asarray(estimate.quantiles), np.asarray(estimate.probabilities)


def _handles() -> list[Line2D]:
    return [
        Line2D([], [], color=GRAY, linewidth=0.7, label="record"),
        Line2D([], [], color=RED, marker="x", linestyle="", markersize=3.5, label="first overturning"),
        Line2D(
            [], [], color=BLUE, marker="o", linestyle="", markersize=3.0, markerfacecolor="white", label="stands again"
        ),
        Line2D([], [], color=BLACK, linewidth=0.9, label="observed"),
        Line2D([], [], color=RED, linestyle="--", label="lognormal"),
    ]
