"""Static base moment over rotation of a pinned beam and of a rocking base."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex._checks import positive
from rockflex._constants import GRAVITY
from rockflex.modal import Pivot, RockingProperties
from rockflex.plot._base_loops import follows_a_line
from rockflex.plot._style import BLACK, GRAY, SMALL, Size, letter, narrow, new_figure, styled
from rockflex.plot._units import readable, short
from rockflex.response import base_path
from rockflex.study import RockingStructure, properties_of

_ROOM = 1.18


def plot_moment_rotation_laws(
    structure: "RockingStructure | RockingProperties",
    spring: float | None = None,
    *,
    rotation: float | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot the static base moment over the rotation: of a pinned beam on a spring, and of the rocking structure.

    The figure is that of Silva & Stojadinović 2024, Fig. 11: M = k_r θ, and M = ±(M_r + k |θ|) with the slope
    k = -L_0^r g, to which tendons add theirs. While the base stands, M is anything between -M_r and M_r. For an
    eccentric base, or tendons that are not symmetric, M_r and k differ between the two sides. With elements that yield
    or slide, the curve is that of a first push to each side; `plot_loops` shows cycles.

    Parameters
    ----------
    structure
        The rocking structure, or its `RockingProperties`.
    spring
        Stiffness k_r of the pinned beam's spring in N m/rad, positive. Default: L_0^r g, so that the slopes
        differ only in sign.
    rotation
        Largest rotation shown in rad. Default: a little beyond the one at which M vanishes, or the nominal
        overturning rotation where tendons keep it from vanishing.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes; θ in rad, M in the unit that suits its size.

    Raises
    ------
    InputError
        If no structure is given, or a number is not positive and finite; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_moment_rotation_laws(frame)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('θ [rad]', 'M [MN m]')
    """
    p = properties_of(structure)
    sides = (p.pivot(1), p.pivot(-1))
    zeros = [side.balance_rotation for side in sides]
    vanishing = [zero for zero in zeros if math.isfinite(zero)]
    default = _ROOM * max(vanishing) if vanishing else max(each.nominal_overturning_rotation for each in sides)
    end = default if rotation is None else positive("rotation", rotation, "rad")
    stiffness = p.l0r * GRAVITY if spring is None else positive("spring", spring, "N m/rad")
    pushes = [_push(p, side, end) for side in (1, -1)]
    starts, lasts = ([moment[place] for _, moment in pushes] for place in (0, -1))
    largest = max(float(np.max(np.abs(moment))) for _, moment in pushes)
    factor, unit = readable(largest, "N m")
    line = follows_a_line(p)
    if not line:
        zeros = [_first_zero(*push) for push in pushes]
    with styled(size=size):
        figure = new_figure(6.3, 5.6 if narrow() else 3.1)
        left, right = figure.subplots(*((2, 1) if narrow() else (1, 2)), sharex=True, sharey=True)
        for axes, mark, title in ((left, "A", "pinned beam on a spring"), (right, "B", "rocking base")):
            axes.axhline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.axvline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.set(title=title, xlabel="θ [rad]")
            axes.tick_params(labelleft=True)
            letter(axes, mark)
        left.set(ylabel=f"M [{unit}]", xlim=(-end, end), ylim=(-_ROOM * largest / factor, _ROOM * largest / factor))
        left.locator_params(axis="x", nbins=5)
        moment = stiffness * end / factor
        left.plot([-end, end], [-moment, moment], color=BLACK, linewidth=1.4, label="pinned beam")
        right.plot(
            np.concatenate((-pushes[1][0][::-1], pushes[0][0])),
            np.concatenate((-pushes[1][1][::-1], pushes[0][1])) / factor,
            color=BLACK, linewidth=1.4, label="rocking",
        )  # fmt: skip
        _note(left, f"slope $k_r$ =\n{_with_unit(stiffness, 'N m/rad')}", low=True)
        starts, lasts = [start / factor for start in starts], [last / factor for last in lasts]
        low = lasts[0] > -0.3 * starts[0]
        crossings = [sign * zero for sign, zero in ((-1.0, zeros[1]), (1.0, zeros[0])) if zero <= end]
        if crossings:
            right.plot(
                crossings, [0.0] * len(crossings), "o", color=BLACK, markersize=4.0, markerfacecolor="white", label="_0"
            )
        slope = _slope(sides, symmetric=p.symmetric) if line else ""
        zero = _vanishing(zeros, end, symmetric=p.symmetric) if line or min(zeros) <= end else ""
        resisting = [f"$M_r$ = {_with_unit(start * factor, 'N m')}" for start in starts]
        corners = not p.symmetric or low  # where M_r is written; else with the rest
        if corners:
            _beside(right, resisting[0], starts[0], left=True)
        if not p.symmetric:
            _beside(right, resisting[1], -starts[1], left=False)
            for rotation in crossings:
                _above(right, f"{short(rotation)} rad", rotation)
        lines = (slope, zero) if corners else (zero, slope, resisting[0])
        at = 0.48 if low and not p.symmetric else None  # between the axis and the lower corner
        _note(right, "\n".join(filter(None, lines)), low=low, at=at)
    return figure


