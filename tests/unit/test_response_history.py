"""Quantities of a history: mechanics that ties them to one another, and its states."""

import copy
import pickle

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:400] * 2.0, 0.02, name="El Centro")
FRAME = make_frame(n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
FULL_MASS = rf.LumpedStructure(
    [[3e4, 4e3, 0.0], [4e3, 2.5e4, 3e3], [0.0, 3e3, 2e4]],
    [[9e7, -4e7, 0.0], [-4e7, 7e7, -3e7], [0.0, -3e7, 3e7]],
    [4.0, 7.0, 11.0],
    base_mass=2e4,
    half_width=1.1,
    damping_ratio=[0.02, 0.03, 0.05],
)
STRUCTURES = {"frame": FRAME, "full mass matrix": FULL_MASS}
EACH = pytest.mark.parametrize("structure", STRUCTURES.values(), ids=STRUCTURES)


def bare(structure):
    """The properties without their floors, as from any finite element program."""
    p = structure.rocking()
    return rf.RockingProperties(
        p.omega,
        p.effective_mass,
        p.effective_height,
        p.top_ordinate,
        p.i_theta,
        p.l0r,
        p.m_tot,
        p.half_width,
        p.zeta,
        p.translational_inertia,
        top_height=p.top_height,
    )


@pytest.fixture(scope="module")
def response():
    run = rf.simulate(FRAME, MOTION, free_vibration=1.0)
    assert run.n_impacts > 5
    return run


@EACH
@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S", "fixed"])
def test_forces_of_the_floors_add_up(structure, model):
    run = rf.simulate(structure, MOTION, model)
    heights = run.history.model.properties.floors.heights
    force = run.story_shear - np.column_stack((run.story_shear[:, 1:], np.zeros(len(run.time))))
    size = run.max_base_shear
    np.testing.assert_allclose(run.story_shear[:, 0], run.base_shear, rtol=0.0, atol=1e-12 * size)
    np.testing.assert_allclose(force @ heights, run.base_moment, rtol=0.0, atol=1e-12 * run.max_base_moment)
    drift = run.story_drift.sum(axis=1)
    np.testing.assert_allclose(drift, run.top_displacement, rtol=0.0, atol=1e-12 * run.max_top_displacement)
    assert run.floors.story_shear[0] == pytest.approx(run.max_base_shear, rel=1e-12)


@EACH
def test_floors_move_as_their_forces_say(structure):
    """With all modes, mass times total acceleration is minus the elastic and damping force, on the ground or off it."""
    run = rf.simulate(structure, MOTION)
    lumped = structure if isinstance(structure, rf.LumpedStructure) else structure.lumped
    p = run.history.model.properties
    mass = lumped.masses if lumped.masses.ndim == 2 else np.diag(lumped.masses)
    elastic = run.modal_displacement @ p.floors.force.T
    damped = (run.modal_velocity * 2.0 * p.zeta / p.omega) @ p.floors.force.T
    # In a full mass matrix, rows count: M (a ι + h θ'' + u'') is what each freedom is pushed with.
    np.testing.assert_allclose(
        run.floor_acceleration @ mass, -(elastic + damped), rtol=0.0, atol=1e-10 * np.abs(elastic).max()
    )
    assert {-1.0, 0.0, 1.0} == set(run.side)


@EACH
def test_stiffness_gives_the_forces(structure):
    run = rf.simulate(structure, MOTION)
    lumped = structure if isinstance(structure, rf.LumpedStructure) else structure.lumped
    displacement = np.cumsum(run.story_drift, axis=1)
    force = run.story_shear - np.column_stack((run.story_shear[:, 1:], np.zeros(len(run.time))))
    np.testing.assert_allclose(displacement @ lumped.stiffness, force, rtol=0.0, atol=1e-9 * np.abs(force).max())


def test_the_first_mode_alone_has_its_own_shape():
    run = rf.simulate(FRAME, MOTION, "2DOF-S")
    shape = FRAME.modal(1).shapes[:, 0]
    displacement = np.cumsum(run.story_drift, axis=1)
    np.testing.assert_allclose(
        displacement, np.outer(displacement[:, -1], shape / shape[-1]), atol=1e-12 * run.max_top_displacement
    )
    assert run.modal_displacement.shape == (len(run.time), 1)


def test_floor_accelerations_are_those_of_the_velocities(response):
    """Between neighbouring states of one phase the total velocity changes by the mean acceleration."""
    p = response.history.model.properties
    t, a = response.time, response.ground_acceleration
    ground = np.concatenate(([0.0], np.cumsum(np.diff(t) * 0.5 * (a[1:] + a[:-1]))))
    velocity = response.modal_velocity @ p.floors.displacement.T
    velocity += np.outer(response.rotation_velocity, p.floors.heights) + ground[:, None]
    # Nodes of one phase, a sample apart.
    inside = (response.side[1:] == response.side[:-1]) & (np.diff(t) > 0.9 * MOTION.dt)
    step = np.diff(t)[inside][:, None]
    middle = 0.5 * (response.floor_acceleration[1:] + response.floor_acceleration[:-1])[inside]
    fastest = p.omega[-1] * 3.0
    allowed = (fastest * MOTION.dt) ** 2 / 12.0 * np.abs(response.floor_acceleration).max()
    assert np.all(np.abs(np.diff(velocity, axis=0)[inside] / step - middle) <= allowed)


def test_states_of_a_history(response):
    history, time = response.history, response.time
    n = history.model.properties.n_modes
    assert history.states.shape == (len(time), 2 * n + 6)
    for name in ("modal_displacement", "modal_velocity"):
        assert getattr(response, name).shape == (len(time), n)
    assert np.all(np.diff(time) > -1e-12)
    # Every sample is there, the record's last one with both its accelerations.
    samples = MOTION.dt * np.arange(400 + 50)
    assert np.isin(samples.round(9), time.round(9)).all()
    end = np.flatnonzero(np.abs(time - MOTION.duration) < 1e-9)
    np.testing.assert_allclose(response.ground_acceleration[end], [MOTION.acceleration[-1], 0.0])
    # Both sides of every event.
    assert len(time) == 450 + 1 + 2 * (response.n_uplifts + response.n_impacts)
    assert response.uplift_times.size == response.n_uplifts
    assert response.impact_times.size == response.n_impacts
    jumps = np.flatnonzero(np.diff(response.side) != 0.0)
    np.testing.assert_array_equal(time[jumps], time[jumps + 1])
    assert not response.rotation[jumps].any()
    assert not response.rotation[response.side == 0.0].any()
    assert not response.rotation_velocity[response.side == 0.0].any()
    assert np.all(response.side * response.rotation >= 0.0)
    # The law of impact (Eq. 25), and no jump of anything at uplift.
    heights = history.model.properties.effective_height
    for k in jumps:
        impact = response.side[k] != 0.0
        change = response.modal_velocity[k + 1] - response.modal_velocity[k]
        np.testing.assert_allclose(change, heights * response.rotation_velocity[k] * impact, rtol=1e-12, atol=1e-15)
        assert np.array_equal(response.modal_displacement[k], response.modal_displacement[k + 1])
        assert impact or response.rotation_velocity[k] == 0.0
    assert response.end_time == pytest.approx(time[-1], abs=1e-12)


def test_samples_stand_at_their_times():
    for scale in (1.0, 1.7):
        run = rf.simulate(FRAME, MOTION.scaled(scale), free_vibration=1.0)
        times, values = MOTION.dt * np.arange(450), scale * np.append(MOTION.acceleration, np.zeros(50))
        assert np.all(np.diff(run.time) >= 0.0)
        assert np.isin(times, run.time).all()
        assert run.end_time == run.time[-1]
        place = np.searchsorted(run.time, times)
        assert np.array_equal(run.ground_acceleration[place], values)


def test_no_floors_no_story_drifts():
    run = rf.simulate(bare(FRAME), MOTION)
    assert run.floors is None
    for name in ("story_drift", "story_shear", "floor_acceleration"):
        for source in (run, run.history):
            with pytest.raises(
                rf.InputError, match=r"include no floors, so there are no story drifts.*Simulate a Frame"
            ):
                getattr(source, name)
            assert not hasattr(source, name)
    assert run.base_shear.shape == run.time.shape


def test_what_is_observed_does_not_change_the_motion(response):
    """Neither the peaks that are tracked nor the states that are kept."""
    without = rf.simulate(bare(FRAME), MOTION, free_vibration=1.0)
    size = np.maximum(np.abs(response.history.states).max(axis=0), 1e-300)  # no vertical motion
    np.testing.assert_allclose(without.history.states / size, response.history.states / size, rtol=0.0, atol=1e-15)
    assert rf.simulate(bare(FRAME), MOTION, free_vibration=1.0, output="peaks").peaks() == without.peaks()
    # Floors call for closer looks, where other peaks may be met a rounding higher.
    for run in (without, rf.simulate(FRAME, MOTION, free_vibration=1.0, output="peaks")):
        for name, value in response.peaks().items():
            if name.startswith(("max_", "min_")):
                value = pytest.approx(value, rel=1e-13)
            elif name.startswith("time_of_"):
                value = pytest.approx(value, abs=1e-7)
            assert getattr(run, name) == value
        assert run.max_rotation == response.max_rotation


ARRAYS = (
    "states", "time", "side", "ground_acceleration", "modal_displacement", "modal_velocity", "rotation",
    "rotation_velocity", "top_displacement", "base_moment", "base_shear", "story_drift", "story_shear",
    "floor_acceleration",
)  # fmt: skip


def test_histories_are_read_only(response):
    """Copies too; and nobody else holds the array."""
    history = response.history
    for each in (history, copy.copy(history), copy.deepcopy(history), pickle.loads(pickle.dumps(history))):
        for name in ARRAYS:
            with pytest.raises(ValueError, match="read-only"):
                getattr(each, name)[-1] = 0.0
        for values in vars(each.energy).values():
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 0.0
        assert np.array_equal(each.states, history.states)
    mine = history.states.copy()
    kept = rf.History(history.model, mine)
    mine[:] = 0.0
    assert np.array_equal(kept.states, history.states)


def test_a_history_in_short(response):
    text = f"History(MDOF-S, {len(response.time)} states over 8.98 s, {response.n_uplifts} uplifts)"
    assert repr(response.history) == text
    start = rf.InitialState(rotation=0.01)
    run = rf.simulate(FRAME, rf.quiet_motion(0.05, dt=0.01), "2DOF-S", initial=start)
    assert repr(run.history) == "History(2DOF-S, 6 states over 0.05 s, 0 uplifts)"


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda states: states[:, 1:], r"states must have the shape \(\d+, 14\), but an array of shape \(\d+, 13\)"),
        (lambda states: states[:0], r"states must have the shape \(1, 14\), but an array of shape \(0, 14\)"),
        (lambda states: 3.0, r"states must have the shape \(1, 14\), but an array of shape \(\)"),
        (lambda states: states + np.inf, r"states must be finite, but its entry \[0, 0\] is inf"),
        (lambda states: "none", "states must be a matrix of numbers in SI units, but str was given"),
    ],
)
def test_states_that_are_none(response, change, text):
    with pytest.raises(rf.InputError, match=text):
        rf.History(response.history.model, change(response.history.states))
