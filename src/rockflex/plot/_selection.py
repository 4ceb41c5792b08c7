"""The spectra of chosen records beside their target."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import counted
from rockflex.motion import Selection
from rockflex.plot._style import BLACK, BLUE, GRAY, RED, SHADE, Size, columns, literal, new_figure, styled

_POINTS = 100
_BEYOND = 3.0  # the figure reaches beyond the range of periods by this factor
_ASKED = 0.9  # of the target, by EN 1998-1:2004 and ASCE 7-16
_NAMES = {"component": "$S_a$", "geometric mean": "geometric-mean $S_a$", "rotd50": "RotD50 $S_a$",
          "rotd100": "RotD100 $S_a$"}  # fmt: skip


def plot_selection(selection: Selection[Any], *, size: Size | None = None) -> Figure:
    """Plot the spectra of chosen records with their target, mean and spread, and the ratio of the mean to the target.

    The mean is the arithmetic one, which codes compare with the target. The band reaches from the 16th to the 84th
    percentile of a lognormal distribution, median times exp(±σ). The range of periods for which the records were chosen
    is shaded, and the dashed line is at 0.9, which EN 1998-1:2004 and ASCE 7-16 ask for.

    Parameters
    ----------
    selection
        The result of `Suite.select`.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes over the period in s: S_a in m/s², and mean/target.

    Raises
    ------
    InputError
        If the argument is not a selection; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> figure = rf.plot_selection(suite.select(rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0)))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['$S_a$ [m/s²]', 'mean/target']
    """
    if not isinstance(selection, Selection):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"selection must be a Selection, but {type(selection).__name__} was given. Make one: suite.select(...)."
        )
    target = selection.target
    low, high = _ends(selection.periods)
    periods = np.geomspace(low / _BEYOND, high * _BEYOND, _POINTS)
    known = periods[(periods >= target.periods[0]) & (periods <= target.periods[-1])]
    rows = selection.at(periods)
    with styled(size=size):
        figure = new_figure(5.4, 4.6)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        for axes in (upper, lower):
            axes.axvspan(low, high, color=SHADE, zorder=0.5)
        _draw_spectra(upper, selection, periods, rows)
        upper.plot(known, target.at(known), color=RED, linewidth=1.6, label=literal(target.name) or "target")
        within = np.isin(periods, known)
        lower.plot(known, rows.mean(axis=0)[within] / target.at(known), color=BLUE, linewidth=1.4)
        lower.axhline(1.0, color=RED, linewidth=0.9)
        lower.axhline(_ASKED, color=BLACK, linewidth=0.8, linestyle="--")
        inside = selection.mean / target.at(selection.periods)
        bottom, top = min(0.85, float(inside.min())), max(1.15, float(inside.max()))
        lower.set(ylim=(bottom - 0.1, top + 0.1), ylabel="mean/target", xlabel="$T$ [s]")
        upper.set(xscale="log", yscale="log", ylabel=f"{_NAMES[selection.measure]} [m/s²]")
        upper.set_xlim(float(periods[0]), float(periods[-1]))
        for axis in (upper.xaxis, upper.yaxis):
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
        handles, labels = upper.get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside upper center", ncols=min(2, columns(labels, 78)),
            title=f"ζ = {100.0 * target.damping_ratio:g} %, {low:.3g} to {high:.3g} s", title_fontsize="medium",
        )  # fmt: skip
    return figure


def _ends(periods: Array) -> tuple[float, float]:
    """First and last positive period; a single one is widened so that its range can be seen."""
    positive = periods[periods > 0.0]
    if not positive.size:
        return 0.1, 1.0
    low, high = float(positive[0]), float(positive[-1])
    return (low, high) if low < high else (low / 1.02, high * 1.02)


def _draw_spectra(axes: Axes, selection: Selection[Any], periods: Array, rows: Array) -> None:
    count = len(rows)
    if count > 1:
        for k, row in enumerate(rows):
            label = counted(count, "record") if k == 0 else f"_{k}"
            axes.plot(periods, row, color=GRAY, linewidth=0.6, alpha=0.7, label=label)
        median, spread = np.exp(np.log(rows).mean(axis=0)), np.log(rows).std(axis=0, ddof=1)
        band = median * np.exp(-spread), median * np.exp(spread)
        axes.fill_between(periods, *band, color=BLUE, alpha=0.15, linewidth=0.0, label="16 to 84 %")
    what = "mean" if count > 1 else "record"
    label = f"{what}: misfit {selection.misfit:.2g}, at least {selection.least_ratio:.2f} of the target"
    axes.plot(periods, rows.mean(axis=0), color=BLUE, linewidth=1.6, label=label)
