"""Random runs of every kind of model: structures, motions, elements, grounds, and laws of impact."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import rockflex as rf

PEAKS = (
    "max_rotation",
    "max_top_displacement",
    "max_base_moment",
    "max_base_shear",
    "max_total_top_displacement",
    "max_horizontal_reaction",
    "min_vertical_reaction",
)
LINEAR = ("plain", "elements", "slides", "springs", "elements on springs")
FURTHER = ("joints", "podium", "yielding springs", "one side", "stories", "leaning", "ties")
NONLINEAR = ("2DOF-C", "MDOF-C", "3DOF-C-SI", "3DOF-C-E", "rigid-C", "2DOF-S-BW", "2DOF-C-BW", "1DOF-fixed-BW")


class RandomRun(NamedTuple):
    """The arguments of `simulate`; the structure is a function that makes it anew, so that no engine is kept."""

    structure: Callable[[], Any]
    motion: rf.GroundMotion
    model: str
    options: dict[str, Any]

    def simulate(self, motion: rf.GroundMotion | None = None, **options: Any) -> rf.Response:
        """Run it, perhaps under another motion or with other options."""
        return rf.simulate(self.structure(), motion or self.motion, self.model, **self.options | options)

    def result(self, motion: rf.GroundMotion | None = None) -> tuple[object, Any, rf.Response | None]:
        """Run it, and return what happened, the peaks, and the response; or what the error says."""
        try:
            found = self.simulate(motion)
        except rf.SolverError as error:
            return "returns energy" in str(error), np.zeros(1), None
        counts = found.status, found.n_impacts, found.n_uplifts, found.settled
        return counts, np.array([getattr(found, name) for name in PEAKS]), found


class HalfOfIt:
    """A law of a user's own."""

    keeps = "half of the velocities"
    loses = "the other half, and the rotation"

    def after(self, properties, modal_velocity, rotation_velocity):
        return 0.5 * (modal_velocity + properties.effective_height * rotation_velocity), 0.0


class PassesSome:
    """A law of a user's own, after which rocking goes on."""

    keeps = "a part of the velocities"
    loses = "the rest"

    def after(self, properties, modal_velocity, rotation_velocity):
        return 0.9 * (modal_velocity + 0.7 * properties.effective_height * rotation_velocity), 0.3 * rotation_velocity


def linear_run(kind: str, seed: int, *, shaken: bool = False) -> RandomRun:
    """A run of a simplified model of a kind of `LINEAR`, perhaps with vertical acceleration."""
    run, rng = plain_run(100 * LINEAR.index(kind) + seed), np.random.default_rng(seed)
    motion, p = shaken_too(run.motion, seed) if shaken else run.motion, run.structure().rocking()
    structure, model, options = run.structure, run.model, dict(run.options)
    if kind != "plain" and model == "fixed":
        model, options = "MDOF-S", options | {"impact": None}
    if "springs" in kind or kind == "slides":
        options["ground"] = ground_of(rng, kind, p.half_width - abs(p.eccentricity), p.m_tot)
        options["impact"] = None if "springs" in kind else options["impact"]
    if "elements" in kind:
        some = linear_elements(rng, p.half_width, p.m_tot * 9.81)
        some = [each for each in some if kind == "elements" or not isinstance(each, rf.FrictionDamper)]
        options["free_vibration"] = 3.0  # tendons without damping may swing for ever
        structure = restrained(structure, some)
    return RandomRun(structure, motion, model, options)


