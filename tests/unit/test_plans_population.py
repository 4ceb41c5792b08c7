"""Random populations: what is drawn, each pair against single runs, chunks, and the statistics of made-up pairs."""

import math
import pickle
from collections import Counter

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from scipy import stats

import rockflex as rf
from rockflex.motion import Suite
from rockflex.papers.silva_stojadinovic_2024._pair_measures import PairMeasures
from rockflex.papers.silva_stojadinovic_2024.population import (
    PopulationStudy,
    draw_prototype,
    population_statistics,
    run_population,
)
from rockflex.studies._run_plan import run_plan

RECORDS = {"suites": ["fema-p695-near-field-no-pulse"], "include": ["NFNP-15-*", "NFNP-16-*"]}
PAIRS = 24


def study(**changes):
    return PopulationStudy(**{"records": RECORDS, "pairs": PAIRS, "seed": 7, "runs_per_chunk": 20} | changes)


@pytest.fixture(scope="module")
def plan():
    return study().plan()


@pytest.fixture(scope="module")
def pairs(plan):
    return run_plan(plan)


def test_draws_are_uniform_and_independent():
    drawn = [draw_prototype(3, number, 72) for number in range(3000)]
    for name, values in (
        ("n_stories", range(2, 16)),
        ("aspect_ratio", range(5, 11)),
        ("base_mass_ratio", (1.0, 1.5, 2.0, 2.5, 3.0)),
        ("stiffness_ratio", (0.0, math.inf)),
        ("record", range(72)),
    ):
        counts = Counter(getattr(each, name) for each in drawn)
        assert sorted(counts) == list(values)
        assert stats.chisquare(list(counts.values())).pvalue > 1e-3
    for shear, low, width in ((True, 0.06, 0.035), (False, 0.0125, 0.0375)):
        chosen = [each.coefficient for each in drawn if math.isinf(each.stiffness_ratio) == shear]
        assert stats.kstest(chosen, stats.uniform(low, width).cdf).pvalue > 1e-3
    numbers = np.array([(d.n_stories, d.aspect_ratio, d.base_mass_ratio, d.record) for d in drawn])
    assert np.abs(np.corrcoef(numbers.T) - np.eye(4)).max() < 0.07


def test_a_draw_depends_on_seed_and_number_alone():
    assert draw_prototype(1, 10**6, 72) == draw_prototype(1, 10**6, 72)
    assert len({draw_prototype(seed, number, 72) for seed in range(5) for number in range(5)}) == 25


def test_periods_of_the_prototypes():
    for number in range(50):
        drawn = draw_prototype(0, number, 1)
        frame = drawn.frame()
        height = 3.0 * drawn.n_stories
        power = 0.85 if drawn.stiffness_ratio else 1.0
        assert frame.period == pytest.approx(drawn.coefficient * height**power)
        properties = frame.rocking()
        assert 2 * math.pi / properties.omega[0] == pytest.approx(drawn.period, rel=1e-9)
        assert properties.effective_height[0] / properties.half_width == pytest.approx(drawn.aspect_ratio)
        assert properties.m_tot == pytest.approx(40e3 * (drawn.n_stories + drawn.base_mass_ratio))


def test_rows_are_pairs_of_single_runs(plan, pairs):
    for row in pairs.itertuples():
        drawn = draw_prototype(7, row.pair, 4)
        motion, frame = plan.motions[drawn.record], drawn.frame()
        assert row.motion == motion.name
        assert (row.n_stories, row.period, row.stiffness_ratio) == (
            drawn.n_stories,
            drawn.period,
            drawn.stiffness_ratio,
        )
        assert row.behaviour == ("shear" if drawn.stiffness_ratio else "flexure")
        for model, suffix in (("MDOF-S", "_mdof"), ("2DOF-S", "_2dof")):
            run = rf.simulate(frame, motion, model, "peaks")
            assert getattr(row, f"status{suffix}") == run.status
            assert getattr(row, f"n_impacts{suffix}") == run.n_impacts
            for name in ("max_rotation", "max_top_displacement", "max_base_shear", "max_base_moment"):
                assert getattr(row, name + suffix) == pytest.approx(getattr(run, name), rel=1e-9, abs=1e-12)


