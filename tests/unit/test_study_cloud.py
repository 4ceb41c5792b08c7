"""Cloud analysis: its specification, plan and table."""

import dataclasses
import math
import pickle
import threading

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

import rockflex as rf
from builders import frame_values, make_frame
from rockflex.studies._result_tables import PivotLifts, count_pivot_lifts
from rockflex.studies._run_matrix import record_checksums, record_groups
from rockflex.studies._run_plan import run_plan
from rockflex.studies._study_kind import KINDS
from rockflex.studies.cloud import CloudStudy, run_cloud

FRAME = frame_values(n_stories=3, period=0.6, aspect_ratio=8.0)
STRUCTURES = [{"name": "stiff", "frame": FRAME}, {"frame": {**FRAME, "period": 1.0, "stiffness_ratio": 0.0}}]
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-3-a"]}
SUITE = rf.load_suite("fema-p695-far-field")


def study(**changes):
    content = {
        "structures": STRUCTURES,
        "records": RECORDS,
        "models": ["MDOF-S", "2DOF-S"],
        "scales": [1.0, 2.0],
        "runs_per_chunk": 5,
    }
    return CloudStudy(**content | changes)


@pytest.fixture(scope="module")
def plan():
    return study().plan()


@pytest.fixture(scope="module")
def table(plan):
    return run_plan(plan)


def test_rows_are_single_runs_in_order(table):
    frames = {"stiff": rf.Frame(**FRAME), "S2": rf.Frame(**STRUCTURES[1]["frame"])}
    expected = [
        (name, record, model, scale)
        for name in frames
        for record in ("FF-1-a", "FF-1-b", "FF-3-a")
        for model in ("MDOF-S", "2DOF-S")
        for scale in (1.0, 2.0)
    ]
    assert list(table[["structure", "motion", "model", "scale"]].itertuples(index=False, name=None)) == expected
    for row in table.itertuples():
        run = rf.simulate(frames[row.structure], SUITE[row.motion].scaled(row.scale), row.model, "peaks")
        assert row.status == run.status
        for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear", "n_impacts"):
            assert getattr(row, name) == getattr(run, name)
        assert row.time_of_max_rotation == run.time_of_max_rotation
        assert row.nominal_overturning == run.nominal_overturning == (row.max_rotation > row.nominal_limit)
    assert table["error"].isna().all()
    assert set(table["status"]) >= {"rocking", "overturned"}


def test_measures_are_those_of_the_scaled_motion(table):
    structures = {"stiff": rf.Frame(**FRAME).rocking(), "S2": rf.Frame(**STRUCTURES[1]["frame"]).rocking()}
    for row in table.itertuples():
        p, motion = structures[row.structure], SUITE[row.motion].scaled(row.scale)
        period = 2 * math.pi / p.omega[0]
        for name in ("pga", "pgv", "pgd", "arias", "cav"):
            assert getattr(row, name) == pytest.approx(getattr(motion, name), rel=1e-12)
        assert row.sa_t1 == pytest.approx(motion.sa(period, 0.02), rel=1e-12)
        assert (row.sa_t1_5, row.zeta_1) == pytest.approx((motion.sa(period, 0.05), 0.02), rel=1e-12)
        assert row.sd_t1 == pytest.approx(motion.sd(period, 0.02), rel=1e-12)
        tan_alpha = p.m_tot * p.half_width / p.l0r
        assert row.relative_pga == pytest.approx(motion.pga / (9.81 * tan_alpha), rel=1e-12)
        rate = math.sqrt(p.l0r * 9.81 / p.i_theta)
        assert row.relative_pgv == pytest.approx(rate * motion.pgv / (9.81 * tan_alpha), rel=1e-12)


def test_rigid_structure_lifts_at_a_relative_pga_of_one():
    block = rf.rigid_block(0.2, 1.5)
    motion = rf.one_sine_pulse(1.0, 1.0)
    table = run_cloud(block, motion, "rigid", scales=[0.1, 1.0, 3.0])
    lifting = table["pga"] / table["relative_pga"]
    below, above = (run_cloud(block, motion, "rigid", scales=f * lifting[0] / motion.pga) for f in (0.999, 1.001))
    assert (below["status"][0], above["status"][0]) == ("no_uplift", "rocking")
    assert table["sa_t1"].isna().all()


