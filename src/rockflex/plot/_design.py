"""Designs: exceedance over the half width of the base, and the least cost of a search."""

import math
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_instance
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.units import Unit
from rockflex.fragility._limit_states import OVERTURNED, OVERTURNING, nominal_rotation_symbol, rotation_limit_state
from rockflex.plot import _figures as figures
from rockflex.plot import _study_tables as tables
from rockflex.plot._figures import BLACK, BLUE, GREEN, LINE_STYLES, ORANGE, RED, SMALL, LineStyle, Size
from rockflex.studies.design._best_design import BestDesign, InterpolatedMargins, trade_off
from rockflex.studies.design._design_table import smallest_width
from rockflex.studies.design._requirements import requirement_margins

if TYPE_CHECKING:
    import pandas as pd

_NEEDED = (
    *("model", "tendon", "half_width", "aspect_ratio", "prestress_ratio", "stiffness_ratio"),
    *("limit", "low", "high"),
)
_STYLES = (LineStyle(BLACK, "-"), LineStyle(RED, "--"), LineStyle(GREEN, "-."), *LINE_STYLES)
_DECADES = 4.0  # of rates below the largest that are shown, or below the target
_AXES = {
    "half_width": ("half_width", "half width $B$", "length"),
    "tendon_factor": ("prestress", "prestress $ΣF_0$", "force"),
    "dissipator_factor": ("dissipator_force", "force of the dissipators $ΣF_y$", "force"),
}
_SEARCH_STYLES = (LineStyle(BLUE, "-"), LineStyle(ORANGE, "--"), LineStyle(GREEN, "-."), *LINE_STYLES)
_FINE = 81  # points along each side of a plane
_MARK = 4.0


def plot_design(
    table: "pd.DataFrame", target: float | None = None, *, logarithmic: bool | None = None, size: Size | None = None
) -> Figure:
    r"""Plot the probability, or the annual rate, of exceeding a limit over the half width, one curve per tendon.

    Symbols are the designs, bands those of the table. With a target, a ring marks where each curve meets it, as
    found by `smallest_width`, and the half widths are listed. Each model has a panel; the axis at the top is h*_1/B.

    Parameters
    ----------
    table
        The table of `design_table`.
    target
        Largest probability, or annual rate, to be met.
    logarithmic
        Whether the axis of the values is logarithmic, which leaves out zeros. Default: only for rates.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per model, over the half width in m.

    Raises
    ------
    InputError
        If the table lacks a column, has no rows or several kinds of limit, the target is not positive, or there
        are too many models or tendons; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> runs = rf.run_design(frame, pulses, half_widths=[1.0, 1.5],
    ...     models="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> table = rf.design_table(runs, 0.005, at=0.5, confidence=None)
    >>> figure = rf.plot_design(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('half width $B$ [m]', 'P($θ_{\\mathrm{max}}>0.005\\ \\mathrm{rad}$)')
    """
    value = "rate" if "rate" in getattr(table, "columns", ()) else "probability"
    tables.check_table_columns(table, (*_NEEDED, value), "what design_table returned")
    tendons, models = tables.names_in_column(table["tendon"]), tables.names_in_column(table["model"])
    looks = list(zip(figures.recoloured_line_styles(_STYLES), tables.MARKERS, strict=False))
    styles: dict[str, tuple[LineStyle, str]] = figures.assign_distinct(tendons, looks, "tendons")
    found = None if target is None else smallest_width(table, target)
    logarithms = value == "rate" if logarithmic is None else logarithmic
    with figures.applied_figure_style(size=size):
        unit = figures.axis_unit("length")
        across = unit.heading(translated("half width $B$"))
        figure, panels = tables.structure_panels(models, 2, 2.9, across, _design_value_name(table, value))
        for axes, model in zip(panels, models, strict=True):
            for tendon, (style, marker) in styles.items():
                rows = _design_rows(table, model, tendon).sort_values("half_width")
                _draw_design_curve(axes, rows, value, style, marker, unit.size, tendon, logarithmic=logarithms)
            if found is not None and target is not None:
                axes.axhline(target, color=BLUE, linewidth=0.8, dashes=(5, 3), label="_target")
                _draw_smallest_widths(axes, _design_rows(found, model), styles, target, unit)
        widths = table["half_width"].to_numpy(float) / unit.size
        _set_design_limits(panels[0], table, widths, table[value].to_numpy(float), target, logarithmic=logarithms)
        for axes in panels:
            _draw_slenderness_axis(axes, table, unit.size)
        handles = tables.model_legend_handles(
            {figures.literal_text(translated(tendon)): style for tendon, style in styles.items()}
        )
        if target is not None:
            label = translated("target {value}", value=short_number(target))
            handles.append(Line2D([], [], color=BLUE, linewidth=0.8, dashes=(5, 3), label=label))
        figures.add_legend_above(figure, handles)
    return figure