def further_run(kind: str, seed: int, *, shaken: bool = False) -> RandomRun:
    """A run of a simplified model of a kind of `FURTHER`, perhaps with vertical acceleration."""
    rng = np.random.default_rng(1000 * (1 + FURTHER.index(kind)) + seed)
    motion, parameters = drawn_motion(rng), drawn_frame(rng)
    if kind == "stories":
        parameters |= {"stiffness_ratio": math.inf}
    frame, n = rf.Frame(**parameters), parameters["n_stories"]
    p = frame.rocking()
    weight, height = p.m_tot * 9.81, 3.0 * n
    options: dict[str, Any] = {"free_vibration": float(rng.choice([0.0, 3.0]))}
    model, made = str(rng.choice(["MDOF-S", "MDOF-S", "2DOF-S", "3DOF-S"])), None
    if kind == "joints":
        places = np.sort(rng.uniform(0.2, 0.8, int(rng.integers(1, 3)))) * height
        joints = [rf.Joint(float(place), float(p.half_width * rng.uniform(0.5, 1.0))) for place in places]
        held = [rf.Tendon(0.1 * weight, weight / 0.02)] if rng.random() < 0.5 else []
        return RandomRun(
            restrained(lambda: rf.Jointed(rf.Frame(**parameters), joints), held),
            shaken_too(motion, seed) if shaken else motion,
            "MDOF-S",
            options,
        )
    if kind == "podium":
        width, spacing = float(rng.uniform(0.6, 1.0)), float(rng.choice([4.0, 6.0]))

        def made():
            return rf.Podium(rf.Frame(**parameters), 4, width, 5.0, column_mass=8e3, column_spacing=spacing)

    elif kind == "yielding springs":
        count, capacity = int(rng.choice([2, 4, 6])), float(rng.uniform(1.5, 4.0))
        each = weight / count
        places = np.linspace(-p.half_width, p.half_width, count)
        springs = rf.Springs(places, np.full(count, each / 3e-3), np.full(count, 2e5), capacity=capacity * each)
        options["ground"] = rf.Ground(springs=springs, base_inertia=0.3 * p.m_tot * p.half_width**2)
    elif kind == "one side":
        restitution, side, block = float(rng.uniform(0.2, 0.8)), str(rng.choice(["right", "left"])), rng.random() < 0.5
        model = "rigid" if block else model

        def made():
            stands = rf.rigid_block(width=0.6, height=6.0, mass=7e3) if block else rf.Frame(**parameters)
            return rf.OneSided(stands, restitution, side)

    elif kind == "stories":
        strengths, ratio = [0.25 * weight * (1.0 - 0.6 * k / n) for k in range(n)], float(rng.choice([0.0, 0.05]))
        model = "MDOF-S"

        def made():
            return rf.YieldingStories(rf.Frame(**parameters), strengths, ratio)

    elif kind == "leaning":

        def made():
            return rf.Leaning(rf.Frame(**parameters), 0.3 * p.m_tot / n)

    else:
        some = (
            rf.ViscousDamper(2e5, between=(0, 1), cosine=0.8),
            rf.YieldingDissipator(weight / 0.01, 0.1 * weight, 0.03, between=(n - 1, n)),
            rf.YieldingDissipator(weight / 0.02, 0.05 * weight, 0.0, height=3.0, rupture_elongation=0.08),
            rf.Tendon(0.05 * weight, weight / 0.05, height=3.0),
            rf.Tendon(0.1 * weight, weight / 0.02, 0.5 * p.half_width),
        )
        chosen = [each for each in some if rng.random() < 0.5] or [some[1]]

        def made():
            return rf.Restrained(rf.Frame(**parameters), chosen)

    return RandomRun(
        made or (lambda: rf.Frame(**parameters)), shaken_too(motion, seed) if shaken else motion, model, options
    )


def restrained(structure: Callable[[], Any], elements: list[Any]) -> Callable[[], Any]:
    """The structure with elements, if there are any."""
    return (lambda: rf.Restrained(structure(), elements)) if elements else structure


def drawn_frame(rng: np.random.Generator) -> dict[str, Any]:
    """Arguments of a frame of two to six stories."""
    return {
        "n_stories": int(rng.integers(2, 7)),
        "story_height": 3.0,
        "story_mass": 40e3,
        "base_mass": 40e3,
        "stiffness_ratio": float(rng.choice([0.2, 1.0, math.inf])),
        "period": float(rng.uniform(0.3, 2.0)),
        "aspect_ratio": float(rng.uniform(3.0, 12.0)),
        "damping_ratio": float(rng.choice([0.01, 0.05])),
    }


def drawn_motion(rng: np.random.Generator) -> rf.GroundMotion:
    """A far-field record, scaled."""
    suite = rf.load_suite("fema-p695-far-field")
    return suite[int(rng.integers(len(suite)))].scaled(float(rng.uniform(0.5, 2.5)))


def plain_run(seed: int) -> RandomRun:
    """A run of a simplified model on rigid ground without elements, centred or eccentric."""
    rng = np.random.default_rng(seed)
    motion, parameters = drawn_motion(rng), drawn_frame(rng)
    shift = float(rng.uniform(-0.3, 0.3)) * (rng.random() < 0.3)
    model = str(rng.choice(["MDOF-S", "2DOF-S", "3DOF-S", "fixed", "2DOF-S-R", "rigid"]))
    laws = [None, None, rf.Restitution(0.6), rf.VVELComplete(), HalfOfIt()]
    options = {
        "impact": None if model == "fixed" else laws[int(rng.integers(len(laws)))],
        "free_vibration": [0.0, 3.0, "settle"][int(rng.integers(3))],
        "output": str(rng.choice(["peaks", "history"])),
    }

    def structure():
        frame = rf.Frame(**parameters)
        return rf.Eccentric(frame, shift * frame.rocking().half_width) if shift else frame

    return RandomRun(structure, motion, model, options)


