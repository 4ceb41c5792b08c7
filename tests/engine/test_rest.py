"""Whether anything can still happen in a free vibration: what is said against the motion itself."""

import numpy as np
import pytest
from scipy.linalg import expm

from rockflex.engine import Event, LinearPhase
from rockflex.engine.rest import Decay

SOON = 1e-9


def phase_of(rng: np.random.Generator, *, swings: bool) -> LinearPhase:
    """Modes that fade, one that is held, two outputs and a condition near its limit."""
    blocks = np.zeros((5, 5))
    if swings:
        for k in (0, 2):
            omega, zeta = rng.uniform(2.0, 20.0), rng.uniform(0.02, 0.3)
            blocks[k : k + 2, k : k + 2] = [[-zeta * omega, omega], [-omega, -zeta * omega]]
    else:
        blocks[:4, :4] = np.diag(-rng.uniform(0.5, 20.0, 4))
    basis = np.linalg.qr(rng.normal(size=(5, 5)))[0] + 0.2 * rng.normal(size=(5, 5))
    A = basis @ blocks @ np.linalg.inv(basis)
    condition = Event("fails", rng.normal(size=5), None, constant=rng.uniform(0.0, 2.0))
    return LinearPhase(A, np.zeros(5), np.zeros(5), rng.normal(size=(2, 5)), np.zeros(2), np.zeros(2), (condition,))


def path_of(phase: LinearPhase, y: np.ndarray, long: float, count: int) -> np.ndarray:
    """States at equal steps: those that are known, and as many later ones, again and again."""
    step, states = expm(phase.A * long / count), y[None]
    while len(states) <= count:
        states, step = np.concatenate((states, states @ step.T)), step @ step
    return states[: count + 1]


@pytest.mark.slow
@pytest.mark.parametrize("swings", [True, False])
def test_rest_is_said_where_nothing_follows_and_only_there(swings):
    rng, one_sided, said = np.random.default_rng(5), np.array([0.0, 1.0]), {"rests": 0, "waits": 0, "unknown": 0}
    for _ in range(400):
        phase, y = phase_of(rng, swings=swings), rng.normal(size=5) * 10.0 ** rng.uniform(-2.0, 0.0)
        high = np.array([1.0, 1.0]) * 10.0 ** rng.uniform(-2.0, 1.0)
        decay = Decay(phase)
        states = path_of(phase, y, 20.0, 4000)
        event, counted = phase.events[0], states @ phase.C.T
        counted[:, 0] = np.abs(counted[:, 0])
        quiet = (states @ event.row + event.constant >= 0.0).all() and (counted <= high).all()
        wait = decay.time_to_rest(y, high, one_sided)
        if wait == 0.0:
            said["rests"] += 1
            assert quiet
        elif wait > SOON:  # until then it cannot be said
            said["waits"] += 1
            before = path_of(phase, y, 0.99 * wait, 50)
            assert all(decay.time_to_rest(each, high, one_sided) > 0.0 for each in before)
        else:
            said["unknown"] += 1
        ends = path_of(phase, y, 200.0, 1)[-1]  # all but the held mode has faded
        stays = event.row @ ends + event.constant
        if abs(stays) > 1e-6 and quiet:
            assert (decay.time_to_rest(ends, high, one_sided) == 0.0) == (stays > 0.0)
    assert said["rests"] > 40
    assert said["unknown"] > 40
    assert said["waits"] > 40 or not swings
