"""Vertical acceleration, which acts on the states and on the conditions: against other integrations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.test_systems import uncompiled
from rockflex.engine import Batch, Event, LinearPhase, Run, StateLayout, System

OMEGA, GAP, H = 7.0, 0.05, 0.02


@pytest.fixture(scope="module", params=["compiled", "Python"])
def engine(request):
    return (Run, Batch) if request.param == "compiled" else (lambda m: (m.Run, m.Batch))(uncompiled())


def shaking(seed: int, size: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """An acceleration and a vertical one."""
    rng = np.random.default_rng(seed)
    first, second = (np.convolve(rng.normal(size=size), np.ones(10) / 3.0, "same") for _ in range(2))
    return 3.0 * first, 3.0 * second


def oscillator(*, omega: float = OMEGA, stiffer: float = 2.0) -> System:
    """y'' = -(k + a_v) y - 0.2 y' - a + 0.3 a_v; k is larger beyond a place that depends on a_v."""
    layout = StateLayout(place=1, speed=1)

    def phase(key: int) -> LinearPhase:
        A_v, C_v, side = np.zeros((2, 2)), np.zeros((2, 2)), 1.0 - 2.0 * key
        A_v[1, 0], C_v[1, 0] = -1.0, -1.0
        row, row_v = np.array([-side, 0.0]), np.array([0.02 * side, 0.0])
        event = Event("crosses", row, 1 - key, GAP * side, row_v=row_v, direct_v=0.01 * side)
        A = np.array([[0.0, 1.0], [-(omega**2) * stiffer**key, -0.2]])
        return LinearPhase(
            A,
            np.array([0.0, -1.0]),
            np.zeros(2),
            np.stack((layout.unit("place"), A[1])),
            np.array([0.0, -1.0]),
            np.zeros(2),
            (event,),
            A_v=A_v,
            f_v=np.array([0.0, 0.3]),
            C_v=C_v,
            d_v=np.array([0.0, 0.3]),
        )

    return System(layout, ("place", "acceleration"), phase, 0)


def integrated(a, v, h, omega=OMEGA, stiffer=2.0):
    """The same by DOP853: times of events, the last state, and peaks at forty places of a sample."""
    y, times, peaks, key = np.zeros(2), [], np.zeros(2), 0
    for i in range(a.size - 1):

        def at(t, i=i):
            u = t / h - i
            return a[i] + (a[i + 1] - a[i]) * u, v[i] + (v[i + 1] - v[i]) * u

        t = i * h
        while t < (i + 1) * h:

            def rates(t, y, at=at, key=key):
                ground, rise = at(t)
                return [y[1], -(omega**2 * stiffer**key + rise) * y[0] - 0.2 * y[1] - ground + 0.3 * rise]

            def crosses(t, y, at=at, side=1 - 2 * key):
                return side * (GAP - y[0] + at(t)[1] * (0.01 + 0.02 * y[0]))

            crosses.terminal, crosses.direction = True, -1
            found = solve_ivp(
                rates, (t, (i + 1) * h), y, "DOP853", rtol=1e-13, atol=1e-16, events=crosses, dense_output=True
            )
            fine = np.linspace(t, found.t[-1], 40)
            states = found.sol(fine).T
            fast = [rates(*each)[1] for each in zip(fine, states, strict=True)]
            peaks = np.maximum(peaks, (np.abs(states[:, 0]).max(), np.abs(fast).max()))
            t, y = found.t[-1], found.y[:, -1]
            if found.status == 1:
                times.append(t)
                key = 1 - key
    return np.array(times), y, peaks


@pytest.mark.parametrize("seed", range(3))
def test_a_parametric_oscillator_with_two_stiffnesses(engine, seed):
    a, v = shaking(seed)
    run = engine[0](oscillator(), H)
    run.advance(a, v)
    times, y, peaks = integrated(a, v, H)
    assert len(times) > 3
    np.testing.assert_allclose([t for t, _, _ in run.events], times, rtol=1e-9)
    np.testing.assert_allclose(run.state, y, atol=1e-10)
    assert run.peaks["place"][0] == pytest.approx(peaks[0], rel=1e-5)
    assert run.peaks["acceleration"][0] == pytest.approx(peaks[1], rel=1e-4)
