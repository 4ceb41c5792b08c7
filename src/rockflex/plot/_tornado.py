"""Tornado diagrams: a bar for each parameter, from one end of its range to the other, the widest on top."""

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, BLUE, ORANGE, SMALL, Size
from rockflex.response._outputs import OUTPUTS
from rockflex.studies._tornado import Tornado

MOST = 15  # bars


def plot_tornado(tornado: Tornado, *, size: Size | None = None) -> Figure:
    """Plot a tornado diagram: the demand with each parameter at the low and at the high end of its range.

    The line is the demand with all parameters as given; the numbers beside the bars are the factors at their ends.

    Parameters
    ----------
    tornado
        What `tornado` returned, of which the 15 widest bars are shown.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches.

    Returns
    -------
    matplotlib.figure.Figure
        One axes.

    Raises
    ------
    InputError
        If it is no tornado, or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> found = rf.tornado(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
    ...     parameters={"period": 0.2, "damping_ratio": (0.5, 2.0)})
    >>> figure = rf.plot_tornado(found)
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['period', 'damping_ratio']
    """
    known = checked_instance("tornado", tornado, Tornado)
    output = OUTPUTS[known.demand]
    names = known.parameters[:MOST]
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.0, 1.1 + 0.45 * len(names))
        axes = figure.subplots()
        factor, unit = figures.axis_unit(output.quantity, float(known.values.max(initial=known.base)), output.usual)
        middle, places = known.base / factor, list(range(len(names)))
        reach = max(float(known.swings.max(initial=0.0)) / factor, 1e-12 * abs(middle))
        labels = translated("parameter at its low end"), translated("parameter at its high end")
        bars: list[Artist] = []
        for end, colour in ((0, BLUE), (1, ORANGE)):
            ends = known.values[: len(names), end] / factor
            at = [place + (0.17 if end else -0.17) for place in places]  # both ends may be on one side
            bars.append(axes.barh(at, ends - middle, left=middle, height=0.34, color=colour).patches[0])
            for place, value, number in zip(at, ends.tolist(), known.factors[:, end].tolist(), strict=False):
                axes.annotate(
                    f"× {short_number(number)}",
                    (value, place),
                    xytext=(3 if value >= middle else -3, 0),
                    textcoords="offset points",
                    ha="left" if value >= middle else "right",
                    va="center",
                    fontsize=SMALL,
                )
        axes.axvline(middle, color=BLACK, linewidth=0.8)
        axes.set_yticks(places, [figures.literal_text(name) for name in names])
        axes.invert_yaxis()
        low, high = float(known.values.min()) / factor, float(known.values.max()) / factor
        axes.set_xlim(min(low, middle) - 0.25 * reach, max(high, middle) + 0.25 * reach)
        axes.xaxis.set_major_locator(MaxNLocator(4))  # the demands may differ in their last digits only
        symbol = figures.symbol_in_mathematics(output.symbol)
        median = translated("median of {n} records", n=known.n_records) if known.n_records > 1 else ""
        axes.set_xlabel(f"{symbol}{f' [{unit}]' if unit else ''}{f', {median}' if median else ''}")
        figures.add_legend_above(figure, bars, labels)
    return figure
