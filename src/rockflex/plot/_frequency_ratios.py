"""Uplifted over fixed-base frequencies, over the slenderness."""

from collections.abc import Mapping, Sequence
from string import ascii_uppercase
from typing import TYPE_CHECKING, SupportsIndex

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._checks import whole_number
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import PinnedBeam
from rockflex.plot._study_tables import label_plainly
from rockflex.plot._style import BLUE, GRAY, SMALL, Look, Size, columns, letter, literal, narrow, new_figure, styled
from rockflex.plot._surrogates import surrogate_looks

if TYPE_CHECKING:
    import pandas as pd

Dashes = str | tuple[int, tuple[float, ...]]
_DASHES: tuple[Dashes, ...] = ("-", (0, (5, 2)), (0, (1, 1)), (0, (6, 1, 1, 1)))
_NEEDED = ("model", "aspect_ratio", "mode", "ratio")
_ROOM = 1.06


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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> table = rf.frequency_ratios(frame, [2.0, 4.0, 8.0])
    >>> figure = rf.plot_frequency_ratios(table)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$h^*_1/B$', '$ω^*_{1}/ω_{1}$')
    """
    named: Mapping[str, pd.DataFrame] = tables if isinstance(tables, Mapping) else {"": tables}
    bounds = limits if isinstance(limits, Mapping) else {} if limits is None else dict.fromkeys(named, limits)
    shown = [whole_number("modes", mode, 1) for mode in modes]
    _check(named, bounds, shown)
    looks = surrogate_looks(str(model) for table in named.values() for model in table["model"])
    dashes = dict(zip(named, _DASHES, strict=False))
    with styled(size=size):
        rows = len(shown) if narrow() else 1
        figure = new_figure(0.6 + 2.95 * len(shown) + 0.5 * (len(shown) == 1), 0.9 + 2.6 * rows)
        panels: list[Axes] = list(figure.subplots(rows, len(shown) // rows, squeeze=False).flat)
        for axes, mode, mark_of_panel in zip(panels, shown, ascii_uppercase, strict=False):
            top = max(_draw(axes, table, mode, looks, dashes[name]) for name, table in named.items())
            for name, beam in bounds.items():
                value = float(beam.ratio[mode - 1])
                _draw_limit(axes, value, dashes[name])
                top = max(top, value)
            if mark is not None:
                axes.axvline(mark, color=GRAY, linewidth=1.2, zorder=1.5, label="_mark")
            axes.set_xscale("log")
            axes.margins(x=0.0)
            if narrow():
                label_plainly(axes.xaxis)
            axes.set(ylim=(1.0 - (_ROOM - 1.0) * (top - 1.0), 1.0 + _ROOM * (top - 1.0) + 1e-6), xlabel=r"$h^*_1/B$")
            axes.set_ylabel(rf"$ω^*_{{{mode}}}/ω_{{{mode}}}$")
            letter(axes, mark_of_panel)
        handles = _handles(looks, dashes, bool(bounds), mark)
        across = columns([str(each.get_label()) for each in handles], 0) if narrow() else 3
        figure.legend(handles=handles, loc="outside upper center", ncols=across)
    return figure


def _draw(axes: Axes, table: "pd.DataFrame", mode: int, looks: dict[str, Look], dashes: Dashes) -> float:
    """Draw one curve per model that has the mode; return the largest ordinate."""
    top = 1.0
    for model, look in looks.items():
        rows = table[(table["model"] == model) & (table["mode"] == mode)].sort_values("aspect_ratio")
        if len(rows):
            ratio = rows["ratio"].to_numpy(dtype=float)
            axes.plot(
                rows["aspect_ratio"].to_numpy(dtype=float), ratio, color=look.color, linestyle=dashes,
                linewidth=look.width, label=model, zorder=2.5 - 0.1 * look.width,
            )  # fmt: skip
            top = max(top, float(ratio.max()))
    return top


def _draw_limit(axes: Axes, value: float, dashes: Dashes) -> None:
    axes.axhline(value, color=BLUE, linestyle=dashes, linewidth=0.8, zorder=1.6, label="_limit")
    axes.annotate(
        f"{value:.3f}", (0.02, value), xytext=(0, 2), xycoords=("axes fraction", "data"), textcoords="offset points",
        color=BLUE, fontsize=SMALL, va="bottom",
    )  # fmt: skip


def _handles(looks: dict[str, Look], dashes: Mapping[str, Dashes], bounded: bool, mark: float | None) -> list[Line2D]:
    handles = [Line2D([], [], color=look.color, linewidth=look.width, label=model) for model, look in looks.items()]
    if list(dashes) != [""]:
        handles += [
            Line2D([], [], color="#606060", linestyle=dash, label=literal(name))  # pyright: ignore[reportArgumentType]
            for name, dash in dashes.items()
        ]
    if bounded:
        handles.append(Line2D([], [], color=BLUE, linewidth=0.8, label="pinned beam, no spring"))
    if mark is not None:
        handles.append(Line2D([], [], color=GRAY, linewidth=1.2, label=rf"$h^*_1/B$ = {mark:g}"))
    return handles


def _check(named: "Mapping[str, pd.DataFrame]", bounds: Mapping[str, PinnedBeam], modes: list[int]) -> None:
    if not modes:
        raise InputError("modes is empty. Give at least one mode, counted from 1.")
    if not 1 <= len(named) <= len(_DASHES):
        raise InputError(f"{len(named)} tables were given, but one figure can show from 1 to {len(_DASHES)}.")
    for name, table in named.items():
        lacking = [column for column in _NEEDED if column not in getattr(table, "columns", ())]
        if lacking:
            raise InputError(
                f"The table {shown(name)} lacks {', '.join(lacking)}. Give what frequency_ratios returned."
            )
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
