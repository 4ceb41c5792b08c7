"""How many modes a structure needs: by hand, against the paper's words, and in the cases between."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

import rockflex as rf
from builders import make_frame
from rockflex.structure._uplifted import lowest_uplifted_frequencies

SHEAR, FLEXURE = math.inf, 0.0
NO_LIMIT = {"base_moment": math.inf, "first_frequency": math.inf, "second_frequency": math.inf, "base_shear": math.inf}

LEFT_OUT = (
    "The horizontal ground reaction ΣF_x leaves no mass out: the mass of missing modes moves with the base, as it does "
    "in the base shear of models that end in -R."
)


def frame(n_stories, stiffness_ratio, aspect_ratio, period=1.0):
    return make_frame(n_stories=n_stories, stiffness_ratio=stiffness_ratio, period=period, aspect_ratio=aspect_ratio)


def tower(n_modes=5, method="ritz"):
    return rf.TaperedTower(200, 8, 4, 1, 2400, 25e9, 0.02, method=method, n_modes=n_modes)


def of(structure):
    return rf.adequacy(structure.rocking(), base_mass=getattr(structure, "base_mass", 0.0))


def uplifted(p, k):
    """Uplifted frequencies of the first k modes, by a generalised eigenvalue problem."""
    mass, arm = np.diag([p.i_theta, *p.effective_mass[:k]]), (p.effective_mass * p.effective_height)[:k]
    mass[0, 1:] = mass[1:, 0] = arm
    return np.sqrt(eigh(np.diag([-p.l0r * 9.81, *(p.effective_mass * p.omega**2)[:k]]), mass)[0][1:])


def test_contributions_are_those_of_the_paper():
    """Section 4.1.1: 0.82 and 0.94 of the base moment, 0.51 and 0.71 of the base shear."""
    found = of(tower())
    assert np.cumsum(found.base_moment)[:2] == pytest.approx([0.82, 0.94], abs=5e-3)
    assert np.cumsum(found.base_shear)[:2] == pytest.approx([0.51, 0.71], abs=5e-3)
    np.testing.assert_allclose(found.base_moment_left[:2], [0.18, 0.06], atol=5e-3)
    np.testing.assert_allclose(found.base_shear_left[:2], [0.49, 0.29], atol=5e-3)


@pytest.mark.parametrize("structure", [frame(5, SHEAR, 10.0), frame(5, FLEXURE, 5.0), tower(3)])
def test_frequency_errors_against_an_eigenvalue_solver(structure):
    found, p = of(structure), structure.rocking()
    whole = uplifted(p, p.n_modes)[:2]
    for k in range(1, p.n_modes + 1):
        some = uplifted(p, k)[:2]
        np.testing.assert_allclose(found.frequency_error[k - 1, :k], (some / whole[:k] - 1.0)[:k], atol=1e-8)
    assert np.isnan(found.frequency_error[0, 1])
    assert not np.isnan(found.frequency_error[1:]).any()


def test_opposite_contributions_do_not_make_up_for_each_other():
    found = of(frame(5, SHEAR, 10.0))
    assert np.cumsum(found.base_moment)[0] == pytest.approx(1.03, abs=5e-3)  # Table 1
    assert found.base_moment[1] < 0.0 < found.base_moment[2]
    np.testing.assert_allclose(found.base_moment_left[0], np.abs(found.base_moment[1:]).sum())
    assert found.base_moment_left[0] > abs(1.0 - found.base_moment[0])
    assert found.base_moment_left[-1] == 0.0


@pytest.mark.parametrize(
    ("stiffness_ratio", "aspect_ratio", "model"),
    [
        (SHEAR, 3.0, "2DOF-S"),  # "likely satisfactory" below 5
        (SHEAR, 10.0, "4DOF-S"),  # 2DOF-S "poor", second frequency of 3DOF-S "quite inaccurate"
        (FLEXURE, 5.0, "2DOF-S"),
        (FLEXURE, 10.0, "2DOF-S"),  # "quite good"; "likely satisfactory" below 10
        (FLEXURE, 12.0, "3DOF-S"),
    ],
)
def test_frames_of_section_3_4(stiffness_ratio, aspect_ratio, model):
    assert of(frame(15, stiffness_ratio, aspect_ratio)).model == model


def test_shear_frames_between_the_two_rules_of_section_3_4():
    """The paper takes 2DOF-S up to h*_1/B = 5, with 44 % in the first frequency; a tolerance of 0.45 follows it."""
    p = frame(15, SHEAR, 5.0).rocking()
    found = rf.adequacy(p)
    assert found.frequency_error[0, 0] == pytest.approx(0.443, abs=1e-3)
    assert found.model == "3DOF-S"
    assert rf.adequacy(p, rf.AdequacyTolerance(first_frequency=0.45)).model == "2DOF-S"


@pytest.mark.parametrize(
    ("period", "aspect_ratio", "stiffness_ratio", "model", "model_for_shear"),
    [
        (1.0, 10.0, SHEAR, "4DOF-S", "3DOF-S"),
        (1.0, 10.0, FLEXURE, "2DOF-S", "4DOF-S"),
        (0.5, 10.0, SHEAR, "4DOF-S", "3DOF-S"),
        (0.5, 10.0, FLEXURE, "2DOF-S", "4DOF-S"),
        (1.0, 5.0, SHEAR, "3DOF-S", "3DOF-S"),
        (1.0, 5.0, FLEXURE, "2DOF-S", "4DOF-S"),
    ],
)
def test_structures_of_table_1(period, aspect_ratio, stiffness_ratio, model, model_for_shear):
    found = of(frame(5, stiffness_ratio, aspect_ratio, period))
    assert (found.model, found.model_for_shear) == (model, model_for_shear)


@pytest.mark.parametrize("method", ["ritz", "fe"])
def test_chimney(method):
    found = of(tower(method=method))
    assert found.model == "3DOF-S"
    assert found.model_for_shear is None
    assert found.reference_error.max() < 1e-3


def test_specimens():
    """Section 3.1: 2DOF-S represents 2Hz-Long Base well, and perhaps not S1."""
    assert rf.adequacy(rf.equivalent_2hz_long_base(0.2, 0.02), base_mass=0.2).model == "2DOF-S"
    assert rf.adequacy(rf.equivalent_2hz_long_base(0.2, 0.02), base_mass=0.2).model_for_shear == "2DOF-S"
    assert rf.adequacy(rf.equivalent_s1(0.2, 0.02, 0.2, 0.5), base_mass=0.2).model == "3DOF-S"


@pytest.mark.parametrize("structure", [frame(5, SHEAR, 10.0), frame(15, FLEXURE, 10.0), frame(15, SHEAR, 5.0)])
def test_the_bound_holds_where_modes_are_missing(structure):
    p = structure.rocking()
    whole = uplifted(p, p.n_modes)[:2]
    for n in range(2, p.n_modes):
        found = rf.adequacy(p.truncated(n))
        for k in range(1, n + 1):
            true = (uplifted(p, k)[:2] / whole[:k] - 1.0)[: min(k, 2)]
            assert (found.frequency_bound[k - 1, : true.size] >= true - 1e-9).all()
        assert (found.reference_error >= 0.0).all()


def test_one_mode_of_many_tells_nothing_of_the_others():
    found = rf.adequacy(frame(5, SHEAR, 10.0).rocking(1), base_mass=40e3)
    assert found.base_moment_left[0] < 0.04
    assert found.frequency_error[0, 0] == 0.0
    assert found.model is None
    assert found.reason.startswith("One mode is not enough: 3 % of the base moment is left out (allowed: 12 %) and the")
    assert "the first uplifted frequency is at most " in found.reason


def test_one_mode_that_is_all():
    found = of(frame(1, SHEAR, 5.0))
    assert (found.model, found.model_for_shear) == ("2DOF-S", "2DOF-S")
    np.testing.assert_array_equal(found.reference_error, 0.0)


def test_mass_that_the_base_shear_is_compared_with():
    structure = frame(5, FLEXURE, 5.0)
    p = structure.rocking()
    known, complete, few = (
        rf.adequacy(p, base_mass=40e3),
        rf.adequacy(p),
        rf.adequacy(replace(p.truncated(3), base_mass=None)),
    )
    assert [known.mass, complete.mass] == pytest.approx([200e3, 200e3], rel=1e-12)  # sums of mass, in any order
    assert known.base_known
    assert complete.base_known
    assert few.mass == 240e3
    assert not few.base_known
    assert few.reason.endswith(
        "For the base shear give more modes, or the mass of the base: only 79.6 % of the total mass including the base "
        f"participates with 3 modes (required: 90 %). {LEFT_OUT}"
    )
    assert rf.adequacy(p.truncated(3)).mass == pytest.approx(200e3, rel=1e-12)  # what is cut off is still known


def test_tendons_are_felt():
    free = frame(5, SHEAR, 10.0)
    held = rf.Restrained(free, rf.Tendon(1e6, 2e9))
    loose, tight = rf.adequacy(free.rocking()), rf.adequacy(held.rocking())
    np.testing.assert_array_equal(loose.base_moment, tight.base_moment)
    assert abs(tight.frequency_error[0, 0] - loose.frequency_error[0, 0]) > 0.01


def test_reason_names_the_numbers():
    assert of(frame(5, FLEXURE, 5.0)).reason == (
        "2DOF-S is enough: with one mode, 10.2 % of the base moment is left out (allowed: 12 %) and the first uplifted "
        "frequency is 3.66 % too high (allowed: 17 %). For the base shear use 4DOF-S: 95.5 % of the mass above the "
        f"base participates with 3 modes, only 67.9 % with one mode (required: 90 %). {LEFT_OUT}"
    )
    assert of(frame(15, SHEAR, 10.0)).reason == (
        "Use 4DOF-S: with 2 modes, the second uplifted frequency is 79.2 % too high (allowed: 25 %); with 3, 0.563 % "
        "of the base moment is left out (allowed: 12 %), the first uplifted frequency is less than 0.1 % too high "
        "(allowed: 17 %) and the second is less than 0.1 % too high (allowed: 25 %). This is also enough for "
        "the base shear: 96 % of the mass above the base participates (required: 90 %)."
    )
    assert of(tower()).reason.endswith(
        "For the base shear give more modes: only 87.2 % of the mass above the base participates with 5 modes "
        f"(required: 90 %). {LEFT_OUT}"
    )
    few = rf.adequacy(tower().rocking(2), base_mass=0.0).reason
    assert few.startswith(
        "The 2 available modes are not enough: 5.9 % of the base moment is left out (allowed: 12 %), "
    )
    assert " Give more modes. For the base shear give more modes: only 71.2 % of " in few


def test_shear_alone_may_be_met():
    few = rf.adequacy(frame(15, SHEAR, 10.0).rocking(2), base_mass=40e3)
    assert (few.model, few.model_for_shear) == (None, "3DOF-S")
    assert few.reason.endswith(
        "For the base shear use 3DOF-S: 92.8 % of the mass above the base participates with 2 modes (required: 90 %). "
        f"{LEFT_OUT}"
    )


@pytest.mark.parametrize(
    ("change", "enough", "enough_for_shear"),
    [
        ({}, 1, 1),
        ({"base_moment": 0.1}, 2, 1),
        ({"first_frequency": 0.1}, 2, 1),
        ({"first_frequency": 0.1, "second_frequency": 0.1}, 3, 1),
        ({"second_frequency": 0.0}, 1, 1),  # of one mode there is no second
        ({"base_shear": 0.2}, 1, 4),
        ({"base_moment": 0.0}, None, 1),
        ({"base_shear": 0.0}, 1, None),
    ],
)
def test_every_tolerance_counts(change, enough, enough_for_shear):
    found = rf.adequacy(tower().rocking(), rf.AdequacyTolerance(**{**NO_LIMIT, **change}), base_mass=0.0)
    assert (found.enough, found.enough_for_shear) == (enough, enough_for_shear)


def test_arrays_are_read_only():
    found = of(frame(2, SHEAR, 5.0))
    for name in ("base_moment", "base_shear", "base_moment_left", "base_shear_left", "frequency_error"):
        assert not getattr(found, name).flags.writeable
    assert not found.reference_error.flags.writeable


@pytest.mark.parametrize("value", [-0.1, math.nan])
def test_wrong_tolerance(value):
    said = r"first_frequency must be a zero or positive number in fractions \(5 % is 0.05\), but (-0.1|nan) was given\."
    with pytest.raises(rf.InputError, match=said):
        rf.AdequacyTolerance(first_frequency=value)


def test_wrong_base_mass():
    p = frame(5, SHEAR, 5.0).rocking()
    with pytest.raises(rf.InputError) as caught:
        rf.adequacy(p, base_mass=60e3)
    assert str(caught.value).startswith("base_mass must leave the effective mass of the modes, 200000 kg, but 60000")
    with pytest.raises(rf.InputError, match="base_mass must be a zero or positive, finite number in kg"):
        rf.adequacy(p, base_mass=-1.0)


def test_no_modes():
    with pytest.raises(rf.InputError, match="properties must have at least one mode, but a rigid structure was given"):
        rf.adequacy(rf.rigid_block(0.2, 3.0))


@pytest.mark.parametrize("structure", [frame(40, SHEAR, 10.0), frame(12, FLEXURE, 5.0), frame(1, SHEAR, 5.0)])
def test_lowest_uplifted_frequencies_are_those_of_all(structure):
    p = structure.rocking()
    whole = rf.uplifted_modes(p).omega
    for count in (1, 2, 3):
        np.testing.assert_allclose(lowest_uplifted_frequencies(p, count), whole[:count], rtol=1e-14)


@pytest.mark.parametrize("kept", [15, 4])
def test_on_an_eccentric_base_the_worse_side_counts(kept):
    """Each side has the frequencies of a base in the middle, as wide as its arm."""
    p = replace(frame(15, SHEAR, 6.0).rocking().truncated(kept), eccentricity=3.0)
    found = rf.adequacy(p, base_mass=40e3)
    middle = replace(p, eccentricity=0.0)
    sides = [rf.adequacy(middle.with_half_width(p.pivot(side).arm), base_mass=40e3) for side in (1, -1)]
    assert p.half_width > 4.0
    assert sides[0].frequency_error[0, 0] > 1.1 * sides[1].frequency_error[0, 0]
    worse = np.maximum(sides[0].frequency_error, sides[1].frequency_error)
    np.testing.assert_allclose(found.frequency_error, worse, rtol=1e-9, atol=1e-12)
    worse = np.maximum(sides[0].reference_error, sides[1].reference_error)
    np.testing.assert_allclose(found.reference_error, worse, rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(found.base_moment, sides[0].base_moment)
