"""Where the masses are and what the ground gives, against Newton's laws in coordinates of the ground."""

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins.newton import Complete, Simplified, integrate, masses_of

FRAME = frame_values(
    n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=6.0, damping_ratio=0.03
)
RECORDS = {"el-centro-1940": (0, slice(60, 210), 2.0), "fema-p695-far-field": (1, slice(500, 1000), 2.0)}


def motion(suite):
    place, cut, factor = RECORDS[suite]
    record = rf.load_suite(suite)[place]
    return rf.GroundMotion(factor * record.acceleration[cut], record.dt)


@pytest.mark.parametrize("suite", RECORDS)
@pytest.mark.parametrize(("label", "kind", "bound"), [("MDOF-S", Simplified, 1e-9), ("MDOF-C", Complete, 1e-9)])
def test_against_the_masses_in_coordinates_of_the_ground(label, kind, bound, suite):
    record = motion(suite)
    twin = integrate(kind(masses_of(**FRAME)), record.acceleration, record.dt)
    frame = rf.Frame(**FRAME)
    run = rf.simulate(frame, record, label)
    peaks = rf.simulate(frame, record, label, "peaks")
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert twin.n_impacts >= 2
    np.testing.assert_allclose(run.floors.total_floor_displacement, twin.places, rtol=bound)
    for response in (run, peaks):
        assert response.max_rotation == pytest.approx(twin.rotation, rel=bound)
        assert response.max_total_top_displacement == pytest.approx(twin.places[-1], rel=bound)
        # Accelerations carry the error of the motion times the square of the fastest frequency.
        assert response.max_horizontal_reaction == pytest.approx(twin.horizontal, rel=1e2 * bound)
        assert response.min_vertical_reaction == pytest.approx(twin.vertical, rel=1e2 * bound)
