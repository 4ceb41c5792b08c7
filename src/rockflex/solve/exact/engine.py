"""The exact engine's door: a model is prepared once, then once a time step, and records run through it."""

import math

import numpy as np

from rockflex._errors import SolverError
from rockflex.models import LinearModel
from rockflex.solve._solution import Solution
from rockflex.solve.exact.basis import contact_basis, rocking_basis
from rockflex.solve.exact.history import HEADER
from rockflex.solve.exact.layout import Array, Log, Physics, System, scratch
from rockflex.solve.exact.run import SETTLED, UNSETTLED, run
from rockflex.solve.exact.tables import tabulate
from rockflex.solve.exact.unit import CHATTER, IMPACTS, OVERTURNED, UPLIFTS

__all__ = ["ExactEngine"]

NO_NODES = np.empty((0, 0))
QUIET = np.zeros(65)  # free vibration is run in stretches of 64 samples


class ExactEngine:
    """A piecewise linear model, uncoupled, with its propagators for every time step met so far.

    Parameters
    ----------
    model
        The model's parameters.
    contact_rows, rocking_rows
        Responses whose peaks are wanted, as functionals over [D.., D'.., θ, θ', a, s] in each phase, (F, 2N + 4).
    """

    def __init__(self, model: LinearModel, contact_rows: Array, rocking_rows: Array) -> None:
        self.model = model
        self._physics = _physics(model)
        rotation = np.zeros(2 * model.omega.size + 4)
        rotation[-4] = 1.0
        self._rows = np.stack(
            (np.vstack((model.contact_moment(), contact_rows)), np.vstack((rotation, rocking_rows)))
        )
        self._contact = contact_basis(self._physics, self._rows[0])
        self._rocking = rocking_basis(self._physics, self._rows[1])
        self._systems: dict[float, System] = {}

    def system(self, dt: float) -> System:
        """Propagators and bounds for one time step; computed once."""
        found = self._systems.get(dt)
        if found is None:
            found = tabulate(self._physics, self._rows, self._contact, self._rocking, dt)
            self._systems[dt] = found
        return found

    def run(
        self,
        acceleration: Array,
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Array | None = None,
        history: bool = False,
    ) -> Solution:
        """Run one record, then `free_vibration` seconds (None: until settled), from a state [D.., D'.., θ, θ'].

        Raises
        ------
        SolverError
            If impacts accumulate without end, or the motion does not settle.
        """
        n = self.model.omega.size
        now = np.zeros(2 * n + 2) if state is None else state.copy()
        side = float(np.sign(now[-2]) or np.sign(now[-1]))
        settle = free_vibration is None
        free = math.ceil((self._patience() if free_vibration is None else free_vibration) / dt - 1e-9)
        rows = self._rows.shape[1]
        system = self.system(dt)
        log = Log(np.zeros(rows), np.zeros(rows), np.zeros(3, dtype=np.int64))
        nodes = np.empty((acceleration.size + 64, HEADER + now.size)) if history else NO_NODES
        room = scratch(now, rows, system.order)
        status, samples, count = run(system, acceleration, QUIET, dt, free, settle, side, log, room, nodes)
        if status in (CHATTER, UNSETTLED):
            raise SolverError(self._complaint(status, samples * dt, now))
        end = samples * dt if status != OVERTURNED else float(log.times[0])
        return Solution(
            overturned=status == OVERTURNED,
            settled=status == SETTLED,
            end_time=end,
            peaks=log.peaks,
            peak_times=log.times,
            n_uplifts=int(log.tally[UPLIFTS]),
            n_impacts=int(log.tally[IMPACTS]),
            nodes=nodes[:count] if history else None,
        )

    def _patience(self) -> float:
        """Longest free vibration that is waited for, s."""
        model = self.model
        slowest = 2.0 * math.pi / float(model.omega.min())
        return 2000.0 * slowest + 200.0 * math.sqrt(model.i_theta / model.gravity_stiffness)

    def _complaint(self, status: int, time: float, state: Array) -> str:
        values = ", ".join(f"{value:.6g}" for value in state)
        where = f"The state [D, D', θ, θ'] there is [{values}]."
        if status == UNSETTLED:
            return (
                f"The free vibration of {self.model.label} has not settled {time:.6g} s after the start. {where} "
                "Give free_vibration in seconds, or more damping."
            )
        return (
            f"The impacts of {self.model.label} accumulate without end in the sample before {time:.6g} s. {where} "
            "Check the model's parameters, and refine the record."
        )


def _physics(model: LinearModel) -> Physics:
    return Physics(
        omega2=model.omega**2,
        damping=2.0 * model.zeta * model.omega,
        height=np.ascontiguousarray(model.height),
        mass=np.ascontiguousarray(model.mass),
        inertia=model.free_inertia,
        gravity=model.gravity_stiffness,
        resistance=model.resisting_moment,
        drive_arm=float(np.sum(model.mass * model.height)) - model.first_moment,
    )
