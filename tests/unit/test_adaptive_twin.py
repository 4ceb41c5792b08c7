"""Integrated models against an independent integration by SciPy, under stretches of records."""

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins import impact_laws
from twins.complete import complete_frame, simulate_complete
from twins.complete_model import BoucWen

SIMPLE, COMPLETE = impact_laws.SimplifiedVVEL(), impact_laws.CompleteVVEL()
NO_FLEXURE = dict.fromkeys(("omega", "effective_mass", "effective_height", "top_ordinate", "zeta"), ())
FRAME = frame_values(stiffness_ratio=0.125, period=0.7, aspect_ratio=7.0)
SPRING = (0.04, 0.02, 0.5, 0.5, 8.0)
CASES = {
    # label: modes of the twin, what else the twin is told, what else the model is
    "2DOF-C": (1, {"law": COMPLETE}, {}),
    "2DOF-C-SI": (1, {"law": SIMPLE}, {}),
    "MDOF-C": (5, {"law": COMPLETE}, {}),
    "3DOF-C-E": (2, {"law": COMPLETE}, {}),
    "rigid-C": (0, {"law": impact_laws.Restitution(0.9)}, {"impact": rf.Restitution(0.9)}),
    "2DOF-S-BW": (
        1,
        {"law": SIMPLE, "complete": False, "bouc_wen": BoucWen(*SPRING)},
        {"bouc_wen": rf.BoucWen(*SPRING)},
    ),
    "1DOF-fixed-BW": (
        1,
        {"law": SIMPLE, "complete": False, "lifts": False, "bouc_wen": BoucWen(*SPRING)},
        {"bouc_wen": rf.BoucWen(*SPRING)},
    ),
    "2DOF-C passing": (1, {"law": impact_laws.Restitution(0.7)}, {"impact": rf.Restitution(0.7)}),
}
RECORDS = {"el-centro-1940": (0, slice(60, 210), 2.5), "fema-p695-far-field": (9, slice(500, 800), 1.5)}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")


def motion(suite):
    place, cut, factor = RECORDS[suite]
    record = rf.load_suite(suite)[place]
    return rf.GroundMotion(factor * record.acceleration[cut], record.dt)


@pytest.mark.parametrize("suite", RECORDS)
@pytest.mark.parametrize("case", CASES)
def test_peaks_and_events(case, suite):
    n_modes, told, options = CASES[case]
    given, record = complete_frame(**FRAME, n_modes=max(n_modes, 1)), motion(suite)
    twin = simulate_complete(
        **given | (NO_FLEXURE if n_modes == 0 else {}), **told, acceleration=record.acceleration, dt=record.dt, free=0.4
    )
    run = rf.simulate(rf.Frame(**FRAME), record, case.split()[0], free_vibration=0.4, **options)
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert twin.n_impacts >= 2 or "fixed" in case
    for name in PEAKS:
        assert getattr(run, name) == pytest.approx(getattr(twin, name), rel=1e-8, abs=1e-14), name
    np.testing.assert_allclose(run.uplift_times, twin.uplift_times, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(run.impact_times, twin.impact_times, rtol=0.0, atol=1e-7)
    assert run.side[-1] == twin.sides[-1]
    peaks = rf.simulate(rf.Frame(**FRAME), record, case.split()[0], "peaks", free_vibration=0.4, **options)
    for name in PEAKS:
        assert getattr(peaks, name) == pytest.approx(getattr(run, name), rel=1e-12), name


def test_states_at_every_sample():
    given, record = complete_frame(**FRAME, n_modes=5), motion("el-centro-1940")
    twin = simulate_complete(**given, acceleration=record.acceleration, dt=record.dt)
    run = rf.simulate(rf.Frame(**FRAME), record, "MDOF-C")
    for k in (20, 75, 110, 149):
        mine = np.flatnonzero(np.abs(run.time - k * record.dt) < 1e-12)[-1]
        theirs = np.flatnonzero(np.abs(twin.times - k * record.dt) < 1e-12)[-1]
        state = twin.states[theirs]
        for actual, expected, size in (
            (run.rotation[mine], state[0], 0.1),
            (run.rotation_velocity[mine], state[1], 0.1),
            (run.modal_displacement[mine], state[2:7], 0.1),
            (run.modal_velocity[mine], state[7:], 1.0),
        ):
            np.testing.assert_allclose(actual, expected, rtol=0.0, atol=1e-7 * size)
