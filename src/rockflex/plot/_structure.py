"""Structures: shapes of modes, the frequencies of uplifted structures, and the geometry of a tapered tower."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from string import ascii_uppercase
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Wedge

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive, checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.shown import shown
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLUE, GRAY, RED, SHADE, SMALL, LineStyle, Size
from rockflex.plot._study_tables import check_table_columns, label_log_axis_plainly, model_line_styles
from rockflex.structure._analysis import ModalProperties
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Structure
from rockflex.structure._towers import TaperedTower
from rockflex.structure._uplifted import PinnedBeam, UpliftedModes, frequency_equation, uplifted_modes
from rockflex.studies._arguments import RockingStructure, rocking_properties_of

if TYPE_CHECKING:
    import pandas as pd

_INK = "#404040"
_SLICE = 0.015  # height of the slice over that of the tower
_PER_ROW, _PER_NARROW_ROW = 5, 3
_POINTS = 300  # of a curve between two poles
_NAMED_ROOTS = 2
_BEYOND = 1.15  # of the last root that is named
_SHARE = 75.0  # per cent of the curves' points that the panel holds
Dashes = str | tuple[int, tuple[float, ...]]
_DASHES: tuple[Dashes, ...] = ("-", (0, (5, 2)), (0, (1, 1)), (0, (6, 1, 1, 1)))
_MARGIN = 1.06


def plot_mode_shapes(
    structure_or_modal: Structure | ModalProperties, n_modes: int | None = None, *, size: Size | None = None
) -> Figure:
    """Plot the mode shapes Γ_n φ_n over the height, one panel each.

    The title of each panel gives T_n, m*_n and h*_n (Silva & Stojadinović 2024, Section 2.1, after Eq. 12), with m*_n
    as a fraction of the mass above the base, or in kg if modes are missing and the fraction is unknown. Γ_n φ_n does
    not depend on the normalisation of φ_n, and sums to 1 at every height over all modes.

    Parameters
    ----------
    structure_or_modal
        A structure with modes, such as a `Frame`, or its `ModalProperties`.
    n_modes
        Number of modes to show, the lowest first. Default: all.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per mode, five per row; heights in m, Γ_n φ_n without unit.

    Raises
    ------
    InputError
        If the argument has no modes, or too few; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_mode_shapes(frame, n_modes=2)
    >>> len(figure.axes), figure.axes[0].get_ylabel()
    (2, 'height [m]')
    """
    if not isinstance(structure_or_modal, ModalProperties) and not hasattr(structure_or_modal, "modal"):
        raise InputError(
            "structure_or_modal must be a structure with modes, such as a Frame, or its ModalProperties, but "
            f"{type(structure_or_modal).__name__} was given. Give the structure itself, or structure.modal()."
        )
    modes = structure_or_modal if isinstance(structure_or_modal, ModalProperties) else structure_or_modal.modal()
    # Γ_n φ_n sums to 1 at every height over all modes, and only over all of them.
    complete = np.allclose(modes.shapes @ modes.participation, 1.0, rtol=0.0, atol=1e-6)
    total = float(modes.effective_mass.sum()) if complete else None
    shown = modes if n_modes is None else modes.truncated(n_modes)
    with figures.applied_figure_style(size=size):
        per_row = min(shown.n_modes, _PER_NARROW_ROW if figures.is_narrow() else _PER_ROW)
        rows = math.ceil(shown.n_modes / per_row)
        figure = figures.new_figure(max(1.26 * per_row, 2.6), 3.4 * rows)
        grid = figure.subplots(rows, per_row, sharey=True, squeeze=False)
        panels: list[Axes] = list(grid.flat)
        for n, axes in enumerate(panels):
            if n < shown.n_modes:
                _draw_mode_shape(axes, shown, n, total)
            else:
                axes.set_axis_off()
        for row in grid:
            row[0].set_ylabel(figures.axis_unit("length").heading(translated("height")))
        figure.supxlabel(r"$Γ_n\,φ_n$", fontsize="medium")
    return figure


def _draw_mode_shape(axes: Axes, modes: ModalProperties, n: int, total: float | None) -> None:
    ordinates = np.concatenate(([0.0], modes.participation[n] * modes.shapes[:, n]))
    heights = np.concatenate(([0.0], modes.heights)) / figures.axis_unit("length").size
    axes.axvline(0.0, color=GRAY, linewidth=0.8)
    few = heights.size <= 40
    axes.plot(ordinates, heights, color=BLUE, linewidth=1.4, marker="o" if few else "", markersize=3.0)
    largest = float(np.max(np.abs(ordinates))) or 1.0
    power = math.floor(math.log10(largest))
    tick = float(f"{math.floor(largest / 10.0**power)}e{power}")  # rounded down to its first digit
    axes.set_xlim(-1.25 * largest, 1.25 * largest)
    axes.set_xticks([-tick, 0.0, tick])
    axes.xaxis.set_major_formatter(lambda x, _: f"{x:g}".replace("-", "−"))
    axes.set_ylim(0.0, 1.04 * float(heights[-1]))
    axes.set_title(_mode_description(modes, n, total), fontsize=figures.scaled_font_size(8.0))


def _mode_description(modes: ModalProperties, n: int, total: float | None) -> str:
    mass, height = float(modes.effective_mass[n]), float(modes.effective_height[n])
    if total is None:
        kilograms, name = figures.axis_unit("mass")
        share = rf"$m^*_{{{n + 1}}}$ = {short_number(mass / kilograms)} {name}"
    else:
        share = rf"$m^*_{{{n + 1}}}/Σm$ = {short_number(100.0 * mass / total)} %"
    metres, name = figures.axis_unit("length")
    arm = f"{short_number(height / metres)} {name}" if math.isfinite(height) else translated("none")
    return f"$T_{{{n + 1}}}$ = {short_number(float(modes.period[n]))} s\n{share}\n" rf"$h^*_{{{n + 1}}}$ = {arm}"


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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
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
    end = None if highest is None else checked_positive("highest", highest, "ω/ω_1")
    models = {name: _truncated_models(each, n_modes, side) for name, each in named.items()}
    styles = model_line_styles(label for each in models.values() for label in each)
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 0.5 + 2.4 * len(named))
        panels: list[Axes] = list(figure.subplots(len(named), 1, squeeze=False).flat)
        for axes, (name, each), mark in zip(panels, models.items(), ascii_uppercase, strict=False):
            _draw_frequency_equation(axes, each, styles, end, side)
            axes.set_title(figures.literal_text(name))
            figures.label_panel(axes, mark)
        panels[-1].set_xlabel(r"$ω/ω_1$")
        handles = [Line2D([], [], **style.look, linewidth=style.width, label=label) for label, style in styles.items()]
        handles.append(
            Line2D(
                [],
                [],
                color=GRAY,
                linestyle=":",
                linewidth=0.9,
                label=translated("{symbol}, fixed base", symbol="$ω_n/ω_1$"),
            )
        )
        figures.add_legend_above(figure, handles, handlelength=2.8)
    return figure


def _truncated_models(
    structure: "RockingStructure | RockingProperties", n_modes: Sequence[SupportsIndex | None], side: int | None
) -> dict[str, tuple[RockingProperties, UpliftedModes]]:
    """Truncated properties and uplifted modes by the models' labels."""
    full = rocking_properties_of(structure)
    if full.n_modes == 0:
        raise InputError("A structure without modes has no frequency equation to plot. Give one with modes.")
    found: dict[str, tuple[RockingProperties, UpliftedModes]] = {}
    for each in n_modes:
        count = full.n_modes if each is None else checked_whole_number("n_modes", each, 1, full.n_modes)
        truncated = full.truncated(count)
        found["MDOF-S" if each is None else f"{count + 1}DOF-S"] = (
            truncated,
            uplifted_modes(truncated, side=side),
        )
    return found


