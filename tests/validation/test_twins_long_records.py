"""Fifteen modes through a minute and a half and more: no event is lost, and no digit that matters.

The twin looks at every quantity 64 times a sample, on exact sub-samples (`twins.fine_step`). In the frames with
soft beams the highest mode turns by up to 19 radians a sample. Measured: event times within 5e-9 s, peaks within
1e-10 (5e-11 in the worst of them).
"""

import numpy as np
import pytest

from rockflex import Frame, GroundMotion, load_suite, simulate
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

FAR, NEAR = "fema-p695-far-field", "fema-p695-near-field-no-pulse"
PEAKS = ("rotation", "top_displacement", "base_moment", "base_shear")


CASES = {
    "shear": ({"stiffness_ratio": np.inf, "aspect_ratio": 9.0, "period": 1.5}, FAR, ["FF-19-a"], 1.0),
    "shear, stiff": ({"stiffness_ratio": np.inf, "aspect_ratio": 8.0, "period": 0.7}, NEAR, ["NFNP-26-a"], 2.0),
    "flexure, three shocks": (
        {"stiffness_ratio": 0.0, "aspect_ratio": 8.0, "period": 1.2},
        FAR,
        ["FF-1-a", "FF-2-b", "FF-4-a"],
        1.0,
    ),
}


def setting(case):
    """A frame's arguments and its record: several embedded ones of the same step, one after the other."""
    changes, suite, names, factor = CASES[case]
    records = [load_suite(suite)[name] for name in names]
    assert len({record.dt for record in records}) == 1
    shaking = factor * np.concatenate([record.acceleration for record in records])
    frame = {"n_stories": 15, "story_height": 3.0, "story_mass": 40e3, "base_mass": 100e3, "damping_ratio": 0.02}
    return {**frame, **changes}, GroundMotion(shaking, records[0].dt)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_nothing_is_lost(case):
    given, record = setting(case)
    assert record.duration > 60.0
    mine = simulate(Frame(**given), record)
    twin = simulate_fine(**frame_properties(**given), acceleration=record.acceleration, dt=record.dt, substeps=64)
    assert mine.modal_displacement.shape[1] == 15
    assert (mine.status, mine.n_uplifts, mine.n_impacts) == ("rocking", twin.n_uplifts, twin.n_impacts)
    assert mine.n_impacts >= 15
    np.testing.assert_allclose(mine.uplift_times, twin.uplift_times, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(mine.impact_times, twin.impact_times, rtol=0.0, atol=1e-8)
    for name in PEAKS:
        assert getattr(mine, f"max_{name}") == pytest.approx(getattr(twin, f"max_{name}"), rel=1e-9, abs=0.0), name
        when = f"time_of_max_{name}"
        assert getattr(mine, when) == pytest.approx(getattr(twin, when), abs=1e-7), name


def test_many_modes_turn_within_a_sample():
    given, record = setting("flexure, three shocks")
    turns = Frame(**given).modal().omega * record.dt
    assert turns[-1] > 15.0
    assert np.count_nonzero(turns > 1.0) >= 10
