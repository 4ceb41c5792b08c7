"""Random structures: formulas, draws, each run against a single one, chunks, resumed folders, and what is refused."""

import math
import pickle
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import rockflex as rf
from rockflex.studies._random_variables import (
    RandomVariables,
    formula_value,
    is_formula,
    names_in_formula,
    uniform_draws,
)
from rockflex.studies._run_plan import run_plan
from rockflex.studies._study_kind import KINDS, StudyFindings

EXAMPLE = Path(__file__).parents[2] / "examples" / "controlled_rocking_walls.toml"
G = 9.81
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-5-*", "FF-9-a"]}
VARIABLES = {
    "height": {"uniform": [8.0, 20.0]},
    "ratio": {"lognormal": [0.3, 0.4]},
    "hardening": {"one_of": [0.0, 0.02]},
    "period": "= 0.05 * height**0.75",
}
WALL = {
    "height": "= height",
    "mass": "= 2e4 * height",
    "stiffness_parameter": 0.0,
    "base_mass": 4e4,
    "period": "= period",
    "aspect_ratio": 6.0,
    "damping_ratio": 0.02,
    "n_modes": 2,
}
FUSE = {
    "kind": "yielding_dissipator",
    "stiffness": "= 100 * weight / half_width",
    "yield_force": "= ratio * weight",
    "post_yield_ratio": "= hardening",
}
TENDON = {"kind": "tendon", "initial_force": "= 0.5 * weight", "stiffness": "= 0.4 * l0r_g / half_width**2"}
STRUCTURE = {"wall_frame": WALL, "elements": [TENDON, FUSE]}


def study(**changes):
    given = {"count": 12, "seed": 3, "variables": VARIABLES, "structure": STRUCTURE, "records": RECORDS}
    return rf.MonteCarloStudy(**given | {"models": ["2DOF-S", "MDOF-S"], "runs_per_chunk": 40} | changes)


@pytest.fixture(scope="module")
def runs():
    return run_plan(study().plan())


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("= 2 + 3 * x", 8),
        ("=-x**2", -4.0),
        ("= (1 + x) / 4", 0.75),
        ("= min(x, 7, 3) + max(1)", 3),
        ("= sqrt(x) * exp(log(x))", 2.0 * math.sqrt(2.0)),
        ("= x", 2),
        ("= 1e3 - +x", 998.0),
    ],
)
def test_formulas(formula, value):
    assert is_formula(formula)
    found = formula_value(formula, {"x": 2})
    assert found == pytest.approx(value)
    assert type(found) is type(value)
    assert names_in_formula(formula) <= {"x"}


def test_what_is_a_formula():
    assert not any(map(is_formula, ("wall", 1.0, None, ["= x"], " = x")))
    assert names_in_formula("= min(a, b) * c_1 - a") == {"a", "b", "c_1"}


@pytest.mark.parametrize(
    "formula",
    ["=", "= ", "= 2 x", "= x.real", "= x[0]", "= 'a'", "= True", "= 1j", "= sum(x)", "= min()", "= min(x, key=x)",
     "= min", "= (x for x in y)", "= __import__('os')", "= x if x else y", "= x; y", "= x := 2", "= a and b", "= ~x",
     "= x % 2", "= x // 2", "= f'{x}'", "= lambda: 1", "= min(*x)", f"= {'(' * 150}x", f"= {'x + ' * 60}x", "= x\0"]
)  # fmt: skip
def test_only_arithmetic_is_a_formula(formula):
    if formula == "= min":
        assert names_in_formula(formula) == {"min"}  # a name that no variable may have
        return
    with pytest.raises(rf.InputError) as caught:
        formula_value(formula, {"x": 1.0})
    assert str(caught.value).endswith(
        "is not a formula. Expected numbers, names of variables, + - * / **, parentheses, and min, max, sqrt, exp, "
        "log, in at most 200 characters."
    )


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("= 1 / x", "The formula '= 1 / x' has no value for x = 0: float division by zero."),
        ("= sqrt(x, 2)", "The formula '= sqrt(x, 2)' has no value for x = 0: math.sqrt() takes exactly one argument"),
        ("= log(x)", "The formula '= log(x)' has no value for x = 0: "),
        ("= (x - 1)**0.5", "The formula '= (x - 1)**0.5' has no value for x = 0: a power of a negative number."),
        ("= 9**9**9**9", "The formula '= 9**9**9**9' has no value: "),
        ("= exp(1e9)", "The formula '= exp(1e9)' has no value: math range error."),
    ],
)
def test_a_formula_without_a_value(formula, said):
    with pytest.raises(rf.InputError, match=re.escape(said)):
        formula_value(formula, {"x": 0.0})


