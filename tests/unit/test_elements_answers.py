"""What elements answer of themselves: those of rockflex, and a user's own, which is asked the same."""

import re
from dataclasses import dataclass, field, replace

import pytest

import rockflex as rf
from builders import fuse_branches, fuse_energy, make_frame
from drawing import drawn
from rockflex.structure._base_element import BaseElement
from rockflex.structure._branches import ElementTension, WithoutMemory

FRAME = make_frame(n_stories=2, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)
K, LIMIT, RATIO, BREAKS = 2e7, 150e3, 0.04, 0.05
FUSE = rf.YieldingDissipator(K, LIMIT, RATIO, 0.3, rupture_elongation=BREAKS)
BUILT_IN = [
    rf.Tendon(100e3, 5e6),
    rf.Tendon(100e3, 5e6, 0.0, 150e3, 0.02, 0.06),
    FUSE,
    rf.YieldingDissipator(K, LIMIT, RATIO, tension_only=True),
    rf.ViscousDamper(3e5),
    rf.FrictionDamper(40e3),
    rf.FrictionDamper(0.0),
    rf.FlagShapedBar(K, LIMIT, RATIO, 0.8),
    rf.GapBar(K, 0.01),
]


@dataclass(frozen=True)
class SteelBar(rf.ElementLaw):
    """The law of `FUSE`, as a user would write it, who also says what else it has of a fuse."""

    title = "Steel bar"
    symbol = "fuse"
    fuse = True

    stiffness: float = field(metadata={"description": "the stiffness", "unit": "N/m"})
    yield_force: float = field(metadata={"description": "the yield force", "unit": "N"})
    ratio: float
    position: float = 0.0
    rupture_elongation: float | None = None

    def branches(self):
        return fuse_branches(self)

    def stored_energy(self, elongation, internal):
        return fuse_energy(self, elongation, internal)

    @property
    def dissipator_force(self):
        return self.yield_force

    def scaled(self, factor, *, size):
        stiffness = self.stiffness * (factor if size else 1.0)
        return replace(self, stiffness=stiffness, yield_force=self.yield_force * factor) if factor else None


@dataclass(frozen=True)
class BufferBranch(WithoutMemory):
    stiffness: float
    coefficient: float
    position: float | None
    rate_dependent = True

    def tension(self, branch):
        return ElementTension(self.stiffness, self.coefficient)

    def stored_energy(self, elongation, force, plastic):
        return 0.5 * self.stiffness * elongation**2

    def lost_energy(self, elongation, force, plastic, stored, sweep):
        return self.coefficient * sweep


@dataclass(frozen=True)
class Buffer(BaseElement):
    """A spring with a dashpot beside it, which no branches of an `ElementLaw` give."""

    stiffness: float
    coefficient: float
    position: float = 0.0
    rate_dependent = dissipates = True

    @property
    def largest_stiffness(self):
        return self.stiffness

    def branched(self):
        return BufferBranch(self.stiffness, self.coefficient, self.place)

    def slow_force(self, elongation):
        return self.stiffness * elongation

    def extremes(self, low, high, speed=0.0):
        return self.stiffness * max(high, -low) + self.coefficient * speed, False


BAR = SteelBar(K, LIMIT, RATIO, 0.3, rupture_elongation=BREAKS)


def test_a_law_of_ones_own_answers_as_the_element_that_it_describes():
    for elongation in (-0.03, -0.004, 0.004, 0.03):
        assert BAR.slow_force(elongation) == pytest.approx(FUSE.slow_force(elongation), rel=1e-12)
    largest, yields = BAR.extremes(0.0, 0.03)
    assert (largest, yields) == (pytest.approx(FUSE.extremes(0.0, 0.03)[0], rel=1e-12), True)
    assert BAR.extremes(-0.004, 0.004)[1] is FUSE.extremes(-0.004, 0.004)[1] is False
    assert BAR.locked_force == pytest.approx(FUSE.locked_force, rel=1e-12)
    names = ("dissipates", "recentres", "sticks", "breaks_at", "dissipator_force", "largest_stiffness", "force_at_rest")
    for name in (*names, "fuse", "symbol", "prestressed", "rate_dependent", "restoring_stiffness"):
        assert getattr(BAR, name) == getattr(FUSE, name), name


