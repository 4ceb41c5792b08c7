"""Elements given by their branches: against adaptive integration (SciPy), closed forms, and elements they equal."""

import pickle
from dataclasses import dataclass

import numpy as np
import pytest

import rockflex as rf
from builders import fuse_branches, fuse_energy, make_frame
from twins.controlled import DOWN, ELASTIC, UP, Bar, ControlledTwin

FRAME = make_frame(n_stories=3, stiffness_ratio=0.125, period=0.6, aspect_ratio=7.0, damping_ratio=0.03)
PLAIN = FRAME.rocking()
WEIGHT, B = PLAIN.m_tot * 9.81, PLAIN.half_width
MOTION = rf.load_suite("fema-p695-far-field")["FF-12-a"].scaled(1.6)
SHORT = rf.GroundMotion(MOTION.acceleration[3600:6400], MOTION.dt)  # its strong part
STIFF = WEIGHT / (0.004 * B)  # N/m: a force of the weight at a stretch of 0.004 B


@dataclass
class Flag(Bar):
    """A flag-shaped bar that is only stretched: m = δ - F_y/k on the upper plateau, δ - `lower` on the lower one."""

    lower: float = 0.0

    def tangent(self):
        k, a = self.stiffness, self.post_yield_ratio
        if self.branch == ELASTIC:
            return k, 0.0, -(1.0 - a) * k * self.plastic
        return a * k, 0.0, (1.0 - a) * k * (self.reach if self.branch == UP else self.lower)

    def limits(self):
        low = self.lower + self.plastic if self.plastic > 0.0 else -np.inf
        return low, DOWN, self.reach + self.plastic, UP

    def emptied(self):
        return self.lower if self.branch == DOWN else -np.inf

    def slacken(self, delta):
        del delta
        self.branch, self.plastic = ELASTIC, 0.0

    def settle(self, delta):
        if self.branch in (UP, DOWN):
            self.plastic = delta - (self.reach if self.branch == UP else self.lower)
            self.branch = ELASTIC

    def rest(self):
        self.settle(0.0)


@dataclass
class Pieces(Bar):
    """A nonlinear elastic bar: points of δ and F, stretched or shortened."""

    ends: tuple = ()
    forces: tuple = ()
    piece: int = 0

    def __post_init__(self):
        self.branch = self.piece = int(np.searchsorted(self.ends, 0.0))

    def tangent(self):
        x, f, k = self.ends, self.forces, int(np.clip(self.branch, 1, len(self.ends) - 1))
        slope = (f[k] - f[k - 1]) / (x[k] - x[k - 1])
        return slope, 0.0, f[k] - slope * x[k]

    def limits(self):
        k, last = self.branch, len(self.ends) - 1
        below, above = (
            (self.ends[k - 1], k - 1) if k > 1 else (-np.inf, k),
            (self.ends[k], k + 1) if k < last else (np.inf, k),
        )
        return *below, *above

    def emptied(self):
        return -np.inf

    def settle(self, delta):
        pass

    def rest(self):
        self.branch = self.piece


FLAGS = [rf.FlagShapedBar(0.5 * STIFF, 0.06 * WEIGHT, 0.03, 0.7, x) for x in (-0.8 * B, 0.8 * B)]
DEEP = [rf.FlagShapedBar(0.4 * STIFF, 0.05 * WEIGHT, 0.05, 0.95, x) for x in (-B, 0.5 * B)]
GAPS = [rf.GapBar(0.5 * STIFF, 0.003 * B, x) for x in (-B, B)]
SOFTENING = [rf.MultilinearBar((0.001 * B, 0.004 * B, 0.02 * B), (0.1 * WEIGHT, 0.18 * WEIGHT, 0.2 * WEIGHT), 0.4 * B)]
CASES = {
    "flags": (FLAGS, 0.0, 3),
    "deep flags": (DEEP, 0.1 * B, 2),
    "gaps": (GAPS, 0.0, 1),
    "softening": (SOFTENING, 0.1 * B, 2),
}