def shaken_too(motion: rf.GroundMotion, seed: int) -> rf.GroundMotion:
    """The motion with the vertical component of another record, or part of it: the record may end before."""
    rng = np.random.default_rng(10_000 + seed)
    suite = rf.load_suite("fema-p695-far-field")
    other = suite[int(rng.integers(len(suite)))]
    times = np.arange(motion.acceleration.size) * motion.dt
    rise = np.interp(times, np.arange(other.acceleration.size) * other.dt, other.acceleration, right=0.0)
    rise *= float(rng.uniform(0.2, 0.8))
    return rf.GroundMotion(motion.acceleration, motion.dt, name="both", vertical=rise)


def linear_elements(rng: np.random.Generator, half_width: float, weight: float) -> list[Any]:
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


def ground_of(rng: np.random.Generator, kind: str, half_width: float, mass: float) -> rf.Ground:
    """Rigid ground with friction, or two to nine springs with dashpots, with or without friction."""
    if kind == "slides":
        return rf.Ground(friction=float(rng.choice([0.1, 0.2, 0.3, 0.5])))
    count, stiffness = int(rng.choice([2, 5, 9])), mass * 9.81 / float(rng.choice([1e-3, 1e-2]))
    damping = float(rng.choice([0.05, 0.3])) * 2.0 * math.sqrt(stiffness * mass)
    places, share = np.linspace(-half_width, half_width, count), np.full(count, 1.0 / count)
    friction = {"friction": 0.4} if rng.random() < 0.4 else {}
    springs = rf.Springs(places, stiffness * share, damping * share)
    return rf.Ground(springs=springs, base_inertia=0.3 * mass * half_width**2, **friction)


def nonlinear_elements(rng: np.random.Generator, weight: float, half_width: float) -> list[Any]:
    """Some tendons, fuses and viscous dampers."""
    found = []
    for _ in range(int(rng.integers(1, 4))):
        stiffness, place = weight * rng.uniform(0.3, 5.0), half_width * rng.choice([0.0, -0.9, 0.9, 0.5])
        force, ratio, kind = weight * rng.uniform(0.02, 0.2), float(rng.choice([0.0, 0.05])), int(rng.integers(5))
        breaks = rng.uniform(0.02, 0.2) if rng.random() < 0.4 else None
        found.append(
            (
                lambda k, x, f, _r, _b: rf.Tendon(f, k, x),
                lambda k, x, f, r, _b: rf.Tendon(0.5 * f, k, x, yield_force=f, post_yield_ratio=r),
                lambda k, x, f, r, b: rf.YieldingDissipator(10.0 * k, f, r, x, rupture_elongation=b),
                lambda k, x, f, r, _b: rf.YieldingDissipator(10.0 * k, f, r, x, tension_only=True),
                lambda k, x, _f, _r, _b: rf.ViscousDamper(0.05 * k, x),
            )[kind](stiffness, place, force, ratio, breaks)
        )
    return found


def nonlinear_run(seed: int) -> RandomRun:
    """A run of a complete or yielding model, each of `NONLINEAR` in turn; a third has vertical acceleration."""
    rng = np.random.default_rng(seed)
    motion, vertical = drawn_motion(rng), None
    if seed % 3 == 2:  # it begins after some seconds
        vertical = 0.6 * np.roll(motion.acceleration, 30) * (np.arange(len(motion.acceleration)) > 400)
    motion = rf.GroundMotion(motion.acceleration, motion.dt, name=motion.name, vertical=vertical)
    model, parameters = NONLINEAR[seed % len(NONLINEAR)], drawn_frame(rng)
    p = rf.Frame(**parameters).rocking()
    shift = float(rng.uniform(-0.3, 0.3)) * p.half_width * (rng.random() < 0.3)
    has_elements = rng.random() < 0.6 and "fixed" not in model
    held = nonlinear_elements(rng, p.m_tot * 9.81, p.half_width - abs(shift)) if has_elements else []
    laws = [None, None, rf.Restitution(0.6), rf.VVELComplete(), PassesSome()]
    yields = "BW" in model
    options: dict[str, Any] = {
        "impact": None if "fixed" in model else laws[int(rng.integers(len(laws)))],
        "free_vibration": [0.0, 3.0, 2.0 if yields else "settle"][int(rng.integers(3))],
        "output": str(rng.choice(["peaks", "history"])),
    }
    if yields:
        law = float(rng.uniform(0.005, 0.08)), float(rng.choice([0.0, 0.1])), 0.5, 0.5
        options["bouc_wen"] = rf.BoucWen(*law, exponent=float(rng.choice([1.0, 3.5, 8.0])))

    def structure():
        frame = rf.Frame(**parameters)
        return rf.Eccentric(frame, shift) if shift else frame

    return RandomRun(restrained(structure, held), motion, model, options)
