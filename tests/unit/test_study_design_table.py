"""The probability of each design, and the smallest width that meets a target."""

import math

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize

import rockflex as rf
from builders import make_frame
from design_case import HAZARD, HEIGHT, WIDTHS
from rockflex.fragility._bootstrap import bootstrap_weights, resampled_exceedance
from rockflex.fragility._regression import FirthScoringOptions, fit_logistic_curves


@pytest.fixture
def runs(designed):
    return designed


def columns(runs, tendon, width):
    rows = runs[(runs["tendon"] == tendon) & (runs["half_width"] == width)]
    fallen = (rows["status"] == "overturned").to_numpy(bool)
    return rows["pgv"].to_numpy(float), rows["max_rotation"].to_numpy(float), fallen, rows["group"].to_numpy()


def test_probabilities_are_those_of_the_fits(runs):
    nominal = {b: 0.7 * math.atan(b / HEIGHT) for b in WIDTHS}
    for limit in (0.02, "0.3 nominal", "overturning"):
        table = rf.design_table(runs, limit, at=0.5, confidence=None)
        assert list(table["half_width"]) == WIDTHS * 2
        assert list(table["tendon"]) == ["no tendon"] * 3 + ["held"] * 3
        assert table[["low", "high"]].isna().all(axis=None)
        for row in table.itertuples():
            im, rotation, fallen, _ = columns(runs, row.tendon, row.half_width)
            fit = rf.fit_outcomes(im, rotation, fallen)
            angle = {0.02: 0.02, "overturning": math.pi / 2}.get(limit, 0.3 * nominal[row.half_width])
            assert row.limit == pytest.approx(angle, rel=1e-12)
            expected = fit.overturning.probability(0.5)
            assert row.overturning == expected
            assert row.probability == (expected if limit == "overturning" else fit.exceedance(0.5, row.limit))
            assert row.n_overturned == fallen.sum()
            assert row.n_exceeding == (fallen if limit == "overturning" else rotation > row.limit).sum()
            assert (row.n_runs, row.n_failed) == (88, 0)
    group = runs[(runs["tendon"] == "held") & (runs["half_width"] == 1.6)]
    row = table[(table["tendon"] == "held") & (table["half_width"] == 1.6)].iloc[0]
    assert row["median_base_moment"] == np.median(group["max_base_moment"])
    assert row["median_tendon_utilisation"] == np.median(group["tendon_utilisation"])


def test_rates_are_those_of_the_fits(runs):
    table = rf.design_table(runs, 0.02, hazard=HAZARD)
    for row in table.itertuples():
        im, rotation, fallen, groups = columns(runs, row.tendon, row.half_width)
        fit = rf.fit_outcomes(im, rotation, fallen, groups)
        found = rf.annual_rate(HAZARD, fit.curve(0.02), confidence=0.9)
        assert (row.rate, row.beyond) == (found.rate, found.beyond)
        assert (row.low, row.high) == (found.low, found.high)
        assert row.overturning == rf.annual_rate(HAZARD, fit.overturning).rate


@pytest.mark.parametrize("limit", [0.02, "overturning", "max_base_moment > 4e6"])
def test_bands_are_those_of_the_fits(runs, limit):
    table = rf.design_table(runs, limit, at=0.8, confidence=0.8)
    for row in table.itertuples():
        im, rotation, fallen, groups = columns(runs, row.tendon, row.half_width)
        if limit == "overturning" and not fallen.any():
            assert math.isnan(row.low)
            assert "No band: all runs had the same outcome." in row.note
            continue
        fit = rf.fit_outcomes(im, rotation, fallen, groups)
        if limit == 0.02:
            low, high = fit.curve(0.02).band([0.8], 0.8)
        elif limit == "overturning":
            low, high = fit.overturning.band([0.8], 0.8)
        else:
            mine = runs[(runs["tendon"] == row.tendon) & (runs["half_width"] == row.half_width)]
            beyond = fallen | (mine["max_base_moment"] > 4e6).to_numpy(bool)
            if beyond.all() or not beyond.any():
                continue
            low, high = rf.fit_logistic(im, beyond, groups).band([0.8], 0.8)
        np.testing.assert_allclose([row.low, row.high], [low[0], high[0]], rtol=1e-9)
        assert row.low <= row.probability <= row.high


def test_resamples_are_those_of_the_bootstrap():
    groups = np.array([0, 0, 1, 2, 2, 2, 3])
    seen = []

    def fit(im, rows):
        seen.append(np.bincount(rows.astype(int), minlength=7))
        return rows

    rf.bootstrap_band(fit, np.arange(1.0, 8.0), np.arange(7), groups, at=[1.0], n=30, seed=9, curve=lambda *_: [0.5])
    np.testing.assert_array_equal(bootstrap_weights(groups, 30, 9), seen[1:])


