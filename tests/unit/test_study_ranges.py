"""Ranges of scale factors: in studies, in their files and on the command line."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import frame_values
from rockflex import InputError
from rockflex.cli import app
from rockflex.study._ranges import expanded, parsed

STRUCTURE = str(Path(rf.__file__).parents[2] / "examples" / "structure_1.toml")
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
    assert expanded(given) == factors
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
    assert parsed(text) == factors


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
