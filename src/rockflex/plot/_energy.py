"""Energy over time."""

import numpy as np
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex._number_format import unit_with_prefix
from rockflex.modal import Tendon
from rockflex.plot._response_curves import response_curves
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    YELLOW,
    Size,
    add_legend_beside,
    literal_text,
    new_figure,
    with_figure_style,
)
from rockflex.response import History, Response

BROWN, SAND, CLAY = "#7d5a30", "#d8c9a3", "#b8926a"  # of the ground


def plot_energy(response: Response, *, size: Size | None = None) -> Figure:
    """Plot the stored and dissipated energies, stacked, and the input energy.

    The layers are those of `EnergyLedger`, with the energies of the simplified models (Silva & Stojadinović 2024,
    Eqs. 15, 23 and 25). Their sum equals the input, which starts from the energy at t = 0; the title
    gives the difference. Tendons that lose prestress give back energy that they held before, which counts as part of
    the energy at t = 0. On springs, the raised weight counts from the deepest position of the base. A run that
    overturns is plotted until θ last passes the rotation at which the static resisting moment vanishes, beyond which
    the weight overturns it.

    Parameters
    ----------
    response
        One response with its history.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; time in s, energy in a unit that suits its size. Empty layers are left out.

    Raises
    ------
    InputError
        If the response has no history; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_energy(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('time [s]', 'energy [kJ]')
    """
    (curve,) = response_curves([response])
    history = curve.history
    ledger, drawn = history.energy, curve.before_fall
    released = -min(float(ledger.element_strain[drawn].min()), 0.0)  # at t = 0, and given back later
    settled = -min(float(ledger.gravity[drawn].min()), 0.0)  # below the level of the unloaded springs
    layers = [
        (label, color, values[drawn]) for label, color, values in _energy_layers(curve.history, released, settled)
    ]
    layers = [layer for layer in layers if np.any(layer[2] != 0.0)]
    start = float(ledger.stored[0]) + released + settled
    supply = ledger.input[drawn] + start
    factor, unit = unit_with_prefix(float(np.max(np.abs(supply))), "J")
    time = history.time[drawn]
    with with_figure_style(size=size):
        figure = new_figure(6.3, 3.4)
        axes = figure.subplots()
        if layers:
            axes.stackplot(
                time, *(values / factor for _, _, values in layers), labels=[label for label, _, _ in layers],
                colors=[color for _, color, _ in layers], linewidth=0.0,
            )  # fmt: skip
        axes.plot(time, supply / factor, color=BLACK, linewidth=0.9, label="input" if start == 0.0 else "start + input")
        if curve.falls:
            axes.axvline(time[-1], color=BLUE, linestyle=":", label="overturning")
        axes.set_xlim(float(history.time[0]), float(history.time[-1]))
        axes.set(ylim=(0.0, 1.06 * float(np.max(supply)) / factor or 1.0), xlabel="time [s]", ylabel=f"energy [{unit}]")
        title = f"{curve.label} under {literal_text(curve.response.motion)}, closing error {ledger.closing_error:.1e}"
        axes.set_title(title)
        handles, _ = axes.get_legend_handles_labels()
        add_legend_beside(figure, handles[::-1])
    return figure


def _energy_layers(history: History, released: float, settled: float) -> list[tuple[str, str, Array]]:
    """Return label, colour and values from the bottom: dissipated energy, which never falls, below stored energy."""
    ledger, elements = history.energy, history.model.properties.elements
    only_tendons = all(isinstance(each, Tendon) for each in elements)
    return [
        ("damped", GRAY, ledger.damped),
        ("lost in impacts", RED, ledger.lost),
        ("yield of tendons" if only_tendons else "taken by elements", YELLOW, ledger.elements.sum(axis=1)),
        ("friction of the base", BROWN, ledger.friction),
        ("damped by the ground", SAND, ledger.soil.sum(axis=1)),
        ("raised weight", GREEN, ledger.gravity + settled),
        ("compressed ground", CLAY, ledger.soil_strain),
        ("tendons" if only_tendons else "stored in elements", PURPLE, ledger.element_strain + released),
        ("strain", SKY, ledger.strain),
        ("kinetic", ORANGE, ledger.kinetic),
    ]