def _design_rows(table: "pd.DataFrame", model: str, tendon: str | None = None) -> "pd.DataFrame":
    rows = table[table["model"].astype(str) == model]
    return rows if tendon is None else rows[rows["tendon"].astype(str) == tendon]


def _design_value_name(table: "pd.DataFrame", value: str) -> str:
    """Name of the values on the axis: one limit in rad, one multiple of 0.7 atan(B/h*_1), or overturning."""
    limits, nominal = table["limit"].to_numpy(float), 0.7 * np.arctan(1.0 / table["aspect_ratio"].to_numpy(float))
    known = np.isfinite(limits)
    event = translated("limit")
    if known.any():
        first, multiple = limits[known][0], (limits / nominal)[known]
        if np.allclose(limits[known], first, rtol=1e-9):
            event = translated((OVERTURNING if first == OVERTURNED else rotation_limit_state(first)).symbol)
        elif np.allclose(multiple, multiple[0], rtol=1e-9):
            event = nominal_rotation_symbol(multiple[0])
        else:
            raise InputError("The designs have limits of several kinds. Plot the table of one limit.")
    event = f"${event}$" if ">" in event else event
    return translated("annual rate of {event}", event=event) if value == "rate" else f"P({event})"


def _draw_design_curve(
    axes: Axes,
    rows: "pd.DataFrame",
    value: str,
    style: LineStyle,
    marker: str,
    size: float,
    name: str,
    *,
    logarithmic: bool,
) -> None:
    b, y, low, high = (rows[column].to_numpy(float) for column in ("half_width", value, "low", "high"))
    b = b / size
    shown = np.isfinite(y) & ((y > 0.0) | (not logarithmic))
    axes.plot(
        b[shown], y[shown], **style.look, marker=marker, markersize=3.5, markerfacecolor="none", markeredgewidth=0.7,
        label=name,
    )  # fmt: skip
    bounded = np.isfinite(low) & np.isfinite(high)
    floor = 1e-300 if logarithmic else 0.0
    axes.fill_between(
        b, np.maximum(low, floor), np.maximum(high, floor), where=bounded, color=style.color, alpha=0.13,
        linewidth=0.0, label="_band",
    )  # fmt: skip


def _draw_smallest_widths(
    axes: Axes, found: "pd.DataFrame", styles: dict[str, tuple[LineStyle, str]], target: float, unit: Unit
) -> None:
    """Draw a ring where each curve meets the target, and list the half widths."""
    lines: list[tuple[str, str]] = []
    for row in found.to_dict("records"):
        style, _ = styles[str(row["tendon"])]
        width = float(row["half_width"]) / unit.size
        met = row["outcome"] in ("met", "met more than once")
        if met:
            axes.plot(
                [width], [target], "o", color=style.color, markersize=7.0, markerfacecolor="none", markeredgewidth=1.2,
                label="_answer", zorder=3.0,
            )  # fmt: skip
        text = f"B {'=' if met else '≤'} {width:.3g} {unit.name}" if math.isfinite(width) else translated("not met")
        if row["outcome"] == "met more than once":
            text = translated("{width} (met more than once)", width=text)
        lines.append((text, style.color))
    for place, (text, color) in enumerate(lines):
        axes.annotate(
            text, (0.97, 0.95), xytext=(0.0, -11.0 * place), xycoords="axes fraction", textcoords="offset points",
            ha="right", va="top", fontsize=SMALL, color=color,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
        )  # fmt: skip


def _set_design_limits(
    axes: Axes, table: "pd.DataFrame", b: Array, y: Array, target: float | None, *, logarithmic: bool
) -> None:
    margin = 0.04 * float(np.ptp(b)) or 0.1 * float(b[0])
    axes.set_xlim(max(float(b.min()) - margin, 0.5 * float(b.min())), float(b.max()) + margin)
    values = np.concatenate([y, table["high"].to_numpy(float)])
    values = np.append(values[np.isfinite(values)], target or 0.0)
    top = float(values.max(initial=0.0)) or 1.0
    if logarithmic:
        seen = np.append(y[y > 0.0], target or top)
        axes.set_yscale("log")
        axes.set_ylim(0.5 * max(float(seen.min()), min(top, target or top) * 10.0**-_DECADES), 2.0 * top)
    else:
        axes.set_ylim(-0.03 * top, 1.05 * top)


