"""Hazard curves, their files, and annual rates of failure."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate
from scipy.special import expit

from rockflex import InputError
from rockflex.fragility import (
    HazardCurve,
    LognormalFragility,
    UnanimousOutcome,
    annual_rate,
    fit_logistic,
    risk_targeted_median,
)

IM = np.array([0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6])
RATE = np.array([0.2, 0.08, 0.03, 8e-3, 1.5e-3, 1.8e-4, 1e-5])
HAZARD = HazardCurve(IM, RATE)
CURVE = LognormalFragility(0.4, 0.5)
OLD = '# mean, investigation_time=1.0, imt="PGA", checksum=3881327509\n'
NEW = "#,,,,,\"generated_by='OpenQuake engine 3.20.0', kind='mean', investigation_time=50.0, imt='SA(0.2)'\"\n"
ROWS = """lon,lat,depth,poe-0.0050000,poe-0.1000000,poe-0.4000000,poe-2.0000000
7.59000,47.56000,0.00000,1.000000E+00,4.000000E-01,1.000000E-01,0.000000E+00
8.54000,47.38000,0.00000,9.990000E-01,3.000000E-01,5.000000E-02,1.000000E-04
"""
NAMED = """custom_site_id,lon,lat,depth,poe-0.1000000,poe-0.4000000
A,7.59000,47.56000,0.00000,4.000000E-01,1.000000E-01
B,7.59000,47.56000,0.00000,3.000000E-01,2.000000E-01
"""


def test_the_curve_is_straight_in_logarithms():
    assert HAZARD.rate_at(math.sqrt(0.1 * 0.2)) == pytest.approx(math.sqrt(0.03 * 8e-3))
    np.testing.assert_allclose(HAZARD.rate_at(IM), RATE, rtol=1e-12)
    np.testing.assert_allclose(HAZARD.im_at(HAZARD.rate_at([0.03, 0.3, 1.0])), [0.03, 0.3, 1.0], rtol=1e-12)
    np.testing.assert_allclose(HAZARD.slopes[0], math.log(0.2 / 0.08) / math.log(0.05 / 0.02))
    assert HAZARD.rate_at(HAZARD.im_at(1 / 2475)) == pytest.approx(1 / 2475)


def test_the_rate_is_the_integral_over_the_hazard():
    def integrand(rate):  # over λ itself, where the library goes over log IM
        return float(CURVE.probability(HAZARD.im_at(rate)))

    expected = sum(integrate.quad(integrand, b, a, epsrel=1e-12)[0] for a, b in pairwise(RATE))
    assert annual_rate(HAZARD, CURVE).rate == pytest.approx(expected, rel=1e-9)


def test_the_rate_is_also_that_of_the_capacity_exceeded_by_the_demand():
    """By parts: ∫ P |dλ| = ∫ λ dP + P(first) λ(first) - P(last) λ(last)."""

    def integrand(u):
        density = math.exp(-0.5 * ((u - math.log(0.4)) / 0.5) ** 2) / (0.5 * math.sqrt(2 * math.pi))
        return float(HAZARD.rate_at(math.exp(u))) * density

    inside = integrate.quad(integrand, *np.log(IM[[0, -1]]), points=np.log(IM[1:-1]), epsrel=1e-11, limit=500)[0]
    p = CURVE.probability(IM)
    assert annual_rate(HAZARD, CURVE).rate == pytest.approx(inside + p[0] * RATE[0] - p[-1] * RATE[-1], rel=1e-8)


def test_a_sharp_capacity_has_the_rate_at_which_it_is_exceeded():
    found = annual_rate(HAZARD, lambda im: np.where(im > 0.33, 1.0, 0.0)).rate
    assert found == pytest.approx(HAZARD.rate_at(0.33) - RATE[-1], rel=1e-6)
    sharp = annual_rate(HAZARD, LognormalFragility(0.33, 1e-4)).rate
    assert sharp == pytest.approx(HAZARD.rate_at(0.33) - RATE[-1], rel=1e-6)


def test_more_points_on_the_same_curve_change_nothing():
    fine = np.unique(np.r_[IM, np.geomspace(0.02, 1.6, 50)])
    one, two = annual_rate(HAZARD, CURVE), annual_rate(HazardCurve(fine, HAZARD.rate_at(fine)), CURVE)
    assert (one.rate, one.below, one.above) == pytest.approx((two.rate, two.below, two.above), rel=1e-8)


def test_what_lies_beyond_the_ends_is_bounded():
    part = slice(2, 6)
    whole, inner = annual_rate(HAZARD, CURVE), annual_rate(HazardCurve(IM[part], RATE[part]), CURVE)
    assert inner.rate < whole.rate < inner.rate + inner.beyond
    assert inner.above == RATE[5]
    assert inner.beyond == inner.below + inner.above

    def tail(s):
        k = math.log(0.2 / 0.08) / math.log(2.5)
        return float(CURVE.probability(0.02 * math.exp(-s))) * k * 0.2 * math.exp(k * s)

    assert whole.below == pytest.approx(integrate.quad(tail, 0, 20, epsrel=1e-10)[0], rel=1e-6, abs=1e-13)


def test_a_tail_that_grows_without_bound_is_said_to():
    flat = fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0, 1, 0, 1, 0, 1])
    steep = HazardCurve([0.1, 1.0], [0.1, 0.1 * 10 ** -(flat.b1 + 1)])
    assert annual_rate(steep, flat).below == math.inf
    gentle = HazardCurve([0.1, 1.0], [0.1, 0.1 * 10 ** -(flat.b1 - 1)])
    k = flat.b1 - 1
    expected = integrate.quad(
        lambda s: expit(flat.b0 + flat.b1 * (math.log(0.1) - s)) * k * 0.1 * math.exp(k * s), 0, 60, epsrel=1e-10
    )[0]
    assert annual_rate(gentle, flat).below == pytest.approx(expected, rel=1e-6)


def test_constant_probabilities_are_integrated_too():
    never, always = (annual_rate(HAZARD, UnanimousOutcome(each, 10)) for each in (False, True))
    assert (never.rate, never.below) == (0.0, 0.0)
    assert always.rate == pytest.approx(0.2 - 1e-5)
    assert always.below == math.inf


def test_probability_in_years_is_that_of_a_poisson_process():
    found = annual_rate(HAZARD, CURVE)
    assert found.probability_in(50) == pytest.approx(1 - math.exp(-50 * found.rate), rel=1e-12)
    assert found.probability_in(0) == 0.0


def test_the_targeted_median_meets_the_target():
    target = -math.log(0.99) / 50
    median = risk_targeted_median(HAZARD, 0.5, target)
    found = annual_rate(HAZARD, LognormalFragility(median, 0.5))
    assert found.rate == pytest.approx(target, rel=1e-9)
    assert found.probability_in(50) == pytest.approx(0.01, rel=1e-9)


@pytest.mark.parametrize(
    ("im", "rate", "text"),
    [
        ([0.1, 0.2], [0.1, 0.05, 0.01], "a rate for each measure, but 2 measures and 3 rates"),
        ([0.1], [0.1], "two points or more.*but 1 measures"),
        ([0.0, 0.2], [0.1, 0.05], "im must be positive and rise"),
        ([0.2, 0.1], [0.1, 0.05], "im must be positive and rise.*Sort the curve"),
        ([0.1, 0.2, 0.3], [0.1, 0.1, 0.05], r"but rate\[1\] = 0\.1 does not\. Give annual rates"),
        ([0.1, 0.2, 0.3], [0.1, 0.05, 0.0], r"but rate\[2\] = 0 does not\..*drop the points"),
    ],
)
def test_curves_that_are_no_hazard_are_refused(im, rate, text):
    with pytest.raises(InputError, match=text):
        HazardCurve(im, rate)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: HAZARD.rate_at(3.0), "im must lie between 0.02 and 1.6, the ends of the hazard curve"),
        (lambda: HAZARD.im_at(1.0), "rate must lie between 1e-05 and 0.2, the ends"),
        (lambda: annual_rate(HAZARD, 0.4), r"fragility must have a method probability\(im\).*but float"),
        (lambda: annual_rate(HAZARD, lambda im: 2.0 * im), "fragility must give probabilities from 0 to 1, but gave"),
        (lambda: annual_rate(HAZARD, lambda im: im * np.nan), "but gave nan. A part that could not be fitted"),
        (lambda: risk_targeted_median(HAZARD, 0.5, 1.0), r"target_rate must lie between .* but 1 was given\. Extend"),
        (lambda: risk_targeted_median(HAZARD, 0.5, 6e-5), "lie beyond the ends .* above\\), more than 0.1 of the targ"),
    ],
)
def test_arguments_out_of_range_are_refused(call, text):
    with pytest.raises(InputError, match=text):
        call()


def test_a_larger_part_beyond_may_be_allowed():
    assert risk_targeted_median(HAZARD, 0.5, 6e-5, allowed_beyond=0.5) < IM[-1]


@pytest.fixture
def export(tmp_path):
    def write(text):
        path = tmp_path / "hazard_curve-mean-PGA_1.csv"
        path.write_text(text, "utf-8")
        return path

    return write


def test_probabilities_are_those_of_a_poisson_process():
    poe, years = np.array([0.9, 0.1, 1e-12]), 50.0
    curve = HazardCurve.from_poe([0.1, 0.2, 0.4], poe, years)
    np.testing.assert_allclose(curve.rate, [-math.log1p(-p) / years for p in poe], rtol=1e-15)
    np.testing.assert_allclose(-np.expm1(-curve.rate * years), poe, rtol=1e-15)
    assert 1.0 / curve.rate[1] == pytest.approx(474.56, rel=1e-5)  # the return period of 10 % in 50 years
    assert curve == HazardCurve([0.1, 0.2, 0.4], curve.rate)


@pytest.mark.parametrize(
    ("poe", "years", "said"),
    [
        ([1.0, 0.5], 50, r"poe\[0\] = 1 was given. No finite rate gives it: drop such points, or"),
        ([0.5, 0.0], 50, r"poe\[1\] = 0 was given. The rate is zero there: drop such points"),
        ([50.0, 10.0], 50, r"poe\[0\] = 50 was given. Give fractions, not percentages"),
        ([0.5, -0.1], 50, r"poe must lie between 0 and 1"),
        ([0.1, 0.5], 50, "rate must be positive and fall"),
        ([0.5, 0.2, 0.1], 50, "2 measures and 3 rates"),
    ],
)  # fmt: skip
def test_probabilities_are_checked(poe, years, said):
    with pytest.raises(InputError, match=said):
        HazardCurve.from_poe([0.1, 0.2], poe, years)


def test_an_export_becomes_rates_of_measures_in_si_units(export):
    curve = HazardCurve.from_openquake_csv(export(OLD + ROWS), site=(8.54, 47.38))
    np.testing.assert_allclose(curve.im, 9.81 * np.array([0.005, 0.1, 0.4, 2.0]), rtol=1e-15)
    np.testing.assert_allclose(curve.rate, -np.log1p([-0.999, -0.3, -0.05, -1e-4]), rtol=1e-14)
    fifty = HazardCurve.from_openquake_csv(str(export(NEW + ROWS)), site=(8.54, 47.38))
    np.testing.assert_allclose(fifty.rate, curve.rate / 50.0, rtol=1e-14)
    np.testing.assert_array_equal(fifty.im, curve.im)
    velocity = HazardCurve.from_openquake_csv(export(OLD.replace("PGA", "PGV") + ROWS), site=(8.54, 47.38))
    np.testing.assert_allclose(velocity.im, 0.01 * np.array([0.005, 0.1, 0.4, 2.0]), rtol=1e-15)


@pytest.mark.parametrize(
    ("head", "unit"),
    [
        ("# kind=mean, investigation_time=50.0, imt=PGA\n", 9.81),
        ("# investigation_time=50.0, imt=SA(0.2), kind=mean\n", 9.81),
        ("\ufeff# source_model_tree_path=('b1',), investigation_time=50.0,imt=\"PGV\"\n", 0.01),
    ],
)
def test_exports_of_older_versions(export, head, unit):
    typed = ROWS.replace("lat,", "lat:float32,").replace("2.0000000\n", "2.0000000:float32\n")
    curve = HazardCurve.from_openquake_csv(export(head + typed), site=(8.54, 47.38))
    np.testing.assert_allclose(curve.im, unit * np.array([0.005, 0.1, 0.4, 2.0]), rtol=1e-15)
    np.testing.assert_allclose(curve.rate, -np.log1p([-0.999, -0.3, -0.05, -1e-4]) / 50.0, rtol=1e-14)


NRML = """<?xml version="1.0" encoding="UTF-8"?>
<nrml xmlns:gml="http://www.opengis.net/gml" xmlns="http://openquake.org/xmlns/nrml/0.5">
  <hazardCurves statistics="mean" investigationTime="50.0" IMT="SA" saPeriod="0.2" saDamping="2.0">
    <IMLs>0.1 0.4 2.0</IMLs>
    <hazardCurve><gml:Point><gml:pos>7.59 47.56</gml:pos></gml:Point><poEs>0.4 0.1 0.0</poEs></hazardCurve>
    <hazardCurve><gml:Point><gml:pos>8.54 47.38</gml:pos></gml:Point><poEs>0.3 0.05 0.0001</poEs></hazardCurve>
  </hazardCurves>