def _push(p: RockingProperties, side: int, end: float) -> tuple[Array, Array]:
    """Rotation |θ| and moment, positive, of a first push to one side, from lift-off on."""
    push = base_path(p, np.array([side * end]))
    return np.abs(push.rotation[1:]), side * push.moment[1:]


def _first_zero(rotation: Array, moment: Array) -> float:
    """Rotation at which the moment first vanishes; infinite if it does not."""
    below = np.flatnonzero((moment[:-1] > 0.0) & (moment[1:] <= 0.0))[:1]
    if not below.size:
        return math.inf
    k = int(below[0])
    return float(rotation[k] + (rotation[k + 1] - rotation[k]) * moment[k] / (moment[k] - moment[k + 1]))


def _slope(sides: tuple[Pivot, Pivot], *, symmetric: bool) -> str:
    held = any(side.tendon_stiffness for side in sides)
    name = r"k_t - L_0^r\,g" if held else r"-L_0^r\,g"
    values = [_with_unit(side.rocking_stiffness, "N m/rad") for side in sides]
    return f"slope ${name}$ =\n{_each(values, symmetric=symmetric or not held)}"


def _vanishing(zeros: list[float], end: float, *, symmetric: bool) -> str:
    """Text about the rotations at which M vanishes, if they are shown."""
    if symmetric:
        if zeros[0] <= end:
            return f"$M$ = 0 at ±{short(zeros[0])} rad"
        return "$M$ does not vanish" if math.isinf(zeros[0]) else ""
    # Written beside the marks, as each side has its own.
    return "$M$ does not vanish" if all(map(math.isinf, zeros)) else ""


def _each(values: list[str], *, symmetric: bool) -> str:
    return values[0] if symmetric else f"{values[0]} (right)\n{values[1]} (left)"


def _with_unit(value: float, unit: str) -> str:
    factor, named = readable(value, unit)
    return f"{short(value / factor)} {named}"


def _beside(axes: Axes, text: str, moment: float, *, left: bool) -> None:
    """Write next to the corner of the curve at θ = 0, on the free side."""
    axes.annotate(
        text, (0.0, moment), xytext=(-4 if left else 4, 0), ha="right" if left else "left", va="center",
        textcoords="offset points", fontsize=SMALL,
    )  # fmt: skip


def _above(axes: Axes, text: str, rotation: float) -> None:
    axes.annotate(
        text, (rotation, 0.0), xytext=(5, 4), ha="left", va="bottom", textcoords="offset points", fontsize=SMALL
    )


def _note(axes: Axes, text: str, *, low: bool, at: float | None = None) -> None:
    """Write into the lower or the upper right corner, whichever is free, or below a given height."""
    height = at if at is not None else (0.03 if low else 0.97)
    axes.text(
        0.97, height, text, transform=axes.transAxes, ha="right", va="bottom" if low and at is None else "top",
        fontsize=SMALL, linespacing=1.5,
    )  # fmt: skip
