"""The effect of uncertain properties, as a band around each model's response."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.plot._curves import Curve, curves_of, title_of
from rockflex.plot._panel import Quantity, quantities_of, scale_of
from rockflex.plot._style import BLACK, GRAY, SHADE, Size, columns, narrow, new_figure, points, styled
from rockflex.response import Response

_POINTS = 2000  # across the panel, more than it has dots


def plot_spread(
    responses: Sequence[Response],
    varied: Sequence[Sequence[Response]],
    labels: Sequence[str] | None = None,
    *,
    panels: Sequence[str] = ("rotation", "top_displacement"),
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot each response with the band from the smallest to the largest value of its variations at each time.

    The band is not a response: it encloses the variations that were run, and says nothing about others. A variation is
    excluded once it has ended or overturns.

    Parameters
    ----------
    responses
        One response per row, with its history.
    varied
        For each of them, the varied responses of the same model: at least one, with histories.
    labels
        A name for each response. Default: the models, with the motions if a model occurs twice.
    panels
        Panels of `plot_history`, from the left.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One row of axes per response and one column per panel, over a common time axis in s.

    Raises
    ------
    InputError
        If the number of groups of variations differs, one is empty or without history, or a panel is unknown; or the
        size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> others = [rf.simulate(frame, rf.ricker_pulse(a, 0.6), "2DOF-S") for a in (3.9, 4.1)]
    >>> figure = rf.plot_spread([response], [others], panels=["rotation"])
    >>> len(figure.axes), figure.axes[0].get_xlabel()
    (1, 'time [s]')
    """
    curves = curves_of(responses, labels)
    if len(varied) != len(curves) or not all(len(group) for group in varied):
        raise InputError(
            f"varied must hold {len(curves)} groups, one per response, each of at least one response, but groups of "
            f"{[len(group) for group in varied]} were given."
        )
    groups = [[_alone(response) for response in group] for group in varied]
    quantities = quantities_of(panels)
    everything = [*curves, *(curve for group in groups for curve in group)]
    times = np.linspace(0.0, max(float(curve.history.time[-1]) for curve in curves), _POINTS)
    with styled(size=size):
        shape = (len(quantities) * len(curves), 1) if narrow() else (len(curves), len(quantities))
        figure = new_figure(0.8 + 3.2 * len(quantities), 0.9 + 1.35 * shape[0])
        # In a narrow figure all panels of a quantity stand above those of the next.
        grid = figure.subplots(*shape, sharex=True, squeeze=False).reshape(len(curves), -1, order="F")
        for column, quantity in enumerate(quantities):
            factor, unit, limit = scale_of(quantity, everything)
            for row, (curve, group) in enumerate(zip(curves, groups, strict=True)):
                axes: Axes = grid[row, column]
                low, high = _band(quantity, [curve, *group], times)
                axes.fill_between(times, low / factor, high / factor, color=SHADE, edgecolor=GRAY, linewidth=0.4)
                drawn = curve.before_fall
                values = quantity.of(curve.history)[drawn] / factor
                axes.plot(curve.history.time[drawn], values, color=BLACK, linewidth=0.8, label=curve.label)
                axes.set(ylim=(-limit, limit), xlim=(0.0, float(times[-1])), ylabel=f"{quantity.symbol} [{unit}]")
                axes.set_title(curve.label, fontsize=points(8.0), loc="left", pad=3.0)
            if column + 1 == len(quantities) or not narrow():
                grid[-1, column].set_xlabel("time [s]")
        figure.align_ylabels()
        handles = [grid[0, 0].get_lines()[0], Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4)]
        names = ["nominal", "from the least to the largest of what was varied"]
        figure.legend(
            handles, names, loc="outside upper center", ncols=columns(names, 16 + 45 * len(quantities)),
            title=title_of(curves, title), title_fontsize="medium",
        )  # fmt: skip
    return figure


def _alone(response: Response) -> Curve:
    return curves_of(response)[0]


def _band(quantity: Quantity, curves: list[Curve], times: Array) -> tuple[Array, Array]:
    """Smallest and largest value at each time, among those that have not ended."""
    rows = np.full((len(curves), times.size), np.nan)
    for row, curve in zip(rows, curves, strict=True):
        drawn = curve.before_fall
        time = curve.history.time[drawn]
        inside = times <= time[-1]
        row[inside] = np.interp(times[inside], time, quantity.of(curve.history)[drawn])
    known = ~np.isnan(rows).all(axis=0)
    low, high = np.full(times.size, np.nan), np.full(times.size, np.nan)
    low[known], high[known] = np.nanmin(rows[:, known], axis=0), np.nanmax(rows[:, known], axis=0)
    return low, high
