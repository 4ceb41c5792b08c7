"""What belongs to each of the two pivots: of a symmetric base, an eccentric one, and one with tendons to one side."""

import copy
import dataclasses
import math
import pickle
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from builders import BY_HAND
from rockflex.structure import Pivot

G = 9.81
B, E = 1.2, 0.3
TENDONS = [rf.Tendon(0.4e6, 5e6, -1.4), rf.Tendon(0.2e6, 3e6, 0.5), rf.Tendon(0.1e6, 2e6)]
PAIRS = [rf.Tendon(0.1e6 * f, 1.1e6 * f, side * 0.37 * f) for side in (1, -1) for f in (1.0, 1.7, 2.3)]


def made(**changes) -> rf.RockingProperties:
    return rf.RockingProperties(**BY_HAND | changes)


def mirrored(p: rf.RockingProperties) -> rf.RockingProperties:
    tendons = [dataclasses.replace(each, position=-each.position) for each in p.tendons]
    return dataclasses.replace(p, eccentricity=-p.eccentricity, elements=tendons)


@pytest.mark.parametrize("tendons", [(), PAIRS, [rf.Tendon(1e5, 1e6), *PAIRS]])
def test_both_pivots_of_a_symmetric_base_have_the_same_bits(tendons):
    p = made(elements=tendons)
    assert p.symmetric
    for side in (1, -1):
        pivot = p.pivot(side)
        assert (pivot.side, pivot.arm, pivot.i_theta) == (side, B, 24e6)
        assert pivot.weight_moment == p.weight_moment == 240e3 * G * B
        assert pivot.prestress_moment == p.prestress * B
        assert pivot.resisting_moment == p.resisting_moment == 240e3 * G * B + p.prestress * B
        assert pivot.tendon_stiffness == p.tendon_stiffness
        assert p.tendon_stiffness == sum((t.stiffness * (B - t.position) ** 2 for t in p.tendons), 0.0)
        assert pivot.axial_stiffness_moment == p.axial_stiffness * B
        assert pivot.rocking_stiffness == p.rocking_stiffness == p.tendon_stiffness - 1.8e6 * G
        assert pivot.nominal_overturning_rotation == p.nominal_overturning_rotation == 0.7 * math.atan2(B, 11.0)


def test_each_side_of_an_eccentric_base_with_tendons():
    p = made(eccentricity=E, elements=TENDONS)
    assert not p.symmetric
    for side, arm in ((1, 0.9), (-1, 1.5)):
        pivot = p.pivot(side)
        assert pivot.side == side
        assert pivot.arm == pytest.approx(arm, rel=1e-15)
        # Steiner, by way of the axis of the masses.
        assert pivot.i_theta == pytest.approx(24e6 - 240e3 * B**2 + 240e3 * arm**2, rel=1e-14)
        assert pivot.weight_moment == pytest.approx(240e3 * G * arm, rel=1e-15)
        # Moments about the pivot at x = side · arm, summed tendon by tendon.
        edge = side * arm
        force = sum(t.initial_force * abs(edge - t.position) for t in TENDONS)
        assert pivot.prestress_moment == pytest.approx(force, rel=1e-14)
        assert pivot.resisting_moment == pytest.approx(240e3 * G * arm + force, rel=1e-14)
        stiffness = sum(t.stiffness * (edge - t.position) ** 2 for t in TENDONS)
        assert pivot.tendon_stiffness == pytest.approx(stiffness, rel=1e-14)
        assert pivot.rocking_stiffness == pytest.approx(stiffness - 1.8e6 * G, rel=1e-14)
        pull = sum(t.stiffness * abs(edge - t.position) for t in TENDONS)
        assert pivot.axial_stiffness_moment == pytest.approx(pull, rel=1e-14)
        assert pivot.nominal_overturning_rotation == pytest.approx(0.7 * math.atan(arm / 11.0), rel=1e-14)


def test_properties_without_a_side_are_those_of_the_pivot_that_lifts_first():
    p = made(eccentricity=E, elements=[rf.Tendon(1e6, 1e6, -1.4)])
    right, left = p.pivot(1), p.pivot(-1)
    assert left.resisting_moment < right.resisting_moment  # the tendon beside it outdoes the weight's longer arm
    assert p.weaker_pivot == left
    for name in ("weight_moment", "resisting_moment", "tendon_stiffness", "rocking_stiffness"):
        assert getattr(p, name) == getattr(left, name)
    assert p.nominal_overturning_rotation == right.nominal_overturning_rotation < left.nominal_overturning_rotation
    assert made(eccentricity=E).weaker_pivot.side == 1
    assert made(eccentricity=-E).weaker_pivot.side == -1
    assert made().weaker_pivot.side == 1


