"""Hazard curves from probabilities of exceedance, and from the files that OpenQuake exports."""

import math

import numpy as np
import pytest

from rockflex import HazardCurve, InputError

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
        ([0.5, 0.1], 0, "years must be a positive, finite number"),
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
