"""Clouds of response over intensity, and the lines through them."""

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array
from rockflex._cases import runs_by_case
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.fragility import NOMINAL, OVERTURNING, ROCKED, CloudFit, fit_each_cloud, rocked_runs
from rockflex.plot._study_tables import (
    check_table_columns,
    label_log_axis_plainly,
    measure_axis_name,
    model_legend_handles,
    model_lines_and_symbols,
    names_in_column,
    structure_panels,
)
from rockflex.plot._style import BLACK, LineStyle, Size, add_legend_above, scaled_font_size, with_figure_style

if TYPE_CHECKING:
    import pandas as pd

_QUANTITIES = {
    "max_rotation": r"$θ_{\mathrm{max}}$ [rad]",
    "max_top_displacement": r"$u_{\mathrm{top,max}}$, relative to the base [m]",
    "max_total_top_displacement": r"total $u_{\mathrm{top,max}}$ [m]",
}
_TINY = 6.75
_ROW = 0.056  # of the panel, from row to row of the numbers in it
_CROSSES = 0.038  # and of the crosses


class _PlottedCloud(NamedTuple):
    """The solved runs of one structure and model, and the line through those that rocked without overturning."""

    structure: str
    model: str
    rocked: "pd.DataFrame"
    fallen: "pd.DataFrame"
    n_failed: int
    line: CloudFit | None
    fitted: bool


def plot_clouds(
    runs: "pd.DataFrame",
    quantity: Literal["max_rotation", "max_top_displacement", "max_total_top_displacement"] = "max_rotation",
    measure: str = "pgv",
    *,
    threshold: float = ROCKED,
    nominal: bool = False,
    size: Size | None = None,
) -> Figure:
    r"""Plot the response of runs that rocked without overturning over an intensity measure, one panel per structure.

    The figure is that of Silva & Stojadinović 2024, Figs. 6 and 7: lines log(y) = c1 + c2 log(IM), with natural
    logarithms, by least squares, and their dispersion σ. The panel lists these values, and the numbers of runs that
    rocked (`n`) and overturned (`OV`). Overturned runs have no peak; they are crosses at the top, one row per model.
    Where there is no fit, for instance with motions of a single intensity, the panel has points without a line and a
    note.

    Parameters
    ----------
    runs
        The table of a cloud study, such as `run_cloud` returns.
    quantity
        ``"max_rotation"`` (Fig. 6), ``"max_top_displacement"`` (Fig. 7, relative to the base) or
        ``"max_total_top_displacement"`` (relative to the ground).
    measure
        Column of the intensity measure.
    threshold
        A run counts as rocking if its base uplifted and its rotation in rad is larger.
    nominal
        Whether runs that exceed 0.7 atan(B/h*_1) count as overturned, as well as those that reach π/2.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per structure, with logarithmic scales; rad or m over the measure in its unit.

    Raises
    ------
    InputError
        If the quantity is unknown, the table lacks a column or holds no solved run, a measure is not positive, or there
        are too many structures or models; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = {"a": rf.ricker_pulse(2.5, 0.5), "b": rf.ricker_pulse(2.5, 1.0)}
    >>> runs = rf.run_cloud(structure, motions, "rigid", scales=[0.5, 1.0, 1.5, 2.0])
    >>> figure = rf.plot_clouds(runs, measure="pga")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('PGA [m/s²]', '$θ_{\\mathrm{max}}$ [rad]')
    """
    if quantity not in _QUANTITIES:
        raise InputError(f"quantity must be one of {', '.join(_QUANTITIES)}, but {shown(quantity)} was given.")
    import pandas as pd

    check_table_columns(runs, ("structure", "model", "status", measure), "what run_cloud returned")
    clouds = _plotted_clouds(runs, quantity, measure, threshold, nominal=nominal)
    styles = model_lines_and_symbols(names_in_column(cloud.model for cloud in clouds))
    names = names_in_column(cloud.structure for cloud in clouds)
    rocked, fallen = pd.concat([cloud.rocked for cloud in clouds]), pd.concat([cloud.fallen for cloud in clouds])
    with with_figure_style(size=size):
        figure, panels = structure_panels(names, 2, 2.45, measure_axis_name(measure), _QUANTITIES[quantity])
        panels[0].set(xscale="log", yscale="log")
        for axes in panels:
            label_log_axis_plainly(axes.xaxis)
        _set_cloud_limits(panels[0], rocked, pd.concat([rocked, fallen]), quantity, measure, len(styles))
        for axes, name in zip(panels, names, strict=True):
            rows: list[tuple[str, str]] = []
            for cloud in (cloud for cloud in clouds if cloud.structure == name):
                style, marker = styles[cloud.model]
                _draw_cloud(axes, cloud, quantity, measure, style, marker)
                _mark_overturned_runs(
                    axes, cloud.fallen[measure].to_numpy(dtype=float), style, list(styles).index(cloud.model)
                )
                rows.append((_cloud_numbers_text(cloud), style.color))
            _write_cloud_numbers(axes, rows)
        handles = model_legend_handles(styles)
        if len(fallen):
            handles.append(Line2D([], [], color=BLACK, marker="x", linestyle="", markersize=3.0, label="overturned"))
        add_legend_above(figure, handles)
    return figure


