"""What an animation draws is the motion of the response."""

import numpy as np
import pytest
from PIL import Image

import rockflex as rf
from builders import PROPERTIES, make_frame
from rockflex.plot._history import response_curves
from rockflex.plot.animation._poses import (
    MAX_DRAWN_MOTION,
    ROUND_FACTORS,
    default_amplification,
    frame_timing,
    outline_of_response,
    structure_poses,
)
from rockflex.plot.animation._scene import structure_state_text
from rockflex.structure._outline import BODY

FRAME = make_frame()
RECORD = rf.load_suite("el-centro-1940")[0]
BLOCK = rf.rigid_block(slenderness=0.25, half_diagonal=1.5, mass=1000.0)
PIER = rf.CantileverWithTipMass(
    height=12.0, tip_mass=500e3, mass_per_length=10e3, bending_stiffness=4.0e10, base_mass=120e3, half_width=1.5,
    damping_ratio=0.03, n_modes=3,
)  # fmt: skip
SOIL = rf.Ground(springs=rf.winkler_bed(1.5, breadth=6.0, subgrade_modulus=8e7, n=12).damped(0.3, 7.4e5),
                 base_inertia=1e5, friction=0.1)  # fmt: skip
TIMES = np.linspace(0.0, 12.0, 161)


def posed(response, structure=None, times=TIMES):
    """The curve of a response, and its poses at some times."""
    (curve,) = response_curves(response)
    return curve, structure_poses(curve, outline_of_response(curve.history, structure, 0), times, 1.0)


def bent(poses, frame, amplification=1.0):
    """Where the axis of the structure is drawn."""
    heights = poses.outline.heights
    axis = np.column_stack((np.zeros(heights.size), heights, np.full(heights.size, BODY)))
    return poses.moved(frame, axis, amplification)


@pytest.fixture(scope="module")
def runs():
    strong = RECORD.scaled(2.0)
    return {
        "complete": rf.simulate(FRAME, strong, "MDOF-C"),
        "simplified": rf.simulate(FRAME, strong, "MDOF-S"),
        "eccentric": rf.simulate(rf.Eccentric(FRAME, 0.3), strong, "MDOF-C"),
        "sliding": rf.simulate(FRAME, strong, "MDOF-S", ground=rf.Ground(friction=0.15)),
        "springs": rf.simulate(PIER, strong, "MDOF-S", ground=SOIL),
        "fixed": rf.simulate(FRAME, strong, "fixed"),
        "block": rf.simulate(BLOCK, RECORD.scaled(2.5), "rigid-C"),
        "fallen": rf.simulate(BLOCK, RECORD.scaled(5.0), "rigid-C"),
    }


@pytest.mark.parametrize("name", ["complete", "eccentric"])
def test_the_top_of_a_complete_model_is_drawn_where_the_response_has_it(runs, name):
    at = runs[name].at(TIMES)
    _, poses = posed(runs[name])
    drawn = np.array([bent(poses, k)[0][-1] for k in range(TIMES.size)])
    assert np.abs(at.rotation).max() > 0.01
    np.testing.assert_allclose(drawn, at.total_top_displacement, atol=1e-9)
    every = np.array([bent(poses, k)[0][1:] for k in range(TIMES.size)])
    np.testing.assert_allclose(every, at.total_floor_displacement, atol=1e-9)


@pytest.mark.parametrize("name", ["simplified", "sliding", "fixed"])
def test_the_top_of_a_simplified_model_is_drawn_there_but_for_squares_of_the_rotation(runs, name):
    at = runs[name].at(TIMES)
    curve, poses = posed(runs[name])
    p = curve.history.model.properties
    drawn = np.array([bent(poses, k)[0][-1] for k in range(TIMES.size)])
    linear = at.slip + at.top_displacement + p.top_height * at.rotation
    error = (p.half_width + np.abs(at.top_displacement)) * at.rotation**2 + p.top_height * np.abs(at.rotation) ** 3
    assert (np.abs(drawn - linear) <= error + 1e-12).all()


@pytest.mark.parametrize("name", ["complete", "simplified", "eccentric", "sliding", "block", "fallen"])
@pytest.mark.parametrize("amplification", [1.0, 7.0])
def test_a_base_on_rigid_ground_stands_on_an_edge_or_lies_on_it(runs, name, amplification):
    curve, poses = posed(runs[name])
    at = curve.history.at(np.minimum(TIMES, curve.history.time[-1]))
    width = 2.0 * curve.history.model.properties.half_width
    assert poses.uplifted.any()
    assert not poses.uplifted.all()
    for frame in range(TIMES.size):
        across, up = poses.base(frame, amplification)
        assert min(up) == pytest.approx(0.0, abs=1e-12)
        assert np.hypot(*(np.array([across, up]) @ [-1.0, 1.0])) == pytest.approx(width)  # turned, not stretched
        theta = min(amplification * abs(at.rotation[frame]), 0.5 * np.pi)
        assert max(up) == pytest.approx(width * np.sin(theta), abs=1e-9)
        if not poses.uplifted[frame]:
            assert max(up) == pytest.approx(0.0, abs=1e-12)
        lower = across[int(np.argmin(up))]
        edge = poses.outline.left if at.rotation[frame] < 0.0 else poses.outline.right
        if poses.uplifted[frame]:
            assert lower == pytest.approx(edge + amplification * at.slip[frame])


