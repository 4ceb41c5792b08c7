"""What a response is: peaks and counts, and its history's quantities where it has a history."""

import copy
import json
import pickle
import subprocess
import sys
from dataclasses import fields
from functools import cached_property
from inspect import isfunction
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.engine.solution import Solution
from rockflex.models import Model
from rockflex.response._peaks import tracked_quantities
from rockflex.response._respond import response_of_solution

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:400] * 2.0, 0.02, name="El Centro")
FRAME = make_frame(n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
QUANTITIES = (
    "time", "sensitivity", "rotation", "rotation_velocity", "side", "ground_acceleration", "modal_displacement",
    "modal_velocity",
    "top_displacement", "base_moment", "base_shear", "uplift_times", "impact_times", "story_drift", "story_shear",
    "floor_acceleration", "modal_acceleration", "rotation_acceleration", "yielding", "horizontal_reaction",
    "vertical_reaction", "friction_demand", "required_friction", "energy", "tendon_force", "total_top_displacement",
    "total_floor_displacement", "element_force", "element_elongation", "element_energy", "element_state",
    "slip", "slip_velocity", "heave", "edge_uplift", "spring_force", "vertical_ground_acceleration", "uplifted",
)  # fmt: skip
KINDS = {
    "energy": "rf.EnergyLedger",
    "sensitivity": "rf.Sensitivity",
    "required_friction": "float",
    "uplifted": "NDArray[np.bool_]",
}
METHODS = (
    "required_friction_excluding_impacts",
    "sliding_time",
    "at",
    "resample",
    "to_frame",
    "to_xarray",
    "to_matlab",
    "to_netcdf",
    "floor_motion",
    "floor_spectrum",
    "settled_rotation",
)


@pytest.fixture(scope="module")
def response():
    return rf.simulate(FRAME, MOTION, free_vibration=1.0)


@pytest.fixture(scope="module")
def peaks_only():
    return rf.simulate(FRAME, MOTION, output="peaks")


def test_a_response_has_the_quantities_of_its_history(response):
    for name in QUANTITIES:
        assert getattr(response, name) is getattr(response.history, name) or np.array_equal(
            getattr(response, name), getattr(response.history, name)
        )
    assert response.energy is response.energy
    assert isinstance(response.energy, rf.EnergyLedger)
    assert repr(response).startswith("Response(MDOF-S under 'El Centro': rocking, θ_max=")


def test_no_quantity_is_forgotten():
    """Every public property of a history, with its documentation, completed by editors and named in the docstring."""
    own = [(name, kind) for name, kind in vars(rf.History).items() if not name.startswith("_")]
    public = {name for name, kind in own if isinstance(kind, property | cached_property)}
    assert public == {
        *QUANTITIES,
        "soil_pressure",
        "bearing_pressure",
        "joint_rotation",
        "joint_force",
        "permanent_settlement",
    }
    methods = {name for name, kind in own if isfunction(kind)}
    assert methods == set(METHODS)
    for name in (*QUANTITIES, *METHODS):
        assert name in dir(rf.Response)
        assert getattr(rf.Response, name).__doc__ == getattr(rf.History, name).__doc__
        assert f"`{name}`" in rf.Response.__doc__ or f"`{name}()`" in rf.Response.__doc__


def test_nothing_else_is_an_attribute(response):
    for name in ("nothing", "_private", "states", "__array__"):
        with pytest.raises(AttributeError, match=f"'Response' object has no attribute '{name}'"):
            getattr(response, name)
    for name in ("max_rotation", "rotation"):
        with pytest.raises(AttributeError):
            setattr(response, name, 0.0)


def test_copies_are_whole(response, peaks_only):
    for run in (response, peaks_only):
        for twin in (copy.copy(run), copy.deepcopy(run), pickle.loads(pickle.dumps(run))):
            assert twin.peaks() == run.peaks()
            assert hasattr(twin, "rotation") == hasattr(run, "rotation")
            if run.history is not None:
                assert np.array_equal(twin.history.states, run.history.states)


def test_floor_peaks_are_read_only(response):
    for each in (response.floors, copy.deepcopy(response.floors), pickle.loads(pickle.dumps(response.floors))):
        for field in fields(rf.FloorPeaks):
            values = getattr(each, field.name)
            assert np.array_equal(values, getattr(response.floors, field.name))
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 0.0


@pytest.mark.parametrize(
    ("peaks", "text"),
    [
        (([1.0, 2.0], [1.0, 2.0], [1.0], [1.0]), r"total_floor_displacement have the sizes \[2, 2, 1, 1\]"),
        (([1.0], [np.nan], [1.0], [1.0]), "story_shear must be finite"),
        (([[1.0]], [1.0], [1.0], [1.0]), "story_drift must be one-dimensional"),
    ],
)
def test_floor_peaks_that_do_not_fit(peaks, text):
    with pytest.raises(rf.InputError, match=text):
        rf.FloorPeaks(*peaks)


def test_peaks_are_a_row_of_a_table(response):
    row = response.peaks()
    assert json.loads(json.dumps(row)) == row
    assert set(row) >= {"model", "motion", "status", "max_rotation", "n_impacts", "end_time", "settled"}
    assert all(getattr(response, name) == value for name, value in row.items())


def test_peaks_alone_have_no_history(peaks_only):
    assert peaks_only.history is None
    assert peaks_only.floors is None
    for name in (*QUANTITIES, *METHODS):
        assert not hasattr(peaks_only, name)
        assert getattr(peaks_only, name, None) is None
        text = f'This response contains only peaks, so it has no {name}. Simulate with output="history".'
        for kind in (rf.InputError, AttributeError):
            with pytest.raises(kind) as caught:
                getattr(peaks_only, name)
            assert str(caught.value) == text


def test_tables_hold_responses(response, peaks_only):
    table = pd.DataFrame({"run": [response, peaks_only]})
    assert str(table).count("Response(MDOF-S") == 2
    assert table["run"].map(lambda run: hasattr(run, "rotation")).tolist() == [True, False]
    assert table.copy(deep=True)["run"][1] is peaks_only


@pytest.mark.slow
def test_type_checkers_know_the_quantities(tmp_path):
    path = tmp_path / "user.py"
    path.write_text(
        "from typing import assert_type\n"
        "import numpy as np\n"
        "from numpy.typing import NDArray\n"
        "import rockflex as rf\n"
        "def use(run: rf.Response) -> None:\n"
        + "".join(f"    assert_type(run.{n}, {KINDS.get(n, 'NDArray[np.float64]')})\n" for n in QUANTITIES)
        + "    assert_type(run.required_friction_excluding_impacts(0.1), float)\n"
        + "    assert_type(run.sliding_time(0.5), float | None)\n"
    )
    checker = Path(sys.executable).with_name("basedpyright")
    done = subprocess.run(
        [checker, "--pythonpath", sys.executable, path], capture_output=True, text=True, check=False, timeout=120
    )
    assert "0 errors" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 0


def test_nominal_overturning_is_a_flag_of_its_own():
    for factor in (1.0, 8.0):
        run = rf.simulate(FRAME, MOTION.scaled(factor), output="peaks")
        limit = 0.7 * np.arctan(1.0 / 8.0)
        assert run.nominal_overturning == (run.max_rotation > limit)
    assert run.nominal_overturning


def solution(**changes):
    given = {
        "overturned": False,
        "settled": False,
        "end_time": 1.0,
        "peaks": np.zeros(6),
        "peak_times": np.zeros(6),
        "extremes": np.zeros(0),
        "extreme_times": np.zeros(0),
        "lost_support": 0.0,
        "time_of_lost_support": 0.0,
        "n_uplifts": 0,
        "n_impacts": 0,
        "n_guarded": 0,
        "final_state": np.zeros(10),
        "states": None,
    }
    return Solution(**{**given, **changes})


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, "no_uplift"),
        ({"peaks": np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])}, "no_uplift"),
        ({"n_uplifts": 1}, "rocking"),
        ({"n_impacts": 1}, "rocking"),
        ({"peaks": np.array([1e-9, 0.0, 0.0, 0.0, 0.0, 0.0])}, "rocking"),
        ({"n_uplifts": 1, "overturned": True}, "overturned"),
    ],
)
def test_status(changes, status):
    model = Model().of(FRAME.rocking())
    assert response_of_solution(model, "", solution(**changes), tracked_quantities(model)).status == status


