"""Stored studies of objects: structures, motions, grounds, elements and demands in the place of tables."""

import json
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from own_study import FRAME, OwnBar, Tower, own_ground, random_frame, roof
from rockflex.studies._study_kind import KINDS
from rockflex.studies.design._design_study import DesignQuestion

SUITE = rf.load_suite("fema-p695-far-field")[:3]
YIELDS = rf.YieldingStories(rf.Leaning(rf.Frame(**FRAME), 20e3), strengths=[300e3, 250e3, 140e3], post_yield_ratio=0.05)
HELD = rf.Restrained(YIELDS, rf.YieldingDissipator(stiffness=1e7, yield_force=5e4, position=0.5))
COMMON = {"records": SUITE, "demands": {"roof": roof}, "runs_per_chunk": 2}
GIVEN = {
    rf.CloudStudy: {"structures": {"A": YIELDS, "B": HELD}},
    rf.IncrementalStudy: {"structures": [YIELDS], "smallest_scale": 0.5, "largest_scale": 2.0, "growth": 2.0,
                          "tolerance": 0.3},
    rf.StripeStudy: {"structures": HELD, "levels": [0.3]},
    rf.MonteCarloStudy: {"count": 3, "variables": {"strength": {"uniform": [0.5, 1.5]}}, "structure": random_frame},
    rf.DesignStudy: {"structures": [YIELDS], "half_widths": [1.2, 1.8], "tendons": [rf.TendonLevel(0.2)],
                     "level": 0.3, "limits": ["max_ductility > 3", "roof > 5"]},
}  # fmt: skip


def made(kind=rf.CloudStudy, **more):
    return kind(**GIVEN[kind] | COMMON | more)


every_kind = pytest.mark.parametrize("kind", GIVEN, ids=lambda kind: kind.__name__)


def interrupted(done, _total):
    if done:
        raise KeyboardInterrupt


@pytest.mark.slow
@pytest.mark.parametrize("searched", [False, True])
def test_a_function_of_designs_resumes_its_folder(searched, tmp_path):
    held, factors = rf.Restrained(rf.Frame(**FRAME), rf.Tendon(1e5, 1e6)), {"scales": [0.5, 1.0, 2.0, 4.0]}
    space = rf.DesignSearch([0.8, 1.6], [0.5, 1.0], refinements=1, designs_per_refinement=2)
    wanted = [rf.Requirement("overturning", 0.1, at=0.8), rf.Requirement(0.01, 0.2, at=0.4)]
    hazard = rf.HazardCurve([0.1, 1.0], [0.1, 0.001])

    def found(widths=(0.8, 1.2, 1.6), requirements=wanted, **more):
        if not searched:
            return rf.run_design(held, SUITE, np.array(widths), models=["2DOF-S", "MDOF-S"], **factors, **more)
        unit = rf.DesignCost(1.0, 1e-6)
        return rf.search_design(
            held, SUITE, replace(space, half_widths=widths), requirements, unit, "2DOF-S", **factors, **more
        )

    whole, folder = found(demands={"roof": roof}), tmp_path / "study"
    with pytest.raises(KeyboardInterrupt):
        found(demands={"roof": roof}, folder=folder, progress=interrupted, workers=1)
    kept = rf.StudyFolder.load(folder)
    assert 0 < len(kept.missing()) < kept.n_chunks
    told = []
    resumed = found(demands={"roof": roof}, folder=folder, progress=lambda *now: told.append(now))
    pd.testing.assert_frame_equal(resumed, whole)
    assert told[1][0] > 0
    assert kept.spec["study"] == "design"
    with pytest.raises(rf.InputError, match=r"another study[\s\S]*half_widths"):
        found((0.8, 1.7), demands={"roof": roof}, folder=folder)
    if searched:
        mixed = [wanted[0], rf.Requirement(0.01, 0.01, hazard=hazard)]
        with pytest.raises(rf.InputError, match="requirements: a folder stores those of one measure"):
            found(requirements=mixed, folder=tmp_path / "other")
        question = DesignQuestion.of_document(kept.spec)
        assert (question.requirements, question.cost) == (wanted, rf.DesignCost(1.0, 1e-6))
        rate = [rf.Requirement(0.01, 0.01, hazard=hazard)]
        pd.testing.assert_frame_equal(found(requirements=rate, folder=tmp_path / "rate"), found(requirements=rate))
    else:
        with pytest.raises(rf.InputError, match="no limits"):
            list(KINDS["design"].figures(kept.spec, whole, "pgv", print))


@pytest.mark.slow
@every_kind
def test_a_study_that_was_stopped_is_resumed(kind, tmp_path):
    whole, folder = rf.run_study(made(kind)), tmp_path / "study"
    assert whole["error"].isna().all()
    assert whole[["roof", "max_ductility"]].notna().all(axis=None)
    done = []

    def stop(progress):
        done.append(progress.done)
        if progress.done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rf.run_study(made(kind), folder, workers=1, progress=stop)
    kept = []
    pd.testing.assert_frame_equal(rf.run_study(made(kind), folder, progress=kept.append), whole)
    assert kept[0].kept == 1
    assert json.loads((folder / "spec.json").read_text())["study"] == made(kind).kind


