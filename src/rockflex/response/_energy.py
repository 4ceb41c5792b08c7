"""The energy ledger (energy balance) of a history.

The simplified equations (Eqs. 15, 23 and 25) describe a system with the energy
½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'² + ½ Σ m* ω² D² + s m_tot g B θ - ½ L_0^r g θ²
relative to the moving ground, plus the energy of the elements between base and ground. The work of the ground is
-∫ a (L_0^r θ' + Σ m* D') dt. For the complete equations the energy is that of Eqs. 6-8. A base that slides has further
kinetic energy, and one on springs the energy of its heave; vertical acceleration of the ground does work on the weight
that rises, -∫ a_v (m_tot z' - L_0^r θ θ') dt.
"""

from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._values import Value
from rockflex.models import (
    HEADER,
    SIDE,
    TIME,
    RockingModel,
    element_energies,
    soil_strain,
    stored_energies,
)
from rockflex.response._element_losses import element_losses
from rockflex.response._work import sweeps_of, work_between


@dataclass(frozen=True, eq=False)
class EnergyLedger(Value):
    """Energies in J at every state of a history, relative to the moving ground; read-only arrays of shape (n_states,).

    ``kinetic + strain + gravity + element_strain + soil_strain + damped + yielded + elements.sum(axis=1) + friction +
    soil.sum(axis=1) + lost - input`` is constant; `residual` is its numerical deviation from the initial value.

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
    soil_strain
        Elastic energy stored in the springs under the base: ½ k z_j² while z_j < 0, loaded or not.
    friction, soil
        Energy lost by sliding, and by each spring under the base, shape (n_states, n_springs), up to each state.
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
    soil_strain: Array
    friction: Array
    soil: Array

    @property
    def residual(self) -> Array:
        """Error of the energy balance at each state, in J."""
        spent = self.damped + self.yielded + self.elements.sum(axis=1) + self.lost
        total = self.stored + spent + self.friction + self.soil.sum(axis=1) - self.input
        return total - total[0]

    @property
    def stored(self) -> Array:
        """Stored energy: kinetic, strain, gravity and that of the elements and the springs under the base, in J."""
        return self.kinetic + self.strain + self.gravity + self.element_strain + self.soil_strain

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
    work = work_between(model, states)
    damped, given, yielded = work.damped, work.ground, np.zeros(work.damped.size)
    if model.integrated:
        integrated = (states[:-1, SIDE] != 0.0) | (model.bouc_wen is not None)
        counted = np.diff(states[:, HEADER + model.layout.damped : HEADER + model.layout.yielded + 1], axis=0)
        # The counters are not advanced while contact is solved in closed form, and resume when it ends.
        damped, given, yielded = np.where(integrated, counted.T, (damped, given, yielded))
        if model.layout.swept >= 0:
            swept = np.diff(model.layout.of(states, model.layout.swept))
            work = work._replace(swing=np.where(integrated, swept, work.swing))
    return EnergyLedger(
        kinetic=kinetic,
        strain=strain,
        gravity=gravity,
        element_strain=element_energies(model, states).sum(axis=1),
        damped=_summed(damped),
        yielded=_summed(yielded),
        elements=_summed(element_losses(model, states, sweeps_of(model, states, work))),
        input=_summed(given),
        lost=np.cumsum(lost),
        impact_losses=losses,
        soil_strain=soil_strain(model, states).sum(axis=1),
        friction=_summed(work.friction),
        soil=_summed(work.soil),
    )


def _summed(parts: Array) -> Array:
    """Return the sums up to each state of what is known between adjacent states."""
    return np.concatenate((np.zeros((1, *parts.shape[1:])), np.cumsum(parts, axis=0)))


def is_impact(model: RockingModel, states: Array) -> Bools:
    """Return True for the interval between the two states of every impact, shape (n_states - 1,)."""
    spin, rotation = (model.layout.of(states, place) for place in (model.layout.spin, model.layout.rotation))
    time, side = states[:, TIME], states[:, SIDE]
    landed = (time[1:] == time[:-1]) & (side[:-1] != 0.0) & (rotation[:-1] == 0.0)
    return landed & ((side[1:] != side[:-1]) | (spin[1:] != spin[:-1]))
