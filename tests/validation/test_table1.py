"""Silva & Stojadinović 2024, Table 1: the six prototypes, to every printed digit (all are rounded)."""

from dataclasses import dataclass

import numpy as np
import pytest

from builders import make_frame
from rockflex.structure import Frame

SHEAR_MASSES, SHEAR_HEIGHTS = "0.88 0.09 0.02 0.008 0.002", "0.70 -0.24 0.15 -0.12 0.10"
FLEXURE_MASSES, FLEXURE_HEIGHTS = "0.68 0.21 0.07 0.03 0.01", "0.79 0.23 0.14 0.10 0.09"


@dataclass(frozen=True)
class Row:
    period: float
    aspect_ratio: float
    stiffness_ratio: float
    inertia: str
    moment: str
    masses: str
    heights: str

    @property
    def frame(self) -> Frame:
        return make_frame(stiffness_ratio=self.stiffness_ratio, period=self.period, aspect_ratio=self.aspect_ratio)


TABLE_1 = {
    1: Row(1.0, 10.0, np.inf, "1.03", "1.03", SHEAR_MASSES, SHEAR_HEIGHTS),
    2: Row(1.0, 10.0, 0.0, "1.05", "0.90", FLEXURE_MASSES, FLEXURE_HEIGHTS),
    3: Row(0.5, 10.0, np.inf, "1.03", "1.03", SHEAR_MASSES, SHEAR_HEIGHTS),
    4: Row(0.5, 10.0, 0.0, "1.05", "0.90", FLEXURE_MASSES, FLEXURE_HEIGHTS),
    5: Row(1.0, 5.0, np.inf, "1.07", "1.03", SHEAR_MASSES, SHEAR_HEIGHTS),
    6: Row(1.0, 5.0, 0.0, "1.10", "0.90", FLEXURE_MASSES, FLEXURE_HEIGHTS),
}


@pytest.fixture(params=TABLE_1.values(), ids=[f"structure {number}" for number in TABLE_1])
def row(request):
    return request.param


def as_printed(values, printed):
    """Write every value with as many decimals as the table gives it."""
    pairs = zip(np.atleast_1d(values), printed.split(), strict=True)
    return " ".join(f"{value:.{len(text.partition('.')[2])}f}" for value, text in pairs)


def test_moment_of_inertia(row):
    props = row.frame.rocking()
    ratio = props.i_theta / (props.effective_mass[0] * props.effective_height[0] ** 2)
    assert as_printed(ratio, row.inertia) == row.inertia


def test_first_mode_participation_in_the_base_moment(row):
    props = row.frame.rocking()
    ratio = props.effective_mass[0] * props.effective_height[0] / props.l0r
    assert as_printed(ratio, row.moment) == row.moment


def test_effective_masses(row):
    assert as_printed(row.frame.modal().effective_mass / (5 * 40e3), row.masses) == row.masses


def test_effective_heights(row):
    assert as_printed(row.frame.modal().effective_height / 15.0, row.heights) == row.heights


def test_period_and_aspect_ratio(row):
    props = row.frame.rocking()
    assert 2.0 * np.pi / props.omega[0] == pytest.approx(row.period, rel=1e-12)
    assert props.effective_height[0] / props.half_width == pytest.approx(row.aspect_ratio, rel=1e-12)
