"""The kinematic check of a wall against closed forms of C8.7.1.2.1, Circolare 7/2019."""

import math

import numpy as np
import pytest

import rockflex as rf
from rockflex.foundation.constants import GRAVITY

WIDTH, HEIGHT, MASS = 0.6, 8.0, 9e3
WALL = rf.OneSided(rf.rigid_block(width=WIDTH, height=HEIGHT, mass=MASS))
TARGET = rf.ec8_spectrum(2.5, "B")
FC = 1.35


def tie(strength: float, rupture: float | None = None, cosine: float = 1.0) -> rf.YieldingDissipator:
    return rf.YieldingDissipator(
        stiffness=1e12, yield_force=strength, height=7.0, cosine=cosine, tension_only=True, rupture_elongation=rupture
    )


@pytest.mark.parametrize(
    ("state", "share", "secant", "eta"),
    [("SLV", 0.4, 1.68, math.sqrt(10 / 13)), ("SLC", 0.6, 1.56, math.sqrt(10 / 15))],
)
def test_block_is_the_closed_form(state: str, share: float, secant: float, eta: float) -> None:
    found = rf.kinematic_check(WALL, TARGET, limit_state=state, behaviour_factor=1.5)  # pyright: ignore[reportArgumentType]
    alpha, a_0 = WIDTH / HEIGHT, WIDTH / HEIGHT * GRAVITY / FC
    capacity = share * WIDTH / 2  # the centre of mass is above the edge at d_0 = t/2
    period = secant * math.pi * math.sqrt(capacity / ((1 - share) * a_0))
    assert found.multiplier == pytest.approx(alpha, rel=1e-12)
    assert found.displacement[-1] == pytest.approx(WIDTH / 2, rel=1e-12)
    assert found.displacement_capacity == pytest.approx(capacity, rel=1e-12)
    assert found.secant_period == pytest.approx(period, rel=1e-12)
    assert found.acceleration_ratio == pytest.approx(2.5 * 1.2 / (1.5 * a_0), rel=1e-12)
    plateau = 2.5 * 1.2 * 2.5 * 0.5 * 2.0 / (2 * math.pi) ** 2  # a_g S 2.5 T_C T_D/4π² from T_D on
    assert found.displacement_demand == pytest.approx(plateau * eta, rel=1e-9)
    assert found.displacement_ratio == pytest.approx(plateau * eta / capacity, rel=1e-9)


def test_tie_that_yields_at_once_adds_its_moment() -> None:
    strength = 3e3
    found = rf.kinematic_check(rf.Restrained(WALL, tie(strength)), TARGET)
    weight = MASS * GRAVITY
    alpha = (weight * WIDTH / 2 + strength * 7.0) / (weight * HEIGHT / 2)
    assert found.multiplier == pytest.approx(alpha, rel=1e-6)
    assert found.displacement[-1] == pytest.approx(alpha * HEIGHT / 2, rel=1e-6)


def test_tie_that_breaks_ends_its_help_and_no_sooner() -> None:
    free, held = rf.kinematic_check(WALL, TARGET), rf.kinematic_check(rf.Restrained(WALL, tie(3e3, 0.05)), TARGET)
    assert held.multiplier > 1.2 * free.multiplier
    assert held.displacement[-1] == pytest.approx(free.displacement[-1], rel=1e-12)
    assert held.displacement_capacity == pytest.approx(free.displacement_capacity, rel=1e-12)


def test_tie_on_the_other_side_slackens() -> None:
    other = rf.kinematic_check(rf.Restrained(WALL, tie(3e3, cosine=-1.0)), TARGET)
    assert other.multiplier == pytest.approx(rf.kinematic_check(WALL, TARGET).multiplier, rel=1e-12)


def test_both_sides_of_a_wall_are_looked_at() -> None:
    block = rf.rigid_block(width=WIDTH, height=HEIGHT, mass=MASS)
    held = rf.kinematic_check(rf.Restrained(block, tie(3e3)), TARGET)  # helps where θ > 0
    assert held.side == -1
    assert held.multiplier == pytest.approx(WIDTH / HEIGHT, rel=1e-12)


def test_flexure_does_not_matter_and_units_do_not_either() -> None:
    masonry = rf.Beam(
        height=HEIGHT,
        mass=MASS / HEIGHT,
        bending_stiffness=3e7,
        base_mass=1.0,
        half_width=WIDTH / 2,
        damping_ratio=0.04,
    )
    flexible, rigid = (rf.kinematic_check(rf.OneSided(each), TARGET) for each in (masonry, WALL.structure))
    assert flexible.multiplier == pytest.approx(rigid.multiplier, rel=2e-4)  # the beam has a base of 1 kg


def test_mass_that_leans_pushes_but_does_not_hold() -> None:
    properties = WALL.rocking()
    found = rf.kinematic_check(properties, TARGET)
    frame = rf.Frame(1, 4.0, MASS, 1.0, 1.0, period=0.2, aspect_ratio=10.0, damping_ratio=0.02)
    leaning = rf.kinematic_check(rf.Leaning(frame, [MASS]), TARGET)
    alone = rf.kinematic_check(frame, TARGET)
    assert found.multiplier == pytest.approx(WIDTH / HEIGHT, rel=1e-12)
    assert leaning.multiplier == pytest.approx(alone.multiplier / 2, rel=1e-9)


def test_wall_that_stays_closed_is_safe_however_soft_the_spectrum() -> None:
    weak = TARGET.scaled(0.05 * WIDTH / HEIGHT * GRAVITY / 3.0)
    found = rf.kinematic_check(WALL, weak)
    assert found.displacement_ratio <= found.ground_acceleration / found.acceleration[0] < 1.0


def test_more_ground_is_never_less_demand() -> None:
    ratios = [
        rf.kinematic_check(WALL, TARGET.scaled(factor)).displacement_ratio for factor in np.geomspace(0.05, 4, 12)
    ]
    assert np.all(np.diff(ratios) > 0.0)


@pytest.mark.parametrize(
    ("structure", "options", "field"),
    [
        (WALL, {"limit_state": "SLD"}, "limit_state"),
        (WALL, {"confidence_factor": 0.0}, "confidence_factor"),
        (WALL, {"behaviour_factor": -1.0}, "behaviour_factor"),
        (rf.Restrained(WALL, rf.Tendon(initial_force=0.0, stiffness=1e8, height=7.0)), {}, "elements"),
        (rf.Restrained(WALL, rf.Tendon(initial_force=1e5, stiffness=1e3, height=7.0, cosine=-1.0)), {}, "structure"),
    ],
)
def test_what_cannot_be_checked_is_refused(structure: rf.Restrained, options: dict[str, object], field: str) -> None:
    with pytest.raises(rf.InputError) as error:
        rf.kinematic_check(structure, TARGET, **options)  # pyright: ignore[reportArgumentType]
    assert error.value.field == field


def test_spectrum_that_ends_too_soon_is_refused() -> None:
    short = rf.TargetSpectrum([0.0, 0.15, 0.5, 1.0], [3.0, 7.5, 7.5, 3.75])
    with pytest.raises(rf.InputError, match="ends at 1 s") as error:
        rf.kinematic_check(WALL, short)
    assert error.value.field == "spectrum"