def test_penalised_fits_maximise_the_penalised_likelihood():
    random = np.random.default_rng(4)
    for _ in range(20):
        x = np.sort(random.normal(size=20))
        x = (x - x.mean()) / x.std()
        y = x > random.uniform(x[1], x[-2])
        times = random.integers(1, 4, size=20)
        design = np.column_stack((np.ones(20), x))

        def unlikely(b, y=y, times=times, design=design):
            eta = design @ b
            p = 1.0 / (1.0 + np.exp(-eta))
            information = (design.T * (times * p * (1.0 - p))) @ design
            return -(times * (y * eta - np.logaddexp(0.0, eta))).sum() - 0.5 * np.linalg.slogdet(information)[1]

        corners = [[0.0, 0.0], [4.0, 4.0], [-4.0, 4.0]]
        options = {"xatol": 1e-8, "fatol": 1e-12, "maxiter": 2000, "initial_simplex": corners}
        best = minimize(unlikely, corners[0], method="Nelder-Mead", options=options)
        curve = fit_logistic_curves(x, y, times[None].astype(float), FirthScoringOptions(1e-8))
        assert curve.separated
        np.testing.assert_allclose(curve.parameters[0], best.x, rtol=1e-5, atol=1e-5)


def test_resamples_with_nothing_to_fit():
    im, rotation = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.0, 0.02, 0.03, 1.6])
    fallen = np.array([False, False, False, True])
    weights = np.array([[2.0, 2, 0, 0], [0.0, 0, 0, 4], [4.0, 0, 0, 0], [0.0, 2, 2, 0], [0.0, 4, 0, 0]])
    with np.errstate(all="raise"):
        found = resampled_exceedance(im, rotation, fallen, weights, np.array([2.5]), 0.024)[:, 0]
    assert math.isnan(found[0])  # one rotation is no line
    assert found[1] == 1.0  # all overturned
    assert found[2] == 0.0  # none rocks
    assert found[3] == 1.0  # the line goes through both, and 0.025 rad at the node
    assert math.isnan(found[4])


def altered(runs, **changes):
    return runs[runs["half_width"] == 1.6].assign(**changes)


@pytest.mark.slow
def test_what_a_row_says_of_itself(runs):
    strong = rf.design_table(runs, 0.02, at=50.0)
    assert strong["note"].str.contains("The level lies outside the measures of the runs, ").all()
    gaps = altered(runs, status=pd.array([None] * 176, dtype="string"), max_rotation=np.nan)
    lost = rf.design_table(gaps, 0.02, at=0.6)
    assert (lost["n_failed"] == 88).all()
    assert lost[["probability", "limit", "overturning"]].isna().all(axis=None)
    assert (lost["note"] == "No run was solved: see the column error.").all()
    quiet = rf.design_table(altered(runs, status="no_uplift", max_rotation=0.0), 0.02, hazard=HAZARD)
    assert (quiet["rate"] == 0.0).all()
    assert quiet["low"].isna().all()
    assert quiet["note"].str.contains("rocking: none of 88 runs").all()
    assert not quiet["note"].str.contains("initiation").any()  # of a fit that the answer does not use
    alone = rf.design_table(altered(runs, group="one"), 0.02, at=0.6)
    assert alone["note"].str.contains("No band: all runs belong to one recording.").all()
    few = runs[(runs["half_width"] == 1.6) & runs["motion"].isin(["FF-1-a", "FF-2-a", "FF-3-a"])]
    few = few.assign(status="no_uplift", max_rotation=[0.0, 0.0, 0.0, 0.01, 0.0, 0.02] * 2)
    unknown = rf.design_table(few, 0.02, at=0.6)
    assert unknown["probability"].isna().all()
    assert unknown["note"].str.contains("There is no probability: a curve that it needs could not be fitted.").all()


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        ({}, {}, "Give either at, a level of the measure, or hazard, a HazardCurve in it."),
        ({}, {"at": 1.0, "hazard": HAZARD}, "Give either at, a level of the measure, or hazard, a HazardCurve in it."),
        ({}, {"hazard": HAZARD, "measure": "sa_t1"}, "The fragility is in a spectral measure at a damping ratio of"),
        ({}, {"at": 0.0}, "at must be a positive, finite number in the unit of the measure, but 0.0 was given."),
        ({}, {"at": 1.0, "measure": "relative_pga"}, "measure must not depend on the base, as a level of relative_pga"),
        ({}, {"at": 1.0, "confidence": 1.0}, "confidence must lie in [0, 1), but 1.0 was given. A 90 % band is 0.9."),
        ({"columns": ["tendon", "pgv"]}, {"at": 1.0}, "The table lacks tendon, pgv. Give what run_design returned."),
        ({"index": range(528)}, {"at": 1.0}, "The table has no rows. Give what run_design returned."),
    ],
)
def test_damaged_arguments_of_the_table(runs, change, arguments, message):
    with pytest.raises(rf.InputError) as caught:
        rf.design_table(runs.drop(**change or {"columns": []}), 0.02, **arguments)
    assert str(caught.value).startswith(message)


