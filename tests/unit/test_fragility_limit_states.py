"""Limit states of runs, and observed fractions."""

import math

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from rockflex.fragility import LIMIT_STATES, OVERTURNING, residual_rotation_limit_state
from rockflex.fragility._limit_states import (
    NOMINAL,
    OVERTURNED,
    ROCKING,
    TENDON_YIELD,
    UPLIFT,
    limit_state_label,
    nominal_rotation_symbol,
    observed_exceedance_fractions,
    rotation_limit_state,
)

# At rest, lifted by less than counts, rocking, beyond 0.7 atan(B/h*_1), and over.
RUNS = pd.DataFrame(
    {
        "structure": "S",
        "model": "rigid",
        "level": 1.0,
        "status": ["no_uplift", "rocking", "rocking", "rocking", "overturned"],
        "max_rotation": [0.0, 5e-5, 0.02, 0.2, OVERTURNED],
        "nominal_overturning": [False, False, False, True, True],
        "tendon_utilisation": [0.5, 0.9, 1.0, 1.01, np.nan],
        "residual_rotation": [0.0, 0.0, -0.004, 0.006, np.nan],
    }
)


@pytest.mark.parametrize(
    ("state", "first"),
    [
        *[(UPLIFT, 1), (ROCKING, 2), (rotation_limit_state(0.1), 3), (NOMINAL, 3), (OVERTURNING, 4)],
        *[
            (TENDON_YIELD, 2),
            (residual_rotation_limit_state(0.003), 2),
            (residual_rotation_limit_state(0.005), 3),
            (residual_rotation_limit_state(1.0), 4),
        ],
    ],
    ids=lambda each: getattr(each, "label", each),
)
def test_runs_that_exceed_it(state, first):
    expected = [False] * first + [True] * (5 - first)
    assert state.exceeded(RUNS).tolist() == expected
    assert [bool(state.exceeded(row)) for row in RUNS.to_dict("records")] == expected


@pytest.mark.parametrize("state", [UPLIFT, NOMINAL, TENDON_YIELD, OVERTURNING], ids=lambda state: state.name)
def test_counts_of_stripes_are_of_it(state):
    assert rf.stripe_counts(RUNS, state.name)["n_exceeding"].tolist() == [state.exceeded(RUNS).sum()]
    assert rf.stripe_counts(RUNS, state).equals(rf.stripe_counts(RUNS, state.name))


def test_residual_rotations_have_stripes_and_a_figure():
    limit = residual_rotation_limit_state(0.005)
    assert rf.stripe_counts(RUNS, limit)["n_exceeding"].tolist() == [2]
    figure = rf.plot_stripes(RUNS, limit)
    assert figure.axes[0].get_ylabel() == r"$P(|θ_{\mathrm{res}}|>0.005\ \mathrm{rad})$"
    assert rf.plot_stripes(RUNS, "tendon_yield").axes[0].get_ylabel() == "P(tendon yield)"


def test_tables_without_residual_rotations():
    with pytest.raises(rf.InputError, match=r"^The runs have no column residual_rotation\. Tables of studies"):
        residual_rotation_limit_state(0.005).exceeded(RUNS.drop(columns="residual_rotation"))


def test_what_overturned_passed_every_rotation_below_a_right_angle():
    fallen = {"status": "overturned", "max_rotation": 1.5}  # the last sample that is known
    assert rotation_limit_state(1.55).exceeded(fallen)
    assert not rotation_limit_state(OVERTURNED).exceeded(fallen)
    assert not rotation_limit_state(1.55).exceeded(fallen | {"status": "rocking"})


def test_names():
    assert all(LIMIT_STATES[name].name == name for name in LIMIT_STATES)
    assert (OVERTURNING.label, OVERTURNING.rotation) == ("overturning", "|θ| = π/2")
    assert NOMINAL.label == NOMINAL.rotation == "0.7 atan(B/h*_1)"
    assert NOMINAL.symbol == r"θ_{\mathrm{max}}>0.7\,\mathrm{atan}(B/h^*_1)"
    assert nominal_rotation_symbol(0.5) == r"θ_{\mathrm{max}}>0.5\cdot0.7\,\mathrm{atan}(B/h^*_1)"
    assert rotation_limit_state(0.02).symbol == r"θ_{\mathrm{max}}>0.02\ \mathrm{rad}"
    assert [limit_state_label(limit) for limit in ("0.5 nominal", 0.02)] == ["0.5 nominal", "0.02 rad"]
    assert ROCKING.label == "uplift with θ_max > 1e-4 rad"
    assert math.isnan(ROCKING.threshold)  # it is not on the rotation alone
    assert math.isnan(NOMINAL.threshold)
    assert (TENDON_YIELD.label, residual_rotation_limit_state(0.005).label) == ("tendon yield", "residual 0.005 rad")


def test_a_base_on_springs_that_turns_without_uplift_does_not_rock():
    tilted = RUNS.assign(status=["no_uplift", "no_uplift", "no_uplift", "rocking", "overturned"])
    assert ROCKING.exceeded(tilted).tolist() == [False, False, False, True, True]
    assert rotation_limit_state(0.01).exceeded(tilted).tolist() == [
        False,
        False,
        True,
        True,
        True,
    ]  # it turned all the same


@pytest.mark.parametrize("groups", [1, 3, 7, 40])
def test_against_a_loop(groups):
    rng = np.random.default_rng(3)
    im, exceeded = rng.lognormal(size=23), rng.random(23) < 0.4
    found = observed_exceedance_fractions(im, exceeded, groups)
    runs = sorted(zip(im, exceeded, strict=True))
    sizes = [23 // groups + (place < 23 % groups) for place in range(groups)]
    ends = np.cumsum(sizes)
    parts = [runs[end - size : end] for size, end in zip(sizes, ends, strict=True) if size]
    expected = [
        (np.prod([m for m, _ in part]) ** (1 / len(part)), sum(e for _, e in part) / len(part)) for part in parts
    ]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