def test_reports_and_figures_name_it_with_symbols_and_units(tmp_path):
    assert BAR.words == "steel bar"
    held = rf.Restrained(FRAME, [BAR, rf.FlagShapedBar(K, LIMIT, RATIO, 0.8)])
    figure = drawn(rf.plot_loops(rf.moment_rotation(held, [0.01, 0.0])))
    assert figure.axes[1].get_title() == "1 steel bar, x = 0.3 m"
    page = rf.write_report(rf.simulate(held, PULSE, "2DOF-S"), tmp_path / "run.html").read_text("utf-8")
    row = "k = 20.0 MN/m, Fy = 150 kN, ratio = 0.04, breaks at 50.0 mm"
    for text in ("1 steel bar", row, "2 flag-shaped bar", "flag depth = 0.8"):
        assert text in re.sub(r"<[^>]++>", "", page), text


def test_checks_have_its_strain_and_its_rupture():
    runs = [rf.simulate(rf.Restrained(FRAME, each), PULSE, "2DOF-S") for each in (BAR, FUSE)]
    own, known = ({row.name: row for row in rf.check(run, rf.CheckLimits(fuse_strain=0.03, fuse_length=0.5)).rows}
                  for run in runs)  # fmt: skip
    for name in ("fuse strain", "rupture"):
        assert own[name].ratio == pytest.approx(known[name].ratio, rel=1e-9)


@pytest.mark.parametrize("scaling", ["size", "force"])
def test_a_search_for_a_design_varies_it(scaling):
    half_width = FRAME.rocking().half_width
    space = rf.DesignSearch([half_width], dissipator_factors=[0.0, 2.0], refinements=0, dissipator_scaling=scaling)
    own, known = (rf.Restrained(FRAME, each).rocking() for each in (BAR, FUSE))
    space.check_elements(own)
    assert space.built(own, (0, 0, 0)).elements == ()
    (made,), (wanted,) = (space.built(each, (0, 0, 1)).elements for each in (own, known))
    assert isinstance(made, SteelBar)
    assert (made.yield_force, made.stiffness) == (wanted.yield_force, wanted.stiffness)
    assert made.stiffness == (2.0 if scaling == "size" else 1.0) * K


def test_what_is_no_dissipator_is_not_varied():
    space = rf.DesignSearch([FRAME.rocking().half_width], dissipator_factors=[1.0, 2.0], refinements=0)
    for each in (rf.ViscousDamper(3e5), rf.GapBar(K, 0.01), rf.Tendon(100e3, 5e6)):
        with pytest.raises(rf.InputError, match="dissipator"):
            space.check_elements(rf.Restrained(FRAME, each).rocking())


@pytest.mark.parametrize("element", BUILT_IN, ids=lambda each: each.words)
def test_answers_fit_together(element):
    if not element.sticks:  # from rest a friction damper has the force of the first movement
        assert element.slow_force(0.0) == element.force_at_rest
    assert element.slow_force(element.breaks_at if element.breaks_at < 1.0 else 0.0) in (0.0, element.slow_force(0.0))
    assert element.extremes(0.0, 0.0, 0.0) == (element.force_at_rest, False)
    assert element.prestressed == isinstance(element, rf.Tendon) == (element.restoring_stiffness > 0.0)
    assert not (element.recentres and element.locked_force)
    assert element.branched().friction == (element.dissipator_force if element.sticks else 0.0)
    if element.prestressed or element.dissipator_force is not None:
        assert element.scaled(0.0, size=True) is None
        twice = element.scaled(2.0, size=True)
        assert twice.slow_force(0.004) == pytest.approx(2.0 * element.slow_force(0.004), rel=1e-12)
    else:
        assert element.scaled(0.0, size=True) is element


GROUNDS = [None, rf.Ground(friction=0.5), rf.Ground(springs=rf.Springs([-0.5, 0.5], 3e8, 1e6), base_inertia=2e4)]


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C"])
@pytest.mark.parametrize("ground", GROUNDS, ids=["rigid", "sliding", "springs"])
def test_a_new_element_needs_no_more_than_its_answers(model, ground):
    """It is a bar and a damper at the same place, on any ground and in any model."""
    elements = ([Buffer(2e6, 2e5)], [rf.GapBar(2e6, 0.0, both_ways=True), rf.ViscousDamper(2e5)])
    one, two = (rf.simulate(rf.Restrained(FRAME, each), PULSE, model, ground=ground) for each in elements)
    assert one.max_rotation == pytest.approx(two.max_rotation, rel=1e-9)
    assert one.element_energy.sum() == pytest.approx(two.element_energy.sum(), rel=1e-7)
    assert abs(one.energy.residual).max() < 1e-8 * one.energy.input.max()


def test_a_damper_without_force_neither_sticks_nor_slides():
    assert not rf.FrictionDamper(0.0).sticks
    assert rf.simulate(rf.Restrained(FRAME, rf.FrictionDamper(0.0)), PULSE, "2DOF-S").max_rotation == pytest.approx(
        rf.simulate(FRAME, PULSE, "2DOF-S").max_rotation, rel=1e-9
    )
