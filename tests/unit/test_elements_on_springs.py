"""Elements between the ground and a base on springs, against an integration in small steps, and their energies."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
B = FRAME.rocking().half_width
INERTIA = 60e3 * (2.0 * B) ** 2 / 12.0
GROUND = rf.Ground(springs=rf.Springs([-B, 0.2 * B, B], [3e8, 1e8, 3e8], 4e6), base_inertia=INERTIA)
PULSE = rf.one_sine_pulse(amplitude=4.0, period=1.1)


def held(*elements):
    return rf.Restrained(FRAME, elements)


def marched(structure, motion, ground, duration, step=2e-5):
    """The largest rotation, elongations and forces by a Runge-Kutta method in small steps, with return mapping."""
    p, springs = structure.rocking(1), ground.springs
    elements = p.elements
    h, m, omega, zeta = p.effective_height[0], p.effective_mass[0], p.omega[0], p.zeta[0]
    mass = np.array([[1.0, h, 0.0], [m * h, p.translational_inertia + ground.base_inertia, 0.0], [0.0, 0.0, p.m_tot]])
    inverse, g = np.linalg.inv(mass), 9.81
    places = np.array([each.position for each in elements])
    initial = np.array([getattr(each, "initial_force", 0.0) for each in elements])
    plastic = np.zeros(places.size)

    def force_of(each, elongation, rate, lost):
        if isinstance(each, rf.ViscousDamper):
            return each.coefficient * rate
        first = getattr(each, "initial_force", 0.0) / each.stiffness
        ratio = each.post_yield_ratio or 0.0
        if isinstance(each, rf.Tendon) and each.post_yield_ratio is None:
            return max(each.initial_force + each.stiffness * elongation, 0.0)
        total = each.stiffness * (elongation + first)
        spring = np.clip(total - each.stiffness * lost, -each.yield_force, each.yield_force)
        found = ratio * total + (1.0 - ratio) * spring
        slack = isinstance(each, rf.Tendon) or each.tension_only
        return max(found, 0.0) if slack else found

    def rates(y, a):
        (d, theta, z), (dd, spin, heaving) = y[:3], y[3:]
        depth, speed = z - springs.positions * theta, heaving - springs.positions * spin
        push = np.where(depth < 0.0, np.maximum(-springs.stiffness * depth - springs.damping * speed, 0.0), 0.0)
        moved, moving = (z - rest[2]) - places * (theta - rest[1]), heaving - places * spin
        pull = np.array([force_of(*each) for each in zip(elements, moved, moving, plastic, strict=True)])
        force = np.array(
            [
                -a - 2.0 * zeta * omega * dd - omega**2 * d,
                p.l0r * g * theta - p.l0r * a - springs.positions @ push + places @ pull,
                push.sum() - pull.sum() - p.m_tot * g,
            ]
        )
        return np.concatenate((y[3:], inverse @ force)), moved, pull

    # At rest the springs carry the weight and the initial tensions.
    levers = np.stack((-springs.positions, np.ones(springs.n)))
    stiffness = levers * springs.stiffness @ levers.T
    stiffness[0, 0] -= p.l0r * g
    rest = np.array([0.0, *np.linalg.solve(stiffness, [places @ initial, -p.m_tot * g - initial.sum()])])
    y = np.concatenate((rest, np.zeros(3)))
    peaks = np.zeros(1), np.zeros(places.size), np.zeros(places.size)
    for k in range(round(duration / step)):
        a = [np.interp((k + part) * step, motion.dt * np.arange(motion.acceleration.size), motion.acceleration, right=0)
             for part in (0.0, 0.5, 1.0)]  # fmt: skip
        one, _, _ = rates(y, a[0])
        two, _, _ = rates(y + 0.5 * step * one, a[1])
        three, _, _ = rates(y + 0.5 * step * two, a[1])
        four, _, _ = rates(y + step * three, a[2])
        y = y + step / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        _, moved, pull = rates(y, a[2])
        for e, each in enumerate(elements):
            limit = getattr(each, "yield_force", None)
            if limit is None or (isinstance(each, rf.Tendon) and each.post_yield_ratio is None):
                continue
            first = getattr(each, "initial_force", 0.0) / each.stiffness
            beyond = moved[e] + first - plastic[e]
            pulls_only = isinstance(each, rf.Tendon) or each.tension_only
            if beyond > limit / each.stiffness or (beyond < -limit / each.stiffness and not pulls_only):
                plastic[e] += beyond - np.sign(beyond) * limit / each.stiffness
        for peak, value in zip(peaks, (y[1:2], moved, pull), strict=True):
            np.maximum(peak, np.abs(value), out=peak)
    return peaks


CASES = {
    "tendon": [rf.Tendon(3e5, 4e6, position=0.1 * B)],
    "slack tendon": [rf.Tendon(1e4, 4e7), rf.Tendon(0.0, 2e7, position=0.6 * B)],
    "border of slack": [
        rf.Tendon(0.0, 4e6, yield_force=3.6e5, post_yield_ratio=0.1),
        rf.YieldingDissipator(2e7, 6e4, position=-0.7 * B, tension_only=True),
        rf.YieldingDissipator(2e7, 6e4, position=0.7 * B, tension_only=True),
    ],
    "damper": [rf.ViscousDamper(8e5, position=-0.5 * B), rf.ViscousDamper(8e5, position=0.5 * B)],
    "fuses": [
        rf.YieldingDissipator(2e7, 8e4, 0.05, position=-0.8 * B),
        rf.YieldingDissipator(2e7, 8e4, 0.05, position=0.8 * B),
    ],
    "hybrid": [
        rf.Tendon(3e5, 6e6, yield_force=3.6e5, post_yield_ratio=0.1),
        rf.YieldingDissipator(2e7, 6e4, position=0.7 * B, tension_only=True),
    ],
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_elements_on_springs(name):
    structure = held(*CASES[name])
    run = rf.simulate(structure, PULSE, "2DOF-S", ground=GROUND, free_vibration=0.6)
    duration = run.time[-1]
    rotation, moved, pull = marched(structure, PULSE, GROUND, duration, 2e-4)
    assert run.max_rotation == pytest.approx(rotation[0], rel=2e-4)
    assert run.max_element_elongation == pytest.approx(moved, rel=2e-4)
    assert run.max_element_force == pytest.approx(pull, rel=2e-3)
    assert run.energy.closing_error < 1e-10
    np.testing.assert_allclose(np.abs(run.element_elongation).max(axis=0), run.max_element_elongation, rtol=1e-3)
    if name in ("fuses", "hybrid"):
        assert run.element_yielded.any()
        assert run.energy.elements[-1].sum() > 0.0


def test_elements_change_nothing_without_stiffness():
    plain = rf.simulate(FRAME, PULSE, "MDOF-S", ground=GROUND)
    with_none = rf.simulate(held(rf.ViscousDamper(0.0), rf.Tendon(0.0, 1e-9)), PULSE, "MDOF-S", ground=GROUND)
    assert with_none.max_rotation == pytest.approx(plain.max_rotation, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_fuses_under_a_record_with_vertical_motion_and_friction(model):
    record = rf.load_suite("fema-p695-far-field")["FF-1-a"].scaled(1.5)
    both = record.with_vertical(0.5 * np.roll(record.acceleration, 137))
    ground = rf.Ground(friction=[0.3, 0.25, 0.3], springs=GROUND.springs, base_inertia=INERTIA)
    run = rf.simulate(held(*CASES["fuses"]), both, model, ground=ground)
    assert run.max_slip > 0.0
    assert run.element_yielded.any()
    assert run.energy.closing_error < 1e-10


def test_elements_with_many_branches(tmp_path):
    """Twenty pieces to each bar: more branches than octal digits."""
    places = np.linspace(0.0015, 0.03, 20)
    bars = [rf.MultilinearBar(places, 3e5 * np.tanh(places / 0.01), x, tension_only=True) for x in (-0.3, 0.3)]
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    bed = rf.winkler_bed(frame.half_width, 3.0, 1e8, n=6).damped(0.3, frame.rocking().m_tot)
    pulse, ground = rf.one_sine_pulse(amplitude=3.0, period=0.8), rf.Ground(springs=bed, base_inertia=1e5)
    run = rf.simulate(rf.Restrained(frame, bars), pulse, ground=ground, free_vibration=2.0)
    stretched = run.history.element_elongation
    assert stretched.max() > 0.02
    force = np.column_stack([[bar.slow_force(each) for each in stretched[:, k]] for k, bar in enumerate(bars)])
    np.testing.assert_allclose(run.element_force, force, rtol=0.0, atol=1e-12 * force.max())
    assert run.energy.closing_error < 1e-10
    back = rf.Response.load(run.save(tmp_path / "run"))
    np.testing.assert_array_equal(back.element_force, run.element_force)