def twin_element(given):
    match given:
        case rf.FlagShapedBar():
            at = (given.stiffness, given.yield_force, given.post_yield_ratio, given.position)
            lower = given.yield_force / given.stiffness * (1.0 - given.flag_depth / (1.0 - given.post_yield_ratio))
            return Flag(*at, lower=lower)
        case rf.GapBar():
            points = (-1.0, given.gap, given.gap + 1.0), (0.0, 0.0, given.stiffness)
        case rf.MultilinearBar():
            x, f = (0.0, *given.elongations), (0.0, *given.forces)
            points = (*(-each for each in reversed(x[1:])), *x), (*(-each for each in reversed(f[1:])), *f)
    return Pieces(1.0, 1.0, 0.0, given.position, ends=points[0], forces=points[1])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_elements_meet_their_twin(name):
    elements, eccentricity, n = CASES[name]
    structure = rf.Restrained(rf.Eccentric(FRAME, eccentricity) if eccentricity else FRAME, elements)
    twin = ControlledTwin.of(structure.rocking(n), [twin_element(each) for each in elements])
    expected = twin.run(SHORT.acceleration, SHORT.dt)
    found = rf.simulate(structure, SHORT, f"{n + 1}DOF-S")
    assert found.n_uplifts == len(expected.uplift_times) > 1
    assert found.max_rotation == pytest.approx(expected.max_rotation, rel=3e-7)
    assert found.max_top_displacement == pytest.approx(expected.max_top_displacement, rel=1e-8)
    assert found.max_base_moment == pytest.approx(expected.max_base_moment, rel=1e-8)
    branches = {state for element in elements for state in element.law if element.law[state].yields}
    assert bool(branches) == found.element_yielded.any() == ("flags" in name)


def test_the_loops_of_a_flag_have_their_closed_form():
    """β F_y (δ_m - F_y/k) to each side, whatever the stiffness after yielding."""
    for ratio, depth, only in ((0.0, 1.0, False), (0.05, 0.6, False), (0.1, 0.9, True)):
        bar = rf.FlagShapedBar(0.5 * STIFF, 0.06 * WEIGHT, ratio, depth, tension_only=only)
        curve = rf.moment_rotation(rf.Restrained(FRAME, bar), [0.02, -0.02, 0.0])
        expected = depth * bar.yield_force * (0.02 * B - bar.yield_force / bar.stiffness)
        np.testing.assert_allclose(curve.loop_energies, expected, rtol=1e-12)
        assert curve.self_centring
        assert bar.locked_force == 0.0


