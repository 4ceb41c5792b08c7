"""`simulate_many` and `run_cloud`, with its like, take the same subjects and name their columns alike."""

import re

import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.study._results import OF_ELEMENTS, OF_GROUND

RECORD = rf.load_suite("el-centro-1940")[0].acceleration[100:400]
FRAMES = {
    "slender": make_frame(n_stories=2, period=0.5, aspect_ratio=9.0),
    "stocky": make_frame(n_stories=2, stiffness_ratio=0.0, period=0.4, aspect_ratio=6.0),
}
MOTIONS = {"weak": rf.GroundMotion(1.2 * RECORD, 0.02, "a"), "strong": rf.GroundMotion(2.0 * RECORD, 0.02, "b")}
SUITE = rf.Suite(MOTIONS.values())
MODELS = ["2DOF-S", "fixed"]
KEYS = ["structure", "motion", "model", "scale"]


def rows(table):
    """What both tables hold, in one form of column."""
    kept = table[[*KEYS, "status", "error", "max_rotation", "max_base_moment", "n_impacts"]]
    return kept.astype(dict.fromkeys(("structure", "motion", "model", "status", "error"), "string"))


@pytest.mark.parametrize(
    ("structures", "motions"),
    [
        (FRAMES, MOTIONS),
        (FRAMES, SUITE),
        ({name: frame.rocking() for name, frame in FRAMES.items()}, list(SUITE)),
        ({"only": FRAMES["slender"]}, SUITE[1]),
        (FRAMES, iter(SUITE)),
    ],
)
def test_one_table_whoever_makes_it(structures, motions):
    motions = list(motions) if hasattr(motions, "__next__") else motions
    many = rf.simulate_many(structures, motions, MODELS, scales=(1.0, 1.5))
    cloud = rf.run_cloud(structures, motions, MODELS, scales=(1.0, 1.5))
    pd.testing.assert_frame_equal(rows(many), rows(cloud))
    assert set(many.columns) - {*OF_ELEMENTS, *OF_GROUND} <= set(cloud.columns)
    assert (many["status"] == "rocking").any()


def test_structures_without_names_are_numbered():
    many, cloud = (run(list(FRAMES.values()), SUITE, "2DOF-S") for run in (rf.simulate_many, rf.run_cloud))
    assert many["structure"].tolist() == [0, 0, 1, 1]
    assert cloud["structure"].tolist() == ["S1", "S1", "S2", "S2"]


def test_one_of_each():
    many, cloud = (run(FRAMES["slender"], SUITE[0], rf.Model(1)) for run in (rf.simulate_many, rf.run_cloud))
    assert many["max_rotation"].tolist() == cloud["max_rotation"].tolist()


def test_a_mapping_names_the_motions():
    for run in (rf.simulate_many, rf.run_cloud, rf.run_incremental):
        assert run(FRAMES["slender"], MOTIONS, "2DOF-S")["motion"].unique().tolist() == ["weak", "strong"]
    designs = rf.run_design(FRAMES["slender"], MOTIONS, [0.6], models="2DOF-S")
    assert designs["motion"].tolist() == ["weak", "strong"]
    pairs = rf.run_population(MOTIONS, pairs=4)
    assert set(pairs["motion"]) <= set(MOTIONS)
    assert SUITE.names == ("a", "b")  # as it was given


RUNS = {
    "simulate_many": rf.simulate_many,
    "run_cloud": rf.run_cloud,
    "run_incremental": rf.run_incremental,
}
STRUCTURE = "a structure such as a Frame, or RockingProperties"


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"structures": {}}, "structures is empty. Give at least one."),
        ({"motions": {}}, "motions is empty. Give at least one."),
        ({"structures": {1: SUITE}}, "The names of structures must be texts, but 1 was given. Write {'1': ...}."),
        ({"motions": {None: SUITE[0]}}, "The names of motions must be texts, but None was given. Write {'None': ...}."),
        ({"structures": {"a": 3}}, f"structures[0] is int. Expected {STRUCTURE}."),
        ({"motions": {"a": RECORD}}, "motions[0] is ndarray. Expected a GroundMotion."),
        ({"structures": "frame"}, f"structures must be {STRUCTURE}, or a sequence of them, but str was given."),
        ({"motions": None}, "motions must be a GroundMotion, or a sequence of them, but NoneType was given."),
        ({"models": {"2DOF-S": 1, "2DOF-Q": 2}}, "Unknown model '2DOF-Q'."),
    ],
)
def test_all_refuse_alike(run, changed, text):
    with pytest.raises(rf.InputError, match=re.escape(text)):
        run(**({"structures": FRAMES, "motions": MOTIONS, "models": "2DOF-S"} | changed))
