"""Derivatives of runs: against closed forms, complex steps of a twin, and differences of runs of every linear kind."""

import cmath
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import rockflex as rf
from differences import PEAKS, difference, slopes_as_differences
from random_runs import LINEAR, further_run, linear_run
from rockflex.response import Sensitivity

G = 9.81


def results(structure, motion, model, options):
    found = rf.simulate(structure, motion, model, output="peaks", **options)
    return np.array([getattr(found, name) for name in PEAKS]), (found.status, found.n_uplifts, found.n_impacts)


@pytest.mark.parametrize("kind", LINEAR)
@pytest.mark.parametrize("shaken", [False, True])
def test_the_scale_of_the_record_as_differences_of_runs(kind, shaken):
    seeds = (21,) if shaken else (20, 21, 22)
    sure = sum(slopes_as_differences(linear_run(kind, seed, shaken=shaken)) for seed in seeds)
    assert sure > 4 or shaken


@pytest.mark.parametrize(
    ("kind", "seed", "name"),
    [
        ("joints", 2, "joints[0].half_width"),
        ("podium", 3, "column_width"),
        ("yielding springs", 2, "ground.springs.capacity"),
        ("one side", 0, "restitution"),
        ("stories", 3, "strengths"),
        ("leaning", 5, "masses"),
        ("ties", 5, "elements[1].stiffness"),
    ],
)
def test_further_kinds_as_differences_of_runs(kind, seed, name):
    assert slopes_as_differences(further_run(kind, seed), [name]) > 5


FRAME = rf.Frame(3, 3.0, 40e3, 40e3, 1.0, period=0.7, aspect_ratio=6.0, damping_ratio=0.03)
TENDON = rf.Tendon(initial_force=1.5e5, stiffness=1e7)
FUSE = rf.YieldingDissipator(4e7, 8e4, 0.02, 0.8)
DAMPED = rf.ViscousDamper(2e5, -0.8)
SPRINGS = rf.Springs(np.linspace(-1.1, 1.1, 3), np.full(3, 2e8), np.full(3, 1e6))


@pytest.mark.parametrize(
    ("name", "change", "options"),
    [
        ("period", lambda s, f: rf.Restrained(replace(FRAME, period=0.7 * f), s.elements), {}),
        ("damping_ratio", lambda s, f: rf.Restrained(replace(FRAME, damping_ratio=0.03 * f), s.elements), {}),
        ("story_mass", lambda s, f: rf.Restrained(replace(FRAME, story_mass=40e3 * f), s.elements), {}),
        ("elements[0].initial_force", lambda s, f: with_element(0, initial_force=1.5e5 * f), {}),
        ("elements[1].stiffness", lambda s, f: with_element(1, stiffness=4e7 * f), {}),
        ("elements[1].yield_force", lambda s, f: with_element(1, yield_force=8e4 * f), {}),
        ("elements[2].coefficient", lambda s, f: with_element(2, coefficient=2e5 * f), {}),
        ("elements[1].position", lambda s, f: with_element(1, position=0.8 * f), {}),
        (
            "impact.restitution",
            lambda s, f: {"impact": rf.AngularMomentum(0.7 * f)},
            {"impact": rf.AngularMomentum(0.7)},
        ),
        ("impact.e", lambda s, f: {"impact": rf.Restitution(0.6 * f)}, {"impact": rf.Restitution(0.6)}),
        ("ground.friction", lambda s, f: {"ground": rf.Ground(friction=0.3 * f)}, {"ground": rf.Ground(friction=0.3)}),
        (
            "ground.springs.stiffness",
            lambda s, f: {
                "ground": rf.Ground(springs=replace(SPRINGS, stiffness=f * SPRINGS.stiffness), base_inertia=1e5)
            },
            {"ground": rf.Ground(springs=SPRINGS, base_inertia=1e5)},
        ),
    ],
)
def test_parameters_as_differences_of_runs(name, change, options):
    structure = rf.Restrained(FRAME, [TENDON, FUSE, DAMPED])
    motion = rf.load_suite("fema-p695-far-field")[3].scaled(1.6)
    found = rf.gradient(structure, motion, "MDOF-S", [name], **options)

    def changed(by):
        made = change(structure, math.exp(by))
        if isinstance(made, dict):
            return results(structure, motion, "MDOF-S", options | made)
        return results(made, motion, "MDOF-S", options)

    expected = difference(changed)
    assert expected is not None
    for peak, slope, doubt, size in zip(PEAKS, *expected, changed(0.0)[0], strict=True):
        assert found.logarithmic[peak][1] == pytest.approx(slope, rel=1e-8, abs=max(1e-8 * abs(size), 4.0 * doubt))


