"""Pushover curves: base shear over the displacement of the top, what yields when, and the drifts of the stories."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.number_format import short_number, unit_with_prefix
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, BLUE, ORANGE, SMALL, Size
from rockflex.response._pushover import BilinearFit, Pushover

_MAX_NOTES = 12  # events that are listed


def plot_pushover(push: Pushover, fit: BilinearFit | None = None, *, size: Size | None = None) -> Figure:
    """Plot the base shear of a pushover over the displacement of the top, and the drifts of the stories.

    Numbers on the curve are its events, which are listed beside it. The drifts are those at the end.

    Parameters
    ----------
    push
        The result of `pushover`.
    fit
        Two lines to show with it, as `Pushover.fit` gives them.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes: the displacement of the top relative to the ground in m and the base shear in a unit that suits its
        size, and the drifts of the stories in mm.

    Raises
    ------
    InputError
        If `push` is no pushover, or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=float("inf"),
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.03)
    >>> push = rf.pushover(rf.YieldingStories(frame, [300e3, 250e3, 140e3], 0.05),
    ...     top_displacement=0.1, lifts=False)
    >>> figure = rf.plot_pushover(push, push.fit())
    >>> len(figure.axes), figure.axes[0].get_ylabel()
    (2, '$V_b$ [kN]')
    """
    checked_instance("push", push, Pushover)
    with figures.applied_figure_style(size=size):
        narrow = figures.is_narrow()
        figure = figures.new_figure(4.2, 6.0) if narrow else figures.new_figure(7.2, 3.4)
        if narrow:
            curve, drifts = figure.subplots(2, 1, height_ratios=[3, 2])
        else:
            curve, drifts = figure.subplots(1, 2, width_ratios=[3, 2])
        _draw_curve(curve, push, fit)
        _draw_drifts(drifts, push)
        figure.align_ylabels()
    return figure


def _draw_curve(axes: Axes, push: Pushover, fit: BilinearFit | None) -> None:
    factor, unit = unit_with_prefix(float(push.base_shear.max()), "N")
    axes.plot(push.total_top_displacement, push.base_shear / factor, color=BLUE, label="pushover")
    if fit is not None:
        end = float(push.top_displacement[-1])
        last = fit.yield_force + fit.post_yield_ratio * fit.stiffness * (end - fit.yield_displacement)
        lines = [0.0, fit.yield_force / factor, last / factor]
        axes.plot([0.0, fit.yield_displacement, end], lines, color=ORANGE, linestyle="--", label="bilinear fit")
    places = push.top_displacement.tolist()
    notes: list[str] = []
    for number, event in enumerate(push.events, 1):
        at = min(range(len(places)), key=lambda k: (abs(places[k] - event.top_displacement), k))
        x, y = float(push.total_top_displacement[at]), event.base_shear / factor
        axes.plot([x], [y], marker="o", color=BLACK, markersize=3.0, linestyle="none")
        notes.append(f"{number}: {event.name}, {short_number(event.base_shear / factor)} {unit}")
    if len(notes) > _MAX_NOTES:
        notes = [*notes[: _MAX_NOTES - 1], f"and {len(notes) - _MAX_NOTES + 1} more"]
    axes.set(xlabel="displacement of the top [m]", ylabel=f"$V_b$ [{unit}]")
    axes.set_xlim(0.0)
    axes.set_ylim(0.0)
    axes.text(
        *(0.97, 0.05, "\n".join(notes)), transform=axes.transAxes, fontsize=SMALL, ha="right", va="bottom",
        bbox={"facecolor": axes.get_facecolor(), "edgecolor": "none", "pad": 1.5},
    )  # fmt: skip
    if fit is not None:
        axes.legend(loc="upper left", fontsize=SMALL)


def _draw_drifts(axes: Axes, push: Pushover) -> None:
    stories = range(1, push.story_drift.shape[1] + 1)
    axes.barh(list(stories), 1e3 * push.story_drift[-1], color=BLUE, height=0.6)
    axes.set(xlabel="drift at the end [mm]", ylabel="story")
    axes.set_yticks(list(stories) if len(stories) <= 12 else list(stories)[:: -(-len(stories) // 12)])
    axes.set_xlim(min(0.0, float(push.story_drift[-1].min()) * 1.1e3))
