"""Nonlinear and rigid runs from other states than rest, in free vibration, and to the end."""

import re

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins import impact_laws
from twins.complete import complete_frame, simulate_complete

GRAVITY = 9.81
GIVEN = frame_values(
    n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=6.0, damping_ratio=0.03
)
FRAME = rf.Frame(**GIVEN)
TIME = 0.02 * np.arange(201)
MOTION = rf.GroundMotion(4.5 * np.sin(0.8 * TIME) * (np.sin(9.0 * TIME + 0.4) + 0.6 * np.sin(27.0 * TIME)), 0.02)
ROCKING = ["rigid", "rigid-C", "2DOF-C", "2DOF-C-SI", "3DOF-C-E", "MDOF-C", "2DOF-S"]


@pytest.mark.parametrize("model", ROCKING)
@pytest.mark.parametrize("record", [rf.quiet_motion(1.0), MOTION], ids=["quiet", "shaken"])
def test_runs_settle(model, record):
    """Nothing more happens in as long again, and the same with a fixed time."""
    run = rf.simulate(FRAME, record, model, free_vibration="settle", initial=rf.InitialState(0.03))
    assert run.settled
    assert run.side[-1] == 0.0
    assert run.n_impacts >= 1
    longer = rf.simulate(FRAME, record, model, free_vibration=2.0 * run.end_time + 5.0, initial=rf.InitialState(0.03))
    assert not longer.settled
    for name, value in run.peaks().items():
        if name not in ("end_time", "settled"):
            close = pytest.approx(value, rel=1e-9, abs=1e-9) if isinstance(value, float) else value
            assert getattr(longer, name) == close, name
    assert longer.uplift_times.max(initial=0.0) <= run.end_time


def test_overturning_ends_a_run_that_was_to_settle():
    for model in ("2DOF-C", "rigid-C", "rigid", "MDOF-C"):
        run = rf.simulate(FRAME, rf.quiet_motion(0.1), model, free_vibration="settle", initial=rf.InitialState(0.3))
        assert (run.status, run.settled) == ("overturned", False)
        assert run.max_rotation == 0.5 * np.pi
        assert run.time_of_max_rotation == run.end_time == run.time[-1]
        assert run.rotation[-1] == pytest.approx(0.5 * np.pi, rel=1e-15)


@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C", "1DOF-fixed", "2DOF-S-BW"])
def test_no_one_knows_when_a_hysteretic_spring_is_at_rest(model):
    label = model if model.endswith("-BW") else f"{model}-BW"
    text = (
        f'free_vibration="settle" cannot tell when the hysteretic spring of {label} is at rest. '
        "Give the free vibration in seconds."
    )
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(FRAME, MOTION, model, free_vibration="settle", bouc_wen=rf.BoucWen(0.05))
    assert str(caught.value) == text
    table = rf.simulate_many(FRAME, MOTION, model, free_vibration="settle", bouc_wen=rf.BoucWen(0.05))
    assert table["error"].tolist() == [text]


@pytest.mark.parametrize("model", ["2DOF-C", "MDOF-C", "rigid-C", "rigid", "1DOF-fixed"])
def test_quiet_ground_moves_nothing(model):
    run = rf.simulate(FRAME, rf.quiet_motion(1.0), model, free_vibration=1.0)
    assert run.status == "no_uplift"
    assert not run.history.states[:, 1:].any()
    assert run.end_time == 2.0
    yields = rf.simulate(FRAME, rf.quiet_motion(1.0), "2DOF-S", bouc_wen=rf.BoucWen(0.05))
    assert not yields.history.states[:, 1:].any()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "n", "law"),
    [
        ("2DOF-C", 1, impact_laws.CompleteVVEL()),
        ("MDOF-C", 3, impact_laws.CompleteVVEL()),
        ("3DOF-C-SI", 2, impact_laws.SimplifiedVVEL()),
    ],
)
@pytest.mark.parametrize(
    "start", [(0.05, [0.02], [0.1], -0.2), (-0.03, None, [-0.4], 0.0), (0.0, [-0.01], None, 0.3)], ids=str
)
def test_any_state_starts_a_run(model, n, law, start):
    rotation, d, v, spin = start
    pad = [0.0] * (n - 1)
    twin = simulate_complete(
        **complete_frame(**GIVEN, n_modes=n),
        acceleration=np.zeros(101),
        dt=0.02,
        law=law,
        rotation=rotation,
        rotation_velocity=spin,
        modal_displacement=d and d + pad,
        modal_velocity=v and v + pad,
    )
    run = rf.simulate(FRAME, rf.quiet_motion(2.0, dt=0.02), model, initial=rf.InitialState(rotation, d, v, spin))
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear"):
        assert getattr(run, name) == pytest.approx(getattr(twin, name), rel=1e-8), name
    first = run.history.states[0]
    assert first[: 6 + 2 * n].tolist() == [
        0,
        np.sign(rotation or spin),
        0,
        0,
        *(d or [0.0]),
        *pad,
        *(v or [0]),
        *pad,
        rotation,
        spin,
    ]


