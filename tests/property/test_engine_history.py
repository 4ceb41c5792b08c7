"""Peaks and histories of the same run."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from rockflex import Frame, InitialState, simulate
from rockflex.models._state_layout import GROUND, HEADER
from strategies import frame_arguments, stretches

settings_ = settings(max_examples=80, deadline=None)

frames = frame_arguments(8, 2.5, damping_ratio=st.floats(0.0, 0.1)).map(lambda given: Frame(**given))
starts = st.one_of(st.none(), st.builds(InitialState, rotation=st.floats(-0.2, 0.2).filter(lambda x: abs(x) > 1e-3)))
models = st.sampled_from(["MDOF-S", "2DOF-S"])


@pytest.mark.slow
@settings_
@given(frames, stretches(), models, starts)
def test_peaks_are_those_of_the_history(structure, motion, model, start):
    """No value of the history is above its peak, and the peak is above the samples by no more than their sag."""
    run = simulate(structure, motion, model, initial=start)
    tied = run.history.model
    p = tied.properties
    vector = np.column_stack((run.history.states[:, HEADER:], run.history.states[:, GROUND], np.ones(run.time.size)))
    rates = np.zeros((run.time.size, p.n_modes + 1))
    for side in tied.sides:
        on = run.side == side
        rates[on] = vector[on] @ tied.accelerations(tied.start(side)).T
    modal, angular = rates[:, :-1], rates[:, -1]
    shear = p.effective_mass * p.omega**2
    second = {
        "rotation": angular,
        "top_displacement": modal @ p.top_ordinate,
        "base_moment": modal @ (shear * p.effective_height),
        "base_shear": modal @ shear,
    }
    assume(p.omega[-1] * motion.dt < 0.3)
    for name, curvature in second.items():
        peak, values = getattr(run, f"max_{name}"), np.abs(getattr(run, name))
        assert values.max() <= peak * (1.0 + 1e-11) + (1e-13 if name == "rotation" else 0.0)
        # Between two nodes the curvature passes that of the nodes by little, the modes being slow against dt.
        assert peak <= values.max() + motion.dt**2 / 8.0 * 1.5 * np.abs(curvature).max()
        near = np.abs(run.time - getattr(run, f"time_of_max_{name}")) <= motion.dt * (1.0 + 1e-9)
        assert peak <= values[near].max() + motion.dt**2 / 8.0 * 1.5 * np.abs(curvature).max()


@settings_
@given(frames, stretches(), models, starts)
def test_floors(structure, motion, model, start):
    run = simulate(structure, motion, model, initial=start)
    assert np.all(np.abs(run.story_drift).max(axis=0) <= run.floors.story_drift * (1.0 + 1e-11))
    assert np.all(np.abs(run.story_shear).max(axis=0) <= run.floors.story_shear * (1.0 + 1e-11))
    # A contact that is over at once, between an impact and an uplift, is a node but no motion.
    lasting = np.ones(run.time.size, dtype=bool)
    alike = np.flatnonzero((run.time[1:] == run.time[:-1]) & (run.side[1:] == 0.0) & (run.side[:-1] == 0.0))
    lasting[alike] = lasting[alike + 1] = False
    acceleration = np.abs(run.floor_acceleration[lasting]).max(axis=0)
    assert np.all(acceleration <= run.floors.floor_acceleration * (1.0 + 1e-10))


@settings_
@given(frames, stretches(), models, starts, st.floats(0.0, 1.0))
def test_nodes(structure, motion, model, start, free):
    run = simulate(structure, motion, model, initial=start, free_vibration=free)
    assert np.all(np.diff(run.time) > -1e-12)
    samples = motion.dt * np.arange(motion.acceleration.size + np.ceil(free / motion.dt - 1e-9))
    samples = samples[samples <= run.end_time + 1e-9]
    place = np.searchsorted(run.time, samples - 1e-9)
    np.testing.assert_allclose(run.time[place], samples, rtol=0.0, atol=1e-12)
    recorded = samples <= motion.duration + 1e-9
    size = np.abs(motion.acceleration).max()
    np.testing.assert_allclose(
        run.ground_acceleration[place[recorded]],
        motion.acceleration[: recorded.sum()],
        rtol=0.0,
        atol=1e-13 * size,
    )
    contact = run.side == 0.0
    assert not run.rotation[contact].any()
    assert not run.rotation_velocity[contact].any()
    assert set(run.side) <= {-1.0, 0.0, 1.0}
    assert np.all(run.side * run.rotation >= 0.0)
    assert np.all(np.abs(run.rotation) <= 0.5 * np.pi)
    assert (run.uplift_times.size, run.impact_times.size) == (run.n_uplifts, run.n_impacts)
    # Uplifts and impacts take turns; the side changes at them alone, and time stands still.
    jumps = np.flatnonzero(np.diff(run.side) != 0.0)
    assert np.all(np.diff(run.time)[jumps] == 0.0)
    assert np.all((run.side[jumps] == 0.0) != (run.side[jumps + 1] == 0.0))
    assert run.n_uplifts + (start is not None) - run.n_impacts == int(run.side[-1] != 0.0)
    # Displacements are continuous, and within a phase the velocities are.
    still = np.flatnonzero(np.diff(run.time) == 0.0)
    assert np.array_equal(run.modal_displacement[still], run.modal_displacement[still + 1])
    assert abs(run.end_time - run.time[-1]) < 1e-12
    assert (run.status == "overturned") == (abs(run.rotation[-1]) == 0.5 * np.pi)


@settings_
@given(frames, stretches(), models, starts)
def test_peaks_do_not_need_a_history(structure, motion, model, start):
    """Other rows may change when a peak is searched, and with it the rounding of the peak."""
    assume(structure.damping_ratio >= 0.01)
    kept = simulate(structure, motion, model, initial=start)
    alone = simulate(structure, motion, model, output="peaks", initial=start)
    assert (alone.status, alone.n_uplifts, alone.n_impacts) == (kept.status, kept.n_uplifts, kept.n_impacts)
    assert abs(alone.end_time - kept.end_time) < 1e-9
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear"):
        one, other = getattr(alone, name), getattr(kept, name)
        assert abs(one - other) <= 1e-9 * other + (1e-13 if name == "max_rotation" else 0.0)
    properties = structure.rocking()
    object.__setattr__(properties, "floors", None)
    bare = simulate(properties, motion, model, initial=start)
    alone = simulate(properties, motion, model, output="peaks", initial=start)
    for name, other in alone.peaks().items():
        one, weight = bare.peaks()[name], properties.m_tot * 9.81
        if not isinstance(other, float) or name.startswith("time_of"):
            continue  # of two equal peaks either may be the first
        tolerance = 1e-13 * (weight if name == "min_vertical_reaction" else abs(other)) + 1e-15
        assert one == pytest.approx(other, rel=0.0, abs=100.0 * tolerance, nan_ok=True), name