def test_a_level_of_tendons_leaves_fuses_where_they_are():
    frame = make_frame(n_stories=3, stiffness_ratio=0.125, period=0.6, aspect_ratio=7.0, damping_ratio=0.03)
    fuse = rf.YieldingDissipator(1e8, 1e5, position=0.5)
    own = rf.Restrained(frame, [fuse, rf.Tendon(1e5, 1e6)]).rocking()
    held = rf.TendonLevel(prestress_ratio=0.2, stiffness_ratio=0.5).held(own)
    assert held.elements[1:] == (fuse,)
    assert held.prestress == pytest.approx(0.2 * own.m_tot * 9.81)
    assert rf.TendonLevel().held(own).elements == (fuse,)


def made_up(values, high=None, widths=None, **columns):
    values = np.asarray(values, float)
    widths = np.arange(1.0, values.size + 1.0) if widths is None else widths
    high = values if high is None else high
    facts = {"model": "MDOF-S", "tendon": "no tendon", "prestress_ratio": 0.0, "stiffness_ratio": 0.0}
    return pd.DataFrame({**facts, "half_width": widths, "probability": values, "high": high} | columns)


def test_exponentials_are_met_exactly():
    b = np.linspace(1.0, 3.0, 7)
    table = made_up(np.exp(-2.0 * b), 1.5 * np.exp(-2.0 * b), b)
    for target in (0.1, 0.02, 0.004):
        (row,) = rf.smallest_width(table.sample(frac=1.0, random_state=1), target).to_dict("records")
        assert row["half_width"] == pytest.approx(-math.log(target) / 2.0, rel=1e-12)
        assert row["half_width_upper"] == pytest.approx(-math.log(target / 1.5) / 2.0, rel=1e-12)
        assert (row["outcome"], row["monotone"], row["note"]) == ("met", True, "")
    rates = table.rename(columns={"probability": "rate"})
    pd.testing.assert_frame_equal(rf.smallest_width(rates, 0.02), rf.smallest_width(table, 0.02))


@pytest.mark.parametrize(
    ("values", "expected", "outcome", "monotone", "notes"),
    [
        ([0.4, 0.0], 1.75, "met", True, ""),
        ([0.4, 0.1], 2.0, "met", True, ""),
        ([0.4, 0.3], math.nan, "not met", True, "The widest base, B = 2 m, has 0.3."),
        ([0.1, 0.05], 1.0, "all meet it", True, "Every base meets it; a base below B = 1 m might do."),
        (
            [0.4, 0.05, 0.2, 0.05],
            3.5,
            "met more than once",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m. Narrower bases meet it too, from B = 2 m, "
            "but 3 m does not.",
        ),
        ([0.4, 0.3, 0.35, 0.1], 4.0, "met", False, "It does not fall everywhere: it rises between B = 2 and 3 m."),
        (
            [0.4, 0.3, 0.35, 0.1, 0.15, 0.02, 0.03],
            5.0 + math.log(0.15 / 0.1) / math.log(0.15 / 0.02),
            "met more than once",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m and 2 times more. Narrower bases meet it too, "
            "from B = 4 m, but 5 m does not.",
        ),
        (
            [0.4, 0.05, 0.2],
            math.nan,
            "not met",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m. The widest base, B = 3 m, has 0.2. Narrower "
            "bases meet it, from B = 2 m.",
        ),
        ([0.4, math.nan, 0.1], 3.0, "met", True, "Left out for want of a value: 1 of 3 bases."),
        ([math.nan], math.nan, "not met", True, "Left out for want of a value: 1 of 1 bases."),
    ],
)
def test_what_is_said_of_a_width(values, expected, outcome, monotone, notes):
    (row,) = rf.smallest_width(made_up(values), 0.1).to_dict("records")
    assert row["half_width"] == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert (row["outcome"], row["monotone"], row["note"]) == (outcome, monotone, notes)


def test_widths_of_every_tendon(runs):
    table = rf.design_table(runs, 0.02, at=0.4)
    target = float(table["probability"].iloc[1])
    found = rf.smallest_width(table, target)
    assert list(found["tendon"]) == ["no tendon", "held"]
    assert list(found["prestress_ratio"]) == pytest.approx([0.0, 0.3])
    assert found["half_width"][0] == pytest.approx(1.6)
    assert found["half_width"][1] < 1.6
    assert (found["half_width_upper"].fillna(math.inf) >= found["half_width"]).all()
    assert math.isnan(rf.smallest_width(table.assign(stiffness_ratio=range(6)), 0.1)["stiffness_ratio"][0])


@pytest.mark.parametrize(
    ("table", "target", "message"),
    [
        (made_up([0.1]).drop(columns="tendon"), 0.1, "The table lacks tendon. Give what design_table returned."),
        (made_up([]), 0.1, "The table has no rows. Give what design_table returned."),
        (made_up([0.1]), 0.0, "target must be a positive, finite number in probability, but 0.0 was given."),
    ],
)
def test_damaged_arguments_of_the_width(table, target, message):
    with pytest.raises(rf.InputError) as caught:
        rf.smallest_width(table, target)
    assert str(caught.value) == message