@pytest.mark.slow
def test_second_mode_and_its_combination(plan, pairs):
    for row in pairs.head(6).itertuples():
        drawn = draw_prototype(7, row.pair, 4)
        motion, p = plan.motions[drawn.record], drawn.frame().rocking()
        run = rf.simulate(drawn.frame(), motion, "MDOF-S")
        sampled = np.abs(run.modal_displacement[:, 1]).max()
        assert sampled <= row.max_second_displacement_mdof * (1 + 1e-9)
        assert sampled == pytest.approx(row.max_second_displacement_mdof, rel=0.05)
        fine = rf.simulate(drawn.frame(), motion.refined(20), "MDOF-S")
        assert np.abs(fine.modal_displacement[:, 1]).max() == pytest.approx(row.max_second_displacement_mdof, rel=1e-3)
        sd = motion.sd(2 * math.pi / p.omega[1], 0.02)
        sa = p.omega[1] ** 2 * sd
        one = rf.simulate(drawn.frame(), motion, "2DOF-S", "peaks")
        for name, second in (
            ("top_displacement", p.top_ordinate[1] * sd),
            ("base_shear", p.effective_mass[1] * sa),
            ("base_moment", p.effective_mass[1] * p.effective_height[1] * sa),
        ):
            expected = math.sqrt(getattr(one, f"max_{name}") ** 2 + second**2)
            assert getattr(row, f"srss_{name}") == pytest.approx(expected, rel=1e-9)
        assert (row.l0r_g, row.structure_mass) == pytest.approx((p.l0r * 9.81, 40e3 * drawn.n_stories))
        assert row.uplift_acceleration == pytest.approx(p.m_tot * 9.81 * p.half_width / p.l0r)


@pytest.mark.slow
def test_chunks_and_their_sizes_change_nothing(plan, pairs):
    assert (plan.n_chunks, plan.n_runs) == (3, 48)
    copied = pickle.loads(pickle.dumps(plan))
    for number in (2, 0, 1):
        assert copied.chunk(number).equals(plan.chunk(number))
    other = study(runs_per_chunk=2).plan()
    assert other.n_chunks == PAIRS
    one, two = (pa.concat_tables([p.chunk(n) for n in range(p.n_chunks)]) for p in (plan, other))
    assert one.equals(two)
    assert one.schema.equals(other.chunk(0).schema)
    assert run_population(plan.motions, PAIRS, 7, workers=1).equals(pairs)
    longer = run_plan(study(pairs=PAIRS + 3).plan())
    assert longer.head(PAIRS).equals(pairs)


def test_structures_alike_are_computed_side_by_side_and_rows_keep_their_order():
    found = study(pairs=12, runs_per_chunk=24).plan()
    order = found.in_order_of_work(range(12))
    stories = [draw_prototype(found.seed, unit, len(found.motions)).n_stories for unit in order]
    assert stories == sorted(stories, reverse=True)
    assert sorted(order) == [*range(12)] != list(order)
    table = found.chunk(0)
    assert table["pair"].to_pylist() == [*range(12)]
    assert found.on_threads(3).chunk(0).equals(table)


def test_free_vibration_reaches_the_runs(plan):
    longer = run_plan(study(pairs=4, free_vibration=3.0).plan())
    longer = longer[(longer["status_mdof"] != "overturned") & (longer["status_2dof"] != "overturned")]
    assert len(longer) >= 2
    for row in longer.itertuples():
        assert row.end_time_mdof == pytest.approx(plan.motions[row.motion].duration + 3.0)
        assert row.end_time_2dof == row.end_time_mdof


@pytest.mark.slow
def test_pair_that_cannot_be_solved_is_a_row():
    absurd = rf.GroundMotion([0.0, 1.0, 0.0], 1e6, "absurd")
    table = run_population(Suite([absurd]), 3)
    assert table["status_mdof"].isna().all()
    assert table["error"].str.contains("time step").all()
    assert table["period"].notna().all()
    with pytest.raises(rf.InputError, match="pairs holds no pair that was solved"):
        population_statistics(table)


