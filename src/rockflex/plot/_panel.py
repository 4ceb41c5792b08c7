"""One panel of a history: its quantity, curves and peaks, and the overturning of a structure."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.plot._curves import Curve, rotation_limit, title_of
from rockflex.plot._style import SMALL, columns, letter
from rockflex.plot._units import readable, short
from rockflex.response import History

_HEADROOM = 1.12


@dataclass(frozen=True)
class Quantity:
    """The quantity of a panel."""

    symbol: str
    name: str
    unit: str
    prefixed: bool
    of: Callable[[History], Array]


_QUANTITIES = (
    Quantity("θ", "rotation", "rad", False, lambda h: h.rotation),
    Quantity(r"$u_{\mathrm{top}}$, relative", "top_displacement", "m", False, lambda h: h.top_displacement),
    Quantity(r"$u_{\mathrm{top}}$, total", "total_top_displacement", "m", False, lambda h: h.total_top_displacement),
    Quantity(r"$M_b$", "base_moment", "N m", True, lambda h: h.base_moment),
    Quantity(r"$V_b$", "base_shear", "N", True, lambda h: h.base_shear),
    Quantity(r"$ΣF_x$", "horizontal_reaction", "N", True, lambda h: h.horizontal_reaction),
    Quantity("slip", "slip", "m", False, lambda h: h.slip),
    Quantity("rise of edges", "edge_uplift", "m", False, lambda h: h.edge_uplift),
)
_ASKED = ("horizontal_reaction", "slip", "edge_uplift")  # or shown where the ground makes them matter
ALL = tuple(quantity.name for quantity in _QUANTITIES)


def usual_panels(curves: list[Curve]) -> list[str]:
    """All but ΣF_x; total displacement if the height of the top is known, slip and edges if a base slides or heaves."""
    known = all(curve.history.model.properties.top_height is not None for curve in curves)
    usual = [name for name in ALL if name not in _ASKED and (known or name != "total_top_displacement")]
    layouts = [curve.history.model.layout for curve in curves]
    moves = {
        "slip": any(layout.slip >= 0 for layout in layouts),
        "edge_uplift": any(layout.heave >= 0 for layout in layouts),
    }
    return usual + [name for name, happens in moves.items() if happens]


def quantities_of(panels: Sequence[str]) -> list[Quantity]:
    """Quantities by name.

    Raises
    ------
    InputError
        If there are none, or one is unknown or repeated.
    """
    names = [panels] if isinstance(panels, str) else list(panels)
    if not names or len(set(names)) < len(names) or not set(names) <= set(ALL):
        raise InputError(f"panels must be one or more of {', '.join(ALL)}, each once, but {shown(panels)} was given.")
    return [next(quantity for quantity in _QUANTITIES if quantity.name == name) for name in names]


def scale_of(quantity: Quantity, curves: list[Curve]) -> tuple[float, str, float]:
    """Divisor, unit and largest magnitude of an axis, with some room."""
    largest = max(_largest(curve, quantity) for curve in curves)
    if quantity.name == "rotation":
        largest = rotation_limit(curves)
    factor, unit = readable(largest, quantity.unit) if quantity.prefixed else (1.0, quantity.unit)
    return factor, unit, _HEADROOM * largest / factor if largest > 0.0 else 1e-3


def draw_panel(axes: Axes, quantity: Quantity, curves: list[Curve], mark: str) -> list[Artist]:
    """Fill one panel over time and list the peaks beside it; return a line for each curve."""
    lines, peaks = draw_curves(axes, quantity, curves)
    letter(axes, mark)
    notes = [(text, curve.look.color) for text, curve in zip(peaks, curves, strict=True)]
    list_beside(axes, [("peaks", "#404040"), *notes], 10.0)
    return lines


def draw_curves(axes: Axes, quantity: Quantity, curves: list[Curve]) -> tuple[list[Artist], list[str]]:
    """Fill one panel over time; return a line for each curve, and its peak in words."""
    factor, unit, limit = scale_of(quantity, curves)
    low = -limit if quantity.name != "edge_uplift" else -_HEADROOM * _settlement(curves, limit)
    axes.set(ylim=(low, limit), ylabel=f"{quantity.symbol} [{unit}]")
    lines: list[Artist] = []
    peaks: list[str] = []
    for curve in curves:
        look = curve.look
        first, *others = axes.plot(
            curve.history.time, quantity.of(curve.history) / factor, color=look.color, linestyle=look.dashes,
            linewidth=look.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
        lines.append(first)
        for right in others:  # the right edge is thinner than the left one
            right.set(linewidth=0.5 * look.width, label="_right")
        if curve.overturned:
            axes.axvline(curve.response.end_time, color=look.color, linestyle=":", linewidth=0.8, zorder=1.5)
        if curve.falls and quantity.name == "rotation":
            _mark_fall(axes, curve, limit)
        peaks.append(_mark_peak(axes, quantity, curve, factor))
    return lines, peaks


def add_key(
    figure: Figure, curves: list[Curve], handles: list[Artist], names: list[str], title: str | None, width: int
) -> None:
    """Add the legend of a figure above it; a row has room for `width` letters."""
    figure.legend(
        handles, names, loc="outside upper center", ncols=columns(names, width), title=title_of(curves, title),
        title_fontsize="medium", handlelength=2.6, columnspacing=1.4,
    )  # fmt: skip


def list_beside(axes: Axes, notes: list[tuple[str, str]], step: float) -> None:
    """Write lines of text in their colours to the right of a panel, `step` points apart."""
    for row, (text, color) in enumerate(notes):
        axes.annotate(
            text, (1.0, 1.0), xytext=(5.0, -1.0 - step * row), xycoords="axes fraction", textcoords="offset points",
            color=color, fontsize=SMALL, va="top", annotation_clip=False,
        )  # fmt: skip


def _largest(curve: Curve, quantity: Quantity) -> float:
    """Largest magnitude on the axis."""
    if not curve.falls:
        return float(getattr(curve.response, f"max_{quantity.name}"))
    return float(np.max(np.abs(quantity.of(curve.history)[curve.before_fall])))


def _mark_peak(axes: Axes, quantity: Quantity, curve: Curve, factor: float) -> str:
    """Circle the true peak, which may be between two nodes of the curve; return its text."""
    if curve.overturned and quantity.name == "rotation":
        return f"overturned, {curve.response.end_time:.2f} s"
    peak = float(getattr(curve.response, f"max_{quantity.name}")) / factor
    if peak == 0.0:
        return "0"
    when, side = _place(quantity, curve)
    axes.plot(
        [when], [side * peak], "o", color=curve.look.color, markersize=3.5, markerfacecolor="white",
        markeredgewidth=0.9, zorder=3.0,
    )  # fmt: skip
    return f"{short(peak)} at {when:.2f} s"


def _place(quantity: Quantity, curve: Curve) -> tuple[float, float]:
    """Return the time and the sign of a peak."""
    time, values = curve.history.time, quantity.of(curve.history)
    if quantity.name == "edge_uplift":
        return float(time[values.max(axis=1).argmax()]), 1.0
    if quantity.name == "slip":
        node = int(np.abs(values).argmax())
        return float(time[node]), float(np.sign(values[node]))
    when = float(getattr(curve.response, f"time_of_max_{quantity.name}"))
    return when, float(np.sign(np.interp(when, time, values)))


def _settlement(curves: list[Curve], limit: float) -> float:
    """Return how far the edges sink in m, for the lower end of an axis that reaches up to `limit`."""
    return max(*(curve.response.max_edge_settlement for curve in curves), 0.05 * limit)


def _mark_fall(axes: Axes, curve: Curve, limit: float) -> None:
    """Draw a triangle where the rotation finally leaves the panel."""
    rotation, time = curve.history.rotation, curve.history.time
    inside = np.flatnonzero(np.abs(rotation) <= limit)
    last = int(inside[-1]) if inside.size else 0
    if last + 1 == time.size:
        return
    around = slice(last, last + 2)
    when = float(np.interp(limit, np.abs(rotation[around]), time[around]))
    side = float(np.sign(rotation[-1]))
    marker = "^" if side > 0 else "v"
    axes.plot([when], [side * limit], marker, color=curve.look.color, markersize=6.0, clip_on=False, zorder=5.0)