DISTRIBUTIONS = {
    "u": ({"uniform": [2.0, 5.0]}, stats.uniform(2.0, 3.0)),
    "l": ({"log_uniform": [0.1, 10.0]}, stats.loguniform(0.1, 10.0)),
    "n": ({"normal": [3.0, 0.5]}, stats.norm(3.0, 0.5)),
    "ln": ({"lognormal": [0.3, 0.4]}, stats.lognorm(0.4, scale=0.3)),
}


def test_draws_have_their_distributions_and_are_independent():
    given = {name: table for name, (table, _) in DISTRIBUTIONS.items()}
    variables = RandomVariables(given | {"w": {"whole": [2, 5]}, "o": {"one_of": [1.0, math.inf]}, "c": 7}, {})
    drawn = [variables.draw(1, number) for number in range(2000)]
    for name, (_, expected) in DISTRIBUTIONS.items():
        assert stats.kstest([each[name] for each in drawn], expected.cdf).pvalue > 1e-3
    for name, values in (("w", [2, 3, 4, 5]), ("o", [1.0, math.inf])):
        found = [each[name] for each in drawn]
        assert sorted(set(found)) == values
        assert stats.chisquare([found.count(value) for value in values]).pvalue > 1e-3
    assert {each["c"] for each in drawn} == {7}
    assert all(type(each["w"]) is int for each in drawn)
    numbers = np.array([[each[name] for name in (*DISTRIBUTIONS, "w")] for each in drawn])
    assert np.abs(np.corrcoef(numbers.T) - np.eye(5)).max() < 0.08
    assert all(0.0 < draw < 1.0 for draw in uniform_draws(1, 2, "u", 1000))


def test_a_draw_depends_on_seed_number_and_name_alone():
    few = RandomVariables({"b": {"uniform": [0.0, 1.0]}}, {})
    many = RandomVariables({"c": "= b + a", "a": {"uniform": [0.0, 1.0]}, "b": {"uniform": [0.0, 1.0]}}, {})
    drawn = many.draw(5, 1000)
    assert list(drawn) == ["c", "a", "b"]
    assert drawn["b"] == few.draw(5, 1000)["b"] != drawn["a"]
    assert drawn["c"] == drawn["a"] + drawn["b"]
    assert len({few.draw(seed, number)["b"] for seed in range(5) for number in range(5)}) == 25
    # Of a longer study, and of one with other fuses, the walls are the same.
    weaker = study(count=99, variables=VARIABLES | {"ratio": 0.1})
    assert weaker.structure_of(4).truncated(1).effective_height == study().structure_of(4).truncated(1).effective_height


def test_structures_are_those_of_the_formulas():
    for number in range(4):
        p = study().structure_of(number)
        values = RandomVariables(VARIABLES, {}).draw(3, number)
        height, weight = values["height"], p.m_tot * G
        wall = rf.WallFrame(height, 2e4 * height, 0.0, 4e4, 0.05 * height**0.75, 6.0, 0.02, n_modes=2)
        tendon = rf.Tendon(0.5 * weight, 0.4 * (p.l0r * G) / p.half_width**2)
        fuse = rf.YieldingDissipator(100 * weight / p.half_width, values["ratio"] * weight, values["hardening"])
        assert p == rf.Restrained(wall, [tendon, fuse]).rocking()
        # By hand: (W + W/2) B over (1 - α) F_y B.
        expected = 1.5 / (values["ratio"] * (1.0 - values["hardening"]))
        assert p.recentring_ratio == pytest.approx(expected, rel=1e-12)


