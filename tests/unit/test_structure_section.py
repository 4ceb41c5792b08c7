"""Cross-sections against integration over their fibres and hand calculations, alone, in columns and in files."""

import dataclasses
import math

import numpy as np
import pytest

import rockflex as rf
from rockflex import InputError

CONCRETE = {"elastic_modulus": 30e9, "density": 2500.0}
STEEL = {"elastic_modulus": 210e9, "density": 7850.0}
SHAPES = {
    "rectangle": (rf.Section.rectangle(1.2, 2.5, **CONCRETE), lambda y: np.full_like(y, 1.2), 2.5),
    "box": (
        rf.Section.box(4.0, 2.5, 0.3, **CONCRETE),
        lambda y: np.where(np.abs(y) > 0.95, 4.0, 0.6),
        2.5,
    ),
    "circle": (rf.Section.circle(1.6, **CONCRETE), lambda y: 2.0 * np.sqrt(0.64 - y**2), 1.6),
    "tube": (
        rf.Section.tube(1.6, 0.1, **CONCRETE),
        lambda y: 2.0 * (np.sqrt(0.64 - y**2) - np.sqrt(np.maximum(0.49 - y**2, 0.0))),
        1.6,
    ),
}
COLUMN = {"height": 12.0, "tip_mass": 50e3, "base_mass": 10e3, "half_width": 1.2, "damping_ratio": 0.03}
PIER = rf.Section.box(3.0, 2.0, 0.25, **CONCRETE, stiffness_factor=0.5)


@pytest.mark.parametrize("name", SHAPES)
def test_area_and_second_moment_are_integrals_over_the_depth(name):
    section, width, depth = SHAPES[name]
    n = 1_000_000
    y = (np.arange(n) + 0.5) / n * depth - 0.5 * depth
    assert section.area == pytest.approx(width(y).sum() * depth / n, rel=1e-8)
    assert section.second_moment == pytest.approx((width(y) * y**2).sum() * depth / n, rel=1e-7)
    assert section.bending_stiffness == 30e9 * section.second_moment
    assert section.mass_per_length == 2500.0 * section.area
    assert section.rotary_inertia == 2500.0 * section.second_moment


def test_cracking_reduces_the_stiffness_alone():
    whole = rf.Section.box(3.0, 2.0, 0.25, **CONCRETE)
    assert pytest.approx(0.5 * whole.bending_stiffness, rel=1e-15) == PIER.bending_stiffness
    assert (PIER.second_moment, PIER.mass_per_length) == (whole.second_moment, whole.mass_per_length)
    assert dataclasses.replace(PIER, stiffness_factor=1.0) == whole


def test_parts_of_one_section_make_that_section():
    whole = rf.Section.rectangle(0.5, 2.0, **CONCRETE)
    part = rf.Section.rectangle(0.5, 1.0, **CONCRETE)
    made = rf.Section.composite([(part, 10.0), (part, 11.0)])  # from any axis
    for name in ("area", "second_moment", "density", "rotary_inertia", "bending_stiffness", "mass_per_length"):
        assert getattr(made, name) == pytest.approx(getattr(whole, name), rel=1e-13)


