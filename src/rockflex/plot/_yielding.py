"""Hysteresis of the superstructure, alone and with the histories."""

from collections.abc import Iterable, Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex.plot._curves import Curve, curves_of
from rockflex.plot._history import shade_uplifts
from rockflex.plot._panel import add_key, draw_panel, quantities_of, scale_of
from rockflex.plot._style import Size, letter, narrow, new_figure, styled
from rockflex.response import Response


def plot_hysteresis(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot the restoring force V_b of the superstructure over its top displacement u_top.

    For one mode V_b is Eq. 37 of Silva & Stojadinović 2024 times m*_1, and an elastic superstructure gives a line; for
    several modes V_b is not a function of u_top. Overturning is plotted until the weight overturns the structure.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; u_top in m, V_b in a unit that suits its size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, or the number of labels differs; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_hysteresis(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$u_{\\mathrm{top}}$, relative [m]', '$V_b$ [kN]')
    """
    curves = curves_of(responses, labels)
    with styled(size=size):
        figure = new_figure(4.2, 3.6)
        lines = _loops(figure.subplots(), curves)
        add_key(figure, curves, lines, [curve.label for curve in curves], title, 58)
    return figure


def plot_yielding(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot rotation θ and top displacement u_top over time, and the hysteresis of the superstructure.

    The figure is that of Silva & Stojadinović 2024, Figs. 16 and 17. Peaks and uplifts are shown as in `plot_history`,
    loops as in `plot_hysteresis`.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Three axes: A, θ in rad over s; B, u_top in m over s; C, V_b, in the unit that suits its size, over m.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, or the number of labels differs; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_yielding(response)
    >>> len(figure.axes), figure.axes[-1].get_xlabel()
    (3, '$u_{\\mathrm{top}}$, relative [m]')
    """
    curves = curves_of(responses, labels)
    with styled(size=size):
        tall = max(1.45, 0.155 * (len(curves) + 2))
        figure = new_figure(8.6, (2.0 * tall if not narrow() else 2.0 * tall + 2.6) + 0.9)
        if narrow():
            grid = figure.add_gridspec(3, 1, height_ratios=(tall, tall, 2.6))
        else:
            grid = figure.add_gridspec(2, 2, width_ratios=(1.55, 1.0))
        top = figure.add_subplot(grid[0, 0])
        histories: list[Axes] = [top, figure.add_subplot(grid[1, 0], sharex=top)]
        for axes, quantity, mark in zip(histories, quantities_of(("rotation", "top_displacement")), "AB", strict=True):
            draw_panel(axes, quantity, curves, mark)
        shade_uplifts(histories, curves)
        top.tick_params(labelbottom=False)
        histories[1].set(xlabel="time [s]", xlim=(0.0, max(float(curve.history.time[-1]) for curve in curves)))
        loops = figure.add_subplot(grid[2, 0] if narrow() else grid[:, 1])
        lines = _loops(loops, curves)
        letter(loops, "C")
        figure.align_ylabels(histories)
        add_key(figure, curves, lines, [curve.label for curve in curves], title, 110)
    return figure


def _loops(axes: Axes, curves: list[Curve]) -> list[Artist]:
    """Fill a panel with V_b over u_top; return a line for each curve."""
    displacement, force = quantities_of(("top_displacement", "base_shear"))
    _, across, right = scale_of(displacement, curves)
    factor, unit, high = scale_of(force, curves)
    axes.set(xlim=(-right, right), ylim=(-high, high))
    axes.locator_params(axis="x", nbins=5)
    axes.set(xlabel=f"{displacement.symbol} [{across}]", ylabel=f"{force.symbol} [{unit}]")
    lines: list[Artist] = []
    for curve in curves:
        drawn = curve.before_fall
        lines += axes.plot(
            displacement.of(curve.history)[drawn], force.of(curve.history)[drawn] / factor, color=curve.look.color,
            linestyle=curve.look.dashes, linewidth=curve.look.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
    return lines
