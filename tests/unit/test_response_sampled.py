"""The motion of a history at other instants than those of its states, and as a table."""

import math

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import PROPERTIES, make_frame, random_shaking
from rockflex.response._interpolation import quintic_between
from rockflex.response._outputs import COLUMNS

FRAME = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
MOTION = rf.GroundMotion(random_shaking(4, 9.0, 4.0, 0.02), 0.02, "random")
VERTICAL = MOTION.with_vertical(0.4 * random_shaking(5, 9.0, 4.0, 0.02))
DAMPED = rf.Restrained(FRAME, [rf.Tendon(1e5, 1e6), rf.FrictionDamper(5e4, 0.2), rf.YieldingDissipator(2e7, 5e4)])
BED = rf.Ground(springs=rf.winkler_bed(FRAME.rocking().half_width, 3.0, n=6, subgrade_modulus=5e7), base_inertia=2e4)
LAW = rf.BoucWen(0.02)


def run(structure, model, motion=MOTION, k=1, **options):
    return rf.simulate(structure, motion.refined(k), model, output="history", free_vibration=1.0, **options)


def distance(coarse, fine):
    """Largest difference of the motion at the states of the fine run, between its events, relative to the largest."""
    k = np.flatnonzero(np.diff(fine.time, prepend=-1.0) > 1e-6)
    k = k[(np.append(np.diff(fine.time), 1.0) > 1e-6)[k]]
    k = k[np.abs(fine.time[k, None] - fine.time[np.diff(fine.time, append=9.9) == 0.0]).min(axis=1, initial=1.0) > 1e-6]
    found = coarse.history.at(fine.time[k])
    names = ("rotation", "rotation_velocity", "modal_displacement", "modal_velocity", "base_moment", "slip", "heave")
    sizes = {name: np.abs(getattr(fine, name)).max(initial=0.0) for name in names}
    gaps = {name: np.abs(getattr(found, name) - getattr(fine, name)[k]).max(initial=0.0) for name in names}
    return max(gaps[name] / size for name, size in sizes.items() if size)


LINEAR = {
    "frame": (FRAME, "MDOF-S", MOTION, {}),
    "fixed": (FRAME, "fixed", MOTION, {}),
    "vertical": (FRAME, "2DOF-S", VERTICAL, {}),
    "elements": (DAMPED, "2DOF-S", MOTION, {}),
    "sliding": (FRAME, "MDOF-S", MOTION, {"ground": rf.Ground(friction=0.12)}),
    "springs": (FRAME, "2DOF-S", MOTION, {"ground": BED}),
}


@pytest.mark.parametrize(("structure", "model", "motion", "options"), LINEAR.values(), ids=LINEAR)
def test_linear_phases_are_exact_between_states(structure, model, motion, options):
    coarse, fine = (run(structure, model, motion, k, **options) for k in (1, 7))
    assert distance(coarse, fine) < 1e-8  # times are rounded to 1e-12 s


STEEL = rf.Restrained(FRAME, [rf.Tendon(1e5, 1e6), rf.YieldingDissipator(2e7, 5e4)])
CURVED = {
    "complete": (FRAME, "2DOF-C", {}, 5e-4),
    "block": (FRAME, "rigid-C", {}, 1e-8),
    "hysteresis": (FRAME, "2DOF-S-BW", {"bouc_wen": LAW}, 3e-3),
    "complete with hysteresis": (FRAME, "2DOF-C-BW", {"bouc_wen": LAW}, 3e-3),
    "complete with elements": (STEEL, "2DOF-C", {}, 5e-4),
}


@pytest.mark.parametrize(("structure", "model", "options", "bound"), CURVED.values(), ids=CURVED)
def test_other_phases_are_close_and_closer_with_smaller_steps(structure, model, options, bound):
    fine = run(structure, model, k=28, **options)
    coarse, finer = (distance(run(structure, model, k=k, **options), fine) for k in (1, 4))
    assert coarse < bound
    assert finer < max(bound / 4.0**3, 1e-8)


@pytest.mark.parametrize("pace", [0.3, 1.0, 2.0])
def test_the_bound_of_the_polynomial(pace):
    """The documented relative errors of a vibration, at the worst phase."""
    start = np.linspace(0.0, 2.0 * math.pi, 400)
    first, last = ((np.sin(x)[:, None], np.cos(x)[:, None], -np.sin(x)[:, None]) for x in (start, start + pace))
    errors = np.zeros(2)
    for part in np.linspace(0.0, 1.0, 41):
        value, slope, _ = quintic_between(first, last, np.full(400, pace), float(part))
        here = start + part * pace
        errors = np.maximum(errors, [abs(value[:, 0] - np.sin(here)).max(), abs(slope[:, 0] - np.cos(here)).max()])
    assert errors[0] < 1.001 * pace**6 / 46080 + 1e-13
    assert errors[1] < 1.001 * pace**5 / 13400 + 1e-13