@pytest.mark.slow
def test_rows_are_those_of_the_function_with_the_same_arguments():
    structures = {"A": YIELDS, "tower": Tower(0.5), "properties": HELD.rocking()}
    laws = {"impact": rf.Restitution(0.4), "ground": own_ground}
    models = [rf.Model(n_modes=1), "MDOF-S"]
    study = rf.CloudStudy(
        structures=structures, records={"x": SUITE[0], "y": SUITE[1]}, models=models, scales=[0.5, 1.0],
        demands={"roof": roof}, **laws,
    )  # fmt: skip
    motions = {"x": SUITE[0], "y": SUITE[1]}
    runs = rf.run_cloud(structures, motions, models, [0.5, 1.0], demands={"roof": roof}, **laws)
    pd.testing.assert_frame_equal(rf.run_study(study), runs)
    single = rf.CloudStudy(structures=YIELDS, records=SUITE[0], models="2DOF-S", ground=rf.Ground(friction=0.3))
    alone = rf.run_cloud(YIELDS, SUITE[0], "2DOF-S", ground=rf.Ground(friction=0.3))
    pd.testing.assert_frame_equal(rf.run_study(single), alone)


def test_bouc_wen_and_a_hazard_curve_may_be_objects():
    frame, hysteresis = rf.Frame(**FRAME), rf.BoucWen(yield_displacement=0.02)
    study = rf.CloudStudy(structures=frame, records=SUITE[0], models=["2DOF-S-BW"], bouc_wen=hysteresis)
    single = rf.simulate(frame, SUITE[0], "2DOF-S", bouc_wen=hysteresis, output="peaks")
    assert rf.run_study(study)["max_rotation"].tolist() == [single.max_rotation]
    hazard = rf.HazardCurve([0.1, 1.0], [0.1, 0.001])
    assert rf.DesignStudy(structures=frame, records=SUITE, half_widths=[1.0], hazard=hazard).document()["hazard"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("more", "differs"),
    [
        ({"structures": {"A": YIELDS}}, r"structures: 2 entries in the folder, 1 now"),
        ({"structures": {"A": YIELDS, "B": YIELDS}}, r"structures\[1\]\.given\.class"),
        ({"demands": {"other": roof}}, r"demands\.roof"),
        ({"records": SUITE[:2]}, r"records\.motions"),
        ({"ground": rf.Ground(friction=0.5)}, "ground: not in the folder"),
        ({"structures": [{"name": "A", "frame": FRAME}, {"name": "B", "frame": FRAME}]}, r"structures\[0\]"),
    ],
)
def test_a_folder_of_other_objects_is_refused(more, differs, tmp_path):
    rf.run_study(made(), tmp_path / "study")
    with pytest.raises(rf.InputError, match=rf"another study[\s\S]*{differs}"):
        rf.run_study(made(**more), tmp_path / "study")


def test_another_record_of_the_same_name_is_refused(tmp_path):
    rf.run_study(made(), tmp_path / "study")
    changed = [SUITE[0].scaled(2.0), *SUITE[1:]]
    changed[0] = rf.GroundMotion(changed[0].acceleration, SUITE[0].dt, name=SUITE[0].name)
    with pytest.raises(rf.InputError, match=rf"another record[\s\S]*{SUITE[0].name}"):
        rf.run_study(made(records=changed), tmp_path / "study")


def test_elements_and_functions_of_a_module_are_recorded_with_its_checksum(tmp_path):
    bar = OwnBar(stiffness=1e6, gap=1e-3)
    study = rf.CloudStudy(
        structures=rf.Restrained(rf.Frame(**FRAME), bar), records=SUITE[0], demands={"roof": roof}, ground=None
    )
    found = rf.fill_study(study, tmp_path / "study").manifest
    assert {"structures[0].element, own_study", "demand roof, own_study"} <= {*found.checksums}
    assert found.spec["structures"][0]["given"]["elements"][0]["class"] == "own_study.OwnBar"
    grounded = rf.CloudStudy(structures=rf.Frame(**FRAME), records=SUITE[0], ground=own_ground)
    assert grounded.document()["ground"] == "own_study.own_ground"
    assert "ground, own_study" in grounded.checksums()


