"""The search for the cheapest design, in Python, from files and on the command line."""

import hashlib
import json
import math
import pickle
import shutil

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize
from typer.testing import CliRunner

import rockflex as rf
from design_case import CONTENT, FRAME
from design_search_case import (
    BARE,
    COST,
    ELEMENTS,
    PROPERTIES,
    SCALES,
    SEARCH,
    SLOW,
    STRONG,
    STRUCTURE,
    SUITE,
    WEIGHT,
    B,
    replaced,
)
from drawing import drawn
from rockflex.cli._app import app
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies.design import DesignStudy
from rockflex.studies.design._design_search import MarginSurface


@pytest.fixture(scope="module")
def law():
    with pytest.MonkeyPatch.context() as patch:
        yield replaced(patch)


@pytest.fixture(scope="module")
def done(law):
    """Runs and best design of a search, made once."""
    made = {}

    def of(*requirements):
        if requirements not in made:
            runs = search(requirements)
            made[requirements] = runs, best_of(runs, requirements)
        return made[requirements]

    return of


def search(requirements=(SLOW,), space=SEARCH, cost=COST, structure=STRUCTURE):
    return rf.search_design(structure, SUITE, space, requirements, cost, "2DOF-S", SCALES)


def best_of(runs, requirements):
    return rf.best_design(runs, requirements, COST, n_resamples=40)


@pytest.mark.slow
@pytest.mark.parametrize("requirements", [[SLOW], [STRONG], [SLOW, STRONG]])
def test_the_optimum_of_a_problem_in_closed_form_is_found(law, done, requirements):
    values, costs, governs = law.optimum(SEARCH, requirements)
    runs, found = done(*requirements)
    best = found.designs.iloc[found.best]
    # The cheapest of 49 x 33 x 33 designs, among 68 that are run: its neighbours differ by less than a percent in cost.
    assert costs <= best["cost"] * (1.0 + 1e-9)
    assert best["cost"] == pytest.approx(costs, rel=0.01)
    assert best["half_width"] == pytest.approx(values[0], abs=0.15)
    assert found.governs == requirements[governs].label
    assert len(runs) <= SEARCH.n_designs * len(SUITE) * len(SCALES)
    start = [2.0, 0.2, 0.1]
    exact = minimize(
        lambda v: v[0] + 1.1 * v[1] + 2.5 * v[2],
        start,
        bounds=[(1.0, 2.5), (0.0, 0.4), (0.0, 0.2)],
        constraints=[
            {"type": "ineq", "fun": lambda v, r=r: -law.margin(r, v[0], v[1] * WEIGHT, v[2] * WEIGHT)}
            for r in requirements
        ],
    )
    assert exact.success
    assert best["cost"] == pytest.approx(exact.fun, rel=0.02)
    curve = rf.trade_off(found)
    assert curve["cost"].min() == pytest.approx(exact.fun, rel=0.02)


@pytest.mark.slow
def test_the_probabilities_are_those_of_the_law(law, done):
    for row in done(SLOW, STRONG)[1].designs.to_dict("records"):
        margins = {
            each.label: law.margin(each, row["half_width"], row["prestress"], row["dissipator_force"])
            for each in (SLOW, STRONG)
        }
        for each in (SLOW, STRONG):
            assert (row[each.label] <= each.target) == (margins[each.label] <= 0.0)
            assert row[f"{each.label}, low"] <= row[each.label] <= row[f"{each.label}, high"]
        assert row["meets"] == all(margin <= 0.0 for margin in margins.values())
        assert row["cost"] == pytest.approx(
            row["half_width"] + 1.1 * row["prestress"] / WEIGHT + 2.5 * row["dissipator_force"] / WEIGHT
        )
        assert row["prestress"] == pytest.approx(0.2 * WEIGHT * row["tendon_factor"])
        assert row["dissipator_force"] == pytest.approx(0.1 * WEIGHT * row["dissipator_factor"])