def test_a_composite_section_by_hand():
    # A slab on a girder: n = 1/7 for the concrete, relative to the steel.
    girder, slab = rf.Section(0.05, 0.02, **STEEL), rf.Section.rectangle(3.0, 0.2, **CONCRETE)
    made = rf.Section.composite([(girder, 0.0), (slab, 1.1)])
    area = 0.05 + 0.6 / 7.0
    axis = 0.6 / 7.0 * 1.1 / area
    second = 0.02 + 0.05 * axis**2 + (3.0 * 0.2**3 / 12.0 + 0.6 * (1.1 - axis) ** 2) / 7.0
    assert made.area == pytest.approx(area, rel=1e-14)
    assert made.second_moment == pytest.approx(second, rel=1e-14)
    assert made.bending_stiffness == pytest.approx(210e9 * second, rel=1e-14)
    assert made.mass_per_length == pytest.approx(0.05 * 7850.0 + 0.6 * 2500.0, rel=1e-14)
    about = 0.02 * 7850.0 + 0.05 * 7850.0 * axis**2 + 2500.0 * (0.002 + 0.6 * (1.1 - axis) ** 2)
    assert made.rotary_inertia == pytest.approx(about, rel=1e-14)
    # The reference does not matter to the stiffness, and a cracked slab counts with its part.
    other = rf.Section.composite([(slab, 1.1), (girder, 0.0)], stiffness_factor=0.8)
    assert other.bending_stiffness == pytest.approx(0.8 * made.bending_stiffness, rel=1e-13)
    half = rf.Section.composite([(girder, 0.0), (dataclasses.replace(slab, stiffness_factor=0.5), 1.1)])
    assert half.area == pytest.approx(0.05 + 0.3 / 7.0, rel=1e-14)
    assert half.mass_per_length == pytest.approx(made.mass_per_length, rel=1e-14)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rf.Section(0.0, 1.0, 1.0, 1.0), "area must be a positive, finite number in m²"),
        (lambda: rf.Section(1.0, math.nan, 1.0, 1.0), "second_moment must be a positive, finite number in m⁴"),
        (lambda: rf.Section(1.0, 1.0, -1.0, 1.0), "elastic_modulus must be a positive, finite number in N/m²"),
        (lambda: rf.Section(1.0, 1.0, 1.0, 0.0), "density must be a positive, finite number in kg/m³"),
        (lambda: rf.Section(1.0, 1.0, 1.0, 1.0, 0.0), "must be a positive, finite number in fractions"),
        (lambda: rf.Section(1.0, 1.0, 1.0, 1.0, 35.0), "at most 1, but 35 was given. Half the uncracked"),
        (lambda: rf.Section(1.0, 1.0, 1.0, 1.0, 1.0, 0.0), "rotary_inertia must be a positive, finite number in kg m"),
        (lambda: rf.Section(1.0, 1e200, 1e200, 1.0), "bending_stiffness of the section must be positive"),
        (lambda: rf.Section.rectangle(1.0, 0.0, **CONCRETE), "depth must be a positive"),
        (lambda: rf.Section.box(2.0, 1.0, 0.5, **CONCRETE), "less than half of 1 m, but 0.5 m was given"),
        (lambda: rf.Section.tube(1.0, 0.5, **CONCRETE), "Without a hollow it is a circle"),
        (lambda: rf.Section.circle(1.0, **CONCRETE, stiffness_factor=-1), "stiffness_factor must be a positive"),
        (lambda: rf.Section.composite([]), "parts must hold one section at least"),
        (lambda: rf.Section.composite(3), "a list of sections and offsets, [(section, offset), ...], but 3"),
        (lambda: rf.Section.composite([PIER]), "parts must be a list of sections and offsets"),
        (lambda: rf.Section.composite([(1.0, PIER)]), "1.0 stands in place of a section"),
        (lambda: rf.Section.composite([(PIER, math.inf)]), "parts: the offset must be a finite number in m"),
    ],
)  # fmt: skip
def test_sections_are_checked(make, said):
    with pytest.raises(InputError) as refused:
        make()
    assert said in str(refused.value)


def test_a_column_takes_stiffness_and_mass_from_its_section():
    column = rf.CantileverWithTipMass(**COLUMN, section=PIER)
    numbers = rf.CantileverWithTipMass(
        **COLUMN, bending_stiffness=PIER.bending_stiffness, mass_per_length=PIER.mass_per_length
    )
    assert (column.bending_stiffness, column.mass_per_length) == (PIER.bending_stiffness, PIER.mass_per_length)
    assert column.rocking() == numbers.rocking()
    assert (
        dataclasses.replace(column, half_width=2.0).rocking() == dataclasses.replace(numbers, half_width=2.0).rocking()
    )


def test_a_beam_takes_stiffness_and_mass_from_its_section():
    given = {"height": 20.0, "half_width": 1.0, "damping_ratio": 0.02, "n_modes": 2}
    beam = rf.Beam(**given, section=PIER, rotary_inertia=PIER.rotary_inertia)
    numbers = rf.Beam(
        **given,
        mass=PIER.mass_per_length,
        bending_stiffness=PIER.bending_stiffness,
        rotary_inertia=PIER.rotary_inertia,
    )
    assert (beam.bending_stiffness, beam.mass) == (PIER.bending_stiffness, PIER.mass_per_length)
    assert beam.rocking() == numbers.rocking()
    assert dataclasses.replace(beam, half_width=2.0).half_width == 2.0
    # Euler and Bernoulli: ω_1 = 3.516 √(EI/m)/H², without rotary inertia.
    plain = rf.Beam(**given, section=PIER)
    omega = 1.8751040687119611**2 * math.sqrt(PIER.bending_stiffness / PIER.mass_per_length) / 20.0**2
    assert plain.modal().omega[0] == pytest.approx(omega, rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "bending_stiffness is missing: give it, or a section."),
        ({"section": 3.0}, "section must be a Section, such as Section.circle(...), but 3.0 was given."),
        ({"section": PIER, "bending_stiffness": 1e9}, "bending_stiffness is 1.5e+10 by the section, but 1000000000.0"),
        ({"section": PIER, "mass_per_length": 1e3}, "without a section, such as section.mass_per_length."),
    ],
)
def test_a_column_has_one_stiffness(changes, said):
    pier = rf.Section(2.0, 0.5, 30e9, 2500.0)
    changes = {name: pier if value is PIER else value for name, value in changes.items()}
    with pytest.raises(InputError) as refused:
        rf.CantileverWithTipMass(**COLUMN, **changes)
    assert said in str(refused.value)


