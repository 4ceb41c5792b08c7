"""Files for OpenQuake and Pelicun against their formats; validation/ has the comparison with their own readers."""

import csv
import math
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy import stats

import rockflex as rf
from rockflex import InputError

NRML = "{http://openquake.org/xmlns/nrml/0.5}"
RNG = np.random.default_rng(11)
IM = np.exp(RNG.normal(0.0, 1.0, 600))
FALLS = RNG.random(IM.size) < 1.0 / (1.0 + np.exp(4.0 - 3.0 * np.log(IM)))
ROCKS = FALLS | (RNG.random(IM.size) < 1.0 / (1.0 + np.exp(-3.0 - 3.0 * np.log(IM))))
ROTATION = np.where(ROCKS, 0.01 * IM * np.exp(RNG.normal(0.0, 0.4, IM.size)) + 1e-4, 0.0)
OUTCOMES = rf.fit_outcomes(IM, np.where(FALLS, 0.5 * np.pi, ROTATION), FALLS)
LEVELS = np.geomspace(0.1, 10.0, 9)
LOGNORMAL = {"tilted": rf.LognormalFragility(1.0, 0.4), "overturned": rf.LognormalFragility(3.0, 0.4)}


def model_in(path):
    root = ET.parse(path).getroot()
    assert root.tag == f"{NRML}nrml"
    (model,) = root
    return model


def numbers(text):
    return [float(word) for word in text.split()]


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    ("measure", "unit"),
    [("PGA", 1 / 9.81), ("SA(0.75)", 1 / 9.81), ("AvgSA", 1 / 9.81), ("PGV", 100), ("PGD", 100), ("IA", 1), ("RSD", 1)],
)
def test_lognormal_curves_are_continuous_functions_of_the_capacity(tmp_path, measure, unit):
    path = rf.write_nrml(tmp_path / "new" / "model.xml", {"pier": LOGNORMAL}, measure, LEVELS[[0, -1]])
    model = model_in(path)
    assert model.attrib == {"id": "rockflex", "assetCategory": "buildings", "lossCategory": "structural"}
    assert model.find(f"{NRML}limitStates").text == "tilted overturned"
    function = model.find(f"{NRML}fragilityFunction")
    assert function.attrib == {"id": "pier", "format": "continuous", "shape": "logncdf"}
    levels, *states = function
    assert levels.attrib["imt"] == measure
    ends = [float(levels.attrib[name]) for name in ("minIML", "maxIML")]
    np.testing.assert_allclose(ends, LEVELS[[0, -1]] * unit, rtol=1e-15)
    for (name, curve), state in zip(LOGNORMAL.items(), states, strict=True):
        capacity = stats.lognorm(curve.beta, scale=curve.median * unit)
        assert state.attrib["ls"] == name
        assert float(state.attrib["mean"]) == pytest.approx(capacity.mean(), rel=1e-14)
        assert float(state.attrib["stddev"]) == pytest.approx(capacity.std(), rel=1e-13)


def test_outcomes_are_discrete_functions(tmp_path):
    limits = {"slight": 0.005, "large": 0.05}
    path = rf.write_nrml(
        tmp_path / "m.xml", {"a": OUTCOMES, "b": OUTCOMES}, "PGV", LEVELS, rotations=limits, no_damage_limit=0.01
    )
    model = model_in(path)
    assert model.find(f"{NRML}limitStates").text == "rocking slight large overturning"
    first, second = model.findall(f"{NRML}fragilityFunction")
    assert (first.attrib["id"], second.attrib["id"]) == ("a", "b")
    levels, *states = first
    assert levels.attrib == {"imt": "PGV", "noDamageLimit": "1.0"}
    np.testing.assert_allclose(numbers(levels.text), 100.0 * LEVELS, rtol=1e-15)
    expected = [
        1.0 - OUTCOMES.probabilities(LEVELS).no_rocking,
        OUTCOMES.exceedance(LEVELS, 0.005),
        OUTCOMES.exceedance(LEVELS, 0.05),
        OUTCOMES.overturning.probability(LEVELS),
    ]
    for state, values in zip(states, expected, strict=True):
        assert numbers(state.text) == values.tolist()


def test_functions_and_other_fits_are_discrete_too(tmp_path):
    curves = {"mild": lambda im: np.minimum(1.0, im), "severe": rf.UnanimousOutcome(False, 40)}
    path = rf.write_nrml(tmp_path / "m.xml", {"a": curves, "b": curves}, "PGV", [0.5, 1.0], description="two <of> them")
    model = model_in(path)
    assert model.find(f"{NRML}description").text == "two <of> them"
    _, mild, severe = model.find(f"{NRML}fragilityFunction")
    assert (numbers(mild.text), numbers(severe.text)) == ([0.5, 1.0], [0.0, 0.0])


