"""The energy ledger against quadrature of the history and against closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import simpson

from builders import frame_values
from rockflex import Frame, Ground, GroundMotion, InitialState, InputError, Springs, load_suite, quiet_motion, simulate
from rockflex.response import _energy

GRAVITY = 9.81


def frame(**changes):
    given = frame_values(
        n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.03
    )
    return Frame(**{**given, **changes})


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S", "fixed"])
@pytest.mark.parametrize("factor", [0.3, 2.0, 40.0])
def test_the_ledger_closes(model, factor):
    """Uplifted or not, overturned or not, on a fixed base too."""
    motion = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:600] * factor, 0.02)
    run = simulate(frame(), motion, model, free_vibration=1.0)
    energy = run.energy
    assert energy.closing_error < 1e-9
    assert energy.closing_error == np.abs(energy.residual).max() / np.abs(energy.input).max()
    for name in ("kinetic", "strain", "gravity", "damped", "yielded", "input", "lost", "residual"):
        assert getattr(energy, name).shape == run.time.shape
    assert not energy.yielded.any()
    assert np.all(energy.kinetic >= 0.0)
    assert np.all(energy.strain >= 0.0)
    assert np.all(np.diff(energy.damped) >= 0.0)
    assert np.all(np.diff(energy.lost) >= 0.0)
    assert not energy.gravity[run.side == 0.0].any()
    assert energy.impact_losses.size == run.n_impacts
    assert energy.lost[-1] == pytest.approx(energy.impact_losses.sum())


def test_input_and_damping_are_the_integrals_that_they_claim():
    motion = GroundMotion(load_suite("el-centro-1940")[0].acceleration[50:250] * 2.0, 0.02).refined(200)
    run = simulate(frame(), motion, "3DOF-S")
    p, energy = run.history.model.properties, run.energy
    power = -run.ground_acceleration * (p.l0r * run.rotation_velocity + run.modal_velocity @ p.effective_mass)
    drag = run.modal_velocity**2 @ (2.0 * p.zeta * p.omega * p.effective_mass)
    edges = np.concatenate(([0], np.flatnonzero(np.diff(run.time) == 0.0) + 1, [run.time.size]))
    pieces = [slice(a, b) for a, b in pairwise(edges) if b - a > 2]
    assert len(pieces) > 5
    for rate, total in ((power, energy.input), (drag, energy.damped)):
        size = np.abs(total).max()
        for piece in pieces:
            # The rule of Simpson straddles the corners of the record.
            mine = total[piece][-1] - total[piece][0]
            assert mine == pytest.approx(simpson(rate[piece], x=run.time[piece]), abs=3e-6 * size)


@pytest.mark.parametrize("n_modes", [1, 3])
def test_free_undamped_motion_keeps_its_energy_between_impacts(n_modes):
    structure = frame(damping_ratio=0.0)
    p = structure.rocking()
    start = InitialState(rotation=0.4 * p.m_tot * p.half_width / p.l0r)
    run = simulate(structure, quiet_motion(12.0, dt=0.02), f"{n_modes + 1}DOF-S", initial=start)
    assert run.n_impacts >= 5
    energy = run.energy
    assert not energy.damped.any()
    assert not energy.input.any()
    total = energy.kinetic + energy.strain + energy.gravity
    first = p.m_tot * GRAVITY * p.half_width * start.rotation - 0.5 * p.l0r * GRAVITY * start.rotation**2
    assert total[0] == pytest.approx(first, rel=1e-14)
    np.testing.assert_allclose(total + energy.lost, total[0], rtol=1e-11)
    # Each loss by the law of impact, from the states on both sides; never a gain.
    k = np.flatnonzero((run.side[:-1] != 0.0) & (run.side[1:] == 0.0))
    kept = run.history.model.properties
    inertia = kept.i_theta - float(kept.effective_mass @ kept.effective_height**2)
    expected = 0.5 * run.rotation_velocity[k] ** 2 * inertia
    np.testing.assert_allclose(energy.impact_losses, expected, rtol=1e-13, atol=1e-14 * total[0])
    np.testing.assert_allclose(total[k] - total[k + 1], energy.impact_losses, rtol=1e-8, atol=1e-12 * total[0])
    assert np.all(energy.impact_losses > 0.0)


def test_at_rest_there_is_nothing_to_account_for():
    run = simulate(frame(), quiet_motion(1.0))
    assert run.energy.closing_error == 0.0
    assert not run.energy.residual.any()


def test_where_steps_are_long_against_the_fastest_mode():
    """A sample in which a damped mode decays many times over still has an exact ledger."""
    motion = GroundMotion(2.0 * np.random.default_rng(2).standard_normal(40), 0.2)
    run = simulate(frame(period=0.2, damping_ratio=0.3), motion, "3DOF-S")
    assert run.n_impacts > 2
    assert run.energy.closing_error < 1e-9


def test_undisturbed_runs_close_to_rounding():
    """Without events nothing but the rounding of the states and of the quadrature is left."""
    for label in ("fixed", "1DOF-fixed"):
        run = simulate(frame(), GroundMotion(load_suite("el-centro-1940")[0].acceleration, 0.02), label)
        assert run.energy.closing_error < 1e-12


@pytest.mark.parametrize("damping_ratio", [0.01, 0.9])
def test_the_quadrature_follows_any_speed(damping_ratio):
    """Stiff or overdamped, the integrals of a single mode are those of its closed form."""
    structure = frame(period=2e-4, damping_ratio=damping_ratio)
    start = InitialState(modal_displacement=[1e-9])
    run = simulate(structure, quiet_motion(0.1, dt=0.02), "1DOF-fixed", initial=start)
    p, energy = run.history.model.properties, run.energy
    assert p.omega[0] * 0.02 > 600.0
    stored = 0.5 * p.effective_mass[0] * (p.omega[0] * 1e-9) ** 2
    if damping_ratio == 0.9:
        assert energy.damped[1] == pytest.approx(stored, rel=1e-12)
    assert energy.closing_error < 1e-11
    assert energy.damped[-1] == pytest.approx(stored - energy.kinetic[-1] - energy.strain[-1], rel=1e-10)


def test_what_is_gone_at_once_costs_nothing():
    """Motions that decay within a step, at 2e5 rad/s here, are not followed to its end."""
    structure = frame()
    half_width = structure.rocking().half_width
    ground = Ground(springs=Springs([-half_width, half_width], 3e8, 1e9), base_inertia=60e3)
    motion = GroundMotion(6.0 * np.sin(0.07 * np.arange(60)), 0.01)
    assert simulate(structure, motion, "2DOF-S", ground=ground, work_limit=None).energy.closing_error < 1e-11


@pytest.mark.parametrize("settlement", [1e-4, 1e-7])
def test_nearly_rigid_springs(settlement):
    """What each dashpot takes is the integral of a square, not a small difference of large energies."""
    structure = frame()
    p = structure.rocking()
    stiffness = p.m_tot * GRAVITY / 2.0 / settlement
    ground = Ground(springs=Springs([-p.half_width, p.half_width], stiffness, 1e-4 * stiffness), base_inertia=60e3)
    motion = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:200] * 2.0, 0.02)
    run = simulate(structure, motion, "2DOF-S", ground=ground, work_limit=None)
    assert run.n_uplifts > 2
    assert run.energy.closing_error < 1e-9
    assert run.energy.soil[-1].min() > 0.0


def test_energies_in_parts_are_those_at_once(monkeypatch):
    """Long histories are taken in parts, so that they fit in memory."""
    motion = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:600] * 2.0, 0.02)
    run = simulate(frame(), motion, "MDOF-S")
    states, model = run.history.states, run.history.model
    whole = _energy.energy_between_states(model, states)
    monkeypatch.setattr(_energy, "CHUNK", 37)
    for one, other in zip(_energy.energy_between_states(model, states), whole, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(other).max(initial=0.0))


def test_a_model_too_fast_for_its_record(monkeypatch):
    """Hours of power series are refused under vertical motion; the rest of the response is there."""
    start = InitialState(rotation=1e-3)
    run = simulate(frame(), GroundMotion(np.zeros(3), 0.05, vertical=[0.0, 1.0, 0.0]), "2DOF-S", initial=start)
    monkeypatch.setattr(_energy, "MAX_SERIES", 0)
    text = (
        r"The energy ledger of 2DOF-S needs \d power series per step, above the limit of 0, since the ground moves "
        r"vertically: the model vibrates or decays at up to \d+\.?\d* rad/s, and steps last up to 0\.0\d* s\. Keep "
        r"fewer modes, or refine the record\."
    )
    with pytest.raises(InputError, match=text):
        _ = run.energy
    assert run.max_rotation >= 1e-3


def test_a_fast_model_without_vertical_motion():
    start = InitialState(modal_displacement=[1e-9])
    run = simulate(frame(period=1e-6), quiet_motion(0.1, dt=0.05), "1DOF-fixed", initial=start)
    assert run.energy.closing_error < 1e-6
