"""What the README and the theory say of the base moment of a structure that rocks."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame()
SUITE = rf.load_suite("fema-p695-far-field")


@pytest.mark.parametrize("name", ["FF-2-a", "FF-12-b"])
def test_the_base_moment_while_rocking_is_the_weight_and_the_inertia_of_the_base_that_lifts(name):
    p = FRAME.rocking()
    r = rf.simulate(p, SUITE[name], "MDOF-S")
    rocks = r.side != 0
    damping = (r.modal_velocity * (2.0 * p.zeta * p.omega * p.effective_mass * p.effective_height)).sum(axis=1)
    weight = r.side * p.resisting_moment - p.l0r * 9.81 * r.rotation
    expected = weight + p.m_tot * p.half_width**2 * r.rotation_acceleration
    # Rounding of sums of forces that are some times the base moment.
    assert np.abs(r.base_moment + damping - expected)[rocks].max() < 1e-9 * p.resisting_moment
    assert rocks.sum() > 100


def test_the_base_moment_peaks_above_what_the_weight_at_rest_resists():
    table = rf.simulate_many(FRAME, SUITE, ["2DOF-S", "MDOF-S"], scales=(1.0, 2.0))
    rocking = table[table["status"] == "rocking"]
    ratio = rocking["max_base_moment"] / FRAME.rocking().resisting_moment
    low, high = np.quantile(ratio, (0.05, 0.95))
    assert 1.1 < low < high < 2.0
    assert ratio.min() > 1.0
    medians = rocking.groupby("scale")["max_base_moment"].median()
    assert medians[2.0] / medians[1.0] < 1.3  # twice the shaking
