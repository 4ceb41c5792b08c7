"""Simplified models as hybrid systems: their phases, events and outputs for `rockflex.engine`."""

from collections.abc import Callable

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import SolverError
from rockflex._shown import shown
from rockflex.engine import Event, LinearPhase, StateLayout, System
from rockflex.models._elements import CLOSED, LEFT, RIGHT
from rockflex.models._impact import Restitution, SidedRestitution, VVELSimplified
from rockflex.models._linear import LinearModel
from rockflex.models._phase import LANDS, LIFTS, OVERTURNS, Exit, Key
from rockflex.models._quantities import Quantities, lost_support_row, rows_of
from rockflex.models._strike import WITHOUT, OwnLaw

NAMES = {LIFTS: "uplift", LANDS: "impact", OVERTURNS: "overturning"}
GAIN = 1e-9  # relative gain of energy in an impact that is attributed to rounding


def system_of(model: LinearModel, quantities: Quantities, extremes: Quantities | None = None) -> System:
    """Return a model without elements, on rigid ground that does not move vertically, as a hybrid system.

    Its outputs are the rotation, the quantities, the extremes, of which the largest value counts, and the loss of
    support. The equations are those of Silva & Stojadinović 2024, Eqs. 15 and 23 to 25.
    """
    n, core = model.properties.n_modes, model.layout.core
    layout = StateLayout(displacement=n, velocity=n, rotation=1, spin=1)
    most = Quantities.none(n) if extremes is None else extremes
    largest = [*(f"extreme {k}" for k in range(len(most))), "loss of support"]
    turn = np.zeros((1, model.layout.columns))
    turn[0, model.layout.rotation] = 1.0

    def phase(key: Key) -> LinearPhase:
        parts = turn, rows_of(model, quantities, key), rows_of(model, most, key), lost_support_row(model, key)[None]
        rows = np.vstack(parts)
        rates = np.zeros((core, model.layout.columns))
        rates[np.arange(n), n + np.arange(n)] = 1.0
        accelerations = model.accelerations(key)
        rates[n : 2 * n] = accelerations[:n]
        if model.is_free(key):
            rates[2 * n, 2 * n + 1], rates[2 * n + 1] = 1.0, accelerations[n]
        A, C = rates[:, :core], rows[:, :core]
        return LinearPhase(A, rates[:, -2], rates[:, -1], C, rows[:, -2], rows[:, -1], _events(model, key))

    names = ("rotation", *(f"quantity {k}" for k in range(len(quantities))), *largest)
    return System(layout, names, phase, model.start(CLOSED), largest)


def _events(model: LinearModel, key: Key) -> tuple[Event, ...]:
    """The conditions at the two limits of the guard of a phase."""
    guard, core = model.phase(key).guard, model.layout.core
    found = list[Event]()
    for sign, limit, leads in ((1.0, guard.low, guard.below), (-1.0, guard.high, guard.above)):
        if leads is None:
            continue
        row = sign * guard.row
        found.append(
            Event(
                NAMES[leads.event],
                row[:core],
                None if leads.event == OVERTURNS else leads.key,
                constant=float(row[-1] - sign * limit),
                direct=float(row[-2]),
                scale=abs(limit) or 1.0,
                jump=_landing(model, leads) if leads.event == LANDS else None,
            )
        )
    return tuple(found)


def _landing(model: LinearModel, leads: Exit) -> Array | Callable[[Array, float], tuple[Array, Key]]:
    """The jump at an impact: a matrix for Eq. 25, for other laws a function."""
    n, height = model.properties.n_modes, model.properties.effective_height
    stick = np.diag([1.0] * (2 * n) + [0.0, 0.0])
    stick[n : 2 * n, 2 * n + 1] = height
    if isinstance(model.law, VVELSimplified):
        return stick
    own = OwnLaw(model.law, model.properties)
    (contact, right, left) = model.phase(leads.key).beside

    def land(state: Array, acceleration: float) -> tuple[Array, Key]:
        before = energy(state, model.free_inertia(RIGHT if state[-1] < 0.0 else LEFT))
        state[-2] = 0.0
        velocity, spin = own.after(state[n : 2 * n], float(state[-1]))
        after = np.concatenate((state[:n], velocity, (0.0, spin)))
        key = contact if spin == 0.0 else right if spin > 0.0 else left
        gained = energy(after, 0.0 if spin == 0.0 else model.free_inertia(key[0])) - before
        if spin != 0.0:
            law = model.law
            if isinstance(law, SidedRestitution):
                law = law.right if state[-1] < 0.0 else law.left
            shortest = law.shortest_excursion if isinstance(law, Restitution) else WITHOUT.shortest_excursion
            row = model.angular_acceleration(key)
            back = -key[0] * (row[: 2 * n + 2] @ after + row[-2] * acceleration + row[-1])
            if 2.0 * abs(spin) < back * shortest:
                after, key = stick @ after, contact
        if gained > GAIN * before:
            raise SolverError(
                f"The impact law {shown(model.law)} returns energy. A law can only lose energy: correct its `after`, "
                "or lower its restitution."
            )
        return after, key

    def energy(state: Array, inertia: float) -> float:
        velocity = state[n : 2 * n] + height * state[-1]
        return 0.5 * inertia * state[-1] ** 2 + 0.5 * float(model.properties.effective_mass @ velocity**2)

    return land
