"""Base moment over rotation as the models have it, of a pinned beam and of a rocking base."""

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._checks import positive
from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.plot._style import BLACK, GRAY, SMALL, letter, new_figure, styled
from rockflex.plot._units import readable, short
from rockflex.study import Structure, properties_of

__all__ = ["plot_moment_rotation_laws"]

_ROOM = 1.18


def plot_moment_rotation_laws(
    structure: "Structure | RockingProperties", spring: float | None = None, *, rotation: float | None = None
) -> Figure:
    """Plot the static base moment over the rotation: of a pinned beam on a spring, and of the rocking structure.

    The figure is that of Silva & Stojadinović 2024, Fig. 11: M = k_r θ, and M = ±(M_r + k |θ|) with the slope
    k = -L_0^r g, to which tendons add theirs. While the base stands, M is anything between -M_r and M_r.

    Parameters
    ----------
    structure
        The rocking structure, or its `RockingProperties`.
    spring
        Stiffness k_r of the pinned beam's spring in N m/rad, positive. Default: L_0^r g, so that the slopes
        differ in sign alone.
    rotation
        Largest rotation shown in rad. Default: a little beyond the one at which M vanishes, or the nominal
        overturning rotation where tendons keep it from vanishing.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes; θ in rad, M in the unit that suits its size.

    Raises
    ------
    InputError
        If no structure is given, or a number is not positive and finite.
    """
    p = properties_of(structure)
    zero = -p.resisting_moment / p.rocking_stiffness if p.rocking_stiffness < 0.0 else math.inf
    default = _ROOM * zero if math.isfinite(zero) else p.nominal_overturning_rotation
    end = default if rotation is None else positive("rotation", rotation, "rad")
    stiffness = p.l0r * GRAVITY if spring is None else positive("spring", spring, "N m/rad")
    last = p.resisting_moment + p.rocking_stiffness * end
    largest = max(p.resisting_moment, abs(last))
    factor, unit = readable(largest, "N m")
    with styled():
        figure = new_figure(6.3, 3.1)
        left, right = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, mark, title in ((left, "A", "pinned beam on a spring"), (right, "B", "rocking base")):
            axes.axhline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.axvline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.set_title(title)
            axes.set_xlabel("θ [rad]")
            axes.tick_params(labelleft=True)
            letter(axes, mark)
        left.set_ylabel(f"M [{unit}]")
        left.set_xlim(-end, end)
        left.set_ylim(-_ROOM * largest / factor, _ROOM * largest / factor)
        left.locator_params(axis="x", nbins=5)
        moment = stiffness * end / factor
        left.plot([-end, end], [-moment, moment], color=BLACK, linewidth=1.4, label="pinned beam")
        start, last = p.resisting_moment / factor, last / factor
        right.plot([-end, 0.0, 0.0, end], [-last, -start, start, last], color=BLACK, linewidth=1.4, label="rocking")
        _note(left, f"slope $k_r$ =\n{_with_unit(stiffness, 'N m/rad')}", low=True)
        low = last > -0.3 * start
        slope, resisting, vanishing = _slope(p), f"$M_r$ = {_with_unit(p.resisting_moment, 'N m')}", ""
        if zero <= end:
            right.plot([-zero, zero], [0.0, 0.0], "o", color=BLACK, markersize=4.0, markerfacecolor="white", label="_0")
            vanishing = f"$M$ = 0 at ±{short(zero)} rad"
        elif math.isinf(zero):
            vanishing = "$M$ does not vanish"
        if low:
            right.annotate(
                resisting, (0.0, start), xytext=(-4, 0), ha="right", va="center", textcoords="offset points",
                fontsize=SMALL,
            )  # fmt: skip
        _note(right, "\n".join(filter(None, (slope, vanishing) if low else (vanishing, slope, resisting))), low=low)
    return figure


def _slope(p: RockingProperties) -> str:
    name = r"-L_0^r\,g" if p.tendon_stiffness == 0.0 else r"k_t - L_0^r\,g"
    return f"slope ${name}$ =\n{_with_unit(p.rocking_stiffness, 'N m/rad')}"


def _with_unit(value: float, unit: str) -> str:
    factor, named = readable(value, unit)
    return f"{short(value / factor)} {named}"


def _note(axes: Axes, text: str, *, low: bool) -> None:
    """Write into the lower or the upper right corner, whichever the curve leaves free."""
    axes.text(
        0.97, 0.03 if low else 0.97, text, transform=axes.transAxes, ha="right", va="bottom" if low else "top",
        fontsize=SMALL, linespacing=1.5,
    )  # fmt: skip
