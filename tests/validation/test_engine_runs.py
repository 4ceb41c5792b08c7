"""Structures on the engine: against forty digits, and against the same motion in other samples."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest

import rockflex as rf
from builders import finer

PEAKS = (
    "max_rotation",
    "max_top_displacement",
    "max_base_moment",
    "max_base_shear",
    "max_total_top_displacement",
    "max_horizontal_reaction",
    "min_vertical_reaction",
)


class Block:
    """A rigid block in forty digits: θ'' = λ² θ - (s W + L a)/I, and θ' → η θ' at θ = 0."""

    def __init__(self, properties: rf.RockingProperties, restitution: float) -> None:
        p, number = properties, mpmath.mpf
        self.inertia, self.arm, self.eta = number(p.i_theta), number(p.l0r), number(restitution)
        self.weight = number(p.m_tot) * number(9.81) * number(p.half_width)
        self.rate = mpmath.sqrt(self.arm * number(9.81) / self.inertia)

    def at(self, start, side, ground, rise, t):
        """Rotation and its velocity after t; `ground` and `rise` are the acceleration and its slope."""
        c = (side * self.weight + self.arm * ground) / (self.inertia * self.rate**2)
        d = self.arm * rise / (self.inertia * self.rate**2)
        a, b = start[0] - c, (start[1] - d) / self.rate
        cosh, sinh = mpmath.cosh(self.rate * t), mpmath.sinh(self.rate * t)
        return c + d * t + a * cosh + b * sinh, d + self.rate * (a * sinh + b * cosh)

    def run(self, record, dt):
        """Largest rotation and number of impacts; every sign is looked for at forty places of a sample."""
        h = mpmath.mpf(dt)
        state, side, peak, impacts = (mpmath.mpf(0), mpmath.mpf(0)), 0, mpmath.mpf(0), 0
        for first, second in pairwise(record):
            first, rise, t = mpmath.mpf(first), (mpmath.mpf(second) - mpmath.mpf(first)) / h, mpmath.mpf(0)
            while t < h:
                ground = first + rise * t
                if side == 0:
                    lifts = fall(lambda x, a=ground, b=rise: self.weight - abs(self.arm * (a + b * x)), 0, h - t)
                    if lifts is None:
                        break
                    t += lifts
                    side = -1 if first + rise * t > 0 else 1
                    continue
                motion = self.moving(state, side, ground, rise)
                start = h * mpmath.mpf(10) ** -12 if state[0] == 0 else 0
                lands = fall(lambda x, m=motion, s=side: s * m(x)[0], start, h - t)
                end = h - t if lands is None else lands
                if side * motion(start)[1] > 0 > side * motion(end)[1]:
                    turns = fall(lambda x, m=motion, s=side: s * m(x)[1], start, end)
                    peak = max(peak, abs(motion(turns)[0]))
                state, t = motion(end), t + end
                peak = max(peak, abs(state[0]))
                if lands is not None:
                    impacts += 1
                    state = (mpmath.mpf(0), self.eta * state[1])
                    side = -side
        return float(peak), impacts

    def moving(self, state, side, ground, rise):
        return lambda t: self.at(state, side, ground, rise, t)


def fall(f, start, stop):
    """Where a function first falls below zero; None if it does not."""
    start, before = mpmath.mpf(start), mpmath.mpf(start)
    for k in range(1, 41):
        here = start + (stop - start) * k / 40
        if f(here) < 0:
            low, high = before, here
            for _ in range(135):
                middle = (low + high) / 2
                low, high = (low, middle) if f(middle) < 0 else (middle, high)
            return (low + high) / 2
        before = here
    return None


def test_a_rigid_block_in_forty_digits():
    block = rf.rigid_block(slenderness=0.15, half_diagonal=3.0)
    times = np.arange(150) * 0.02
    motion = rf.GroundMotion(2.5 * np.sin(5.0 * times) * np.exp(-times), 0.02, name="decay")
    with mpmath.workdps(40):
        peak, impacts = Block(block, 0.9).run(motion.acceleration, motion.dt)
    found = rf.simulate(block, motion, "rigid", impact=rf.Restitution(0.9), output="peaks")
    assert impacts > 3
    assert found.n_impacts == impacts
    # Every impact multiplies an error by about ten at the most, and rounding is 1e-16 of the rotation.
    assert found.max_rotation == pytest.approx(peak, rel=1e-12)


def case(seed):
    rng = np.random.default_rng(seed)
    suite = rf.load_suite("fema-p695-far-field")
    motion = suite[int(rng.integers(len(suite)))].scaled(float(rng.uniform(0.5, 2.5)))
    n = int(rng.integers(2, 7))
    parameters = {
        "n_stories": n,
        "story_height": 3.0,
        "story_mass": 40e3,
        "base_mass": 40e3,
        "stiffness_ratio": float(rng.choice([0.2, 1.0, math.inf])),
        "period": float(rng.uniform(0.3, 2.0)),
        "aspect_ratio": float(rng.uniform(3.0, 12.0)),
        "damping_ratio": float(rng.choice([0.01, 0.05])),
    }
    shift = float(rng.uniform(-0.3, 0.3)) * (rng.random() < 0.3)
    model = str(rng.choice(["MDOF-S", "2DOF-S", "3DOF-S", "fixed", "2DOF-S-R", "rigid"]))
    laws = [None, None, rf.Restitution(0.6), rf.VVELComplete(), HalfOfIt()]
    options = {
        "impact": None if model == "fixed" else laws[int(rng.integers(len(laws)))],
        "free_vibration": [0.0, 3.0, "settle"][int(rng.integers(3))],
        "output": str(rng.choice(["peaks", "history"])),
    }

    def structure():
        """Made anew, so that no engine is kept from another run."""
        frame = rf.Frame(**parameters)
        return rf.Eccentric(frame, shift * frame.rocking().half_width) if shift else frame

    return structure, motion, model, options


class HalfOfIt:
    """A law of a user's own."""

    keeps = "half of the velocities"
    loses = "the other half, and the rotation"

    def after(self, properties, modal_velocity, rotation_velocity):
        return 0.5 * (modal_velocity + properties.effective_height * rotation_velocity), 0.0


