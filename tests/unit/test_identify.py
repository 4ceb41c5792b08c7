"""Identification from synthetic measurements, and tornado diagrams."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf

BLOCK = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
START, STILL = rf.InitialState(rotation=0.1), rf.quiet_motion(6.0, 0.02)
FRAME = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)


def free_rocking(restitution):
    run = rf.simulate(BLOCK, STILL, "rigid", impact=rf.AngularMomentum(restitution), initial=START)
    return run.resample(0.02).rotation


def test_what_was_computed_is_found_again():
    found = rf.identify(
        BLOCK, STILL, free_rocking(0.9), ["impact.restitution"], "rigid", impact=rf.AngularMomentum(0.92), initial=START
    )
    assert found.values == pytest.approx([0.9], rel=1e-9)
    assert found.impact.restitution == pytest.approx(0.9, rel=1e-9)
    assert found.residual < 1e-9


def test_noise_is_covered_without_bias():
    true, rng = free_rocking(0.9), np.random.default_rng(3)
    off, inside = [], 0
    for _ in range(25):
        seen = true + 2e-3 * rng.normal(size=true.size)
        seen[rng.random(true.size) < 0.1] = np.nan
        found = rf.identify(
            BLOCK, STILL, seen, ["impact.restitution"], "rigid", impact=rf.AngularMomentum(0.91), initial=START
        )
        low, high = found.interval(0.9)
        inside += int(low[0] < 0.9 < high[0])
        off.append(np.log(found.values[0] / 0.9) / found.standard_errors[0])
        assert found.residual == pytest.approx(2e-3, rel=0.25)
    assert abs(np.mean(off)) < 3.0 / np.sqrt(25)
    assert 0.6 < np.std(off) < 1.4
    assert 17 <= inside <= 25


def test_period_and_damping_from_the_motion_of_a_floor():
    record = rf.load_suite("el-centro-1940")[0].scaled(0.05)
    true = rf.simulate(FRAME, record, "MDOF-S")
    at = np.searchsorted(true.time, np.arange(record.acceleration.size) * record.dt + 1e-9) - 1
    found = rf.identify(
        replace(FRAME, period=0.51, damping_ratio=0.022),
        record,
        true.floor_acceleration[at],
        ["period", "damping_ratio"],
        observed="floor_acceleration",
    )
    assert found.values == pytest.approx([0.5, 0.02], rel=1e-6)


def test_intervals_of_period_and_damping_cover_what_was_computed():
    record, true = rf.load_suite("el-centro-1940")[0].scaled(0.05), np.log([0.5, 0.02])
    run = rf.simulate(FRAME, record, "MDOF-S")
    at = np.searchsorted(run.time, np.arange(record.acceleration.size) * record.dt + 1e-9) - 1
    seen = run.floor_acceleration[at]
    off = []
    for seed in range(24):
        rng = np.random.default_rng(seed)
        guess = replace(
            FRAME, period=0.5 * np.exp(0.05 * rng.normal()), damping_ratio=0.02 * np.exp(0.3 * rng.normal())
        )
        noisy = seen + 0.1 * seen.std() * rng.normal(size=seen.shape)
        found = rf.identify(guess, record, noisy, ["period", "damping_ratio"], observed="floor_acceleration")
        off.append((np.log(found.values) - true) / found.standard_errors)
    assert (np.abs(np.mean(off, axis=0)) < 3.0 / np.sqrt(24)).all()
    assert (np.std(off, axis=0) < 1.5).all()
    assert (np.sum(np.abs(off) < 1.645, axis=0) >= 17).all()


@pytest.mark.parametrize("seed", [0, 11, 24])
def test_a_far_guess_of_a_frame_that_rocks_does_not_lead_away(seed):
    # full steps from here end at a restitution of 1, or creep along an impact that comes and goes
    start, still, rng = rf.InitialState(rotation=0.05), rf.quiet_motion(6.0, 0.01), np.random.default_rng(seed)
    true = rf.simulate(FRAME, still, "MDOF-S", impact=rf.AngularMomentum(0.9), initial=start).resample(0.01).rotation
    noise = 0.02 * np.abs(true).max()
    seen = true + noise * rng.normal(size=true.shape)
    guess = replace(FRAME, period=0.5 * np.exp(0.05 * rng.normal()), damping_ratio=0.02 * np.exp(0.3 * rng.normal()))
    law = rf.AngularMomentum(0.9 * np.exp(0.03 * rng.normal()))
    names = ["period", "damping_ratio", "impact.restitution"]
    found = rf.identify(guess, still, seen, names, impact=law, initial=start)
    assert found.residual == pytest.approx(noise, rel=0.1)
    assert (np.abs(np.log(found.values / [0.5, 0.02, 0.9])) < 4.0 * found.standard_errors).all()


@pytest.mark.parametrize(
    ("changes", "field", "word"),
    [
        ({"measured": np.zeros((3, 2))}, "measured", "1 columns"),
        ({"measured": np.full(20, np.nan)}, "measured", "finite"),
        ({"parameters": []}, "parameters", "one or more"),
        ({"parameters": ["eccentricity"]}, "parameters", "eccentricity"),
        ({"observed": "velocity"}, "observed", "velocity"),
        ({"observed": "floor_acceleration"}, "observed", "no floors"),
    ],
)
def test_what_cannot_be_identified_is_told(changes, field, word):
    given = {"measured": free_rocking(0.9), "parameters": ["impact.restitution"]} | changes
    with pytest.raises(rf.InputError, match=word) as caught:
        rf.identify(BLOCK, STILL, model="rigid", impact=rf.AngularMomentum(0.9), initial=START, **given)
    assert caught.value.field == field


def test_a_tornado_has_the_runs_at_the_ends_of_each_range():
    found = rf.tornado(FRAME, PULSE, parameters={"period": 0.2, "scale": (0.5, 1.5)}, demand="max_base_moment")
    by_name = dict(zip(found.parameters, found.values, strict=True))
    for place, factor in enumerate((0.8, 1.2)):
        run = rf.simulate(replace(FRAME, period=0.5 * factor), PULSE, output="peaks")
        assert by_name["period"][place] == pytest.approx(run.max_base_moment, rel=1e-12)
    for place, factor in enumerate((0.5, 1.5)):
        run = rf.simulate(FRAME, PULSE.scaled(factor), output="peaks")
        assert by_name["scale"][place] == pytest.approx(run.max_base_moment, rel=1e-12)
    assert (np.diff(found.swings) <= 0.0).all()


def test_a_narrow_tornado_is_the_gradient():
    found = rf.tornado(FRAME, PULSE, parameters={"period": 1e-4, "aspect_ratio": 1e-4})
    slopes = rf.gradient(FRAME, PULSE, parameters=found.parameters).logarithmic["max_rotation"][1:]
    assert np.diff(found.values)[:, 0] / 2e-4 == pytest.approx(slopes, rel=1e-4)


def test_a_tornado_of_a_suite_has_medians():
    suite = rf.load_suite("fema-p695-far-field")[:3]
    found = rf.tornado(FRAME, suite, parameters={"damping_ratio": (0.5, 2.0)})
    table = rf.simulate_many(replace(FRAME, damping_ratio=0.04), suite)
    assert found.values[0, 1] == pytest.approx(table["max_rotation"].median(), rel=1e-12)
    assert found.n_records == 3


@pytest.mark.parametrize(
    ("given", "field"), [({"demand": "status"}, "demand"), ({"parameters": {"period": 1.2}}, "parameters")]
)
def test_an_impossible_tornado_is_told(given, field):
    with pytest.raises(rf.InputError) as caught:
        rf.tornado(FRAME, PULSE, **given)
    assert caught.value.field == field
