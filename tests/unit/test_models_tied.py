"""A choice of model, tied to a structure: which model it becomes, with which impact law."""

import dataclasses

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import Model, housner, parse_model
from rockflex.models._impact import SidedRestitution
from rockflex.motion import quiet_motion

FRAME = make_frame(n_stories=3, stiffness_ratio=0.125, period=0.5, aspect_ratio=8.0)
PROPERTIES = FRAME.rocking()
BLOCK = PROPERTIES.truncated(0)
SPRING = rf.BoucWen(0.05)


@pytest.mark.parametrize(
    ("label", "complete", "law", "n_modes"),
    [
        ("2DOF-S", False, rf.VVELSimplified(), 1),
        ("MDOF-S", False, rf.VVELSimplified(), 3),
        ("fixed", False, rf.VVELSimplified(), 3),
        ("rigid", False, housner(BLOCK), 0),
        ("rigid-C", True, housner(BLOCK), 0),
        ("2DOF-C", True, rf.VVELComplete(), 1),
        ("2DOF-C-SI", True, rf.VVELSimplified(), 1),
        ("2DOF-C-E", True, rf.VVELComplete(), 1),
        ("3DOF-C-SI", True, rf.VVELSimplified(), 2),
        ("3DOF-C-E", True, rf.VVELComplete(), 2),
        ("MDOF-C", True, rf.VVELComplete(), 3),
        ("MDOF-C-SI", True, rf.VVELSimplified(), 3),
    ],
)
def test_models_and_their_own_laws(label, complete, law, n_modes):
    tied = parse_model(label).of(PROPERTIES)
    assert (tied.label, tied.law, tied.properties.n_modes) == (label, law, n_modes)
    assert tied.lifts == (label != "fixed")
    assert (tied.complete, tied.bouc_wen) == (complete, None)
    mine = rf.Restitution(0.3)
    assert parse_model(label).of(PROPERTIES, mine).law is mine


@pytest.mark.parametrize(
    ("label", "named", "complete"),
    [
        ("2DOF-S", "2DOF-S-BW", False),
        ("2DOF-S-BW", "2DOF-S-BW", False),
        ("2DOF-C", "2DOF-C-BW", True),
        ("2DOF-C-SI", "2DOF-C-SI-BW", True),
        ("1DOF-fixed", "1DOF-fixed-BW", False),
    ],
)
def test_a_spring_makes_any_model_of_one_mode_yield(label, named, complete):
    tied = parse_model(label).of(PROPERTIES, bouc_wen=SPRING)
    assert (tied.label, tied.complete, tied.bouc_wen) == (named, complete, SPRING)
    assert parse_model("MDOF-S").of(PROPERTIES.truncated(1), bouc_wen=SPRING).label == "MDOF-S-BW"
    assert parse_model("fixed").of(PROPERTIES.truncated(1), bouc_wen=SPRING).label == "fixed-BW"


@pytest.mark.parametrize(
    ("model", "properties", "options", "text"),
    [
        (Model(4), PROPERTIES, {}, "Model 5DOF-S needs 4 modes, but the structure has 3. Give more modes, or use"),
        (Model(4, lifts=False), PROPERTIES, {}, "Model 4DOF-fixed needs 4 modes, but the structure has 3. Give more"),
        (parse_model("5DOF-C-SI"), PROPERTIES, {}, "Model 5DOF-C-SI needs 4 modes, but the structure has 3. Give"),
        (Model(1, complete=True), BLOCK, {}, "Model 2DOF-C needs modes, but the structure is a rigid block. Use"),
        (Model(), BLOCK, {}, 'Model MDOF-S needs modes, but the structure is a rigid block. Use "rigid" or "rigid-C".'),
        (Model(lifts=False), BLOCK, {}, 'Model fixed needs modes, but the structure is a rigid block. Use "rigid"'),
        (Model(complete=True), PROPERTIES.truncated(2), {}, "MDOF-C needs all modes, but those given have 99.75%"),
        (parse_model("2DOF-S-BW"), PROPERTIES, {}, "2DOF-S-BW needs its hysteresis. Give"),
        (parse_model("MDOF-S"), PROPERTIES, {"bouc_wen": SPRING}, "bouc_wen applies to models with one mode"),
        (parse_model("rigid"), PROPERTIES, {"bouc_wen": SPRING}, "bouc_wen applies to models with one mode"),
        (parse_model("fixed"), PROPERTIES, {"bouc_wen": SPRING}, "bouc_wen applies to models with one mode"),
    ],
)
def test_structures_that_a_model_cannot_have(model, properties, options, text):
    with pytest.raises(rf.InputError) as caught:
        model.of(properties, **options)
    assert str(caught.value).startswith(text)


