"""Free vibration until nothing more can happen, and runs with impacts without number."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

GRAVITY = 9.81
EL_CENTRO = rf.load_suite("el-centro-1940")[0]


def frame(**changes):
    given = frame_values(n_stories=3, period=0.8, aspect_ratio=9.0)
    return {**given, **changes}


def block():
    return rf.RockingProperties(
        omega=[400.0],
        effective_mass=[9e4],
        effective_height=[8.0],
        top_ordinate=[1.0],
        i_theta=1.1e7,
        l0r=9e5,
        m_tot=1.4e5,
        half_width=0.8,
        zeta=0.05,
    )


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S", "fixed"])
@pytest.mark.parametrize("factor", [0.2, 1.0, 2.5])
def test_no_longer_run_finds_more(model, factor):
    """A settled run has the peaks and the counts of one that goes on for as long again."""
    motion = EL_CENTRO.scaled(factor)
    run = rf.simulate(rf.Frame(**frame()), motion, model, free_vibration="settle", output="peaks")
    assert run.settled
    assert motion.duration <= run.end_time < 300.0
    longer = rf.simulate(
        rf.Frame(**frame()), motion, model, free_vibration=2.0 * run.end_time - motion.duration, output="peaks"
    )
    assert not longer.settled
    same = {key: value for key, value in run.peaks().items() if key not in ("settled", "end_time")}
    assert same.items() <= longer.peaks().items()


@pytest.mark.parametrize("peak", [1.0, 15.0])
def test_peaks_after_a_short_shock_are_waited_for(peak):
    """The shock is over within an eighth of the period, long before the peaks."""
    motion = rf.GroundMotion([0.0, peak, 0.0], 0.05)
    run = rf.simulate(rf.Frame(**frame()), motion, free_vibration="settle")
    longer = rf.simulate(rf.Frame(**frame()), motion, free_vibration=60.0)
    assert (run.status, run.n_impacts) == (longer.status, longer.n_impacts)
    assert run.settled
    assert run.time_of_max_top_displacement > motion.duration
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear"):
        assert getattr(run, name) == getattr(longer, name)
    for name in ("story_drift", "story_shear", "floor_acceleration"):
        assert np.array_equal(getattr(run.floors, name), getattr(longer.floors, name))


@pytest.mark.parametrize(("factor", "status"), [(1.003, "overturned"), (0.997, "rocking")])
def test_what_still_rocks_outward_at_the_end_of_the_record_is_decided(factor, status):
    """The least half sine that overturns a rigid block, r = 1.800724 at Ω = 2: the pulse is over long before."""
    p = block()
    rate, alpha = math.sqrt(p.l0r * GRAVITY / p.i_theta), p.m_tot * p.half_width / p.l0r
    n = 150
    pulse = -factor * 1.800724 * GRAVITY * alpha * np.sin(np.linspace(0.0, np.pi, n + 1))
    motion = rf.GroundMotion(pulse, np.pi / (2.0 * rate) / n)
    cut = rf.simulate(p, motion)
    assert cut.status == "rocking"
    assert cut.rotation[-1] > 0.0
    assert cut.rotation_velocity[-1] > 0.0
    run = rf.simulate(p, motion, free_vibration="settle")
    assert run.status == status
    assert run.settled == (status == "rocking")
    assert run.max_rotation > 1.5 * cut.max_rotation
    assert np.array_equal(run.history.states[: len(cut.time)], cut.history.states)


def test_history_grows_as_long_as_it_takes():
    """A free vibration that is settled only after many samples: the history is whole all the same."""
    start = rf.InitialState(rotation=0.03)
    run = rf.simulate(rf.Frame(**frame()), rf.quiet_motion(0.02, dt=0.002), free_vibration="settle", initial=start)
    assert run.settled
    assert len(run.time) > 1000
    assert np.all(np.diff(run.time) > -1e-12)
    assert run.time[-1] == pytest.approx(run.end_time, abs=1e-12)
    fixed = rf.simulate(
        rf.Frame(**frame()), rf.quiet_motion(0.02, dt=0.002), free_vibration=run.end_time - 0.02, initial=start
    )
    assert np.array_equal(run.history.states, fixed.history.states)


def test_a_single_undamped_mode_settles():
    """Its amplitude in contact is known for ever after, and below what lifts the base."""
    given = frame(n_stories=1, damping_ratio=0.0)
    run = rf.simulate(
        rf.Frame(**given), rf.quiet_motion(1.0), free_vibration="settle", initial=rf.InitialState(rotation=0.01)
    )
    assert run.settled
    assert run.n_impacts >= 1
    at_rest = rf.simulate(rf.Frame(**given), rf.quiet_motion(1.0), free_vibration="settle")
    assert (at_rest.settled, at_rest.end_time) == (True, 1.0)


def test_undamped_modes_may_add_up_for_ever():
    start = rf.InitialState(rotation=0.01)
    with pytest.raises(rf.SolverError) as caught:
        rf.simulate(rf.Frame(**frame(damping_ratio=0.0)), rf.quiet_motion(1.0), free_vibration="settle", initial=start)
    text = str(caught.value)
    assert text.startswith("The free vibration of MDOF-S has not settled ")
    assert "s after the start. The state there is D = [" in text
    assert text.endswith("Give free_vibration in seconds, or more damping.")


def test_motions_beyond_any_number_end():
    """Whatever comes of them: an answer without NaN, or an error."""
    for factor in (1e120, 1e200, 1e290):
        for motion in (EL_CENTRO, rf.load_suite("fema-p695-far-field")["FF-12-a"]):
            try:
                run = rf.simulate(rf.Frame(**frame()), motion.scaled(factor), output="peaks")
            except rf.SolverError:
                continue
            assert run.status == "overturned"
            peaks = run.peaks()
            assert math.isnan(peaks.pop("residual_rotation"))
            assert not any(math.isnan(value) for value in peaks.values() if isinstance(value, float))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("stiffness_ratio", [0.0, np.inf])
def test_chattering(seed, stiffness_ratio):
    """A stiff frame under white noise: impacts by the hundred, each of them found."""
    given = frame(n_stories=2, period=0.1, aspect_ratio=2.0, damping_ratio=0.1, stiffness_ratio=stiffness_ratio)
    record = 6.0 * np.random.default_rng(seed).standard_normal(1500)
    mine = rf.simulate(rf.Frame(**given), rf.GroundMotion(record, 0.01))
    twin = simulate_fine(**frame_properties(**given), acceleration=record, dt=0.01, substeps=64)
    assert mine.n_impacts >= 100
    assert (mine.status, mine.n_uplifts, mine.n_impacts) == (twin.status, twin.n_uplifts, twin.n_impacts)
    assert mine.max_rotation == pytest.approx(twin.max_rotation, rel=1e-8)


@pytest.mark.parametrize("damping_ratio", [0.0, 0.02, 0.5, 0.95])
@pytest.mark.parametrize("period", [0.02, 0.2, 5.0])
@pytest.mark.parametrize("dt", [0.001, 0.05])
def test_every_run_ends(damping_ratio, period, dt):
    record = 8.0 * np.random.default_rng(5).standard_normal(200)
    for aspect_ratio in (1.5, 6.0, 25.0):
        given = frame(period=period, damping_ratio=damping_ratio, aspect_ratio=aspect_ratio)
        run = rf.simulate(rf.Frame(**given), rf.GroundMotion(record, dt), output="peaks")
        assert run.n_uplifts - run.n_impacts in (0, 1)
        assert all(math.isfinite(value) for key, value in run.peaks().items() if key.startswith("max_"))
