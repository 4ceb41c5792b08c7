"""The motion at one place after the other inside all intervals, against that place by itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from builders import make_frame
from rockflex.models import HEADER
from rockflex.models._kept import _codes
from rockflex.solve import ClosedForm

PLACES = [0.0, 0.05, 0.31, 0.5, 0.77, 1.0]


@pytest.mark.parametrize("ground", [None, rf.Ground(friction=0.1)])
def test_places_one_after_the_other(ground):
    shaking = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    motion = rf.GroundMotion(shaking.acceleration[:600], shaking.dt, vertical=0.4 * shaking.acceleration[300:900])
    response = rf.simulate(make_frame(), motion, "MDOF-S", output="history", ground=ground)
    model, states = response.history.model, response.history.states
    intervals = ClosedForm(model).intervals(states)
    assert intervals.series
    whole, step = np.arange(states.shape[0] - 1), np.zeros(states.shape[0] - 1)
    for part in (*intervals.parts, *intervals.series):
        step[part.rows] = part.steps
    for place, found in zip(PLACES, intervals.along(PLACES), strict=True):
        alone = intervals.after(whole, place * step)
        size = np.abs(states[:, HEADER:]).max(axis=0) + 1e-12
        assert np.abs((found - alone) / size).max() < 1e-10  # rounding of two ways through the same series
        assert np.array_equal(intervals.at(place), next(intervals.along([place])))


def test_falling_places_begin_anew():
    motion = rf.GroundMotion([0.0, 3.0, -3.0, 2.0, 0.0], 0.2, vertical=[0.0, 1.0, -1.0, 1.0, 0.0])
    response = rf.simulate(make_frame(), motion, "MDOF-S", output="history")
    intervals = ClosedForm(response.history.model).intervals(response.history.states)
    up, down = list(intervals.along([0.2, 0.9])), list(intervals.along([0.9, 0.2]))
    assert np.allclose(up[0], down[1], rtol=1e-12, atol=1e-15)
    assert np.allclose(up[1], down[0], rtol=1e-12, atol=1e-15)


@given(st.integers(1, 60), st.integers(1, 70), st.integers(0, 2**32 - 1))
def test_codes_tell_rows_apart(rows, columns, seed):
    branches = np.random.default_rng(seed).integers(-2, 5, (rows, columns))
    branches[rows // 2] = branches[0]
    _, expected = np.unique(branches, axis=0, return_inverse=True)
    _, found = np.unique(_codes(branches), return_inverse=True)
    assert np.array_equal(found, expected.ravel())
    assert _codes(np.zeros((0, 3), dtype=np.int64)).size == 0
