"""Accelerations along a history: of the modes, of the rotation, of the floors; in contacts of no length too."""

import numpy as np
import pytest

from builders import frame_values
from rockflex import BoucWen, Frame, GroundMotion, InitialState, Restitution, load_suite, quiet_motion, simulate

GIVEN = frame_values(
    n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=7.0, damping_ratio=0.03
)
FRAME = Frame(**GIVEN)
HEIGHTS = 3.0 * np.arange(1.0, 4.0)
SHORT = GroundMotion(load_suite("el-centro-1940")[0].acceleration[60:160] * 2.5, 0.02)
CASES = {
    "MDOF-C": {},
    "2DOF-C": {},
    "3DOF-C-SI": {},
    "2DOF-C-BW": {"bouc_wen": BoucWen(0.04)},
    "2DOF-S-BW": {"bouc_wen": BoucWen(0.04)},
    "MDOF-S": {},
    "3DOF-S": {"impact": Restitution(0.6)},
    "fixed": {},
}


def dense(model, factor=100):
    return simulate(FRAME, SHORT.refined(factor), model, **CASES[model])


def inner(run):
    """Nodes whose two neighbours are in the same phase, half a sample of the record away from its corners."""
    step = np.diff(run.time)
    k = np.arange(1, run.time.size - 1)
    regular = np.abs(step[k] - step[k - 1]) < 1e-9
    regular &= (run.side[k] == run.side[k - 1]) & (run.side[k] == run.side[k + 1])
    corner = np.round(run.time[k] / 0.02) * 0.02
    return k[regular & (np.abs(run.time[k] - corner) > 0.5 * step.max())]


def slope(run, values, k):
    return (values[k + 1] - values[k - 1]).T / (run.time[k + 1] - run.time[k - 1])


@pytest.mark.parametrize("model", CASES)
def test_accelerations_are_the_rates_of_velocities(model):
    run = dense(model)
    k = inner(run)
    assert k.size > 0.9 * run.time.size
    if model != "fixed":
        assert run.n_impacts >= 2
        assert (run.side[k] != 0.0).sum() > 1000
    for velocity, acceleration in (
        (run.modal_velocity, run.modal_acceleration),
        (run.rotation_velocity[:, None], run.rotation_acceleration[:, None]),
    ):
        found = slope(run, velocity, k).T
        size = np.abs(acceleration).max(initial=1e-12)
        np.testing.assert_allclose(found, acceleration[k], rtol=0.0, atol=3e-4 * size)
    assert not run.rotation_acceleration[(run.side == 0.0) & np.append(np.diff(run.time) > 0.0, True)].any()


@pytest.mark.parametrize("model", [model for model in CASES if "-C" in model])
def test_floors_of_complete_models_move_as_equation_3(model):
    """Velocities across of -s B cos θ + h sin θ + u cos θ, differenced in time, and the ground's acceleration."""
    run = dense(model)
    p = run.history.model.properties
    u, du = run.modal_displacement @ p.floors.displacement.T, run.modal_velocity @ p.floors.displacement.T
    turn, spin = run.rotation[:, None], run.rotation_velocity[:, None]
    lever = run.side[:, None] * p.half_width * np.sin(turn) + HEIGHTS * np.cos(turn) - u * np.sin(turn)
    across = spin * lever + du * np.cos(turn)
    k = inner(run)
    total = slope(run, across, k).T + run.ground_acceleration[k, None]
    size = np.abs(run.floor_acceleration).max()
    np.testing.assert_allclose(total, run.floor_acceleration[k], rtol=0.0, atol=3e-4 * size)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S-BW", "fixed"])
def test_floors_of_simplified_models_move_as_their_sum(model):
    """h θ' + u', differenced in time, and the ground's acceleration."""
    run = dense(model)
    p = run.history.model.properties
    across = run.rotation_velocity[:, None] * HEIGHTS + run.modal_velocity @ p.floors.displacement.T
    k = inner(run)
    total = slope(run, across, k).T + run.ground_acceleration[k, None]
    size = np.abs(run.floor_acceleration).max()
    np.testing.assert_allclose(total, run.floor_acceleration[k], rtol=0.0, atol=3e-4 * size)