def result(structure, motion, model, options):
    try:
        found = rf.simulate(structure(), motion, model, **options)
    except rf.SolverError as error:
        return "returns energy" in str(error), np.zeros(1), 0
    counts = found.status, found.n_impacts, found.n_uplifts, found.settled
    return counts, np.array([getattr(found, name) for name in PEAKS]), found.end_time


def shaken(motion, seed):
    """The motion with the vertical component of another record, or part of it: the record may end before."""
    rng = np.random.default_rng(10_000 + seed)
    suite = rf.load_suite("fema-p695-far-field")
    other = suite[int(rng.integers(len(suite)))]
    times = np.arange(motion.acceleration.size) * motion.dt
    rise = np.interp(times, np.arange(other.acceleration.size) * other.dt, other.acceleration, right=0.0)
    rise *= float(rng.uniform(0.2, 0.8))
    return rf.GroundMotion(motion.acceleration, motion.dt, name="both", vertical=rise)


def elements(rng, half_width, weight):
    """Some tendons, fuses, bars that only pull, viscous and friction dampers."""
    found = []
    for _ in range(int(rng.integers(1, 4))):
        place = half_width * float(rng.choice([0.0, 1.0, -1.0, rng.uniform(-1.0, 1.0)]))
        force = weight * float(rng.uniform(0.02, 0.3))
        stiffness, ratio = force / float(rng.uniform(1e-3, 2e-2)), float(rng.choice([0.0, 0.03]))
        breaks = [None, float(rng.uniform(0.02, 0.2))][int(rng.random() < 0.3)]
        found.append(
            (
                lambda f, k, r, b, x: rf.Tendon(f, k, x),
                lambda f, k, r, b, x: rf.Tendon(f, k, x, yield_force=1.3 * f, post_yield_ratio=r, rupture_elongation=b),
                lambda f, k, r, b, x: rf.YieldingDissipator(k, f, r, x, rupture_elongation=b),
                lambda f, k, r, b, x: rf.YieldingDissipator(k, f, r, x, tension_only=True),
                lambda f, k, r, b, x: rf.ViscousDamper(10.0 * f, x),
                lambda f, k, r, b, x: rf.FrictionDamper(f, x),
            )[int(rng.integers(6))](force, stiffness, ratio, breaks, place)
        )
    return found


