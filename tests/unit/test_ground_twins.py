"""The twins of the ground against an integration that knows no phases, and in limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from builders import make_frame
from twins import ground_answers as answers
from twins.ground_sliding import SLIDE, SlidingTwin
from twins.ground_springs import HEAVE, LOADED, SLIP, TURN, SpringTwin
from twins.ground_springs import SLIDE as SPRUNG_SLIDE

NONE = np.zeros(0)
FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)


def plain_springs(twin, a, a_v, end, creep=None):
    """State at `end` by an integration that knows no phases: the forces of the springs as they are stated.

    Friction is rounded off within the speed `creep`.
    """
    q = twin.q

    def rate(t, y):
        p, v = y[:q], y[q:]
        z, down = p[HEAVE] - twin.positions * p[TURN], v[HEAVE] - twin.positions * v[TURN]
        push = np.where(z < 0.0, np.maximum(0.0, -twin.stiffness * z - twin.damping * down), 0.0)
        weight = twin.gravity + a_v(t)
        force = np.zeros(q)
        force[TURN] = twin.l0r * (weight * p[TURN] - a(t)) - twin.positions @ push
        force[HEAVE] = push.sum() - twin.m_tot * weight
        force[3:] = -twin.mass * (twin.omega**2 * p[3:] + 2.0 * twin.zeta * twin.omega * v[3:] + a(t))
        free = np.full(q, True)
        if creep is None:
            free[SLIP] = False
        else:
            force[SLIP] = -twin.m_tot * a(t) - twin.friction @ push * np.clip(v[SLIP] / creep, -1.0, 1.0)
        accelerations = np.zeros(q)
        accelerations[free] = np.linalg.solve(twin.mass_matrix[np.ix_(free, free)], force[free])
        return np.concatenate((v, accelerations))

    y = twin.standing()[1]
    return solve_ivp(rate, (0.0, end), y, method="LSODA", rtol=1e-9, atol=1e-12, max_step=2e-3).y[:, -1]


def test_springs_against_an_integration_without_phases():
    p, dt = FRAME.rocking(1), 0.01
    twin = SpringTwin.of(p, (-1.1, 0.2, 1.1), 2e8, (0.0, 1e6, 3e6), 6e4)
    t = dt * np.arange(151)
    one, two = 6.0 * np.sin(7.0 * t), 9.0 * np.cos(11.0 * t)
    run = twin.run(one, dt, two)
    assert {sum(each == LOADED for each in key[0]) for _, key, *_ in run.events} == {0, 1, 2, 3}
    plain = plain_springs(twin, lambda s: np.interp(s, t, one), lambda s: np.interp(s, t, two), t[-1])
    np.testing.assert_allclose(run.y, plain, atol=2e-6 * abs(plain).max())


@pytest.mark.slow
def test_springs_that_slide_against_an_integration_without_phases():
    p, dt = FRAME.rocking(1), 0.01
    twin = SpringTwin.of(p, (-1.1, 1.1), 3e8, 2e6, 6e4, friction=(0.15, 0.25))
    t = dt * np.arange(151)
    one, two = 7.0 * np.sin(7.0 * t), 12.0 * np.cos(9.0 * t)
    run = twin.run(one, dt, two)
    assert {key[1] for _, key, *_ in run.events} == {-1, 0, 1}
    assert 0 in {sum(each == LOADED for each in key[0]) for _, key, *_ in run.events}
    plain = plain_springs(twin, lambda s: np.interp(s, t, one), lambda s: np.interp(s, t, two), t[-1], 1e-5)
    np.testing.assert_allclose(run.y, plain, atol=1e-4 * abs(plain).max())


def test_restitution_of_a_spring_dashpot():
    assert answers.restitution(0.0) == 1.0
    for middle in (1.0, np.sqrt(0.5)):
        around = [answers.restitution(middle * (1.0 + d)) for d in (-1e-7, 0.0, 1e-7)]
        assert around[1] == pytest.approx(0.5 * (around[0] + around[2]), rel=1e-9)
    with pytest.raises(ValueError, match="stays on the spring"):
        answers.bounce(0.01, 20.0, 0.5)
    with pytest.raises(ValueError, match="damping ratio"):
        answers.bounce(1.0, 20.0, 1.0)


@pytest.mark.parametrize("positions", [(-1.0, 1.0), (-0.6, 1.3), (-1.4, -0.8, 0.0, 0.9)])
def test_standing_is_an_equilibrium(positions):
    twin = SpringTwin(*[NONE] * 5, 4e5, 1e5, 1e5, positions, 1e8, 2e6, (1.0, -1.0))
    key, y = twin.standing()
    run = twin.run(np.zeros(101), 0.01)
    np.testing.assert_allclose(run.y, y, atol=1e-13)
    assert run.key == key


def test_friction_at_springs_is_friction_on_rigid_ground_if_they_are_stiff():
    """A block too low to rock slides on springs as it does on rigid ground, but for what its tilt does."""
    a = 5.0 * np.sin(0.07 * np.arange(300))
    rigid = SlidingTwin(*[NONE] * 5, 4e5, 1e4, 1e5, 1.5, 0.3).run(a, 0.01)
    on = SpringTwin(*[NONE] * 5, 2e5, 1e4, 1e5, (-1.5, 1.5), 1e10, 1e7, (1.5, -1.5), 0.3)
    run = on.run(a, 0.01)
    assert run.peaks[SPRUNG_SLIDE] == pytest.approx(rigid.peaks[SLIDE], rel=1e-4)
    parts = on.energies(run, on.stored(on.standing()[1]))
    assert abs(parts["error"]) < 1e-9 * parts["friction"]
    assert parts["friction"] > 0.0
