"""A ground motion and its spectrum."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.motion import MEASURES, GroundMotion, Shaking
from rockflex.plot._style import BLACK, BLUE, ORANGE, SHADE, Size, literal, narrow, new_figure, points, styled
from rockflex.plot._units import short

_PERIODS = np.geomspace(0.02, 10.0, 240)
_DAMPING = 0.05


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
        ("a", "m/s²", motion.acceleration, f"{_told('pga', motion)} ({short(motion.pga / GRAVITY)} g)"),
        ("v", "m/s", motion.velocity, _told("pgv", motion)),
        ("d", "m", motion.displacement, _told("pgd", motion)),
    ]
    if motion.vertical is not None:
        histories.insert(
            1, ("a_v", "m/s²", motion.vertical, f"{_told('pva', motion)} ({short(motion.pva / GRAVITY)} g)")
        )
    with styled(size=size):
        figure = new_figure(7.2, 1.0 + 1.2 * len(histories) + 2.4 * narrow())
        if narrow():
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
            axes.set_title(peak, loc="right", fontsize=points(8.0))
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
            axes.legend(loc="upper right", fontsize=points(8.0))
            largest = max(largest, float(upwards.sa.max()))
        axes.set(xscale="log", xlim=(_PERIODS[0], _PERIODS[-1]), ylim=(0.0, 1.08 * largest or 1.0))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set(xlabel="$T$ [s]", ylabel="$S_a$ [m/s²]")
        measures = f"{_told('arias', motion)}, {_told('d5_95', motion)} (shaded)"
        axes.set_title(f"{measures}\nspectrum for ζ = {100.0 * _DAMPING:g} %", fontsize=points(8.0))
        figure.suptitle(literal(motion.name) or "ground motion", fontsize="medium")
    return figure


def _told(name: str, motion: GroundMotion) -> str:
    """Symbol, value and unit of a measure."""
    measure = MEASURES[name]
    return f"{measure.sign} = {short(measure.of(Shaking(motion)))} {measure.unit}"
