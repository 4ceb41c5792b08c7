"""Border cases: settling, slack, yielding back, sticking for no time, falling ground, energies that do not close."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rockflex as rf
from builders import make_frame

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
B = FRAME.rocking().half_width
SUITE = rf.load_suite("fema-p695-far-field")
PULSE = rf.one_sine_pulse(amplitude=4.0, period=1.1)
QUIET = rf.quiet_motion(0.5)
SINKS = 0.01  # m, under the weight


def on_springs(friction=None, positions=(-1.0, 1.0), structure=FRAME):
    p = structure.rocking()
    stiffness = p.m_tot * 9.81 / SINKS / len(positions)
    springs = rf.Springs(p.half_width * np.array(positions), stiffness, 0.01 * stiffness)
    return rf.Ground(friction=friction, springs=springs, base_inertia=1e5 * p.half_width**2)


# Settling


@pytest.mark.parametrize("friction", [0.15, 0.5, 2.0])
@pytest.mark.parametrize("motion", [QUIET, PULSE, SUITE["FF-1-a"].scaled(1.5)], ids=["quiet", "pulse", "record"])
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_a_base_on_springs_with_friction_settles(friction, motion, model):
    """And a run that goes on for as long again finds no more."""
    ground = on_springs(friction, (-1.0, 0.2, 1.0))
    run = rf.simulate(FRAME, motion, model, ground=ground, free_vibration="settle")
    assert run.settled
    assert run.end_time < motion.duration + 60.0
    longer = rf.simulate(FRAME, motion, model, ground=ground, free_vibration=2.0 * run.end_time + 20.0)
    assert run.n_uplifts == longer.n_uplifts
    for name in ("max_rotation", "max_base_moment", "max_slip", "residual_slip", "min_vertical_reaction"):
        assert getattr(run, name) == pytest.approx(getattr(longer, name), rel=1e-9, abs=1e-9)
    assert (run.max_slip > 0.0) == (longer.max_slip > 0.0)


def test_a_rigid_block_on_springs_settles():
    """Its heave never moves: the support that it has lost is a rounded zero."""
    frame = make_frame(n_stories=3, aspect_ratio=7.5)
    ground = on_springs(positions=(-1.0, 0.0, 1.0), structure=frame)
    shock = rf.GroundMotion([0.0, 3.0, 0.0], 0.05)
    run = rf.simulate(frame, shock, "rigid", ground=ground, free_vibration="settle")
    assert run.settled


def test_settling_ends_a_fragility_on_springs_with_friction():
    runs = rf.run_cloud(FRAME, SUITE[:4], models=["2DOF-S"], ground=on_springs(0.4), free_vibration="settle")
    assert (runs["error"].fillna("") == "").all()


def test_bars_without_prestress_settle_on_soft_springs_with_little_damping():
    """Each cycle passes the border of slack, until its amplitude is rounding: half an hour, at 0.8 % and T = 4.4 s."""
    frame = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.3, damping_ratio=0.1, aspect_ratio=8)
    p = frame.rocking()
    weight, half = p.m_tot * 9.81, p.half_width
    springs = rf.Springs(half * np.array([-1.0, -0.3, 0.5, 1.0]), weight / 0.05 / 4.0).damped(0.05, p.m_tot)
    ground = rf.Ground(springs=springs, base_inertia=60e3 * half**2)
    bar = rf.YieldingDissipator(2e7, 0.05 * weight, 0.02, 0.5 * half, tension_only=True)
    held = rf.Restrained(frame, [rf.Tendon(0.0, 2e7, 0.1 * half), bar])
    assert rf.simulate(held, SUITE["FF-2-a"].scaled(0.25), "2DOF-S", ground=ground, free_vibration="settle").settled


def test_output_does_not_change_when_a_run_has_settled():
    frame, pulse = make_frame(period=1.2, aspect_ratio=6.0, damping_ratio=0.2), rf.one_sine_pulse(3.3, 0.34)
    runs = [rf.simulate(frame, pulse, "MDOF-S", free_vibration="settle", output=each) for each in ("peaks", "history")]
    assert runs[0].end_time == runs[1].end_time


# Slack


def border(structure, initial_force, yields):
    p = structure.rocking()
    limit, half = 0.1 * p.m_tot * 9.81, p.half_width
    fuses = [rf.YieldingDissipator(limit / 5e-3, limit, 0.02, s * 0.7 * half, tension_only=True) for s in (1.0, -1.0)]
    return rf.Restrained(structure, [rf.Tendon(initial_force, 8e6, 0.0, *((limit, 0.02) if yields else ())), *fuses])


@pytest.mark.slow
@pytest.mark.parametrize("count", [2, 5])
@pytest.mark.parametrize(
    "motion", [QUIET, SUITE["FF-1-a"], SUITE["FF-5-a"].scaled(2.0)], ids=["quiet", "weak", "strong"]
)
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_tension_only_elements_may_start_on_the_border_of_slack(count, motion, model):
    """Without prestress the run is that with one newton, which a base on springs does not notice."""
    frame = make_frame()
    ground = on_springs(positions=np.linspace(-1.0, 1.0, count), structure=frame)
    for yields in (False, True):
        held = [border(frame, force, yields) for force in (0.0, 1.0)]
        loose, taut = (rf.simulate(each, motion, model, ground=ground, free_vibration=3.0) for each in held)
        assert loose.max_rotation == pytest.approx(taut.max_rotation, rel=1e-3, abs=1e-9)
        assert loose.max_element_force == pytest.approx(taut.max_element_force, rel=1e-2, abs=10.0)
        assert loose.energy.closing_error < 1e-8
        assert rf.simulate(held[0], motion, model, ground=ground, free_vibration="settle").settled


def test_an_elastic_tendon_on_springs_does_not_push():
    ground = on_springs()
    held = rf.Restrained(FRAME, rf.Tendon(1e4, 5e7))
    run = rf.simulate(held, SUITE["FF-1-a"].scaled(2.0), "2DOF-S", ground=ground)
    force, stretch = run.element_force[:, 0], run.element_elongation[:, 0]
    assert (1e4 + 5e7 * stretch).min() < -1e4
    np.testing.assert_allclose(force, np.maximum(1e4 + 5e7 * stretch, 0.0), atol=1e-6 * force.max())
    assert run.energy.closing_error < 1e-9


@pytest.mark.parametrize("model", ["rigid", "rigid-C"])
@pytest.mark.parametrize("force", [0.0, 2e5])
def test_a_tendon_beyond_the_pivot_goes_slack_on_rigid_ground(model, force):
    """An eccentric block let go from a rotation, against SciPy's integrator: the time of its first impact."""
    mass, half, off, leverage, stiffness, place = 240e3, 1.2, 0.6, 1.8e6, 2e7, 1.6
    block = {"i_theta": 24e6, "l0r": leverage, "m_tot": mass, "half_width": half, "zeta": 0.02, "eccentricity": off}
    held = rf.RockingProperties([], [], [], [], **block, elements=(rf.Tendon(force, stiffness, place),))
    inertia = 24e6 + mass * ((half - off) ** 2 - half**2)
    start, arm = 0.05, half - off - place
    run = rf.simulate(held, rf.quiet_motion(3.0), model, initial=rf.InitialState(rotation=start))

    def rates(_, y):
        large = model == "rigid-C"
        stretch = arm * (2.0 * math.sin(0.5 * y[0]) if large else y[0])
        lever = arm * (math.cos(0.5 * y[0]) if large else 1.0)
        pull = max(force + stiffness * stretch, 0.0) * lever
        sine, cosine = (math.sin(y[0]), math.cos(y[0])) if large else (y[0], 1.0)
        return y[1], (9.81 * (leverage * sine - mass * (half - off) * cosine) - pull) / inertia

    def closed(_, y):
        return y[0]

    closed.terminal = True
    found = solve_ivp(rates, (0.0, 5.0), (start, 0.0), rtol=1e-12, atol=1e-14, events=closed, max_step=1e-3)
    assert run.impact_times[0] == pytest.approx(found.t[-1], rel=1e-7)
    assert run.element_force.min() >= -1e-6


