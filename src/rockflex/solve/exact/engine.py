"""The exact engine's door: a model is prepared once, then once a time step, and records run through it."""

import math

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError, SolverError
from rockflex.models import Impact, LinearModel, impact_of
from rockflex.solve._solution import Solution
from rockflex.solve.exact.basis import contact_basis, rocking_basis
from rockflex.solve.exact.history import HEADER
from rockflex.solve.exact.layout import Array, Log, Physics, System, scratch
from rockflex.solve.exact.run import SETTLED, UNSETTLED, run
from rockflex.solve.exact.tables import propagate, tabulate
from rockflex.solve.exact.unit import BROKEN, CHATTER, GAINED, IMPACTS, OVERTURNED, UPLIFTS

__all__ = ["ExactEngine"]

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
        impact, self._failures = impact_of(model.law, model.properties)
        self._physics = _physics(model, impact)
        rotation = np.zeros(2 * model.properties.n_modes + 4)
        rotation[-4] = 1.0
        self._rows = np.stack((np.vstack((model.contact_moment(), contact_rows)), np.vstack((rotation, rocking_rows))))
        self._contact = contact_basis(self._physics, self._rows[0])
        # A base that cannot lift never rocks; its second phase only fills the place.
        self._rocking = self._contact
        if model.lifts:
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
        start = np.zeros(2 * self.model.properties.n_modes + 2) if state is None else state
        side = float(np.sign(start[-2]) or np.sign(start[-1]))
        settle = free_vibration is None
        free = math.ceil((self._patience() if free_vibration is None else free_vibration) / dt - 1e-9)
        record = np.require(acceleration, dtype=np.float64, requirements=("C", "W"))  # the type compiled for
        system = self.system(dt)
        rows = self._rows.shape[1]
        room_for = record.size + 64 + (0 if settle else free) if history else 0
        while True:
            log = Log(np.zeros(rows), np.zeros(rows), np.zeros(3, dtype=np.int64))
            nodes = np.empty((room_for, HEADER + start.size))
            room = scratch(start.copy(), rows, system.order)
            status, samples, count = run(system, record, QUIET, dt, free, settle, side, log, room, nodes)
            if not history or count <= room_for:
                break
            room_for = count
        if status == BROKEN and self._failures:
            failure = self._failures.pop()
            message = f"The impact law {self.model.law!r} failed: {failure}"
            raise InputError(message) from failure
        if status in (CHATTER, UNSETTLED, GAINED) or not np.all(np.isfinite(room.state)):
            raise SolverError(self._complaint(status, samples * dt, room.state))
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

    def _patience(self) -> float:
        """Longest free vibration that is waited for, s."""
        p = self.model.properties
        slowest = float(p.omega.min(initial=math.inf))
        return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))

    def _complaint(self, status: int, time: float, state: Array) -> str:
        values = ", ".join(f"{value:.6g}" for value in state)
        where = f"The state [D, D', θ, θ'] there is [{values}]."
        if status == UNSETTLED:
            return (
                f"The free vibration of {self.model.label} has not settled {time:.6g} s after the start. {where} "
                "Give free_vibration in seconds, or more damping."
            )
        if status == GAINED:
            return (
                f"The impact law {self.model.law!r} returns energy in the sample before {time:.6g} s. {where} "
                "A law can only lose energy: mend its `after`, or lower its restitution."
            )
        if status != CHATTER:
            return f"The motion of {self.model.label} is not finite at {time:.6g} s. {where} Check the parameters."
        return (
            f"The impacts of {self.model.label} accumulate without end in the sample before {time:.6g} s. {where} "
            "Check the model's parameters, and refine the record."
        )


def _physics(model: LinearModel, impact: Impact) -> Physics:
    p = model.properties
    return Physics(
        omega2=p.omega**2,
        damping=2.0 * p.zeta * p.omega,
        height=p.effective_height.copy(),  # writable, as the kernels are compiled for
        mass=p.effective_mass.copy(),
        inertia=model.free_inertia,
        gravity=p.l0r * GRAVITY,
        resistance=model.resistance,
        drive_arm=float(np.sum(p.effective_mass * p.effective_height)) - p.l0r,
        impact=impact,
    )