def test_a_beam_has_one_mass():
    given = {"height": 20.0, "half_width": 1.0, "damping_ratio": 0.02}
    with pytest.raises(InputError, match="mass is missing: give it, or a section"):
        rf.Beam(**given, bending_stiffness=1e9)
    with pytest.raises(InputError, match=r"mass is 5625 by the section, but \(\[0.0, 20.0\], \[1.0, 2.0\]\) was given"):
        rf.Beam(**given, section=PIER, mass=([0.0, 20.0], [1.0, 2.0]))


FILE = """
[cantilever]
height = 12.0
tip_mass = 50e3
base_mass = 10e3
half_width = 1.2
damping_ratio = 0.03

[cantilever.section]
"""
MATERIAL = "elastic_modulus = 30e9\ndensity = 2500.0\n"


PARTS = 'shape = "composite"\n[[cantilever.section.parts]]\n'


@pytest.fixture
def read(tmp_path):
    def build(section, head=FILE):
        path = tmp_path / "structure.toml"
        path.write_text(head + section, "utf-8")
        return rf.read_structure(path)

    return build


@pytest.mark.parametrize(
    ("section", "made"),
    [
        ('shape = "rectangle"\nwidth = 1.2\ndepth = 2.5\n', SHAPES["rectangle"][0]),
        ('shape = "box"\nwidth = 4\ndepth = 2.5\nwall = 0.3\n', SHAPES["box"][0]),
        ('shape = "circle"\ndiameter = 1.6\n', SHAPES["circle"][0]),
        ('shape = "tube"\ndiameter = 1.6\nwall = 0.1\n', SHAPES["tube"][0]),
    ],
)
def test_files_have_sections(read, section, made):
    assert read(section + MATERIAL) == rf.CantileverWithTipMass(**COLUMN, section=made)
    beam = "[beam]\nheight = 12.0\nhalf_width = 1.2\ndamping_ratio = 0.03\n[beam.section]\n"
    assert read(section + MATERIAL, beam) == rf.Beam(height=12.0, half_width=1.2, damping_ratio=0.03, section=made)


def test_files_have_composite_sections(read):
    parts = """shape = "composite"
stiffness_factor = 0.7
[[cantilever.section.parts]]
shape = "tube"
diameter = 1.0
wall = 0.02
elastic_modulus = 210e9
density = 7850.0
[[cantilever.section.parts]]
shape = "circle"
diameter = 0.96
offset = 0.01
stiffness_factor = 0.6
"""
    tube = rf.Section.tube(1.0, 0.02, **STEEL)
    core = rf.Section.circle(0.96, **CONCRETE, stiffness_factor=0.6)
    made = rf.Section.composite([(tube, 0.0), (core, 0.01)], stiffness_factor=0.7)
    assert read(parts + MATERIAL).section == made


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ('shape = "tube"\ndiameter = 1.6\n' + MATERIAL, "density and stiffness_factor, but it lacks wall."),
        ('shape = "circle"\ndiameter = 1.6\nwall = 0.1\n' + MATERIAL, "density and stiffness_factor, not wall."),
        ('shape = "circle"\ndiameter = 1.6\n', "but it lacks elastic_modulus, density."),
        ('shape = "tube"\ndiameter = 1.6\nwall = 0.9\n' + MATERIAL, "section: wall must be less than half of 1.6 m"),
        ('shape = "composite"\n', "section: parts must hold one section at least"),
        ('shape = "composite"\nwidth = 2.0\n', "section: width belongs to each part of a composite one."),
        (PARTS + 'shape = "circle"\n' + MATERIAL, "part no. 1 of the section: a circle takes"),
        ('shape = "hexagon"\n' + MATERIAL, '[cantilever.section] shape must be one of "rectangle", "box"'),
        ('shape = "circle"\ndiamter = 1.6\n' + MATERIAL, "Did you mean diameter?"),
    ],
)  # fmt: skip
def test_sections_in_files_are_checked(read, section, said):
    with pytest.raises(InputError) as refused:
        read(section)
    assert said in str(refused.value)
