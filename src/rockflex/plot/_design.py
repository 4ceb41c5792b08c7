"""Probability or annual rate of exceeding a limit over the half width of the base."""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._errors import InputError
from rockflex.fragility import OVERTURNED, OVERTURNING, beyond, symbol_of_nominal
from rockflex.plot._study_tables import MARKERS, check_columns, keys_of, names_in, structure_panels
from rockflex.plot._style import BLACK, BLUE, GREEN, LOOKS, RED, SMALL, Look, Size, columns, literal, recoloured, styled
from rockflex.plot._units import short

if TYPE_CHECKING:
    import pandas as pd


_NEEDED = (
    "model",
    "tendon",
    "half_width",
    "aspect_ratio",
    "prestress_ratio",
    "stiffness_ratio",
    "limit",
    "low",
    "high",
)
_SOURCE = "what design_table returned"
_LOOKS = (Look(BLACK, "-"), Look(RED, "--"), Look(GREEN, "-."), *LOOKS)
_DECADES = 4.0  # of rates below the largest that are shown, or below the target


class _Value(NamedTuple):
    """The column plotted, its name on the axis, and whether that axis is logarithmic."""

    column: str
    name: str
    logarithmic: bool


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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> runs = rf.run_design(frame, pulses, half_widths=[1.0, 1.5], models="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> table = rf.design_table(runs, 0.005, at=0.5, confidence=None)
    >>> figure = rf.plot_design(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('half width $B$ [m]', 'P($θ_{\\mathrm{max}}>0.005\\ \\mathrm{rad}$)')
    """
    value = "rate" if "rate" in getattr(table, "columns", ()) else "probability"
    check_columns(table, (*_NEEDED, value), _SOURCE)
    tendons, models = names_in(table["tendon"]), names_in(table["model"])
    if len(tendons) > len(MARKERS):
        raise InputError(f"{len(tendons)} tendons were given, but there are {len(MARKERS)} symbols. Plot some of them.")
    found = None if target is None else _least(table, target)
    looks: dict[str, tuple[Look, str]] = dict(
        zip(tendons, zip(recoloured(_LOOKS), MARKERS, strict=False), strict=False)
    )
    drawn = _Value(value, _words(table, value), value == "rate" if logarithmic is None else logarithmic)
    with styled(size=size):
        figure, panels = structure_panels(models, 2, 2.9, "half width $B$ [m]", drawn.name)
        for axes, model in zip(panels, models, strict=True):
            for tendon, (look, marker) in looks.items():
                _draw(axes, _of(table, model, tendon), drawn, look, marker, tendon)
            if found is not None and target is not None:
                axes.axhline(target, color=BLUE, linewidth=0.8, dashes=(5, 3), label="_target")
                _answer(axes, _of(found, model), looks, target)
        _limits(panels, table, drawn, target)
        for axes in panels:
            _slenderness(axes, table)
        handles = keys_of({literal(tendon): look for tendon, look in looks.items()})
        if target is not None:
            handles.append(Line2D([], [], color=BLUE, linewidth=0.8, dashes=(5, 3), label=f"target {short(target)}"))
        labels = [str(handle.get_label()) for handle in handles]
        width = 42 + 44 * (len(panels) > 1)
        figure.legend(handles=handles, loc="outside upper center", ncols=columns(labels, width))
    return figure


def _least(table: "pd.DataFrame", target: float) -> "pd.DataFrame":
    from rockflex.study.design import smallest_width

    return smallest_width(table, target)


def _of(table: "pd.DataFrame", model: str, tendon: str | None = None) -> "pd.DataFrame":
    rows = table[table["model"].astype(str) == model]
    return rows if tendon is None else rows[rows["tendon"].astype(str) == tendon].sort_values("half_width")


def _words(table: "pd.DataFrame", value: str) -> str:
    """Name of the values on the axis: one limit in rad, one multiple of 0.7 atan(B/h*_1), or overturning."""
    limits, nominal = table["limit"].to_numpy(float), 0.7 * np.arctan(1.0 / table["aspect_ratio"].to_numpy(float))
    known = np.isfinite(limits)
    event = "limit"
    if known.any():
        first, multiple = limits[known][0], (limits / nominal)[known]
        if np.allclose(limits[known], first, rtol=1e-9):
            event = (OVERTURNING if first == OVERTURNED else beyond(first)).symbol
        elif np.allclose(multiple, multiple[0], rtol=1e-9):
            event = symbol_of_nominal(multiple[0])
        else:
            raise InputError("The designs have limits of several kinds. Plot the table of one limit.")
    event = f"${event}$" if ">" in event else event
    return f"annual rate of {event}" if value == "rate" else f"P({event})"


def _draw(axes: Axes, rows: "pd.DataFrame", drawn: _Value, look: Look, marker: str, name: str) -> None:
    b, y, low, high = (rows[column].to_numpy(float) for column in ("half_width", drawn.column, "low", "high"))
    shown = np.isfinite(y) & ((y > 0.0) | (not drawn.logarithmic))
    axes.plot(
        b[shown], y[shown], color=look.color, linestyle=look.dashes, marker=marker, markersize=3.5,
        markerfacecolor="none", markeredgewidth=0.7, label=name,
    )  # fmt: skip
    bounded = np.isfinite(low) & np.isfinite(high)
    floor = 1e-300 if drawn.logarithmic else 0.0
    axes.fill_between(
        b, np.maximum(low, floor), np.maximum(high, floor), where=bounded, color=look.color, alpha=0.13,
        linewidth=0.0, label="_band",
    )  # fmt: skip


def _answer(axes: Axes, found: "pd.DataFrame", looks: dict[str, tuple[Look, str]], target: float) -> None:
    """Draw a ring where each curve meets the target, and list the half widths."""
    lines: list[tuple[str, str]] = []
    for row in found.to_dict("records"):
        look, _ = looks[str(row["tendon"])]
        width = float(row["half_width"])
        met = row["outcome"] in ("met", "met more than once")
        if met:
            axes.plot(
                [width], [target], "o", color=look.color, markersize=7.0, markerfacecolor="none", markeredgewidth=1.2,
                label="_answer", zorder=3.0,
            )  # fmt: skip
        text = f"B {'=' if met else '≤'} {width:.3g} m" if math.isfinite(width) else "not met"
        lines.append((text + " (met more than once)" * (row["outcome"] == "met more than once"), look.color))
    for place, (text, color) in enumerate(lines):
        axes.annotate(
            text, (0.97, 0.95), xytext=(0.0, -11.0 * place), xycoords="axes fraction", textcoords="offset points",
            ha="right", va="top", fontsize=SMALL, color=color,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
        )  # fmt: skip


def _limits(panels: list[Axes], table: "pd.DataFrame", drawn: _Value, target: float | None) -> None:
    b = table["half_width"].to_numpy(float)
    margin = 0.04 * float(np.ptp(b)) or 0.1 * float(b[0])
    panels[0].set_xlim(max(float(b.min()) - margin, 0.5 * float(b.min())), float(b.max()) + margin)
    values = np.concatenate([table[name].to_numpy(float) for name in (drawn.column, "high")])
    values = np.append(values[np.isfinite(values)], target or 0.0)
    top = float(values.max(initial=0.0)) or 1.0
    if drawn.logarithmic:
        seen = table[drawn.column].to_numpy(float)
        seen = np.append(seen[seen > 0.0], target or top)
        panels[0].set_yscale("log")
        panels[0].set_ylim(0.5 * max(float(seen.min()), min(top, target or top) * 10.0**-_DECADES), 2.0 * top)
    else:
        panels[0].set_ylim(-0.03 * top, 1.05 * top)


def _slenderness(axes: Axes, table: "pd.DataFrame") -> None:
    """Draw the axis of h*_1/B at the top."""
    height = float((table["half_width"] * table["aspect_ratio"]).iloc[0])
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
