"""The energy ledger (energy balance) of a history.

The simplified equations (Eqs. 15, 23 and 25) describe a system with the energy
½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'² + ½ Σ m* ω² D² + s m_tot g B θ - ½ L_0^r g θ²
relative to the moving ground, plus the energy of the elements between base and ground. The work of the ground is
-∫ a (L_0^r θ' + Σ m* D') dt. For the complete equations the energy is that of Eqs. 6-8.
"""

import math
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.models import GROUND, HEADER, SIDE, TIME, RockingModel, element_energies, stored_energies
from rockflex.response._element_losses import element_losses
from rockflex.solve import ClosedForm

REACH = 8.0  # radians of the fastest mode covered by one Gauss rule, which then has at most 20 points
MOST_PIECES = 10_000  # per interval: a minute of quadrature for a record of a thousand samples


@dataclass(frozen=True, eq=False)
class EnergyLedger(Value):
    """Energies in J at every state of a history, relative to the moving ground; read-only arrays of shape (n_states,).

    ``kinetic + strain + gravity + element_strain + damped + yielded + elements.sum(axis=1) + lost - input`` is
    constant; `residual` is its numerical deviation from the initial value.

    Parameters
    ----------
    kinetic, strain, gravity
        Kinetic energy, elastic strain energy, and potential energy of the lifted weight (zero in contact).
    element_strain
        Elastic energy stored in tendons and dissipators, relative to the base in contact before anything yields. A bar
        that hardens also stores energy at zero force, locked in by its plastic stretch.
    damped, input
        Energy dissipated by modal damping, and work of the ground, up to each state; found by quadrature of the exact
        states, or integrated with the motion.
    yielded
        Energy absorbed by the hysteretic spring of a Bouc-Wen superstructure; `strain` is then that of its elastic
        part.
    elements
        Energy dissipated by each element up to each state, in the order of `RockingProperties.elements`, shape
        (n_states, E). An element that breaks dissipates what it had stored.
    lost
        Energy lost in impacts up to each state.
    impact_losses
        Energy lost in each impact, shape (n_impacts,).

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> energy = rf.simulate(column, pulse, "2DOF-S", output="history", free_vibration=5.0).energy
    >>> energy.impact_losses.size
    3
    >>> energy.closing_error < 1e-9
    True
    """

    kinetic: Array
    strain: Array
    gravity: Array
    element_strain: Array
    damped: Array
    yielded: Array
    elements: Array
    input: Array
    lost: Array
    impact_losses: Array

    @property
    def residual(self) -> Array:
        """Error of the energy balance at each state, in J."""
        total = self.stored + self.damped + self.yielded + self.elements.sum(axis=1) + self.lost - self.input
        return total - total[0]

    @property
    def stored(self) -> Array:
        """Stored energy: kinetic, strain, gravity and that of the elements, in J."""
        return self.kinetic + self.strain + self.gravity + self.element_strain

    @property
    def tendons(self) -> Array:
        """Another name of `element_strain`."""
        return self.element_strain

    @property
    def closing_error(self) -> float:
        """Largest residual divided by the largest input energy, or by the initial energy if that is larger."""
        start = abs(float(self.stored[0]))
        scale = max(float(np.max(np.abs(self.input))), start)
        return float(np.max(np.abs(self.residual))) / scale if scale > 0.0 else 0.0