@pytest.mark.slow
def test_the_trade_off_is_that_of_the_law(law, done):
    slow = done(SLOW)[1]
    prestress, force = (
        factors.ravel() * WEIGHT for factors in np.meshgrid(np.linspace(0, 0.4, 201), np.linspace(0, 0.2, 201))
    )
    curve = rf.trade_off(slow)
    assert len(curve) > 30
    for row in curve.itertuples():
        cost = COST.of(row.half_width, prestress, force)
        least = cost[law.margin(SLOW, row.half_width, prestress, force) <= 0.01].min()
        assert row.cost == pytest.approx(least, rel=0.03)
        assert row.governs == SLOW.label
    forces = rf.trade_off(slow, "tendon_factor")
    assert (np.diff(forces["prestress"]) > 0.0).all()
    assert forces["cost"].min() == pytest.approx(curve["cost"].min())
    with pytest.raises(rf.InputError, match="variable must be one that the search varied, half_width, tendon_factor, "):
        rf.trade_off(slow, "width")


@pytest.mark.slow
def test_the_limit_that_governs_is_the_one_whose_loss_makes_it_cheaper(law, done):
    found, (_, _, governs) = done(SLOW, STRONG)[1], law.optimum(SEARCH, [SLOW, STRONG])
    limits = found.limits.set_index("limit")
    least = found.designs.loc[found.best, "cost"]
    other = [SLOW, STRONG][1 - governs].label
    assert limits.loc[found.governs, "cost_without"] < least
    assert limits.loc[other, "cost_without"] == pytest.approx(least)
    assert limits.loc[found.governs, "used"] == limits["used"].max()
    assert limits["used"].max() <= 1.0


@pytest.mark.slow
def test_resamples_choose_anew(done):
    runs, found = done(SLOW)
    again = best_of(runs, [SLOW])
    pd.testing.assert_frame_equal(found.designs, again.designs)
    table, band = found.designs, found.interval.set_index("quantity")
    assert table["chosen"].sum() <= 1.0 + 1e-12
    assert band.loc["cost", "low"] <= table.loc[found.best, "cost"] <= band.loc["cost", "high"]
    cautious = table.loc[found.cautious]
    assert cautious["cost"] >= table.loc[found.best, "cost"]
    assert cautious[f"{SLOW.label}, high"] <= SLOW.target
    assert cautious["confidence"] >= 0.94


@pytest.mark.slow
def test_the_same_search_runs_the_same_designs_in_any_chunks(done):
    one = done(SLOW)[0]
    two = rf.search_design(STRUCTURE, SUITE, SEARCH, [SLOW], COST, "2DOF-S", SCALES, workers=1)
    pd.testing.assert_frame_equal(one, two)
    facts = one.groupby("structure", observed=True)[["half_width", "tendon_factor", "dissipator_factor"]].first()
    assert not facts.duplicated().any()
    assert one.groupby("round")["structure"].nunique().tolist()[0] == SEARCH.n_first == 36


@pytest.mark.slow
def test_refinements_beat_the_values_given(done):
    spaces = [
        rf.DesignSearch(SEARCH.half_widths, SEARCH.tendon_factors, SEARCH.dissipator_factors, refinements=refinements)
        for refinements in (0, 2)
    ]
    every = [*(best_of(search([SLOW], space), [SLOW]) for space in spaces), done(SLOW)[1]]
    costs = [found.designs.loc[found.best, "cost"] for found in every]
    assert SEARCH.refinements == 4
    assert costs[0] > costs[1] >= costs[2]


@pytest.mark.slow
def test_targets_that_cannot_be_met_are_approached(law):
    hard = [rf.Requirement(0.005, 0.001, at=0.7)]
    found = best_of(search(hard), hard)
    assert (found.best, found.cautious, found.governs) == (None, None, "")
    assert found.notes == ("No design meets all targets. Widen the ranges, or accept a higher probability.",)
    assert found.designs["half_width"].iloc[36:].mean() > found.designs["half_width"].iloc[:36].mean()
    assert found.interval["best"].isna().all()
    assert not len(found.limits)


@pytest.mark.slow
def test_a_best_design_at_the_end_of_a_range_is_told(law):
    easy = [rf.Requirement(0.5, 0.5, at=0.2)]
    found = best_of(search(easy), easy)
    best = found.designs.loc[found.best]
    assert best[["half_width", "tendon_factor", "dissipator_factor"]].tolist() == [1.0, 0.0, 0.0]
    assert found.notes == (
        "The best design has the smallest half width of its range, 1: a design beyond it might be cheaper.",
    )


# The designs


