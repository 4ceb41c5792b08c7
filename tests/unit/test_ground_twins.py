"""The twins of the ground against closed forms and an integration that knows no phases."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from builders import make_frame
from twins import ground_answers as answers
from twins.ground_sliding import SLIDE, SlidingTwin, impacts
from twins.ground_springs import HEAVE, LOADED, SLIP, TURN, SpringTwin
from twins.ground_springs import SLIDE as SPRUNG_SLIDE

GRAVITY = 9.81
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


@pytest.mark.parametrize("gravity", [9.81, 12.5])
@pytest.mark.parametrize("kind", ["springs", "sliding"])
def test_constant_vertical_acceleration_is_another_gravity(kind, gravity):
    p = make_frame().rocking(2)
    a = 4.0 * np.sin(0.06 * np.arange(400))
    up = np.full(a.size, gravity - GRAVITY)
    if kind == "sliding":
        one = SlidingTwin.of(p, 0.2).run(a, 0.01, up)
        two = SlidingTwin.of(p, 0.2, gravity=gravity).run(a, 0.01)
    else:
        made = [SpringTwin.of(p, (-1.0, 1.0), 2e8, 3e6, 2e4, gravity=each) for each in (GRAVITY, gravity)]
        one, two = made[0].run(a, 0.01, up, start=made[1].standing()), made[1].run(a, 0.01)
    np.testing.assert_allclose(one.peaks, two.peaks, rtol=1e-9)
    assert [(key, after) for _, key, _, after in one.events] == [(key, after) for _, key, _, after in two.events]


def test_newmarks_block():
    twin = SlidingTwin(*[NONE] * 5, i_theta=4e5, l0r=1e5, m_tot=1e5, half_width=1.5, friction=0.3)
    run = twin.run(np.full(51, 6.0), 0.01, free=2.0)
    assert run.y[1] == pytest.approx(-answers.newmark_slip(6.0, 0.5, 0.3), rel=1e-12)
    stop = run.events[-1]
    assert stop[0] == pytest.approx(answers.newmark_duration(6.0, 0.5, 0.3), rel=1e-12)
    assert stop[2:] == ("stop", (0, 0, True))
    assert answers.newmark_slip(2.9, 0.5, 0.3) == 0.0


def test_shentons_map():
    """From rest at a constant acceleration: what a run does in its first instants is what the criteria say."""
    seen = set()
    for slenderness, friction, a in itertools.product((0.5, 1.0, 3.0), (0.2, 0.6, 1.1, 2.5), (1.0, 4.0, 12.0, 40.0)):
        b, h = 1.0, slenderness
        block = answers.homogeneous(b, h)
        inertia = 1e3 * block.about_edge
        twin = SlidingTwin(*[NONE] * 5, inertia, 1e3 * h, 1e3, b, friction)
        run = twin.run(np.full(3, -a), 1e-4)
        side, slip, _ = run.key
        what = {(0, 0): "rest", (0, 1): "slide", (1, 0): "rock", (1, 1): "slide-rock"}[side, slip]
        assert what == block.begins(friction, a), (slenderness, friction, a)
        seen.add(what)
        turn, speed = run.y[2] / 2e-4, run.y[3] / 2e-4
        if what == "slide-rock":
            assert (turn, speed) == pytest.approx(block.slide_rock(friction, a), rel=1e-4)
        if what == "rock":
            assert turn == pytest.approx(block.rock(a), rel=1e-4)
        if a > block.rocks_above():
            boundary = answers.shenton_friction(a / GRAVITY, slenderness)
            assert block.friction_to_rock(a) == pytest.approx(boundary, rel=1e-12)
    assert len(seen) == 4
    corner = answers.homogeneous(1.0, 3.0)
    assert corner.friction_to_rock(corner.rocks_above()) == pytest.approx(1.0 / 3.0)


def dropped(stiffness, damping, height, speed=0.0):
    """A rigid base above its two springs, and the state that it begins with."""
    twin = SpringTwin(*[NONE] * 5, 4e5, 1e5, 1e5, (-1.0, 1.0), stiffness, damping, (1.0, -1.0))
    y = np.zeros(6)
    y[HEAVE], y[3 + HEAVE] = height, speed
    return twin, (("lifted", "lifted"), None), y


def test_ballistic_flight():
    """The heave of a base in flight is a parabola, and its rotation grows with √(L g/I_c) as long as it flies."""
    twin, key, y = dropped(1e8, 1e6, 0.2, 1.5)
    y[TURN] = 0.02
    run = twin.run(np.zeros(31), 0.01, start=(key, y))
    assert not run.events
    rate = np.sqrt(1e5 * GRAVITY / 4e5)
    assert run.y[HEAVE] == pytest.approx(0.2 + 1.5 * 0.3 - 0.5 * GRAVITY * 0.09, rel=1e-12)
    assert run.y[TURN] == pytest.approx(0.02 * np.cosh(0.3 * rate), rel=1e-12)
    _, height = answers.flight(1.5)
    assert max(run.highs[5:7]) == pytest.approx(0.2 + height, rel=0.15)


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.3, 0.6, 0.9])
def test_bouncing_mass(zeta):
    frequency, speed = 90.0, 3.0
    k = 0.5 * 1e5 * frequency**2
    c = 0.5 * 2.0 * zeta * 1e5 * frequency
    twin, key, y = dropped(k, c, 0.0, -speed)
    run = twin.run(np.zeros(251), 0.002, start=(key, y))
    expected = answers.bounce(speed, frequency, zeta)
    pushed = [(t, name) for t, _, name, _ in run.events if name[0] in ("land", "empty")]
    assert [name[0] for _, name in pushed[:4]] == ["land", "land", "empty", "empty"]
    assert pushed[2][0] == pytest.approx(expected.duration, rel=1e-12)
    assert run.highs[7 + 5] == pytest.approx(expected.deepest, rel=1e-12)
    hop = expected.speed**2 / (2.0 * GRAVITY) - expected.depth
    assert run.highs[5] == pytest.approx(hop, rel=1e-10)
    weightless = answers.bounce(speed, frequency, zeta, gravity=0.0)
    assert weightless.speed / speed == pytest.approx(answers.restitution(zeta), rel=1e-12)


def test_restitution_of_a_spring_dashpot():
    assert answers.restitution(0.0) == 1.0
    for middle in (1.0, np.sqrt(0.5)):
        around = [answers.restitution(middle * (1.0 + d)) for d in (-1e-7, 0.0, 1e-7)]
        assert around[1] == pytest.approx(0.5 * (around[0] + around[2]), rel=1e-9)
    with pytest.raises(ValueError, match="stays on the spring"):
        answers.bounce(0.01, 20.0, 0.5)
    with pytest.raises(ValueError, match="damping ratio"):
        answers.bounce(1.0, 20.0, 1.0)


def pushed_over(twin, theta):
    """Moment and heave of a base held at a rotation, from its springs' forces in vertical equilibrium."""
    low, high = -1.0, 1.0
    for _ in range(200):
        heave = 0.5 * (low + high)
        forces = np.maximum(0.0, -twin.stiffness * (heave - twin.positions * theta))
        low, high = (heave, high) if forces.sum() > twin.m_tot * GRAVITY else (low, heave)
    return twin.positions @ forces, heave