@pytest.mark.slow
def test_rows_are_single_runs(runs):
    assert len(runs) == study().plan().n_runs == 12 * 5 * 2
    assert runs["error"].isna().all()
    suite = rf.Records(**RECORDS).load(Path())
    for row in runs.iloc[::17].itertuples():
        p = study().structure_of(row.number)
        alone = rf.simulate(p, suite[row.motion], row.model, output="peaks")
        assert (row.status, row.max_rotation, row.max_base_moment) == (
            alone.status,
            alone.max_rotation,
            alone.max_base_moment,
        )
        assert row.weight == p.m_tot * G
        assert (row.half_width, row.resisting_moment) == (p.half_width, p.resisting_moment)
        assert row.weight_moment == pytest.approx(row.weight * row.half_width)
        assert (row.l0r_g, row.recentring_ratio) == (p.l0r * G, p.recentring_ratio)
        assert row.nominal_limit == p.nominal_overturning_rotation
        assert row.sa_t1 == pytest.approx(suite[row.motion].sa(2.0 * math.pi / p.omega[0], 0.02), rel=1e-9)
    assert runs["structure"].unique().tolist() == ["random structures"]
    assert runs["number"].tolist() == [number for number in range(12) for _ in range(10)]


@pytest.mark.slow
def test_chunks_change_nothing(runs):
    for per_chunk in (1, 10, 1000):
        assert run_plan(study(runs_per_chunk=per_chunk).plan()).equals(runs)
    plan = pickle.loads(pickle.dumps(study().plan()))
    assert plan.chunk(1).equals(study().plan().chunk(1))
    assert plan.n_chunks == 3


def test_records_are_drawn_for_each_structure():
    plan = study(count=400, records_per_structure=2).plan()
    chosen = [plan.records_of(number) for number in range(400)]
    assert all(len(set(each)) == 2 and each == sorted(each) for each in chosen)
    counts = np.bincount(np.concatenate(chosen), minlength=5)
    assert stats.chisquare(counts).pvalue > 1e-3
    assert study(count=3, records_per_structure=2, models=["2DOF-S"], scales=[0.5, 1.0]).plan().n_runs == 12
    with pytest.raises(rf.InputError) as caught:
        study(records_per_structure=6).plan()
    assert str(caught.value) == ("records_per_structure must be at most the number of records, 5, but 6 was given.")


@pytest.mark.slow
def test_a_stopped_study_is_resumed(tmp_path, runs):
    def stop(now):
        if now.done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rf.run_study(study(), tmp_path / "a", workers=1, progress=stop)
    seen = []
    whole = rf.run_study(study(), tmp_path / "a", progress=seen.append)
    assert seen[0].kept == 2
    assert whole.equals(runs)
    with pytest.raises(rf.InputError, match=r"variables\.ratio\.lognormal\[0\]: 0\.3 in the folder, 0\.35 now"):
        rf.run_study(study(variables=VARIABLES | {"ratio": {"lognormal": [0.35, 0.4]}}), tmp_path / "a")


def test_structures_that_cannot_be_built_are_rows_with_an_error():
    table = run_plan(study(variables=VARIABLES | {"ratio": {"one_of": [-0.1, 0.3]}}, models=["2DOF-S"]).plan())
    lost = table["error"].notna()
    assert 0 < lost.sum() < len(table)
    assert (table.loc[lost, "ratio"] == -0.1).all()
    assert table.loc[lost, ["status", "weight", "recentring_ratio", "pga"]].isna().all(axis=None)
    assert table.loc[lost, ["motion", "model", "scale", "height"]].notna().all(axis=None)
    assert table.loc[~lost, "status"].notna().all()
    said = table.loc[lost, "error"].iloc[0]
    assert said.startswith("[[elements]] no. 2: yield_force must be a positive, finite number in N, but -")
    found = StudyFindings()
    KINDS["monte_carlo"].report(study(), table, found)
    n = int(lost.sum()) // 5
    assert found.remarks == [f"{n} of 12 structures cannot be built; their runs have an error"]