def designed(space, point, structure=STRUCTURE):
    return space.built(structure.rocking(), point)


def test_elements_keep_their_place_relative_to_the_edges():
    space = rf.DesignSearch([1.0, 3.0], refinements=0)
    for point, b in (((0, 0, 0), 1.0), ((1, 0, 0), 3.0)):
        made = designed(space, point)
        assert [each.position for each in made.elements] == pytest.approx([0.0, -b, b])
    off = rf.Eccentric(rf.Restrained(BARE, ()), 0.3).rocking()
    moved = rf.DesignSearch([2.0, 3.0], refinements=0)
    edges = [rf.Tendon(1e5, 1e6, position) for position in (off.half_width - 0.3, -off.half_width - 0.3, -0.3)]
    from dataclasses import replace

    made = moved.built(replace(off, elements=edges), (1, 0, 0))
    assert [each.position for each in made.elements] == pytest.approx([2.7, -3.3, -0.3])


def test_factors_multiply_size_or_force():
    tendon, dissipator, _ = ELEMENTS
    size = designed(rf.DesignSearch([B], [2.0], [0.5, 1.0], refinements=0), (0, 0, 0)).elements
    assert (size[0].initial_force, size[0].stiffness, size[0].yield_force) == pytest.approx(
        (2.0 * tendon.initial_force, 2.0 * tendon.stiffness, 2.0 * tendon.yield_force)
    )
    assert (size[1].stiffness, size[1].yield_force) == pytest.approx(
        (0.5 * dissipator.stiffness, 0.5 * dissipator.yield_force)
    )
    space = rf.DesignSearch([B], [2.0], [0.5, 1.0], "force", "force", refinements=0)
    force = designed(space, (0, 0, 0)).elements
    assert (force[0].initial_force, force[0].stiffness, force[0].yield_force) == pytest.approx(
        (2.0 * tendon.initial_force, tendon.stiffness, tendon.yield_force)
    )
    assert (force[1].stiffness, force[1].yield_force) == pytest.approx(
        (dissipator.stiffness, 0.5 * dissipator.yield_force)
    )
    none = designed(rf.DesignSearch([B], [0.0, 1.0], [0.0, 1.0], refinements=0), (0, 0, 0))
    assert none.elements == ()
    slack = designed(rf.DesignSearch([B], [0.0, 1.0], [0.0, 1.0], "force", refinements=0), (0, 0, 0))
    assert [each.initial_force for each in slack.elements] == [0.0]


def test_other_elements_stay_and_friction_is_scaled():
    given = [rf.ViscousDamper(1e4, B), rf.ViscousDamper(1e4, -B), rf.FrictionDamper(2e4)]
    space = rf.DesignSearch([B, 2.0 * B], dissipator_factors=[1.0, 3.0], refinements=0)
    made = designed(space, (1, 0, 1), rf.Restrained(BARE, given))
    assert made.elements[:2] == (rf.ViscousDamper(1e4, 2.0 * B), rf.ViscousDamper(1e4, -2.0 * B))
    assert made.elements[2].force == pytest.approx(6e4)


def test_a_design_is_the_structure_built_that_way():
    space = rf.DesignSearch([1.0, 2.0], [1.0, 2.0], [1.0, 2.0], base_mass_per_width=1e3, refinements=0)
    made = designed(space, (1, 1, 1))
    frame = rf.Frame(**{**vars_of(2.0), "base_mass": 50e3 + 2e3 * (2.0 - B)})
    twice = [
        rf.Tendon(0.4 * WEIGHT, 4e6, 0.0, 1.6 * WEIGHT, 0.02),
        *(rf.YieldingDissipator(100.0 * WEIGHT, 0.1 * WEIGHT, 0.02, x) for x in (-2.0, 2.0)),
    ]
    other = rf.Restrained(frame, twice).rocking()
    for name in ("i_theta", "m_tot", "l0r", "resisting_moment", "half_width", "prestress"):
        assert getattr(made, name) == pytest.approx(getattr(other, name), rel=1e-12)


def vars_of(half_width):
    from design_search_case import FRAME

    return FRAME | {"aspect_ratio": PROPERTIES.effective_height[0] / half_width}


# The surface