def _draw_frequency_equation(
    axes: Axes,
    models: dict[str, tuple[RockingProperties, UpliftedModes]],
    styles: dict[str, LineStyle],
    highest: float | None,
    side: int | None,
) -> None:
    most = max((p for p, _ in models.values()), key=lambda p: p.n_modes)
    first = float(most.omega[0])
    named = max(float(modes.omega[:_NAMED_ROOTS][-1]) for _, modes in models.values()) / first
    end = _BEYOND * named if highest is None else highest
    for pole in most.omega[most.omega < end * first] / first:
        axes.axvline(float(pole), color=GRAY, linestyle=":", linewidth=0.9, zorder=1.5, label="_pole")
    axes.axhline(0.0, color=_INK, linewidth=0.8, zorder=1.6, label="_zero")
    ordinates: list[Array] = []
    notes = [(translated("zeros, {symbol}", symbol="$ω^*_n/ω_1$"), _INK)]
    for label, (p, modes) in models.items():
        style = styles[label]
        omega = _frequencies_between_poles(p.omega, end * first)
        inertia = p.weaker_pivot.i_theta if side is None else p.pivot(side).i_theta
        ordinate = frequency_equation(p, omega, side=side) / (inertia * first**2)
        ordinates.append(np.abs(ordinate[np.isfinite(ordinate)]))
        order = 2.5 - 0.1 * style.width
        axes.plot(omega / first, ordinate, **style.look, linewidth=style.width, label=label, zorder=order)
        roots = modes.omega[modes.omega < end * first] / first
        axes.plot(
            roots, np.zeros(roots.size), "o", color=style.color, markersize=3.0 + 1.5 * style.width,
            markerfacecolor="white", markeredgewidth=1.1, zorder=1.0 + order, label=f"_{label}",
        )  # fmt: skip
        notes += [(label, style.color), *((f"   {root:.3f}", style.color) for root in roots[:_NAMED_ROOTS])]
    limit = float(np.percentile(np.concatenate(ordinates), _SHARE))
    axes.set(ylim=(-limit, limit), xlim=(0.0, end), ylabel=translated("frequency equation") + r" / $I_θ\,ω_1^2$")
    figures.write_notes_beside(axes, notes, 10.5)


