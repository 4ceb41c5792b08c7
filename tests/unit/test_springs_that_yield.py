"""Soil that yields: runs against an integration of their own, statics with its plateau, limits, energies, files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rockflex as rf

FRAME = rf.Frame(3, 3.0, 40e3, 60e3, 0.5, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
P = FRAME.rocking()
WEIGHT, B = P.m_tot * 9.81, P.half_width
RECORD = rf.load_suite("fema-p695-near-field-pulse")[3].scaled(1.2)


def bed(ratio: float, n: int = 6, damping: float = 4e5) -> rf.Springs:
    """Springs with the strength of `ratio` times the weight."""
    places = np.linspace(-B, B, n)
    return rf.Springs(places, 5e7, damping, capacity=ratio * WEIGHT / n)


def ground(springs: rf.Springs) -> rf.Ground:
    return rf.Ground(springs=springs, base_inertia=30e3)


def integrated(springs: rf.Springs, motion: rf.GroundMotion, step: float) -> tuple[float, np.ndarray]:
    """θ_max and permanent settlements of a frame with all modes, by the rule of Heun with small steps."""
    x, k, c, strength = springs.positions, springs.stiffness, springs.damping, springs.capacity
    assert strength is not None
    m, h, omega, zeta = P.effective_mass, P.effective_height, P.omega, P.zeta
    N = m.size
    M = np.zeros((N + 2, N + 2))
    M[range(N), range(N)] = m
    M[:N, N] = M[N, :N] = m * h
    M[N, N], M[N + 1, N + 1] = P.translational_inertia + 30e3, P.m_tot
    inverse, crushed = np.linalg.inv(M), np.zeros(x.size)
    y = np.zeros(2 * (N + 2))
    y[N + 1] = -WEIGHT / k.sum()

    def rates(y: Any, crushed: Any, a: float) -> tuple[Any, Any]:
        q, v = y[: N + 2], y[N + 2 :]
        w, speed = x * q[N] - q[N + 1], x * v[N] - v[N + 1]
        elastic = np.minimum(k * (w - crushed), strength)
        force = np.where(w > crushed, np.maximum(elastic + c * speed, 0.0), 0.0)
        on = np.zeros(N + 2)
        on[:N] = -m * (2.0 * zeta * omega * v[:N] + omega**2 * q[:N]) - m * a
        on[N] = P.l0r * 9.81 * q[N] - P.l0r * a - x @ force
        on[N + 1] = force.sum() - WEIGHT
        return np.append(v, inverse @ on), np.where((k * (w - crushed) >= strength) & (speed > 0.0), speed, 0.0)

    largest, count = 0.0, round(motion.dt / step)
    for first, last in zip(motion.acceleration[:-1], motion.acceleration[1:], strict=True):
        for i in range(count):
            a, b = first + (last - first) * i / count, first + (last - first) * (i + 1) / count
            one, settles = rates(y, crushed, a)
            two, _ = rates(y + step * one, crushed + step * settles, b)
            y = y + 0.5 * step * (one + two)
            w = x * y[N] - y[N + 1]
            crushed = np.maximum(crushed, w - strength / k)
            largest = max(largest, abs(y[N]))
    return largest, crushed


def test_a_run_is_that_of_small_steps() -> None:
    springs, motion = bed(1.6, 4), rf.one_sine_pulse(amplitude=4.0, period=0.7)
    short = rf.GroundMotion(motion.acceleration[::2], 2.0 * motion.dt, "pulse")
    largest, crushed = integrated(springs, short, short.dt / 40)
    run = rf.simulate(FRAME, short, ground=ground(springs), output="history")
    np.testing.assert_allclose(run.max_rotation, largest, rtol=2e-3)
    np.testing.assert_allclose(run.permanent_settlement[-1], crushed, rtol=5e-3, atol=1e-5)
    assert run.max_permanent_settlement == run.permanent_settlement[-1].max() > 1e-4


def test_ample_capacity_changes_nothing() -> None:
    strong, elastic = bed(1e6), rf.Springs(np.linspace(-B, B, 6), 5e7, 4e5)
    a, b = (rf.simulate(FRAME, RECORD, ground=ground(each), free_vibration=2.0) for each in (strong, elastic))
    assert a.max_permanent_settlement < 1e-14
    for name in ("max_rotation", "max_base_moment", "max_edge_uplift", "settlement", "n_uplifts"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=1e-9)


@pytest.mark.parametrize("vertical", [False, True])
def test_energy_closes_and_settlements_only_grow(vertical: bool) -> None:
    motion = RECORD.with_vertical(RECORD.scaled(0.4)) if vertical else RECORD
    run = rf.simulate(FRAME, motion, ground=ground(bed(1.5)), output="history", free_vibration=5.0)
    assert run.energy.closing_error < 1e-10
    assert np.diff(run.permanent_settlement, axis=0).min() > -1e-15
    assert run.max_permanent_settlement > 1e-3
    assert run.spring_force.min() > -1e-6


def test_a_push_from_above_settles_by_its_energy() -> None:
    """A heavier weight for a while: the work of the excess is that of the plastic force, up to the elastic parts."""
    springs = rf.Springs([-B, B], 5e8, 0.0, capacity=0.625 * WEIGHT)  # 1.25 W together
    zeros, up = np.zeros(400), np.zeros(400)
    up[1:200] = 0.4 * 9.81  # as much more weight: 1.4 W on 1.25 W
    up[:20], up[190:210] = np.linspace(0.0, 0.4 * 9.81, 20), np.linspace(0.4 * 9.81, 0.0, 20)
    motion = rf.GroundMotion(zeros, 1e-3, "push").with_vertical(rf.GroundMotion(up, 1e-3, "up"))
    run = rf.simulate(FRAME, motion, "2DOF-S", ground=ground(springs), output="history", free_vibration=1.0)
    assert run.energy.closing_error < 1e-9
    settled = run.permanent_settlement[-1]
    np.testing.assert_allclose(settled[0], settled[1], rtol=1e-9)
    np.testing.assert_allclose(run.energy.soil[-1].sum(), 1.25 * WEIGHT * settled[0], rtol=1e-9)


def test_mirrored_motions_have_mirrored_answers() -> None:
    there, back = (
        rf.simulate(FRAME, RECORD.scaled(sign), ground=ground(bed(1.8)), output="history") for sign in (1.0, -1.0)
    )
    np.testing.assert_allclose(
        there.permanent_settlement[-1], back.permanent_settlement[-1][::-1], rtol=1e-9, atol=1e-12
    )
    np.testing.assert_allclose(there.residual_rotation, -back.residual_rotation, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("ratio", [1.3, 2.0, 4.0])
def test_static_moment_reaches_its_plateau(ratio: float) -> None:
    """M = N B (1 - N/N_ult) - q δ²/24 of a continuous bed, with δ = q/(k' θ), less the moment of the weight."""
    q = ratio * WEIGHT / (2.0 * B)
    springs = rf.winkler_bed(B, 1.0, 5e8, n=200, bearing_capacity=q)
    theta = 0.03
    path = rf.moment_rotation(FRAME, [theta], ground=ground(springs))
    expected = WEIGHT * B * (1.0 - 1.0 / ratio) - q * (q / (5e8 * theta)) ** 2 / 24.0
    np.testing.assert_allclose(path.spring_moment[-1], expected, rtol=2e-3)
    plateau = springs.moment_capacity(WEIGHT)
    np.testing.assert_allclose(plateau, WEIGHT * B * (1.0 - 1.0 / ratio), rtol=2e-4)
    assert path.spring_moment.max() < plateau * (1.0 + 1e-9)


def test_few_springs_have_more_moment_and_two_have_the_least_of_both() -> None:
    for ratio in (1.4, 1.9, 3.0):
        two = rf.Springs([-B, B], 5e7, capacity=0.5 * ratio * WEIGHT)
        expected = B * min(WEIGHT, (ratio - 1.0) * WEIGHT)
        np.testing.assert_allclose(two.moment_capacity(WEIGHT), expected, rtol=1e-12)
    for n in (4, 8):
        found = bed(2.0, n).moment_capacity(WEIGHT)
        assert 1.0 <= found / (WEIGHT * B * 0.5) <= n / (n - 1) * (1.0 + 1e-12)


def test_a_loop_leaves_the_ground_settled() -> None:
    springs = bed(1.4, 8)
    path = rf.moment_rotation(FRAME, [0.02, -0.02, 0.0], ground=ground(springs))
    rest = rf.moment_rotation(FRAME, [0.0], ground=ground(springs))
    assert path.heave[-1] < rest.heave[-1] - 1e-4
    assert path.spring_force.max() <= springs.capacity[0] * (1.0 + 1e-12)
    np.testing.assert_allclose(path.spring_force.sum(axis=1), WEIGHT, rtol=1e-9)


def test_files_and_saved_responses_keep_the_capacity(tmp_path: Path) -> None:
    run = rf.simulate(FRAME, RECORD, ground=ground(bed(1.5)), output="history")
    read = rf.Response.load(run.save(tmp_path / "run.npz"))
    np.testing.assert_array_equal(read.permanent_settlement, run.permanent_settlement)
    assert read.settlement == run.settlement
    structure = tmp_path / "frame.toml"
    structure.write_text(
        "frame = { n_stories = 3, story_height = 3.0, story_mass = 40e3, base_mass = 60e3, stiffness_ratio = 0.5, "
        "period = 0.5, aspect_ratio = 6.0, damping_ratio = 0.03 }\n"
        "[ground]\nmat_mass = 60e3\n[ground.bed]\nbreadth = 2.0\nsubgrade_modulus = 4e7\nbearing_capacity = 1.5e6\n"
    )
    case = rf.Case(structures=[{"file": str(structure)}], records={"suites": ["el-centro-1940"]}, models=["2DOF-S"])
    assert case.run()["max_permanent_settlement"].notna().all()


@pytest.mark.parametrize(
    ("capacity", "model", "field"),
    [(0.1 * WEIGHT, "MDOF-S", "capacity"), (WEIGHT, "2DOF-C", "capacity"), (-1.0, "MDOF-S", "capacity")],
)
def test_what_cannot_be_is_refused(capacity: float, model: str, field: str) -> None:
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(FRAME, RECORD, model, ground=ground(rf.Springs([-B, B], 5e7, capacity=capacity)))
    assert caught.value.field == field