# Energies


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C"])
def test_bars_that_yield_back_before_they_are_slack_balance(seed, model):
    """And what a bar dissipates is the work of its own force, less what it stores."""
    chance = np.random.default_rng(seed)
    ratio, stiffness, limit = (
        chance.uniform(0.2, 0.7),
        10.0 ** chance.uniform(7.0, 8.0),
        10.0 ** chance.uniform(4.3, 5.2),
    )
    bar = rf.YieldingDissipator(stiffness, limit, ratio, chance.uniform(-0.9, 0.9) * B, tension_only=True)
    if seed % 2:
        bar = rf.Tendon(chance.uniform(0.0, 0.9) * limit, stiffness, 0.3 * B, limit, ratio)
    motion = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:500] * 2.5, 0.02)
    run = rf.simulate(rf.Restrained(FRAME, bar), motion, model)
    force, stretch = run.element_force[:, 0], run.element_elongation[:, 0]
    assert force.max() > 2.0 * limit
    work = 0.5 * (force[1:] + force[:-1]) @ np.diff(stretch)  # linear between the states
    spent = run.energy.elements[-1, 0] + run.energy.element_strain[-1] - run.energy.element_strain[0]
    assert spent == pytest.approx(work, rel=1e-6)
    assert run.energy.closing_error < 1e-8