def test_truncated_modes_have_a_closure_or_a_law_of_their_own():
    two = PROPERTIES.truncated(2)
    assert parse_model("MDOF-C-SI").of(two).law == rf.VVELSimplified()
    assert parse_model("MDOF-C-E").of(two).law == rf.VVELComplete()
    assert Model(complete=True).of(two, rf.VVELSimplified()).law == rf.VVELSimplified()
    assert (
        Model(complete=True).of(PROPERTIES.truncated(1)).law == rf.VVELComplete()
    )  # Eq. 29: one velocity, one equation


def squat(**changes):
    """A block with the inertia of one lumped mass 3 m up on a base."""
    given = {"i_theta": 3000.0 + 1500.0, "l0r": 1000.0, "m_tot": 1500.0, "half_width": 1.0, **changes}
    return rf.RockingProperties([], [], [], [], zeta=[], **given)


def test_housner_keeps_the_angular_momentum_about_the_new_pivot():
    """Masses at (±B, h) from the pivots: before, each moves at θ' times its lever about the old one."""
    rng = np.random.default_rng(3)
    masses, heights, half = rng.uniform(1.0, 5.0, 6), rng.uniform(2.0, 9.0, 6), 0.7
    block = squat(
        i_theta=float(masses @ (heights**2 + half**2)),
        l0r=float(masses @ heights),
        m_tot=float(masses.sum()),
        half_width=half,
    )
    # About the right pivot the masses stand at (-B, h); the velocity of rotation 1 there is (h, B).
    momentum = masses @ (heights * heights + half * -half)
    assert housner(block).e == pytest.approx(momentum / block.i_theta, rel=1e-14)
    assert housner(block).shortest_excursion == rf.Restitution(0.0).shortest_excursion


@pytest.mark.parametrize("eccentricity", [0.2, -0.45, 1e-9])
def test_housner_on_an_eccentric_base(eccentricity):
    """Masses on an axis; each moves with its lever about the old pivot, and has its momentum about the new one."""
    rng = np.random.default_rng(4)
    masses, heights, half = rng.uniform(1.0, 5.0, 6), rng.uniform(2.0, 9.0, 6), 0.7
    block = squat(
        i_theta=float(masses @ (heights**2 + half**2)),
        l0r=float(masses @ heights),
        m_tot=float(masses.sum()),
        half_width=half,
        eccentricity=eccentricity,
    )
    law = housner(block)
    assert isinstance(law, SidedRestitution)
    for side, each in ((1, law.right), (-1, law.left)):
        # Turning clockwise with velocity 1 about the old pivot at x, a mass at (0, h) moves with (h, x).
        old, new = side * (half - side * eccentricity), -side * (half + side * eccentricity)
        momentum = masses @ (heights * heights + new * old)
        inertia = masses @ (heights**2 + new**2)
        assert each.e == pytest.approx(momentum / inertia, rel=1e-14)
        assert law.after(block, np.zeros(0), -side * 2.0)[1] == -side * 2.0 * each.e
        # Plastic impacts lose energy, whichever pivot has more inertia.
        assert inertia * each.e**2 < block.pivot(side).i_theta
    assert law.keeps == rf.Restitution(0.0).keeps


def test_an_eccentric_block_too_squat_for_housner():
    with pytest.raises(rf.InputError) as caught:
        housner(squat(i_theta=2700.0, eccentricity=-0.3))
    assert str(caught.value).startswith("Housner's coefficient 1 - 2 m_tot B B_2/I_2 is -0.08527: an eccentric block")


def test_a_block_too_squat_for_housner():
    block = squat(i_theta=2000.0)
    text = (
        "Housner's coefficient 1 - 2 m_tot B²/I_θ is -0.5: a block this squat stops at its first impact. "
        "Give impact=VVELSimplified()."
    )
    with pytest.raises(rf.InputError) as caught:
        housner(block)
    assert str(caught.value) == text
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(block, quiet_motion(0.1), "rigid")
    assert str(caught.value) == text
    assert rf.simulate(block, quiet_motion(0.1), "rigid", impact=rf.VVELSimplified()).status == "no_uplift"
    edge = squat(i_theta=3000.0)
    assert housner(edge).e == 0.0


def test_without_modes_there_are_no_floors():
    assert BLOCK.floors is None
    assert BLOCK.n_modes == 0
    assert BLOCK.nominal_overturning_rotation == pytest.approx(
        0.7 * np.arctan(BLOCK.half_width * BLOCK.m_tot / BLOCK.l0r)
    )
    assert dataclasses.replace(BLOCK).i_theta == BLOCK.i_theta
