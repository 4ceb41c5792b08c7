"""Mode shapes over the height."""

import math
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._errors import InputError
from rockflex.modal import ModalProperties
from rockflex.plot._style import BLUE, GRAY, Size, narrow, new_figure, points, styled
from rockflex.plot._units import short

_PER_ROW, _PER_NARROW_ROW = 5, 3


class _HasModes(Protocol):
    def modal(self, n_modes: int | None = None) -> ModalProperties: ...


def plot_mode_shapes(
    structure_or_modal: _HasModes | ModalProperties, n_modes: int | None = None, *, size: Size | None = None
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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_mode_shapes(frame, n_modes=2)
    >>> len(figure.axes), figure.axes[0].get_ylabel()
    (2, 'height [m]')
    """
    modes = _modes_of(structure_or_modal)
    # With all modes, and with no fewer, a unit translation is the sum of what they take of it.
    complete = np.allclose(modes.shapes @ modes.participation, 1.0, rtol=0.0, atol=1e-6)
    total = float(modes.effective_mass.sum()) if complete else None
    shown = modes if n_modes is None else modes.truncated(n_modes)
    with styled(size=size):
        columns = min(shown.n_modes, _PER_NARROW_ROW if narrow() else _PER_ROW)
        rows = math.ceil(shown.n_modes / columns)
        figure = new_figure(max(1.26 * columns, 2.6), 3.4 * rows)
        grid = figure.subplots(rows, columns, sharey=True, squeeze=False)
        panels: list[Axes] = list(grid.flat)
        for n, axes in enumerate(panels):
            if n < shown.n_modes:
                _draw(axes, shown, n, total)
            else:
                axes.set_axis_off()
        for row in grid:
            row[0].set_ylabel("height [m]")
        figure.supxlabel(r"$Γ_n\,φ_n$", fontsize="medium")
    return figure


def _modes_of(source: _HasModes | ModalProperties) -> ModalProperties:
    if isinstance(source, ModalProperties):
        return source
    if not hasattr(source, "modal"):
        raise InputError(
            f"structure_or_modal must be a structure with modes, such as a Frame, or its ModalProperties, but "
            f"{type(source).__name__} was given. Give the structure itself, or structure.modal()."
        )
    return source.modal()


def _draw(axes: Axes, modes: ModalProperties, n: int, total: float | None) -> None:
    ordinates = np.concatenate(([0.0], modes.participation[n] * modes.shapes[:, n]))
    heights = np.concatenate(([0.0], modes.heights))
    axes.axvline(0.0, color=GRAY, linewidth=0.8)
    few = heights.size <= 40
    axes.plot(ordinates, heights, color=BLUE, linewidth=1.4, marker="o" if few else "", markersize=3.0)
    largest = float(np.max(np.abs(ordinates))) or 1.0
    tick = _rounded_down(largest)
    axes.set_xlim(-1.25 * largest, 1.25 * largest)
    axes.set_xticks([-tick, 0.0, tick], [f"−{tick:g}", "0", f"{tick:g}"])
    axes.set_ylim(0.0, 1.04 * float(heights[-1]))
    axes.set_title(_describe(modes, n, total), fontsize=points(8.0))


def _rounded_down(value: float) -> float:
    """First digit of a positive number."""
    power = math.floor(math.log10(value))
    return float(f"{math.floor(value / 10.0**power)}e{power}")


def _describe(modes: ModalProperties, n: int, total: float | None) -> str:
    mass, height = float(modes.effective_mass[n]), float(modes.effective_height[n])
    if total is None:
        share = rf"$m^*_{{{n + 1}}}$ = {short(mass)} kg"
    else:
        share = rf"$m^*_{{{n + 1}}}/Σm$ = {short(100.0 * mass / total)} %"
    arm = f"{short(height)} m" if math.isfinite(height) else "none"
    return f"$T_{{{n + 1}}}$ = {short(float(modes.period[n]))} s\n{share}\n" rf"$h^*_{{{n + 1}}}$ = {arm}"
