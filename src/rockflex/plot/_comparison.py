"""Alternatives side by side: their histories in common panels, and the structures as they rock."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.language import translated
from rockflex.plot import _figures as figures
from rockflex.plot._figures import Size
from rockflex.plot._history import plot_history, response_curves
from rockflex.plot.animation._scene import draw_structures_at
from rockflex.response._comparison import Comparison

_MM = 1.0 / 25.4  # inches


def plot_comparison(
    comparison: Comparison,
    *,
    panels: Sequence[str] | None = None,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot the histories of alternatives under their governing record over each other, one panel per quantity.

    Colours and dashes tell the alternatives apart; one legend names them.

    Parameters
    ----------
    comparison
        What `compare` returned.
    panels, size
        As in `plot_history`.
    title
        Default: the governing record, and of how many it is one.

    Returns
    -------
    matplotlib.figure.Figure
        As `plot_history`.

    Raises
    ------
    InputError
        If a panel or the size is unknown, or it is no comparison.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> tied = rf.Restrained(frame, rf.Tendon(initial_force=100e3, stiffness=5e6))
    >>> both = rf.compare({"free": frame, "tied": tied},
    ...     rf.one_sine_pulse(amplitude=3.0, period=0.8))
    >>> figure = rf.plot_comparison(both, panels=["rotation", "base_moment"])
    >>> [text.get_text() for text in figure.legends[0].get_texts()][:2]
    ['free', 'tied']
    """
    known = checked_instance("comparison", comparison, Comparison)
    if title is None:
        title, n = figures.literal_text(known.motion.name), known.n_records
        title = title if n == 1 else translated("{record}, which governs of {n}", record=title, n=n)
    labels = [figures.literal_text(name) for name in known.names]
    return plot_history(known.responses, labels, panels=panels, title=title, size=size)


def draw_alternatives(comparison: Comparison, *, width: float, height: float) -> Figure:
    """Draw the structures of a comparison at the instant at which one of them rotates most, `width` by `height` mm."""
    runs = comparison.responses
    instant = max(runs, key=lambda run: run.max_rotation).time_of_max_rotation
    with figures.applied_figure_style():
        curves = response_curves(runs, [figures.literal_text(name) for name in comparison.names])
        figure = figures.new_figure(width * _MM, height * _MM)
        figure.set_layout_engine("none")
        draw_structures_at(figure.add_axes((0.0, 0.0, 1.0, 1.0)), curves, comparison.structures, instant)
    return figure
