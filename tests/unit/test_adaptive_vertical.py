"""Integrated models on ground that also moves vertically: against SciPy, other gravities, and the energy balance."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import NO_MODES, frame_values
from rockflex.models import Model, parse_model
from rockflex.models._prepared_model import PreparedModel
from rockflex.models._reactions import reactions
from rockflex.models._values_at_states import accelerations_at_states, acting_side
from rockflex.response._peaks import tracked_quantities
from rockflex.response._respond import response_of_solution
from twins import impact_laws
from twins.complete import complete_frame, simulate_complete
from twins.complete_model import BoucWen, CompleteModel, Shaking, Structure

FRAME = frame_values(stiffness_ratio=0.125, period=0.7, aspect_ratio=7.0)
SPRING = (0.04, 0.02, 0.5, 0.5, 8.0)
SIMPLE, COMPLETE = impact_laws.SimplifiedVVEL(), impact_laws.CompleteVVEL()
YIELDING = {"bouc_wen": BoucWen(*SPRING)}
CASES = {
    # label: modes, impact law and further options of the twin
    "2DOF-C": (1, {"law": COMPLETE}),
    "MDOF-C-SI": (5, {"law": SIMPLE}),
    "3DOF-C-E": (2, {"law": COMPLETE}),
    "rigid-C": (0, {"law": impact_laws.Restitution(0.9)}),
    "2DOF-S-BW": (1, {"law": SIMPLE, "complete": False, **YIELDING}),
    "2DOF-C-BW": (1, {"law": COMPLETE, **YIELDING}),
    "1DOF-fixed-BW": (1, {"law": SIMPLE, "complete": False, "lifts": False, **YIELDING}),
}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")


def record():
    """A stretch of El Centro, and another one upwards at two thirds of its strength."""
    found = rf.load_suite("el-centro-1940")[0]
    return 2.5 * found.acceleration[60:210], 1.7 * found.acceleration[160:310], found.dt


def model_of(label, **options):
    yields = {"bouc_wen": rf.BoucWen(*SPRING)} if label.endswith("BW") else {}
    return parse_model(label).of(rf.Frame(**FRAME).rocking(), **yields, **options)


def run(model, acceleration, dt, vertical=None, *, history=True, **options):
    tracked = tracked_quantities(model)
    engine = PreparedModel(model, tracked.peaks.quantities)
    return response_of_solution(
        model, "", engine.run(acceleration, dt, vertical=vertical, history=history, **options), tracked
    )


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_against_scipy(case):
    n_modes, told = CASES[case]
    horizontal, vertical, dt = record()
    given = complete_frame(**FRAME, n_modes=max(n_modes, 1)) | (NO_MODES if n_modes == 0 else {})
    twin = simulate_complete(**given, **told, acceleration=horizontal, vertical=vertical, dt=dt, free=0.4)
    level = simulate_complete(**given, **told, acceleration=horizontal, dt=dt, free=0.4)
    model = model_of(case, **({"impact": rf.Restitution(0.9)} if n_modes == 0 else {}))
    found = run(model, horizontal, dt, vertical, free_vibration=0.4)
    assert (found.n_uplifts, found.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert twin.n_impacts >= 2 or "fixed" in case
    for name in PEAKS:
        assert getattr(found, name) == pytest.approx(getattr(twin, name), rel=1e-8, abs=1e-14), name
    np.testing.assert_allclose(found.uplift_times, twin.uplift_times, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(found.impact_times, twin.impact_times, rtol=0.0, atol=1e-7)
    assert "fixed" in case or twin.max_rotation != pytest.approx(level.max_rotation, rel=1e-3)
    peaks = run(model, horizontal, dt, vertical, history=False, free_vibration=0.4)
    for name in (*PEAKS, "min_vertical_reaction", "max_horizontal_reaction"):
        assert getattr(peaks, name) == pytest.approx(getattr(found, name), rel=1e-12), name
    assert found.energy.closing_error < 1e-9 or not model.lifts


@pytest.mark.parametrize("case", ["2DOF-C", "MDOF-C-SI", "2DOF-S-BW"])
def test_reactions(case):
    """Those of the history are the twin's at the same states, and the peaks are not smaller."""
    n_modes, _ = CASES[case]
    horizontal, vertical, dt = record()
    model = model_of(case)
    found = run(model, horizontal, dt, vertical)
    states = found.history.states
    forces = reactions(model, states, accelerations_at_states(model, states))
    if model.complete:
        twin = CompleteModel(Structure(**complete_frame(**FRAME, n_modes=n_modes)), complete=True)
        side = acting_side(states)
        for k in range(0, states.shape[0], 7):
            y = np.concatenate((states[k, 4 + 2 * n_modes : 6 + 2 * n_modes], states[k, 4 : 4 + 2 * n_modes]))
            expected = twin.ground_forces(y, Shaking(states[k, 2], states[k, 3]), int(side[k]))
            assert (forces.horizontal[k], forces.vertical[k]) == pytest.approx(expected, rel=1e-11, abs=1e-6)
    fine = np.arange(16 * (horizontal.size - 1) + 1) / 16
    finer = [np.interp(fine, np.arange(horizontal.size), each) for each in (horizontal, vertical)]
    states = run(model, finer[0], dt / 16, finer[1]).history.states
    forces = reactions(model, states, accelerations_at_states(model, states))
    assert found.min_vertical_reaction == pytest.approx(forces.vertical.min(), rel=0.01)
    assert found.max_horizontal_reaction == pytest.approx(np.abs(forces.horizontal).max(), rel=0.01)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("share", [0.2, -0.3])
