"""Ground motions with their spectra, selected records beside their target, and rocking and overturning spectra."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.units import Unit
from rockflex.motion._conditional import ConditionalSpectrum
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measures import MEASURES, MeasureInput
from rockflex.motion._suite import Selection
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, BLUE, GRAY, GREEN, LINE_STYLES, ORANGE, RED, SHADE, LineStyle, Size
from rockflex.plot._study_tables import check_table_columns, label_log_axis_plainly

if TYPE_CHECKING:
    import pandas as pd

_PERIODS = np.geomspace(0.02, 10.0, 240)
_DAMPING = 0.05
_N_PERIODS = 100
_BEYOND = 3.0  # the figure reaches beyond the range of periods by this factor
_CODE_MINIMUM = 0.9  # of the target, by EN 1998-1:2004 and ASCE 7-16
_NAMES = {"component": "$S_a$", "geometric mean": "geometric-mean $S_a$", "rotd50": "RotD50 $S_a$",
          "rotd100": "RotD100 $S_a$"}  # fmt: skip
_CROSS_ROW = 0.045  # of the panel, from row to row
_SPECTRUM_STYLES = (
    LineStyle(BLACK, "-"),
    LineStyle(RED, "-."),
    LineStyle(GREEN, "--"),
    LineStyle(BLUE, ":"),
    *LINE_STYLES,
)


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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    said = {
        name: f"{MEASURES[name].sign} = {short_number(MEASURES[name].of(MeasureInput(motion)))} {MEASURES[name].unit}"
        for name in ("arias", "d5_95")
    }
    acceleration, velocity, displacement = map(figures.axis_unit, ("acceleration", "velocity", "displacement"))
    histories = [
        ("a", acceleration, motion.acceleration, _peak_text("PGA", motion.pga, acceleration)),
        ("v", velocity, motion.velocity, _peak_text("PGV", motion.pgv, velocity)),
        ("d", displacement, motion.displacement, _peak_text("PGD", motion.pgd, displacement)),
    ]
    if motion.vertical is not None:
        histories.insert(1, ("a_v", acceleration, motion.vertical, _peak_text("PVA", motion.pva, acceleration)))
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(7.2, 1.0 + 1.2 * len(histories) + 2.4 * figures.is_narrow())
        if figures.is_narrow():
            stacked: list[Any] = [[name] for name in (*(symbol for symbol, *_ in histories), "spectrum")]
            panels = figure.subplot_mosaic(stacked, height_ratios=(*[1.0] * len(histories), 1.7))
        else:
            panels = figure.subplot_mosaic([[symbol, "spectrum"] for symbol, *_ in histories], width_ratios=(3, 2))
        for symbol, unit, values, peak in histories:
            axes = panels[symbol]
            axes.axvspan(first, first + motion.d5_95, color=SHADE, zorder=0.5)
            axes.plot(motion.time, values / unit.size, color=BLACK, linewidth=0.7)
            limit = 1.1 * float(np.max(np.abs(values))) / unit.size or 1.0
            axes.set(ylim=(-limit, limit), xlim=(0.0, motion.duration), ylabel=unit.heading(f"${symbol}$"))
            axes.set_title(peak, loc="right", fontsize=figures.scaled_font_size(8.0))
        for symbol, *_ in histories[:-1]:
            panels[symbol].sharex(panels["d"])
            panels[symbol].tick_params(labelbottom=False)
        panels["d"].set_xlabel(translated("time [s]"))
        axes = panels["spectrum"]
        axes.plot(
            spectrum.period, spectrum.sa / acceleration.size, color=BLUE, linewidth=1.2, label=translated("horizontal")
        )
        largest = float(spectrum.sa.max()) / acceleration.size
        if motion.vertical is not None:
            upwards = motion.vertical_motion.spectrum(_PERIODS, _DAMPING)
            over = upwards.sa / acceleration.size
            axes.plot(upwards.period, over, color=ORANGE, linewidth=1.2, linestyle="--", label=translated("vertical"))
            axes.legend(loc="upper right", fontsize=figures.scaled_font_size(8.0))
            largest = max(largest, float(over.max()))
        axes.set(xscale="log", xlim=(_PERIODS[0], _PERIODS[-1]), ylim=(0.0, 1.08 * largest or 1.0))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set(xlabel="$T$ [s]", ylabel=acceleration.heading("$S_a$"))
        words = translated(
            "{arias}, {duration} (shaded)\nspectrum for ζ = {damping} %",
            arias=said["arias"],
            duration=said["d5_95"],
            damping=f"{100.0 * _DAMPING:g}",
        )
        axes.set_title(words, fontsize=figures.scaled_font_size(8.0))
        figure.suptitle(figures.literal_text(motion.name) or translated("ground motion"), fontsize="medium")
    return figure


def _peak_text(name: str, value: float, unit: Unit) -> str:
    """Return a peak with its unit, of an acceleration also in g."""
    text = f"{name} = {short_number(value / unit.size)} {unit.name}"
    return f"{text} ({short_number(value / GRAVITY)} g)" if unit.name == "m/s²" else text


def plot_selection(selection: Selection, *, period: float | None = None, size: Size | None = None) -> Figure:
    """Plot the spectra of chosen records with their target, mean and spread, and the ratio of the mean to the target.

    The mean is the arithmetic one, which codes compare with the target. The band reaches from the 16th to the 84th
    percentile of a lognormal distribution, median times exp(±σ). The range of periods for which the records were chosen
    is shaded, and the dashed line is at 0.9, which EN 1998-1:2004 and ASCE 7-16 ask for. With a conditional spectrum
    the median takes the place of the mean, the bands reach from -2 σ to +2 σ, and the lower axes compare the standard
    deviations of ln S_a.

    Parameters
    ----------
    selection
        The result of `Suite.select`.
    period
        A period in s that a line marks, such as the first one of the structure.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes over the period in s: S_a in m/s², and mean/target, or the standard deviation of ln S_a.

    Raises
    ------
    InputError
        If the argument is not a selection; the period is not positive; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> figure = rf.plot_selection(suite.select(rf.ec8_spectrum(2.5, "C"), 7,
    ...     (0.2, 2.0)))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['$S_a$ [m/s²]', 'mean/target']
    """
    if not isinstance(selection, Selection):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"selection must be a Selection, but {type(selection).__name__} was given. Make one: suite.select(...)."
        )
    marked = None if period is None else checked_positive("period", period, "s")
    target = selection.target
    positive = selection.periods[selection.periods > 0.0]
    low, high = (float(positive[0]), float(positive[-1])) if positive.size else (0.1, 1.0)
    if low == high:  # widened so that it can be seen
        low, high = low / 1.02, high * 1.02
    periods = np.geomspace(low / _BEYOND, high * _BEYOND, _N_PERIODS)
    known = periods[(periods >= target.periods[0]) & (periods <= target.periods[-1])]
    rows = selection.at(periods)
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(5.4, 4.6)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        for axes in (upper, lower):
            axes.axvspan(low, high, color=SHADE, zorder=0.5)
            if marked is not None:
                axes.axvline(marked, color=BLACK, linewidth=0.9, linestyle=":", label=f"$T_1$ = {marked:.3g} s")
        unit = figures.axis_unit("acceleration")
        _draw_selected_spectra(upper, selection, periods, rows / unit.size)
        name = figures.literal_text(target.name) or translated("target")
        upper.plot(known, target.at(known) / unit.size, color=RED, linewidth=1.6, label=name)
        if isinstance(target, ConditionalSpectrum):
            _draw_spread(upper, lower, target, known, periods, rows)
        else:
            within = np.isin(periods, known)
            lower.plot(known, rows.mean(axis=0)[within] / target.at(known), color=BLUE, linewidth=1.4)
            lower.axhline(1.0, color=RED, linewidth=0.9)
            lower.axhline(_CODE_MINIMUM, color=BLACK, linewidth=0.8, linestyle="--")
            inside = selection.mean / target.at(selection.periods)
            bottom, top = min(0.85, float(inside.min())), max(1.15, float(inside.max()))
            lower.set(ylim=(bottom - 0.1, top + 0.1), ylabel=translated("mean/target"))
        lower.set_xlabel("$T$ [s]")
        upper.set(xscale="log", yscale="log", ylabel=unit.heading(translated(_NAMES[selection.measure])))
        upper.set_xlim(float(periods[0]), float(periods[-1]))
        for axis in (upper.xaxis, upper.yaxis):
            label_log_axis_plainly(axis)
        handles, labels = upper.get_legend_handles_labels()
        title = translated(
            "ζ = {damping} %, {low} to {high} s",
            damping=f"{100.0 * target.damping_ratio:g}",
            low=f"{low:.3g}",
            high=f"{high:.3g}",
        )
        figures.add_legend_above(figure, handles, labels, title=title, max_columns=2)
    return figure


def _draw_spread(
    upper: Axes, lower: Axes, target: ConditionalSpectrum, known: Array, periods: Array, rows: Array
) -> None:
    """Draw the target two standard deviations from its median, and both standard deviations of ln S_a."""
    wanted = target.dispersion_at(known)
    for sign in (-2.0, 2.0):
        ordinates = target.at(known) * np.exp(sign * wanted) / figures.axis_unit("acceleration").size
        label = translated("target ± 2 σ") if sign < 0.0 else "_"
        upper.plot(known, ordinates, color=RED, linewidth=1.0, linestyle="--", label=label)
    spread = np.log(rows).std(axis=0, ddof=1)
    lower.plot(known, wanted, color=RED, linewidth=1.4)
    lower.plot(periods, spread, color=BLUE, linewidth=1.4)
    lower.set(ylim=(0.0, 1.15 * max(float(wanted.max()), float(spread.max()), 0.1)), ylabel=r"$\sigma$ (ln $S_a$)")


def _draw_selected_spectra(axes: Axes, selection: Selection, periods: Array, rows: Array) -> None:
    count, conditional = len(rows), isinstance(selection.target, ConditionalSpectrum)
    median = np.exp(np.log(rows).mean(axis=0))
    if count > 1:
        for k, row in enumerate(rows):
            label = translated("{n} records", n=count) if k == 0 else f"_{k}"
            axes.plot(periods, row, color=GRAY, linewidth=0.6, alpha=0.7, label=label)
        spread = np.log(rows).std(axis=0, ddof=1) * (2.0 if conditional else 1.0)
        band = median * np.exp(-spread), median * np.exp(spread)
        label = translated("records ± 2 σ" if conditional else "16 to 84 %")
        axes.fill_between(periods, *band, color=BLUE, alpha=0.15, linewidth=0.0, label=label)
    if conditional:
        label = translated("median: misfit {misfit}", misfit=f"{selection.misfit:.2g}")
        axes.plot(periods, median, color=BLUE, linewidth=1.6, label=label)
        return
    label = translated(
        "mean: misfit {misfit}, at least {ratio} of the target"
        if count > 1
        else "record: misfit {misfit}, at least {ratio} of the target",
        misfit=f"{selection.misfit:.2g}",
        ratio=f"{selection.least_ratio:.2f}",
    )
    axes.plot(periods, rows.mean(axis=0), color=BLUE, linewidth=1.6, label=label)


def plot_rocking_spectrum(table: "pd.DataFrame", *, title: str = "", size: Size | None = None) -> Figure:
    r"""Plot θ_max/α over 2π/p, a curve for each slenderness.

    Blocks that overturn have no θ_max: the curve is interrupted, and crosses at the top mark them, one row per
    slenderness.

    Parameters
    ----------
    table
        The table of `rocking_spectrum`.
    title
        Title of the figure, such as the name of the motion.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; 2π/p in s.

    Raises
    ------
    InputError
        If the table lacks a column that it needs, has no rows, or has too many slendernesses to distinguish; or the
        size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = rf.rocking_spectrum(rf.ricker_pulse(4.0, 0.6),
    ...     slendernesses=[0.2], periods=[2.0, 4.0, 6.0])
    >>> figure = rf.plot_rocking_spectrum(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$2π/p$ [s]', '$θ_{\\mathrm{max}}/α$')
    """
    check_table_columns(
        table, ("slenderness", "period", "relative_rotation", "overturned"), "what rocking_spectrum returned"
    )
    groups = dict(iter(table.groupby("slenderness")))
    styles = figures.assign_distinct(list(groups), figures.recoloured_line_styles(_SPECTRUM_STYLES), "slendernesses")
    fell = table["overturned"].fillna(False).astype(bool)
    standing = [float(value) for value in table["relative_rotation"][~fell] if np.isfinite(value)]
    share = 1.0 - _CROSS_ROW * (len(groups) + 1)
    limit = (1.05 * max(standing, default=0.0) or 1.0) / share
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 3.6)
        axes = figure.subplots()
        for rank, (slenderness, style) in enumerate(styles.items()):
            block = groups[slenderness].sort_values("period")
            over = block["overturned"].fillna(False).to_numpy(dtype=bool)
            values = np.where(over, np.nan, block["relative_rotation"].to_numpy(dtype=float))
            label = f"α = {slenderness:.3g} rad"
            axes.plot(block["period"], values, **style.look, marker=".", markersize=2.5, label=label)
            axes.plot(
                block["period"][over], np.full(over.sum(), 1.0 - _CROSS_ROW * (rank + 1)), "x", color=style.color,
                markersize=3.5, transform=axes.get_xaxis_transform(), label="_overturned",
            )  # fmt: skip
        axes.set(
            ylim=(0.0, limit), xlabel=r"$2π/p$ [s]", ylabel=r"$θ_{\mathrm{max}}/α$", title=figures.literal_text(title)
        )
        cross = Line2D([], [], color=BLACK, marker="x", linestyle="", markersize=3.5, label=translated("overturned"))
        handles, _ = axes.get_legend_handles_labels()
        figures.add_legend_beside(figure, [*handles, cross])
    return figure


def plot_overturning_spectrum(
    tables: "pd.DataFrame | Mapping[str, pd.DataFrame]", *, title: str = "", size: Size | None = None
) -> Figure:
    r"""Plot the smallest amplitude a_p/(g α) that overturns over ω_g/p, one curve per table.

    Some larger amplitudes may not overturn, because overturning is not monotone: the range up to the largest of them
    is hatched.

    Parameters
    ----------
    tables
        A table of `overturning_spectrum`, or several by name.
    title
        Title of the figure.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; no units.

    Raises
    ------
    InputError
        If a table lacks a column that it needs or has no rows, or there are too many tables to distinguish; or the size
        is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> pulse = lambda amplitude, frequency: rf.ricker_pulse(amplitude,
    ...     6.28 / frequency)
    >>> table = rf.overturning_spectrum(structure, pulse, [1.0, 2.0],
    ...     relative_amplitudes=[1.0, 2.0, 4.0, 8.0])
    >>> figure = rf.plot_overturning_spectrum(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$ω_g/p$', '$a_p/(g\\,α)$')
    """
    named: Mapping[str, pd.DataFrame] = tables if isinstance(tables, Mapping) else {"": tables}
    if not named:
        raise InputError("There is no table to plot. Give at least one from overturning_spectrum.")
    styles = figures.assign_distinct(list(named), figures.recoloured_line_styles(_SPECTRUM_STYLES), "tables")
    needed = ("frequency_ratio", "lowest", "highest_standing")
    for table in named.values():
        check_table_columns(table, needed, "what overturning_spectrum returned")
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 3.6)
        axes = figure.subplots()
        ends = [value for table in named.values() for name in needed[1:] for value in table[name]]
        limit = 1.1 * max(value for value in (*ends, 1.0) if np.isfinite(value))
        for name, style in styles.items():
            rows = named[name].sort_values("frequency_ratio")
            ratio, low = rows["frequency_ratio"].to_numpy(dtype=float), rows["lowest"].to_numpy(dtype=float)
            high = np.minimum(rows["highest_standing"].to_numpy(dtype=float), limit)
            both = high > low * (1.0 + 1e-3)
            axes.fill_between(
                ratio, low, high, where=both, facecolor="none", edgecolor=style.color, hatch="////", linewidth=0.0,
                alpha=0.5,
            )  # fmt: skip
            axes.plot(ratio, low, **style.look, label=figures.literal_text(name) or translated("lowest"))
        axes.axhline(1.0, color=GRAY, linewidth=0.8, label=translated("uplift"))
        axes.set_xlim(left=0.0)
        axes.set(ylim=(0.0, limit), xlabel=r"$ω_g/p$", ylabel=r"$a_p/(g\,α)$", title=figures.literal_text(title))
        handles, _ = axes.get_legend_handles_labels()
        if axes.collections and any(len(area.get_paths()) for area in axes.collections):
            either = translated("either")
            handles.append(Patch(facecolor="none", edgecolor=GRAY, hatch="////", linewidth=0.0, label=either))
        figures.add_legend_beside(figure, handles)
    return figure