@pytest.fixture(scope="module")
def response():
    found = run(FRAME, "MDOF-S")
    assert found.n_impacts == 2
    return found


def test_the_states_of_the_run_are_returned_as_they_are(response):
    states = response.history.states
    after = np.append(np.diff(response.time) > 0.0, True)
    found = response.at(response.time)
    np.testing.assert_array_equal(found.states[after], states[after])
    before = np.flatnonzero(~after)  # at an event the motion after it
    np.testing.assert_array_equal(found.time, response.time)
    np.testing.assert_array_equal(response.at(response.time[before]).states, found.states[before + 1])
    assert response.at(response.uplift_times).uplifted.all()


def test_instants_come_in_any_order_and_alone(response):
    mixed = response.at([2.013, 0.5, 0.5])
    assert mixed.time.tolist() == [2.013, 0.5, 0.5]
    assert mixed.rotation[0] == response.at(2.013).rotation[0] != 0.0
    assert mixed.floor_acceleration.shape == (3, 3)
    assert repr(mixed) == "SampledHistory(MDOF-S, 3 instants, 2.013 to 0.5 s)"


def test_equal_steps_end_with_the_last_state(response):
    even = response.resample(0.01)
    assert even.time.size == 501
    assert even.time[-1] == response.end_time
    np.testing.assert_allclose(np.diff(even.time), 0.01, rtol=0.0, atol=1e-12)
    uneven = response.resample(0.3)
    np.testing.assert_allclose(uneven.time, [*np.arange(17) * 0.3, 5.0], rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(uneven.states[-1], response.history.states[-1])
    assert response.resample(99.0).time.tolist() == [0.0, response.end_time]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda r: r.at([0.1, 7.0]), r"from 0 to 5 s, but times\[1\] = 7 s was given. Simulate with a longer"),
        (lambda r: r.at(-0.1), r"but times\[0\] = -0.1 s was given"),
        (lambda r: r.at([]), "but no time was given"),
        (lambda r: r.at("soon"), "times must be a sequence of numbers in s, but"),
        (lambda r: r.at([math.nan]), "times"),
        (lambda r: r.resample(0.0), "dt must be"),
        (lambda r: r.resample(1e-9), r"gives 5e\+09 instants over 5 s, above the limit of 10000000. Give a dt of at"),
        (lambda r: r.to_frame(["rotatoin"]), "but 'rotatoin' was given. Did you mean 'rotation'"),
        (lambda r: r.to_frame("rotation"), "must be a list of different names .* but 'rotation' was given"),
        (lambda r: r.to_frame(["slip", "slip"]), r"but \['slip', 'slip'\] were given"),
        (lambda r: r.to_frame(7), "must be a list of different names .* but 7 was given"),
    ],
)
def test_errors(response, call, message):
    with pytest.raises(rf.InputError, match=message):
        call(response)


def test_what_needs_the_events_is_not_told_by_samples(response):
    even = response.resample(0.1)
    for name in ("uplift_times", "impact_times", "energy", "element_energy", "required_friction", "at", "resample"):
        assert not hasattr(even, name)
    with pytest.raises(rf.InputError, match="A sampled history has no energy, since it lacks the events"):
        _ = even.energy


def test_a_table_has_every_state_twice_at_events(response):
    table = response.to_frame()
    assert isinstance(table, pd.DataFrame)
    assert list(table.columns) == list(COLUMNS)[1:]
    assert table.index.name == "time"
    np.testing.assert_array_equal(table.index, response.time)
    for name in table:
        np.testing.assert_array_equal(table[name], getattr(response, name))
    assert len(table.loc[response.uplift_times[1]]) == 2
    assert response.resample(0.1).to_frame().index.is_unique


def test_chosen_quantities(response):
    table = response.to_frame(["time", "uplifted", "floor_acceleration"])
    assert list(table.columns) == ["uplifted", "floor_acceleration_1", "floor_acceleration_2", "floor_acceleration_3"]
    np.testing.assert_array_equal(table["floor_acceleration_3"], response.floor_acceleration[:, 2])


def test_columns_of_other_models():
    table = run(FRAME, "2DOF-S", VERTICAL, ground=BED).to_frame()
    assert {"vertical_ground_acceleration", "heave", "right_edge_uplift", "spring_force_6"} <= set(table.columns)
    assert "yielding" in run(FRAME, "2DOF-S-BW", bouc_wen=LAW).to_frame()
    unknown = rf.RockingProperties(**PROPERTIES)
    assert run(unknown, "MDOF-S").to_frame()["total_top_displacement"].isna().all()


def test_peaks_have_no_table():
    peaks = rf.simulate(FRAME, MOTION, output="peaks")
    assert not hasattr(peaks, "to_frame")
    with pytest.raises(rf.InputError, match="contains only peaks, so it has no resample"):
        peaks.resample(0.1)
