"""Springs, beds of springs and the ground as values."""

import math

import numpy as np
import pytest

import rockflex as rf

B, BREADTH, MODULUS = 2.0, 3.0, 40e6
SPRINGS = rf.Springs([-1.0, 0.5, 1.5], [1e8, 2e8, 3e8], [1e6, 0.0, 2e6])


def test_sums_over_springs():
    assert SPRINGS.n == 3
    assert SPRINGS.total_stiffness == 6e8
    assert SPRINGS.total_damping == 3e6
    assert SPRINGS.rotational_stiffness == pytest.approx(1e8 + 2e8 * 0.25 + 3e8 * 2.25, rel=1e-15)


def test_a_base_that_can_heave_turns_about_the_centre_of_stiffness():
    centre = (-1e8 + 1e8 + 4.5e8) / 6e8
    about_it = sum(k * (x - centre) ** 2 for x, k in zip(SPRINGS.positions, SPRINGS.stiffness, strict=True))
    assert SPRINGS.tilting_stiffness == pytest.approx(about_it, rel=1e-14)


def test_one_number_applies_to_all_springs():
    assert rf.Springs([-1.0, 2.0], 1e8, 1e6) == rf.Springs([-1.0, 2.0], [1e8, 1e8], [1e6, 1e6])
    assert rf.Ground(0.3, SPRINGS, 1e3) == rf.Ground([0.3] * 3, SPRINGS, 1e3)


def test_damped_springs_have_the_ratio_of_the_heave_mode():
    mass = 5e4
    damped = SPRINGS.damped(0.4, mass)
    assert damped.total_damping == pytest.approx(2.0 * 0.4 * math.sqrt(damped.total_stiffness * mass), rel=1e-14)
    np.testing.assert_allclose(damped.damping / damped.stiffness, damped.total_damping / 6e8, rtol=1e-14)
    assert rf.winkler_bed(B, BREADTH, MODULUS).damped(0.1, mass).area is not None


@pytest.mark.parametrize("n", [2, 5, 40])
def test_a_uniform_bed_has_the_stiffness_of_the_continuous_one(n):
    bed = rf.winkler_bed(B, BREADTH, MODULUS, n=n, damping=3e6)
    assert bed.n == n
    assert bed.total_stiffness == pytest.approx(MODULUS * BREADTH * 2.0 * B, rel=1e-14)
    continuous = MODULUS * BREADTH * 2.0 * B**3 / 3.0
    assert bed.rotational_stiffness == pytest.approx(continuous * (1.0 - 1.0 / n**2), rel=1e-13)
    assert bed.total_damping == pytest.approx(3e6, rel=1e-14)
    assert bed.area.sum() == pytest.approx(2.0 * B * BREADTH, rel=1e-14)


def test_the_bed_of_asce_41_against_integrals_over_its_zones():
    shear, poisson = 20e6, 0.35
    zone = BREADTH / 6.0
    end, middle = 6.83 * shear / (1.0 - poisson), 0.73 * shear / (1.0 - poisson)
    heave = 2.0 * zone * end + 2.0 * (B - zone) * middle
    rotation = 2.0 / 3.0 * (end * (B**3 - (B - zone) ** 3) + middle * (B - zone) ** 3)
    errors = []
    for n in (8, 32, 128):  # 1, 4 and 16 in each end zone
        bed = rf.asce41_bed(B, BREADTH, shear, poisson, n=n)
        assert bed.n == n
        assert bed.total_stiffness == pytest.approx(heave, rel=1e-14)
        assert bed.area.sum() == pytest.approx(2.0 * B * BREADTH, rel=1e-14)
        errors.append(1.0 - bed.rotational_stiffness / rotation)
    np.testing.assert_allclose(errors[1:], np.array(errors[:-1]) / 16.0, rtol=1e-9)  # as 1/n²
    assert 0.0 < errors[-1] < 1e-4


