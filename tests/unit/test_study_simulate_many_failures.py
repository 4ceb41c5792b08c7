"""What `simulate_many` does with runs that fail, and with arguments that cannot be used."""

import itertools

import numpy as np
import pandas as pd
import pytest

from builders import frame_values
from rockflex import Frame, GroundMotion, InitialState, InputError, load_suite, simulate, simulate_many
from rockflex.response import PEAKS
from rockflex.solve import engine
from rockflex.solve._failures import Status

RECORD = load_suite("el-centro-1940")[0].acceleration


def frame(**changes):
    given = frame_values(n_stories=3, base_mass=60e3, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
    return Frame(**{**given, **changes})


STRUCTURES = [frame(), frame(n_stories=2, stiffness_ratio=0.0).rocking(), frame(period=0.3).lumped]
MOTIONS = [
    GroundMotion(2.0 * RECORD[:300], 0.02, name="first"),
    GroundMotion(1.5 * RECORD[100:350], 0.01, name="second"),
]
VALUES = [name for name in PEAKS if name not in ("model", "motion", "status")]


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_runs_that_fail_become_rows(monkeypatch, workers, output):
    """Models with more modes than a structure has; runs that the solver gives up."""
    real = engine._ends_of

    def ends_of(batch, states, dt, *others, **options):
        found = real(batch, states, dt, *others, **options)
        if dt == MOTIONS[1].dt:
            found.status[:], found.samples[:] = Status.CHATTER, 0
        return found

    monkeypatch.setattr(engine, "_ends_of", ends_of)
    table = simulate_many(STRUCTURES, MOTIONS, ["2DOF-S", "4DOF-S"], output, workers=workers)
    for name in ("n_uplifts", "n_impacts"):
        assert table[name].dtype == "Int64"
    for name in ("nominal_overturning", "settled"):
        assert table[name].dtype == "boolean"
    for (index, motion, model), (_, row) in zip(
        itertools.product(range(3), ["first", "second"], ["2DOF-S", "4DOF-S"]), table.iterrows(), strict=True
    ):
        assert (row["structure"], row["motion"], row["model"]) == (index, motion, model)
        if index == 1 and model == "4DOF-S":
            text = "Model 4DOF-S needs 3 modes, but the structure has 2."
        elif motion == "second":
            text = f"The events of {model}, such as impacts, accumulate without end in the sample before 0.01 s."
        else:
            assert row["status"] == "rocking"
            assert pd.isna(row["error"])
            continue
        assert row["error"].startswith(text)
        assert pd.isna(row["status"])
        for name in VALUES:
            assert pd.isna(row[name]), name
        if output == "history":
            assert row["response"] is None


def test_a_start_that_a_model_cannot_have_is_a_row():
    table = simulate_many(STRUCTURES[0], MOTIONS[0], ["2DOF-S", "fixed"], initial=InitialState(rotation=0.01))
    assert pd.isna(table["error"][0])
    assert table["error"][1].startswith("fixed has a base that cannot lift, but rotation=0.01")


def test_one_start_for_models_of_several_lengths():
    """A start of more modes than a model has makes a row with an error; the others run."""
    start = InitialState(modal_displacement=[1e-3, 1e-4])
    table = simulate_many(STRUCTURES[0], MOTIONS[0], ["2DOF-S", "3DOF-S", "MDOF-S"], initial=start)
    assert table["error"].isna().tolist() == [False, True, True]
    assert table["error"][0] == "modal_displacement has 2 values, but 2DOF-S has 1 mode. Give at most 1."
    assert table["n_impacts"].isna().tolist() == [True, False, False]
    alone = simulate(STRUCTURES[0], MOTIONS[0], "3DOF-S", initial=start)
    assert table["max_rotation"][1] == pytest.approx(alone.max_rotation, rel=1e-12)


STRUCTURE = "a structure such as a Frame, or RockingProperties"
LABEL = 'a label such as "2DOF-S", or a Model'


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"structures": []}, "structures is empty. Give at least one."),
        ({"motions": []}, "motions is empty. Give at least one."),
        ({"models": []}, "models is empty. Give at least one."),
        ({"structures": 3}, f"structures must be {STRUCTURE}, or a sequence of them, but int was given."),
        ({"structures": "frame"}, f"structures must be {STRUCTURE}, or a sequence of them, but str was given."),
        (
            {"structures": Frame},
            f"structures must be {STRUCTURE}, or a sequence of them, but the class Frame was given.",
        ),
        ({"motions": None}, "motions must be a GroundMotion, or a sequence of them, but NoneType was given."),
        ({"motions": np.array(1.0)}, "motions must be a GroundMotion, or a sequence of them, but ndarray was given."),
        ({"models": None}, f"models must be {LABEL}, or a sequence of them, but NoneType was given."),
        ({"structures": [frame(), 3]}, f"structures[1] is int. Expected {STRUCTURE}."),
        ({"structures": [Frame]}, f"structures[0] is the class Frame. Expected {STRUCTURE}."),
        ({"motions": [MOTIONS[0], RECORD]}, "motions[1] is ndarray. Expected a GroundMotion."),
        ({"models": ["2DOF-S", 2]}, f"models[1] is int. Expected {LABEL}."),
        (
            {"initial": 0.1},
            "initial must be an InitialState or None, but 0.1 was given. Write InitialState(rotation=...).",
        ),
        (
            {"free_vibration": -1},
            'free_vibration must be zero or more seconds (at most 1e+09), or "settle", but -1 was given.',
        ),
        ({"workers": 0}, "workers must be a whole number of at least 1, but 0 was given."),
        ({"workers": True}, "workers must be a whole number of at least 1, but True was given."),
        ({"output": "all"}, 'output must be "history" or "peaks", but \'all\' was given.'),
        (
            {"scales": [1.0, -1e308]},
            "scales must keep the accelerations finite, but the factor -1e+308 was given for 'first' with "
            f"{MOTIONS[0].pga:.3g} m/s². Give a smaller factor.",
        ),
    ],
)
def test_arguments_that_cannot_be_used(changes, text):
    with pytest.raises(InputError) as caught:
        simulate_many(**{"structures": STRUCTURES, "motions": MOTIONS, **changes})
    assert str(caught.value) == text


@pytest.mark.parametrize(
    "scales", [[], [1.0, np.nan], [np.inf], np.nan, "a", "12", ["a"], ["1.0"], [True], None, [[1.0]], [10**400]]
)
def test_scales_that_are_none(scales):
    with pytest.raises(InputError) as caught:
        simulate_many(STRUCTURES, MOTIONS, scales=scales)
    given = repr(scales).replace(str(10**400), "an integer of about 400 digits")
    assert str(caught.value) == f"scales must be one or more finite factors, but {given} was given."


def test_unknown_models():
    with pytest.raises(InputError, match="Unknown model '2DOF-Q'"):
        simulate_many(STRUCTURES, MOTIONS, ["2DOF-S", "2DOF-Q"])


def test_workers_may_be_of_numpy():
    table = simulate_many(STRUCTURES[0], MOTIONS, workers=np.int64(2))
    pd.testing.assert_frame_equal(table, simulate_many(STRUCTURES[0], MOTIONS, workers=1))