def with_element(place, **changes):
    elements = [TENDON, FUSE, DAMPED]
    elements[place] = replace(elements[place], **changes)
    return rf.Restrained(FRAME, elements)


@pytest.mark.parametrize("rocked", [1e-3, 0.05, 0.4, 0.9])
def test_an_uplift_that_starts_with_the_third_power_of_time(rocked):
    block = rf.rigid_block(slenderness=0.2, half_diagonal=4.0)
    p = block.rocking()
    rate = 3.0  # m/s³
    starts = p.resisting_moment / p.l0r / rate
    end = starts + rocked
    motion = rf.GroundMotion(rate * end * np.array([0.0, 0.5, 1.0]), 0.5 * end)
    found = rf.gradient(block, motion, "rigid", [])
    growth = math.sqrt(p.l0r * G / p.i_theta)
    push = p.l0r * rate / p.i_theta
    rotation = push / growth**3 * (math.sinh(growth * rocked) - growth * rocked)
    slope = rotation + push / growth**2 * (math.cosh(growth * rocked) - 1.0) * starts
    if rocked > 0.01:
        assert found.response.max_rotation == pytest.approx(rotation, rel=1e-10)
    assert found.logarithmic["max_rotation"][0] == pytest.approx(slope, rel=1e-9 if rocked > 0.01 else 1e-6)


def rocking_block(scale, restitution, width, record, dt):
    """The largest rotation of a rigid block: piecewise in closed form, with numbers that may be complex."""
    height, mass = 3.0, 1.0
    inertia = 4.0 / 3.0 * mass * (width**2 + height**2)
    p = cmath.sqrt(mass * G * height / inertia)
    theta, spin, side, best = 0.0, 0.0, 0, 0.0
    for a0, a1 in zip(record[:-1] * scale, record[1:] * scale, strict=True):
        slope, passed = (a1 - a0) / dt, 0.0
        while True:
            a = a0 + slope * passed
            if side == 0:
                side = 1 if (height * a - G * width).real > 0.0 else -1 if (-height * a - G * width).real > 0.0 else 0
                if side == 0:
                    way = 1.0 if slope.real > 0.0 else -1.0
                    until = (way * G * width / height - a) / slope if slope != 0.0 else math.inf
                    if not 1e-14 < until.real < dt - passed.real if slope != 0.0 else True:
                        break
                    passed, side, theta, spin = passed + until, int(way), 0.0, 0.0
                    continue
            # p² (θ - s B/h + a/g) = θ'': with a particular solution that is linear in time
            now, rate = side * width / height - a / G, -slope / G
            b, c = theta - now, (spin - rate) / p

            def at(t, b=b, c=c, now=now, rate=rate):
                return now + rate * t + b * cmath.cosh(p * t) + c * cmath.sinh(p * t)

            def velocity(t, b=b, c=c, rate=rate):
                return rate + p * (b * cmath.sinh(p * t) + c * cmath.cosh(p * t))

            rest = dt - passed
            grid = np.linspace(0.0, rest.real, 200)[1:]
            below = [t for t in grid if (side * at(t)).real < 0.0]
            stop = rest
            if below:
                t = below[0]
                for _ in range(60):
                    t = t - at(t) / velocity(t)
                stop = t
            inside = [t for t in grid if t < stop.real]
            for t, u in pairwise(inside):
                if (velocity(t) * velocity(u)).real < 0.0:
                    top = t
                    for _ in range(60):
                        top = top - velocity(top) / (p * p * (at(top) - now - rate * top))
                    if (side * at(top)).real > best.real:
                        best = side * at(top)
            theta, spin, passed = at(stop), velocity(stop), passed + stop
            if not below:
                break
            theta, spin, side = 0.0, restitution * spin, -side
    return best


def test_a_rigid_block_as_complex_steps_of_a_twin():
    dt, rng = 0.1, np.random.default_rng(4)
    record = 3.5 * np.sin(0.9 * np.arange(40)) * rng.uniform(0.5, 1.2, 40)
    width, law = 0.6, rf.Restitution(0.85, shortest_excursion=1e-12)
    block = rf.rigid_block(slenderness=math.atan(width / 3.0), half_diagonal=math.hypot(width, 3.0))
    found = rf.gradient(block, rf.GroundMotion(record, dt), "rigid", ["impact.e"], impact=law)
    assert found.response.n_impacts > 2
    h = 1e-30
    assert found.response.max_rotation == pytest.approx(rocking_block(1.0, 0.85, width, record, dt).real, rel=1e-10)
    by_scale = rocking_block(1.0 + h * 1j, 0.85, width, record, dt).imag / h
    by_restitution = rocking_block(1.0, 0.85 + h * 1j, width, record, dt).imag / h
    assert found["max_rotation"] == pytest.approx([by_scale, by_restitution], rel=1e-9)