def test_a_surface_passes_through_linear_margins_and_smooths_noise():
    random = np.random.default_rng(5)
    steps = random.uniform(0.0, 3.0, (60, 3))
    plane = steps @ [[1.0, 0.2], [-2.0, 0.0], [0.5, 0.3]] + [0.1, -0.4]
    new = random.uniform(0.0, 3.0, (50, 3))
    expected = new @ [[1.0, 0.2], [-2.0, 0.0], [0.5, 0.3]] + [0.1, -0.4]
    np.testing.assert_allclose(MarginSurface(steps, plane).margins(new), expected, atol=1e-6)
    noisy = MarginSurface(steps, plane + 0.2 * random.standard_normal(plane.shape)).margins(new)
    assert np.sqrt(np.mean((noisy - expected) ** 2)) < 0.12
    missing = plane.copy()
    missing[5, 1] = np.nan
    np.testing.assert_allclose(MarginSurface(steps, missing).margins(new), expected, atol=1e-6)


# Wrong arguments


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rf.DesignCost(), "cost: all unit costs are zero, so that no design is cheaper than another."),
        (lambda: rf.DesignCost(-1.0), "half_width must be a zero or positive, finite number in cost/m, but -1.0"),
        (lambda: rf.DesignSearch([1.0]), "There is only one design to look at. Give two values or more of half_widths"),
        (lambda: rf.DesignSearch([1.0, 2.0], [-1.0]), "tendon_factors must be one or more different factors, zero or"),
        (
            lambda: rf.DesignSearch([1.0, 2.0], {"smallest": 1.0, "largest": 0.5, "count": 3}),
            "tendon_factors must be a list of factors, or a range {smallest = 0.5, largest = 2.0, count = 4} of two to",
        ),
        (lambda: rf.DesignSearch([1.0, 2.0], tendon_scaling="area"), 'tendon_scaling must be "size" or "force", but'),
        (lambda: rf.DesignSearch([1.0, 2.0], range(1, 30), range(1, 30)), "The search would try 1714 designs, but at"),
        (
            lambda: rf.DesignSearch(range(1, 10), range(9), range(9), refinements=8),
            "The finest grid would have 8602523649 designs",
        ),
        (lambda: rf.DesignSearch([1.0, 2.0], refinements=9), "refinements must be a whole number from 0 to 8, but 9"),
        (lambda: rf.Requirement("half", 0.1, at=0.5), "limit must be a rotation from 0.0001 rad to below π/2"),
        (lambda: rf.Requirement("max_base_moment > x", 0.1, at=0.5), "limit: the bound of max_base_moment must be"),
        (lambda: rf.Requirement(0.02, 1.5, at=0.5), "target must lie in [0, 1), but 1.5 was given."),
        (lambda: rf.Requirement(0.02, 0.1), "Give either at, a level of the measure, or hazard, a HazardCurve in it."),
        (lambda: search([]), "requirements must be one or more Requirement objects, each with another limit or level"),
        (lambda: search([SLOW, SLOW]), "requirements must be one or more Requirement objects, each with another limit"),
        (lambda: search([0.02]), "requirements[0] is float. Expected a Requirement."),
        (lambda: search(structure=BARE), "tendon_factors were given, but the structure has no tendon that they could"),
        (lambda: search(structure=rf.Restrained(BARE, ELEMENTS[0])), "dissipator_factors were given, but the"),
        (lambda: rf.search_design(STRUCTURE, SUITE, SEARCH, [SLOW], COST, "fixed"), "models: fixed has a fixed base,"),
        (
            lambda: search(space=rf.DesignSearch([1.0, 2.0], [1.0, 5.0], tendon_scaling="force")),
            "B = 1 m, tendons times 5, dissipators times 1: initial_force must not exceed yield_force,",
        ),
        (lambda: search([rf.Requirement("2.5 nominal", 0.1, at=0.5)], rf.DesignSearch([1.0, 9.0])), "B = 9 m: limit "),
        (lambda: rf.best_design(pd.DataFrame({"a": [1]}), [SLOW], COST), "The table lacks half_width, tendon_factor,"),
    ],
)
def test_damaged_arguments_of_a_search(call, message):
    with pytest.raises(rf.InputError) as caught:
        call()
    assert str(caught.value).startswith(message)