GROUNDS = {
    "rigid": None,
    "slides": rf.Ground(friction=0.3),
    "springs": rf.Ground(
        springs=rf.Springs(np.linspace(-B, B, 3), np.full(3, 3e8), np.full(3, 2e5)), base_inertia=1e5, friction=0.5
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("elements", [FLAGS, DEEP, GAPS, SOFTENING], ids=["flags", "deep", "gaps", "softening"])
def test_energy_closes(elements, ground):
    vertical = rf.GroundMotion(SHORT.acceleration, SHORT.dt, vertical=0.4 * SHORT.acceleration)
    for motion in (SHORT, vertical):
        run = rf.simulate(rf.Restrained(FRAME, elements), motion, "MDOF-S", ground=GROUNDS[ground])
        assert np.abs(run.energy.residual).max() < 1e-10 * run.energy.input.max()
        dissipated = run.element_energy
        assert (dissipated[run.element_yielded] > 0.0).all()
        assert np.abs(dissipated[~run.element_yielded]).max(initial=0.0) < 1e-10 * run.energy.input.max()
        assert "flag" in type(elements[0]).__name__.lower() or not dissipated.any()  # not even rounding


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C"])
def test_limits_are_other_elements(model):
    """A gap of zero and one piece are a tendon without force; a flag that never yields is, too."""
    tendon = rf.simulate(rf.Restrained(FRAME, rf.Tendon(0.0, 0.5 * STIFF)), SHORT, model)
    for same in (
        rf.GapBar(0.5 * STIFF, 0.0),
        rf.MultilinearBar([1.0], [0.5 * STIFF]),
        rf.FlagShapedBar(0.5 * STIFF, 100.0 * WEIGHT, 0.0, 0.5),
    ):
        run = rf.simulate(rf.Restrained(FRAME, same), SHORT, model)
        assert run.n_impacts == tendon.n_impacts
        assert run.max_rotation == pytest.approx(tendon.max_rotation, rel=1e-9)
        assert run.max_element_force[0] == pytest.approx(tendon.max_element_force[0], rel=1e-9)
        assert not run.element_yielded[0]


def test_small_rotations_of_complete_models_are_those_of_simplified_ones():
    weak = SHORT.scaled(0.4)
    runs = [rf.simulate(rf.Restrained(FRAME, FLAGS), weak, model) for model in ("2DOF-S", "2DOF-C")]
    assert runs[1].element_yielded.all()
    assert runs[0].max_rotation == pytest.approx(runs[1].max_rotation, rel=0.05)
    assert np.abs(runs[1].energy.residual).max() < 1e-8 * runs[1].energy.input.max()


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C"])
def test_saved_responses_go_on(model, tmp_path):
    elements = [*FLAGS, GAPS[0], SOFTENING[0]]
    run = rf.simulate(rf.Restrained(FRAME, elements), SHORT, model)
    back = rf.Response.load(run.save(tmp_path / "run"))
    for name, value in run.peaks().items():
        np.testing.assert_array_equal(back.peaks()[name], value)
    np.testing.assert_array_equal(back.history.element_force, run.history.element_force)
    np.testing.assert_array_equal(back.element_energy, run.element_energy)
    assert back.history.model.properties.elements == tuple(elements)


def bumper(**changes):
    """A user's own bar of two branches, with one of them changed."""

    @dataclass(frozen=True)
    class Bumper(rf.ElementLaw):
        stiffness: float = 5e7
        gap: float = 0.005
        position: float = 0.0

        def branches(self):
            given = {
                "open": {"ends": [rf.BranchEnd("pressed", self.gap, rising=True)]},
                "pressed": {
                    "stiffness": self.stiffness,
                    "force": -self.stiffness * self.gap,
                    "ends": [rf.BranchEnd("open", self.gap, rising=False)],
                },
            }
            for name, values in changes.items():
                given[name] = given.get(name, {}) | values
            return {name: rf.Branch(**values) for name, values in given.items()}

    return Bumper()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"pressed": {"force": 0.0}}, "jumps.*pressed"),
        ({"open": {"ends": [rf.BranchEnd("shut", 0.005, rising=True)]}}, "'shut', which is no branch"),
        ({"open": {"stiffness": float("nan")}}, "stiffness must be a number"),
        ({"pressed": {"yields": 2}}, "yields must be 1, 0 or -1"),
        ({"pressed": {"yields": 1, "turns_to": "open"}}, "open.*no branch|jumps|elastic"),
        ({"open": {"ends": [rf.BranchEnd("open", 0.005, rising=True)]}}, "without end"),
    ],
)
def test_branches_that_contradict_each_other_are_refused(changes, words):
    with pytest.raises(rf.InputError, match=words) as caught:
        bumper(**changes)
    assert caught.value.field == "branches"


@dataclass(frozen=True)
class Fuse(rf.ElementLaw):
    """An elastoplastic bar as a user would write one; `share` is the part of α (1 - α) k m²/2 that it stores."""

    stiffness: float
    yield_force: float
    ratio: float
    position: float = 0.0
    share: float = 1.0

    def branches(self):
        return fuse_branches(self)

    def stored_energy(self, elongation, internal):
        return fuse_energy(self, elongation, internal, self.share)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C"])
@pytest.mark.parametrize("ground", ["rigid", "springs"])
def test_a_law_of_ones_own_is_the_element_that_it_describes(model, ground):
    values = 0.5 * STIFF, 0.06 * WEIGHT, 0.03
    runs = [
        rf.simulate(rf.Restrained(FRAME, kind(*values)), SHORT, model, ground=GROUNDS[ground])
        for kind in (rf.YieldingDissipator, Fuse)
    ]
    assert runs[0].n_uplifts == runs[1].n_uplifts
    for name in ("max_rotation", "max_top_displacement", "max_base_moment"):
        assert getattr(runs[1], name) == pytest.approx(getattr(runs[0], name), rel=1e-8)
    np.testing.assert_allclose(runs[1].element_energy, runs[0].element_energy, rtol=1e-8)
    np.testing.assert_allclose(runs[1].max_element_force, runs[0].max_element_force, rtol=1e-8)
    assert Fuse(*values).locked_force == pytest.approx((1.0 - values[2]) * values[1])


def test_an_energy_that_is_no_energy_is_refused():
    with pytest.raises(rf.InputError, match="stored") as caught:
        Fuse(1e7, 1e5, 0.05, share=40.0)
    assert caught.value.field == "stored_energy"


def test_laws_travel_to_other_processes():
    again = pickle.loads(pickle.dumps(FLAGS[0]))
    assert again == FLAGS[0]
    assert again.slow_force(0.02) == FLAGS[0].slow_force(0.02)