def test_the_report_counts_all_structures_together(runs):
    found = StudyFindings()
    KINDS["monte_carlo"].report(study(), runs, found)
    values, outcomes, lines = found.tables.values()
    assert [row["variable"] for row in values] == [*VARIABLES, "recentring_ratio"]
    assert values[0]["least"] == runs["height"].min()
    assert [sum(row[name] for name in ("no rocking", "rocking", "overturned", "failed")) for row in outcomes] == [
        60
    ] * 2
    assert len(lines) == 6


def test_files_of_numbers_belong_to_the_study(tmp_path):
    np.savetxt(tmp_path / "k.csv", [[2e7, -1e7], [-1e7, 1e7]], delimiter=",")
    matrices = {"mass": ["= m", 1e4], "stiffness": "k.csv", "heights": [3.0, 6.0], "base_mass": 1e4}
    matrices |= {"half_width": "= b", "damping_ratio": 0.02}
    variables = {"m": {"uniform": [9e3, 1.1e4]}, "b": {"uniform": [0.5, 1.0]}}
    made = study(variables=variables, structure={"matrices": matrices}, records_per_structure=1)
    table = run_plan(made.read_from(tmp_path).plan())
    assert table["error"].isna().all()
    assert table["half_width"].equals(table["b"])
    assert list(made.checksums()) == ["structure.matrices.stiffness"]


def test_the_example(tmp_path):
    made = rf.load_study(EXAMPLE)
    plan = made.plan()
    assert plan.n_runs == 4000
    drawn = [plan.population.variables.draw(made.seed, number) for number in range(20)]
    for number, values in enumerate(drawn):
        p = made.structure_of(number)
        # The fuses are given as a share of the strength at which the base stays open.
        assert p.recentring_ratio == pytest.approx(1.0 / (values["fuses"] * (1.0 - values["hardening"])), rel=1e-12)
        assert p.self_centring == (p.recentring_ratio > 1.0)
        (tendon,) = p.tendons
        strain = tendon.yield_force / (tendon.stiffness * values["height"])
        assert strain == pytest.approx(1580.0 / 195e3, rel=1e-3)
        assert tendon.initial_force / tendon.yield_force == pytest.approx(values["stress"])
    assert made.document() == rf.MonteCarloStudy(**tomllib.loads(EXAMPLE.read_text("utf-8"))).document()