def test_what_cannot_be_recorded_is_for_studies_without_a_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(roof, "__module__", "typed_at_the_prompt")
    study = made()
    assert rf.run_study(study)["roof"].notna().all()
    with pytest.raises(rf.InputError, match=r"function roof is not defined in a file.*Put it into a module"):
        rf.run_study(study, tmp_path / "study")

    @dataclass(frozen=True)
    class Typed(rf.GapBar):
        table: object = object()

    unknown = rf.CloudStudy(structures=rf.Restrained(rf.Frame(**FRAME), Typed(1e6, 1e-3)), records=SUITE[0])
    with pytest.raises(rf.InputError, match=r"structures.*table is of type object.*without a folder"):
        rf.run_study(unknown, tmp_path / "other")


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"structures": {"A": YIELDS, 3: YIELDS}}, "names of structures must be texts"),
        ({"structures": [YIELDS, 3]}, r"structures\[1\] is int"),
        ({"structures": 3}, "structures must be one or more tables"),
        ({"records": [SUITE[0], "FF-1-a"]}, r"motions\[1\] is str"),
        ({"records": []}, "records must be"),
        ({"demands": {"roof": 3}}, "demands must be functions"),
        ({"demands": {"level": roof}}, "has a column level already"),
        ({"demands": {"max_ductility": roof}}, "has a column max_ductility already"),
    ],
)
def test_what_is_no_object_of_a_study(more, message):
    with pytest.raises(rf.InputError, match=message):
        made(**more).plan()


def test_a_design_study_has_one_structure():
    with pytest.raises(rf.InputError, match="a design study has one structure, but 2"):
        made(rf.DesignStudy, structures=[YIELDS, HELD])


def test_a_random_structure_that_cannot_be_built_is_an_error_of_its_runs():
    study = made(rf.MonteCarloStudy, variables={"strength": {"one_of": [-1.0, 1.0]}}, count=8)
    runs = rf.run_study(study)
    lost = runs["strength"] < 0.0
    assert 0 < lost.sum() < len(runs)
    assert runs["error"].notna().tolist() == lost.tolist()
    row = runs[~lost].iloc[-1]
    response = rf.simulate(random_frame({"strength": 1.0}), SUITE[row["motion"]])
    assert row["max_ductility"] == pytest.approx(np.max(response.ductility), rel=1e-9)
    grounded = made(rf.MonteCarloStudy, ground=own_ground)
    assert grounded.ground_of(0) == own_ground(grounded.structure_of(0))


@pytest.mark.slow
def test_a_cluster_gives_the_same_rows(cluster):
    pd.testing.assert_frame_equal(rf.run_study(made(), dask=cluster.address), rf.run_study(made()))


CALLS = {
    "cloud": lambda **where: rf.run_cloud({"A": YIELDS, "B": HELD}, SUITE, demands={"roof": roof}, **where),
    "incremental": lambda **where: rf.run_incremental(
        YIELDS, SUITE, smallest_scale=0.5, largest_scale=2.0, growth=2.0, tolerance=0.3, demands={"roof": roof}, **where
    ),
    "population": lambda **where: rf.run_population(SUITE, pairs=3, seed=1, **where),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", CALLS)
def test_a_call_with_a_folder_stores_what_it_returns(kind, tmp_path):
    whole, told = CALLS[kind](), []
    pd.testing.assert_frame_equal(CALLS[kind](folder=tmp_path / "study"), whole)
    found = rf.StudyFolder.load(tmp_path / "study")
    assert found.finished
    assert found.manifest.spec["study"] == kind
    assert found.manifest.spec.get("demands") == (None if kind == "population" else {"roof": "own_study.roof"})
    again = CALLS[kind](folder=tmp_path / "study", progress=lambda done, total: told.append((done, total)))
    pd.testing.assert_frame_equal(again, whole)
    assert told[-1][0] == told[-1][1]
    assert len(told) == 2  # the start, and what was stored before


def test_a_stopped_call_is_resumed_also_as_a_study(tmp_path):
    many = [rf.one_sine_pulse(1.0 + 0.01 * place, 0.8) for place in range(100)]
    records = {f"P{place}": pulse for place, pulse in enumerate(many)}

    def stop(done, total):
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rf.run_cloud(YIELDS, records, folder=tmp_path, workers=1, progress=stop)
    assert len(rf.StudyFolder.load(tmp_path).missing()) == 1
    study = rf.CloudStudy(structures=YIELDS, records=records, runs_per_chunk=64)
    pd.testing.assert_frame_equal(rf.run_study(study, tmp_path), rf.run_cloud(YIELDS, records))
    with pytest.raises(rf.InputError, match=r"another study[\s\S]*scales"):
        rf.run_cloud(YIELDS, records, scales=2.0, folder=tmp_path)


@pytest.mark.slow
def test_calls_run_on_a_cluster(cluster, tmp_path):
    for call in CALLS.values():
        pd.testing.assert_frame_equal(call(dask=cluster.address), call(dask=cluster.address, folder=tmp_path / "a"))
        pd.testing.assert_frame_equal(call(dask=cluster.address), call())
        (tmp_path / "a").rename(tmp_path / f"stored-{len(list(tmp_path.iterdir()))}")
    widths = {"half_widths": [1.0, 1.5], "demands": {"roof": roof}}
    there = rf.run_design(YIELDS, SUITE, **widths, dask=cluster.address)
    pd.testing.assert_frame_equal(there, rf.run_design(YIELDS, SUITE, **widths))
    with pytest.raises(rf.InputError, match="workers is for this machine"):
        rf.run_design(YIELDS, SUITE, **widths, dask=cluster.address, workers=2)