def test_the_zones_of_asce_41_are_footings_of_gazetas():
    shear, poisson, half_length = 20e6, 0.35, BREADTH / 2.0

    def per_length(shape):  # Gazetas (1991): K_z = 2 G L/(1 - ν) (0.73 + 1.54 χ^0.75) of a base 2 L × 2 L χ
        heave = 2.0 * shear * half_length / (1.0 - poisson) * (0.73 + 1.54 * shape**0.75)
        return heave / (2.0 * half_length)

    bed = rf.asce41_bed(B, BREADTH, shear, poisson, n=16)
    along = bed.stiffness / (bed.area / BREADTH)
    assert along[0] == pytest.approx(6.0 * per_length(1.0 / 6.0), rel=0.01)  # given to three digits
    assert along[8] == pytest.approx(per_length(0.0), rel=1e-12)


def test_only_the_end_zones_are_stiffer():
    bed = rf.winkler_bed(B, BREADTH, MODULUS, n=16, end_zone=0.5, end_ratio=3.0)
    modulus = bed.stiffness / bed.area
    in_zone = np.abs(bed.positions) > 1.5
    np.testing.assert_allclose(modulus, np.where(in_zone, 3.0, 1.0) * MODULUS, rtol=1e-14)
    assert in_zone.sum() == 4


@pytest.mark.parametrize("n", [3, 4, 5])
@pytest.mark.parametrize("zone", [1e-3, 1.999])
def test_every_zone_has_a_spring_however_few_there_are(n, zone):
    bed = rf.winkler_bed(B, BREADTH, MODULUS, n=n, end_zone=zone, end_ratio=2.0)
    assert bed.n == n
    assert bed.total_stiffness == pytest.approx(MODULUS * BREADTH * 2.0 * (B + zone), rel=1e-13)
    np.testing.assert_allclose(bed.positions, -bed.positions[::-1], atol=1e-15)


def test_positions_are_measured_from_the_axis_of_the_masses():
    centred, shifted = (rf.winkler_bed(B, BREADTH, MODULUS, n=6, eccentricity=e) for e in (0.0, 0.5))
    np.testing.assert_allclose(shifted.positions, centred.positions - 0.5, rtol=1e-15)
    assert shifted.tilting_stiffness == pytest.approx(centred.tilting_stiffness, rel=1e-13)


@pytest.mark.parametrize(("friction", "slides"), [(0.4, True), (math.inf, False), ([0.4, math.inf, 0.1], True)])
def test_a_finite_coefficient_lets_the_base_slide(friction, slides):
    assert rf.Ground(friction, SPRINGS, 1e4).slides is slides


def test_the_ground_without_friction_holds_the_base():
    assert not rf.Ground(springs=SPRINGS, base_inertia=1e4).slides
    assert rf.Ground(0.4).slides
    assert not rf.Ground(math.inf).slides


COEFFICIENT = "friction must be a positive Coulomb coefficient, such as 0.4, or infinity for no sliding"


