"""Designs of a base: runs against structures built that way, the table against the fits, widths in closed form."""

import math
import pickle

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize

import rockflex as rf
from rockflex.study.plans import ChunkedPlan, DesignStudy
from rockflex.study.plans._design_levels import designs_of, half_widths_of
from rockflex.study.plans._design_limits import rotation_of
from rockflex.study.plans._design_resamples import _firth, exceedances, resample_weights

FRAME = {
    "n_stories": 3,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 50e3,
    "stiffness_ratio": math.inf,
    "period": 0.6,
    "aspect_ratio": 8.0,
    "damping_ratio": 0.02,
}
STRUCTURE = rf.Frame(**FRAME)
PROPERTIES = STRUCTURE.rocking()
HEIGHT = PROPERTIES.effective_height[0]
SUITE = rf.load_suite("fema-p695-far-field")
WIDTHS = [0.8, 1.6, 2.4]
LEVELS = [rf.TendonLevel(), rf.TendonLevel(0.3, 0.6, 0.9, name="held")]
HAZARD = rf.HazardCurve([0.05, 0.1, 0.2, 0.4, 0.8, 1.6], [0.1, 0.03, 8e-3, 1.5e-3, 2e-4, 2e-5])
CONTENT = {
    "structures": [{"name": "A", "frame": FRAME}],
    "records": {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]},
    "half_widths": {"smallest": 0.8, "largest": 2.4, "count": 3},
    "tendons": [{"name": "none"}, {"prestress_ratio": 0.3, "stiffness_ratio": 0.6}],
    "scales": [1.0, 2.0],
    "level": 0.6,
    "runs_per_chunk": 7,
}


@pytest.fixture(scope="module")
def runs():
    return rf.run_design(STRUCTURE, list(SUITE), WIDTHS, LEVELS, scales=[1.0, 2.0])


def built(half_width, prestress=0.0, stiffness=0.0, base_mass=50e3):
    """The frame made with that base, and a tendon of that force and stiffness."""
    frame = rf.Frame(**FRAME | {"aspect_ratio": HEIGHT / half_width, "base_mass": base_mass})
    return rf.Restrained(frame, rf.Tendon(prestress, stiffness)) if prestress or stiffness else frame


# Runs


def test_rows_are_those_of_structures_built_that_way():
    motions = [SUITE[name] for name in ("FF-1-a", "FF-3-b", "FF-5-a")]
    table = rf.run_design(STRUCTURE, motions, WIDTHS[::-1], LEVELS, ["MDOF-S", "2DOF-S"], [1.0, 2.5])
    weight, l0r = PROPERTIES.m_tot * 9.81, PROPERTIES.l0r
    structures = {f"B = {b:g} m, no tendon": built(b) for b in WIDTHS}
    structures |= {f"B = {b:g} m, held": built(b, 0.3 * weight, 0.6 * l0r * 9.81 / b**2) for b in WIDTHS}
    cloud = rf.run_cloud(structures, motions, ["MDOF-S", "2DOF-S"], [1.0, 2.5], free_vibration="settle")
    for name in ("structure", "record", "model", "scale", "group", "status", "n_impacts", "error"):
        assert table[name].astype(str).tolist() == cloud[name].astype(str).tolist()
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "nominal_limit", "pgv", "max_tendon_force"):
        np.testing.assert_allclose(table[name], cloud[name], rtol=1e-8)
    assert {"rocking", "overturned"} <= set(table["status"])
    assert cloud["tendon_utilisation"].isna().any()  # no yield force was given there
    held = table[table["tendon"] == "held"]
    np.testing.assert_allclose(held["tendon_utilisation"], held["max_tendon_force"] / (0.9 * weight), rtol=1e-12)


def test_facts_of_a_design_are_closed_forms(runs):
    weight = PROPERTIES.m_tot * 9.81
    np.testing.assert_allclose(runs["resisting_moment"], (1.0 + runs["prestress_ratio"]) * weight * runs["half_width"])
    np.testing.assert_allclose(runs["aspect_ratio"] * runs["half_width"], HEIGHT, rtol=1e-12)
    np.testing.assert_allclose(runs["prestress_ratio"], np.where(runs["tendon"] == "held", 0.3, 0.0), rtol=1e-12)
    np.testing.assert_allclose(runs["stiffness_ratio"], np.where(runs["tendon"] == "held", 0.6, 0.0), rtol=1e-12)
    free, held = (runs[runs["tendon"] == name]["resisting_moment"].unique() for name in ("no tendon", "held"))
    assert (np.diff(free) > 0.0).all()
    assert (np.diff(held) > 0.0).all()
    assert (held > free).all()


