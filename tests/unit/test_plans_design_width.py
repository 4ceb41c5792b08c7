"""The least width of a base that meets a target, in closed form."""

import math

import numpy as np
import pandas as pd
import pytest

import rockflex as rf


@pytest.fixture
def runs(designed):
    return designed


def made_up(values, high=None, widths=None, **columns):
    values = np.asarray(values, float)
    widths = np.arange(1.0, values.size + 1.0) if widths is None else widths
    high = values if high is None else high
    facts = {"model": "MDOF-S", "tendon": "no tendon", "prestress_ratio": 0.0, "stiffness_ratio": 0.0}
    return pd.DataFrame({**facts, "half_width": widths, "probability": values, "high": high} | columns)


def test_exponentials_are_met_exactly():
    b = np.linspace(1.0, 3.0, 7)
    table = made_up(np.exp(-2.0 * b), 1.5 * np.exp(-2.0 * b), b)
    for target in (0.1, 0.02, 0.004):
        (row,) = rf.smallest_width(table.sample(frac=1.0, random_state=1), target).to_dict("records")
        assert row["half_width"] == pytest.approx(-math.log(target) / 2.0, rel=1e-12)
        assert row["half_width_upper"] == pytest.approx(-math.log(target / 1.5) / 2.0, rel=1e-12)
        assert (row["outcome"], row["monotone"], row["note"]) == ("met", True, "")
    rates = table.rename(columns={"probability": "rate"})
    pd.testing.assert_frame_equal(rf.smallest_width(rates, 0.02), rf.smallest_width(table, 0.02))


@pytest.mark.parametrize(
    ("values", "expected", "outcome", "monotone", "notes"),
    [
        ([0.4, 0.0], 1.75, "met", True, ""),
        ([0.4, 0.1], 2.0, "met", True, ""),
        ([0.4, 0.3], math.nan, "not met", True, "The widest base, B = 2 m, has 0.3."),
        ([0.1, 0.05], 1.0, "all meet it", True, "Every base meets it; a base below B = 1 m might do."),
        (
            [0.4, 0.05, 0.2, 0.05],
            3.5,
            "met more than once",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m. Narrower bases meet it too, from B = 2 m, "
            "but 3 m does not.",
        ),
        ([0.4, 0.3, 0.35, 0.1], 4.0, "met", False, "It does not fall everywhere: it rises between B = 2 and 3 m."),
        (
            [0.4, 0.3, 0.35, 0.1, 0.15, 0.02, 0.03],
            5.0 + math.log(0.15 / 0.1) / math.log(0.15 / 0.02),
            "met more than once",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m and 2 times more. Narrower bases meet it too, "
            "from B = 4 m, but 5 m does not.",
        ),
        (
            [0.4, 0.05, 0.2],
            math.nan,
            "not met",
            False,
            "It does not fall everywhere: it rises between B = 2 and 3 m. The widest base, B = 3 m, has 0.2. Narrower "
            "bases meet it, from B = 2 m.",
        ),
        ([0.4, math.nan, 0.1], 3.0, "met", True, "1 of 3 bases have no value and were left out."),
        ([math.nan], math.nan, "not met", True, "1 of 1 bases have no value and were left out."),
    ],
)
def test_what_is_said_of_a_width(values, expected, outcome, monotone, notes):
    (row,) = rf.smallest_width(made_up(values), 0.1).to_dict("records")
    assert row["half_width"] == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert (row["outcome"], row["monotone"], row["note"]) == (outcome, monotone, notes)


def test_widths_of_every_tendon(runs):
    table = rf.design_table(runs, 0.02, at=0.4)
    target = float(table["probability"].iloc[1])
    found = rf.smallest_width(table, target)
    assert list(found["tendon"]) == ["no tendon", "held"]
    assert list(found["prestress_ratio"]) == pytest.approx([0.0, 0.3])
    assert found["half_width"][0] == pytest.approx(1.6)
    assert found["half_width"][1] < 1.6
    assert (found["half_width_upper"].fillna(math.inf) >= found["half_width"]).all()
    assert math.isnan(rf.smallest_width(table.assign(stiffness_ratio=range(6)), 0.1)["stiffness_ratio"][0])


@pytest.mark.parametrize(
    ("table", "target", "message"),
    [
        (made_up([0.1]).drop(columns="tendon"), 0.1, "The table lacks tendon. Give what design_table returned."),
        (made_up([]), 0.1, "The table has no rows. Give what design_table returned."),
        (made_up([0.1]), 0.0, "target must be a positive, finite number in probability, but 0.0 was given."),
    ],
)
def test_damaged_arguments_of_the_width(table, target, message):
    with pytest.raises(rf.InputError) as caught:
        rf.smallest_width(table, target)
    assert str(caught.value) == message