</nrml>
"""


def test_curves_in_nrml(export):
    curve = HazardCurve.from_openquake_csv(export(NRML), site=(8.54, 47.38))
    np.testing.assert_allclose(curve.im, 9.81 * np.array([0.1, 0.4, 2.0]), rtol=1e-15)
    np.testing.assert_allclose(curve.rate, -np.log1p([-0.3, -0.05, -1e-4]) / 50.0, rtol=1e-14)
    assert curve.damping == 0.02
    alone = """<nrml><hazardCurves IMT="PGA" investigationTime="1"><hazardCurve>
        <IMLs>0.1 0.4</IMLs><poEs>0.3 0.05</poEs></hazardCurve></hazardCurves></nrml>"""
    curve = HazardCurve.from_openquake_csv(export(alone))
    np.testing.assert_allclose(curve.rate, -np.log1p([-0.3, -0.05]), rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (NRML, "has 2 sites. Choose one with site="),
        (NRML.replace("</nrml>", ""), "is no valid XML"),
        (NRML.replace("hazardCurves", "hazardMap"), "hold the hazard curves of one intensity measure"),
        (NRML.replace('IMT="SA"', 'IMT="MMI"').replace("8.54 47.38", "7.59 47.56"), "has 2 sites"),
        (NRML.replace(' investigationTime="50.0"', ""), "'' stands where a number is expected"),
        (NRML.replace("0.4 0.1 0.0", "0.4 0.1"), "a row of 5 values for each site, but 1 row differs"),
        ('<?xml version="1.0"?><!DOCTYPE n [<!ENTITY a "b">]><nrml>&a;</nrml>', "declares entities"),
    ],
)
def test_nrml_is_checked(export, text, said):
    with pytest.raises(InputError) as refused:
        HazardCurve.from_openquake_csv(export(text))
    assert said in str(refused.value)
    assert refused.value.field in ("path", "site")


def test_points_without_a_rate_are_left_out(export):
    curve = HazardCurve.from_openquake_csv(export(OLD + ROWS), site=(7.59, 47.56))
    np.testing.assert_allclose(curve.im, [0.981, 3.924], rtol=1e-15)
    level = ROWS.replace("9.990000E-01", "3.000000E-01")
    curve = HazardCurve.from_openquake_csv(export(OLD + level), site=(8.54, 47.38))
    np.testing.assert_allclose(curve.im, 9.81 * np.array([0.1, 0.4, 2.0]), rtol=1e-15)


def test_one_site_needs_no_choice_and_names_choose(export):
    first = "\n".join(ROWS.splitlines()[:2])
    assert HazardCurve.from_openquake_csv(export(OLD + first)).im.size == 2
    curve = HazardCurve.from_openquake_csv(export(OLD + NAMED), site="B")
    np.testing.assert_allclose(curve.rate, -np.log1p([-0.3, -0.2]), rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "site", "said"),
    [
        (OLD + ROWS, None, "has 2 sites. Choose one with site=(longitude, latitude)."),
        (OLD + ROWS, (7.6, 47.6), "has no site at 7.6, 47.6. The nearest in degrees is at 7.59, 47.56."),
        (OLD + ROWS, "A", "has no names of sites. Give site=(longitude, latitude)."),
        (OLD + ROWS, 3.0, "site must be (longitude, latitude) in degrees, or a name, but 3.0 was given."),
        (OLD + NAMED, "C", "has no site 'C', but 'A', ..."),
        (OLD + NAMED, (7.59, 47.56), "has 2 sites at 7.59, 47.56. Choose one by its name, such as 'A'."),
        (ROWS, (7.59, 47.56), "must begin with a comment that states investigation_time and imt"),
        (OLD + "lon,lat,iml\n1,2,3\n", None, "lon, lat and poe-..., but its columns are 'lon, lat, iml'"),
        (OLD, None, "with the columns lon, lat and poe-..., but its columns are ''"),
        (OLD + ROWS.splitlines()[0], None, "must have a row of 7 values for each site, but it has none"),
        (OLD + ROWS + "1,2\n", None, "must have a row of 7 values for each site, but 1 row differs"),
        (OLD + ROWS.replace("3.0000", "x"), (8.54, 47.38), "'x00E-01' stands where a number is expected"),
        (OLD + ROWS.replace("3.0", "-3.0"), (8.54, 47.38), "holds probabilities below 0 or above 1"),
        (OLD.replace("PGA", "MMI") + ROWS, (8.54, 47.38), "measure must be one of PGA"),
        (OLD + ROWS.replace("4.0", "0.0"), (7.59, 47.56), "between 0 and 1 at this site, but it has 1"),
    ],
)  # fmt: skip
def test_files_are_checked(export, text, site, said):
    with pytest.raises(InputError) as refused:
        HazardCurve.from_openquake_csv(export(text), site=site)
    assert said in str(refused.value)


def test_files_that_cannot_be_read_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        HazardCurve.from_openquake_csv(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is a folder, but a regular file is expected"):
        HazardCurve.from_openquake_csv(tmp_path)
    (tmp_path / "latin.csv").write_bytes(b"# \xff\n")
    with pytest.raises(InputError, match="cannot be read"):
        HazardCurve.from_openquake_csv(tmp_path / "latin.csv")
