"""Many runs in one call of the kernel: each has the bits of the run alone, whatever the others did."""

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.engine.solution import Excitation
from rockflex.models import parse_model
from rockflex.models._prepared_model import run_all
from rockflex.models._work import WorkLimitError
from rockflex.response._respond import NAMES, STATUSES, response_columns_of_runs, response_of_solution
from rockflex.studies import PreparedCase

RECORD = rf.load_suite("el-centro-1940")[0].acceleration
FRAME = rf.Frame(**frame_values(n_stories=3, base_mass=60e3, period=0.5, aspect_ratio=8.0, damping_ratio=0.03))
TIED = rf.Restrained(FRAME, [rf.Tendon(1e5, 2e7, 0.1, 2e5, 0.02), rf.ViscousDamper(1e5, 0.3)]).rocking()
P = FRAME.rocking()
SOIL = rf.Ground(springs=rf.winkler_bed(P.half_width, 2.0, 2e8).damped(0.1, P.m_tot), base_inertia=1e5)
UPWARD = 0.3 * np.roll(RECORD, 7)

RUNS = [
    Excitation(2.0 * RECORD[:400]),
    Excitation(RECORD[100:250], None, -3.0),
    Excitation(RECORD[:400], None, 0.01),
    Excitation(RECORD[100:250], None, 3.5),
]
CASES = {
    "2DOF-S": {},
    "MDOF-S": {},
    "rigid": {},
    "fixed": {},
    "2DOF-C": {},
    "MDOF-C-SI": {},
    "2DOF-S-BW": {"bouc_wen": rf.BoucWen(yield_displacement=0.02)},
    "MDOF-S, eccentric": {"properties": rf.Eccentric(FRAME, -0.15).rocking()},
    "MDOF-S, tendon": {"properties": TIED},
    "MDOF-S, soil": {"ground": SOIL},
    "MDOF-S, sliding": {"ground": rf.Ground(0.1)},
    "2DOF-S, settles": {"free_vibration": None},
    "2DOF-S, starts open": {"initial": rf.InitialState(rotation=0.02)},
    "MDOF-S, vertical": {"vertical": UPWARD},
    "2DOF-C, vertical": {"vertical": UPWARD},
}


def case_of(name):
    given = dict(CASES[name])
    vertical, properties = given.pop("vertical", None), given.pop("properties", P)
    tied = {key: given.pop(key) for key in ("bouc_wen", "ground") if key in given}
    model = parse_model(name.split(",")[0]).of(properties, None, tied.get("bouc_wen"), tied.get("ground"))
    runs = RUNS if vertical is None else [run._replace(vertical=vertical[: run.acceleration.size]) for run in RUNS]
    return PreparedCase(model, **given), runs


def solved(case, runs, **options):
    starts = [case.start] * len(runs)
    engines = [case.engine] * len(runs)
    return run_all(engines, runs, 0.02, free_vibration=case.free_vibration, starts=starts, **options)


def assert_same(one, other):
    for name in type(one).__slots__:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


@pytest.mark.parametrize("name", CASES)
def test_every_run_is_as_if_it_were_alone(name):
    case, runs = case_of(name)
    alone = [solved(case, [run]).one(0) for run in runs]
    assert any(each.n_uplifts + each.n_impacts > 0 for each in alone) or name == "fixed"
    together = solved(case, runs)
    assert not together.failures
    for place, each in enumerate(alone):
        assert_same(together.one(place), each)


@pytest.mark.parametrize("name", CASES)
def test_columns_are_the_numbers_of_the_responses(name):
    case, runs = case_of(name)
    found = solved(case, [runs[0], runs[1]._replace(scale=30.0), runs[2]])
    columns = response_columns_of_runs([case.model] * 3, found, case.tracked)
    assert set(columns) == set(NAMES)
    for place in range(3):
        response = response_of_solution(case.model, "", found.one(place), case.tracked)
        assert STATUSES[columns["status"][place]] == response.status
        for label in NAMES[1:]:
            value, expected = columns[label][place].item(), getattr(response, label)
            assert type(value) is type(expected)
            np.testing.assert_array_equal(value, expected, err_msg=label)


def test_a_run_that_fails_leaves_the_others_alone():
    case, runs = case_of("MDOF-S")
    longest = Excitation(np.tile(RECORD, 40))
    limit = case.engine.task(runs[0], 0.02).work().total * 3.0
    found = solved(case, [runs[0], longest, runs[1]], work_limit=limit)
    assert list(found.failures) == [1]
    with pytest.raises(WorkLimitError, match="MDOF-S would take about"):
        found.one(1)
    for place, run in ((0, runs[0]), (2, runs[1])):
        assert_same(found.one(place), solved(case, [run]).one(0))
    only = solved(case, [longest, longest], work_limit=limit)
    assert list(only.failures) == [0, 1]


def test_a_law_that_fails_in_one_run_fails_that_run():
    class Fussy:
        """Fails if the base returns fast."""

        def after(self, properties, modal_velocity, rotation_velocity):
            if abs(rotation_velocity) > 0.12:
                raise ValueError(f"too fast: {rotation_velocity:.3g} rad/s")
            return modal_velocity + properties.effective_height * rotation_velocity, 0.0

    case = PreparedCase(parse_model("MDOF-S").of(P, Fussy()))
    found = solved(case, [RUNS[0], Excitation(RECORD[:400], None, 0.8), RUNS[1], RUNS[0]])
    assert sorted(found.failures) == [0, 2, 3]
    for place in (0, 2, 3):
        text = r"The impact law .*Fussy.* failed: too fast: -?0\.\d+ rad/s"
        with pytest.raises(rf.InputError, match=text) as caught:
            found.one(place)
        assert isinstance(caught.value.__cause__, ValueError)
    assert found.one(1).n_impacts > 0


def test_a_work_limit_is_that_of_each_run():
    """What a run takes more than estimated ends that run only, and not those after it."""
    law = rf.Restitution(0.9, 1e-6)
    case = PreparedCase(parse_model("rigid").of(P, law))
    calm, wild = Excitation(0.5 * RECORD[:200]), Excitation(np.concatenate((3.0 * RECORD[:200], np.zeros(3000))))
    limit = 1.05 * case.engine.task(wild, 0.02).work().total
    found = solved(case, [calm, wild, calm], work_limit=limit)
    assert 0 not in found.failures
    assert 2 not in found.failures
    if found.failures:
        with pytest.raises(rf.SolverError, match="was stopped at"):
            found.one(1)
    assert_same(found.one(2), found.one(0))
