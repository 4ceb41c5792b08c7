"""What Silva & Stojadinović 2024 say of Figs. 3 and 4, seen in the equivalents of the two specimens."""

import numpy as np
import pytest

import rockflex as rf

G = 9.81
BASES, DAMPINGS = (0.0, 0.1, 0.3), (0.005, 0.02)


@pytest.fixture(scope="module", params=[(m, z) for m in BASES for z in DAMPINGS])
def two_hz(request):
    properties = rf.equivalent_2hz_long_base(*request.param)
    pulse = rf.ricker_pulse(0.1 * G, 0.5)
    models = ("2DOF-C", "2DOF-C-SI", "2DOF-S", "MDOF-S")
    return properties, {model: rf.simulate(properties, pulse, model, free_vibration=2.0) for model in models}


def test_any_of_the_four_models_gives_the_peaks(two_hz):
    _, runs = two_hz
    rotations = [run.max_rotation for run in runs.values()]
    displacements = [run.max_top_displacement for run in runs.values()]
    assert max(rotations) < 1.2 * min(rotations)
    assert max(displacements) < 1.12 * min(displacements)


def test_the_simplified_models_are_alike_and_so_are_the_complete_ones(two_hz):
    _, runs = two_hz
    for one, other in (("2DOF-S", "MDOF-S"), ("2DOF-C", "2DOF-C-SI")):
        assert runs[one].max_rotation == pytest.approx(runs[other].max_rotation, rel=0.02)
        assert runs[one].max_top_displacement == pytest.approx(runs[other].max_top_displacement, rel=0.02)


def test_the_simplified_resisting_moment_is_about_7_percent_larger(two_hz):
    p, runs = two_hz
    run = runs["2DOF-C"]
    off = run.side != 0.0
    theta = np.abs(run.rotation[off])
    bend = run.side[off] * run.modal_displacement[off, 0]
    full = (p.resisting_moment - p.effective_mass[0] * G * bend) * np.cos(theta) - p.l0r * G * np.sin(theta)
    excess = (p.resisting_moment - p.l0r * G * theta) / full - 1.0
    assert 0.06 < excess.mean() < 0.085


def test_the_simplified_models_return_to_the_ground_sooner():
    p = rf.equivalent_2hz_long_base(0.1, 0.01)
    simple, complete = (
        rf.simulate(p, rf.ricker_pulse(0.1 * G, 0.5), model, free_vibration=2.0) for model in ("2DOF-S", "2DOF-C")
    )
    longest = [np.max(run.impact_times - run.uplift_times[: run.impact_times.size]) for run in (simple, complete)]
    assert longest[0] < 0.95 * longest[1]


@pytest.mark.parametrize("height", [0.5, 1.0, 2.0])
def test_s1_rotates_alike_for_a_cycle_and_bends_alike_with_one_mode(height):
    p = rf.equivalent_s1(0.3, 0.02, 0.2, height)
    start = rf.InitialState(rotation=0.11)
    runs = {
        model: rf.simulate(p, rf.quiet_motion(1.5, 0.001), model, initial=start)
        for model in ("2DOF-C", "2DOF-C-SI", "2DOF-S", "MDOF-S")
    }
    first = [run.impact_times[0] for run in runs.values()]
    assert max(first) < 1.02 * min(first)
    tops = [runs[model].max_top_displacement for model in ("2DOF-C", "2DOF-C-SI", "2DOF-S")]
    assert max(tops) < 1.02 * min(tops)
    swings = [np.max(-run.rotation) for run in runs.values()]
    assert max(swings) < 1.06 * min(swings)


def test_the_printed_21_percent_of_s1_lie_within_what_is_free():
    start = rf.InitialState(rotation=0.11)
    ratios = []
    for height, damping in ((0.5, 0.005), (1.0, 0.02), (2.0, 0.02), (3.0, 0.05)):
        p = rf.equivalent_s1(0.1, damping, 0.2, height)
        tops = [
            rf.simulate(p, rf.quiet_motion(1.5, 0.001), model, output="peaks", initial=start).max_top_displacement
            for model in ("2DOF-S", "MDOF-S")
        ]
        ratios.append(tops[1] / tops[0] - 1.0)
    assert min(ratios) < -0.21 < max(ratios)