def energy_ledger(model: RockingModel, states: Array) -> EnergyLedger:
    """Return the energy ledger of a history; `states` as in `History`.

    Raises
    ------
    InputError
        If the model is too fast for the sampling: too many quadratures would be needed.
    """
    kinetic, strain, gravity = stored_energies(model, states)
    impact = np.flatnonzero(is_impact(model, states))
    losses = kinetic[impact] - kinetic[impact + 1]
    lost = np.zeros(states.shape[0])
    np.add.at(lost, impact + 1, losses)
    damped, work, swing = _work(model, states)
    yielded = np.zeros(damped.size)
    if model.integrated:
        integrated = (states[:-1, SIDE] != 0.0) | (model.bouc_wen is not None)
        counted = np.diff(states[:, HEADER + model.layout.damped : HEADER + model.layout.yielded + 1], axis=0)
        # The counters are not advanced while contact is solved in closed form, and resume when it ends.
        damped, work, yielded = np.where(integrated, counted.T, (damped, work, yielded))
        if model.layout.swept >= 0:
            swing = np.where(integrated, np.diff(model.layout.of(states, model.layout.swept)), swing)
    return EnergyLedger(
        kinetic=kinetic,
        strain=strain,
        gravity=gravity,
        element_strain=element_energies(model, states).sum(axis=1),
        damped=np.concatenate(([0.0], np.cumsum(damped))),
        yielded=np.concatenate(([0.0], np.cumsum(yielded))),
        elements=np.vstack((np.zeros(len(model.elements)), np.cumsum(element_losses(model, states, swing), axis=0))),
        input=np.concatenate(([0.0], np.cumsum(work))),
        lost=np.cumsum(lost),
        impact_losses=losses,
    )


def is_impact(model: RockingModel, states: Array) -> Bools:
    """Return True for the interval between the two states of every impact, shape (n_states - 1,)."""
    spin, rotation = (model.layout.of(states, place) for place in (model.layout.spin, model.layout.rotation))
    time, side = states[:, TIME], states[:, SIDE]
    landed = (time[1:] == time[:-1]) & (side[:-1] != 0.0) & (rotation[:-1] == 0.0)
    return landed & ((side[1:] != side[:-1]) | (spin[1:] != spin[:-1]))


def _work(model: RockingModel, states: Array) -> tuple[Array, Array, Array]:
    """Return the damped and the input energy in J, and ∫ (δ'/r)² dt in rad²/s, between adjacent states.

    δ'/r is the rate of an element's elongation per unit distance from the pivot. All have the shape (n_states - 1,),
    and are found by Gauss quadrature.
    """
    p, layout = model.properties, model.layout
    n = p.n_modes
    motion = ClosedForm(model)
    intervals = motion.intervals(states)
    span = np.diff(states[:, TIME])
    places, weights = _rule(model.label, motion.fastest, float(span.max(initial=0.0)))
    drag = 2.0 * p.zeta * p.omega * p.effective_mass
    damped, work, swing = (np.zeros(span.size) for _ in range(3))
    for place, weight in zip(places, weights, strict=True):
        inside = intervals.at(float(place))
        v, spin = inside[:, n : 2 * n], inside[:, layout.spin]
        acceleration = states[:-1, GROUND] + place * np.diff(states[:, GROUND])
        damped += weight * span * (v**2 @ drag)
        work -= weight * span * acceleration * (p.l0r * spin + v @ p.effective_mass)
        swing += weight * span * spin**2
    return damped, work, swing


def _rule(label: str, fastest: float, longest: float) -> tuple[Array, Array]:
    """Return points in [0, 1] and weights of a Gauss rule for states with eigenvalues up to `fastest` (rad/s)."""
    pieces = max(math.ceil(fastest * longest / REACH), 1)
    if pieces > MOST_PIECES:
        raise InputError(
            f"The energy ledger of {label} needs {pieces} quadratures per step, above the limit of {MOST_PIECES}: the "
            f"model vibrates or decays at up to {fastest:.3g} rad/s, and steps last up to {longest:.3g} s. Keep fewer "
            "modes, damp them less, or refine the record."
        )
    places, weights = np.polynomial.legendre.leggauss(8 + math.ceil(1.5 * fastest * longest / pieces))
    starts = np.arange(pieces)[:, None]
    return ((starts + 0.5 + 0.5 * places) / pieces).ravel(), np.tile(0.5 * weights / pieces, pieces)
