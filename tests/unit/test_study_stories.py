"""Stories that yield in studies: columns, limits, random strengths and leaning mass, the design search."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.fragility._limit_states import demand_limit_state

FRAME = {"n_stories": 3, "story_height": 3.0, "story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": math.inf}
FRAME |= {"period": 0.6, "aspect_ratio": 6.0, "damping_ratio": 0.03}
STORIES = {"strengths": [300e3, 250e3, 140e3], "post_yield_ratio": 0.05}
LEANING = 20e3
ENTRY = {"name": "yields", "frame": FRAME, "leaning_masses": LEANING, "stories": STORIES}
YIELDS = rf.YieldingStories(rf.Leaning(rf.Frame(**FRAME), LEANING), **STORIES)
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]}
SUITE = rf.Suite(each for each in rf.load_suite("fema-p695-far-field") if each.name.startswith(("FF-1-", "FF-2-")))
OF_STORIES = ["max_ductility", "max_residual_drift_ratio"]
BY_STORY = [f"{name}_{k}" for name in ("ductility", "residual_drift") for k in (1, 2, 3)]


def test_rows_have_the_demands_of_the_stories_of_each_response():
    structures = {"yields": YIELDS, "elastic": rf.Frame(**FRAME)}
    for runs in (
        rf.simulate_many(structures, SUITE, ["MDOF-S", "rigid"], scales=[1.0, 2.0]),
        rf.run_cloud(structures, SUITE, ["MDOF-S", "rigid"], scales=[1.0, 2.0]),
    ):
        assert {*OF_STORIES, *BY_STORY} <= {*runs.columns}
        with_stories = (runs["structure"] == "yields") & (runs["model"] == "MDOF-S")
        assert runs.loc[~with_stories, [*OF_STORIES, *BY_STORY]].isna().all(axis=None)
        for row in runs[with_stories].itertuples():
            response = rf.simulate(YIELDS, SUITE[row.motion].scaled(row.scale))
            # The drifts themselves, from the history; a story of 3 m.
            drift = np.abs(response.story_drift).max(axis=0)
            found = [row.ductility_1, row.ductility_2, row.ductility_3]
            assert found == pytest.approx(response.ductility, rel=1e-9)
            assert (np.array(found) * YIELDS.yield_drift >= drift * (1.0 - 1e-9)).all()
            assert row.max_ductility == max(found)
            left = np.array([row.residual_drift_1, row.residual_drift_2, row.residual_drift_3])
            assert row.max_residual_drift_ratio == pytest.approx(np.abs(left).max() / 3.0, rel=1e-12)


def test_there_are_no_such_columns_where_nothing_yields():
    elastic = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
    for runs in (rf.simulate_many(elastic, SUITE), rf.run_cloud(elastic, SUITE)):
        assert not any("ductility" in name or "drift" in name for name in runs.columns)


def test_ductility_has_a_line_and_limits_have_curves():
    runs = rf.run_cloud({"A": YIELDS}, SUITE, scales=[0.5, 1.0, 2.0])
    (fit,) = rf.fit_clouds(runs)
    stands = runs[runs["status"] == "rocking"]
    alone = rf.fit_cloud(stands["pgv"], stands["max_ductility"])
    assert fit.ductility.c2 == pytest.approx(alone.c2, rel=1e-12)
    panel = rf.plot_clouds(runs, "max_ductility").axes[0]
    np.testing.assert_array_equal(panel.lines[0].get_ydata(), stands["max_ductility"])
    (none,) = rf.fit_clouds(rf.run_cloud(rf.Frame(**FRAME), SUITE, scales=[1.0, 2.0]))
    assert none.ductility is None


def test_limits_of_a_study_are_reported_and_checked_before_any_run():
    limits = ["max_ductility > 4", "max_residual_drift_ratio > 0.002", 0.01]
    study = rf.CloudStudy(structures=[ENTRY], records=RECORDS, scales=[0.5, 1.0, 2.0], limits=limits)
    runs = rf.run_study(study)
    from rockflex.studies._study_kind import KINDS, StudyFindings

    found = StudyFindings()
    KINDS["cloud"].report(study, runs, found)
    (rows,) = (rows for title, rows in found.tables.items() if title.startswith("P(limit)"))
    beyond = (runs["max_ductility"] > 4.0) | (runs["status"] == "overturned")
    assert rows[0]["beyond"] == f"{beyond.sum()}/{len(runs)}"
    assert rows[0]["median"] == pytest.approx(rf.fit_logistic(runs["pgv"], beyond).median)
    elastic = [{"frame": FRAME}]
    for limit in ({"limits": limits}, {"limits": ["max_ductilty > 4"]}):
        with pytest.raises(rf.InputError, match="the study has no column max_duct"):
            rf.CloudStudy(structures=elastic, records=RECORDS, **limit).plan()
    with pytest.raises(rf.InputError, match="the study has no column max_ductility"):
        rf.run_incremental(rf.Frame(**FRAME), SUITE, limit="max_ductility > 4")
    for wrong in ("max_ductility > -1", "max_ductility > four", "ductile"):
        with pytest.raises(rf.InputError, match=r"bound of max_ductility must be|limit must be"):
            rf.StripeStudy(structures=[ENTRY], records=RECORDS, levels=[0.4], limits=[wrong])


def test_incremental_analyses_and_stripes_of_a_ductility():
    runs = rf.run_incremental(YIELDS, SUITE[:2], growth=1.5, tolerance=0.05, limit="max_ductility > 4")
    beyond = (runs["max_ductility"] > 4.0) | (runs["status"] == "overturned")
    assert runs["overturned"].tolist() == beyond.tolist()
    assert (rf.incremental_capacities(runs, "pga")["capacity"] > 0.0).all()
    turned = rf.run_incremental(YIELDS, SUITE[:1], smallest_scale=0.5, growth=2.0, tolerance=0.2, limit=0.01)
    assert turned["overturned"].tolist() == (turned["max_rotation"] > 0.01).tolist()
    stripes = rf.run_study(rf.StripeStudy(structures=[ENTRY], records=RECORDS, levels=[0.2, 0.6]))
    counts = rf.stripe_counts(stripes, "max_ductility > 4")
    assert counts["n_exceeding"].tolist() == [
        int(
            (each["max_ductility"] > 4.0).sum()
            + ((each["status"] == "overturned") & ~(each["max_ductility"] > 4.0)).sum()
        )
        for _, each in stripes.groupby("level")
    ]
    assert rf.stripe_counts(stripes, demand_limit_state("max_ductility", 4.0)).equals(counts)


def test_a_demand_counts_in_either_direction():
    runs = {"residual_drift_1": -0.02, "status": "rocking"}
    assert demand_limit_state("residual_drift_1", 0.01).exceeded(runs)
    assert not demand_limit_state("residual_drift_1", 0.03).exceeded(runs)
    assert demand_limit_state("residual_drift_1", 0.03).exceeded(runs | {"status": "overturned"})
    with pytest.raises(rf.InputError, match=r"no column max_ductility\. .*stories yield"):
        demand_limit_state("max_ductility", 4.0).exceeded(runs)


def random_frames(**more):
    structure = {
        "frame": FRAME,
        "leaning_masses": "= 20e3 * leaning",
        "stories": {"strengths": ["= s * 300e3", "= s * 250e3", "= s * 140e3"], "post_yield_ratio": "= ratio"},
    }
    variables = {"s": {"lognormal": [1.0, 0.3]}, "ratio": {"uniform": [0.0, 0.1]}, "leaning": {"uniform": [0.5, 1.5]}}
    content = {"count": 5, "seed": 3, "variables": variables, "structure": structure, "records": RECORDS}
    return rf.MonteCarloStudy(**content | more)


def test_strengths_hardening_and_leaning_mass_are_random_variables():
    study = random_frames(records_per_structure=1)
    runs = rf.run_study(study)
    assert runs["max_ductility"].notna().all()
    assert "ductility_1" not in runs  # the number of stories may be random, too
    for row in runs.itertuples():
        built = rf.YieldingStories(
            rf.Leaning(rf.Frame(**FRAME), 20e3 * row.leaning), row.s * np.array(STORIES["strengths"]), row.ratio
        )
        response = rf.simulate(built, SUITE[row.motion])
        assert row.max_ductility == pytest.approx(response.ductility.max(), rel=1e-9)
        assert study.structure_of(row.number).leaning_mass == pytest.approx(60e3 * row.leaning, rel=1e-12)


def test_strengths_may_be_shares_of_the_weight_that_stands_on_the_base():
    structure = {"frame": FRAME, "leaning_masses": LEANING, "stories": {"strengths": "= s * weight"}}
    study = random_frames(variables={"s": {"uniform": [0.2, 0.4]}}, structure=structure)
    runs = rf.run_study(study)
    properties = study.structure_of(2)
    share = runs.loc[runs["number"] == 2, "s"].iloc[0]
    assert [each.yield_force for each in properties.stories] == pytest.approx([share * 160e3 * 9.81] * 3, rel=1e-12)


def test_a_design_search_keeps_the_stories_and_says_what_it_varies():
    held = rf.Restrained(YIELDS, rf.Tendon(initial_force=200e3, stiffness=2e6))
    search = rf.DesignSearch([1.2, 1.8], tendon_factors=[0.5, 1.0], refinements=0)
    requirement = rf.Requirement("max_ductility > 4", 0.5, at=0.4)
    runs = rf.search_design(held, SUITE, search, [requirement], rf.DesignCost(half_width=1.0), scales=[1.0, 2.0])
    row = runs[runs["half_width"] == 1.8].iloc[-1]
    moved = rf.Restrained(YIELDS, rf.Tendon(initial_force=200e3, stiffness=2e6)).rocking().with_half_width(1.8)
    response = rf.simulate(moved, SUITE[row["motion"]].scaled(row["scale"]), free_vibration="settle")
    assert row["max_ductility"] == pytest.approx(response.ductility.max(), rel=1e-9)
    assert rf.best_design(runs, [requirement], rf.DesignCost(half_width=1.0)).designs[requirement.label].notna().any()
    with pytest.raises(rf.InputError, match=r"no fuse.*strengths of stories.*MonteCarloStudy"):
        rf.search_design(
            held, SUITE, rf.DesignSearch([1.2], dissipator_factors=[0.5, 1.0]), [requirement],
            rf.DesignCost(half_width=1.0),
        )  # fmt: skip
    widths = rf.run_design(YIELDS, SUITE[:1], [1.2, 1.8])
    assert widths["max_ductility"].notna().all()
