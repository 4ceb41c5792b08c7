"""The figures of a report of one page: histories and loops of several models, and the record."""

from collections.abc import Iterable, Sequence
from string import ascii_uppercase
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex.foundation.arrays import Array
from rockflex.foundation.language import translated
from rockflex.plot import _figures as figures
from rockflex.plot import _history as histories
from rockflex.plot._history import ResponseCurve
from rockflex.plot._loops import largest_base_moment_on_axes, resisting_moment_line, static_line_rotation
from rockflex.plot.animation._scene import draw_structures_at
from rockflex.response._response import Response

_MM = 1.0 / 25.4  # inches
_MARGIN = 1.08
_MIN_PANEL_MM = 26.0  # mm of height that a panel needs
_ONE_LINE_MM = 40.0  # mm of height in which every label has room in one line
_MIN_STAGE_MM = 95.0  # mm of height in which a structure and its loops have room above each other
_MIN_PANELS = 3  # panels in any case
_MAX_LAW_POINTS = 500  # points of a line that is a path, not a law


def draw_run_sheet(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    structure: Any = None,
    *,
    width: float,
    height: float,
) -> Figure:
    """Draw the histories of models that ran under one record, one panel per quantity, and their loops beside them.

    The panels are the rotation, the displacement of the top, the base moment, and what a base does that slides or is on
    springs. The loops are those of base moment and rotation, over the static resisting moment of the first model that
    can lift. Where there is room above them, that model stands as it does at its largest rotation, with the shape of
    the `structure` if that is known. `width` and `height` are in mm.

    Raises
    ------
    InputError
        If there are no responses or too many, or one has no history.
    """
    names = None if labels is None else [figures.literal_text(label) for label in labels]
    curves = histories.response_curves(responses, names)
    lifting = [curve for curve in curves if curve.lifts]
    loops = [curve for curve in lifting if curve.history.model.properties.n_modes]
    quantities = histories.panel_quantities(_run_sheet_panels(curves, height))
    with figures.applied_figure_style():
        figure = figures.new_figure(width * _MM, height * _MM)
        figure.get_layout_engine().set(h_pad=0.01, w_pad=0.02, hspace=0.02, wspace=0.02)  # pyright: ignore
        stands = bool(lifting) and height >= _MIN_STAGE_MM
        beside = bool(loops) or stands
        grid = figure.add_gridspec(len(quantities), 1 + beside, width_ratios=(1.9, 1.0) if beside else None)
        panels: list[Axes] = []
        handles: list[Artist] = []
        for row, (quantity, mark) in enumerate(zip(quantities, ascii_uppercase, strict=False)):
            axes = figure.add_subplot(grid[row, 0], sharex=panels[0] if panels else None)
            handles, _ = histories.draw_curves(axes, quantity, curves)
            _label_inside_panel(axes, mark)
            unit, _ = histories.quantity_axis_scale(quantity, curves)
            room = height / len(quantities)
            label = unit.heading(quantity.label if room > _MIN_PANEL_MM else quantity.label.split(" ")[0])
            lines = label.replace(" [", "\n[") if room < _ONE_LINE_MM else label
            axes.set_ylabel(lines, fontsize=figures.scaled_font_size(8.0))
            axes.tick_params(labelbottom=row == len(quantities) - 1)
            axes.locator_params(axis="y", nbins=5)
            panels.append(axes)
        uplifts = histories.shade_uplifts(panels, curves)
        panels[-1].set(xlabel=translated("time [s]"), xlim=histories.time_axis_limits(curves))
        figure.align_ylabels(panels)
        stage = None
        if beside:
            rows = grid[:, 1].subgridspec(stands + bool(loops), 1)
            stage = figure.add_subplot(rows[0]) if stands else stage
            if loops:
                mark = ascii_uppercase[len(quantities)]
                _draw_moment_rotation_loops(figure.add_subplot(rows[int(stands)]), loops, mark)
        histories.add_legend(figure, curves, handles, uplifts, "", borderpad=0.1, borderaxespad=0.1)
        if stage is not None:
            figure.draw_without_rendering()  # the stage is drawn in points, so its place must be known
            figure.set_layout_engine("none")
            first = lifting[0]
            draw_structures_at(stage, [first], [structure], first.response.time_of_max_rotation)
    return figure


