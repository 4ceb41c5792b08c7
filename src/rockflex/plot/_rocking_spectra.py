"""Rocking spectra and overturning spectra."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockflex._errors import InputError
from rockflex.plot._study_tables import check_table_columns
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    GREEN,
    LINE_STYLES,
    RED,
    LineStyle,
    Size,
    add_legend_beside,
    literal_text,
    new_figure,
    recoloured_line_styles,
    with_figure_style,
)

if TYPE_CHECKING:
    import pandas as pd

_CROSSES = 0.045  # of the panel, from row to row
_STYLES = (LineStyle(BLACK, "-"), LineStyle(RED, "-."), LineStyle(GREEN, "--"), LineStyle(BLUE, ":"), *LINE_STYLES)


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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> table = rf.rocking_spectrum(rf.ricker_pulse(4.0, 0.6), slendernesses=[0.2], periods=[2.0, 4.0, 6.0])
    >>> figure = rf.plot_rocking_spectrum(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$2π/p$ [s]', '$θ_{\\mathrm{max}}/α$')
    """
    check_table_columns(
        table, ("slenderness", "period", "relative_rotation", "overturned"), "what rocking_spectrum returned"
    )
    groups = list(table.groupby("slenderness"))
    _check_number_of_spectra(len(groups), "slendernesses")
    fell = table["overturned"].fillna(False).astype(bool)
    standing = [float(value) for value in table["relative_rotation"][~fell] if np.isfinite(value)]
    share = 1.0 - _CROSSES * (len(groups) + 1)
    limit = (1.05 * max(standing, default=0.0) or 1.0) / share
    with with_figure_style(size=size):
        figure = new_figure(6.3, 3.6)
        axes = figure.subplots()
        for rank, ((slenderness, rows), style) in enumerate(zip(groups, recoloured_line_styles(_STYLES), strict=False)):
            block = rows.sort_values("period")
            over = block["overturned"].fillna(False).to_numpy(dtype=bool)
            values = np.where(over, np.nan, block["relative_rotation"].to_numpy(dtype=float))
            axes.plot(
                block["period"], values, color=style.color, linestyle=style.dashes, marker=".",
                markersize=2.5, label=f"α = {slenderness:.3g} rad",
            )  # fmt: skip
            axes.plot(
                block["period"][over], np.full(over.sum(), 1.0 - _CROSSES * (rank + 1)), "x", color=style.color,
                markersize=3.5, transform=axes.get_xaxis_transform(), label="_overturned",
            )  # fmt: skip
        axes.set(ylim=(0.0, limit), xlabel=r"$2π/p$ [s]", ylabel=r"$θ_{\mathrm{max}}/α$", title=literal_text(title))
        cross = Line2D([], [], color=BLACK, marker="x", linestyle="", markersize=3.5, label="overturned")
        handles, _ = axes.get_legend_handles_labels()
        add_legend_beside(figure, [*handles, cross])
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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> pulse = lambda amplitude, frequency: rf.ricker_pulse(amplitude, 6.28 / frequency)
    >>> table = rf.overturning_spectrum(structure, pulse, [1.0, 2.0], relative_amplitudes=[1.0, 2.0, 4.0, 8.0])
    >>> figure = rf.plot_overturning_spectrum(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$ω_g/p$', '$a_p/(g\\,α)$')
    """
    named: Mapping[str, pd.DataFrame] = tables if isinstance(tables, Mapping) else {"": tables}
    if not named:
        raise InputError("There is no table to plot. Give at least one from overturning_spectrum.")
    _check_number_of_spectra(len(named), "tables")
    for table in named.values():
        check_table_columns(
            table, ("frequency_ratio", "lowest", "highest_standing"), "what overturning_spectrum returned"
        )
    with with_figure_style(size=size):
        figure = new_figure(6.3, 3.6)
        axes = figure.subplots()
        finite = [v for table in named.values() for v in table["lowest"] if np.isfinite(v)]
        top = [v for table in named.values() for v in table["highest_standing"] if np.isfinite(v)]
        limit = 1.1 * max([*finite, *top, 1.0])
        for (name, table), style in zip(named.items(), recoloured_line_styles(_STYLES), strict=False):
            rows = table.sort_values("frequency_ratio")
            ratio, low = rows["frequency_ratio"].to_numpy(dtype=float), rows["lowest"].to_numpy(dtype=float)
            high = np.minimum(rows["highest_standing"].to_numpy(dtype=float), limit)
            both = high > low * (1.0 + 1e-3)
            axes.fill_between(
                ratio, low, high, where=both, facecolor="none", edgecolor=style.color, hatch="////", linewidth=0.0,
                alpha=0.5,
            )  # fmt: skip
            axes.plot(ratio, low, color=style.color, linestyle=style.dashes, label=literal_text(name) or "lowest")
        axes.axhline(1.0, color=GRAY, linewidth=0.8, label="uplift")
        axes.set_xlim(left=0.0)
        axes.set(ylim=(0.0, limit), xlabel=r"$ω_g/p$", ylabel=r"$a_p/(g\,α)$", title=literal_text(title))
        handles, _ = axes.get_legend_handles_labels()
        if axes.collections and any(len(area.get_paths()) for area in axes.collections):
            handles.append(Patch(facecolor="none", edgecolor=GRAY, hatch="////", linewidth=0.0, label="either"))
        add_legend_beside(figure, handles)
    return figure


def _check_number_of_spectra(given: int, what: str) -> None:
    if given > len(_STYLES):
        raise InputError(
            f"{given} {what} are too many to distinguish in one figure; at most {len(_STYLES)} can be shown."
        )