def test_edges_of_an_eccentric_base_are_at_their_distances_from_the_axis(runs):
    _, poses = posed(runs["eccentric"])
    b = FRAME.rocking().half_width
    assert (poses.outline.left, poses.outline.right) == pytest.approx((-b - 0.3, b - 0.3))


def test_a_base_on_springs_moves_as_the_response_says(runs):
    at = runs["springs"].at(TIMES)
    _, poses = posed(runs["springs"], PIER)
    assert poses.springs.size == 12
    assert np.abs(at.slip).max() > 0.0
    for frame in range(TIMES.size):
        across, up = poses.base(frame, 1.0)
        assert up == pytest.approx(at.edge_uplift[frame], abs=1.5 * abs(at.rotation[frame]) ** 3)
        assert across.mean() == pytest.approx(at.slip[frame], abs=1e-12)
        _, high = poses.place(frame, poses.springs, np.zeros(12), 1.0)
        pressed = at.spring_force[frame] > 0.0
        assert (high[pressed] < 1e-4).all()
    assert (poses.rise.max(axis=1) > 0.0).any()


@pytest.mark.parametrize("name", ["complete", "springs", "fixed", "fallen"])
def test_words_are_those_of_the_response(runs, name):
    curve, poses = posed(runs[name])
    end = curve.history.time[-1]
    words = [structure_state_text(curve, poses, k, t)[0] for k, t in enumerate(TIMES)]
    at = curve.history.at(np.minimum(TIMES, end))
    for time, word, lifted in zip(TIMES, words, at.uplifted, strict=True):
        if word.startswith("uplifted"):
            assert lifted
        if word == "in contact":
            assert not lifted
        assert (word == "fixed base") == (name == "fixed")
        assert word.startswith("overturned") == (name == "fallen" and time >= end)
    if name == "fallen":
        assert words[-1] == f"overturned at {runs[name].end_time:.2f} s"
        assert "falling" in words
        _, up = poses.base(TIMES.size - 1, 1.0)
        assert max(up) == pytest.approx(2.0 * BLOCK.half_width)  # on its side


def test_impacts_are_marked_for_a_moment_of_the_animation(runs):
    curve, _ = posed(runs["simplified"])
    outline = outline_of_response(curve.history, None, 0)
    blow = float(curve.history.impact_times[0])
    for speed in (1.0, 0.1):
        times = blow + speed * np.array([-0.01, 0.001, 0.11, 0.13])
        poses = structure_poses(curve, outline, times[times < curve.history.impact_times[1]], speed)
        assert [bool(each) for each in poses.impact] == [False, True, True, False][: poses.impact.size]
        assert poses.impact.size >= 2


def test_outlines_follow_what_is_known():
    tower = rf.TaperedTower(height=100, base_radius=4, top_radius=3, wall=0.4, density=2400, elastic_modulus=30e9,
                            damping_ratio=0.02)  # fmt: skip
    run = rf.simulate(tower, rf.ricker_pulse(4.0, 1.0), "3DOF-S")
    (curve,) = response_curves(run)
    straight, bent = (outline_of_response(curve.history, each, 0) for each in (None, tower))
    assert (straight.kind, straight.top) == ("frame", pytest.approx(100.0))  # its floors are all that is known
    assert bent.kind == "column"
    assert bent.heights.size > 10
    assert bent.top == pytest.approx(100.0)
    np.testing.assert_allclose(bent.shapes[-1], straight.shapes[-1])
    bare = rf.RockingProperties(**PROPERTIES, top_height=13.0)
    kinds = {
        "column": (bare, "2DOF-S", bare),
        "mast": (PIER, "3DOF-S", PIER),
        "frame": (FRAME, "MDOF-S", None),
        "block": (BLOCK, "rigid", None),
    }
    for kind, (structure, model, given) in kinds.items():
        (curve,) = response_curves(rf.simulate(structure, rf.ricker_pulse(4.0, 1.0), model))
        assert outline_of_response(curve.history, given, 0).kind == kind
    held = rf.Restrained(PIER, rf.Tendon(initial_force=2.0e6, stiffness=25e6))
    (curve,) = response_curves(rf.simulate(held, rf.ricker_pulse(4.0, 1.0), "2DOF-S"))
    assert outline_of_response(curve.history, held, 0).kind == "mast"
    assert outline_of_response(curve.history, held, 0).shapes.shape[1] == 1