@given(
    st.floats(-1.19, 1.19),
    st.lists(st.tuples(st.floats(0.0, 1e6), st.floats(0.0, 1e8), st.floats(-1.0, 1.0)), max_size=4),
)
def test_a_mirrored_structure_swaps_its_pivots(eccentricity, tendons):
    middle, half = -eccentricity, B  # of the base, from the axis
    p = made(eccentricity=eccentricity, elements=[rf.Tendon(f, k, middle + half * x) for f, k, x in tendons])
    for side in (1, -1):
        assert dataclasses.replace(mirrored(p).pivot(-side), side=side) == p.pivot(side)


def test_tendons_balanced_on_an_eccentric_base_are_no_symmetry():
    p = made(eccentricity=E, elements=[rf.Tendon(1e5, 1e6, 0.8), rf.Tendon(1e5, 1e6, -0.8)])
    assert not p.symmetric
    assert not made(elements=TENDONS[1]).symmetric


def test_an_eccentric_rigid_block_has_the_slenderness_of_its_side():
    p = made(eccentricity=E).truncated(0)
    assert p.pivot(-1).nominal_overturning_rotation == pytest.approx(0.7 * math.atan(1.5 * 240e3 / 1.8e6), rel=1e-14)
    assert p.pivot(1).i_theta == made(eccentricity=E).pivot(1).i_theta


def test_printed_inertia_never_falls_below_that_about_the_nearer_pivot():
    inertia = 150e3 * 121.0 + 30e3 * 9.0
    # One part in 2e5 is missing, more than 240e3 (1.2 - 1.1999)² leaves.
    p = made(translational_inertia=inertia, i_theta=(inertia + 240e3 * B**2) * (1.0 - 5e-6), eccentricity=1.1999)
    assert p.pivot(1).i_theta == pytest.approx(inertia + 240e3 * 1e-4**2, rel=1e-12)
    assert p.pivot(1).i_theta > inertia


def test_copies_and_changes_keep_the_eccentricity():
    p = made(eccentricity=E, elements=TENDONS)
    for same in (pickle.loads(pickle.dumps(p)), copy.deepcopy(p), dataclasses.replace(p), p.truncated(2)):
        assert same == p
        assert hash(same) == hash(p)
        assert same.pivot(-1) == p.pivot(-1)
    assert p != made(elements=TENDONS[1:])
    assert made(eccentricity=E) != made()
    assert made(eccentricity=-0.0) == made()
    assert str(made(eccentricity=-0.0).eccentricity) == "0.0"
    assert p.truncated(1).eccentricity == E
    wider = p.with_half_width(2.0)
    assert (wider.eccentricity, wider.pivot(1).arm, wider.pivot(-1).arm) == (E, 1.7, 2.3)
    built = made(half_width=2.0, i_theta=24e6 + 240e3 * (2.0**2 - B**2), eccentricity=E)
    assert wider.pivot(-1).i_theta == pytest.approx(built.pivot(-1).i_theta, rel=1e-14)
    assert isinstance(p.pivot(np.int64(1)), Pivot)
    assert type(p.pivot(np.int64(1)).side) is int


@pytest.mark.parametrize("side", [0, 2, True, "left", 0.5, None, math.nan])
def test_there_are_two_sides(side):
    with pytest.raises(rf.InputError) as caught:
        made().pivot(side)
    says = f"side must be 1 (right edge of the base) or -1 (left edge), but {side!r} was given."
    assert str(caught.value) == says


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"eccentricity": 1.2}, "eccentricity must be smaller than half_width, 1.2 m, to either side, but 1.2 m was"),
        ({"eccentricity": -90.0}, "to either side, but -90 m was given"),
        ({"eccentricity": math.nan}, "eccentricity must be a finite number in m, but nan was given"),
        ({"eccentricity": "left"}, "eccentricity must be a finite number in m, but 'left' was given"),
        ({"eccentricity": 0.3, "elements": rf.Tendon(1.0, 1.0, 1.6)}, "Elements must act within half_width +"),
        ({"elements": rf.ViscousDamper(1.0, -1.3)}, "but a ViscousDamper is at -1.3 m."),
        (
            {"eccentricity": B * (1.0 - 1e-15), "i_theta": 150e3 * 121.0 + 30e3 * 9.0 + 240e3 * B**2},
            "eccentricity must leave rotational inertia about the nearer pivot, but with 1.2 m and half_width = 1.2 m "
            "only the 18420000 kg m² of the modes are left. Move the axis of the masses further from the edge",
        ),
    ],
)  # fmt: skip
def test_errors(changes, says):
    with pytest.raises(rf.InputError, match=re.escape(says)):
        made(**changes)


def test_a_base_narrower_than_the_eccentricity_is_refused():
    with pytest.raises(rf.InputError, match=r"eccentricity must be smaller than half_width, 0\.2 m, to either side"):
        made(eccentricity=E).with_half_width(0.2)
