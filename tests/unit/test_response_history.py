"""Quantities of a history: mechanics that ties them to one another, nodes, and what a response without one says."""

import copy
import json
import pickle

import numpy as np
import pytest

from rockflex import Frame, GroundMotion, InputError, LumpedStructure, Response, RockingProperties, load_suite, simulate

MOTION = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:400] * 2.0, 0.02, name="El Centro")
FRAME = Frame(
    n_stories=4,
    story_height=3.0,
    story_mass=40e3,
    base_mass=60e3,
    stiffness_ratio=0.125,
    period=0.5,
    aspect_ratio=8.0,
    damping_ratio=0.03,
)
FULL_MASS = LumpedStructure(
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
    return RockingProperties(
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
    )


@pytest.fixture(scope="module")
def response():
    run = simulate(FRAME, MOTION, free_vibration=1.0)
    assert run.n_impacts > 5
    return run


@EACH
@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S", "fixed"])
def test_forces_of_the_floors_add_up(structure, model):
    run = simulate(structure, MOTION, model)
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
    run = simulate(structure, MOTION)
    lumped = structure if isinstance(structure, LumpedStructure) else structure.lumped
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
    run = simulate(structure, MOTION)
    lumped = structure if isinstance(structure, LumpedStructure) else structure.lumped
    displacement = np.cumsum(run.story_drift, axis=1)
    force = run.story_shear - np.column_stack((run.story_shear[:, 1:], np.zeros(len(run.time))))
    np.testing.assert_allclose(displacement @ lumped.stiffness, force, rtol=0.0, atol=1e-9 * np.abs(force).max())


def test_the_first_mode_alone_has_its_own_shape():
    run = simulate(FRAME, MOTION, "2DOF-S")
    shape = FRAME.modal(1).shapes[:, 0]
    displacement = np.cumsum(run.story_drift, axis=1)
    np.testing.assert_allclose(
        displacement, np.outer(displacement[:, -1], shape / shape[-1]), atol=1e-12 * run.max_top_displacement
    )
    assert run.modal_displacement.shape == (len(run.time), 1)


def test_floor_accelerations_are_those_of_the_velocities(response):
    """Between neighbouring nodes of one phase the total velocity changes by the mean acceleration."""
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


def test_nodes_of_a_history(response):
    history, time = response.history, response.time
    n = history.model.properties.n_modes
    assert history.nodes.shape == (len(time), 2 * n + 5)
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
        run = simulate(FRAME, MOTION.scaled(scale), free_vibration=1.0)
        times, values = MOTION.dt * np.arange(450), scale * np.append(MOTION.acceleration, np.zeros(50))
        assert np.all(np.diff(run.time) >= 0.0)
        assert np.isin(times, run.time).all()
        assert run.end_time == run.time[-1]
        place = np.searchsorted(run.time, times)
        assert np.array_equal(run.ground_acceleration[place], values)


def test_response_and_history_share_their_quantities(response):
    for name in ("time", "side", "rotation", "base_moment", "energy", "floor_acceleration"):
        assert getattr(response, name) is getattr(response.history, name) or np.array_equal(
            getattr(response, name), getattr(response.history, name)
        )
    assert response.energy is response.energy
    assert repr(response).startswith("Response(MDOF-S under 'El Centro': rocking, θ_max=")
    for name in ("nothing", "_private", "nodes", "__array__"):
        with pytest.raises(AttributeError, match=f"'Response' object has no attribute '{name}'"):
            getattr(response, name)
    for twin in (copy.copy(response), copy.deepcopy(response), pickle.loads(pickle.dumps(response))):
        assert twin.peaks() == response.peaks()
        assert np.array_equal(twin.history.nodes, response.history.nodes)
    with pytest.raises(AttributeError):
        response.max_rotation = 0.0


def test_peaks_are_a_row_of_a_table(response):
    row = response.peaks()
    assert json.loads(json.dumps(row)) == row
    assert set(row) >= {"model", "motion", "status", "max_rotation", "n_impacts", "end_time", "settled"}
    assert all(getattr(response, name) == value for name, value in row.items())


def test_nominal_overturning_is_a_flag_of_its_own():
    for factor in (1.0, 8.0):
        run = simulate(FRAME, MOTION.scaled(factor), output="peaks")
        limit = 0.7 * np.arctan(1.0 / 8.0)
        assert run.nominal_overturning == (run.max_rotation > limit)
    assert run.nominal_overturning


QUANTITIES = (
    "time", "rotation", "rotation_velocity", "side", "ground_acceleration", "modal_displacement", "modal_velocity",
    "top_displacement", "base_moment", "base_shear", "uplift_times", "impact_times", "story_drift", "story_shear",
    "floor_acceleration", "energy",
)  # fmt: skip


def test_peaks_alone_have_no_history():
    run = simulate(FRAME, MOTION, output="peaks")
    assert run.history is None
    assert run.floors is None
    for name in QUANTITIES:
        text = f'This response keeps peaks only, so it has no {name}. Simulate with output="history".'
        with pytest.raises(InputError) as caught:
            getattr(run, name)
        assert str(caught.value) == text


def test_no_floors_no_story_drifts():
    run = simulate(bare(FRAME), MOTION)
    assert run.floors is None
    for name in ("story_drift", "story_shear", "floor_acceleration"):
        with pytest.raises(InputError, match=r"name no floors, so there are no story drifts.*Simulate a Frame or"):
            getattr(run, name)
    assert run.base_shear.shape == run.time.shape


def test_what_is_observed_does_not_change_the_motion(response):
    """Neither the peaks that are tracked nor the nodes that are kept."""
    without = simulate(bare(FRAME), MOTION, free_vibration=1.0)
    size = np.abs(response.history.nodes).max(axis=0)
    np.testing.assert_allclose(without.history.nodes / size, response.history.nodes / size, rtol=0.0, atol=1e-15)
    assert simulate(bare(FRAME), MOTION, free_vibration=1.0, output="peaks").peaks() == without.peaks()
    # Floors call for closer looks, where other peaks may be met a rounding higher.
    for run in (without, simulate(FRAME, MOTION, free_vibration=1.0, output="peaks")):
        for name, value in response.peaks().items():
            if name.startswith("max_"):
                value = pytest.approx(value, rel=1e-13)
            elif name.startswith("time_of_max"):
                value = pytest.approx(value, abs=1e-7)
            assert getattr(run, name) == value
        assert run.max_rotation == response.max_rotation


def test_is_a_response(response):
    assert isinstance(response, Response)
