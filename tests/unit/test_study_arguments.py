"""Structures, motions, models, scales and options that studies are called with."""

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import frame_values, make_frame
from rockflex import InputError
from rockflex.cli._app import app
from rockflex.models import parse_model
from rockflex.structure.file._toml_table import parse_toml_table
from rockflex.studies._arguments import expand_scale_range, parse_scale_range
from rockflex.studies._case_keys import RunOptionKeys
from rockflex.studies._prepared_case import RunOptions, yielding_model_labels
from rockflex.studies._result_tables import OF_ELEMENTS, OF_GROUND

STRUCTURE = str(Path(__file__).parents[2] / "examples" / "structure_1.toml")
BASE = {
    "structures": [{"name": "one", "frame": frame_values(n_stories=2, period=0.5, aspect_ratio=6.0)}],
    "records": {"suites": ["el-centro-1940"]},
    "models": ["rigid"],
}
FILE = """study = "cloud"
models = ["rigid"]
scales = {smallest = 0.1, largest = 0.5, step = 0.1}

[records]
suites = ["el-centro-1940"]

[[structures]]
[structures.block]
slenderness = 0.2
half_diagonal = 3.0
"""


@pytest.mark.parametrize(
    ("given", "factors"),
    [
        ({"smallest": 0.5, "largest": 3.0, "step": 0.25}, [0.5 + 0.25 * k for k in range(11)]),
        ({"smallest": 0.1, "largest": 0.5, "step": 0.1}, [0.1, 0.2, 0.3, 0.4, 0.5]),
        ({"smallest": 1, "largest": 2, "step": 0.4}, [1.0, 1.4, 1.8]),
        ({"smallest": -1.0, "largest": 1.0, "step": 1.0}, [-1.0, 0.0, 1.0]),
        ({"smallest": 0.0, "largest": 1.0, "count": 3}, [0.0, 0.5, 1.0]),
        ({"smallest": 0.0, "largest": 1.0, "count": 2, "spacing": "linear"}, [0.0, 1.0]),
        ({"smallest": 0.25, "largest": 4.0, "count": 5, "spacing": "logarithmic"}, [0.25, 0.5, 1.0, 2.0, 4.0]),
    ],
)
def test_a_range_is_the_list_of_its_factors(given, factors):
    assert expand_scale_range(given) == factors
    assert rf.CloudStudy(**BASE, scales=given) == rf.CloudStudy(**BASE, scales=factors)
    assert rf.CloudStudy(**BASE, scales=given).document()["scales"] == factors


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"smallest": 1.0, "largest": 2.0},
        {"smallest": 1.0, "largest": 2.0, "step": 0.1, "count": 3},
        {"smallest": 1.0, "largest": 2.0, "number": 3},
        {"smallest": 2.0, "largest": 1.0, "count": 3},
        {"smallest": 1.0, "largest": 2.0, "count": 1},
        {"smallest": 1.0, "largest": 2.0, "count": 3.0},
        {"smallest": 1.0, "largest": 2.0, "count": True},
        {"smallest": 1.0, "largest": 2.0, "count": 1001},
        {"smallest": 1.0, "largest": 2.0, "step": 0.1, "spacing": "logarithmic"},
        {"smallest": 0.0, "largest": 2.0, "count": 3, "spacing": "logarithmic"},
        {"smallest": 1.0, "largest": 2.0, "count": 3, "spacing": "even"},
    ],
)
def test_what_is_no_range_is_refused(given):
    with pytest.raises(InputError, match=r"scales must be a list, or a range such as \{smallest = 0.5, largest = 3.0"):
        rf.CloudStudy(**BASE, scales=given)


@pytest.mark.parametrize(
    ("smallest", "largest", "step"),
    [(2.0, 1.0, 0.1), (1.0, 2.0, 0.0), (1.0, 2.0, 2.0), (0.0, 1.0, 1e-3), (np.nan, 1.0, 0.1), (0.0, np.inf, 0.1)],
)
def test_steps_lead_from_the_smallest_to_the_largest(smallest, largest, step):
    with pytest.raises(InputError, match="scales must rise in 1 to 999 steps, but a range from"):
        rf.CloudStudy(**BASE, scales={"smallest": smallest, "largest": largest, "step": step})


@pytest.mark.parametrize(("text", "factors"), [("2", [2.0]), ("-1e-1", [-0.1]), ("0.5:1:0.25", [0.5, 0.75, 1.0])])
def test_factors_from_a_text(text, factors):
    assert parse_scale_range(text) == factors