def test_the_sensitivity_of_a_history_is_the_gradient_by_the_scale():
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    for options in ({}, {"free_vibration": "settle"}, {"free_vibration": 2.0}):
        run = rf.simulate(FRAME, motion, **options)
        found = rf.gradient(FRAME, motion, parameters=[], **options)
        assert run.sensitivity["max_rotation"] == pytest.approx(found.elasticity("max_rotation")[0], rel=1e-9)
        assert run.sensitivity["max_base_moment"] == pytest.approx(found.elasticity("max_base_moment")[0], rel=1e-9)


def test_more_impacts_than_samples_do_not_hide_the_time_step():
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    motion, impact = rf.load_suite("el-centro-1940")[0], rf.Restitution(0.9)
    run = rf.simulate(frame, motion, "2DOF-S", impact=impact, free_vibration=2.0)
    assert np.median(np.diff(np.unique(run.time))) < 0.6 * motion.dt
    found = rf.gradient(frame, motion, "2DOF-S", [], impact=impact, free_vibration=2.0)
    assert run.sensitivity["max_rotation"] == pytest.approx(found.elasticity("max_rotation")[0], rel=1e-6)


def test_an_overturning_run_ends_at_the_same_rotation():
    found = rf.gradient(FRAME, rf.load_suite("el-centro-1940")[0].scaled(20.0), parameters=["period"])
    assert found.response.status == "overturned"
    assert found.elasticity("max_rotation") == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_run_near_overturning_is_flagged_with_a_note():
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    pulse = rf.one_sine_pulse(amplitude=4.0, period=1.0)
    scale = 1.0
    for step in 0.5 ** np.arange(1, 18):  # as much as it bears
        falls = rf.simulate(block, pulse.scaled(scale), "rigid", "peaks", "settle").status == "overturned"
        scale += -step if falls else step
    while rf.simulate(block, pulse.scaled(scale), "rigid", "peaks", "settle").status == "overturned":
        scale -= 1e-5
    run = rf.simulate(block, pulse.scaled(scale * (1.0 - 1e-4)), "rigid", free_vibration="settle")
    assert abs(run.sensitivity["max_rotation"]) > 10.0
    assert "max_rotation" in run.sensitivity.flagged
    assert "1 %" in run.sensitivity.note
    calm = rf.simulate(block, pulse.scaled(0.8 * scale), "rigid", free_vibration="settle")
    assert not calm.sensitivity.flagged
    assert calm.sensitivity.note == ""


def test_a_note_writes_large_numbers_without_exponent():
    assert "8010 %" in Sensitivity({"max_rotation": -8012.3, "max_base_moment": 11.0}).note


@pytest.mark.parametrize(
    ("parameters", "word"),
    [
        (["perod"], "perod"),
        (["elements[3].stiffness"], "elements"),
        (["period "], "period"),
        (["ground.friction"], "ground"),
    ],
)
def test_an_unknown_parameter_is_named(parameters, word):
    with pytest.raises(rf.InputError, match=word) as caught:
        rf.gradient(FRAME, rf.one_sine_pulse(3.0, 0.8), parameters=parameters)
    assert caught.value.field == "parameters"


def test_zero_has_no_relative_change():
    undamped = replace(FRAME, damping_ratio=0.0)
    with pytest.raises(rf.InputError, match="zero"):
        rf.gradient(undamped, rf.one_sine_pulse(3.0, 0.8), parameters=["damping_ratio"])
    assert "damping_ratio" not in rf.parameter_names(undamped)


def test_a_number_at_a_kink_of_the_structure_has_no_derivative():
    motion = rf.load_suite("fema-p695-far-field")[3].scaled(1.6)
    names = ["period", "story_height", "elements[0].height"]
    held = rf.Restrained(FRAME, rf.YieldingDissipator(4e7, 8e4, 0.02, height=3.0))  # just at a floor
    found = rf.gradient(held, motion, parameters=names)
    alone = rf.gradient(held, motion, parameters=["period"])
    assert np.isnan(found["max_rotation"]).tolist() == [False, False, True, True]
    assert found["max_rotation"][:2] == pytest.approx(alone["max_rotation"], rel=1e-9)
    assert np.isnan(found.to_frame()["max_rotation"]).tolist() == [False, False, True, True]
    between = rf.Restrained(FRAME, rf.YieldingDissipator(4e7, 8e4, 0.02, height=3.5))
    assert np.isfinite(rf.gradient(between, motion, parameters=names)["max_rotation"]).all()


def test_models_that_are_integrated_have_no_gradient():
    with pytest.raises(rf.InputError, match="MDOF-C") as caught:
        rf.gradient(FRAME, rf.one_sine_pulse(3.0, 0.8), "MDOF-C", parameters=[])
    assert caught.value.field == "model"
