"""Base moment over rotation."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.plot._base_loops import follows_a_line, resistance_of
from rockflex.plot._curves import Curve, curves_of, rotation_limit
from rockflex.plot._style import BLUE, Size, narrow, new_figure, styled
from rockflex.plot._units import readable
from rockflex.response import Response, push_on_springs, resistance_on_springs

_HEADROOM = 1.1
_PER_ROW = 3
_FREE = r"$\pm(m_{tot}\,g\,B - L_0^r\,g\,|θ|)$"
_HELD = r"$\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$"
_PATH = "resisting moment of weight and elements"
_SPRINGS = "static, on the springs"
_SIDED = r"$\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$ of each side"


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
    curves = [curve for curve in curves_of(responses, labels) if curve.lifts]
    if not curves:
        raise InputError(
            "None of the responses has a base that can lift, so there is no moment over rotation to plot. "
            'Give at least one of a model that rocks, such as "2DOF-S".'
        )
    rotation = _HEADROOM * (rotation_limit(curves) or max(map(whole_line, curves)))
    largest = max(largest_moment(curve) for curve in curves)
    factor, unit = readable(largest, "N m")
    with styled(size=size):
        columns = 1 if narrow() else min(len(curves), _PER_ROW)
        rows = math.ceil(len(curves) / columns)
        figure = new_figure(2.2 + 1.8 * columns, 0.6 + 2.6 * rows)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        panels: list[Axes] = list(grid.flat)
        panels[0].set(xlim=(-rotation, rotation), ylim=(-_HEADROOM * largest / factor, _HEADROOM * largest / factor))
        panels[0].locator_params(axis="x", nbins=5)
        for axes, curve in zip(panels, curves, strict=False):
            moment = curve.history.base_moment / factor
            axes.plot(curve.history.rotation, moment, color=curve.look.color, linewidth=0.8, label=curve.label)
            axes.add_line(resistance_line(curve, rotation, factor))
            axes.set_title(curve.label)
            axes.tick_params(labelbottom=True)
        for axes in panels[len(curves) :]:
            axes.set_axis_off()
        figure.supxlabel("θ [rad]", fontsize="medium")
        figure.supylabel(f"$M_b$ [{unit}]", fontsize="medium")
        kinds = {line.get_label(): line for axes in panels for line in axes.get_lines()[1:]}
        figure.legend(handles=list(kinds.values()), loc="outside upper center", handlelength=3.0)
    return figure


def whole_line(curve: Curve) -> float:
    """Rotation up to which the static line is shown: where the moment vanishes, if it does."""
    balance = curve.balance_rotation
    return balance if math.isfinite(balance) else curve.history.model.properties.nominal_overturning_rotation


def largest_moment(curve: Curve) -> float:
    """Largest moment on the axes: of the static moment, and of M_b without overturning."""
    moment = curve.response.max_base_moment
    if curve.falls:
        moment = float(np.max(np.abs(curve.history.base_moment[curve.before_fall])))
    p = curve.history.model.properties
    held = 0.0 if follows_a_line(p) else float(np.max(np.abs(_path(curve)[1]), initial=0.0))
    return max(moment, held, *(pivot.resisting_moment for pivot in p.pivots))


def _path(curve: Curve) -> tuple[Array, Array]:
    """Rotation and resisting moment while the base is off the ground."""
    history, kept = curve.history, curve.before_fall
    on_springs = resistance_on_springs(history)
    if on_springs is not None:
        return history.rotation[kept], on_springs.moment[kept]
    weight, parts = resistance_of(history)
    rocking = np.flatnonzero(history.side[kept] != 0.0)
    return history.rotation[rocking], (weight + parts.sum(axis=1))[rocking]


def resistance_line(curve: Curve, rotation: float, factor: float) -> Line2D:
    p = curve.history.model.properties
    if not follows_a_line(p):
        theta, moment = _path(curve)
        return Line2D(theta, moment / factor, color=BLUE, linewidth=0.8, label=_PATH, zorder=3.0)
    dashes, push = (0, (4, 2)), push_on_springs(curve.history, rotation)
    if push is not None:
        return Line2D(
            push.rotation, push.moment / factor, color=BLUE, linestyle=dashes, linewidth=1.1, label=_SPRINGS, zorder=3.0
        )
    right, left = (
        (each.resisting_moment / factor, (each.resisting_moment + each.rocking_stiffness * rotation) / factor)
        for each in (p.pivot(1), p.pivot(-1))
    )
    law = (_HELD if p.tendons else _FREE) if p.symmetric else _SIDED
    return Line2D(
        [-rotation, 0.0, 0.0, rotation], [-left[1], -left[0], *right], color=BLUE, linestyle=dashes,
        linewidth=1.1, label="static, " + law, zorder=3.0,
    )  # fmt: skip
