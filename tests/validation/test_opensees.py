"""rockflex against OpenSees, and against Newton's law for each mass; see docs/design/0009-validation.md.

What needs OpenSeesPy is skipped where it cannot be imported. The full tables come from validation/opensees/run.py.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf

sys.path.insert(0, str(Path(__file__).parents[2] / "validation" / "opensees"))

from first_excursion import complete, crossing, pulse, simplified
from fixed_base import fixed_errors, modal_differences
from frames import FLEXURE, SHEAR, Contact, linear, load_opensees
from later_cycles import CASES, impact_share, later_cycles
from newton import by_newton
from references import absolute_damping, reference
from speed import speeds
from springs import DAMPED_GROUND, PARALLEL_GROUND, STIFF_GROUND, compare, explained, speeds_on_springs
from stepping import Scheme, march, settle
from yielding import stories, yielding

try:
    load_opensees()
    MISSING = ""
except ImportError as error:
    MISSING = str(error)
needs_opensees = pytest.mark.skipif(MISSING != "", reason=MISSING)
both = pytest.mark.parametrize("prototype", [SHEAR, FLEXURE], ids=lambda each: each.name)


def difference(mine, other):
    """Largest difference of θ over θ_max between two excursions, and of their uplift times in s."""
    at = np.linspace(max(mine.uplift, other.uplift), min(mine.impact, other.impact), 1000)[1:-1]
    theta = np.abs(mine.motion(at)[0] - other.motion(at)[0]).max() / mine.largest[0]
    return theta, abs(mine.uplift - other.uplift)


@pytest.mark.slow
@both
def test_mdof_c_is_newton_s_law_for_its_kinematics(prototype):
    # Cartesian positions of each mass, no modes, an event where the base would turn upwards. Its steps, a thousand or
    # more, err by 1e-9 each.
    theta, uplift = difference(
        reference(prototype.structure(second_order=True), "MDOF-C", pulse()),
        by_newton(prototype, pulse(), shortening=False),
    )
    assert theta < 1e-5
    assert uplift < 1e-7


@pytest.mark.slow
def test_mdof_s_is_the_plain_integration_without_damping():
    theta, uplift = difference(reference(SHEAR.structure(), "MDOF-S", pulse()), absolute_damping(SHEAR, pulse(), 0.0))
    assert theta < 1e-6
    assert uplift < 1e-7


def test_columns_that_shorten_change_the_excursion_by_percents():
    complete_model = reference(SHEAR.structure(second_order=True), "MDOF-C", pulse())
    theta, _ = difference(complete_model, by_newton(SHEAR, pulse(), shortening=True))
    assert 0.01 < theta < 0.1


@both
def test_an_impact_takes_the_vertical_energy_alone(prototype):
    p = prototype.frame().rocking()
    assert impact_share(prototype) == pytest.approx(p.m_tot * p.half_width**2 / p.i_theta, rel=1e-10)


@needs_opensees
@both
def test_modes_agree_to_rounding(prototype):
    assert max(modal_differences(prototype).values()) < 1e-11


@needs_opensees
@both
def test_held_base_converges_with_the_square_of_the_step(prototype):
    record = rf.load_suite("el-centro-1940")[0]
    short = rf.GroundMotion(record.acceleration[:400], record.dt, name="8 s")
    coarse, fine, finest = fixed_errors(prototype, short, (16, 32, 128))
    for k in range(3):
        assert 3.0 < coarse.history[k] / fine.history[k] < 5.0
        assert finest.history[k] < 1e-4
        assert abs(finest.peak[k]) < 1e-4


@needs_opensees
@both
def test_first_excursion_converges_with_the_contact_s_stiffness(prototype):
    soft, stiff, stiffest = simplified(prototype, pulse(), [(1e10, 5e-4), (1e11, 5e-4), (1e13, 2e-4)])
    assert 7.0 < soft.rotation / stiff.rotation < 13.0
    assert 5.0 < soft.uplift / stiff.uplift < 20.0
    assert stiffest.rotation < 2e-4
    assert stiffest.top < 8e-4
    assert abs(stiffest.peak) < 5e-5
    assert abs(stiffest.uplift) < 1e-4
    assert abs(stiffest.impact) < 1e-4


@needs_opensees
def test_the_weight_s_moment_is_needed():
    # Without the spring of -L_0^r g the comparison fails: what agrees is not for want of sensitivity.
    (whole,) = simplified(SHEAR, pulse(), [(1e12, 5e-4)])
    (lacking,) = simplified(SHEAR, pulse(), [(1e12, 5e-4)], gravity_spring=False)
    assert abs(whole.peak) < 5e-4
    assert lacking.peak < -0.04


@needs_opensees
@both
def test_damping_by_stiffness_agrees_modal_damping_is_another(prototype):
    case = [(1e13, 5e-4)]
    (by_stiffness,) = simplified(prototype, pulse(), case, ("stiffness", 0.015))
    assert by_stiffness.rotation < 1e-4
    (modal,) = simplified(prototype, pulse(), case, ("modal", 0.02))
    (explained,) = simplified(prototype, pulse(), case, ("modal", 0.02), like_opensees=True)
    assert modal.rotation > 0.1
    assert explained.rotation < 5e-4


@needs_opensees
def test_stories_that_yield_under_leaning_mass_converge_with_the_contact_s_stiffness():
    # Average acceleration errs by the square of the step, contact by the inverse of its stiffness.
    soft, stiff = yielding(pulse(), [(1e11, 5e-4), (1e13, 2e-4)])
    assert (stiff.ductility > 1.2).all()
    assert stiff.excursion.rotation < 2e-4
    assert stiff.excursion.rotation < 0.1 * soft.excursion.rotation
    assert stiff.excursion.top < 5e-4
    assert stiff.drift < 5e-4
    assert abs(stiff.excursion.uplift) < 1e-4
    assert abs(stiff.excursion.impact) < 1e-4
    # Hinged columns that carry the leaning weight add P-Δ of the drifts and their push on the floors.
    (columns,) = yielding(pulse(), [(1e13, 5e-4)], columns=True)
    assert 0.01 < columns.excursion.rotation < 0.1
    assert columns.drift < 0.3


def test_the_stories_compared_are_those_of_the_prototype():
    structure = stories()
    assert structure.rocking().leaning_mass == 100e3
    assert structure.rocking().m_tot == SHEAR.frame().rocking().m_tot


@needs_opensees
@both
def test_large_rotations_are_those_of_columns_that_shorten(prototype):
    case = [(1e12, 5e-4)]
    (model,) = complete(prototype, pulse(), case)
    (explained,) = complete(prototype, pulse(), case, like_opensees=True)
    assert 0.005 < model.rotation < 0.05
    assert explained.rotation < 2.5e-3
    assert abs(explained.peak) < 5e-4


@needs_opensees
def test_an_absorbing_contact_is_vvel_an_elastic_one_bounces():
    record = rf.load_suite("el-centro-1940")[0]
    cases = tuple(case for case in CASES if case.contact.stiffness == 1e11 and case.scheme.dt == 2.5e-4)
    elastic, absorbing = later_cycles(SHEAR, record, 0.02, cases, (5.0, 8.0))
    assert elastic.case.name == "elastic"
    assert elastic.rebound == pytest.approx(1.0, abs=0.05)
    assert absorbing.rebound < 0.3
    assert absorbing.errors[-1] < 0.01 < 0.03 < elastic.errors[1]


@needs_opensees
@both
def test_two_springs_without_dashpots_are_the_same_law(prototype):
    coarse, fine = compare(prototype, pulse(), [(STIFF_GROUND, 2e-3), (STIFF_GROUND, 5e-4)])
    assert abs(fine.late) < 1e-5
    assert abs(fine.peak) < 5e-5
    assert fine.rotation < 5e-4
    assert abs(coarse.peak) < 1e-3
    assert coarse.rotation > 3.0 * fine.rotation


@needs_opensees
@both
def test_a_dashpot_behind_a_contact_is_nearly_the_same_one_beside_it_pulls(prototype):
    series, parallel = compare(prototype, pulse(), [(DAMPED_GROUND, 5e-4), (PARALLEL_GROUND, 1e-3)])
    assert abs(series.late) < 1e-4
    assert abs(series.peak) < 1e-3
    assert series.rotation < 2e-3
    assert parallel.peak < -0.1


@needs_opensees
def test_a_footing_that_is_left_behind_explains_the_difference():
    motion = pulse()
    (series,) = compare(SHEAR, motion, [(DAMPED_GROUND, 5e-4)])
    peak, rotation = explained(SHEAR, motion, DAMPED_GROUND, 5e-4)
    assert abs(peak) < 2e-5
    assert rotation < 0.3 * series.rotation


@needs_opensees
def test_speeds_on_springs_name_the_largest_step_that_meets_the_target():
    (found,) = speeds_on_springs(SHEAR, (1e-3,), (1e-2, 1e-3))
    assert found.dt == 1e-3
    assert abs(found.error) < 1e-3
    assert speeds_on_springs(SHEAR, (1e-12,), (1e-2,)) == []


@needs_opensees
def test_speeds_name_the_grid_s_fastest_that_meets_the_target():
    (found,) = speeds(SHEAR, (1e-3,), [(1e12, 1e-3), (1e9, 1e-2)], ("MDOF-S",))
    assert (found.contact, found.dt) == (1e12, 1e-3)
    assert abs(found.error) < 1e-3
    assert found.ratio == pytest.approx(found.opensees / found.rockflex)
    assert speeds(SHEAR, (1e-12,), [(1e10, 1e-2)], ("MDOF-S",)) == []


def test_without_opensees_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "openseespy", None)
    monkeypatch.setitem(sys.modules, "openseespy.opensees", None)
    with pytest.raises(ImportError, match=r"pip install openseespy.*apt-get install libblas3 liblapack3"):
        load_opensees()


def test_a_crossing_is_on_the_chord_and_must_exist():
    assert crossing(np.array([0.0, 1.0, 2.0]), np.array([-2.0, -1.0, 3.0]), 0) == pytest.approx(1.25)
    with pytest.raises(RuntimeError, match="never did what was looked for"):
        crossing(np.array([0.0, 1.0]), np.array([-2.0, -1.0]), 0)


@needs_opensees
def test_a_run_that_does_not_converge_says_so():
    ops = load_opensees()
    linear(ops, SHEAR, Contact(1e10))
    settle(ops)
    # Displacements so large that their rounding exceeds the tolerance.
    with pytest.raises(RuntimeError, match=r"The analysis at t = [\d.]+ s did not converge in OpenSees \(code -3\)"):
        march(ops, pulse().scaled(1e12), 5.0, Scheme(1e-3))