def test_facts_of_the_records(table):
    assert table["group"].tolist() == [f"RSN{SUITE[name].metadata.rsn}" for name in table["motion"]]
    assert table["group"].nunique() == 2
    assert (table["magnitude"] == [SUITE[name].metadata.magnitude for name in table["motion"]]).all()
    assert (table["distance_km"] == [SUITE[name].metadata.distance_km for name in table["motion"]]).all()


def test_group_of_a_record():
    motion = rf.GroundMotion([0, 1, 0], 0.01, "x")
    known = rf.RecordInfo(event="Quake", year=1990, station="A", rsn=7)
    infos = (None, rf.RecordInfo(event="Quake", station="A"), known, dataclasses.replace(known, rsn=None))
    motions = [dataclasses.replace(motion, metadata=info) for info in infos]
    assert record_groups(motions) == ["x", "Quake A", "RSN7", "Quake 1990 A"]


@pytest.mark.parametrize(
    "names",
    [
        ("ABC000", "ABC090", "DEF000"),
        ("RSN9_MUL009", "RSN9_MUL279", "RSN8_MUL009"),
        ("a_NS", "a_EW", "b_NS"),
        ("rec1H1", "rec1H2", "rec2H1"),
        ("a-x", "a-y", "b-x"),
        ("folder/a.E", "folder/a.N", "other/a.E"),
    ],
)
def test_components_known_by_their_names_alone_are_of_one_recording(names):
    first, second, third = record_groups(rf.GroundMotion([0, 1, 0], 0.01, name) for name in names)
    assert first == second != third


@pytest.mark.parametrize(
    "names",
    [
        [f"GM{number}" for number in range(1, 23)],
        [f"eq{number}" for number in range(1, 22)],
        [f"record_{number:03d}" for number in range(100)],
        ["GM1", "GM2"],
        ["pulse 0.5", "pulse 0.7"],
        ["ABC010", "ABC020", "ABC120"],
    ],
)
def test_records_that_are_merely_numbered_are_recordings_of_their_own(names):
    assert record_groups(rf.GroundMotion([0, 1, 0], 0.01, name) for name in names) == names


def test_chunks_depend_on_nothing_but_their_number(plan):
    assert (plan.n_runs, plan.n_chunks) == (24, 5)
    fresh = study().plan()
    backwards = [fresh.chunk(number) for number in reversed(range(5))][::-1]
    copied = pickle.loads(pickle.dumps(plan))
    assert not copied.matrix._cases
    for number, table in enumerate(backwards):
        assert plan.chunk(number).equals(table)
        assert copied.chunk(number).equals(table)
        assert table.schema.equals(backwards[0].schema)
    assert [len(table) for table in backwards] == [5, 5, 5, 5, 4]


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_size_of_the_chunks_changes_no_row(plan, size):
    other = study(runs_per_chunk=size).plan()
    one, two = (pa.concat_tables([p.chunk(n) for n in range(p.n_chunks)]) for p in (plan, other))
    assert one.equals(two)
    assert run_plan(plan, workers=1).equals(run_plan(other, workers=2))


def test_threads_share_a_study_of_one_chunk():
    meeting, threads = threading.Barrier(2), set()

    def met(_):
        if threading.get_ident() not in threads:  # alone, a thread would wait in vain
            threads.add(threading.get_ident())
            meeting.wait(60.0)
        return 1.0

    records = [rf.load_suite("fema-p695-far-field")[name] for name in ("FF-1-a", "FF-1-b", "FF-2-a", "FF-2-b")]
    given = {"structures": {"A": rf.Frame(**FRAME), "B": rf.Frame(**FRAME)}, "records": records, "models": ["2DOF-S"]}
    plan = rf.CloudStudy(**given, demands={"met": met}).plan()
    assert plan.n_chunks == 1
    shared = run_plan(plan, workers=2)
    assert shared.drop(columns="met").equals(run_plan(rf.CloudStudy(**given).plan(), workers=1))


