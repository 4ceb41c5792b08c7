"""Response histories of several models, one panel per quantity."""

from collections.abc import Iterable, Sequence
from string import ascii_uppercase

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockflex.plot._curves import Curve, curves_of
from rockflex.plot._panel import add_key, draw_panel, quantities_of, usual_panels
from rockflex.plot._style import GRAY, SHADE, Size, new_figure, styled
from rockflex.response import Response

_BAR = 0.025  # height of an uplift bar as a share of the panel


def plot_history(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    panels: Sequence[str] | None = None,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot rotation θ, displacements of the top, base moment M_b and base shear V_b over time, one panel each.

    With ``panels=("rotation", "top_displacement", "base_moment", "base_shear")`` the figure is that of Silva &
    Stojadinović 2024, Fig. 15; with the first two, that of Figs. 3 and 4. Their u_top is relative to the rotating base;
    the total displacement is relative to the ground, and comparable with a fixed base. The times during which the base
    of the most detailed model is uplifted are shaded; if several models rock, bars at the bottom of the first panel
    show the uplifts of each. Circles mark the true peaks, which are listed with their times beside each panel.
    Overturning does not extend the axes: a triangle marks where the rotation leaves its panel, and a dotted line when
    |θ| = π/2.

    Parameters
    ----------
    responses
        One response or several, each with its history, of one structure or of several.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    panels
        Which of ``"rotation"``, ``"top_displacement"``, ``"total_top_displacement"``, ``"base_moment"``,
        ``"base_shear"``, ``"horizontal_reaction"``, ``"slip"`` and ``"edge_uplift"`` (of the left edge, and thinner of
        the right one), from the top. Default: all but the last three; without the total displacement if the height of
        the top is not known, and with the slip if a base can slide and the edges if one is on springs.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per panel over a common time axis in s; θ in rad, displacements in m, M_b and V_b in units that suit
        their size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels differs, or a panel is
        unknown; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_history(response, panels=["rotation", "base_moment"])
    >>> len(figure.axes), figure.axes[1].get_xlabel()
    (2, 'time [s]')
    """
    curves = curves_of(responses, labels)
    quantities = quantities_of(usual_panels(curves) if panels is None else panels)
    handles: list[Artist] = []
    with styled(size=size):
        figure = new_figure(6.3, len(quantities) * max(1.45, 0.155 * (len(curves) + 2)) + 0.8)
        grid: list[Axes] = list(figure.subplots(len(quantities), 1, sharex=True, squeeze=False).flat)
        for axes, quantity, mark in zip(grid, quantities, ascii_uppercase, strict=False):
            handles = draw_panel(axes, quantity, curves, mark)
        names = [curve.label for curve in curves]
        main = shade_uplifts(grid, curves)
        if main is not None:
            handles.append(Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4))
            names.append(f"uplifted: {main.label}" if len(curves) > 1 else "uplifted")
        grid[-1].set_xlabel("time [s]")
        grid[-1].set_xlim(
            min(float(curve.history.time[0]) for curve in curves),
            max(float(curve.history.time[-1]) for curve in curves),
        )
        figure.align_ylabels()
        add_key(figure, curves, handles, names, title, 88)
    return figure


def shade_uplifts(panels: list[Axes], curves: list[Curve]) -> Curve | None:
    """Shade the uplifts of the most detailed model, and return that model."""
    rocking = [curve for curve in curves if curve.uplifts.size]
    if not rocking:
        text = "no uplift" if any(curve.lifts for curve in curves) else "fixed base"
        panels[0].text(0.5, 0.75, text, transform=panels[0].transAxes, ha="center", va="center", color="#404040")
        return None
    main = max(rocking, key=lambda curve: curve.history.model.properties.n_modes)
    for axes in panels:
        _draw_spans(axes, main, 0.0, 1.0, SHADE, 0.5)
    if len(rocking) == 1:
        return main
    low, high = panels[0].get_ylim()
    foot = _BAR * (len(rocking) + 1)
    panels[0].set_ylim(low - (high - low) * foot / (1.0 - foot), high)
    for row, curve in enumerate(reversed(rocking)):
        _draw_spans(panels[0], curve, _BAR * (row + 0.35), 0.7 * _BAR, curve.look.color, 2.6)
    return main


def _draw_spans(axes: Axes, curve: Curve, bottom: float, height: float, color: str, order: float) -> None:
    """Draw a bar over every phase of rocking; bottom and height are fractions of the panel."""
    spans = [(float(start), float(end - start)) for start, end in curve.uplifts]
    axes.broken_barh(
        spans, (bottom, height), transform=axes.get_xaxis_transform(), color=color, linewidth=0.0, zorder=order
    )
