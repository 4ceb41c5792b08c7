"""The energy that elements store and dissipate, against closed forms and against the balance."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import simpson

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:500] * 2.5, 0.02)
FRAME = make_frame(
    n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0, damping_ratio=0.02
)
SETS = {
    "fuses": [rf.YieldingDissipator(20.7e6, 172e3, 0.05, x) for x in (-0.771, 0.771)],
    "one fuse": [rf.YieldingDissipator(20.7e6, 172e3, 0.0, 0.5)],
    "hardening fuse": [rf.YieldingDissipator(20.7e6, 172e3, 0.4, -0.5)],
    "hooks": [rf.YieldingDissipator(20.7e6, 172e3, 0.05, x, tension_only=True) for x in (-0.771, 0.4)],
    "tendons": [rf.Tendon(434e3, 29.8e6, 0.0, 508e3, 0.01), rf.Tendon(90e3, 20e6, 0.6, 148e3, 0.02)],
    "stiff tendon": [rf.Tendon(100e3, 29.8e6, 0.5, 148e3, 0.3)],  # yields downwards before it is slack
    "sliders": [rf.FrictionDamper(60e3, x) for x in (-0.7, 0.4)],
    "breaking": [
        rf.YieldingDissipator(20.7e6, 172e3, 0.05, -0.771, rupture_elongation=0.03),
        rf.YieldingDissipator(20.7e6, 172e3, 0.2, 0.5, True, 0.02),
        rf.Tendon(434e3, 29.8e6, 0.0, 508e3, 0.01, 0.012),
    ],
    "dampers": [rf.ViscousDamper(78.5e3, -0.883), rf.ViscousDamper(178.5e3, 0.3)],
}
SETS["all"] = [each for name in ("one fuse", "hooks", "stiff tendon", "sliders", "dampers") for each in SETS[name]]


def held(elements, eccentricity=0.0):
    return rf.Restrained(rf.Eccentric(FRAME, eccentricity) if eccentricity else FRAME, elements)


@pytest.mark.slow
@pytest.mark.parametrize("eccentricity", [0.0, 0.3, -0.31])
@pytest.mark.parametrize("name", list(SETS))
@pytest.mark.parametrize("model", ["MDOF-S", "rigid"])
def test_the_balance_closes(name, eccentricity, model):
    run = rf.simulate(held(SETS[name], eccentricity), MOTION, model, free_vibration=3.0)
    energy = run.energy
    assert run.n_impacts > 10
    assert run.impact_times.size == energy.impact_losses.size == run.n_impacts
    assert energy.closing_error < 1e-10
    assert energy.elements.shape == (run.time.size, len(SETS[name]))
    assert (np.diff(energy.elements, axis=0) >= 0.0).all()
    assert (energy.elements[-1] > 0.01 * np.abs(energy.input).max() / len(SETS[name])).all()
    assert np.array_equal(run.element_energy, energy.elements[-1])
    assert energy.tendons is energy.element_strain


@pytest.mark.parametrize("name", [name for name in SETS if name not in ("sliders", "all")])
@pytest.mark.parametrize("model", ["2DOF-C", "MDOF-C-SI"])
def test_the_balance_of_large_rotations_closes(name, model):
    run = rf.simulate(held(SETS[name], 0.3), MOTION, model, free_vibration=3.0)
    assert run.impact_times.size == run.n_impacts > 10
    assert run.energy.closing_error < 1e-9
    assert (np.diff(run.energy.elements, axis=0) >= 0.0).all()
    assert (run.element_energy > 0.0).all()


def test_a_friction_damper_takes_its_force_times_the_way_it_slides():
    (slider,) = sliders = [rf.FrictionDamper(90e3, 0.4)]
    run = rf.simulate(held(sliders), MOTION, "2DOF-S", free_vibration=3.0)
    way = np.abs(np.diff(run.element_elongation[:, 0])).sum()
    assert run.element_energy[0] == pytest.approx(slider.force * way, rel=1e-12)
    assert np.abs(run.element_force).max() <= slider.force == run.max_element_force[0]
    assert (np.abs(run.element_force[run.side != 0.0]) > 0.999 * slider.force).mean() > 0.9
    assert run.element_yielded.tolist() == [True]


def test_what_breaks_gives_away_what_it_stored():
    bar = rf.YieldingDissipator(20.7e6, 172e3, 0.2, 0.0, rupture_elongation=0.02)
    run = rf.simulate(held([bar]), MOTION, "2DOF-S")
    k = int(np.flatnonzero(run.element_elongation[:, 0] >= 0.02 * (1.0 - 1e-12))[0])
    assert run.element_force[k, 0] == pytest.approx(run.max_element_force[0], rel=1e-9)
    assert not run.element_force[k + 1 :].any()
    reach = bar.yield_force / bar.stiffness
    largest = 0.2 * bar.stiffness * 0.02 + 0.8 * bar.yield_force
    assert run.max_element_force[0] == pytest.approx(largest, rel=1e-12)
    assert run.max_element_elongation[0] > 0.02
    stored = largest**2 / (2.0 * bar.stiffness) + 0.5 * 0.2 * 0.8 * bar.stiffness * (0.02 - reach) ** 2
    assert run.energy.elements[k + 1, 0] - run.energy.elements[k, 0] == pytest.approx(stored, rel=1e-9)
    assert run.energy.element_strain[k + 1] == pytest.approx(0.0, abs=1e-9)


def test_a_tendon_that_went_slack_gave_its_energy_back():
    tendon = SETS["tendons"][1]
    run = rf.simulate(held([tendon]), MOTION, "2DOF-S", free_vibration=3.0)
    assert (run.element_force[run.side != 0.0] == 0.0).any()
    assert run.remaining_prestress[0] == 0.0
    k, a = tendon.stiffness, tendon.post_yield_ratio
    plastic = run.max_element_elongation[0] + (tendon.initial_force - tendon.yield_force) / k
    locked = 0.5 * a * (1.0 - a) * k * plastic**2  # between the two springs
    assert run.energy.element_strain[-1] == pytest.approx(locked - tendon.initial_force**2 / (2.0 * k), rel=1e-9)
    # It yields only as it is stretched, and its plastic stretch never returns.
    assert run.element_energy[0] == pytest.approx((1.0 - a) * tendon.yield_force * plastic, rel=1e-12)


def test_a_fuse_stretched_once_dissipates_both_ways():
    """The first excursion stretches it to δ and back to zero: F_y (δ - δ_y) and F_y (δ - 2 δ_y)."""
    fuse = rf.YieldingDissipator(50e6, 20e3)
    run = rf.simulate(held([fuse]), rf.one_sine_pulse(6.0, 0.5), "2DOF-S")
    k = int(np.flatnonzero((run.side[:-1] != 0.0) & (run.side[1:] == 0.0))[0])
    delta, at_yield = run.element_elongation[:k].max(), fuse.yield_force / fuse.stiffness
    assert delta > 3.0 * at_yield
    expected = fuse.yield_force * (2.0 * delta - 3.0 * at_yield)
    assert run.energy.elements[k, 0] == pytest.approx(expected, rel=1e-10)
    # Loop area: the work of its force, of which only what it stores is not lost.
    work = np.trapezoid(run.element_force[: k + 1, 0], run.element_elongation[: k + 1, 0])
    stored = 0.5 * fuse.yield_force**2 / fuse.stiffness
    assert work == pytest.approx(expected + stored, rel=1e-3)


def test_a_full_cycle_of_a_fuse():
    """Beyond the edge of an eccentric base a fuse is stretched to one side and shortened to the other."""
    fuse = rf.YieldingDissipator(50e6, 20e3, 0.0, -1.5)
    base = rf.RockingProperties(
        [], [], [], [], i_theta=2e6, l0r=4e5, m_tot=1e5, half_width=1.0, zeta=[], elements=fuse, eccentricity=-0.5
    )
    model = parse_model("rigid").of(base)
    assert base.pivot(-1).arm + fuse.position == pytest.approx(-1.0)
    arms, reach, delta = {1: base.pivot(1).arm + 1.5, -1: 1.0}, fuse.yield_force / fuse.stiffness, 0.004
    rows, memory = [], 0.0

    def at(stretch, side, remembers):
        rows.append([len(rows), side, 0.0, 0.0, stretch / arms[side], 0.0, remembers])

    for _ in range(2):
        for side in (1, -1):
            peak, left = side * delta, side * (delta - reach)
            at(0.0, side, memory)
            at(memory + side * reach, side, memory)
            at(peak, side, memory)
            at(peak, side, left)
            at(left - side * reach, side, left)
            at(0.0, side, left)
            at(0.0, side, side * reach)
            memory = side * reach
    history = rf.History(model, np.array(rows))
    taken = history.energy.elements[:, 0]
    assert taken[-1] - taken[len(rows) // 2] == pytest.approx(4.0 * fuse.yield_force * (delta - reach), rel=1e-12)
    assert history.element_elongation.min() == pytest.approx(-delta)


def test_dampers_take_the_integral_of_their_power():
    fine = MOTION.refined(50)
    run = rf.simulate(held(SETS["dampers"]), fine, "MDOF-S")
    speed = run.element_force / np.array([each.coefficient for each in SETS["dampers"]])
    edges = [0, *(np.flatnonzero(np.diff(run.time) == 0.0) + 1), run.time.size]
    for place in range(2):
        power = run.element_force[:, place] * speed[:, place]
        pieces = [slice(a, b) for a, b in pairwise(edges) if b - a > 2]
        work = sum(simpson(power[piece], x=run.time[piece]) for piece in pieces)
        assert run.element_energy[place] == pytest.approx(work, rel=1e-5)


def test_the_friction_demand_knows_the_branches():
    """Between the states of a history, too: it is that of a finer record."""
    structure = held(SETS["fuses"] + SETS["hooks"])
    run = rf.simulate(structure, MOTION, "2DOF-S")
    fine = rf.simulate(structure, MOTION.refined(40), "2DOF-S")
    assert run.required_friction == pytest.approx(fine.friction_demand.max(), rel=1e-3)