def test_the_plan_tells_its_runs_before(law):
    from rockflex.studies._arguments import rocking_properties_of
    from rockflex.studies._run_matrix import study_matrix
    from rockflex.studies.design._design_search import DesignSearchPlan

    matrix = study_matrix([rocking_properties_of(STRUCTURE)], SUITE, "2DOF-S", {"free_vibration": "settle"})
    plan = DesignSearchPlan(matrix, SEARCH, [SLOW], COST, SCALES, 200)
    assert plan.n_runs == (36 + 4 * 8) * 90
    assert not plan.exact_count
    assert [len(numbers) for numbers in plan.rounds] == [18, 4, 4, 4, 4]
    assert [*plan.units_of(17)] == [34, 35]
    assert [*plan.units_of(18)] == [36, 37]
    assert pickle.loads(pickle.dumps(plan)).chunk(3).equals(plan.chunk(3))
    assert plan.chunk(20).num_rows == 0  # not known before the first round
    assert math.prod(plan.chunk(0).shape) > 0


SEARCHED = {
    "structures": [
        {"name": "A", "frame": FRAME, "elements": [{"kind": "tendon", "initial_force": 3e5, "stiffness": 2e6}]}
    ],
    "records": {"suites": ["fema-p695-far-field"], "include": ["FF-?-*"]},
    "models": ["2DOF-S"],
    "half_widths": [0.8, 1.6, 2.4],
    "scales": [0.7, 1.4, 2.8],
    "limits": [0.02, "overturning"],
    "level": [0.4, 0.8],
    "target": [0.2, 0.05],
    "search": {
        "tendon_factors": {"smallest": 0.0, "largest": 2.0, "count": 2},
        "refinements": 2,
        "designs_per_refinement": 3,
        "cost": {"half_width": 1.0, "prestress": 1e-6},
    },
    "runs_per_chunk": 54,
}


@pytest.fixture(scope="module")
def study():
    return DesignStudy(**SEARCHED)


@pytest.fixture(scope="module")
def folder(study, tmp_path_factory):
    path = tmp_path_factory.mktemp("search") / "kept"
    return path, rf.run_study(study, path)


@pytest.fixture(scope="module")
def found(study, folder):
    return rf.best_design(folder[1], study.question.requirements, study.question.cost, n_resamples=40)


def parts(path):
    return {each.name: each.read_bytes() for each in (path / "parts").iterdir()}


@pytest.mark.slow
def test_the_study_is_the_call_in_python(study, folder):
    _, table = folder
    held = rf.Restrained(rf.Frame(**FRAME), rf.Tendon(3e5, 2e6))
    motions = [motion for motion in rf.load_suite("fema-p695-far-field") if len(motion.name) == len("FF-1-a")]
    space = rf.DesignSearch([0.8, 1.6, 2.4], [0.0, 2.0], refinements=2, designs_per_refinement=3)
    wanted = [rf.Requirement(0.02, 0.2, at=0.4), rf.Requirement("overturning", 0.05, at=0.8)]
    cost = rf.DesignCost(1.0, 1e-6)
    pd.testing.assert_frame_equal(
        table, rf.search_design(held, motions, space, wanted, cost, "2DOF-S", [0.7, 1.4, 2.8])
    )
    assert (study.question.requirements, study.question.cost) == (wanted, cost)
    assert table["error"].isna().all()
    assert set(table["round"]) == {0, 1, 2}


def test_rows_are_those_of_structures_built_that_way(folder):
    _, table = folder
    designs = table.groupby("structure", observed=True)
    motions = [motion for motion in rf.load_suite("fema-p695-far-field") if len(motion.name) == len("FF-1-a")]
    height = rf.Frame(**FRAME).rocking().effective_height[0]
    for name in ("design 6", "design 8", str(table["structure"].iloc[-1])):
        rows = designs.get_group(name)
        b, factor = rows["half_width"].iloc[0], rows["tendon_factor"].iloc[0]
        frame = rf.Frame(**FRAME | {"aspect_ratio": height / b})
        held = rf.Restrained(frame, rf.Tendon(3e5 * factor, 2e6 * factor))
        cloud = rf.run_cloud(held, motions, "2DOF-S", [0.7, 1.4, 2.8], free_vibration="settle")
        np.testing.assert_allclose(rows["max_rotation"], cloud["max_rotation"], rtol=1e-7)
        np.testing.assert_allclose(rows["resisting_moment"], held.rocking().resisting_moment, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("stop", [1, 4, 6])
def test_a_search_that_is_killed_is_resumed_to_the_same_bytes(study, folder, tmp_path, stop):
    whole, table = folder

    def kill(progress):
        if progress.done == stop:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rf.run_study(study, tmp_path / "kept", progress=kill)
    assert len(parts(tmp_path / "kept")) in (stop, stop + 1)
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), table)
    assert parts(tmp_path / "kept") == parts(whole)