def _draw_slenderness_axis(axes: Axes, table: "pd.DataFrame", size: float) -> None:
    """Draw the axis of h*_1/B at the top; `size` is that of the unit of the half width, in m."""
    height = float((table["half_width"] * table["aspect_ratio"]).iloc[0]) / size
    if not height > 0.0:
        return

    def turned(x: Any) -> Any:
        return height / np.maximum(x, 1e-9)

    top = axes.secondary_xaxis("top", functions=(turned, turned))
    top.set_xlabel("$h^*_1/B$")
    low, high = axes.get_xlim()
    candidates = [v for v in (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 40, 50, 100) if low < height / v < high]
    places: list[float] = []
    for v in candidates:  # ticks apart enough for their labels
        if not places or (height / places[-1] - height / v) > 0.06 * (high - low):
            places.append(float(v))
    top.set_xticks(places, [f"{v:g}" for v in places])
    top.minorticks_off()


class _DesignVariableAxis:
    """The column of a variable as it is plotted, and the name of its axis."""

    def __init__(self, variable: str, designs: "pd.DataFrame") -> None:
        self.variable = variable
        self.column, words, quantity = _AXES[variable]
        if not designs[self.column].to_numpy(float).any():  # factors on forces of zero
            self.column, words, quantity = variable, variable.replace("_", " "), ""
        unit = figures.axis_unit(quantity, float(designs[self.column].max())) if quantity else Unit(1.0, "")
        self.divisor, self.unit = unit
        self.words = translated(words)
        self.name = unit.heading(self.words)

    def of(self, table: "pd.DataFrame") -> Array:
        return table[self.column].to_numpy(float) / self.divisor


def plot_design_search(found: BestDesign, *, size: Size | None = None) -> Figure:
    """Plot the least cost over the width, and the trade-off of prestress against dissipators at the best width.

    Left: the least cost at which all targets are met, as predicted by `trade_off`, in the colour of the limit that
    governs; symbols are the designs that were run, filled where they meet all targets; a ring with bars is the cheapest
    of them with its band. Right, if the search varied two variables or more: for the other values of the cheapest
    design, lines on which each limit just meets its target, the region in which one does not (shaded), and lines of
    equal cost.

    Parameters
    ----------
    found
        What `best_design` returned.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One or two axes.

    Raises
    ------
    InputError
        If too few designs have probabilities of all limits, or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0],
    ...     refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(
    ...     half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost,
    ...     model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> figure = rf.plot_design_search(rf.best_design(runs, targets, cost))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['half width $B$ [m]', 'half width $B$ [m]']
    """
    checked_instance("found", found, BestDesign)
    between = InterpolatedMargins.of(found)
    varied = [*between.given]
    labels = [each.label for each in found.requirements]
    styles = figures.assign_distinct(labels, figures.recoloured_line_styles(_SEARCH_STYLES), "requirements")
    with figures.applied_figure_style(size):
        count = min(len(varied), 2)
        figure = figures.new_figure(7.2 if count > 1 else 4.2, 0.9 + 3.0 * count if figures.is_narrow() else 3.9)
        panels: list[Axes] = list(np.atleast_1d(figure.subplots(*((count, 1) if figures.is_narrow() else (1, count)))))
        _draw_design_costs(panels[0], found, varied[0], styles)
        if len(varied) > 1:
            _draw_design_plane(panels[1], found, between, (varied[-2], varied[-1]), styles)
        handles = [Line2D([], [], **style.look, label=figures.literal_text(label)) for label, style in styles.items()]
        for name, face in (
            (translated("run, meets all targets"), _design_text_color()),
            (translated("run, does not"), "none"),
        ):
            handles.append(
                Line2D(
                    [], [], color="none", marker="o", markersize=_MARK, markeredgecolor=_design_text_color(),
                    markerfacecolor=face, label=name,
                )
            )  # fmt: skip
        figures.add_legend_above(
            figure, handles, title=_best_design_text(found), max_columns=1 if figures.is_narrow() else 2
        )
    return figure


def _design_text_color() -> str:
    return str(mpl.rcParams["text.color"])


def _best_design_text(found: BestDesign) -> str:
    if found.best is None:
        return translated("No design meets all targets")
    best = found.designs.iloc[found.best]
    length = figures.axis_unit("length")
    words = [f"B = {short_number(best['half_width'] / length.size)} {length.name}"]
    for column, symbol in (("prestress", "$ΣF_0$"), ("dissipator_force", "$ΣF_y$")):
        if best[column] > 0.0:
            divisor, unit = figures.axis_unit("force", float(best[column]))
            words.append(f"{symbol} = {short_number(best[column] / divisor)} {unit}")
    return translated(
        "Cheapest: {values}; {limit} governs", values=", ".join(words), limit=figures.literal_text(found.governs)
    )