@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 3.0])
def test_ratio_of_stiffness_is_that_of_the_slope(ratio):
    for design in designs_of(PROPERTIES, WIDTHS, [rf.TendonLevel(0.1, ratio)], 0.0):
        expected = (ratio - 1.0) * PROPERTIES.l0r * 9.81
        assert design.properties.rocking_stiffness == pytest.approx(expected, rel=1e-12, abs=1e-6)


def test_a_base_whose_mass_grows():
    for design in designs_of(PROPERTIES, WIDTHS, [], 6e3):
        b = design.properties.half_width
        made = built(b, base_mass=50e3 + 6e3 * 2.0 * (b - PROPERTIES.half_width)).rocking()
        for name in ("m_tot", "i_theta", "l0r", "translational_inertia", "resisting_moment"):
            assert getattr(design.properties, name) == pytest.approx(getattr(made, name), rel=1e-12)


def test_rotary_inertia_and_tendons_of_its_own_stay():
    tower = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02).rocking()
    (wide,) = designs_of(tower, [10.0], [], 0.0)
    rotary = tower.i_theta - tower.translational_inertia - tower.m_tot * 64.0
    assert wide.properties.i_theta == pytest.approx(tower.translational_inertia + rotary + tower.m_tot * 100.0)
    pair = [rf.Tendon(1e5, 1e6, -0.5), rf.Tendon(1e5, 1e6, 0.5)]
    held = rf.Restrained(STRUCTURE, pair).rocking()
    (design,) = designs_of(held, [2.0], [], 0.0)
    assert (design.tendon, design.properties.tendons) == ("its own tendons", tuple(pair))
    table = rf.run_design(held, SUITE[0], [1.0, 2.0])
    np.testing.assert_allclose(
        table["stiffness_ratio"], [1e6 * 2 * (b**2 + 0.25) / (held.l0r * 9.81) for b in (1.0, 2.0)], rtol=1e-12
    )


def test_a_rigid_block():
    block = rf.rigid_block(0.2, 1.5)
    table = rf.run_design(block, SUITE[0], [0.3, 0.6], models="rigid")
    np.testing.assert_allclose(table["aspect_ratio"], block.l0r / block.m_tot / np.array([0.3, 0.6]))


# The study


def test_a_study_is_the_call_in_python(tmp_path):
    study = DesignStudy(**CONTENT)
    table = rf.run_study(study)
    motions = [motion for motion in SUITE if motion.name.startswith(("FF-1-", "FF-2-"))]
    levels = [rf.TendonLevel(name="none"), rf.TendonLevel(0.3, 0.6)]
    pd.testing.assert_frame_equal(table, rf.run_design(STRUCTURE, motions, WIDTHS, levels, scales=[1.0, 2.0]))
    assert study.document()["half_widths"] == pytest.approx(WIDTHS)
    assert list(table["tendon"].cat.categories) == ["none", "F₀ = 0.3 W, k = 0.6 L₀ʳg/B²"]
    plan = study.plan()
    assert (plan.n_runs, plan.n_chunks) == (48, 7)
    assert pickle.loads(pickle.dumps(plan)).chunk(3).equals(plan.chunk(3))
    assert DesignStudy(**study.document() | {"structures": CONTENT["structures"]}).document() == study.document()


def test_a_stopped_study_goes_on(tmp_path, monkeypatch):
    study = DesignStudy(**CONTENT)
    whole = rf.run_study(study, tmp_path / "kept")
    for number in (1, 4):
        (tmp_path / "kept" / "parts" / f"part-{number:05d}.parquet").unlink()
    computed: list[int] = []
    real = ChunkedPlan.chunk
    monkeypatch.setattr(ChunkedPlan, "chunk", lambda plan, number: computed.append(number) or real(plan, number))
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), whole)
    assert sorted(computed) == [1, 4]