def _plotted_clouds(
    runs: "pd.DataFrame", quantity: str, measure: str, threshold: float, *, nominal: bool
) -> list[_PlottedCloud]:
    """Clouds of all structures and models, in the order of the table."""
    fits, _ = fit_each_cloud(runs, measure, threshold=threshold, nominal=nominal)
    fit_of = {(fit.structure, fit.model): fit for fit in fits}
    _check_solved_runs(runs[runs["status"].notna()], measure)
    clouds: list[_PlottedCloud] = []
    for structure, model, group in runs_by_case(runs):
        solved = group[group["status"].notna()]
        fell = (NOMINAL if nominal else OVERTURNING).exceeded(solved).to_numpy(dtype=bool)
        rocks = ~fell & rocked_runs(solved, threshold).to_numpy(dtype=bool)
        fit = fit_of.get((structure, model))
        line = fit and (fit.outcomes.rotation if quantity == "max_rotation" else getattr(fit, quantity[4:]))
        failed = len(group) - len(solved)
        clouds.append(_PlottedCloud(structure, model, solved[rocks], solved[fell], failed, line, fit is not None))
    return clouds


def _check_solved_runs(solved: "pd.DataFrame", measure: str) -> None:
    if not len(solved):
        raise InputError("No run was solved. See the column error of the table.")
    bad = ~(solved[measure].to_numpy(dtype=float) > 0.0)
    if bad.any():
        raise InputError(
            f"{measure} must be positive, as its axis is logarithmic, but {int(bad.sum())} of {bad.size} values are "
            f"not. Leave those runs out: keep the rows with {measure} > 0."
        )


def _set_cloud_limits(
    axes: Axes, rocked: "pd.DataFrame", seen: "pd.DataFrame", quantity: str, measure: str, n_models: int
) -> None:
    """Leave room for all points, a row of crosses per model above them, and the numbers below."""
    im = seen[measure].to_numpy(dtype=float)
    values = rocked[quantity].to_numpy(dtype=float)
    values = values[values > 0.0]
    low, high = (values.min(), values.max()) if values.size else (1e-4, 1e-1)
    left, right = (im.min(), im.max()) if im.size else (0.1, 1.0)
    below, above = 0.06 + _ROW * (n_models + 1), 0.06 + _CROSSES * n_models
    height = max(float(np.log(high / low)), 0.5) / (1.0 - below - above)
    axes.set_ylim(low * np.exp(-below * height), high * np.exp(above * height))
    margin = 1.15 if right > 2.0 * left else 2.0  # of one intensity alone, wide enough for labels
    axes.set_xlim(left / margin, right * margin)


def _draw_cloud(axes: Axes, cloud: _PlottedCloud, quantity: str, measure: str, style: LineStyle, marker: str) -> None:
    im = cloud.rocked[measure].to_numpy(dtype=float)
    axes.plot(
        im, cloud.rocked[quantity].to_numpy(dtype=float), marker, color=style.color, markersize=2.4,
        markerfacecolor="none", markeredgewidth=0.45, alpha=0.6, label=f"_{cloud.model}",
    )  # fmt: skip
    if cloud.line is not None:
        ends = np.array([im.min(), im.max()])
        axes.plot(
            ends, cloud.line.median(ends), color=style.color, linestyle=style.dashes, linewidth=1.3, label=cloud.model,
            zorder=3.0,
        )  # fmt: skip


def _mark_overturned_runs(axes: Axes, im: Array, style: LineStyle, rank: int) -> None:
    """Crosses of the runs that overturned, in the model's own row at the top."""
    axes.plot(
        im, np.full(im.size, 0.97 - _CROSSES * rank), "x", color=style.color, markersize=2.6, markeredgewidth=0.6,
        transform=axes.get_xaxis_transform(), label="_overturned",
    )  # fmt: skip


def _cloud_numbers_text(cloud: _PlottedCloud) -> str:
    line = cloud.line
    three = "     –     –     –" if line is None else f"{line.c1:6.2f}{line.c2:6.2f}{line.dispersion:6.2f}"
    remarks = [f"{cloud.n_failed} failed"] * bool(cloud.n_failed) + ["no fit"] * (not cloud.fitted)
    remark = f" ({', '.join(remarks)})" if remarks else ""
    return f"{cloud.model[:9]:>9}{three}{len(cloud.rocked):5d}{len(cloud.fallen):4d}{remark}".replace("-0.00", " 0.00")


def _write_cloud_numbers(axes: Axes, rows: list[tuple[str, str]]) -> None:
    """Write the numbers of all models, the first on top, in the lower right corner."""
    header = f"{'':9}{'c₁':>6}{'c₂':>6}{'σ':>6}{'n':>5}{'OV':>4}"
    width = max(len(text) for text, _ in rows)  # remarks stand behind, and move no column
    for place, (text, color) in enumerate(reversed([(header, BLACK), *rows])):
        axes.text(
            0.985, 0.025 + _ROW * place, text.ljust(width), transform=axes.transAxes, color=color,
            fontsize=scaled_font_size(_TINY), ha="right", family="DejaVu Sans Mono",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.6, "pad": 0.5},
        )  # fmt: skip
