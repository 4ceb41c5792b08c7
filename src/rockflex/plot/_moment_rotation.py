"""Base moment over rotation: of responses, and the static laws of a structure."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array
from rockflex._checks import checked_positive
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._number_format import short_number, unit_with_prefix
from rockflex.modal import Pivot, RockingProperties
from rockflex.plot._loops import is_moment_path_independent, resisting_moments
from rockflex.plot._response_curves import ResponseCurve, response_curves, rotation_axis_limit
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    SMALL,
    Size,
    add_legend_above,
    is_narrow_figure,
    label_panel,
    new_figure,
    with_figure_style,
)
from rockflex.response import Response, resistance_on_springs, static_path
from rockflex.study import RockingStructure, rocking_properties_of

_LIMIT = 1.1
_PER_ROW = 3
_WITHOUT_TENDONS = r"$\pm(m_{tot}\,g\,B - L_0^r\,g\,|θ|)$"
_WITH_TENDONS = r"$\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$"
_PATH = "resisting moment of weight and elements"
_SPRINGS = "static, on the springs"
_EACH_SIDE = r"$\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$ of each side"
_MARGIN = 1.18


def plot_moment_rotation(
    responses: Response | Iterable[Response], labels: Sequence[str] | None = None, *, size: Size | None = None
) -> Figure:
    """Plot the base moment M_b over the rotation θ, and the static resisting moment of the simplified models.

    The resisting moment is ±(M_r - L_0^r g |θ|), with M_r = m_tot g B (Silva & Stojadinović 2024, Fig. 11 and Eq. 23);
    tendons add their prestress to M_r and their stiffness k_t to the slope, and the two sides differ if the base is
    eccentric or the tendons are not symmetric. With elements that yield, slide or damp, the resisting moment depends on
    the path, and that of the run is plotted: `plot_loops` shows its parts. On springs the static moment is that of
    `moment_rotation`. M_b is the moment of the elastic forces; it
    differs from the resisting moment by rotational inertia and damping. Responses on a fixed base have no rotation and
    are left out. Overturning does not extend the axes.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response. Default: the models, with the motions if a model occurs twice.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per response, three per row, with common scales; θ in rad, M_b in a unit that suits its size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels differs, or no base can
        lift; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_moment_rotation(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('', '')
    """
    curves = [curve for curve in response_curves(responses, labels) if curve.lifts]
    if not curves:
        raise InputError(
            "None of the responses has a base that can lift, so there is no moment over rotation to plot. "
            'Give at least one of a model that rocks, such as "2DOF-S".'
        )
    rotation = _LIMIT * (rotation_axis_limit(curves) or max(map(static_line_rotation, curves)))
    largest = max(largest_base_moment_on_axes(curve) for curve in curves)
    factor, unit = unit_with_prefix(largest, "N m")
    with with_figure_style(size=size):
        columns = 1 if is_narrow_figure() else min(len(curves), _PER_ROW)
        rows = math.ceil(len(curves) / columns)
        figure = new_figure(2.2 + 1.8 * columns, 0.6 + 2.6 * rows)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        panels: list[Axes] = list(grid.flat)
        panels[0].set(xlim=(-rotation, rotation), ylim=(-_LIMIT * largest / factor, _LIMIT * largest / factor))
        panels[0].locator_params(axis="x", nbins=5)
        for axes, curve in zip(panels, curves, strict=False):
            moment = curve.history.base_moment / factor
            axes.plot(curve.history.rotation, moment, color=curve.style.color, linewidth=0.8, label=curve.label)
            axes.add_line(resisting_moment_line(curve, rotation, factor))
            axes.set_title(curve.label)
            axes.tick_params(labelbottom=True)
        for axes in panels[len(curves) :]:
            axes.set_axis_off()
        figure.supxlabel("θ [rad]", fontsize="medium")
        figure.supylabel(f"$M_b$ [{unit}]", fontsize="medium")
        kinds = {line.get_label(): line for axes in panels for line in axes.get_lines()[1:]}
        add_legend_above(figure, list(kinds.values()), max_columns=1, handlelength=3.0)
    return figure


def static_line_rotation(curve: ResponseCurve) -> float:
    """Rotation up to which the static line is shown: where the moment vanishes, if it does."""
    balance = curve.balance_rotation
    return balance if math.isfinite(balance) else curve.history.model.properties.nominal_overturning_rotation


def largest_base_moment_on_axes(curve: ResponseCurve) -> float:
    """Largest moment on the axes: of the static moment, and of M_b without overturning."""
    moment = curve.response.max_base_moment
    if curve.falls:
        moment = float(np.max(np.abs(curve.history.base_moment[curve.before_fall])))
    p = curve.history.model.properties
    held = 0.0 if is_moment_path_independent(p) else float(np.max(np.abs(_uplifted_moment_path(curve)[1]), initial=0.0))
    return max(moment, held, *(pivot.resisting_moment for pivot in p.pivots))


def _uplifted_moment_path(curve: ResponseCurve) -> tuple[Array, Array]:
    """Rotation and resisting moment while the base is off the ground."""
    history, until_fall = curve.history, curve.before_fall
    on_springs = resistance_on_springs(history)
    if on_springs is not None:
        return history.rotation[until_fall], on_springs.moment[until_fall]
    weight, parts = resisting_moments(history)
    rocking = np.flatnonzero(history.side[until_fall] != 0.0)
    return history.rotation[rocking], (weight + parts.sum(axis=1))[rocking]


def resisting_moment_line(curve: ResponseCurve, rotation: float, factor: float) -> Line2D:
    model, p = curve.history.model, curve.history.model.properties
    if not is_moment_path_independent(p):
        theta, moment = _uplifted_moment_path(curve)
        return Line2D(theta, moment / factor, color=BLUE, linewidth=0.8, label=_PATH, zorder=3.0)
    dashes = (0, (4, 2))
    if model.springs is not None:
        push = static_path(p, np.array([rotation, -rotation]), model.springs, model.rest)
        return Line2D(
            push.rotation, push.moment / factor, color=BLUE, linestyle=dashes, linewidth=1.1, label=_SPRINGS, zorder=3.0
        )
    right, left = (
        (each.resisting_moment / factor, (each.resisting_moment + each.rocking_stiffness * rotation) / factor)
        for each in (p.pivot(1), p.pivot(-1))
    )
    law = (_WITH_TENDONS if p.tendons else _WITHOUT_TENDONS) if p.symmetric else _EACH_SIDE
    return Line2D(
        [-rotation, 0.0, 0.0, rotation], [-left[1], -left[0], *right], color=BLUE, linestyle=dashes,
        linewidth=1.1, label="static, " + law, zorder=3.0,
    )  # fmt: skip


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
    p = rocking_properties_of(structure)
    sides = (p.pivot(1), p.pivot(-1))
    zeros = [side.balance_rotation for side in sides]
    vanishing = [zero for zero in zeros if math.isfinite(zero)]
    default = _MARGIN * max(vanishing) if vanishing else max(each.nominal_overturning_rotation for each in sides)
    end = default if rotation is None else checked_positive("rotation", rotation, "rad")
    stiffness = p.l0r * GRAVITY if spring is None else checked_positive("spring", spring, "N m/rad")
    pushes = [_first_pushover_branch(p, side, end) for side in (1, -1)]
    starts, lasts = ([moment[place] for _, moment in pushes] for place in (0, -1))
    largest = max(float(np.max(np.abs(moment))) for _, moment in pushes)
    factor, unit = unit_with_prefix(largest, "N m")
    line = is_moment_path_independent(p)
    if not line:
        zeros = [_rotation_of_zero_moment(*push) for push in pushes]
    with with_figure_style(size=size):
        figure = new_figure(6.3, 5.6 if is_narrow_figure() else 3.1)
        left, right = figure.subplots(*((2, 1) if is_narrow_figure() else (1, 2)), sharex=True, sharey=True)
        for axes, mark, title in ((left, "A", "pinned beam on a spring"), (right, "B", "rocking base")):
            axes.axhline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.axvline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.set(title=title, xlabel="θ [rad]")
            axes.tick_params(labelleft=True)
            label_panel(axes, mark)
        left.set(ylabel=f"M [{unit}]", xlim=(-end, end), ylim=(-_MARGIN * largest / factor, _MARGIN * largest / factor))
        left.locator_params(axis="x", nbins=5)
        moment = stiffness * end / factor
        left.plot([-end, end], [-moment, moment], color=BLACK, linewidth=1.4, label="pinned beam")
        right.plot(
            np.concatenate((-pushes[1][0][::-1], pushes[0][0])),
            np.concatenate((-pushes[1][1][::-1], pushes[0][1])) / factor,
            color=BLACK, linewidth=1.4, label="rocking",
        )  # fmt: skip
        _write_moment_note(left, f"slope $k_r$ =\n{_moment_with_unit(stiffness, 'N m/rad')}", low=True)
        starts, lasts = [start / factor for start in starts], [last / factor for last in lasts]
        low = lasts[0] > -0.3 * starts[0]
        crossings = [sign * zero for sign, zero in ((-1.0, zeros[1]), (1.0, zeros[0])) if zero <= end]
        if crossings:
            right.plot(
                crossings, [0.0] * len(crossings), "o", color=BLACK, markersize=4.0, markerfacecolor="white", label="_0"
            )
        slope = _moment_slope_text(sides, symmetric=p.symmetric) if line else ""
        zero = _vanishing_moment_text(zeros, end, symmetric=p.symmetric) if line or min(zeros) <= end else ""
        resisting = [f"$M_r$ = {_moment_with_unit(start * factor, 'N m')}" for start in starts]
        corners = not p.symmetric or low  # where M_r is written; else with the rest
        if corners:
            _write_beside_moment_corner(right, resisting[0], starts[0], left=True)
        if not p.symmetric:
            _write_beside_moment_corner(right, resisting[1], -starts[1], left=False)
            for rotation in crossings:
                _write_above_rotation(right, f"{short_number(rotation)} rad", rotation)
        lines = (slope, zero) if corners else (zero, slope, resisting[0])
        at = 0.48 if low and not p.symmetric else None  # between the axis and the lower corner
        _write_moment_note(right, "\n".join(filter(None, lines)), low=low, at=at)
    return figure


def _first_pushover_branch(p: RockingProperties, side: int, end: float) -> tuple[Array, Array]:
    """Rotation |θ| and moment, positive, of a first push to one side, from lift-off on."""
    push = static_path(p, np.array([side * end]))
    return np.abs(push.rotation[1:]), side * push.moment[1:]


def _rotation_of_zero_moment(rotation: Array, moment: Array) -> float:
    """Rotation at which the moment first vanishes; infinite if it does not."""
    below = np.flatnonzero((moment[:-1] > 0.0) & (moment[1:] <= 0.0))[:1]
    if not below.size:
        return math.inf
    k = int(below[0])
    return float(rotation[k] + (rotation[k + 1] - rotation[k]) * moment[k] / (moment[k] - moment[k + 1]))


def _moment_slope_text(sides: tuple[Pivot, Pivot], *, symmetric: bool) -> str:
    held = any(side.tendon_stiffness for side in sides)
    name = r"k_t - L_0^r\,g" if held else r"-L_0^r\,g"
    values = [_moment_with_unit(side.rocking_stiffness, "N m/rad") for side in sides]
    return f"slope ${name}$ =\n{_text_for_each_side(values, symmetric=symmetric or not held)}"


def _vanishing_moment_text(zeros: list[float], end: float, *, symmetric: bool) -> str:
    """Text about the rotations at which M vanishes, if they are shown."""
    if symmetric:
        if zeros[0] <= end:
            return f"$M$ = 0 at ±{short_number(zeros[0])} rad"
        return "$M$ does not vanish" if math.isinf(zeros[0]) else ""
    # Written beside the marks, as each side has its own.
    return "$M$ does not vanish" if all(map(math.isinf, zeros)) else ""


def _text_for_each_side(values: list[str], *, symmetric: bool) -> str:
    return values[0] if symmetric else f"{values[0]} (right)\n{values[1]} (left)"


def _moment_with_unit(value: float, unit: str) -> str:
    factor, named = unit_with_prefix(value, unit)
    return f"{short_number(value / factor)} {named}"


def _write_beside_moment_corner(axes: Axes, text: str, moment: float, *, left: bool) -> None:
    """Write next to the corner of the curve at θ = 0, on the free side."""
    axes.annotate(
        text, (0.0, moment), xytext=(-4 if left else 4, 0), ha="right" if left else "left", va="center",
        textcoords="offset points", fontsize=SMALL,
    )  # fmt: skip


def _write_above_rotation(axes: Axes, text: str, rotation: float) -> None:
    axes.annotate(
        text, (rotation, 0.0), xytext=(5, 4), ha="left", va="bottom", textcoords="offset points", fontsize=SMALL
    )


def _write_moment_note(axes: Axes, text: str, *, low: bool, at: float | None = None) -> None:
    """Write into the lower or the upper right corner, whichever is free, or below a given height."""
    height = at if at is not None else (0.03 if low else 0.97)
    axes.text(
        0.97, height, text, transform=axes.transAxes, ha="right", va="bottom" if low and at is None else "top",
        fontsize=SMALL, linespacing=1.5,
    )  # fmt: skip
