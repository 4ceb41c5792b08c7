"""The exact engine's door: a model is prepared once, then once a time step, and records run through it."""

import math
from functools import cached_property

import numpy as np

from rockflex._kernel import Entry
from rockflex.models import LinearModel, impact_of, lost_support_row
from rockflex.solve._engine import QUIET, Engine, preparing
from rockflex.solve._observables import Observables
from rockflex.solve._pace import Pace
from rockflex.solve.exact.basis import contact_basis, rocking_basis
from rockflex.solve.exact.history import HEADER
from rockflex.solve.exact.layout import Array, Log, Physics, System, scratch
from rockflex.solve.exact.run import run
from rockflex.solve.exact.tables import propagate, tabulate

__all__ = ["ExactEngine", "physics_of"]

compiled_run = Entry(run)


class ExactEngine(Engine):
    """A piecewise linear model, uncoupled, with its propagators for every time step met so far.

    Parameters
    ----------
    model
        The model's parameters.
    observables
        Responses whose peaks are wanted.
    """

    def __init__(self, model: LinearModel, observables: Observables) -> None:
        impact, failures = impact_of(model.law, model.properties)
        super().__init__(model, 2 + observables.contact.shape[0], failures)
        self._impact = impact
        rotation = np.zeros(2 * model.properties.n_modes + 4)
        rotation[-4] = 1.0
        supported = np.zeros_like(rotation)
        lost = lost_support_row(model) if model.lifts else supported
        contact = np.vstack((model.contact_moment(), observables.contact, supported))
        self._rows = np.stack((contact, np.vstack((rotation, observables.rocking, lost))))
        with preparing(model):
            self._physics = physics_of(model)
            self._contact = contact_basis(self._physics, self._rows[0])
            # A base that cannot lift never rocks, and a neutral one is integrated: the second phase fills the place.
            self._rocking = self._contact
            if model.lifts and not model.neutral:
                accelerations = np.vstack((model.modal_accelerations(rocking=True), model.angular_acceleration()))
                self._rocking = rocking_basis(self._physics, accelerations, self._rows[1])
        self._systems: dict[float, System] = {}

    def system(self, dt: float) -> System:
        """Propagators and bounds for one time step; computed once."""
        found = self._systems.get(dt)
        if found is None:
            found = tabulate(self._physics, self._rows, self._contact, self._rocking, dt)
            self._systems[dt] = found
        return found

    def _motion(self, start: Array) -> Array:
        return start.copy()

    def _carry(
        self, motion: Array, record: Array, dt: float, free: int, settle: bool, side: float, log: Log, nodes: Array
    ) -> tuple[int, int, int]:
        system = self.system(dt)
        room = scratch(motion, self._n_rows, system.order)
        return compiled_run(system, self._impact, record, QUIET, dt, free, settle, side, log, room, nodes)

    @cached_property
    def pace(self) -> Pace:
        """What the work of its runs grows with."""
        return Pace(self.model.properties.n_modes, self._n_rows, self.fastest, dense=self._rocking.dense)

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of both phases, rad/s."""
        return max(self._contact.fastest, self._rocking.fastest)

    def between(self, nodes: Array, fraction: float) -> Array:
        """States at one fraction of the way from every node to the next, shape (n_nodes - 1, 2N + 2)."""
        steps = np.diff(nodes[:, 0])
        # Samples' distances differ by the rounding of their times; alike, they share one propagator.
        steps = np.round(steps, 12 - math.ceil(math.log10(max(float(nodes[-1, 0]), 1.0))))
        safe = np.where(steps > 0.0, steps, 1.0)
        slopes = np.where(steps > 0.0, np.diff(nodes[:, 2]) / safe, 0.0)
        start = np.column_stack((nodes[:-1, 2], slopes, nodes[:-1, 1]))
        end = start.copy()
        end[:, 0] += fraction * steps * slopes
        states = nodes[:-1, HEADER:].copy()
        for basis, chosen in ((self._contact, start[:, 2] == 0.0), (self._rocking, start[:, 2] != 0.0)):
            if chosen.any():
                w = states[chosen] @ basis.inverse.T - start[chosen] @ basis.forced
                moved = propagate(basis, w, fraction * steps[chosen]) + end[chosen] @ basis.forced
                states[chosen] = moved @ basis.basis.T
        return states


def physics_of(model: LinearModel) -> Physics:
    """The model's coefficients as kernels take them."""
    p = model.properties
    return Physics(
        omega2=p.omega**2,
        damping=2.0 * p.zeta * p.omega,
        height=p.effective_height.copy(),  # writable, as the kernels are compiled for
        mass=p.effective_mass.copy(),
        inertia=model.free_inertia,
        gravity=-p.rocking_stiffness,
        resistance=model.resistance,
        drive_arm=float(np.sum(p.effective_mass * p.effective_height)) - p.l0r,
    )