def test_a_file_has_a_range(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(FILE, "utf-8")
    assert rf.load_study(path).scales == [0.1, 0.2, 0.3, 0.4, 0.5]
    assert rf.load_study(path).plan().n_runs == 5


def run(*scales):
    given = [word for scale in scales for word in ("--scale", scale)]
    return CliRunner().invoke(app, ["run", STRUCTURE, "el-centro-1940", "--model", "rigid", "--json", *given])


def test_the_command_line_has_ranges():
    found = json.loads(run("1:2:0.5", "2", "0.25").stdout)
    assert found["options"]["scales"] == [1.0, 1.5, 2.0, 0.25]
    assert [row["scale"] for row in found["runs"]] == [1.0, 1.5, 2.0, 0.25]


@pytest.mark.parametrize(
    ("scale", "said"),
    [
        ("twice", "--scale must be numbers, or ranges such as 0.5:3.0:0.25, but 'twice' was given."),
        ("1:2", "--scale must be numbers, or ranges such as 0.5:3.0:0.25, but '1:2' was given."),
        ("2:1:0.1", "--scale must rise in 1 to 999 steps, but a range from 2 to 1 in steps of 0.1 was given."),
    ],
)
def test_wrong_factors_are_refused(scale, said):
    result = run(scale)
    assert result.exit_code == 2
    assert said in " ".join(result.stderr.split())


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
EXPECTED_STRUCTURE = "a structure such as a Frame, or RockingProperties"


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"structures": {}}, "structures is empty. Give at least one."),
        ({"motions": {}}, "motions is empty. Give at least one."),
        ({"structures": {1: SUITE}}, "The names of structures must be texts, but 1 was given. Write {'1': ...}."),
        ({"motions": {None: SUITE[0]}}, "The names of motions must be texts, but None was given. Write {'None': ...}."),
        ({"motions": {"a": RECORD}}, "motions[0] is ndarray. Expected a GroundMotion."),
        (
            {"structures": "frame"},
            f"structures must be {EXPECTED_STRUCTURE}, or a sequence of them, but str was given.",
        ),
        ({"motions": None}, "motions must be a GroundMotion, or a sequence of them, but NoneType was given."),
        ({"models": {"2DOF-S": 1, "2DOF-Q": 2}}, "Unknown model '2DOF-Q'."),
    ],
)
def test_all_refuse_alike(run, changed, text):
    with pytest.raises(rf.InputError, match=re.escape(text)):
        run(**({"structures": FRAMES, "motions": MOTIONS, "models": "2DOF-S"} | changed))


PULSE = rf.one_sine_pulse(amplitude=4.0, period=0.8)
YIELDS = rf.BoucWen(yield_displacement=0.02)
FRAME = make_frame(n_stories=2)


def test_a_table_of_a_file_gives_the_options_of_a_call():
    table = parse_toml_table(
        RunOptionKeys,
        {
            "impact": "restitution",
            "restitution": 0.5,
            "ground": {"friction": 0.4},
            "bouc_wen": {"yield_displacement": 0.02},
        },
    )
    of_file = RunOptions.of(1.0, impact=table.law(), bouc_wen=table.hysteresis(), ground=table.ground_rule())
    of_call = RunOptions.of(1.0, impact=rf.Restitution(0.5), bouc_wen=YIELDS, ground=rf.Ground(friction=0.4))
    model, properties = parse_model("2DOF-S"), FRAME.rocking()
    found = [options.case(model, properties).run(PULSE).peaks() for options in (of_file, of_call)]
    direct = rf.simulate(
        FRAME,
        PULSE,
        model,
        output="peaks",
        free_vibration=1.0,
        impact=rf.Restitution(0.5),
        ground=rf.Ground(friction=0.4),
    )
    assert found[0] == found[1] == direct.peaks()


@pytest.mark.parametrize(
    ("labels", "with_hysteresis"), [(["2DOF-S", "2DOF-S-BW"], [False, True]), (["2DOF-S", "1DOF-fixed"], [True, True])]
)
def test_the_hysteresis_is_of_the_labelled_models_or_of_all_if_none_is(labels, with_hysteresis):
    models = list(map(parse_model, labels))
    options = RunOptions.of(bouc_wen=YIELDS).for_models(models)
    tied = [options.model_of(model, FRAME.rocking(1)) for model in models]
    assert [model.bouc_wen is not None for model in tied] == with_hysteresis
    assert yielding_model_labels(labels) == [label for label in labels if label.endswith("-BW")]


@pytest.mark.parametrize(
    ("given", "field"),
    [({"free_vibration": -1.0}, "free_vibration"), ({"work_limit": 0.0}, "work_limit"), ({"ground": 3}, "ground")],
)
def test_an_option_out_of_range_is_named(given, field):
    with pytest.raises(rf.InputError) as caught:
        RunOptions.of(**given)
    assert caught.value.field == field
