"""Demands of a set of records: each record, the statistics of all, and the value for design."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import unit_with_prefix
from rockflex.foundation.shown import few_texts_shown, shortened
from rockflex.foundation.units import KN
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, GRAY, GREEN, ORANGE, RED, SKY, SMALL, Size
from rockflex.response._outputs import OUTPUTS
from rockflex.response._record_set import RecordSet

USUAL = ("max_rotation", "max_total_top_displacement", "max_base_moment", "max_base_shear")
LINES = {
    "design": (BLACK, "-", 3.6, "for design"),  # below the others, which it may equal
    "mean": (SKY, "-", 1.4, "mean"),
    "median": (GREEN, "--", 1.2, "median"),
    "fractile_84": (ORANGE, ":", 1.6, "84 % fractile"),
}
_MAX_NAMES, _MAX_LETTERS = 30, 24  # records that are all named, and letters of a name


def plot_set(found: RecordSet, demands: Sequence[str] | None = None, *, size: Size | None = None) -> Figure:
    """Plot the peaks of each record of a set, with their mean, median, 84 % fractile and value for design.

    Parameters
    ----------
    found
        What `simulate_set` returned.
    demands
        Names among the rows of `RecordSet.statistics`, a panel each. Default: rotation, total displacement of the top,
        base moment and base shear, as far as they occur.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each demand, with a line for each record. A record that overturns is a cross at the edge, and a
        statistic that is not defined or infinite is left out.

    Raises
    ------
    InputError
        If `found` is no set, a demand does not occur in it, or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulses = [rf.one_sine_pulse(amplitude=3.0, period=t)
    ...     for t in (0.5, 0.6, 0.7)]
    >>> len(rf.plot_set(rf.simulate_set(frame, pulses, "2DOF-S",
    ...     rule="ec8")).axes)
    4
    """
    statistics = checked_instance("found", found, RecordSet).statistics
    known = [str(name) for name in statistics.index]
    names = [name for name in USUAL if name in known] if demands is None else list(demands)
    unknown = [name for name in names if name not in known]
    if unknown or not names:
        raise InputError(
            f"demands must be some of those of the set, {', '.join(known) or 'none'}, but {few_texts_shown(unknown)} "
            "was given.",
            field="demands",
        )
    with figures.applied_figure_style(size=size):
        narrow, n = figures.is_narrow(), len(found.responses)
        rows = len(names) if narrow else 1
        height = 1.1 + (0.12 if narrow else 0.17) * min(max(n, 5), _MAX_NAMES)
        figure = figures.new_figure(7.2, rows * height)
        panels = figure.subplots(rows, len(names) // rows, sharey=not narrow, squeeze=False).ravel()
        for axes, name in zip(panels, names, strict=True):
            _draw_demand(axes, found, name)
        for axes in panels if narrow else panels[:1]:
            _name_records(axes, [motion.name for motion in found.motions])
        handles, labels = panels[0].get_legend_handles_labels()
        figures.add_legend_above(figure, handles, labels)
    return figure


def _draw_demand(axes: Axes, found: RecordSet, name: str) -> None:
    values, fallen = found.peaks[name].to_numpy(float), found.fallen
    row: Any = found.statistics.loc[name]
    stands = values[~fallen]
    chosen = figures.chosen_units()
    size, unit = OUTPUTS[name].unit_in(chosen or KN)
    if chosen is None and unit.startswith("kN"):
        size, unit = unit_with_prefix(float(abs(stands).max(initial=0.0)), unit.removeprefix("k"))
    places = [place for place, fell in enumerate(fallen) if not fell]
    axes.hlines(places, 0.0, stands / size, color=GRAY, linewidth=0.6)
    for column, (color, dashes, width, label) in LINES.items():
        if math.isfinite(row[column]):
            axes.axvline(row[column] / size, color=color, linestyle=dashes, linewidth=width, label=translated(label))
    axes.plot(
        stands / size, places, color=GRAY, marker="o", markersize=2.5, linestyle="none", label=translated("record")
    )
    if fallen.any():
        axes.plot(
            [0.97] * int(fallen.sum()), [place for place, fell in enumerate(fallen) if fell], color=RED, marker="x",
            markersize=4.0, linestyle="none", transform=axes.get_yaxis_transform(), label=translated("overturns"),
        )  # fmt: skip
    axes.set_xlabel(f"{figures.symbol_in_mathematics(OUTPUTS[name].symbol)} [{unit}]")
    axes.margins(x=0.12)
    axes.set_xlim(min(0.0, axes.get_xlim()[0]) if stands.min(initial=0.0) < 0.0 else 0.0)
    axes.set_ylim(len(values) - 0.5, -0.5)
    axes.grid(visible=False, axis="y")
    axes.locator_params(axis="x", nbins=4)


def _name_records(axes: Axes, names: list[str]) -> None:
    step = -(-len(names) // _MAX_NAMES)
    shown = [figures.literal_text(shortened(name, _MAX_LETTERS)) for name in names[::step]]
    axes.set_yticks(range(0, len(names), step), shown, fontsize=SMALL)
