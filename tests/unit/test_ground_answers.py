"""Bases that slide, hop and stand on springs against closed forms."""

import itertools

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from twins import ground_answers as answers

GRAVITY = 9.81


LANDS = rf.VVELSimplified()  # Housner's coefficient would be negative for the squat blocks here


def rigid(half_width, height, mass=1e5):
    """A homogeneous rectangular block, 2B wide and 2H high."""
    return rf.rigid_block(np.arctan2(half_width, height), np.hypot(half_width, height), mass)


def springs(structure, stiffness, damping, positions=None):
    b = structure.half_width
    at = (-b, b) if positions is None else positions
    inertia = structure.m_tot * b**2 / 3.0
    return rf.Ground(springs=rf.Springs(at, stiffness, damping), base_inertia=inertia)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("a", "seconds", "friction"), [(6.0, 0.5, 0.3), (3.0, 1.0, 0.05), (4.5, 0.2, 0.45)])
def test_newmarks_block(sign, a, seconds, friction):
    """The block is left behind by the pulse, and stops at A t_1/(μ g)."""
    motion = rf.GroundMotion(np.full(round(seconds / 0.01) + 1, sign * a), 0.01)
    block = rigid(3.0, 1.0)
    run = rf.simulate(block, motion, "rigid", impact=LANDS, ground=rf.Ground(friction=friction), free_vibration=8.0)
    expected = answers.newmark_slip(a, seconds, friction)
    assert run.max_slip == pytest.approx(expected, rel=1e-12)
    assert run.residual_slip == pytest.approx(-sign * expected, rel=1e-12)
    assert run.n_uplifts == 0
    still = run.time[np.flatnonzero(run.slip == run.residual_slip)[0]]
    assert still == pytest.approx(answers.newmark_duration(a, seconds, friction), abs=0.011)


def test_a_grip_that_is_enough_moves_nothing():
    motion = rf.GroundMotion(np.full(50, 2.9), 0.01)
    run = rf.simulate(
        rigid(3.0, 1.0), motion, "rigid", impact=LANDS, ground=rf.Ground(friction=0.3), free_vibration=1.0
    )
    assert (run.max_slip, run.residual_slip, run.status) == (0.0, 0.0, "no_uplift")


def test_a_frame_that_sticks_stands_as_on_rigid_ground():
    motion = rf.load_suite("el-centro-1940")[0]
    free = rf.simulate(make_frame(), motion, "2DOF-S")
    held = rf.simulate(make_frame(), motion, "2DOF-S", ground=rf.Ground(friction=5.0))
    assert held.max_slip == 0.0
    assert held.max_rotation == pytest.approx(free.max_rotation, rel=1e-9)
    assert held.n_uplifts == free.n_uplifts


@pytest.mark.parametrize("slenderness", [0.5, 1.0, 3.0])
def test_shentons_map(slenderness):
    """What a block does from rest at a constant acceleration is what the criteria say, on either side of each."""
    block, formula = rigid(1.0, slenderness), answers.homogeneous(1.0, slenderness)
    seen = set()
    for a, aside in itertools.product((1.0, 4.0, 12.0, 40.0), (0.99, 1.01)):
        limits = [a / GRAVITY, 1.0 / slenderness]
        if a > formula.rocks_above():
            limits.append(answers.shenton_friction(a / GRAVITY, slenderness))
        for limit in limits:
            friction = aside * limit
            motion = rf.GroundMotion(np.full(3, -a), 1e-4)
            run = rf.simulate(block, motion, "rigid", impact=LANDS, ground=rf.Ground(friction=friction), output="peaks")
            what = {(0, 0): "rest", (0, 1): "slide", (1, 0): "rock", (1, 1): "slide-rock"}[
                run.n_uplifts, int(run.max_slip > 0.0)
            ]
            assert what == formula.begins(friction, a), (a, friction)
            seen.add(what)
            if what == "slide-rock":
                turn, slide = formula.slide_rock(friction, a)
                assert run.max_rotation == pytest.approx(0.5 * turn * 4e-8, rel=1e-6)
                assert run.max_slip == pytest.approx(0.5 * slide * 4e-8, rel=1e-6)
            if what == "rock":
                assert run.max_rotation == pytest.approx(0.5 * formula.rock(a) * 4e-8, rel=1e-6)
    assert {"rest", "slide", "slide-rock"} <= seen


