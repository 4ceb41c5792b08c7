"""`RockingProperties.with_half_width`, and structures that no base can carry."""

import dataclasses
import re

import numpy as np
import pytest

import rockflex as rf

FIELDS = ("i_theta", "l0r", "m_tot", "half_width", "translational_inertia", "resisting_moment", "omega", "zeta",
          "effective_mass", "effective_height", "top_ordinate", "nominal_overturning_rotation")  # fmt: skip


def lumped(half_width, tendons=()):
    stiffness = [[3e6, -1e6], [-1e6, 1e6]]
    made = rf.LumpedStructure(
        [3e3, 2e3], stiffness, [4.0, 9.0], base_mass=1e3, half_width=half_width, damping_ratio=0.02
    )
    return dataclasses.replace(made.rocking(), elements=tendons)


def beam(half_width):
    bodies = rf.LumpedMasses([10.0], [4e3], [6e3])
    return rf.Beam(height=10.0, mass=500.0, bending_stiffness=1e8, rotary_inertia=200.0, rotary_in_modes=False,
                   lumped_masses=bodies, half_width=half_width, damping_ratio=0.02).rocking(2)  # fmt: skip


@pytest.mark.parametrize("build", [lumped, beam])
@pytest.mark.parametrize("width", [0.1, 0.9, 3.0, 40.0])
def test_it_is_the_structure_built_on_that_base(build, width):
    moved, built = build(1.3).with_half_width(width), build(width)
    for name in FIELDS:
        np.testing.assert_allclose(getattr(moved, name), getattr(built, name), rtol=1e-13)
    assert moved.floors == built.floors


def test_inertia_and_resisting_moment_follow():
    p = lumped(1.0, [rf.Tendon(5e4, 1e6)])
    wider = p.with_half_width(2.5)
    assert wider.i_theta - p.i_theta == pytest.approx(6e3 * (2.5**2 - 1.0**2), rel=1e-12)
    assert wider.resisting_moment == pytest.approx((6e3 * 9.81 + 5e4) * 2.5, rel=1e-14)
    assert wider.tendons == p.tendons


def test_there_and_back():
    p = lumped(1.3)
    assert p.with_half_width(1.3) is p
    assert p.with_half_width(0.2).with_half_width(1.3).i_theta == pytest.approx(p.i_theta, rel=1e-14)


def test_a_block_keeps_its_rotary_inertia():
    block = rf.rigid_block(0.3, 2.0, mass=10.0)
    about_middle = block.i_theta - 10.0 * block.half_width**2
    assert block.with_half_width(0.1).i_theta == pytest.approx(about_middle + 10.0 * 0.1**2, rel=1e-14)


def test_the_response_is_that_of_the_structure_built_on_that_base():
    motion = rf.load_suite("el-centro-1940")[0]
    moved, built = (rf.simulate(p, motion, "MDOF-S") for p in (lumped(2.0).with_half_width(0.6), lumped(0.6)))
    assert moved.n_impacts == built.n_impacts > 3
    np.testing.assert_allclose(moved.rotation, built.rotation, atol=1e-9 * built.max_rotation)


def test_tendons_must_stand_within_the_base():
    pair = [rf.Tendon(1e4, 1e6, position=x) for x in (-0.8, 0.8)]
    assert lumped(1.0, pair).with_half_width(0.8).tendons == tuple(pair)
    with pytest.raises(rf.InputError, match=r"must act within half_width = 0\.7 m .*Tendon is at -0\.8 m"):
        lumped(1.0, pair).with_half_width(0.7)


@pytest.mark.parametrize(
    ("width", "text"),
    [
        (0.0, "half_width must be a positive, finite number in m, but 0.0 was given"),
        (-1.0, "half_width must be a positive, finite number in m, but -1.0 was given"),
        (np.nan, "half_width must be a positive, finite number in m, but nan was given"),
        ("wide", "half_width must be a number in m, but 'wide' was given"),
        (1e200, "The inertia of the structure on this base cannot be computed"),
    ],
)
def test_errors(width, text):
    with pytest.raises(rf.InputError, match=re.escape(text)):
        lumped(1.0).with_half_width(width)


@pytest.mark.parametrize("changed", [{"half_width": 10.0}, {"m_tot": 1e6}, {"i_theta": 2.12e5}])
def test_a_base_that_the_inertia_leaves_no_room_for(changed):
    p = lumped(1.0)
    given = {name: getattr(p, name) for name in ("i_theta", "m_tot", "half_width")} | changed
    least = p.translational_inertia + given["m_tot"] * given["half_width"] ** 2
    text = (
        f"i_theta must be at least translational_inertia + m_tot * half_width**2, {least:.9g} kg m², but "
        f"{given['i_theta']:.9g} kg m² was given. It refers to a pivot, so it changes with the base: "
        "properties.with_half_width(B) gives the same structure on another base."
    )
    with pytest.raises(rf.InputError, match=re.escape(text)):
        dataclasses.replace(p, **changed)


def test_numbers_printed_to_six_digits_are_taken():
    p = lumped(1.234567)
    printed = {name: float(f"{getattr(p, name):.6g}") for name in ("i_theta", "m_tot", "translational_inertia")}
    printed["i_theta"] = p.i_theta * (1.0 - 5e-6)
    taken = dataclasses.replace(p, **printed)
    assert taken.i_theta < taken.translational_inertia + taken.m_tot * taken.half_width**2
    # What rounding took from a wide base is no mass that a narrow one could miss.
    narrow = dataclasses.replace(lumped(500.0), i_theta=lumped(500.0).i_theta * (1.0 - 5e-6)).with_half_width(0.1)
    assert narrow.i_theta == pytest.approx(lumped(0.1).i_theta, rel=1e-12)
    with pytest.raises(rf.InputError, match="i_theta must be at least"):
        dataclasses.replace(p, i_theta=p.i_theta * (1.0 - 1e-4))