def _draw_design_costs(axes: Axes, found: BestDesign, variable: str, styles: dict[str, LineStyle]) -> None:
    scale = _DesignVariableAxis(variable, found.designs)
    curve = trade_off(found, variable)
    for label, style in styles.items():
        cost = np.where(curve["governs"] == label, curve["cost"].to_numpy(float), np.nan)
        axes.plot(scale.of(curve), cost, **style.look, linewidth=1.6, label=label)
    tried, costs = scale.of(found.designs), found.designs["cost"].to_numpy(float)
    _draw_tried_designs(axes, tried, costs, found.designs["meets"].to_numpy(bool))
    if found.best is not None:
        bands = {str(row["quantity"]): np.array([row["low"], row["high"]]) for row in found.interval.to_dict("records")}
        across = bands.get(scale.column, np.full(2, np.nan)) / scale.divisor
        x, y = float(tried[found.best]), float(costs[found.best])
        for ends in ((across, [y, y]), ([x, x], bands["cost"])):
            axes.plot(*ends, color=_design_text_color(), linewidth=2.0, alpha=0.6, label="_band", solid_capstyle="butt")
        _mark_best_design(axes, x, y)
    axes.set(xlabel=scale.name, ylabel=translated("cost"))


def _draw_design_plane(
    axes: Axes, found: BestDesign, between: InterpolatedMargins, names: tuple[str, str], styles: dict[str, LineStyle]
) -> None:
    """Draw the limits over two variables; the others have their values in the best design, or in the nearest to it."""
    designs = found.designs
    place = found.best
    if place is None:
        margins = requirement_margins(designs[list(styles)].to_numpy(float), found.requirements)
        place = int(np.nan_to_num(margins, nan=np.inf).max(axis=1).argmin())
    values = {name: np.array([float(designs[name].iloc[place])]) for name in between.given}
    for name in names:
        values[name] = np.linspace(between.given[name][0], between.given[name][-1], _FINE)
    table = between.designs(values)
    across, up = (_DesignVariableAxis(name, designs) for name in names)
    shape = _FINE, _FINE
    x, y = (scale.of(table).reshape(shape) for scale in (across, up))
    margins = between.at(table)
    worst = margins.max(axis=1).reshape(shape)
    axes.contourf(x, y, worst, levels=[0.0, np.inf], colors=[_design_text_color()], alpha=0.12)
    for column, (_, style) in enumerate(styles.items()):
        each = margins[:, column].reshape(shape)
        if each.min() < 0.0 < each.max():
            axes.contour(x, y, each, levels=[0.0], colors=[style.color], linestyles=[style.dashes], linewidths=1.6)
    cost = np.asarray(found.cost.of(table["half_width"], table["prestress"], table["dissipator_force"]), dtype=float)
    if cost.max() > cost.min():
        lines = axes.contour(
            x, y, cost.reshape(shape), levels=6, colors=[_design_text_color()], linewidths=0.6, linestyles="dotted"
        )
        axes.clabel(lines, fontsize=SMALL, fmt=short_number)
    others = [name for name in between.given if name not in names]
    near = np.all([np.isclose(designs[name], values[name][0]) for name in others], axis=0) if others else slice(None)
    there = designs[near] if others else designs
    _draw_tried_designs(axes, across.of(there), up.of(there), there["meets"].to_numpy(bool))
    if found.best is not None:
        _mark_best_design(axes, float(across.of(designs)[place]), float(up.of(designs)[place]))
    fixed = [_DesignVariableAxis(name, designs) for name in others]
    words = [f"{s.words} = {short_number(float(s.of(designs)[place]))} {s.unit}" for s in fixed]
    axes.set(xlabel=across.name, ylabel=up.name, title=", ".join(words))


def _draw_tried_designs(axes: Axes, x: Array, y: Array, met: Bools) -> None:
    for which, face in ((~met, "none"), (met, _design_text_color())):
        if not which.any():  # an empty line that is not clipped spoils the layout
            continue
        axes.plot(
            x[which], y[which], "o", markersize=_MARK, markerfacecolor=face, markeredgecolor=_design_text_color(),
            markeredgewidth=0.6, alpha=0.75, label="_runs", clip_on=False,
        )  # fmt: skip


def _mark_best_design(axes: Axes, x: float, y: float) -> None:
    axes.plot(
        [x], [y], "o", markersize=11.0, markerfacecolor="none", markeredgecolor=RED, markeredgewidth=1.8,
        label="_best", zorder=4.0, clip_on=False,
    )  # fmt: skip