def test_the_example_is_a_study():
    from pathlib import Path

    plan = rf.load_study(Path(__file__).parents[2] / "examples" / "design.toml").plan()
    assert plan.n_runs == 33 * 72 * 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"half_widths": {"smallest": 2.0, "largest": 1.0, "count": 3}},
            "half_widths: half_widths must be a list in m, or a range {smallest = 1.0, largest = 3.0, count = 9} of "
            "positive numbers in m, 2 to 10000 of them, but {'smallest': 2.0, 'largest': 1.0, 'count': 3} was given.",
        ),
        (
            {"half_widths": {"smallest": 1.0, "largest": 2.0}},
            "half_widths: half_widths must be a list in m, or a range",
        ),
        ({"half_widths": [1.0, 1.0]}, "half_widths: half_widths: '1' occurs more than once. Give each once."),
        ({"half_widths": [1.0, -1.0]}, "half_widths: half_widths must be one or more positive numbers in m, but"),
        ({"half_widths": 3.0}, "half_widths must be a list of half widths B in m, or a range {smallest = 1.0,"),
        (
            {"limits": ["half"]},
            "limits: limit must be a rotation from 0.0001 rad to below π/2, a multiple of 0.7 atan(B/h*_1) such as "
            '"nominal" or "0.5 nominal" in the same range, or "overturning", but \'half\' was given.',
        ),
        ({"measure": "relative_pgv"}, "measure: measure must not depend on the base, as a level of relative_pgv does."),
        ({"measure": "pgw"}, "measure: measure must be one of pga, pgv,"),
        ({"level": None}, "level and hazard: one of them is needed, and not both, to say how strong the ground"),
        ({"hazard": {"im": [0.1, 1.0], "rate": [1e-2, 1e-4]}}, "level and hazard: one of them is needed, and not"),
        (
            {"level": None, "hazard": {"im": [0.1, 1.0], "rate": [1e-2, 1e-1]}},
            "rate must be positive and fall from point to point",
        ),
        ({"target": 1.5}, "target must lie in [0, 1), but 1.5 was given. With a level it is a probability."),
        ({"target": 0.0}, "target must be a positive, finite number in probability or 1/year, but 0.0 was given."),
        ({"level": -1.0}, "level must be a positive, finite number in the unit of the measure, but -1.0 was given."),
        ({"structures": CONTENT["structures"] * 2}, "structures must be one table [[structures]], but"),
        ({"scales": [math.inf]}, "scales: scales must be one or more finite factors, but [inf] was given."),
        ({"tendons": [{"prestress": 0.2}]}, "prestress is not known; there are prestress_ratio, stiffness_ratio,"),
    ],
)
def test_a_specification_that_is_wrong(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**CONTENT | changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ["3DOF-fixed"]}, "models: 3DOF-fixed has a base that cannot lift, so its width is nothing."),
        ({"tendons": [{}, {}]}, "tendons: 'no tendon' occurs more than once. Give each once."),
        (
            {"structures": [{"frame": FRAME, "tendons": [{"initial_force": 1e5, "stiffness": 1e6}]}]},
            "The structure has tendons of its own, and there are levels of tendons besides. Leave out the one or the",
        ),
        (
            {"limits": ["2.5 nominal"], "half_widths": [9.0]},
            "B = 9 m, none: limit must be a rotation from 0.0001 rad to",
        ),
        ({"limits": ["2.5 nominal"], "half_widths": [9.0]}, "but '2.5 nominal' (1.62 rad) was given."),
        ({"base_mass_per_width": 1e6}, "B = 0.8 m, none: m_tot must be at least the sum of effective_mass,"),
    ],
)
def test_a_design_that_cannot_be_built(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**CONTENT | changes).plan()
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rf.TendonLevel(-0.1), "prestress_ratio must be a zero or positive, finite number in W, but -0.1"),
        (lambda: rf.TendonLevel(0.1, math.inf), "stiffness_ratio must be a zero or positive, finite number in L_0^r"),
        (lambda: rf.TendonLevel(0.1, 0.0, 0.0), "yield_ratio must be a positive, finite number in W, but 0.0 was"),
        (lambda: rf.TendonLevel(0.5, 0.0, 0.4), "prestress_ratio must not exceed yield_ratio, 0.4, but 0.5 was given."),
        (lambda: rf.run_design(STRUCTURE, SUITE[0], []), "half_widths must be one or more positive numbers in m, but"),
        (lambda: rf.run_design(STRUCTURE, SUITE[0], [1.0], [0.2]), "tendons[0] is float. Expected a TendonLevel."),
        (
            lambda: rf.run_design(
                rf.Restrained(STRUCTURE, [rf.Tendon(1.0, 1.0, -0.5), rf.Tendon(1.0, 1.0, 0.5)]), SUITE[0], [0.4]
            ),
            "B = 0.4 m: Tendons must pass through the base, 0.4 m to each side of its centre, but one stands at",
        ),
    ],
)
def test_damaged_arguments_of_a_design(call, message):
    with pytest.raises(rf.InputError) as caught:
        call()
    assert str(caught.value).startswith(message)