@pytest.mark.slow
def test_a_part_that_is_lost_is_computed_anew(study, folder, tmp_path, monkeypatch):
    whole, table = folder
    rf.run_study(study, tmp_path / "kept")
    n_chunks = study.plan().n_chunks
    for number in (0, n_chunks - 1):
        (tmp_path / "kept" / "parts" / f"part-{number:05d}.parquet").unlink()
    computed = []
    real = ChunkedPlan.chunk
    monkeypatch.setattr(ChunkedPlan, "chunk", lambda plan, number: computed.append(number) or real(plan, number))
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), table)
    assert computed == [0, n_chunks - 1]
    assert parts(tmp_path / "kept") == parts(whole)


@pytest.mark.slow
@pytest.mark.parametrize(
    "damage", [lambda content: content[:-9], lambda _: b"", lambda content: content[:99] + b"!" * 9]
)
def test_every_damaged_part_is_computed_anew(study, folder, tmp_path, damage):
    whole, table = folder
    shutil.copytree(whole, tmp_path / "kept")
    names = sorted(parts(whole))
    for name in names:
        path = tmp_path / "kept" / "parts" / name
        path.write_bytes(damage(path.read_bytes()))
        pd.testing.assert_frame_equal(rf.run_study(study, tmp_path / "kept"), table)
        assert parts(tmp_path / "kept") == parts(whole)


def test_designs_without_a_search_are_the_same_documents_as_before():
    text = json.dumps(DesignStudy(**CONTENT).document(), sort_keys=True)
    assert "search" not in text
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == "32bb1743b0526d99"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"target": None}, "target is missing: a search needs the probability or annual rate that must not be"),
        ({"target": [0.1]}, "target must be one number, or one for each of the 2 limits, but [0.1] was given."),
        ({"level": [0.4, 0.5, 0.6]}, "level must be one number, or one for each of the 2 limits, but [0.4, 0.5, 0.6]"),
        ({"level": [0.4, -0.5]}, "level must be a positive, finite number in the unit of the measure, but -0.5 was"),
        ({"limits": [0.02, 0.02], "level": 0.4}, "requirements must be one or more Requirement objects, each with"),
        ({"tendons": [{}]}, "A search varies the elements of the structure itself by factors. Leave out the levels"),
        ({"half_widths": [1.0], "search": {"cost": {"half_width": 1.0}}}, "There is only one design to look at."),
        ({"search": {}}, "[search] cost is missing: a table of half_width, prestress and dissipator_force"),
        ({"search": {"cost": {}}}, "cost: all unit costs are zero"),
        ({"search": {"cost": {"width": 1.0}}}, "[search.cost] width is not known; there are half_width, prestress,"),
        ({"search": SEARCHED["search"] | {"tendon_factors": {"smallest": 1.0}}}, "tendon_factors must be a list of"),
        ({"search": SEARCHED["search"] | {"tendon_factors": "all"}}, "[search] tendon_factors must be a list of"),
        ({"search": SEARCHED["search"] | {"tendon_scaling": "area"}}, '[search] tendon_scaling must be "size" (force'),
    ],
)
def test_a_search_that_is_wrong(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**SEARCHED | changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ["2DOF-S", "MDOF-S"]}, "models: a search needs one model, but 2DOF-S, MDOF-S were given."),
        ({"search": SEARCHED["search"] | {"dissipator_factors": [0.0, 1.0]}}, "dissipator_factors were given, but the"),
    ],
)
def test_a_search_that_cannot_be_planned(changes, message):
    with pytest.raises(rf.InputError) as caught:
        DesignStudy(**SEARCHED | changes).plan()
    assert str(caught.value).startswith(message)


# The command line