def test_a_base_stands_in_static_equilibrium():
    """Settled evenly, or tilted by an eccentric weight whose moment grows with the tilt."""
    frame = make_frame()
    p = frame.rocking()
    b, weight, k = p.half_width, p.m_tot * GRAVITY, 2e8
    e = 0.2 * b
    ground = rf.Ground(springs=rf.Springs([-b - e, b - e], k, 3e6), base_inertia=2e4)
    run = rf.simulate(rf.Eccentric(frame, e), rf.quiet_motion(2.0), "2DOF-S", ground=ground)
    x = np.array([-b - e, b - e])
    matrix = [[2.0 * k, -k * x.sum()], [-k * x.sum(), k * x @ x - p.l0r * GRAVITY]]
    _, tilt = np.linalg.solve(matrix, [-weight, 0.0])
    np.testing.assert_allclose(run.rotation, tilt, rtol=1e-9)
    assert run.max_edge_uplift == 0.0
    even = rf.simulate(frame, rf.quiet_motion(2.0), "2DOF-S", ground=springs(p, k, 3e6))
    assert even.max_rotation == pytest.approx(0.0, abs=1e-15)


def pushed(block, ground, a):
    """Rotation at which a base comes to rest under a constant acceleration that grows slowly from zero."""
    ramp = np.concatenate((np.linspace(0.0, a, 201), np.full(1800, a)))
    return rf.simulate(block, rf.GroundMotion(ramp, 0.01), "rigid", ground=ground).rotation[-1]


def test_static_rotation_on_two_springs():
    """With both springs loaded the moment is 2 k b² θ: 2 k b² θ = L (g θ + |a|)."""
    block, k = rigid(1.0, 3.0), 2e8
    theta = -pushed(block, springs(block, k, 2e7), 2.0)
    moment, _ = answers.two_springs(theta, block.m_tot * GRAVITY, k, 1.0)
    assert moment == pytest.approx(block.l0r * (2.0 + GRAVITY * theta), rel=1e-8)


@pytest.mark.parametrize("a", [0.9, 1.5, 2.0])
def test_static_rotation_on_a_bed(a):
    """Many springs carry like a continuous bed; from W B/3 on a part of it is free."""
    block, n, modulus = rigid(1.0, 3.0), 60, 1e8
    at = (np.arange(n) + 0.5) * 2.0 / n - 1.0
    ground = springs(block, modulus * 2.0 / n, 4e7 / n, at)
    theta = -pushed(block, ground, a)
    moment, _ = answers.bed(theta, block.m_tot * GRAVITY, modulus, 1.0)
    assert moment == pytest.approx(block.l0r * (a + GRAVITY * theta), rel=1e-3)
    assert (theta > block.m_tot * GRAVITY / (2.0 * modulus)) == (a > 1.0)


def test_a_base_that_is_thrown_up_flies_on_a_parabola():
    """From rest on its springs under an upward excess A - g, until the springs are empty, and on without shaking."""
    block, k, above = rigid(1.5, 1.0), 2e7, 14.0
    w = np.sqrt(2.0 * k / block.m_tot)
    excess = above - GRAVITY
    end = 0.5
    motion = rf.GroundMotion(np.zeros(51), 0.01, vertical=np.full(51, -above))
    run = rf.simulate(block, motion, "rigid", ground=springs(block, k, 0.0), free_vibration=1.0)
    leaves = np.arccos(excess / above) / w
    speed = above / w * np.sin(w * leaves)
    left = end - leaves
    height, rate = speed * left + 0.5 * excess * left**2, speed + excess * left
    assert run.max_edge_uplift == pytest.approx(height + answers.flight(rate)[1], rel=1e-10)
    assert run.max_rotation == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("zeta", [0.05, 0.2, 0.4])
def test_a_base_that_is_let_go_hops(zeta):
    """Pressed down by a long upward acceleration that ends at once; dashpots do not hold it back at the end."""
    block, k, above = rigid(1.5, 1.0), 2e7, 40.0
    w = np.sqrt(2.0 * k / block.m_tot)
    motion = rf.GroundMotion(np.zeros(2001), 0.02, vertical=np.full(2001, above))
    ground = springs(block, k, zeta * w * block.m_tot)
    run = rf.simulate(block, motion, "rigid", ground=ground, free_vibration=2.0)
    off = answers.bounce(0.0, w, zeta, pressed=(GRAVITY + above) / w**2)
    assert run.max_edge_uplift == pytest.approx(answers.flight(off.speed)[1] - off.depth, rel=1e-9)