def of_no_length(run):
    """Nodes in contact between two phases of rocking at the same instant."""
    k = np.arange(1, run.time.size - 1)
    k = k[(run.side[k] == 0.0) & (run.time[k] == run.time[k - 1])]
    lifted = []
    for node in k:
        end = node
        while end + 1 < run.time.size and run.time[end + 1] == run.time[node] and run.side[end] == 0.0:
            end += 1
        if run.side[end] != 0.0 and run.side[node - 1] != 0.0:
            lifted.append(node)
    return np.array(lifted, dtype=int)


def bent():
    """A structure that comes down so bent that it lifts again at once."""
    return simulate(
        FRAME, quiet_motion(1.0, dt=0.01), "MDOF-S", initial=InitialState(1e-4, [0.08], rotation_velocity=-0.5)
    )


def test_a_contact_of_no_length_never_acts():
    """There the accelerations are those of what follows, and no peak of a history exceeds the run's own."""
    run = bent()
    contact = of_no_length(run)
    assert contact.size >= 1
    for node in contact:
        end = node
        while run.side[end] == 0.0:
            end += 1
        assert run.time[end] == run.time[node]
        for values in (run.floor_acceleration, run.modal_acceleration, run.rotation_acceleration):
            np.testing.assert_array_equal(values[node], values[end])


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
@pytest.mark.parametrize("seed", range(6))
def test_peaks_of_floors_are_those_of_a_fine_history(model, seed):
    rng = np.random.default_rng(seed)
    values = rng.standard_normal(60)
    frame = Frame(**{**GIVEN, "aspect_ratio": rng.uniform(4.0, 10.0), "period": rng.uniform(0.3, 1.0)})
    motion = GroundMotion(values * rng.uniform(2.0, 8.0) / np.abs(values).max(), 0.02)
    run, fine = (simulate(frame, each, model) for each in (motion, motion.refined(100)))
    for name in ("story_drift", "story_shear", "floor_acceleration"):
        largest = np.abs(getattr(fine, name)).max(axis=0)
        peak = getattr(run.floors, name)
        assert np.all(largest <= peak * (1.0 + 1e-9)), name
        np.testing.assert_allclose(largest, peak, rtol=2e-3)
        assert np.all(np.abs(getattr(run, name)).max(axis=0) <= peak * (1.0 + 1e-9)), name


def test_a_contact_of_no_length_makes_no_peak():
    run = bent()
    peak = np.abs(run.floor_acceleration).max(axis=0)
    assert np.all(peak <= run.floors.floor_acceleration * (1.0 + 1e-12))


@pytest.mark.parametrize("model", ["2DOF-C", "2DOF-S-BW"])
def test_peaks_of_nonlinear_floors(model):
    """Drifts and shears between samples too, accelerations at the nodes of the history."""
    run = simulate(FRAME, SHORT, model, **CASES[model])
    fine = dense(model)
    for name in ("story_drift", "story_shear"):
        largest = np.abs(getattr(fine, name)).max(axis=0)
        np.testing.assert_allclose(getattr(run.floors, name), largest, rtol=1e-4)
        assert np.all(np.abs(getattr(run, name)).max(axis=0) <= getattr(run.floors, name) * (1.0 + 1e-9))
    assert np.array_equal(run.floors.floor_acceleration, np.abs(run.floor_acceleration).max(axis=0))


def test_yielding_is_known_of_yielding_models_alone():
    assert not simulate(FRAME, SHORT, "MDOF-S").yielding.any()
    assert not simulate(FRAME, SHORT, "MDOF-C").yielding.any()
    run = simulate(FRAME, SHORT, "2DOF-S", bouc_wen=BoucWen(0.02))
    assert np.abs(run.yielding).max() > 0.9
    p = run.history.model.properties
    force = p.omega[0] ** 2 * (0.01 * run.modal_displacement[:, 0] + 0.99 * 0.02 * run.yielding)
    np.testing.assert_allclose(run.base_shear, p.effective_mass[0] * force, rtol=1e-12)
    np.testing.assert_allclose(run.base_moment, p.effective_mass[0] * p.effective_height[0] * force, rtol=1e-12)
    np.testing.assert_allclose(run.story_shear[:, 0], run.base_shear, rtol=0.03, atol=1e-9 * run.max_base_shear)


def test_a_block_has_no_floors():
    for model in ("rigid", "rigid-C"):
        run = simulate(FRAME, SHORT, model)
        assert run.floors is None
        assert not hasattr(run, "floor_acceleration")
        assert run.modal_acceleration.shape == (run.time.size, 0)
        assert run.rotation_acceleration.any()
