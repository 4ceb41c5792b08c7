"""Ground motions: one with its spectrum, and the spectra of selected records beside their target."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._number_format import short_number
from rockflex._shown import number_with_noun
from rockflex.motion import MEASURES, GroundMotion, MeasureInput, Selection
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    ORANGE,
    RED,
    SHADE,
    Size,
    add_legend_above,
    is_narrow_figure,
    literal_text,
    new_figure,
    scaled_font_size,
    with_figure_style,
)

_PERIODS = np.geomspace(0.02, 10.0, 240)
_DAMPING = 0.05
_N_PERIODS = 100
_BEYOND = 3.0  # the figure reaches beyond the range of periods by this factor
_CODE_MINIMUM = 0.9  # of the target, by EN 1998-1:2004 and ASCE 7-16
_NAMES = {"component": "$S_a$", "geometric mean": "geometric-mean $S_a$", "rotd50": "RotD50 $S_a$",
          "rotd100": "RotD100 $S_a$"}  # fmt: skip


def plot_motion(motion: GroundMotion, *, size: Size | None = None) -> Figure:
    """Plot ground acceleration, velocity and displacement, and the 5 % damped spectrum of pseudo-acceleration.

    A vertical component has a panel for its acceleration, below the horizontal one, and a spectrum. The titles of the
    panels give PGA, PGV, PGD, PVA, and the Arias intensity I_a and the significant duration D_5-95 of the horizontal
    component, which is shaded. All are values of `GroundMotion`, exact for an acceleration that is linear between its
    samples.

    Parameters
    ----------
    motion
        A ground motion.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Four axes: a in m/s², v in m/s and d in m over time in s, and S_a in m/s² over the period in s; with a vertical
        component also a_v in m/s².

    Raises
    ------
    InputError
        If the argument is not a ground motion; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> figure = rf.plot_motion(rf.ricker_pulse(4.0, 0.6))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['$a$ [m/s²]', '$S_a$ [m/s²]', '$v$ [m/s]', '$d$ [m]']
    """
    if not hasattr(motion, "acceleration"):
        raise InputError(
            f"motion must be a GroundMotion, but {type(motion).__name__} was given. "
            "Read one from a file, take one of a suite, or build it from its samples."
        )
    spectrum = motion.spectrum(_PERIODS, _DAMPING)
    first = motion.significant_duration(0.0, 0.05)
    histories = [
        ("a", "m/s²", motion.acceleration, f"{_measure_text('pga', motion)} ({short_number(motion.pga / GRAVITY)} g)"),
        ("v", "m/s", motion.velocity, _measure_text("pgv", motion)),
        ("d", "m", motion.displacement, _measure_text("pgd", motion)),
    ]
    if motion.vertical is not None:
        histories.insert(
            1,
            (
                "a_v",
                "m/s²",
                motion.vertical,
                f"{_measure_text('pva', motion)} ({short_number(motion.pva / GRAVITY)} g)",
            ),
        )
    with with_figure_style(size=size):
        figure = new_figure(7.2, 1.0 + 1.2 * len(histories) + 2.4 * is_narrow_figure())
        if is_narrow_figure():
            stacked: list[Any] = [[name] for name in (*(symbol for symbol, *_ in histories), "spectrum")]
            panels = figure.subplot_mosaic(stacked, height_ratios=(*[1.0] * len(histories), 1.7))
        else:
            panels = figure.subplot_mosaic([[symbol, "spectrum"] for symbol, *_ in histories], width_ratios=(3, 2))
        for symbol, unit, values, peak in histories:
            axes = panels[symbol]
            axes.axvspan(first, first + motion.d5_95, color=SHADE, zorder=0.5)
            axes.plot(motion.time, values, color=BLACK, linewidth=0.7)
            limit = 1.1 * float(np.max(np.abs(values))) or 1.0
            axes.set(ylim=(-limit, limit), xlim=(0.0, motion.duration), ylabel=f"${symbol}$ [{unit}]")
            axes.set_title(peak, loc="right", fontsize=scaled_font_size(8.0))
        for symbol, *_ in histories[:-1]:
            panels[symbol].sharex(panels["d"])
            panels[symbol].tick_params(labelbottom=False)
        panels["d"].set_xlabel("time [s]")
        axes = panels["spectrum"]
        axes.plot(spectrum.period, spectrum.sa, color=BLUE, linewidth=1.2, label="horizontal")
        largest = float(spectrum.sa.max())
        if motion.vertical is not None:
            upwards = motion.vertical_motion.spectrum(_PERIODS, _DAMPING)
            axes.plot(upwards.period, upwards.sa, color=ORANGE, linewidth=1.2, linestyle="--", label="vertical")
            axes.legend(loc="upper right", fontsize=scaled_font_size(8.0))
            largest = max(largest, float(upwards.sa.max()))
        axes.set(xscale="log", xlim=(_PERIODS[0], _PERIODS[-1]), ylim=(0.0, 1.08 * largest or 1.0))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set(xlabel="$T$ [s]", ylabel="$S_a$ [m/s²]")
        measures = f"{_measure_text('arias', motion)}, {_measure_text('d5_95', motion)} (shaded)"
        axes.set_title(f"{measures}\nspectrum for ζ = {100.0 * _DAMPING:g} %", fontsize=scaled_font_size(8.0))
        figure.suptitle(literal_text(motion.name) or "ground motion", fontsize="medium")
    return figure


def _measure_text(name: str, motion: GroundMotion) -> str:
    """Symbol, value and unit of a measure."""
    measure = MEASURES[name]
    return f"{measure.sign} = {short_number(measure.of(MeasureInput(motion)))} {measure.unit}"


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
    low, high = _period_range_ends(selection.periods)
    periods = np.geomspace(low / _BEYOND, high * _BEYOND, _N_PERIODS)
    known = periods[(periods >= target.periods[0]) & (periods <= target.periods[-1])]
    rows = selection.at(periods)
    with with_figure_style(size=size):
        figure = new_figure(5.4, 4.6)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        for axes in (upper, lower):
            axes.axvspan(low, high, color=SHADE, zorder=0.5)
        _draw_selected_spectra(upper, selection, periods, rows)
        upper.plot(known, target.at(known), color=RED, linewidth=1.6, label=literal_text(target.name) or "target")
        within = np.isin(periods, known)
        lower.plot(known, rows.mean(axis=0)[within] / target.at(known), color=BLUE, linewidth=1.4)
        lower.axhline(1.0, color=RED, linewidth=0.9)
        lower.axhline(_CODE_MINIMUM, color=BLACK, linewidth=0.8, linestyle="--")
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
        title = f"ζ = {100.0 * target.damping_ratio:g} %, {low:.3g} to {high:.3g} s"
        add_legend_above(figure, handles, labels, title=title, max_columns=2)
    return figure


def _period_range_ends(periods: Array) -> tuple[float, float]:
    """First and last positive period; a single one is widened so that its range can be seen."""
    positive = periods[periods > 0.0]
    if not positive.size:
        return 0.1, 1.0
    low, high = float(positive[0]), float(positive[-1])
    return (low, high) if low < high else (low / 1.02, high * 1.02)


def _draw_selected_spectra(axes: Axes, selection: Selection[Any], periods: Array, rows: Array) -> None:
    count = len(rows)
    if count > 1:
        for k, row in enumerate(rows):
            label = number_with_noun(count, "record") if k == 0 else f"_{k}"
            axes.plot(periods, row, color=GRAY, linewidth=0.6, alpha=0.7, label=label)
        median, spread = np.exp(np.log(rows).mean(axis=0)), np.log(rows).std(axis=0, ddof=1)
        band = median * np.exp(-spread), median * np.exp(spread)
        axes.fill_between(periods, *band, color=BLUE, alpha=0.15, linewidth=0.0, label="16 to 84 %")
    what = "mean" if count > 1 else "record"
    label = f"{what}: misfit {selection.misfit:.2g}, at least {selection.least_ratio:.2f} of the target"
    axes.plot(periods, rows.mean(axis=0), color=BLUE, linewidth=1.6, label=label)
