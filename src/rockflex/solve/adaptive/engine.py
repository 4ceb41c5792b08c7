"""The adaptive engine's door: the complete and the yielding models."""

import math

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._kernel import Entry
from rockflex.models import EXTRA, LINEAR, VERTICAL, NonlinearModel, impact_of, lost_support_row
from rockflex.solve._engine import QUIET, Engine, preparing
from rockflex.solve._observables import Observables
from rockflex.solve.adaptive.layout import Flow, stages
from rockflex.solve.adaptive.run import run
from rockflex.solve.exact.basis import contact_basis
from rockflex.solve.exact.engine import physics_of
from rockflex.solve.exact.layout import Array, Log, System, scratch
from rockflex.solve.exact.tables import tabulate

__all__ = ["AdaptiveEngine"]

compiled_run = Entry(run)
TOLERANCE = 1e-10  # relative, of a step
TREMOR = 0.01  # m/s²


class AdaptiveEngine(Engine):
    """A nonlinear model with its propagators of linear contact for every time step met so far.

    Parameters
    ----------
    model
        The model's parameters.
    observables
        Responses whose peaks are wanted.
    tolerance
        Relative error allowed in a step.
    """

    def __init__(self, model: NonlinearModel, observables: Observables, tolerance: float = TOLERANCE) -> None:
        impact, failures = impact_of(model.law, model.properties)
        super().__init__(model, 2 + observables.contact.shape[0], failures)
        linear = model.linear
        guards = model.guards()
        supported = np.zeros_like(guards[0])
        lost = supported if model.complete or not model.lifts else lost_support_row(model)
        contact = np.vstack((guards[0], observables.contact, supported))
        both = np.stack((contact, np.vstack((guards[1], observables.rocking, lost))))
        own = VERTICAL if model.complete else LINEAR
        self._flow = Flow(
            field=model.field(),
            resistance=linear.resistance,
            free_inertia=linear.free_inertia,
            rows=both,
            kinds=np.concatenate(([LINEAR], observables.kinds, [own])).astype(np.int64),
            levers=np.vstack((np.zeros((1, 2)), observables.levers, np.zeros((1, 2)))),
            rest=model.properties.resting_reaction,
            scale=_scale(model),
            tolerance=tolerance,
        )
        self._impact = impact
        n = model.properties.n_modes
        self._plain_rows = np.delete(both, 2 * n + 2, axis=2)
        with preparing(model):
            self._physics = physics_of(linear)
            self._contact = contact_basis(self._physics, self._plain_rows[0])
        self._systems: dict[float, System] = {}

    def system(self, dt: float) -> System:
        """Propagators and bounds of contact for one time step; computed once."""
        found = self._systems.get(dt)
        if found is None:
            found = tabulate(self._physics, self._plain_rows, self._contact, self._contact, dt)
            self._systems[dt] = found
        return found

    def _motion(self, start: Array) -> Array:
        return np.concatenate((start, np.zeros(EXTRA)))

    def _carry(
        self, motion: Array, record: Array, dt: float, free: int, settle: bool, side: float, log: Log, nodes: Array
    ) -> tuple[int, int, int]:
        system = self.system(dt)
        room = scratch(motion[:-EXTRA], self._n_rows, system.order)
        work = stages(motion, self._n_rows, log.work)
        return compiled_run(
            system, self._flow, self._impact, record, QUIET, dt, free, settle, side, log, room, work, nodes
        )


def _scale(model: NonlinearModel) -> Array:
    """Sizes of D, D', θ, θ' and z below which errors do not matter: what a ground acceleration of `TREMOR` does."""
    p = model.properties
    rotation = TREMOR / GRAVITY * p.m_tot * p.half_width / p.l0r
    fall = math.sqrt(p.l0r * GRAVITY / p.i_theta)
    return np.concatenate((TREMOR / p.omega**2, TREMOR / p.omega, [rotation, rotation * fall, TREMOR / GRAVITY]))