@pytest.mark.parametrize("seed", [5, 43, 50, 170])
def test_bars_that_are_slack_and_taut_again_within_a_sample_balance(seed):
    """Both ends of the interval are then on the border of slack, and only the velocities tell what lies between."""
    frame, coarse = undamped(seed)
    p = frame.rocking()
    bar = rf.YieldingDissipator(2.5e7, 0.05 * p.m_tot * 9.81, 0.1, 0.5 * p.half_width, tension_only=True)
    assert rf.simulate(rf.Restrained(frame, bar), coarse, "2DOF-S").energy.closing_error < 1e-9


def undamped(seed):
    """A frame without damping, and a record of which every eighth sample is left."""
    chance = np.random.default_rng(seed)
    frame = make_frame(period=chance.choice([0.2, 0.5]), aspect_ratio=4.0, damping_ratio=0.0)
    record = SUITE[int(chance.integers(len(SUITE)))]
    return frame, rf.GroundMotion(chance.uniform(1.0, 3.0) * record.acceleration[::8].copy(), 8.0 * record.dt)


@pytest.mark.parametrize("friction", [0.04, 0.07, 0.14])
@pytest.mark.parametrize("model", ["rigid", "2DOF-S"])
def test_a_base_that_sticks_and_slips_again_at_once_balances(friction, model):
    coarse = rf.GroundMotion(3.0 * SUITE["FF-18-b"].acceleration[::4].copy(), 4.0 * SUITE["FF-18-b"].dt)
    for frame in (make_frame(n_stories=3, aspect_ratio=1.5), FRAME):
        run = rf.simulate(frame, coarse, model, ground=rf.Ground(friction=friction))
        assert run.max_slip > 0.0
        assert run.energy.closing_error < 1e-7
        assert run.warnings == ()


@pytest.mark.parametrize("seed", range(40))
def test_a_base_on_ground_that_falls_faster_than_gravity_balances(seed):
    """Both edges want to lift then, and it is the one that is pulled more that does."""
    chance = np.random.default_rng(seed)
    frame = make_frame(n_stories=3, period=chance.choice([0.15, 0.5, 1.0]), aspect_ratio=chance.choice([2.5, 6.0]))
    along, across = (SUITE[int(k)].acceleration[:700] for k in chance.integers(len(SUITE), size=2))
    peak = 9.81 * chance.uniform(1.0, 3.0)
    size = min(along.size, across.size)
    motion = rf.GroundMotion(9.81 * along[:size] / np.abs(along).max(), 0.01)
    motion = motion.with_vertical(peak * across[:size] / np.abs(across).max())
    run = rf.simulate(frame, motion, chance.choice(["2DOF-S", "MDOF-S"]))
    assert (run.side * run.rotation).min() >= 0.0
    assert run.energy.closing_error < 1e-7


def test_energies_that_do_not_balance_are_a_warning():
    run = rf.simulate(FRAME, PULSE, "2DOF-S")
    assert not any("balance" in text for text in run.warnings)
    assert run.history is not None
    states = run.history.states.copy()
    states[states.shape[0] // 2 :, 4] *= 1.001  # D_1, a little off from there on
    wrong = dataclasses.replace(run, history=rf.History(run.history.model, states))
    assert [text for text in wrong.warnings if "balance" in text]
    assert not any("balance" in text for text in rf.simulate(FRAME, PULSE, "2DOF-S", output="peaks").warnings)


# Histories


@pytest.mark.parametrize("seed", [*range(10), 79])
@pytest.mark.parametrize("model", ["2DOF-S-R", "3DOF-S-R"])
def test_histories_stay_within_their_peaks(seed, model):
    """Where friction holds a base for no time as it turns, its acceleration is no part of the motion."""
    chance = np.random.default_rng(seed)
    frame = make_frame(period=chance.choice([0.3, 1.0]), aspect_ratio=chance.choice([4.0, 8.0]), damping_ratio=0.03)
    p = frame.rocking()
    held = rf.Restrained(frame, rf.FrictionDamper(0.1 * p.m_tot * 9.81, 0.5 * p.half_width))
    record = SUITE[int(chance.integers(len(SUITE)))]
    motion = rf.GroundMotion(chance.uniform(1.0, 3.0) * record.acceleration[::4].copy(), 4.0 * record.dt)
    for structure, ground in ((held, None), (frame, rf.Ground(friction=0.1))):
        assert_within_peaks(rf.simulate(structure, motion, model, ground=ground))


def assert_within_peaks(run):
    for name in ("base_moment", "base_shear", "horizontal_reaction"):
        assert np.abs(getattr(run, name)).max() <= getattr(run, f"max_{name}") * (1.0 + 1e-9)


@pytest.mark.parametrize("seed", [4, 13, 33, 39])
def test_a_base_that_lands_and_lifts_at_once_is_not_held_between(seed):
    frame, coarse = undamped(seed)
    p = frame.rocking()
    held = rf.Restrained(frame, rf.FrictionDamper(0.05 * p.m_tot * 9.81, 0.5 * p.half_width))
    assert_within_peaks(rf.simulate(held, coarse, "2DOF-S-R"))
