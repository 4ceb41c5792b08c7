"""What a response says of the elements between base and ground: forces, elongations, peaks and what is left."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model
from rockflex.response._peaks import tracked_quantities

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:500] * 2.5, 0.02)
FRAME = make_frame(
    n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0, damping_ratio=0.02
)
FUSES = [rf.YieldingDissipator(20.7e6, 172e3, 0.05, -0.771), rf.YieldingDissipator(20.7e6, 172e3, 0.0, 0.5)]
HOOKS = [rf.YieldingDissipator(20.7e6, 172e3, 0.05, x, tension_only=True) for x in (-0.771, 0.771)]
TENDONS = [rf.Tendon(434e3, 29.8e6, 0.0, 508e3, 0.01), rf.Tendon(90e3, 20e6, 0.6, 148e3, 0.02)]
DAMPERS = [rf.ViscousDamper(78.5e3, -0.883), rf.ViscousDamper(178.5e3, 0.3)]
MIXED = [*FUSES, *HOOKS, *TENDONS, *DAMPERS]


def held(elements, eccentricity=0.0):
    return rf.Restrained(rf.Eccentric(FRAME, eccentricity) if eccentricity else FRAME, elements)


def followed(element, delta):
    """Force and plastic stretch of a bar along a path of elongations, each step of which goes one way."""
    k, a, reach = element.stiffness, element.post_yield_ratio, element.yield_force / element.stiffness
    tendon = isinstance(element, rf.Tendon)
    pulls_only = tendon or element.tension_only
    plastic, force, path = 0.0, [], []
    for e in delta + (element.initial_force / k if tendon else 0.0):
        if e - plastic > reach:
            plastic = e - reach
        elif e - plastic < -reach and not (pulls_only and a * plastic <= reach):
            plastic = e + reach
        pull = a * k * e + (1.0 - a) * k * (e - plastic)
        force.append(max(pull, 0.0) if pulls_only else pull)
        path.append(plastic)
    return np.array(force), np.array(path)


@pytest.fixture(scope="module", params=[0.0, 0.3, -0.31], ids=lambda e: f"e={e}")
def run(request):
    return rf.simulate(held(MIXED, request.param), MOTION, "MDOF-S", free_vibration=3.0)


def test_elongations_are_distances_times_the_rotation(run):
    p = run.history.model.properties
    for place, each in enumerate(p.elements):
        right, left = p.pivot(1).arm - each.position, p.pivot(-1).arm + each.position
        delta = np.where(run.rotation < 0.0, left, right) * np.abs(run.rotation)
        np.testing.assert_allclose(run.element_elongation[:, place], delta, atol=1e-18)
    assert run.element_elongation.shape == (run.time.size, len(p.elements))


def test_forces_are_those_of_bars_followed_step_by_step(run):
    """Turning points are states of the history, so that a bar can be followed from state to state."""
    elements = run.history.model.properties.elements
    for place, each in enumerate(elements[:6]):
        force, plastic = followed(each, run.element_elongation[:, place])
        np.testing.assert_allclose(run.element_force[:, place], force, atol=1e-6 * each.yield_force)
        assert run.max_element_force[place] == pytest.approx(np.abs(force).max(), rel=1e-9)
        assert run.max_element_elongation[place] == pytest.approx(np.abs(run.element_elongation[:, place]).max())
        assert run.element_yielded[place] == plastic.any() == True  # noqa: E712
        if isinstance(each, rf.Tendon):
            lost = (1.0 - each.post_yield_ratio) * each.stiffness * plastic[-1]
            left = max(each.initial_force - lost, 0.0)
            assert run.remaining_prestress[place - 4] == pytest.approx(left, abs=1e-3)
    assert np.array_equal(run.tendon_force, run.element_force[:, 4:6])
    assert (run.element_force[:, 2:6] >= -1e-6).all()
    assert (run.element_force[:, 0] < -0.9 * 172e3).any()  # a fuse pushes the base up


def test_peaks_of_dampers_are_those_between_the_samples(run):
    p = run.history.model.properties
    fine = rf.simulate(p, MOTION.refined(20), "MDOF-S", free_vibration=3.0)
    for place, each in list(enumerate(p.elements))[6:]:
        largest = np.abs(fine.element_force[:, place]).max()
        assert largest <= run.max_element_force[place] * (1.0 + 1e-9)
        assert run.max_element_force[place] == pytest.approx(largest, rel=1e-3)
        right, left = p.pivot(1).arm - each.position, p.pivot(-1).arm + each.position
        arm = np.where(run.side < 0.0, left, right)
        force = each.coefficient * arm * run.side * run.rotation_velocity
        np.testing.assert_allclose(run.element_force[:, place], force, atol=1e-6)
        assert not run.element_yielded[place]


def test_peaks_alone_are_the_same(run):
    p = run.history.model.properties
    alone = rf.simulate(p, MOTION, "MDOF-S", free_vibration=3.0, output="peaks")
    for name in ("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress"):
        np.testing.assert_allclose(getattr(alone, name), getattr(run, name), rtol=1e-12)
        assert not getattr(alone, name).flags.writeable
    assert alone.residual_rotation == run.residual_rotation == run.rotation[-1]
    assert (alone.tendon_yield, alone.tendon_overload) == (True, False)
    assert alone.max_tendon_force == alone.max_element_force[4:6].max()
    utilisation = max(alone.max_element_force[4] / 508e3, alone.max_element_force[5] / 148e3)
    assert alone.tendon_utilisation == pytest.approx(utilisation, rel=1e-14)
    assert run.warnings == alone.warnings


def test_a_base_with_one_element_off_its_axis_knows_both_sides():
    """The mirror image of a motion moves an element as its own mirror image was moved."""
    one, other = rf.YieldingDissipator(20.7e6, 172e3, 0.05, 0.6), rf.YieldingDissipator(20.7e6, 172e3, 0.05, -0.6)
    run = rf.simulate(held([one, other]), MOTION, "2DOF-S", output="peaks")
    back = rf.simulate(held([one, other]), MOTION.scaled(-1.0), "2DOF-S", output="peaks")
    np.testing.assert_allclose(run.max_element_force, back.max_element_force[::-1], rtol=1e-9)
    assert run.max_element_elongation[0] != pytest.approx(run.max_element_elongation[1], rel=1e-3)


@pytest.mark.parametrize("elements", [(), TENDONS[:1], [rf.Tendon(1e5, 1e6)]], ids=["none", "yields", "elastic"])
def test_no_rows_are_added_for_what_follows_from_the_rotation(elements):
    model = parse_model("MDOF-S").of(held(elements).rocking() if elements else FRAME.rocking())
    assert len(tracked_quantities(model).peaks.quantities) == 5


def test_without_elements_there_is_nothing():
    run = rf.simulate(FRAME, MOTION, "2DOF-S", free_vibration=1.0)
    for name in ("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress"):
        assert getattr(run, name).shape == (0,)
    assert run.element_force.shape == run.element_elongation.shape == (run.time.size, 0)
    assert run.element_energy.shape == (0,)
    assert not run.tendon_yield
    assert not run.tendon_overload


def test_a_run_that_overturns_has_no_residual_rotation():
    run = rf.simulate(FRAME, MOTION.scaled(8.0), "2DOF-S", output="peaks")
    assert run.status == "overturned"
    assert np.isnan(run.residual_rotation)
    start = rf.InitialState(rotation=0.01)
    still = rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-S", initial=start)
    assert 0.0 < still.residual_rotation == still.rotation[-1] < 0.01


def test_only_tendons_that_cannot_yield_are_overloaded():
    elastic, yields = (rf.Tendon(434e3, 29.8e6, 0.0, 508e3, ratio) for ratio in (None, 0.02))
    over = rf.simulate(held([elastic]), MOTION, "2DOF-S", output="peaks")
    assert (over.tendon_yield, over.tendon_overload, over.element_yielded.tolist()) == (True, True, [True])
    assert over.remaining_prestress.tolist() == [434e3]
    assert over.warnings[-1] == (
        f"A tendon carries more than its yield force, up to {over.tendon_utilisation:.4g} times it. It stays elastic "
        "in the model, so the results are not valid. Give it a post_yield_ratio."
    )
    fine = rf.simulate(held([yields]), MOTION, "2DOF-S", output="peaks")
    assert (fine.tendon_yield, fine.tendon_overload) == (True, False)
    assert not any("tendon" in each for each in fine.warnings)
    assert fine.tendon_utilisation > 1.0
    calm = rf.simulate(held([elastic]), MOTION.scaled(0.3), "2DOF-S", output="peaks")
    assert (calm.tendon_yield, calm.tendon_overload) == (False, False)


def test_the_vertical_reaction_holds_the_pull_of_all_elements(run):
    p = run.history.model.properties
    contact = (run.side == 0.0) & (run.rotation_acceleration == 0.0)
    expected = p.m_tot * 9.81 + run.element_force[contact].sum(axis=1)
    np.testing.assert_allclose(run.vertical_reaction[contact], expected, rtol=1e-12)
    fine = rf.simulate(p, MOTION.refined(40), "MDOF-S", free_vibration=3.0).vertical_reaction.min()
    assert run.min_vertical_reaction <= fine * (1.0 + 1e-9)
    assert run.min_vertical_reaction == pytest.approx(fine, abs=0.01 * p.m_tot * 9.81)


def test_tables_hold_what_is_left():
    table = rf.simulate_many([held(MIXED), FRAME], MOTION, ["2DOF-S"])
    run = rf.simulate(held(MIXED), MOTION, "2DOF-S", output="peaks")
    row = table.iloc[0]
    assert row["residual_rotation"] == run.residual_rotation
    assert (row["tendon_yield"], row["tendon_overload"]) == (True, False)
    assert table["tendon_yield"].dtype == "boolean"
    kept = rf.run_cloud({"held": held(MIXED), "free": FRAME}, {"a": MOTION}, "2DOF-S", scales=[1.0])
    assert kept["residual_rotation"].tolist() == table["residual_rotation"].tolist()
    elastic = rf.run_cloud({"held": held(rf.Tendon(1e5, 1e6))}, {"a": MOTION}, "2DOF-S", scales=[1.0])
    assert not {"residual_rotation", "tendon_yield"} & set(elastic.columns)


@pytest.mark.parametrize("model", ["2DOF-C", "rigid-C"])
def test_complete_models_have_the_true_elongation(model):
    elements = [rf.Tendon(434e3, 2.98e6), rf.Tendon(90e3, 2e6, 0.6)]
    run = rf.simulate(held(elements), MOTION, model)
    theta, half = run.rotation, FRAME.rocking().half_width
    for place, each in enumerate(elements):
        chord = np.abs(np.exp(1j * theta) - 1.0) * (half - np.sign(theta) * each.position)
        np.testing.assert_allclose(run.element_elongation[:, place], chord, atol=1e-16)
        np.testing.assert_allclose(run.element_force[:, place], each.initial_force + each.stiffness * chord)
    assert np.abs(theta).max() > 0.005
    assert not run.element_energy.any()


def test_peaks_of_dampers_at_large_rotations():
    structure = held(DAMPERS, 0.3)
    run = rf.simulate(structure, MOTION, "2DOF-C", output="peaks")
    fine = rf.simulate(structure, MOTION.refined(20), "2DOF-C")
    theta, p = fine.rotation, fine.history.model.properties
    for place, each in enumerate(DAMPERS):
        right, left = p.pivot(1).arm - each.position, p.pivot(-1).arm + each.position
        rate = np.where(fine.side < 0.0, left, right) * np.cos(0.5 * theta) * np.abs(fine.rotation_velocity)
        force = each.coefficient * np.where(fine.side == 0.0, 0.0, rate)
        np.testing.assert_allclose(np.abs(fine.element_force[:, place]), force, atol=1e-6)
        assert force.max() <= run.max_element_force[place] * (1.0 + 1e-9)
        assert run.max_element_force[place] == pytest.approx(force.max(), rel=1e-3)