def test_python_twin_gives_the_same_rows(table):
    structures = {"stiff": rf.Frame(**FRAME), "S2": rf.Frame(**STRUCTURES[1]["frame"])}
    motions = [SUITE[name] for name in ("FF-1-a", "FF-1-b", "FF-3-a")]
    assert run_cloud(structures, motions, ["MDOF-S", "2DOF-S"], [1.0, 2.0]).equals(table)
    assert run_cloud(list(structures.values()), motions)["structure"].unique().tolist() == ["S1", "S2"]


def test_runs_that_cannot_be_solved_are_rows():
    table = run_cloud(
        rf.Frame(**FRAME), [SUITE[0], rf.GroundMotion([0.0, 1.0, 0.0], 1e6, "absurd")], ["5DOF-S", "2DOF-S"]
    )
    assert table["status"].isna().tolist() == [True, False, True, True]
    assert table["error"][0].startswith("Model 5DOF-S needs 4 modes, but the structure has 3.")
    assert "time step" in table["error"][3]
    assert (
        table["max_rotation"].isna().tolist() == table["n_impacts"].isna().tolist() == table["status"].isna().tolist()
    )
    assert table["pga"].notna().all()
    assert table["n_impacts"].dtype == "Int64"
    assert table["nominal_overturning"].dtype == "boolean"


def test_friction():
    motion = SUITE["FF-3-a"]
    table = run_cloud(rf.Frame(**FRAME), motion, ["MDOF-S", "2DOF-C"], friction=True)
    for row in table.itertuples():
        run = rf.simulate(rf.Frame(**FRAME), motion, row.model)
        assert row.required_friction == pytest.approx(run.required_friction, rel=1e-9)
        assert row.max_rotation == pytest.approx(run.max_rotation, rel=1e-12)
    assert "required_friction" not in run_cloud(rf.Frame(**FRAME), motion)


def test_options_reach_the_runs():
    motion, frame = SUITE["FF-3-a"], rf.Frame(**FRAME)
    plan = study(
        models=["2DOF-S"],
        impact="restitution",
        restitution=0.5,
        bouc_wen={"yield_displacement": 0.01, "exponent": 4},
        free_vibration=2.0,
        scales=[1.0],
        records={"suites": ["fema-p695-far-field"], "include": ["FF-3-a"]},
    ).plan()
    options = {"impact": rf.Restitution(0.5), "bouc_wen": rf.BoucWen(0.01, exponent=4.0), "free_vibration": 2.0}
    run = rf.simulate(frame, motion, "2DOF-S", "peaks", **options)
    for table in (run_plan(plan), run_cloud(frame, motion, "2DOF-S", **options)):
        for name in ("max_rotation", "max_top_displacement", "max_base_shear"):
            assert table[name][0] == getattr(run, name)
    assert run.end_time == pytest.approx(motion.duration + 2.0)
    complete = study(models=["2DOF-S"], impact="complete", structures=STRUCTURES[:1]).plan()
    run = rf.simulate(frame, SUITE["FF-1-a"], "2DOF-S", "peaks", impact=rf.VVELComplete())
    assert run_plan(complete)["max_rotation"][0] == run.max_rotation


def test_mirrored_motion():
    table = run_cloud(rf.Frame(**FRAME), SUITE[0], scales=[1.0, -1.0])
    names = [
        "pga",
        "pgv",
        "pgd",
        "arias",
        "cav",
        "sd_t1",
        "sa_t1",
        "sa_t1_5",
        "relative_pga",
        "relative_pgv",
        "max_rotation",
    ]
    assert table.loc[0, names].tolist() == pytest.approx(table.loc[1, names].tolist(), rel=1e-9)
    assert (table[names] > 0).all(axis=None)


def test_what_is_not_a_number_is_missing():
    study = CloudStudy(structures=rf.rigid_block(0.2, 1.5), records=SUITE[0], models="rigid")
    table = study.plan().chunk(0)
    assert (table["sa_t1"].null_count, table["pga"].null_count) == (1, 0)
    assert table["pva"].null_count == 1


def test_the_peak_of_a_vertical_component_is_a_measure():
    both = SUITE[0].with_vertical(SUITE[0].acceleration[::-1])
    study = CloudStudy(structures=rf.rigid_block(0.2, 1.5), records=both, models="rigid", scales=[-2.0])
    table = study.plan().chunk(0)
    assert table["pva"].to_pylist() == [2.0 * both.pva]


