"""The frequency equation of uplifted structures, and its zeros."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from string import ascii_uppercase
from typing import SupportsIndex

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array
from rockflex._checks import positive, whole_number
from rockflex._errors import InputError
from rockflex.modal import RockingProperties, UpliftedModes, frequency_equation, uplifted_modes
from rockflex.plot._panel import list_beside
from rockflex.plot._style import GRAY, Look, Size, columns, letter, literal, narrow, new_figure, styled
from rockflex.plot._surrogates import surrogate_looks
from rockflex.study import RockingStructure, properties_of

_POINTS = 300  # of a curve between two poles
_NAMED_ROOTS = 2
_BEYOND = 1.15  # of the last root that is named
_SHARE = 75.0  # per cent of the curves' points that the panel holds


def plot_frequency_equation(
    structures: "RockingStructure | RockingProperties | Mapping[str, RockingStructure | RockingProperties]",
    n_modes: Sequence[SupportsIndex | None] = (1, 2, None),
    *,
    highest: float | None = None,
    side: int | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot the frequency equation of an uplifted structure over ω, one curve per model, and mark its zeros.

    The figure is that of Silva & Stojadinović 2024, Fig. 12. The ordinate is `frequency_equation` over I_θ ω_1², which
    does not change the zeros. Dotted lines mark the fixed-base frequencies ω_n, where the equation has poles and the
    curves are interrupted. The first two zeros of each model, ω*_n/ω_1, are listed beside the panel.

    Parameters
    ----------
    structures
        A structure or its `RockingProperties`, or several by name, one panel each.
    n_modes
        Numbers of modes, one curve each: 1 for 2DOF-S, 2 for 3DOF-S, None for all.
    highest
        Upper end of the axis, ω/ω_1. Default: beyond the second zero of every model.
    side
        1 for motion about the right edge of the base, -1 about the left one. Default: the edge about which the base
        lifts first; both are equal if the structure is symmetric.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per structure; no units.

    Raises
    ------
    InputError
        If there is no structure, one has too few modes, `highest` is not positive, or `side` is neither; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_frequency_equation(frame)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$ω/ω_1$', 'frequency equation / $I_θ\\,ω_1^2$')
    """
    named = structures if isinstance(structures, Mapping) else {"": structures}
    if not named or not len(n_modes):
        raise InputError(
            "There is nothing to plot. Give at least one structure, and one number of modes (None for all)."
        )
    end = None if highest is None else positive("highest", highest, "ω/ω_1")
    models = {name: _models_of(each, n_modes, side) for name, each in named.items()}
    looks = surrogate_looks(label for each in models.values() for label in each)
    with styled(size=size):
        figure = new_figure(6.3, 0.5 + 2.4 * len(named))
        panels: list[Axes] = list(figure.subplots(len(named), 1, squeeze=False).flat)
        for axes, (name, each), mark in zip(panels, models.items(), ascii_uppercase, strict=False):
            _draw_panel(axes, each, looks, end, side)
            axes.set_title(literal(name))
            letter(axes, mark)
        panels[-1].set_xlabel(r"$ω/ω_1$")
        handles = [
            Line2D([], [], color=look.color, linestyle=look.dashes, linewidth=look.width, label=label)  # pyright: ignore[reportArgumentType]
            for label, look in looks.items()
        ]
        handles.append(Line2D([], [], color=GRAY, linestyle=":", linewidth=0.9, label=r"$ω_n/ω_1$, fixed base"))
        across = columns([str(each.get_label()) for each in handles], 0) if narrow() else len(handles)
        figure.legend(handles=handles, loc="outside upper center", ncols=across, handlelength=2.8)
    return figure


def _models_of(
    structure: "RockingStructure | RockingProperties", n_modes: Sequence[SupportsIndex | None], side: int | None
) -> dict[str, tuple[RockingProperties, UpliftedModes]]:
    """Truncated properties and uplifted modes by the models' labels."""
    full = properties_of(structure)
    if full.n_modes == 0:
        raise InputError("A structure without modes has no frequency equation to plot. Give one with modes.")
    found: dict[str, tuple[RockingProperties, UpliftedModes]] = {}
    for each in n_modes:
        count = full.n_modes if each is None else whole_number("n_modes", each, 1, full.n_modes)
        kept = full.truncated(count)
        found["MDOF-S" if each is None else f"{count + 1}DOF-S"] = (kept, uplifted_modes(kept, side=side))
    return found


def _draw_panel(
    axes: Axes,
    models: dict[str, tuple[RockingProperties, UpliftedModes]],
    looks: dict[str, Look],
    highest: float | None,
    side: int | None,
) -> None:
    most = max((p for p, _ in models.values()), key=lambda p: p.n_modes)
    first = float(most.omega[0])
    named = max(float(modes.omega[:_NAMED_ROOTS][-1]) for _, modes in models.values()) / first
    end = _BEYOND * named if highest is None else highest
    for pole in most.omega[most.omega < end * first] / first:
        axes.axvline(float(pole), color=GRAY, linestyle=":", linewidth=0.9, zorder=1.5, label="_pole")
    axes.axhline(0.0, color="#404040", linewidth=0.8, zorder=1.6, label="_zero")
    ordinates: list[Array] = []
    notes = [(r"zeros, $ω^*_n/ω_1$", "#404040")]
    for label, (p, modes) in models.items():
        look = looks[label]
        omega = _between_poles(p.omega, end * first)
        inertia = p.weaker_pivot.i_theta if side is None else p.pivot(side).i_theta
        ordinate = frequency_equation(p, omega, side=side) / (inertia * first**2)
        ordinates.append(np.abs(ordinate[np.isfinite(ordinate)]))
        axes.plot(
            omega / first, ordinate, color=look.color, linestyle=look.dashes, linewidth=look.width,
            label=label, zorder=2.5 - 0.1 * look.width,
        )  # fmt: skip
        roots = modes.omega[modes.omega < end * first] / first
        axes.plot(
            roots, np.zeros(roots.size), "o", color=look.color, markersize=3.0 + 1.5 * look.width,
            markerfacecolor="white", markeredgewidth=1.1, zorder=3.5 - 0.1 * look.width, label=f"_{label}",
        )  # fmt: skip
        notes += [(label, look.color), *((f"   {root:.3f}", look.color) for root in roots[:_NAMED_ROOTS])]
    limit = float(np.percentile(np.concatenate(ordinates), _SHARE))
    axes.set(ylim=(-limit, limit), xlim=(0.0, end), ylabel=r"frequency equation / $I_θ\,ω_1^2$")
    list_beside(axes, notes, 10.5)


def _between_poles(poles: Array, end: float) -> Array:
    """Frequencies up to `end`, dense beside each pole and with the poles themselves, where the equation is NaN."""
    inside = np.concatenate([[0.0], poles[poles < end], [end]])
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS)))
    pieces = [low + (high - low) * share[1:-1] for low, high in pairwise(inside)]
    return np.sort(np.concatenate([*pieces, inside[1:]]))