FILE = """
study = "design"
models = ["2DOF-S"]
half_widths = [0.8, 1.6, 2.4]
scales = [0.7, 1.4, 2.8]
limits = [0.02, "overturning", "max_base_moment > 4e6"]
{level}
[records]
suites = ["fema-p695-far-field"]
include = ["FF-?-*"]
{hazard}
[[structures]]
elements = [{{kind = "tendon", initial_force = 3e5, stiffness = 2e6}}]
frame = {{n_stories = 3, story_height = 3.0, story_mass = 40e3, base_mass = 50e3, stiffness_ratio = inf, period = 0.6, \
aspect_ratio = 8, damping_ratio = 0.02}}
[search]
tendon_factors = [0.0, 2.0]
refinements = 1
designs_per_refinement = 2
cost = {{half_width = 1.0, prestress = 1e-6}}
"""
HAZARD = "[hazard]\nim = [0.05, 0.2, 0.8]\nrate = [0.1, 1e-2, 2e-4]"


def invoke(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "300"})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("level", "hazard"), [("level = 0.4\ntarget = [0.3, 0.1, 0.9]", ""), ("target = [1e-2, 1e-3, 0.1]", HAZARD)]
)
def test_a_search_is_run_kept_told_and_drawn(tmp_path, level, hazard):
    file, kept = tmp_path / "search.toml", tmp_path / "kept"
    file.write_text(FILE.format(level=level, hazard=hazard), "utf-8")
    assert "at most 432 runs in 3 parts, 18 records" in invoke("design", file, "--dry-run").stdout
    done = invoke("design", file, "--out", kept)
    assert done.exit_code == 0, done.stderr
    document = json.loads(invoke("design", file, "--out", kept, "--json").stdout)
    study = rf.load_study(file)
    found = rf.best_design(rf.StudyFolder.load(kept).frame(), study.question.requirements, study.question.cost)
    (designs,) = (rows for title, rows in document.items() if title.startswith("Designs of the search"))
    assert [row["cost"] for row in designs] == found.designs["cost"].tolist()
    (limits,) = (rows for title, rows in document.items() if title.startswith("Limits of the cheapest design"))
    assert [row["limit"] for row in limits if row["governs"] == "yes"] == [found.governs]
    assert [row["value"] for row in limits] == found.limits["value"].tolist()
    assert f"governed by {found.governs}" in done.stdout
    assert document["Cheapest designs"][0]["B [m]"] == found.designs.loc[found.best, "half_width"]
    figures = invoke("figures", kept)
    assert figures.exit_code == 0, figures.stderr
    names = sorted(path.name for path in (kept / "figures").iterdir())
    assert names == ["design_search.png", "summary.json"]


# The figure


def test_a_search_is_drawn(found):
    figure = drawn(rf.plot_design_search(found))
    costs, plane = figure.axes
    assert (costs.get_xlabel(), costs.get_ylabel()) == ("half width $B$ [m]", "cost")
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("half width $B$ [m]", "prestress $ΣF_0$ [kN]")
    curve = rf.trade_off(found)
    drawn_costs = np.concatenate(
        [line.get_ydata() for line in costs.lines if line.get_label() in set(curve["governs"])]
    )
    np.testing.assert_allclose(np.sort(drawn_costs[np.isfinite(drawn_costs)]), np.sort(curve["cost"]))
    best = found.designs.loc[found.best]
    ((ring,), (other,)) = ([line for line in axes.lines if line.get_label() == "_best"] for axes in figure.axes)
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (best["half_width"], best["cost"])
    assert other.get_ydata()[0] == pytest.approx(best["prestress"] / 1e3)
    shown = sum(len(line.get_xdata()) for line in costs.lines if line.get_label() == "_runs")
    assert shown == len(found.designs)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.texts][:2] == [each.label for each in found.requirements]
    assert f"{found.governs} governs" in legend.get_title().get_text()


@pytest.mark.slow
def test_a_search_that_found_nothing_is_drawn(folder):
    hard = [rf.Requirement(0.001, 1e-3, at=1.0)]
    nothing = rf.best_design(folder[1], hard, rf.DesignCost(1.0), n_resamples=20)
    figure = drawn(rf.plot_design_search(nothing))
    assert figure.legends[0].get_title().get_text() == "No design meets all targets"
    assert math.isnan(nothing.interval["best"].iloc[0])