def draw_record_strip(time: Array, acceleration: Array, *, width: float, height: float) -> Figure:
    """Draw a ground acceleration, given in m/s², over the time in s, `width` by `height` mm."""
    unit = figures.axis_unit("acceleration")
    shaking = acceleration / unit.size
    largest = float(np.max(np.abs(shaking))) or 1.0
    with figures.applied_figure_style():
        figure = figures.new_figure(width * _MM, height * _MM)
        figure.get_layout_engine().set(h_pad=0.01, w_pad=0.02)  # pyright: ignore
        axes = figure.add_subplot()
        axes.plot(time, shaking, color=figures.BLACK, linewidth=0.5)
        axes.set(xlim=(float(time[0]), float(time[-1])), ylim=(-_MARGIN * largest, _MARGIN * largest))
        axes.locator_params(axis="y", nbins=4)
        axes.tick_params(labelsize=figures.SMALL)
        axes.set_xlabel(translated("time [s]"), fontsize=figures.SMALL, labelpad=1.0)
        axes.set_ylabel(unit.heading("$a_g$"), fontsize=figures.SMALL, labelpad=1.0)
    return figure


def _run_sheet_panels(curves: list[ResponseCurve], height: float) -> list[str]:
    """Names of the quantities that matter for these models."""
    models = [curve.history.model for curve in curves]
    known = all(model.properties.top_height is not None for model in models)
    names = ["rotation"] if any(model.lifts for model in models) else []
    names.append("total_top_displacement" if known else "top_displacement")
    if any(model.properties.n_modes for model in models):
        names += ["base_moment", "base_shear"]
    else:
        names.append("horizontal_reaction")
    if any(model.layout.n_joints for model in models):
        names.append("joint_rotation")
    if any(curve.response.max_slip for curve in curves):
        names.append("slip")
    if any(model.layout.heave >= 0 for model in models):
        names.append("edge_uplift")
    spare = [name for name in ("base_shear", "base_moment") if name in names]
    while len(names) * _MIN_PANEL_MM > height and len(names) > _MIN_PANELS and spare:
        names.remove(spare.pop(0))
    return names


def _draw_moment_rotation_loops(axes: Axes, curves: list[ResponseCurve], mark: str) -> None:
    """Draw base moment over rotation, and the static resisting moment."""
    rotation = _MARGIN * (histories.rotation_axis_limit(curves) or max(map(static_line_rotation, curves)))
    (moment,) = histories.panel_quantities(["base_moment"])
    unit, limit = histories.quantity_axis_scale(moment, curves)
    largest = max(largest_base_moment_on_axes(curves[0]), limit * unit.size / _MARGIN)
    factor, unit = figures.axis_unit("moment", largest)
    turn = figures.axis_unit("rotation")
    for curve in curves:
        until_fall = curve.before_fall
        axes.plot(
            curve.history.rotation[until_fall] / turn.size, curve.history.base_moment[until_fall] / factor,
            **curve.style.look, linewidth=0.8 * curve.style.width, zorder=curve.order,
        )  # fmt: skip
    line = resisting_moment_line(curves[0], rotation, factor, turn.size)
    line.set(linewidth=0.9 if len(line.get_xdata()) < _MAX_LAW_POINTS else 0.5, zorder=1.8)  # pyright: ignore[reportArgumentType]
    axes.add_line(line)
    limit = _MARGIN * largest / factor
    right = rotation / turn.size
    axes.set(xlim=(-right, right), ylim=(-limit, limit), xlabel=turn.heading("θ"), ylabel=f"$M_b$ [{unit}]")
    axes.locator_params(axis="x", nbins=4)
    title = translated("$M_b$ over θ; blue: resisting moment\nof {model}", model=curves[0].label)
    axes.set_title(title, fontsize=figures.SMALL, loc="right")
    _label_inside_panel(axes, mark)


def _label_inside_panel(axes: Axes, mark: str) -> None:
    axes.annotate(
        mark, (0.0, 1.0), xytext=(4, -3), xycoords="axes fraction", textcoords="offset points", weight="bold", va="top",
        zorder=6.0,
    )  # fmt: skip
