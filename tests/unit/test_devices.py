"""Tendons, fuses and springs from geometry: values of standards, mechanics on its own, scaling, and bad input."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import quad

import rockflex as rf
from rockflex.structure._devices import STEELS, STRANDS

KIP, INCH = 4448.2216, 0.0254
SOIL = {"shear_modulus": 30e6, "poisson_ratio": 0.3}


@pytest.mark.parametrize(
    ("name", "area", "breaking", "yielding", "tolerance"),
    [
        ("Y1860S7-15.7", 150e-6, 1860e6 * 150e-6, 0.88 * 279e3, 3e-3),  # EN: f_pk, and 0.88 of it, in whole kN
        ("Y1860S7-15.3", 140e-6, 1860e6 * 140e-6, 0.88 * 260e3, 3e-3),
        ("Y1860S7-12.9", 100e-6, 1860e6 * 100e-6, 0.88 * 186e3, 3e-3),
        ("Y1860S7-12.5", 93e-6, 1860e6 * 93e-6, 0.88 * 173e3, 3e-3),
        ("A416-270-0.6in", 0.217 * INCH**2, 58.6 * KIP, 52.74 * KIP, 1e-3),  # ASTM A416, in pounds and inches
        ("A416-270-0.5in", 0.153 * INCH**2, 41.3 * KIP, 37.17 * KIP, 1e-3),
    ],
)
def test_strands_are_those_of_their_standards(name, area, breaking, yielding, tolerance):
    strand = STRANDS[name]
    found = [strand.area, strand.breaking_force, strand.yield_force]
    np.testing.assert_allclose(found, [area, breaking, yielding], rtol=tolerance)


def test_a_tendon_of_strands_by_hand():
    tendon = rf.strand_tendon(12, "Y1860S7-15.7", 15.0, 0.5, position=0.3)
    assert tendon.initial_force == pytest.approx(0.5 * 12 * 279e3, rel=1e-15)
    assert tendon.stiffness == pytest.approx(12 * 195e9 * 150e-6 / 15.0, rel=1e-15)
    assert (tendon.yield_force, tendon.position, tendon.post_yield_ratio) == (12 * 246e3, 0.3, None)
    double = rf.strand_tendon(24, "Y1860S7-15.7", 30.0, 0.5)
    assert double.stiffness == pytest.approx(tendon.stiffness, rel=1e-15)
    assert double.initial_force == pytest.approx(2.0 * tendon.initial_force, rel=1e-15)


def test_the_strain_at_which_a_tendon_breaks_includes_that_of_the_prestress():
    tendon = rf.strand_tendon(3, "A416-270-0.6in", 20.0, 0.6, post_yield_ratio=0.02, ultimate_strain=0.02)
    strain = tendon.initial_force / (tendon.stiffness * 20.0) + tendon.rupture_elongation / 20.0
    assert strain == pytest.approx(0.02, rel=1e-14)


@pytest.mark.parametrize("name", ["B500B", "A706-60", "S355"])
def test_bars_reach_the_tensile_strength_at_the_ultimate_strain(name):
    steel, area = STEELS[name], 3 * math.pi * 0.025**2 / 4.0
    fuse = rf.bar_fuse(3, 0.025, 0.8, name, tension_only=True, height=2.0, cosine=0.8)
    assert (fuse.height, fuse.cosine, fuse.tension_only) == (2.0, 0.8, True)
    assert fuse.stiffness == pytest.approx(steel.modulus * area / 0.8, rel=1e-14)
    assert fuse.yield_force == pytest.approx(steel.yield_strength * area, rel=1e-14)
    assert fuse.rupture_elongation == pytest.approx(0.8 * steel.ultimate_strain, rel=1e-14)
    plastic = fuse.rupture_elongation - fuse.yield_force / fuse.stiffness
    largest = fuse.yield_force + fuse.post_yield_ratio * fuse.stiffness * plastic
    assert largest == pytest.approx(steel.tensile_strength * area, rel=1e-13)


def test_steels_of_ones_own_and_other_strains():
    mean = rf.Steel(330e6, 460e6, 0.2, 205e9)
    assert rf.bar_fuse(1, 0.02, 0.5, mean).yield_force == pytest.approx(330e6 * math.pi * 1e-4, rel=1e-14)
    limited = rf.bar_fuse(1, 0.02, 0.5, mean, ultimate_strain=0.05)
    assert limited == dataclasses.replace(rf.bar_fuse(1, 0.02, 0.5, mean), rupture_elongation=0.025)
    # ASTM A706 in ksi; k of EN 1992-1-1, Table C.1
    assert STEELS["A706-60"].tensile_strength / STEELS["A706-60"].yield_strength == pytest.approx(80 / 60, 1e-2)
    assert STEELS["B500B"].tensile_strength == pytest.approx(1.08 * 500e6, rel=1e-15)


def flexural_plate_displacement(share, width, thickness, diameter, steel):
    """Displacement under a share of the plastic force: a thin semicircle of ideally plastic strips, by virtual work.

    The apex is free of moment, and the ends do not turn: M = F r sin φ from the apex to either leg.
    """
    r, I = diameter / 2.0, width * thickness**3 / 12.0  # noqa: E741
    first = steel.yield_strength * width * thickness**2 / 6.0
    force = share * 1.5 * first / r

    def product(angle):
        m = force * r * math.sin(angle) / first
        curvature = m if m <= 1.0 else 1.0 / math.sqrt(3.0 - 2.0 * m)  # over that at first yield
        return math.sin(angle) * curvature

    where = [math.asin(min(1.0, 1.0 / (1.5 * share)))]
    return 2.0 * r**2 * first / (steel.modulus * I) * quad(product, 0.0, math.pi / 2.0, points=where, limit=200)[0]


def test_flexural_plates_against_a_plastic_curved_beam():
    plate, steel = (0.12, 0.012, 0.12), STEELS["S355"]
    fuse = rf.u_plate_fuse(1, *plate, "S355")
    elastic = 4.0 * steel.modulus * plate[0] / (3.0 * math.pi) * (plate[1] / plate[2]) ** 3
    small = 0.5 * fuse.yield_force / flexural_plate_displacement(0.5, *plate, steel)
    assert small == pytest.approx(elastic, rel=1e-9)
    assert fuse.stiffness == pytest.approx(4.0 / 9.0 * elastic, rel=1e-14)
    near = [share * fuse.yield_force / flexural_plate_displacement(share, *plate, steel) for share in (0.997, 0.998)]
    assert near[0] > fuse.stiffness > near[1]  # the slope to F_y, in the docstring to three digits


def test_flexural_plates_scale():
    one = rf.u_plate_fuse(1, 0.1, 0.01, 0.1, "B500B", post_yield_ratio=0.03)
    larger = rf.u_plate_fuse(4, 0.2, 0.02, 0.2, "B500B", post_yield_ratio=0.03, position=1.0)
    assert larger.yield_force == pytest.approx(16.0 * one.yield_force, rel=1e-14)
    assert larger.stiffness == pytest.approx(8.0 * one.stiffness, rel=1e-14)
    assert (larger.position, larger.post_yield_ratio, larger.rupture_elongation) == (1.0, 0.03, None)


@pytest.mark.parametrize("n", [2, 3, 20, 200])
@pytest.mark.parametrize(
    ("half_width", "breadth", "heave", "rotation"),
    [
        # 3 m by 2 m: Gazetas (1991) by hand, with I^0.75 = 4.5^0.75 along the length and 2^0.75 across it
        (1.5, 2.0, 239.939e6, 422.151e6),
        (1.0, 3.0, 239.939e6, 218.027e6),
    ],
)
def test_springs_have_the_stiffness_of_gazetas(half_width, breadth, heave, rotation, n):
    springs = rf.gazetas_bed(half_width, breadth, **SOIL, n=n)
    assert springs.n == n
    assert springs.rotational_stiffness == pytest.approx(rotation, rel=2e-6)  # six digits above
    assert springs.area.sum() == pytest.approx(2.0 * half_width * breadth, rel=1e-13)
    if n == 2:
        assert springs.total_stiffness == pytest.approx(heave, rel=2e-6)
    else:
        inner = np.abs(springs.positions) < 0.7 * half_width
        per_area = springs.stiffness / springs.area
        np.testing.assert_allclose(per_area[inner], heave / (2.0 * half_width * breadth), rtol=2e-6)
        assert np.ptp(per_area[~inner]) < 1e-9 * per_area.max()
        assert springs.total_stiffness > heave


def test_the_stiffness_of_the_ends_tends_to_that_of_nist():
    B, width, zone = 1.5, 2.0, 0.3
    heave, rotation = 239.939e6, 422.151e6
    even = heave / (2.0 * B * width) * width * 2.0 * B**3 / 3.0
    expected = (rotation / even - (1.0 - zone) ** 3) / (1.0 - (1.0 - zone) ** 3)
    errors = []
    for n in (20, 40, 80):  # 3, 6 and 12 in each zone
        stiffness = rf.gazetas_bed(B, width, **SOIL, n=n).stiffness
        errors.append(stiffness[0] / stiffness[n // 2] - expected)
    np.testing.assert_allclose(errors[1:], np.array(errors[:-1]) / 4.0, rtol=0.1)  # as 1/n²
    assert abs(errors[-1]) < 0.01


def test_springs_stay_under_the_base_where_both_stiffnesses_would_need_a_wider_one():
    springs = rf.gazetas_bed(1.0, 8.0, **SOIL, n=2, eccentricity=0.2)
    np.testing.assert_allclose(springs.positions, [-1.2, 0.8], rtol=1e-15)
    middle = springs.stiffness @ (springs.positions + 0.2) ** 2
    across = 4.0**0.25 * (2.4 + 0.5 / 4.0) * (8.0 * 8.0 / 12.0) ** 0.75 * 30e6 / 0.7
    assert middle == pytest.approx(across, rel=1e-13)


def test_dashpots_radiate_from_the_area():
    density, poisson = 1900.0, 0.3
    wave = 3.4 / (math.pi * (1.0 - poisson)) * math.sqrt(30e6 / density)
    for n in (2, 20):
        springs = rf.gazetas_bed(1.5, 2.0, **SOIL, n=n, density=density)
        assert springs.total_damping == pytest.approx(density * wave * 6.0, rel=1e-13)
        assert not rf.gazetas_bed(1.5, 2.0, **SOIL, n=n).damping.any()
    bed = rf.gazetas_bed(1.5, 2.0, **SOIL, n=200, density=density)
    limit = density * wave * 2.0 * 3.0**3 / 12.0  # ρ V_La I; the strips have 1 - 1/n² of it
    assert bed.damping @ bed.positions**2 == pytest.approx(limit * (1.0 - 1.0 / 200**2), rel=1e-3)  # unequal strips


@pytest.mark.parametrize(
    ("make", "said", "field"),
    [
        (lambda: rf.strand_tendon(2, "Y1860", 15.0, 0.5), "Y1860S7-15.7", "strand"),
        (lambda: rf.strand_tendon(2, ["Y1860"], 15.0, 0.5), "Strand", "strand"),
        (lambda: rf.strand_tendon(2, "Y1860S7-15.7", 15.0, 0.9), "share of F_pk", "prestress"),
        (lambda: rf.strand_tendon(2, "Y1860S7-15.7", 15.0, 0.5, ultimate_strain=0.02), "yields", "ultimate_strain"),
        (
            lambda: rf.strand_tendon(2, "Y1860S7-15.7", 15.0, 0.5, post_yield_ratio=0.1, ultimate_strain=0.008),
            "0.00841",
            "ultimate_strain",
        ),
        (lambda: rf.bar_fuse(1, 25, 0.5, "B500B"), "in m", "diameter"),
        (lambda: rf.bar_fuse(1, 0.02, 0.5, "steel"), "B500B", "steel"),
        (lambda: rf.bar_fuse(1, 0.02, 0.5, "B500B", ultimate_strain=0.001), "0.0025", "ultimate_strain"),
        (lambda: rf.bar_fuse(1, 0.02, 0.5, "B500B", ultimate_strain=5.0), "below 1", "ultimate_strain"),
        (lambda: rf.u_plate_fuse(1, 0.1, 0.2, 0.1, "S355"), "below the diameter", "thickness"),
        (lambda: rf.Strand(0.0, 2e5, 1.8e5, 2e11), "positive", "area"),
        (lambda: rf.Strand(1e-4, 2e5, 2.8e5, 2e11), "not exceed", "yield_force"),
        (lambda: rf.Steel(5e8, 4e8, 0.05, 2e11), "tensile_strength", "tensile_strength"),
        (lambda: rf.Steel(5e8, 6e8, 0.002, 2e11), "0.0025", "ultimate_strain"),
        (lambda: rf.gazetas_bed(1.0, 100.0, **SOIL), "units", "breadth"),
        (lambda: rf.gazetas_bed(1.0, 1.0, 3e7, 0.6), "0 to 0.5", "poisson_ratio"),
        (lambda: rf.gazetas_bed(1.0, 1.0, **SOIL, n=2, end_zone=0.1), "more than two", "end_zone"),
        (lambda: rf.gazetas_bed(1.0, 1.0, **SOIL, end_zone=1.0), "[0, 1)", "end_zone"),
        (lambda: rf.gazetas_bed(1.0, 1.0, **SOIL, n=2, eccentricity=1.0), "half_width", "eccentricity"),
    ],
)
def test_bad_values_are_refused(make, said, field):
    with pytest.raises(rf.InputError) as raised:
        make()
    assert said in str(raised.value)
    assert raised.value.field == field


def test_an_unknown_steel_in_a_file(tmp_path):
    path = tmp_path / "fused.toml"
    fuse = '[[elements]]\nkind = "bar_fuse"\nn = 1\ndiameter = 0.02\nlength = 0.5\nsteel = "S999"\n'
    path.write_text("block = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 }\n" + fuse)
    with pytest.raises(rf.InputError, match=r"steel must be a steel: .*S355.*S999"):
        rf.read_structure(path)
    path.write_text(path.read_text().replace("S999", "S355"))
    assert rf.read_structure(path).elements == (rf.bar_fuse(1, 0.02, 0.5, "S355"),)


def test_random_devices_in_a_study():
    known = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": 1.0}
    known |= {"period": 0.5, "aspect_ratio": 8.0, "damping_ratio": 0.02}
    fuse = {"kind": "bar_fuse", "n": 2, "diameter": "= d", "length": 0.5, "steel": "B500B", "position": "= half_width"}
    study = rf.MonteCarloStudy(
        count=2,
        variables={"d": {"uniform": [0.018, 0.024]}},
        structure={"frame": known, "elements": [fuse]},
        records={"suites": ["el-centro-1940"]},
    )
    (made,) = study.structure_of(1).elements
    assert 0.018**2 < made.yield_force / (2 * 500e6 * math.pi / 4.0) < 0.024**2
    assert made.position == pytest.approx(study.structure_of(1).half_width, rel=1e-15)
