"""Energy over time."""

import numpy as np
from matplotlib.figure import Figure

from rockflex.plot._curves import curves_of
from rockflex.plot._style import BLACK, BLUE, GRAY, GREEN, ORANGE, PURPLE, RED, SKY, literal, new_figure, styled
from rockflex.plot._units import readable
from rockflex.response import Response

# From the bottom: what is gone never falls, so what can still return rides on it.
_LAYERS = (
    ("damped", "damped", GRAY),
    ("lost", "lost in impacts", RED),
    ("gravity", "raised weight", GREEN),
    ("tendons", "tendons", PURPLE),
    ("strain", "strain", SKY),
    ("kinetic", "kinetic", ORANGE),
)


def plot_energy(response: Response) -> Figure:
    """Plot the stored and dissipated energies, stacked, and the input energy.

    The layers are those of `EnergyLedger`, with the energies of the simplified models (Silva & Stojadinović 2024,
    Eqs. 15, 23 and 25). Their sum equals the input, which starts from the energy at t = 0; the title
    gives the difference. A run that overturns is plotted until θ last passes the rotation at which the static
    resisting moment vanishes, beyond which the weight overturns it.

    Parameters
    ----------
    response
        One response with its history.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; time in s, energy in a unit that suits its size. Empty layers are left out.

    Raises
    ------
    InputError
        If the response has no history.

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
    (curve,) = curves_of([response])
    history = curve.history
    ledger, drawn = history.energy, curve.before_fall
    layers = [(label, color, np.asarray(getattr(ledger, name))[drawn]) for name, label, color in _LAYERS]
    layers = [layer for layer in layers if np.any(layer[2] != 0.0)]
    start = float(ledger.stored[0])
    supply = ledger.input[drawn] + start
    factor, unit = readable(float(np.max(np.abs(supply))), "J")
    time = history.time[drawn]
    with styled():
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
        title = f"{curve.label} under {literal(curve.response.motion)}, closing error {ledger.closing_error:.1e}"
        axes.set_title(title)
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside right upper")
    return figure