def test_checksums_follow_the_samples():
    motions = [rf.GroundMotion([0.0, 1.0, 0.0], 0.01, "a"), rf.GroundMotion([0.0, 1.0, 0.0], 0.02, "b")]
    motions += [rf.GroundMotion([0.0, 1.0, 5e-324], 0.01, "c"), rf.GroundMotion([0.0, 1.0, 0.0], 0.01, "d")]
    sums = record_checksums(motions)
    motions += [motions[0].with_vertical(np.array([0.0, up, 0.0])) for up in (1.0, 2.0)]
    motions[4:] = [dataclasses.replace(motion, name=name) for motion, name in zip(motions[4:], "ef", strict=True)]
    sums = record_checksums(motions)
    assert sums["a"] == sums["d"]
    assert len(set(sums.values())) == 5
    assert set(study().plan().checksums) == {"FF-1-a", "FF-1-b", "FF-3-a"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"motions": [SUITE[0], SUITE[0]]}, "The motions of a suite need different names, but 'FF-1-a' occurs"),
        ({"models": ["2DOF-S", "2DOF-S"]}, "models: '2DOF-S' occurs more than once. Give each once."),
        ({"scales": []}, "scales must be one or more finite factors, but [] was given."),
        ({"scales": math.inf}, "scales must be one or more finite factors, but inf was given."),
        ({"bouc_wen": rf.BoucWen(0.01), "free_vibration": "settle"}, 'free_vibration="settle" cannot tell when a'),
    ],
)
def test_damaged_arguments(arguments, message):
    given = {"structures": rf.Frame(**FRAME), "motions": SUITE[0]} | arguments
    with pytest.raises(rf.InputError) as caught:
        run_cloud(**given)
    assert str(caught.value).startswith(message)


def test_chunk_that_is_not_there(plan):
    with pytest.raises(rf.InputError, match="number must be a whole number from 0 to 4, but 5 was given"):
        plan.chunk(5)


def test_every_number_of_a_response_is_a_column(table):
    """But for those that say something only of elements that yield, slide or damp, or of the ground."""
    run = rf.simulate(rf.Frame(**FRAME), SUITE[0], output="peaks").peaks()
    silent = {"tendon_yield", "tendon_overload", "residual_rotation"}
    silent |= {"max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement"}
    silent |= {"settlement", "max_permanent_settlement"}
    assert {name for name in run if name not in ("model", "motion")} - silent <= set(table.columns)
    assert not silent & set(table.columns)
    assert np.isfinite(table[["max_rotation", "max_base_moment"]].to_numpy()).all()


def test_on_springs_a_run_without_uplift_does_not_rock():
    """Elastic tilts of some mrad are not rocking: the outcomes are those of the springs at the edges."""
    wall = rf.Frame(**{**FRAME, "base_mass": 60e3})
    p = wall.rocking()
    bed = rf.winkler_bed(p.half_width, 4.0, 40e6, n=6).damped(0.3, p.m_tot)
    ground = rf.Ground(springs=bed, base_inertia=60e3 * (2.0 * p.half_width) ** 2 / 12.0)
    motions = {each.name: each for each in list(SUITE)[:6]}
    scales = [0.02, 0.1, 0.3]
    runs = run_cloud(wall, motions, "2DOF-S", scales, ground=ground)
    lifted = [
        rf.simulate(wall, motions[name].scaled(scale), "2DOF-S", ground=ground).uplifted.any()
        for name, scale in zip(runs["motion"].astype(str), runs["scale"], strict=True)
    ]
    assert (runs["status"] != "no_uplift").tolist() == lifted
    tilted = runs.loc[runs["status"] == "no_uplift", "max_rotation"]
    assert tilted.max() > 2e-4
    (fit,) = rf.fit_clouds(runs, "pgv")
    assert (fit.outcomes.n_no_rocking, fit.outcomes.n_rocking) == (len(tilted), sum(lifted))
    assert fit.outcomes.initiation.probability(runs["pgv"].min()) < 0.2
    figure = rf.plot_fragility(runs, "pgv", bins=3)
    marks = next(line for line in figure.axes[0].get_lines() if line.get_label() == "_observed")
    assert marks.get_ydata()[0] == 0.0
    figure = rf.plot_clouds(runs)
    (points,) = (line for line in figure.axes[0].get_lines() if line.get_label() == "_2DOF-S")
    assert points.get_xdata().size == sum(lifted)