def test_constant_vertical_acceleration_is_another_gravity(case, share):
    horizontal, _, dt = record()
    model = model_of(case, **({"impact": rf.Restitution(0.9)} if case.startswith("rigid") else {}))
    vertical = np.full(horizontal.size, share * model.gravity)
    moved = run(model, horizontal, dt, vertical)
    heavier = run(replace(model, gravity=(1.0 + share) * model.gravity), horizontal, dt)
    assert (moved.n_uplifts, moved.n_impacts) == (heavier.n_uplifts, heavier.n_impacts)
    for name in (*PEAKS, "max_total_top_displacement", "max_horizontal_reaction", "min_vertical_reaction"):
        assert getattr(moved, name) == pytest.approx(getattr(heavier, name), rel=1e-8, abs=1e-14), name
    level = run(model, horizontal, dt)
    assert "fixed" in case or level.max_rotation != pytest.approx(moved.max_rotation, rel=1e-3)


def test_no_vertical_acceleration_changes_nothing():
    horizontal, _, dt = record()
    model = model_of("MDOF-C-SI")
    still, level = run(model, horizontal, dt, np.zeros(horizontal.size)), run(model, horizontal, dt)
    for name in PEAKS:
        assert getattr(still, name) == pytest.approx(getattr(level, name), rel=1e-9), name


@pytest.mark.parametrize(("complete", "simple", "power"), [("2DOF-C-SI", "2DOF-S", 1.0), ("rigid-C", "rigid", 2.0)])
def test_small_rotations_are_simplified_ones(complete, simple, power):
    """From a rotation θ0 the times of impact differ by the order of θ0, without modes by that of θ0²."""
    dt = 0.005
    vertical = 4.0 * np.sin(40.0 * dt * np.arange(200) + 0.3)
    errors, starts = [], 0.004 * 0.5 ** np.arange(6.0)
    for start in starts:
        times = []
        for label in (complete, simple):
            model = model_of(label)
            state = np.zeros(2 * model.properties.n_modes + 2)
            state[-2] = start
            times.append(run(model, np.zeros(200), dt, vertical, state=state).impact_times[0])
        errors.append(abs(times[0] / times[1] - 1.0))
    order = np.diff(np.log(errors)) / np.diff(np.log(starts))
    assert order[-1] == pytest.approx(power, abs=0.1)


def test_a_structure_whose_tendons_balance_the_weight_is_near_the_one_just_beside_it():
    horizontal, vertical, dt = record()
    frame = rf.Frame(**FRAME)
    p = frame.rocking()
    stiffness = p.l0r * 9.81 / p.half_width**2
    ends = []
    for share in (1.0, 0.985):
        tied = rf.Restrained(frame, rf.Tendon(1e3, share * stiffness)).rocking()
        model = Model(1).of(tied)
        assert not model.integrated
        ends.append(run(model, horizontal, dt, vertical))
    assert ends[0].max_rotation == pytest.approx(ends[1].max_rotation, rel=0.05)
    assert ends[0].energy.closing_error < 1e-9
