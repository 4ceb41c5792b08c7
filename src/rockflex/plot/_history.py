"""Response histories of several models in four panels."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rockflex.plot._curves import Curve, curves_of, rotation_limit
from rockflex.plot._style import GRAY, SHADE, SMALL, columns, letter, literal, new_figure, styled
from rockflex.plot._units import readable, short

if TYPE_CHECKING:
    from rockflex.response import History, Response

__all__ = ["plot_history"]

_HEADROOM = 1.12
_BAR = 0.025  # height of an uplift bar as a share of the panel


@dataclass(frozen=True)
class _Quantity:
    letter: str
    symbol: str
    name: str
    unit: str
    prefixed: bool
    of: "Callable[[History], NDArray[np.float64]]"


_QUANTITIES = (
    _Quantity("A", "θ", "rotation", "rad", False, lambda h: h.rotation),
    _Quantity("B", r"$u_{\mathrm{top}}$", "top_displacement", "m", False, lambda h: h.top_displacement),
    _Quantity("C", r"$M_b$", "base_moment", "N m", True, lambda h: h.base_moment),
    _Quantity("D", r"$V_b$", "base_shear", "N", True, lambda h: h.base_shear),
)


def plot_history(
    responses: "Response | Iterable[Response]", labels: Sequence[str] | None = None, *, title: str | None = None
) -> Figure:
    """Plot rotation θ, top displacement u_top, base moment M_b and base shear V_b over time, a panel each.

    The figure is that of Silva & Stojadinović 2024, Fig. 15. The time in which the base of the most detailed model is
    uplifted is shaded; where several models rock, a bar for each at the foot of panel A shows when. Circles mark
    the true peaks, which stand with their times beside each panel. The phase in which a structure overturns does
    not stretch the axes: a triangle shows where its rotation leaves panel A, and a dotted line when |θ| = π/2.

    Parameters
    ----------
    responses
        One response or several, each with its history, of one structure or of several.
    labels
        A name for each response in the legend. Default: the models, with the motions where a model occurs twice.
    title
        Default: the name of the motion, if there is only one.

    Returns
    -------
    matplotlib.figure.Figure
        Four axes over one time axis in s; θ in rad, u_top in m, M_b and V_b in the unit that suits their size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, or there is not one label a response.
    """
    curves = curves_of(responses, labels)
    motions = {curve.response.motion for curve in curves}
    if title is None:
        title = literal(next(iter(motions))) if len(motions) == 1 else ""
    handles: list[Artist] = []
    with styled():
        figure = new_figure(6.3, 4 * max(1.45, 0.155 * (len(curves) + 2)) + 0.8)
        panels: list[Axes] = list(figure.subplots(4, 1, sharex=True))
        for axes, quantity in zip(panels, _QUANTITIES, strict=True):
            handles = _draw(axes, quantity, curves)
        names = [curve.label for curve in curves]
        main = _shade_uplifts(panels, curves)
        if main is not None:
            handles.append(Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4))
            names.append(f"uplifted: {main.label}" if len(curves) > 1 else "uplifted")
        panels[-1].set_xlabel("time [s]")
        panels[-1].set_xlim(
            min(float(curve.history.time[0]) for curve in curves),
            max(float(curve.history.time[-1]) for curve in curves),
        )
        figure.align_ylabels()
        figure.legend(
            handles, names, loc="outside upper center", ncols=columns(names, 88), title=title,
            title_fontsize=9.0, handlelength=2.6, columnspacing=1.4,
        )  # fmt: skip
    return figure


def _draw(axes: Axes, quantity: _Quantity, curves: list[Curve]) -> list[Artist]:
    """Fill one panel; return a line for each curve."""
    largest = max(_largest(curve, quantity) for curve in curves)
    if quantity.name == "rotation":
        largest = rotation_limit(curves)
    factor, unit = readable(largest, quantity.unit) if quantity.prefixed else (1.0, quantity.unit)
    limit = _HEADROOM * largest / factor if largest > 0.0 else 1e-3
    axes.set_ylim(-limit, limit)
    axes.set_ylabel(f"{quantity.symbol} [{unit}]")
    letter(axes, quantity.letter)
    lines: list[Artist] = []
    notes = [("peaks", "#404040")]
    for curve in curves:
        look = curve.look
        lines += axes.plot(
            curve.history.time, quantity.of(curve.history) / factor, color=look.color, linestyle=look.dashes,
            linewidth=look.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
        if curve.overturned:
            axes.axvline(curve.response.end_time, color=look.color, linestyle=":", linewidth=0.8, zorder=1.5)
        if curve.falls and quantity.name == "rotation":
            _mark_fall(axes, curve, limit)
        notes.append((_mark_peak(axes, quantity, curve, factor), look.color))
    for row, (text, color) in enumerate(notes):
        axes.annotate(
            text, (1.0, 1.0), xytext=(5.0, -1.0 - 10.0 * row), xycoords="axes fraction", textcoords="offset points",
            color=color, fontsize=SMALL, va="top", annotation_clip=False,
        )  # fmt: skip
    return lines


def _largest(curve: Curve, quantity: _Quantity) -> float:
    """Largest magnitude that the axis must hold."""
    if not curve.falls:
        return float(getattr(curve.response, f"max_{quantity.name}"))
    return float(np.max(np.abs(quantity.of(curve.history)[curve.before_fall])))


def _mark_peak(axes: Axes, quantity: _Quantity, curve: Curve, factor: float) -> str:
    """Circle the true peak, which may lie between two nodes of the curve; return what to write of it."""
    if curve.overturned and quantity.name == "rotation":
        return f"overturned, {curve.response.end_time:.2f} s"
    peak = float(getattr(curve.response, f"max_{quantity.name}")) / factor
    when = float(getattr(curve.response, f"time_of_max_{quantity.name}"))
    if peak == 0.0:
        return "0"
    side = float(np.sign(np.interp(when, curve.history.time, quantity.of(curve.history))))
    axes.plot(
        [when], [side * peak], "o", color=curve.look.color, markersize=3.5, markerfacecolor="white",
        markeredgewidth=0.9, zorder=3.0,
    )  # fmt: skip
    return f"{short(peak)} at {when:.2f} s"


def _mark_fall(axes: Axes, curve: Curve, limit: float) -> None:
    """Triangle where the rotation leaves the panel for good."""
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


def _shade_uplifts(panels: list[Axes], curves: list[Curve]) -> Curve | None:
    """Shade the uplift of the most detailed model, and return it."""
    rocking = [curve for curve in curves if curve.uplifts.size]
    if not rocking:
        text = "no uplift" if any(curve.lifts for curve in curves) else "fixed base"
        panels[0].text(0.5, 0.75, text, transform=panels[0].transAxes, ha="center", va="center", color="#404040")
        return None
    main = max(rocking, key=lambda curve: curve.history.model.properties.n_modes)
    for axes in panels:
        _draw_spans(axes, main, 0.0, 1.0, SHADE, 0.5)
    if len(rocking) == 1:
        return main
    low, high = panels[0].get_ylim()
    foot = _BAR * (len(rocking) + 1)
    panels[0].set_ylim(low - (high - low) * foot / (1.0 - foot), high)
    for row, curve in enumerate(reversed(rocking)):
        _draw_spans(panels[0], curve, _BAR * (row + 0.35), 0.7 * _BAR, curve.look.color, 2.6)
    return main


def _draw_spans(axes: Axes, curve: Curve, bottom: float, height: float, color: str, order: float) -> None:
    """Bar over every phase of rocking; bottom and height are shares of the panel."""
    spans = [(float(start), float(end - start)) for start, end in curve.uplifts]
    axes.broken_barh(
        spans, (bottom, height), transform=axes.get_xaxis_transform(), color=color, linewidth=0.0, zorder=order
    )