def test_peaks_of_the_solver_are_named_in_their_order():
    names = (
        "rotation", "top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction",
    )  # fmt: skip
    peaks, times = np.arange(6.0 + 4 * 4), 0.1 * np.arange(22.0)
    lost = {"lost_support": 1e5, "time_of_lost_support": 7.0}
    model = Model().of(FRAME.rocking())
    tracked = tracked_quantities(model, floors=True)
    run = response_of_solution(model, "one", solution(peaks=peaks, peak_times=times, **lost), tracked)
    assert [getattr(run, f"max_{name}") for name in names] == peaks[:6].tolist()
    assert [getattr(run, f"time_of_max_{name}") for name in names] == times[:6].tolist()
    assert run.min_vertical_reaction == FRAME.rocking().m_tot * 9.81 - 1e5
    assert run.time_of_min_vertical_reaction == 7.0
    assert run.floors.story_drift.tolist() == [6, 7, 8, 9]
    assert run.floors.story_shear.tolist() == [10, 11, 12, 13]
    assert run.floors.total_floor_displacement.tolist() == [14, 15, 16, 17]
    assert run.floors.floor_acceleration.tolist() == [18, 19, 20, 21]


def test_a_start_off_the_ground_is_no_uplift():
    """It counts as rocking, and the base may come back once more often than it left."""
    run = rf.simulate(FRAME, rf.quiet_motion(20.0, dt=0.01), "2DOF-S", initial=rf.InitialState(rotation=0.01))
    assert run.status == "rocking"
    assert run.n_impacts == run.n_uplifts + 1