def test_half_widths_rise():
    assert half_widths_of([2.0, 1.0]) == [1.0, 2.0]
    assert half_widths_of({"smallest": 1, "largest": 2, "count": 5}) == [1.0, 1.25, 1.5, 1.75, 2.0]


def test_limits():
    assert rotation_of(0.02, 0.1) == 0.02
    assert rotation_of("nominal", 0.1) == 0.1
    assert rotation_of("0.5 nominal", 0.1) == 0.05
    assert rotation_of("overturning", 0.1) == math.pi / 2
    for limit in (0.0, 1e-5, 1.6, math.nan, True, "x nominal", "0.5 0.5 nominal", "", "0.0005 nominal", None):
        with pytest.raises(rf.InputError, match=r"limit must be a rotation from 0\.0001 rad"):
            rotation_of(limit, 0.1)


# The table


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
    table = rf.design_table(runs, 0.02, hazard=HAZARD, n_resamples=40)
    for row in table.itertuples():
        im, rotation, fallen, groups = columns(runs, row.tendon, row.half_width)
        fit = rf.fit_outcomes(im, rotation, fallen)
        found = rf.annual_rate(HAZARD, lambda at, fit=fit: fit.exceedance(at, 0.02))
        assert row.rate == found.rate
        assert row.beyond == found.beyond
        assert row.overturning == rf.annual_rate(HAZARD, fit.overturning).rate
    # The band of the last against the adaptive integral of each resample.
    band = rf.bootstrap_band(
        lambda im, values: rf.fit_outcomes(im, values[:, 0], values[:, 1]),
        im,
        np.column_stack((rotation, fallen)),
        groups,
        at=[1.0],
        n=40,
        curve=lambda fit, _: [rf.annual_rate(HAZARD, lambda at: fit.exceedance(at, 0.02)).rate],
    )
    np.testing.assert_allclose([row.low, row.high], [band.low[0], band.high[0]], rtol=1e-4)


@pytest.mark.parametrize("limit", [0.02, "overturning"])
def test_bands_are_those_of_the_bootstrap(runs, limit):
    table = rf.design_table(runs, limit, at=0.8, n_resamples=60, seed=5, confidence=0.8)
    separated = 0
    for row in table.itertuples():
        im, rotation, fallen, groups = columns(runs, row.tendon, row.half_width)
        if limit == "overturning" and not fallen.any():
            assert math.isnan(row.low)
            assert "No band: all runs ended alike." in row.note
            continue
        curve = (
            (lambda fit, at: fit.exceedance(at, 0.02))
            if limit == 0.02
            else lambda fit, at: fit.overturning.probability(at)
        )
        failed = []

        def fitted(im, values, failed=failed):
            fit = rf.fit_outcomes(im, values[:, 0], values[:, 1])
            failed.append(getattr(fit.overturning, "separated", False))
            return fit

        band = rf.bootstrap_band(
            fitted, im, np.column_stack((rotation, fallen)), groups, at=[0.8], n=60, seed=5, level=0.8, curve=curve
        )
        separated += sum(failed)
        np.testing.assert_allclose([row.low, row.high], [band.low[0], band.high[0]], rtol=1e-5, atol=1e-6)
        assert row.low <= row.probability <= row.high or limit == "overturning"
    assert separated > 0


def test_resamples_are_those_of_the_bootstrap():
    groups = np.array([0, 0, 1, 2, 2, 2, 3])
    seen = []

    def fit(im, rows):
        seen.append(np.bincount(rows.astype(int), minlength=7))
        return rows

    rf.bootstrap_band(fit, np.arange(1.0, 8.0), np.arange(7), groups, at=[1.0], n=30, seed=9, curve=lambda *_: [0.5])
    np.testing.assert_array_equal(resample_weights(groups, 30, 9), seen[1:])


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
        (b,) = _firth(x, y, times[None].astype(float))
        np.testing.assert_allclose(b, best.x, rtol=1e-5, atol=1e-5)