def _frequencies_between_poles(poles: Array, end: float) -> Array:
    """Frequencies up to `end`, dense beside each pole and with the poles themselves, where the equation is NaN."""
    inside = np.concatenate([[0.0], poles[poles < end], [end]])
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS)))
    pieces = [low + (high - low) * share[1:-1] for low, high in pairwise(inside)]
    return np.sort(np.concatenate([*pieces, inside[1:]]))


def plot_frequency_ratios(
    tables: "pd.DataFrame | Mapping[str, pd.DataFrame]",
    limits: PinnedBeam | Mapping[str, PinnedBeam] | None = None,
    *,
    modes: Sequence[SupportsIndex] = (1, 2),
    mark: float | None = 10.0,
    size: Size | None = None,
) -> Figure:
    """Plot ω*_n/ω_n over the aspect ratio h*_1/B, one panel per mode.

    The figure is that of Silva & Stojadinović 2024, Fig. 10. Models differ by colour, structures by dashes. A blue line
    with its value is the frequency ratio of the pinned beam, which a structure of evenly distributed mass with all its
    modes approaches as the base narrows; models with fewer modes exceed it.

    Parameters
    ----------
    tables
        A table of `frequency_ratios`, or up to four by name.
    limits
        Results of `pinned_beam`, by the same names.
    modes
        Modes to show, counted from 1.
    mark
        Aspect ratio of a vertical gray line; None for none.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per mode, over a logarithmic axis; no units.

    Raises
    ------
    InputError
        If no mode is given, a table lacks a column or has no row of a mode, a limit belongs to no table or has too
        few modes, or there are too many tables to distinguish; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> table = rf.frequency_ratios(frame, [2.0, 4.0, 8.0])
    >>> figure = rf.plot_frequency_ratios(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$h^*_1/B$', '$ω^*_{1}/ω_{1}$')
    """
    named: Mapping[str, pd.DataFrame] = tables if isinstance(tables, Mapping) else {"": tables}
    bounds = limits if isinstance(limits, Mapping) else {} if limits is None else dict.fromkeys(named, limits)
    shown = [checked_whole_number("modes", mode, 1) for mode in modes]
    _check_frequency_ratios(named, bounds, shown)
    styles = model_line_styles(str(model) for table in named.values() for model in table["model"])
    dashes = dict(zip(named, _DASHES, strict=False))
    with figures.applied_figure_style(size=size):
        rows = len(shown) if figures.is_narrow() else 1
        figure = figures.new_figure(0.6 + 2.95 * len(shown) + 0.5 * (len(shown) == 1), 0.9 + 2.6 * rows)
        panels: list[Axes] = list(figure.subplots(rows, len(shown) // rows, squeeze=False).flat)
        for axes, mode, mark_of_panel in zip(panels, shown, ascii_uppercase, strict=False):
            top = max(_draw_frequency_ratios(axes, table, mode, styles, dashes[name]) for name, table in named.items())
            for name, beam in bounds.items():
                value = float(beam.ratio[mode - 1])
                axes.axhline(value, color=BLUE, linestyle=dashes[name], linewidth=0.8, zorder=1.6, label="_limit")
                axes.annotate(
                    f"{value:.3f}", (0.02, value), xytext=(0, 2), xycoords=("axes fraction", "data"),
                    textcoords="offset points", color=BLUE, fontsize=SMALL, va="bottom",
                )  # fmt: skip
                top = max(top, value)
            if mark is not None:
                axes.axvline(mark, color=GRAY, linewidth=1.2, zorder=1.5, label="_mark")
            axes.set_xscale("log")
            axes.margins(x=0.0)
            if figures.is_narrow():
                label_log_axis_plainly(axes.xaxis)
            axes.set(
                ylim=(1.0 - (_MARGIN - 1.0) * (top - 1.0), 1.0 + _MARGIN * (top - 1.0) + 1e-6), xlabel=r"$h^*_1/B$"
            )
            axes.set_ylabel(rf"$ω^*_{{{mode}}}/ω_{{{mode}}}$")
            figures.label_panel(axes, mark_of_panel)
        handles = _frequency_ratio_handles(styles, dashes, bool(bounds), mark)
        figures.add_legend_above(figure, handles, max_columns=3)
    return figure


def _draw_frequency_ratios(
    axes: Axes, table: "pd.DataFrame", mode: int, styles: dict[str, LineStyle], dashes: Dashes
) -> float:
    """Draw one curve per model that has the mode; return the largest ordinate."""
    top = 1.0
    for model, style in styles.items():
        rows = table[(table["model"] == model) & (table["mode"] == mode)].sort_values("aspect_ratio")
        if len(rows):
            axes.plot(
                rows["aspect_ratio"], rows["ratio"], color=style.color, linestyle=dashes, linewidth=style.width,
                label=model, zorder=2.5 - 0.1 * style.width,
            )  # fmt: skip
            top = max(top, float(rows["ratio"].max()))
    return top


def _frequency_ratio_handles(
    styles: dict[str, LineStyle], dashes: Mapping[str, Dashes], bounded: bool, mark: float | None
) -> list[Line2D]:
    handles = [Line2D([], [], color=style.color, linewidth=style.width, label=model) for model, style in styles.items()]
    if list(dashes) != [""]:
        grays = {name: LineStyle("#606060", dash) for name, dash in dashes.items()}
        handles += [Line2D([], [], **gray.look, label=figures.literal_text(name)) for name, gray in grays.items()]
    if bounded:
        handles.append(Line2D([], [], color=BLUE, linewidth=0.8, label=translated("pinned beam, no spring")))
    if mark is not None:
        handles.append(Line2D([], [], color=GRAY, linewidth=1.2, label=rf"$h^*_1/B$ = {mark:g}"))
    return handles


def _check_frequency_ratios(
    named: "Mapping[str, pd.DataFrame]", bounds: Mapping[str, PinnedBeam], modes: list[int]
) -> None:
    if not modes:
        raise InputError("modes is empty. Give at least one mode, counted from 1.")
    if not 1 <= len(named) <= len(_DASHES):
        raise InputError(f"{len(named)} tables were given, but one figure can show from 1 to {len(_DASHES)}.")
    for name, table in named.items():
        check_table_columns(table, ("model", "aspect_ratio", "mode", "ratio"), "what frequency_ratios returned", name)
        absent = [mode for mode in modes if not (table["mode"] == mode).any()]
        if absent:
            raise InputError(
                f"The table {shown(name)} has no row of mode {absent[0]}. Show modes that a model in it keeps."
            )
    for name, beam in bounds.items():
        if name not in named:
            raise InputError(
                f"limits has the name {shown(name)}, which no table has: those have {', '.join(map(repr, named))}."
            )
        if beam.ratio.size < max(modes):
            raise InputError(
                f"The limit {shown(name)} has {beam.ratio.size} frequency ratios, but mode {max(modes)} is to be "
                f"shown. Give pinned_beam(..., n_modes={max(modes)})."
            )


def plot_tower(tower: TaperedTower, section: float | None = None, *, size: Size | None = None) -> Figure:
    """Plot a tower's elevation, and one of its sections with its contribution to I_θ.

    The figure is that of Silva & Stojadinović 2024, Fig. 14. A slice of mass m at the height z turns about the pivot O
    with m((R² + r²)/4 + Δ²), where Δ² = z² + B² (Eq. 33).

    Parameters
    ----------
    tower
        A `TaperedTower`.
    section
        Height z of the section in m, at most the tower's height. Default: half the height.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes, elevation and section, in m. Widths and heights of the elevation have different scales.

    Raises
    ------
    InputError
        If no tower is given, or the section is outside it; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> tower = rf.TaperedTower(height=200, base_radius=8, top_radius=4, wall=1,
    ...     density=2400, elastic_modulus=25e9,
    ...                         damping_ratio=0.02)
    >>> figure = rf.plot_tower(tower)
    >>> len(figure.axes), figure.axes[0].get_ylabel()
    (2, 'height [m]')
    """
    if not hasattr(tower, "top_radius"):
        raise InputError(f"tower must be a TaperedTower, but {type(tower).__name__} was given.")
    z = 0.5 * tower.height if section is None else checked_positive("section", section, "m")
    if z > tower.height:
        raise InputError(f"section must be at most the height of the tower, {tower.height:g} m, but {z:g} m was given.")
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 7.2 if figures.is_narrow() else 4.6)
        if figures.is_narrow():
            left, right = figure.subplots(2, 1, height_ratios=(1.5, 1.0))
        else:
            left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _draw_tower_elevation(left, tower, z)
        _draw_tower_section(right, tower, z)
        figures.label_panel(left, "A")
        figures.label_panel(right, "B")
    return figure


def _outer_tower_radius(tower: TaperedTower, z: float) -> float:
    return tower.base_radius + (tower.top_radius - tower.base_radius) * z / tower.height


def _draw_tower_elevation(axes: Axes, tower: TaperedTower, z: float) -> None:
    height, base, top = tower.height, tower.base_radius, tower.top_radius
    levels = np.array([0.0, height])
    outer = np.array([base, top])
    inner = np.maximum(outer - tower.wall, 0.0)
    for side in (-1.0, 1.0):
        axes.fill_betweenx(
            levels, side * inner, side * outer, facecolor=SHADE, edgecolor=_INK, linewidth=0.9, label="_wall"
        )
    radius = _outer_tower_radius(tower, z)
    slab = z + 0.5 * _SLICE * height * np.array([-1.0, 1.0])
    axes.fill_betweenx(slab, -radius, radius, facecolor=BLUE, alpha=0.5, linewidth=0.0, label="_slice")
    axes.axvline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    axes.axhline(0.0, color=_INK, linewidth=1.2, label="_ground")
    axes.plot([base, 0.0], [0.0, z], color=RED, linewidth=1.0, label="_arm")
    axes.plot([base], [0.0], "o", color=RED, markersize=4.5, clip_on=False, zorder=4.0, label="_pivot")
    _annotate_tower(axes, "O", (base, 0.0), (5, 4), RED)
    arm = float(np.hypot(z, base))
    _annotate_tower(axes, rf"$Δ$ = {arm:.4g} m", (0.5 * base, 0.5 * z), (3, 6), RED, boxed=True)
    reach = 1.5 * max(base, top)
    axes.set(xlim=(-reach, 1.75 * max(base, top)), ylim=(-0.12 * height, 1.09 * height))
    _draw_tower_dimension(axes, (-1.25 * max(base, top), 0.0), (-1.25 * max(base, top), height))
    _annotate_tower(axes, rf"$H$ = {height:g} m", (-1.25 * max(base, top), 0.5 * height), (-3, 0), _INK, turned=True)
    _draw_tower_dimension(axes, (0.0, -0.045 * height), (base, -0.045 * height))
    _annotate_tower(axes, rf"$B$ = $R_c$ = {base:g} m", (0.5 * base, -0.045 * height), (0, -4), _INK, below=True)
    _draw_tower_dimension(axes, (0.0, 1.03 * height), (top, 1.03 * height))
    _annotate_tower(axes, rf"$R_{{\mathrm{{top}}}}$ = {top:g} m", (top, 1.03 * height), (4, -3), _INK)
    _annotate_tower(
        axes, rf"$t_c$ = {tower.wall:g} m", (_outer_tower_radius(tower, 0.78 * height), 0.78 * height), (4, -3), _INK
    )
    _annotate_tower(axes, rf"$z$ = {z:g} m", (radius, z), (4, -3), BLUE)
    axes.set(xlabel=translated("width [m]"), ylabel=translated("height [m]"))
    axes.grid(visible=False)
    axes.set_title(translated("elevation, widths enlarged"))


def _draw_tower_section(axes: Axes, tower: TaperedTower, z: float) -> None:
    outer = _outer_tower_radius(tower, z)
    inner = max(outer - tower.wall, 0.0)
    axes.add_patch(Wedge((0.0, 0.0), outer, 0.0, 360.0, width=outer - inner, facecolor=SHADE, edgecolor="none"))
    for radius in (outer, inner):
        axes.add_patch(Circle((0.0, 0.0), radius, fill=False, edgecolor=_INK, linewidth=0.9))
    reach = 1.25 * outer
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.axhline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    axes.axvline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    for radius, degrees, name in ((outer, 40.0, "R"), (inner, 140.0, "r")):
        angle = np.deg2rad(degrees)
        end = (radius * float(np.cos(angle)), radius * float(np.sin(angle)))
        axes.annotate("", end, (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": BLUE, "linewidth": 1.0})
        middle = (0.5 * end[0], 0.5 * end[1])
        _annotate_tower(axes, f"${name}$ = {short_number(radius)} m", middle, (0, 0), BLUE, boxed=True)
    axes.set_xlabel(r"$I = m\,[(R^2 + r^2)/4 + Δ^2]$, $Δ^2 = z^2 + B^2$")
    axes.grid(visible=False)
    axes.set_ylabel("[m]")
    axes.set_anchor("N")
    axes.set_title(translated("section at {height} m", height=f"{z:g}"))


def _draw_tower_dimension(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    axes.annotate(
        "", end, start, arrowprops={"arrowstyle": "<|-|>", "color": _INK, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
    )


def _annotate_tower(
    axes: Axes,
    text: str,
    at: tuple[float, float],
    offset: tuple[float, float],
    color: str,
    *,
    turned: bool = False,
    below: bool = False,
    boxed: bool = False,
) -> None:
    """Write next to a point, `offset` points away."""
    axes.annotate(
        text, at, xytext=offset, textcoords="offset points", color=color, fontsize=SMALL, annotation_clip=False,
        ha="right" if turned else "center" if below or boxed else "left",
        va="center" if turned or boxed else "top" if below else "bottom", rotation=90.0 if turned else 0.0,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0} if boxed else None,
    )  # fmt: skip
