"""Annual rates against the closed form of a power-law hazard and a lognormal capacity.

Cornell, Jalayer, Hamburger & Foutch 2002, J. Struct. Eng. 128(4), 526-533: with λ = k0 IM^-k, a capacity of median
m and dispersion β fails at the rate k0 m^-k exp(k² β²/2).
"""

import math

import numpy as np
import pytest

from rockflex.fragility import CloudFit, HazardCurve, LognormalFragility, annual_rate, risk_targeted_median

K0 = 1e-4
WIDE = np.geomspace(1e-6, 1e6, 60)


@pytest.mark.parametrize("k", [1.5, 2.5, 4.0])
@pytest.mark.parametrize("beta", [0.05, 0.4, 0.8])
@pytest.mark.parametrize("median", [0.2, 1.3])
def test_rate_of_a_lognormal_capacity(k, beta, median):
    hazard = HazardCurve(WIDE, K0 * WIDE**-k)
    expected = K0 * median**-k * math.exp(0.5 * (k * beta) ** 2)
    found = annual_rate(hazard, LognormalFragility(median, beta))
    assert found.rate == pytest.approx(expected, rel=1e-8)
    assert found.beyond < 1e-8 * expected


@pytest.mark.parametrize("points", [2, 3, 17])
def test_the_number_of_points_on_a_power_law_does_not_matter(points):
    im = np.geomspace(1e-4, 1e4, points)
    found = annual_rate(HazardCurve(im, K0 * im**-2.0), LognormalFragility(0.5, 0.3))
    expected = K0 * 0.5**-2.0 * math.exp(0.5 * (2 * 0.3) ** 2)
    assert found.rate + found.above == pytest.approx(expected, rel=1e-8)


def test_rate_of_a_demand_with_scatter():
    """Demand a IM^b with dispersion β exceeds d at λ((d/a)^(1/b)) exp(k² β²/(2 b²)) (ibid.)."""
    a, b, beta, k, limit = 0.02, 1.3, 0.45, 2.2, 0.03
    cloud = CloudFit(math.log(a), b, beta, 0.8, 100, np.zeros((2, 2)))
    hazard = HazardCurve(WIDE, K0 * WIDE**-k)
    expected = K0 * (limit / a) ** (-k / b) * math.exp(0.5 * (k * beta / b) ** 2)
    assert annual_rate(hazard, lambda im: cloud.exceedance(im, limit)).rate == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("k", [1.5, 3.0])
def test_targeted_median_inverts_the_closed_form(k):
    hazard = HazardCurve(WIDE, K0 * WIDE**-k)
    expected = (2e-4 / K0 * math.exp(-0.5 * (k * 0.6) ** 2)) ** (-1 / k)
    assert risk_targeted_median(hazard, 0.6, 2e-4) == pytest.approx(expected, rel=1e-8)