def ground_of(rng, kind, half_width, mass):
    """Rigid ground with friction, or two to nine springs with dashpots, with or without friction."""
    if kind == "slides":
        return rf.Ground(friction=float(rng.choice([0.1, 0.2, 0.3, 0.5])))
    count, stiffness = int(rng.choice([2, 5, 9])), mass * 9.81 / float(rng.choice([1e-3, 1e-2]))
    damping = float(rng.choice([0.05, 0.3])) * 2.0 * math.sqrt(stiffness * mass)
    places, share = np.linspace(-half_width, half_width, count), np.full(count, 1.0 / count)
    friction = {"friction": 0.4} if rng.random() < 0.4 else {}
    springs = rf.Springs(places, stiffness * share, damping * share)
    return rf.Ground(springs=springs, base_inertia=0.3 * mass * half_width**2, **friction)


KINDS = ("plain", "elements", "slides", "springs", "elements on springs")


@pytest.mark.parametrize("shakes", [False, True])
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("kind", KINDS)
def test_random_runs_do_not_depend_on_the_samples_of_a_motion(kind, seed, shakes):
    structure, motion, model, options = case(100 * KINDS.index(kind) + seed)
    motion, rng, p = shaken(motion, seed) if shakes else motion, np.random.default_rng(seed), structure().rocking()
    if kind != "plain" and model == "fixed":
        model, options = "MDOF-S", options | {"impact": None}
    if "springs" in kind or kind == "slides":
        options["ground"] = ground_of(rng, kind, p.half_width - abs(p.eccentricity), p.m_tot)
        options["impact"] = None if "springs" in kind else options["impact"]
    if "elements" in kind:
        some = [each for each in elements(rng, p.half_width, p.m_tot * 9.81) if kind == "elements" or not rubs(each)]
        options["free_vibration"] = 3.0  # tendons without damping may swing for ever

        def tied():
            return rf.Restrained(structure(), some) if some else structure()

    made = tied if "elements" in kind else structure
    counts, peaks, end = result(made, motion, model, options)
    others, expected, until = result(made, finer(motion), model, options)
    near = rf.GroundMotion(motion.acceleration * (1.0 + 1e-12), motion.dt, name=motion.name, vertical=motion.vertical)
    moved = result(made, near, model, options)
    # Rounding does less to both than a change of the record by 1e-12, unless that is too little to see.
    bound = 1e-10 + 30.0 * (np.abs(moved[1] - peaks) / np.maximum(np.abs(peaks), 1e-300)).max()
    if moved[0] != counts or (counts != others and bound > 1e-9):
        pytest.skip("the outcome itself depends on the twelfth digit of the record")
    assert counts == others
    np.testing.assert_allclose(peaks, expected, rtol=bound, atol=1e-300)
    assert end == pytest.approx(until, abs=256 * motion.dt)  # whether a run has settled is asked every 64 samples


def rubs(element):
    return isinstance(element, rf.FrictionDamper)


@pytest.mark.parametrize("seed", range(20))
def test_no_more_than_friction_can_give_is_asked_of_the_ground(seed):
    """Where the base stops and at once slides back, it is not held for an instant."""
    structure, motion, _, _ = case(seed)
    run = rf.simulate(structure(), motion.scaled(1.5), "MDOF-S", ground=rf.Ground(friction=0.02))
    p = structure().rocking()
    assert run.max_horizontal_reaction <= 0.02 * p.m_tot * 9.81 * (1.0 + 1e-12)


def test_an_interrupt_in_a_law_ends_the_run():
    class Interrupts(HalfOfIt):
        def after(self, properties, modal_velocity, rotation_velocity):
            raise KeyboardInterrupt

    structure, motion, _, _ = case(1)
    with pytest.raises(KeyboardInterrupt):
        rf.simulate(structure(), motion.scaled(3.0), "2DOF-S", impact=Interrupts())