@pytest.mark.parametrize(
    ("measure", "demand", "unit"),
    [
        ("PGA", "Peak Ground Acceleration", "mps2"),
        ("PGV", "Peak Ground Velocity", "mps"),
        ("SA(0.50)", "Spectral Acceleration|0.50", "mps2"),
    ],
)
def test_pelicun_takes_medians_and_dispersions_in_si_units(tmp_path, measure, demand, unit):
    (row,) = rows(rf.write_pelicun(tmp_path / "f.csv", {"pier.1": LOGNORMAL}, measure, LEVELS))
    assert (row["ID"], row["Incomplete"], row["Demand-Type"], row["Demand-Unit"]) == ("pier.1", "0", demand, unit)
    assert (row["Demand-Offset"], row["Demand-Directional"]) == ("0", "1")
    for number, curve in enumerate(LOGNORMAL.values(), start=1):
        assert row[f"LS{number}-Family"] == "lognormal"
        assert float(row[f"LS{number}-Theta_0"]) == curve.median
        assert float(row[f"LS{number}-Theta_1"]) == curve.beta
        assert row[f"LS{number}-DamageStateWeights"] == ""


def points(row, number):
    assert row[f"LS{number}-Family"] == "multilinear_CDF"
    x, y = row[f"LS{number}-Theta_0"].split("|")
    return np.array(x.split(","), dtype=float), np.array(y.split(","), dtype=float)


def test_other_curves_are_distributions_through_the_levels(tmp_path):
    (row,) = rows(rf.write_pelicun(tmp_path / "f.csv", {"pier": OUTCOMES}, "PGV", LEVELS, rotations={"large": 0.05}))
    for number, curve in enumerate(
        (
            lambda im: 1.0 - OUTCOMES.probabilities(im).no_rocking,
            lambda im: OUTCOMES.exceedance(im, 0.05),
            OUTCOMES.overturning.probability,
        ),
        start=1,
    ):
        x, y = points(row, number)
        assert (x[0], y[0], y[-1]) == (0.0, 0.0, 1.0)
        assert (np.diff(x) > 0.0).all()
        assert (np.diff(y) > 1e-8).all()
        np.testing.assert_allclose(np.interp(LEVELS, x, y), curve(LEVELS), atol=1e-5)


def test_a_level_curve_rises_by_no_more_than_its_digits(tmp_path):
    curves = {"a": lambda im: np.select([im < 2.0, im < 5.0], [0.0, 0.4], 1.0), "b": rf.UnanimousOutcome(False, 9)}
    levels = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    (row,) = rows(rf.write_pelicun(tmp_path / "f.csv", {"s": curves}, "PGV", levels))
    x, y = points(row, 1)
    assert x.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    np.testing.assert_allclose(y, [0.0, 0.0, 0.4, 0.4, 0.4, 1.0], atol=3e-6)
    x, y = points(row, 2)
    assert x[-1] == 6e6
    assert y[-2] < 1e-5
    assert (np.diff(y) > 1e-8).all()


BOTH = pytest.mark.parametrize("write", [rf.write_nrml, rf.write_pelicun])