def made_up(n=400, noise=0.05, seed=0, slopes=(0.9, 1.1)):
    rng = np.random.default_rng(seed)
    x, shear = rng.lognormal(0.0, 0.5, n), rng.random(n) < 0.5
    y = np.where(shear, *slopes) * x + noise * rng.standard_normal(n)
    numbers = {name: np.ones(n) for name in ("structure_mass", "l0r_g", "sd_2", "max_second_displacement_mdof")}
    for quantity in ("top_displacement", "base_shear", "base_moment", "rotation"):
        numbers |= {f"max_{quantity}_2dof": x, f"max_{quantity}_mdof": y, f"srss_{quantity}": 1.1 * x}
    return pd.DataFrame(
        numbers
        | {"behaviour": np.where(shear, "shear", "flexure"), "status_mdof": "rocking", "status_2dof": "rocking"}
        | {name: np.arange(n) for name in ("pair", "n_stories", "period", "aspect_ratio", "base_mass_ratio", "motion")}
        | {"pga": 1.0, "pgv": 1.0, "nominal_overturning_mdof": False, "nominal_overturning_2dof": False}
    )


def test_measures_leave_out_pairs_that_could_not_be_solved():
    frame = made_up().astype({"status_mdof": "string", "status_2dof": "string"})
    frame.loc[:9, ["status_mdof", "status_2dof"]] = "no_uplift"
    failed = frame.index % 7 == 0
    frame.loc[failed, "status_2dof"] = pd.NA
    frame.loc[failed, [name for name in frame if name.startswith("max_") and name.endswith("_2dof")]] = np.nan
    found, expected = (
        PairMeasures(pairs).of(np.arange(len(pairs))) for pairs in (frame, frame[~failed].reset_index(drop=True))
    )
    fitted = {name: value for name, value in expected.items() if name.startswith(("slope", "r2"))}
    assert {name: found[name] for name in fitted} == pytest.approx(fitted, rel=1e-12, nan_ok=True)
    assert found["largest rotation of 2DOF-S"] == expected["largest rotation of 2DOF-S"]
    assert found["2DOF-S alone uplifts"] == 0.0


def test_slopes_and_coefficients_are_what_their_definitions_say():
    frame = made_up()
    found = population_statistics(frame, n_resamples=50)
    rows = found.agreement.set_index(["group", "quantity", "behaviour"])
    for behaviour in ("all", "shear", "flexure"):
        part = frame if behaviour == "all" else frame[frame["behaviour"] == behaviour]
        x, y = part["max_rotation_2dof"].to_numpy(), part["max_rotation_mdof"].to_numpy()
        slope = np.linalg.lstsq(x[:, None], y, rcond=None)[0][0]
        spread = ((y - y.mean()) ** 2).sum()
        row = rows.loc[("rocking", "rotation", behaviour)]
        assert row["n"] == len(part)
        assert row["slope"] == pytest.approx(slope, rel=1e-10)
        assert row["r2"] == pytest.approx(1 - ((y - x) ** 2).sum() / spread, rel=1e-10)
        assert row["r2_line"] == pytest.approx(1 - ((y - slope * x) ** 2).sum() / spread, rel=1e-10)
        assert row["r2_low"] < row["r2"] < row["r2_high"]
        assert row["slope_low"] < row["slope"] < row["slope_high"]
    combined = found.combination.set_index(["quantity", "estimate"])
    assert combined.loc[("base_shear", "SRSS"), "slope"] == pytest.approx(rows["slope"].iloc[3] / 1.1, rel=1e-10)
    assert combined.loc[("base_shear", "2DOF-S"), "slope"] == pytest.approx(
        np.linalg.lstsq(frame[["max_base_shear_2dof"]], frame["max_base_shear_mdof"], rcond=None)[0][0] / 1.0,
        rel=1e-10,
    )
    assert np.isnan(rows.loc[("no_uplift", "top_displacement", "all"), "r2"])