@pytest.mark.parametrize(
    ("make", "message", "field"),
    [
        (lambda: rf.Springs([-1.0, 1.0], [1e8, -1e8]), "stiffness must be positive, but stiffness[1]", "stiffness"),
        (lambda: rf.Springs([-1.0, 1.0], [1e8] * 3), "stiffness must be one number, or one for each", "stiffness"),
        (lambda: rf.Springs([-1.0, 1.0], "stiff"), "stiffness must be a finite number in N/m", "stiffness"),
        (lambda: rf.Springs([-1.0, 1.0], math.inf), "stiffness must be a finite number in N/m, but inf", "stiffness"),
        (lambda: rf.Springs([-1.0, 1.0], 1e8, [0.0, -2.0]), "damping must be zero or positive", "damping"),
        (lambda: rf.Springs([-1.0, 1.0], 1e8, area=0.0), "area must be positive, but area[0] = 0 m² was", "area"),
        (lambda: rf.Springs([0.0], 1e8), "positions must have 2 to 200 springs, but 1 were given. A", "positions"),
        (lambda: rf.Springs([-1.0, 1.0, 1.0], 1e8), "positions must increase from left to right", "positions"),
        (lambda: rf.Springs([0.0, 3.0], 1e8), "positions must be on both sides of the axis", "positions"),
        (lambda: SPRINGS.damped(-0.1, 1e4), "heave_damping_ratio must be a zero or positive", "heave_damping_ratio"),
        (lambda: SPRINGS.damped(0.1, 0.0), "mass must be a positive, finite number in kg, but 0.0 was given.", "mass"),
        (rf.Ground, "Ground needs friction, springs or both: Ground(friction=0.4), for example. Leave", None),
        (lambda: rf.Ground(0.0), f"{COEFFICIENT}, but 0.0 was given.", "friction"),
        (lambda: rf.Ground(True), f"{COEFFICIENT}, but True was given.", "friction"),
        (lambda: rf.Ground(math.nan), f"{COEFFICIENT}, but nan was given.", "friction"),
        (lambda: rf.Ground([0.3, 0.4]), f"{COEFFICIENT}, but [0.3, 0.4] was given. Several coefficients need springs, "
         "one for each.", "friction"),
        (lambda: rf.Ground([0.3, -0.4, 0.1], SPRINGS, 1e3), f"{COEFFICIENT}, or one for each spring, but "
         "[0.3, -0.4, 0.1] was given.", "friction"),
        (lambda: rf.Ground([0.3, 0.4], SPRINGS, 1e3), "friction must be one number, or one for each", "friction"),
        (lambda: rf.Ground(springs=[1.0]), "springs must be of type Springs, but list was given.", "springs"),
        (lambda: rf.Ground(springs=SPRINGS), "A base without rotary inertia on springs has", "base_inertia"),
        (lambda: rf.Ground(springs=SPRINGS, base_inertia=-1.0), "base_inertia must be a zero or", "base_inertia"),
        (lambda: rf.Ground(0.4, base_inertia=1e3), "base_inertia belongs to springs, but 1000.0 was", "base_inertia"),
        (lambda: rf.winkler_bed(B, BREADTH, MODULUS, end_zone=2.0), "end_zone must lie in [0, 2)", "end_zone"),
        (lambda: rf.winkler_bed(B, BREADTH, MODULUS, end_zone=0.5, n=2), "n must be a whole number from 3", "n"),
        (lambda: rf.winkler_bed(B, BREADTH, MODULUS, eccentricity=-2.0), "eccentricity must be less than half_width 2 "
         "m, but -2 m was given.", "eccentricity"),
        (lambda: rf.asce41_bed(B, BREADTH, 2e7, 0.6), "poisson_ratio must be from 0 to 0.5, but 0.6", "poisson_ratio"),
        (lambda: rf.asce41_bed(B, 12.0, 2e7, 0.3), "The end zones of ASCE 41, breadth/6 = 2 m each, cover", "breadth"),
    ],
)  # fmt: skip
def test_bad_values_are_refused(make, message, field):
    with pytest.raises(rf.InputError) as raised:
        make()
    assert str(raised.value).startswith(message)
    assert raised.value.field == field


def test_a_block_needs_no_inertia_of_its_base_but_a_frame_with_all_modes_does():
    """The rotary inertia of a block is its own; that of a frame of lumped masses is the base's."""
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0, mass=1e5)
    b = block.half_width
    springs = rf.Springs([-b, b], 0.5 * block.m_tot * 9.81 / 1e-3).damped(0.2, block.m_tot)
    with pytest.raises(rf.InputError, match=r"0 where the structure has its own.*twice"):
        rf.Ground(springs=springs)
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    below = rf.Ground(springs=rf.Springs([-0.5, 0.5], 1e9), base_inertia=0.0)
    with pytest.raises(rf.InputError, match="no inertia against rotation") as caught:
        rf.simulate(frame, rf.quiet_motion(1.0), ground=below)
    assert caught.value.field == "base_inertia"
    pulse = rf.one_sine_pulse(2.5, 1.5)
    own, rest = (
        rf.simulate(block, pulse, "rigid", ground=rf.Ground(springs=springs, base_inertia=inertia), output="peaks")
        for inertia in (0.0, 1e-6)
    )
    assert own.max_rotation == pytest.approx(rest.max_rotation, rel=1e-6)