RUNS = pd.DataFrame(
    {
        "structure": ["A", "A", "A", "A", "B", "B"],
        "model": ["MDOF-S"] * 6,
        "status": ["rocking", "rocking", "overturned", None, "no_uplift", "rocking"],
        "min_vertical_reaction": [-1.0, 1.0, -5.0, float("nan"), 2.0, 0.0],
    }
)


def test_only_runs_that_rock_and_stand_count() -> None:
    assert count_pivot_lifts(RUNS) == [PivotLifts("A", "MDOF-S", 2, 1, overturned=1), PivotLifts("B", "MDOF-S", 1, 0)]


def test_widths_of_a_design_are_counted_together_and_pairs_by_model() -> None:
    assert count_pivot_lifts(KINDS["design"].runs(RUNS.assign(tendon="none"))) == [
        PivotLifts("Designs, tendons: none", "MDOF-S", 3, 1, overturned=1)
    ]
    names = {"status": "status_mdof", "min_vertical_reaction": "min_vertical_reaction_mdof"}
    pairs = RUNS.rename(columns=names).drop(columns=["structure", "model"])
    pairs = pairs.assign(status_2dof="rocking", min_vertical_reaction_2dof=-1.0)
    lifts = count_pivot_lifts(KINDS["population"].runs(pairs))
    assert lifts == [PivotLifts("Population", "MDOF-S", 3, 1, overturned=1), PivotLifts("Population", "2DOF-S", 6, 6)]


def test_flexural_frames_would_lift_often_and_shear_frames_do_not() -> None:
    """Structures #4 and #3 of Table 1."""
    suite = rf.load_suite("fema-p695-far-field")
    share = {}
    for name, stiffness_ratio in (("flexure", 0.0), ("shear", float("inf"))):
        frame = make_frame(stiffness_ratio=stiffness_ratio, period=0.5)
        runs = rf.run_cloud(frame, list(suite)[::4], ["MDOF-S"], (2.0,))
        (found,) = count_pivot_lifts(runs)
        standing = runs[runs["status"] == "rocking"]
        assert found.lifting == (standing["min_vertical_reaction"] < 0.0).sum()
        share[name] = found.lifting / found.rocking
    assert share["flexure"] > 0.2 > share["shear"]


def test_runs_beyond_the_balance_rotation_are_counted_and_told() -> None:
    runs = RUNS.assign(
        balance_ratio=[1.2, 0.9, 5.0, float("nan"), 0.0, 3.0], max_rotation=[0.1, 0.1, 1.571, None, 0, 0.3]
    )
    assert [each.beyond for each in count_pivot_lifts(runs)] == [1, 1]
    assert "θ passes α" in str(count_pivot_lifts(runs)[1])
    assert "such as rigid-C" in str(count_pivot_lifts(runs.assign(model="rigid"))[1])
    complete = count_pivot_lifts(runs.assign(model="MDOF-C-SI"))
    assert [(each.beyond, each.overturned) for each in complete] == [(0, 0), (0, 0)]


def test_runs_in_which_a_joint_would_lift_off_are_counted_and_told() -> None:
    first, second = count_pivot_lifts(RUNS.assign(min_joint_force=[-1.0, 2.0, -1.0, None, 0.0, 0.0]))
    assert (first.joints, second.joints) == (1, 0)
    assert "joint above the base" in str(first)


def test_runs_that_overturn_by_a_simplified_model_or_may_still_fall_are_counted_and_told() -> None:
    first, second = count_pivot_lifts(RUNS.assign(may_fall=[True, False, True, None, False, False]))
    assert (first.falling, first.overturned, second.falling, second.overturned) == (1, 1, 0, 0)
    assert "may still fall" in str(first)
    assert "overturn by a model for small rotations" in str(first)
    assert not second.warnings
