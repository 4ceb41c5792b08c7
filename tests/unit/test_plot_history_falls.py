import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from drawing import notes, spans, uplift_intervals
from rockflex.plot import plot_history

FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]
# Rotation at which the static resisting moment vanishes, from the masses by hand.
HALF_WIDTH = FRAME.modal().effective_height[0] / 10.0
BALANCE = 6 * 40e3 * HALF_WIDTH / (40e3 * 3.0 * (1 + 2 + 3 + 4 + 5))


@pytest.fixture(scope="module")
def fallen():
    """Released beyond the amplitude from which it can return, after one return."""
    quiet = rf.quiet_motion(20.0)
    return rf.simulate(FRAME, quiet, "2DOF-S", initial=rf.InitialState(rotation=0.05, rotation_velocity=0.5))


@pytest.fixture(scope="module")
def returned():
    return rf.simulate(FRAME, rf.quiet_motion(20.0), "3DOF-S", initial=rf.InitialState(rotation=0.05))


def test_overturning_squashes_no_other_curve(fallen, returned):
    assert (fallen.status, returned.status) == ("overturned", "rocking")
    figure = plot_history([fallen, returned])
    rotation, displacement, total, moment, _ = figure.axes
    high = rotation.get_ylim()[1]
    assert high == pytest.approx(1.12 * returned.max_rotation)
    (triangle,) = (line for line in rotation.get_lines() if line.get_marker() in "^v")
    when = float(np.interp(high, np.abs(fallen.rotation), fallen.time))
    assert float(triangle.get_xdata()[0]) == pytest.approx(when, rel=1e-9)
    assert triangle.get_marker() == "^"
    assert triangle.get_ydata()[0] == high
    for axes in figure.axes:
        (line,) = (line for line in axes.get_lines() if line.get_linestyle() == ":")
        assert list(line.get_xdata()) == [fallen.end_time] * 2
    assert f"overturned, {fallen.end_time:.2f} s" in notes(rotation)
    before = fallen.time < np.min(fallen.time[np.abs(fallen.rotation) > BALANCE])
    for axes, values, factor, name in (
        (displacement, fallen.top_displacement, 1.0, "top_displacement"),
        (total, fallen.total_top_displacement, 1.0, "total_top_displacement"),
        (moment, fallen.base_moment, 1e6, "base_moment"),
    ):
        largest = max(np.abs(values[before]).max(), getattr(returned, f"max_{name}")) / factor
        assert axes.get_ylim()[1] == pytest.approx(1.12 * largest)
    assert np.abs(fallen.base_moment).max() / 1e6 > moment.get_ylim()[1]


def test_overturning_to_the_left_points_down():
    initial = rf.InitialState(rotation=-0.05, rotation_velocity=-0.5)
    left = rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=initial)
    assert left.status == "overturned"
    axes = plot_history(left).axes[0]
    (triangle,) = (line for line in axes.get_lines() if line.get_marker() in "^v")
    assert triangle.get_marker() == "v"
    assert triangle.get_ydata()[0] == axes.get_ylim()[0]


def test_where_all_overturn_the_axis_reaches_the_rotation_of_balance(fallen):
    assert plot_history(fallen).axes[0].get_ylim()[1] == pytest.approx(1.12 * BALANCE)
    fixed = rf.simulate(FRAME, rf.quiet_motion(20.0), "fixed")
    assert plot_history([fallen, fixed]).axes[0].get_ylim()[1] == pytest.approx(1.12 * BALANCE)


def test_a_fall_that_the_record_cuts_short_squashes_nothing_either(returned):
    initial = rf.InitialState(rotation=0.05, rotation_velocity=0.5)
    falling = rf.simulate(FRAME, rf.quiet_motion(1.0), "2DOF-S", initial=initial)
    assert falling.status == "rocking"
    assert falling.max_rotation > BALANCE
    axes = plot_history([falling, returned]).axes[0]
    assert axes.get_ylim()[1] == pytest.approx(1.12 * returned.max_rotation)
    assert any(line.get_marker() == "^" for line in axes.get_lines())


def test_a_run_beyond_balance_from_the_start_is_shown_whole():
    start = rf.InitialState(rotation=1.2 * BALANCE)
    response = rf.simulate(FRAME, rf.quiet_motion(20.0), "2DOF-S", initial=start)
    assert response.status == "overturned"
    panels = plot_history(response).axes
    assert panels[0].get_ylim()[1] > 0.5 * math.pi
    assert panels[1].get_ylim()[1] > response.max_top_displacement


def test_phases_open_at_both_ends_are_shaded(returned):
    initial = rf.InitialState(rotation=0.05)
    short = rf.simulate(FRAME, rf.quiet_motion(0.5), "2DOF-S", initial=initial)
    np.testing.assert_allclose(spans(plot_history(short).axes[1].collections[0]), [[0.0, 0.5]])
    expected = uplift_intervals(returned)
    assert expected[0, 0] == 0.0
    np.testing.assert_allclose(spans(plot_history(returned).axes[1].collections[0]), expected, rtol=1e-12)