def changed(structure=None, **variables):
    return {"variables": VARIABLES | variables} | ({} if structure is None else {"structure": STRUCTURE | structure})


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (changed(height=True), "[variables] height must be a distribution such as { uniform = [0.1, 0.5] }, a formula"),
        (changed(height="tall"), "[variables] height must be a distribution such as"),
        (changed(height={}), "[variables.height]: one distribution is expected, uniform, log_uniform, whole, normal,"),
        (changed(height={"uniform": [1.0, 2.0], "normal": [1.0, 0.1]}), "or one_of, but 2 were given."),
        (changed(height={"unifrom": [1.0, 2.0]}), "[variables.height]: unifrom is not known; there are uniform,"),
        (changed(height={"uniform": 3.0}), "[variables.height]: uniform must be a list of the smallest and the"),
        (changed(height={"uniform": [3.0]}), "uniform must be a list of two finite numbers, but [3.0] was given."),
        (changed(height={"normal": [3.0, math.inf]}), "normal must be a list of two finite numbers, but [3.0, inf]"),
        (changed(height={"uniform": [3.0, 2.0]}), "uniform must be a range whose first number is the smaller, but"),
        (changed(height={"whole": [3.0, 2.5]}), "whole must be a list of the smallest and the largest of equally"),
        (changed(height={"lognormal": [0.0, 0.1]}), "lognormal must begin with a positive number, but [0.0, 0.1] was"),
        (changed(height={"log_uniform": [-1.0, 1.0]}), "log_uniform must begin with a positive number, but"),
        (changed(height={"lognormal": [2e5, 4e4]}), "standard deviation of the logarithm, at most 10, but"),
        (changed(height={"normal": [1.0, -0.1]}), "normal must end with a standard deviation, but -0.1 is negative."),
        (changed(height={"one_of": []}), "one_of must be a list of one number or more, but [] was given."),
        (changed(height={"one_of": [math.nan]}), "one_of must be a list of one number or more, but [nan] was given."),
        (changed(height="= 2 * hight"), "[variables] height: hight is not known; there are height, ratio, hardening,"),
        (changed(height="= period"), "[variables] Formulas refer to each other: "),
        (changed(height="= 2 * ("), "'= 2 * (' is not a formula. Expected numbers"),
        (changed(**{"fuse ratio": 1.0}), "[variables] 'fuse ratio' is not a name. Expected letters, digits and _,"),
        (changed(weight=1.0), "[variables] weight is already the weight m_tot g of the structure in N. Give the"),
        (changed(pga=1.0), "[variables] pga is already a column of the table. Give the variable another name."),
        (changed(min=1.0), "[variables] min is already a function. Give the variable another name."),
        (changed({"wall_frame": WALL | {"height": "= hieght"}}), "[structure.wall_frame] height: hieght is not known;"),
        (changed({"wall_frame": WALL | {"mass": "= 0.1 * weight"}}), "[structure.wall_frame] mass: weight is known"),
        (
            changed({"wall_frame": WALL | {"damping_ratio": ["= 0.02", "= (x"]}}),
            "[structure.wall_frame] damping_ratio: '= (x' is not a formula.",
        ),
        (changed({"elements": [TENDON, FUSE | {"yield_force": "= share * weight"}]}), "[[structure.elements]] no. 2,"),
        (
            changed({"elements": [FUSE | {"yield_force": "= weight / (hardening - hardening)"}]}),
            "None of the first 12 "
            "structures can be built. Number 0: [[structure.elements]] no. 1, yield_force: The formula "
            "'= weight / (hardening - hardening)' has no value for hardening = ",
        ),
        (changed({"wall_frame": WALL | {"heigth": 3.0}}), "None of the first 12 structures can be built. Number 0:"),
        (changed({"elements": [{"kind": "damper"}]}), '[[structure.elements]] no. 1, kind must be "tendon", '),
        (changed({"wall_frame": WALL | {"period": "= 0 * height"}}), "Number 0: [wall_frame]: period must be a"),
        (changed({"wall_frame": None}), "[structure]: one structure is expected, [frame], "),
        ({"count": 0}, "count must be the number of random structures, a whole number from 1 to 4294967295, but 0 was"),
        ({"seed": -1}, "seed must be what the draws depend on, a whole number of at least 0, but -1 was given."),
        ({"records_per_structure": 0}, "records_per_structure must be how many records to draw for each structure, a"),
        ({"variables": [1]}, "variables must be a table of random variables, but [1] was given."),
        ({"structure": "wall"}, "structure must be a table of a structure, such as [structure.frame], but 'wall' was"),
        ({"scales": []}, "largest = 3.0, step = 0.25}, but [] was given."),
    ],
)
def test_messages(changes, said):
    with pytest.raises(rf.InputError) as caught:
        study(**changes).plan()
    assert said in str(caught.value)
    assert "pydantic" not in str(caught.value)


def test_sensitivities_are_columns_of_runs_that_stand(tmp_path):
    example = Path(__file__).parents[2] / "examples" / "reference_set.toml"
    study = rf.load_study(example).model_copy(update={"count": 3})
    runs = rf.run_study(study, tmp_path / "out")
    assert len(runs) == 3 * 4 * 4
    column = runs["sensitivity_max_rotation"]
    assert column[runs["status"] != "rocking"].isna().all()
    assert column[runs["status"] == "rocking"].notna().all()
    suite = study.records.load(example.parent)
    for _, row in runs[runs["status"] == "rocking"].head(4).iterrows():
        motion = suite[row["motion"]].scaled(row["scale"])
        alone = rf.simulate(study.structure_of(row["number"]), motion, "MDOF-S", free_vibration="settle")
        assert row["sensitivity_max_rotation"] == alone.sensitivity["max_rotation"]


def test_sensitivity_of_what_has_none_is_refused():
    study = rf.load_study(Path(__file__).parents[2] / "examples" / "reference_set.toml")
    with pytest.raises(rf.InputError, match=r"sensitivities must be among .* 'status' was given"):
        type(study)(**{**study.model_dump(exclude={"sensitivities"}), "sensitivities": ["status"]})