def test_resamples_with_nothing_to_fit():
    im, rotation = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.0, 0.02, 0.03, 1.6])
    fallen = np.array([False, False, False, True])
    weights = np.array([[2.0, 2, 0, 0], [0.0, 0, 0, 4], [4.0, 0, 0, 0], [0.0, 2, 2, 0], [0.0, 4, 0, 0]])
    with np.errstate(all="raise"):
        found = exceedances(im, rotation, fallen, weights, np.array([2.5]), 0.024, 1e-4)[:, 0]
    assert math.isnan(found[0])  # one rotation is no line
    assert found[1] == 1.0  # all overturned
    assert found[2] == 0.0  # none rocks
    assert found[3] == 1.0  # the line goes through both, and 0.025 rad at the node
    assert math.isnan(found[4])


def altered(runs, **changes):
    return runs[runs["half_width"] == 1.6].assign(**changes)


def test_what_a_row_says_of_itself(runs):
    strong = rf.design_table(runs, 0.02, at=50.0, n_resamples=20)
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
    alone = rf.design_table(altered(runs, group="one"), 0.02, at=0.6)
    assert alone["note"].str.contains("No band: all runs belong to one recording.").all()
    few = runs[(runs["half_width"] == 1.6) & runs["record"].isin(["FF-1-a", "FF-2-a", "FF-3-a"])]
    few = few.assign(status="no_uplift", max_rotation=[0.0, 0.0, 0.0, 0.01, 0.0, 0.02] * 2)
    unknown = rf.design_table(few, 0.02, at=0.6)
    assert unknown["probability"].isna().all()
    assert unknown["note"].str.contains("There is no probability: a part that counts could not be fitted.").all()
    some = rf.design_table(runs[runs["record"].str.startswith("FF-1")], 0.02, at=0.6)
    assert some["note"].str.contains("recordings is too narrow|could be fitted").all()


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        ({}, {}, "Give either at, a level of the measure, or hazard, a HazardCurve in it."),
        ({}, {"at": 1.0, "hazard": HAZARD}, "Give either at, a level of the measure, or hazard, a HazardCurve in it."),
        ({}, {"at": 0.0}, "at must be a positive, finite number in the unit of the measure, but 0.0 was given."),
        ({}, {"at": 1.0, "measure": "relative_pga"}, "measure must not depend on the base, as a level of relative_pga"),
        ({}, {"at": 1.0, "confidence": 1.0}, "confidence must lie in [0, 1), but 1.0 was given. A 90 % band is 0.9."),
        ({}, {"at": 1.0, "n_resamples": 5}, "n_resamples must be a whole number of at least 20, but 5 was given."),
        ({"columns": ["tendon", "pgv"]}, {"at": 1.0}, "The table lacks tendon, pgv. Give what run_design returned."),
        ({"index": range(528)}, {"at": 1.0}, "The table has no rows. Give what run_design returned."),
    ],
)
def test_damaged_arguments_of_the_table(runs, change, arguments, message):
    with pytest.raises(rf.InputError) as caught:
        rf.design_table(runs.drop(**change or {"columns": []}), 0.02, **arguments)
    assert str(caught.value).startswith(message)


# The width


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
        ([0.1, 0.05], 1.0, "all meet it", True, "Every base meets it; one below B = 1 m might do."),
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
        ([0.4, math.nan, 0.1], 3.0, "met", True, "1 of 3 bases have no value and were left out."),
        ([math.nan], math.nan, "not met", True, "1 of 1 bases have no value and were left out."),
    ],
)
def test_what_is_said_of_a_width(values, expected, outcome, monotone, notes):
    (row,) = rf.smallest_width(made_up(values), 0.1).to_dict("records")
    assert row["half_width"] == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert (row["outcome"], row["monotone"], row["note"]) == (outcome, monotone, notes)


def test_widths_of_every_tendon(runs):
    table = rf.design_table(runs, 0.02, at=0.4, n_resamples=40)
    target = float(table["probability"].iloc[1])
    found = rf.smallest_width(table, target)
    assert list(found["tendon"]) == ["no tendon", "held"]
    assert list(found["prestress_ratio"]) == pytest.approx([0.0, 0.3])
    assert found["half_width"][0] == pytest.approx(1.6)
    assert found["half_width"][1] < 1.6
    assert (found["half_width_upper"].dropna() >= found["half_width"]).all()
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