def test_a_rigid_block_keeps_its_energy_and_pendulum():
    """Under full trigonometry, from a rotation: θ'² = 2 g/I [m B (sin θ0 - sin θ) + L (cos θ0 - cos θ)]."""
    p = FRAME.rocking(1).truncated(0)
    start = 0.1
    run = rf.simulate(p, rf.quiet_motion(2.0, dt=0.02), "rigid-C", initial=rf.InitialState(start))
    until = int(np.flatnonzero(run.side == 0.0)[0]) if (run.side == 0.0).any() else run.time.size
    first = int(np.flatnonzero(np.diff(run.time) == 0.0)[0]) + 1
    assert first <= until
    theta, spin = run.rotation[:first], run.rotation_velocity[:first]
    raised = p.m_tot * p.half_width * (np.sin(start) - np.sin(theta)) + p.l0r * (np.cos(start) - np.cos(theta))
    np.testing.assert_allclose(0.5 * p.i_theta * spin**2, GRAVITY * raised, rtol=1e-9, atol=1e-9 * p.i_theta)
    assert run.max_base_moment == run.max_base_shear == run.max_top_displacement == 0.0


def test_a_rigid_block_lifts_at_its_slenderness():
    p = FRAME.rocking().truncated(0)
    for model in ("rigid", "rigid-C"):
        for factor, status in ((0.999, "no_uplift"), (1.001, "rocking")):
            peak = factor * GRAVITY * p.m_tot * p.half_width / p.l0r
            motion = rf.GroundMotion(np.array([0.0, peak, 0.0]), 0.1)
            assert rf.simulate(p, motion, model).status == status
            assert rf.simulate(FRAME, motion, model).status == status


def test_a_state_that_the_ground_cannot_hold_lifts_at_once():
    for model in ("2DOF-C", "MDOF-C"):
        run = rf.simulate(FRAME, rf.quiet_motion(0.5), model, initial=rf.InitialState(modal_displacement=[0.2]))
        assert run.uplift_times[0] == 0.0
        assert run.time_of_max_top_displacement == 0.0


def test_weight_on_a_bent_structure_lifts_it_sooner():
    """Eq. 16 has the displaced weight, Eq. 24 has not: the limits of D_1 differ by m* g D_1."""
    p = FRAME.rocking(1)
    (m,), (h,), (omega,) = p.effective_mass, p.effective_height, p.omega
    moment = p.m_tot * GRAVITY * p.half_width
    for model, stiffness in (("2DOF-S", m * h * omega**2), ("2DOF-C", m * h * omega**2 + m * GRAVITY)):
        limit = moment / stiffness
        for factor, lifts in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
            run = rf.simulate(
                FRAME, rf.quiet_motion(0.001), model, initial=rf.InitialState(modal_displacement=[factor * limit])
            )
            assert (run.n_uplifts > 0) == lifts


def test_a_fixed_base_neither_rotates_nor_is_complete():
    for initial in (rf.InitialState(0.1), rf.InitialState(rotation_velocity=0.1)):
        with pytest.raises(rf.InputError, match="1DOF-fixed-BW has a base that cannot lift"):
            rf.simulate(FRAME, rf.quiet_motion(0.1), "1DOF-fixed", bouc_wen=rf.BoucWen(0.05), initial=initial)


def test_a_block_has_no_modes_to_start_from():
    with pytest.raises(
        rf.InputError, match=re.escape("modal_displacement has 1 value, but rigid has 0 modes. Give at")
    ):
        rf.simulate(FRAME, rf.quiet_motion(0.1), "rigid", initial=rf.InitialState(modal_displacement=[0.1]))


@pytest.mark.parametrize("model", ["rigid-C", "2DOF-C", "MDOF-C"])
@pytest.mark.parametrize("velocity", [-9.9e8, -1e3, 1e3, 9.9e8])
def test_whatever_is_accepted_is_solved(model, velocity):
    start = rf.InitialState(0.1, None if model == "rigid-C" else [1e3], rotation_velocity=velocity)
    run = rf.simulate(FRAME, rf.quiet_motion(0.1), model, impact=rf.VVELSimplified(), initial=start)
    assert np.isfinite(run.history.states).all()
    assert np.isfinite(run.energy.residual).all()


def test_free_vibration_follows_a_record():
    """Its end, with a jump of the acceleration to zero, and the rest from there."""
    values = np.concatenate((MOTION.acceleration[:120], [1.5]))
    cut = rf.GroundMotion(values, 0.02)
    for model, options in (("2DOF-C", {}), ("rigid-C", {"impact": rf.Restitution(0.9)})):
        run = rf.simulate(FRAME, cut, model, free_vibration=1.0, **options)
        twin_end = np.flatnonzero(run.time == 120 * 0.02)
        assert run.ground_acceleration[twin_end].tolist() == [1.5, 0.0]
        assert run.end_time == pytest.approx(120 * 0.02 + 1.0)
        short = rf.simulate(FRAME, cut, model, **options)
        assert np.array_equal(run.history.states[: short.time.size], short.history.states)
        last = short.history.states[-1]
        n = (last.size - 10) // 2
        rest = rf.simulate(
            FRAME,
            rf.quiet_motion(1.0, dt=0.02),
            model,
            initial=rf.InitialState(last[4 + 2 * n], last[4 : 4 + n], last[4 + n : 4 + 2 * n], last[5 + 2 * n]),
            **options,
        )
        np.testing.assert_allclose(rest.rotation[-1], run.rotation[-1], rtol=1e-7, atol=1e-12)