def test_a_simplified_run_beyond_the_balance_rotation_warns():
    """It goes on as if it rocked, at any rotation below π/2, where the structure would long have fallen."""
    balance = FRAME.rocking().pivot(1).balance_rotation
    for turn, warned in ((0.9, False), (1.1, True), (6.0, True)):
        start = rf.InitialState(rotation=turn * balance)
        run = rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-S", initial=start)
        assert run.status == "rocking"
        assert run.balance_ratio == pytest.approx(run.max_rotation / balance, rel=1e-12)
        assert any("static moment vanishes" in text for text in run.warnings) == warned
        peaks = rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-S", "peaks", initial=start)
        assert peaks.warnings == run.warnings
        assert "such as MDOF-C" in "".join(run.warnings) or not warned
        complete = rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-C", initial=start)
        assert not any("static moment vanishes" in text for text in complete.warnings)
        assert complete.may_fall == warned  # it is let go there, and has no time to fall
        block = rf.simulate(FRAME, rf.quiet_motion(0.02), "rigid", initial=start)
        assert "such as rigid-C" in "".join(block.warnings) or not warned
    fell = rf.simulate(
        FRAME, rf.quiet_motion(1.0), "2DOF-S", initial=rf.InitialState(rotation=3.0 * balance), free_vibration=9.0
    )
    assert fell.status == "overturned"
    (text,) = fell.warnings
    assert "such as MDOF-C" in text


def test_a_run_that_ends_during_the_fall_says_so():
    """Under a pulse that overturns a block later, and one that does not; a longer run tells which."""
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    for amplitude, model in product((3.0, 8.0), ("rigid", "rigid-C")):
        pulse = rf.half_sine_pulse(amplitude, 0.6)
        short, whole = (rf.simulate(block, pulse, model, "peaks", free_vibration=more) for more in (0.0, "settle"))
        assert (short.status, whole.status) == ("rocking", "overturned" if amplitude == 8.0 else "rocking")
        assert short.may_fall
        assert not whole.may_fall
        assert any('free_vibration="settle"' in text for text in short.warnings)
        assert not any("may still fall" in text for text in whole.warnings)
    # From rest on its side of α: on its way back in, with energy enough for nothing.
    start = rf.InitialState(rotation=0.15)
    assert not rf.simulate(block, rf.quiet_motion(0.3), "rigid", "peaks", initial=start).may_fall
    # Moving in, but fast enough to fall over beyond.
    start = rf.InitialState(rotation=0.15, rotation_velocity=-1.0)
    assert rf.simulate(block, rf.quiet_motion(0.02), "rigid", "peaks", initial=start).may_fall
    table = rf.simulate_many(block, rf.half_sine_pulse(8.0, 0.6), ["rigid", "rigid-C"])
    assert table["may_fall"].all()


def test_leaning_columns_whose_push_counts_are_told():
    """Σ l_i g θ over V_b; the wall alone has none."""
    wall = rf.Frame(5, 3.0, 40e3, 40e3, 0.0, period=1.0, aspect_ratio=8.0, damping_ratio=0.02)
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    shares = {}
    for mass in (0.0, 20e3, 60e3):
        run = rf.simulate(rf.Leaning(wall, mass), motion, output="peaks")
        shares[mass] = run.leaning_push
        assert run.leaning_push == pytest.approx(5 * mass * 9.81 * run.max_rotation / run.max_base_shear, rel=1e-12)
        assert any("leaning columns push" in text for text in run.warnings) == (run.leaning_push > 0.05)
    assert shares[0.0] == 0.0
    assert shares[20e3] < 0.05 < shares[60e3]
    table = rf.simulate_many([rf.Leaning(wall, 60e3), wall], motion)
    assert table["leaning_push"].tolist() == [shares[60e3], 0.0]