@pytest.mark.parametrize("theta", [1e-4, 5e-4, 2e-3, 2e-2])
def test_static_moment_of_springs(theta):
    twin = SpringTwin(*[NONE] * 5, 4e5, 1e5, 1e5, (-1.2, 1.2), 4e8, 0.0, (1.2, -1.2))
    assert pushed_over(twin, theta) == pytest.approx(answers.two_springs(theta, 1e5 * GRAVITY, 4e8, 1.2), rel=1e-9)
    n, half = 4000, 1.2
    x = half * ((np.arange(n) + 0.5) * 2.0 / n - 1.0)
    modulus = 3e8
    many = SpringTwin(*[NONE] * 5, 4e5, 1e5, 1e5, x, modulus * 2.0 * half / n, 0.0, (half, -half))
    expected = answers.bed(theta, 1e5 * GRAVITY, modulus, half)
    assert pushed_over(many, theta) == pytest.approx(expected, rel=1e-6)


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


def test_friction_of_single_springs_differs():
    """With friction at one spring alone the grip is its share of the weight."""
    a = np.full(201, 3.0)
    twin = SpringTwin(*[NONE] * 5, 2e5, 0.0, 1e5, (-1.0, 1.0), 1e8, 1e7, (1.0, -1.0), (0.0, 0.4))
    run = twin.run(a, 0.01)
    assert run.y[3 + SLIP] == pytest.approx(-(3.0 - 0.2 * GRAVITY) * 2.0, rel=1e-9)


def test_impacts_with_a_restitution_are_those_of_housner():
    """A rigid block let go from a rotation comes down again and again, each time at e θ'."""
    b, h = 0.8, 4.0
    block = answers.homogeneous(b, h)
    e = 1.0 - 2.0 * b**2 / block.about_edge
    twin = SlidingTwin(*[NONE] * 5, 1e3 * block.about_edge, 1e3 * h, 1e3, b, 5.0, restitution=e)
    y = np.array([0.3 * b / h, 0.0, 0.0, 0.0])
    run = twin.run(np.zeros(801), 0.01, start=((1, 0, True), y))
    times = impacts(run)
    rate, share = np.sqrt(h * GRAVITY / block.about_edge), 0.3
    clock = np.arccosh(1.0 / (1.0 - share)) / rate
    for k in range(4):
        assert times[k] == pytest.approx(clock, rel=1e-9)
        share = 1.0 - np.sqrt(1.0 - e**2 * (1.0 - (1.0 - share) ** 2))
        clock += 2.0 * np.arccosh(1.0 / (1.0 - share)) / rate
