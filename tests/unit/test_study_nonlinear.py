"""The cross product with nonlinear models, springs and laws, against single runs."""

import re

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.models import Model

RECORD = rf.load_suite("el-centro-1940")[0].acceleration
MOTIONS = [rf.GroundMotion(RECORD[60:160] * f, 0.02, name=f"El Centro x {f:g}") for f in (0.5, 2.5)]
GIVEN = frame_values(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=7.0, damping_ratio=0.03)
FRAMES = [rf.Frame(**GIVEN), rf.Frame(**{**GIVEN, "period": 0.9, "aspect_ratio": 9.0})]
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear", "n_impacts", "n_uplifts")
LABELS = ["2DOF-C", "2DOF-C-SI", "3DOF-C-E", "MDOF-C", "rigid", "rigid-C", "MDOF-S", "fixed"]


def assert_as_single_runs(table, models, scales, **options):
    assert table["error"].isna().all()
    for row in table.itertuples():
        motion = MOTIONS[[m.name for m in MOTIONS].index(row.motion)].scaled(row.scale)
        run = rf.simulate(FRAMES[row.structure], motion, row.model, output="peaks", **options)
        assert row.status == run.status
        for name in PEAKS:
            assert getattr(row, name) == getattr(run, name), (row.model, name)
    assert len(table) == len(FRAMES) * len(MOTIONS) * len(models) * len(scales)


@pytest.mark.parametrize("workers", [1, 2])
def test_all_kinds_of_models(workers):
    scales = [1.0, 1.3]
    table = rf.simulate_many(FRAMES, MOTIONS, LABELS, scales=scales, workers=workers)
    assert_as_single_runs(table, LABELS, scales)
    assert set(table["model"]) == set(LABELS)
    assert (table["status"] == "rocking").sum() > 20


def test_a_law_goes_to_all():
    law = rf.Restitution(0.6, 1e-3)
    models = ["MDOF-S", "2DOF-C", "rigid-C"]
    table = rf.simulate_many(FRAMES, MOTIONS, models, impact=law, workers=2)
    assert_as_single_runs(table, models, [1.0], impact=law)


def test_a_spring_goes_to_all_where_no_label_asks_for_it():
    spring = rf.BoucWen(0.03)
    models = [Model(1), "2DOF-C-SI", "1DOF-fixed"]
    table = rf.simulate_many(FRAMES, MOTIONS, models, bouc_wen=spring, workers=2)
    assert table["error"].isna().all()
    # The table names what was asked for.
    assert list(dict.fromkeys(table["model"])) == ["2DOF-S", "2DOF-C-SI", "1DOF-fixed"]
    assert_as_single_runs(table, models, [1.0], bouc_wen=spring)
    asked = rf.simulate_many(FRAMES, MOTIONS, ["2DOF-S-BW"], bouc_wen=spring)
    for name in PEAKS:
        assert asked[name].tolist() == table[table["model"] == "2DOF-S"][name].tolist()


def test_histories_and_initial_states():
    start = rf.InitialState(0.02)
    table = rf.simulate_many(
        FRAMES[0],
        MOTIONS[1],
        ["2DOF-C", "rigid-C"],
        "history",
        initial=start,
        impact=rf.VVELComplete(),
        free_vibration=0.5,
    )
    for row in table.itertuples():
        run = rf.simulate(FRAMES[0], MOTIONS[1], row.model, initial=start, impact=rf.VVELComplete(), free_vibration=0.5)
        assert np.array_equal(row.response.history.states, run.history.states)
        assert row.response.peaks() == run.peaks()


@pytest.mark.slow
def test_what_a_model_cannot_have_is_said_in_its_row():
    table = rf.simulate_many(FRAMES[0], MOTIONS[1], ["2DOF-S", "MDOF-C", "rigid", "2DOF-C"], bouc_wen=rf.BoucWen(0.05))
    assert table["error"].isna().tolist() == [True, False, False, True]
    assert table["error"][1].startswith("bouc_wen applies to models with one mode, but MDOF-C has 3. Use 2DOF-S, or")
    assert table["n_impacts"].isna().tolist() == [False, True, True, False]
    table = rf.simulate_many(FRAMES[0], MOTIONS[1], ["2DOF-S-BW", "MDOF-C"])
    assert table["error"][0] == "2DOF-S-BW needs its hysteresis. Give bouc_wen=BoucWen(yield_displacement=...)."
    table = rf.simulate_many(FRAMES[0].rocking(2), MOTIONS[1], ["MDOF-C", "MDOF-C-SI"])
    assert table["error"][0].startswith("MDOF-C needs all modes, but those given have 99.")
    assert table["error"].isna().tolist() == [False, True]


@pytest.mark.parametrize("run", [rf.simulate, rf.simulate_many])
@pytest.mark.parametrize("spring", [rf.BoucWen, 0.05, "BW", {"yield_displacement": 0.05}])
def test_what_is_no_spring(run, spring):
    text = f"bouc_wen must be a BoucWen or None, but {spring!r} was given. Write BoucWen(yield_displacement=...)."
    with pytest.raises(rf.InputError, match=re.escape(text)):
        run(FRAMES[0], MOTIONS[0], "2DOF-S", bouc_wen=spring)


@pytest.mark.parametrize("label", ["3DOF-C", "MDOF-fixed", "rigid-S"])
def test_labels_of_no_model_are_refused_at_once(label):
    with pytest.raises(rf.InputError):
        rf.simulate_many(FRAMES, MOTIONS, ["2DOF-S", label])


@pytest.mark.parametrize(
    ("model", "label", "values", "options"),
    [
        ("2DOF-C", "2DOF-C", 4, {}),
        ("rigid-C", "rigid-C", 2, {}),
        ("1DOF-fixed", "1DOF-fixed-BW", 4, {"bouc_wen": rf.BoucWen(0.05)}),
    ],
)
def test_a_motion_that_cannot_be_followed(model, label, values, options):
    """Accelerations beyond all numbers: the error names the sample and the state."""
    shaken = rf.GroundMotion(np.array([0.0, 1e160, -1e160, 0.0]), 0.02)
    text = (
        f"The motion of {label} cannot be integrated in the sample before 0.02 s: no step is short enough. The state "
        "there is "
    )
    with pytest.raises(rf.SolverError) as caught:
        rf.simulate(FRAMES[0], shaken, model, work_limit=None, **options)
    before, _, state = str(caught.value).partition(text)
    assert not before
    told = [abs(float(each)) < 1e-100 for each in re.findall(r"-?\d[\d.e+-]*+", state.partition(" Check")[0])]
    assert told == [True] * values
    table = rf.simulate_many(FRAMES[0], shaken, model, work_limit=None, **options)
    assert table["error"].tolist() == [str(caught.value)]