@BOTH
@pytest.mark.parametrize(
    ("curves", "measure", "levels", "said"),
    [
        ({"p": LOGNORMAL}, "pgv", LEVELS, "measure must be one of PGA, PGV, PGD, AvgSA, IA, CAV, RSD, SA(T) and"),
        ({"p": LOGNORMAL}, "SA", LEVELS, "such as SA(1.0), but 'SA' was given"),
        ({"p": LOGNORMAL}, "SA(0)", LEVELS, "with a period T in s"),
        ({"p": LOGNORMAL}, 3, LEVELS, "but 3 was given"),
        ({"p": LOGNORMAL}, "PGV", [0.1], "levels must be two or more measures that rise"),
        ({"p": LOGNORMAL}, "PGV", [0.2, 0.1], "levels must be two or more measures that rise"),
        ({"p": LOGNORMAL}, "PGV", [0.0, 0.1], "levels must be positive"),
        ({}, "PGV", LEVELS, "curves must be a dictionary with the limit states of each structure"),
        (LOGNORMAL["tilted"], "PGV", LEVELS, "curves must be a dictionary"),
        ({"p": LOGNORMAL["tilted"]}, "PGV", LEVELS, "curves['p'] must be an OutcomeFragility or a dictionary"),
        ({"p": {"a": 3.0}}, "PGV", LEVELS, "curves['p']['a'] must have a method probability(im)"),
        ({"p": {"a": lambda im: im}}, "PGV", [0.5, 2.0], "curves['p']['a'] must give probabilities from 0 to 1"),
        ({"a pier": LOGNORMAL}, "PGV", LEVELS, "The name of a structure may contain letters"),
        ({"p": {"two words": LOGNORMAL["tilted"]}}, "PGV", LEVELS, "The name of a limit state may contain letters"),
        ({"p": LOGNORMAL, "q": {"tilted": LOGNORMAL["tilted"]}}, "PGV", LEVELS, "p has tilted, overturned and q has"),
        (
            {"p": dict(reversed(LOGNORMAL.items()))},
            "PGV",
            LEVELS,
            "at 1.723 the probability of tilted is 0.913, more than the 0.08273 of overturned, which comes before it",
        ),
        (
            {"p": {"a": rf.LognormalFragility(1.0, 0.4), "b": rf.LognormalFragility(2.0, 0.9)}},
            "PGV",
            LEVELS,
            "curves with different dispersions cross somewhere",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_written_is_refused(tmp_path, write, curves, measure, levels, said):
    with pytest.raises(InputError, match=r"^[^\n]+$") as refused:
        write(tmp_path / "file", curves, measure, levels)
    assert said in str(refused.value)
    assert not (tmp_path / "file").exists()


@BOTH
@pytest.mark.parametrize(
    ("rotations", "said"),
    [
        ({"a": 0.05, "b": 0.01}, "rotations must rise from the mildest limit state to the most severe"),
        ({"a": -1.0}, "rotations['a'] must be a positive, finite number in rad"),
        ({"rocking": 0.01}, "rocking is a limit state of its own"),
        ({"a": 3.0}, "limit must lie in"),
    ],
)  # fmt: skip
def test_rotations_are_checked(tmp_path, write, rotations, said):
    with pytest.raises(InputError) as refused:
        write(tmp_path / "file", {"p": OUTCOMES}, "PGV", LEVELS, rotations=rotations)
    assert said in str(refused.value)


@BOTH
def test_rotations_belong_to_outcomes(tmp_path, write):
    with pytest.raises(InputError, match="rotations are limits of fitted outcomes, but curves has none"):
        write(tmp_path / "file", {"p": LOGNORMAL}, "PGV", LEVELS, rotations={"a": 0.01})


@BOTH
def test_outcomes_that_could_not_be_fitted_are_refused(tmp_path, write):
    few = rf.fit_outcomes([0.1, 0.2, 0.3, 0.4], [0.0, 0.001, 1.6, 1.6], [False, False, True, True])
    assert few.rotation is None
    with pytest.raises(InputError, match="A part that could not be fitted gives NaN"):
        write(tmp_path / "file", {"p": few}, "PGV", LEVELS, rotations={"a": 0.01})


def test_nrml_refuses_what_it_cannot_say(tmp_path):
    with pytest.raises(InputError, match=r"no_damage_limit must be below the first level, 0.1, but 0.2 was given"):
        rf.write_nrml(tmp_path / "m.xml", {"p": LOGNORMAL}, "PGV", LEVELS, no_damage_limit=0.2)
    with pytest.raises(InputError, match="description must be a line of text"):
        rf.write_nrml(tmp_path / "m.xml", {"p": LOGNORMAL}, "PGV", LEVELS, description="\n")
    for beta in (40.0, 1e-200):
        wide = {"p": {"a": rf.LognormalFragility(1.0, beta)}}
        with pytest.raises(InputError, match=r"has no mean and standard deviation in double precision"):
            rf.write_nrml(tmp_path / "m.xml", wide, "PGV", LEVELS)


def test_an_id_that_a_spreadsheet_would_compute_is_a_text(tmp_path):
    (row,) = rows(rf.write_pelicun(tmp_path / "f.csv", {"-A1": LOGNORMAL}, "PGV", LEVELS))
    assert row["ID"] == "'-A1"


def test_pelicun_refuses_what_it_cannot_say(tmp_path):
    with pytest.raises(InputError, match=r"measure must be PGA, PGV or SA\(T\), .* but IA was given"):
        rf.write_pelicun(tmp_path / "f.csv", {"p": LOGNORMAL}, "IA", LEVELS)
    falls = {"a": lambda im: 0.5 / (1.0 + im)}
    with pytest.raises(InputError, match=r"p: the probability of a falls from 0.4545 at 0.1 to .* Leave out"):
        rf.write_pelicun(tmp_path / "f.csv", {"p": falls}, "PGV", LEVELS)
    near = {"a": lambda im: np.where(im < 0.5, 0.0, 1.0)}
    with pytest.raises(InputError, match=r"levels must differ in their first six digits, but two are 0.1"):
        rf.write_pelicun(tmp_path / "f.csv", {"p": near}, "PGV", [0.1, 0.1 + 1e-9, math.e])