def test_points_of_an_outline_move_as_they_are_held():
    tower = rf.Leaning(make_frame(n_stories=50, period=3.0), 1e3)
    brace = rf.ViscousDamper(coefficient=1e5, between=(0, 43), cosine=0.8)
    tie = rf.Tendon(initial_force=1e5, stiffness=5e6, height=9.0, cosine=-0.6)
    _, poses = posed(rf.simulate(rf.Restrained(tower, [brace, tie]), RECORD.scaled(3.0), "2DOF-S"), tower)
    outline, frame = poses.outline, int(np.abs(poses.rotation).argmax())
    assert outline.heights.size <= 41
    (_, low), (symbol, anchored) = outline.elements
    assert low[:, 1] == pytest.approx([0.0, 43 * 3.0])
    (x, z, _), (_, height, _) = anchored
    assert (symbol, height, z) == ("tendons", 9.0, pytest.approx(0.0))
    assert x / np.hypot(x, height) == pytest.approx(0.6)
    across, up = poses.moved(frame, anchored, 5.0, sunk=0.7)
    assert (across[0], up[0]) == pytest.approx((x, -0.7))  # in the ground, which is lower than the base on springs
    (leaning,) = (each.points for each in outline.strokes if each.width == 1.6)
    across, up = poses.moved(frame, leaning, 5.0)
    assert up == pytest.approx(outline.heights)  # its floors move it sideways
    assert across[0] == leaning[0, 0]
    assert (np.abs(across - leaning[:, 0])[-5:] > 0.5 * np.abs(bent(poses, frame, 5.0)[0])[-5:]).all()


@pytest.mark.parametrize("name", ["simplified", "springs", "fixed", "block"])
def test_the_usual_amplification_is_the_largest_that_keeps_the_limit(runs, name):
    curve, poses = posed(runs[name])
    factor = default_amplification([curve], [poses])
    assert factor in ROUND_FACTORS

    def reach(by):
        there = [bent(poses, k, by)[0][-1] for k in range(TIMES.size)]
        return np.abs(there).max() / poses.outline.size

    assert factor == 1.0 or reach(factor) <= MAX_DRAWN_MOTION + 0.02
    larger = [each for each in ROUND_FACTORS if each > factor]
    assert reach(larger[0]) > 0.5 * MAX_DRAWN_MOTION


def test_what_falls_is_not_enlarged(runs):
    curve, poses = posed(runs["fallen"])
    assert default_amplification([curve], [poses]) == 1.0


def test_frames_are_at_equal_steps_to_the_end():
    curves = response_curves(rf.simulate(FRAME, rf.ricker_pulse(4.0, 0.6), "2DOF-S"))
    timing = frame_timing(curves, ".gif", 2.0, 25, 0.5, 2.0)
    np.testing.assert_allclose(timing.times[:-1], 0.5 + 0.08 * np.arange(timing.times.size - 1))
    assert timing.times[-1] == 2.0
    assert timing.hundredths.tolist() == [4] * timing.times.size


def test_the_last_frame_of_a_fall_says_when_it_overturned(runs):
    curve, _ = posed(runs["fallen"])
    for rate in (7, 10, 25, 30):
        timing = frame_timing([curve], ".gif", 1.0, rate, None, None)
        assert timing.times[-1] == runs["fallen"].end_time
        assert (np.diff(timing.times) > 0.0).all()
        assert np.diff(timing.times).max() <= 1.25 / rate + 1e-12
        _, poses = posed(runs["fallen"], times=timing.times)
        assert structure_state_text(curve, poses, timing.times.size - 1, timing.times[-1])[0].startswith(
            "overturned at"
        )


@pytest.mark.slow
def test_the_picture_moves_as_the_response(tmp_path):
    run = rf.simulate(PIER, RECORD.scaled(2.0), "2DOF-S")  # drawn in a colour that nothing else on the left has
    file = rf.animate(run, tmp_path / "run.gif", structure=PIER, start=2.0, stop=6.0, frames_per_second=5,
                      amplification=8.0, panels=["rotation"])  # fmt: skip
    moved = []
    with Image.open(file) as image:
        for frame in range(image.n_frames):
            image.seek(frame)
            pixels = np.asarray(image.convert("RGB")).astype(int)[100:, :380]
            colored = np.abs(pixels - (213, 94, 0)).sum(axis=2) < 30
            rows = np.flatnonzero(colored.any(axis=1))
            moved.append(np.flatnonzero(colored[rows[0] + 5]).mean())
    u = run.at(np.linspace(2.0, 6.0, 21)).total_top_displacement
    assert np.ptp(moved) > 20
    slope, middle = np.polyfit(u, moved, 1)
    assert slope > 0.0
    assert np.abs(slope * u + middle - moved).max() < 2.0  # pixels