@pytest.mark.parametrize("a", [0.0, 4.0])
def test_a_block_too_low_to_rock_knows_only_its_grip(a):
    """Constant vertical acceleration changes the grip as another gravity does."""
    motion = rf.GroundMotion(np.full(51, 6.0), 0.01, vertical=np.full(51, a))
    run = rf.simulate(rigid(3.0, 1.0), motion, "rigid", impact=LANDS, ground=rf.Ground(friction=0.2), output="peaks")
    expected = 0.5 * (6.0 - 0.2 * (GRAVITY + a)) * 0.25
    assert run.residual_slip == pytest.approx(-expected, rel=1e-12)


def on_springs(wall, ground, record, product):
    """Largest |θ| by a Runge-Kutta of fourth order, with `product` times the moment L_0^r z'' θ of the heave."""
    p, bed = wall.rocking(), ground.springs
    x, k, c, w = bed.positions, bed.stiffness, bed.damping, float(p.omega[0])
    h, inertia = float(p.effective_height[0]), p.translational_inertia + ground.base_inertia
    square = np.array([[inertia, float(p.effective_mass[0]) * h], [h, 1.0]])
    inverse, sub = np.linalg.inv(square), 32

    def rates(y, a, rise):
        theta, z, d, spin, heaving, bending = y
        place, speed = z - x * theta, heaving - x * spin
        force = np.where(place < 0.0, np.maximum(-k * place - c * speed, 0.0), 0.0)
        lifts = force.sum() / p.m_tot - 9.81 - rise
        moment = p.l0r * ((9.81 + rise + product * lifts) * theta - a) - force @ x
        turn, bend = inverse @ (moment, -a - 2.0 * float(p.zeta[0]) * w * bending - w * w * d)
        return np.array([spin, heaving, bending, turn, lifts, bend])

    y, largest, step = np.zeros(6), 0.0, record.dt / sub
    y[1] = -p.m_tot * 9.81 / bed.total_stiffness
    grid = np.arange(2 * sub * (record.acceleration.size - 1) + 1) * (0.5 * step)
    a, rise = (np.interp(grid, record.time, each) for each in (record.acceleration, record.vertical))
    for i in range(0, grid.size - 1, 2):
        one = rates(y, a[i], rise[i])
        two = rates(y + 0.5 * step * one, a[i + 1], rise[i + 1])
        three = rates(y + 0.5 * step * two, a[i + 1], rise[i + 1])
        four = rates(y + step * three, a[i + 2], rise[i + 2])
        y = y + step / 6.0 * (one + 2.0 * (two + three) + four)
        largest = max(largest, abs(y[0]))
    return largest


@pytest.mark.slow
def test_the_moment_of_the_heave_is_left_out_and_small():
    """The weight's moment is L_0^r (g + a_v) θ; L_0^r z'' θ, of the same order, changes θ_max by less than 1 %."""
    wall = rf.WallFrame(
        height=15.0, mass=250e3, stiffness_parameter=0.0, base_mass=60e3, period=0.5, aspect_ratio=5.0,
        damping_ratio=0.05, n_modes=1,
    )  # fmt: skip
    p = wall.rocking()
    bed = rf.winkler_bed(p.half_width, 4.0, 80e6, n=4).damped(0.3, p.m_tot)
    ground = rf.Ground(springs=bed, base_inertia=60e3 * (2.0 * p.half_width) ** 2 / 12.0)
    one, other = (each.acceleration[200:600] for each in list(rf.load_suite("fema-p695-far-field"))[:2])
    record = rf.GroundMotion(1.5 * one, 0.01, vertical=other)
    run = rf.simulate(wall, record, "2DOF-S", "peaks", ground=ground)
    assert run.n_uplifts > 2
    left_out, whole = (on_springs(wall, ground, record, product) for product in (0.0, 1.0))
    assert run.max_rotation == pytest.approx(left_out, rel=2e-4)
    assert abs(whole / left_out - 1.0) < 0.01
    assert abs(run.max_rotation - whole) > 3.0 * abs(run.max_rotation - left_out)