def test_intervals_are_those_of_scipy():
    frame = made_up(200)
    x, y = frame["max_rotation_2dof"].to_numpy(), frame["max_rotation_mdof"].to_numpy()
    found = population_statistics(frame, confidence=0.8, n_resamples=4000).agreement
    row = found[(found["quantity"] == "rotation") & (found["behaviour"] == "all")].iloc[0]

    def slope(x, y, axis=-1):
        return (x * y).sum(axis) / (x * x).sum(axis)

    def r2(x, y, axis=-1):
        return 1 - ((y - x) ** 2).sum(axis) / ((y - y.mean(axis, keepdims=True)) ** 2).sum(axis)

    for name, statistic in (("slope", slope), ("r2", r2)):
        interval = stats.bootstrap(
            (x, y), statistic, paired=True, method="percentile", confidence_level=0.8, n_resamples=4000, rng=1
        ).confidence_interval
        width = interval.high - interval.low
        assert row[f"{name}_low"] == pytest.approx(interval.low, abs=0.1 * width)
        assert row[f"{name}_high"] == pytest.approx(interval.high, abs=0.1 * width)


@pytest.mark.slow
def test_intervals_are_seeded_and_cover():
    frame = made_up()
    one, two, other = (population_statistics(frame, n_resamples=100, seed=s).agreement for s in (1, 1, 2))
    assert one.equals(two)
    assert not one.equals(other)
    covered = 0
    for seed in range(60):
        found = population_statistics(made_up(150, seed=seed, slopes=(1.0, 1.0)), n_resamples=200).agreement
        row = found[found["quantity"] == "rotation"].iloc[0]
        covered += row["slope_low"] < 1.0 < row["slope_high"]
    assert 45 <= covered <= 59  # 54 of 60 at a level of 90 %


def test_outcomes_and_outliers():
    frame = made_up(30)
    frame.loc[0, "status_mdof"] = "overturned"
    frame.loc[1, ["status_mdof", "status_2dof"]] = "no_uplift"
    frame.loc[2, "status_2dof"] = "overturned"
    frame.loc[3, "status_mdof"] = None
    frame.loc[4, "nominal_overturning_mdof"] = True
    frame.loc[0, "max_rotation_mdof"] = frame.loc[2, "max_rotation_2dof"] = 1e3
    frame.loc[5, "max_rotation_mdof"] = 100.0
    found = population_statistics(frame, n_resamples=10, n_outliers=3)
    assert found.outcomes.to_numpy().tolist() == [[1, 0, 0], [0, 26, 1], [0, 1, 0]]
    assert (found.n_failed, found.n_nominal_mdof, found.n_nominal_2dof) == (1, 1, 0)
    assert found.agreement.query("group == 'rocking' and behaviour == 'all'")["n"].tolist() == [26, 26]
    assert found.outliers["pair"].tolist() in ([0, 2, 5], [2, 0, 5])
    assert found.outliers["share"].isna().tolist() == [True, True, False]
    assert 0.99 < found.outliers["share"][2] < 1.0
    assert found.outliers["difference"][2] == pytest.approx(100.0 - frame.loc[5, "max_rotation_2dof"])


def test_few_pairs_say_nothing():
    frame = made_up(5)
    frame.loc[:2, ["status_mdof", "status_2dof"]] = "no_uplift"
    rows = population_statistics(frame, n_resamples=10).agreement.set_index(["group", "quantity", "behaviour"])
    assert rows.loc[("no_uplift", "top_displacement", "all"), "slope"] > 0
    assert np.isnan(rows.loc[("rocking", "rotation", "all"), "slope"])
    frame["status_mdof"] = frame["status_2dof"] = "no_uplift"
    assert population_statistics(frame, n_resamples=10).combination["n"].tolist() == [0] * 7


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda _: population_statistics(made_up(10), confidence=1.0), "confidence must lie in .* but 1.0"),
        (lambda _: population_statistics(made_up(10), n_resamples=0), "n_resamples must be .* at least 1, but 0"),
        (lambda _: population_statistics(made_up(10), seed=-1), "seed must be .* at least 0, but -1"),
        (lambda _: population_statistics(made_up(10), n_outliers=-1), "n_outliers must be .* at least 0, but -1"),
        (lambda plan: run_population(plan.motions, 0), "pairs must be a whole number from 1 to 4294967295, but 0"),
        (lambda plan: run_population(plan.motions, 1, -1), "seed must be a whole number of at least 0, but -1"),
    ],
)
def test_values_out_of_range_are_named(plan, call, said):
    with pytest.raises(rf.InputError, match=said):
        call(plan)
