"""Base shear and moment with the mass that the modes leave out: the limit of modes that are stiff."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model

EL_CENTRO = rf.load_suite("el-centro-1940")[0]
FRAME = make_frame(
    n_stories=2,
    story_height=4.0,
    story_mass=30e3,
    base_mass=20e3,
    stiffness_ratio=0.0,
    period=0.8,
    aspect_ratio=6.0,
    damping_ratio=0.05,
)
MOTION = rf.GroundMotion(2.5 * EL_CENTRO.acceleration[60:160], EL_CENTRO.dt)


def stiffened(factor):
    """The frame whose second mode follows the base at once, without ringing."""
    p = FRAME.rocking()
    return replace(p, omega=(p.omega[0], factor * p.omega[0]), zeta=(0.05, 0.95))


@pytest.mark.parametrize(
    ("whole", "cut", "factor"),
    [("fixed", "1DOF-fixed-R", 3000.0), ("MDOF-S", "2DOF-S-R", 3000.0), ("3DOF-C-SI", "2DOF-C-SI-R", 300.0)],
)
def test_a_mode_made_stiff_and_then_left_out_changes_nothing(whole, cut, factor):
    """Until the first impact: that strikes a stiff mode as it does any other, and no static share can tell."""
    p = stiffened(factor)
    one, other, bare = (rf.simulate(p, MOTION, label) for label in (whole, cut, cut.removesuffix("-R")))
    end = other.impact_times[0] if other.n_impacts else MOTION.duration
    lag = 2.0 * 0.95 / p.omega[1]  # by which the mode trails what it follows
    events = np.concatenate(([0.0], other.uplift_times))
    instants = [t for t in samples() if t < end and np.abs(t - events)[events <= t].min() > 30.0 * lag]
    assert len(instants) > 20
    if other.n_impacts:
        assert sum(t > other.uplift_times[0] for t in instants) > 10
    np.testing.assert_allclose(at(one, "rotation", instants), at(other, "rotation", instants), atol=1e-2 / factor)
    followed = at(other, "ground_acceleration", instants)
    followed += p.effective_height[1] * at(other, "rotation_acceleration", instants)
    rate = np.abs(np.diff(followed)).max() / MOTION.dt
    for name, arm in (("base_shear", 1.0), ("base_moment", p.effective_height[1])):
        mine, theirs, without = (at(run, name, instants) for run in (one, other, bare))
        error = np.abs(mine - theirs).max()
        assert error < 4.0 * p.effective_mass[1] * arm * rate * lag
        assert error < 0.05 * np.abs(mine - without).max()


def samples():
    return MOTION.dt * np.arange(MOTION.acceleration.size)


def at(run, name, instants):
    """A quantity at some samples, after any event there."""
    return np.array([getattr(run, name)[np.flatnonzero(np.abs(run.time - t) < 1e-9)[-1]] for t in instants])


def test_the_motion_is_the_same():
    for label in ("2DOF-S", "2DOF-C", "1DOF-fixed"):
        bare, corrected = (rf.simulate(FRAME, MOTION, end) for end in (label, f"{label}-R"))
        np.testing.assert_allclose(corrected.rotation, bare.rotation, rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(corrected.top_displacement, bare.top_displacement, rtol=0.0, atol=1e-9)
        assert abs(corrected.max_base_shear / bare.max_base_shear - 1.0) > 0.005
        assert corrected.model == f"{label}-R"


@pytest.mark.parametrize("label", ["2DOF-S-R", "2DOF-C-R", "1DOF-fixed-R", "2DOF-C-SI-R"])
def test_peaks_are_those_of_the_history(label):
    run, peaks = rf.simulate(FRAME, MOTION, label), rf.simulate(FRAME, MOTION, label, "peaks")
    for name in ("base_shear", "base_moment"):
        largest = getattr(peaks, f"max_{name}")
        assert largest == pytest.approx(getattr(run, f"max_{name}"), rel=1e-9)
        assert np.abs(getattr(run, name)).max() <= largest * (1.0 + 1e-12)


def test_nothing_is_left_out_by_all_modes():
    assert FRAME.rocking().mass_left_out.tolist() == [0.0, 0.0, 0.0]
    whole, corrected = (rf.simulate(FRAME, MOTION, label, "peaks") for label in ("MDOF-S", "MDOF-S-R"))
    assert whole.peaks() == {**corrected.peaks(), "model": "MDOF-S"}


def test_what_one_mode_leaves_out():
    p = FRAME.rocking()
    second = p.effective_mass[1] * p.effective_height[1] ** np.arange(3)
    np.testing.assert_allclose(p.truncated(1).mass_left_out, second, rtol=1e-9)


def test_a_horizontal_reaction_in_contact_is_the_base_shear_with_the_base_and_without_damping():
    """ΣF_x = V_b + the drag of the modes + m_0 a, with all modes and full contact."""
    run = rf.simulate(FRAME, MOTION, "fixed")
    p = FRAME.rocking()
    drag = run.modal_velocity @ (p.effective_mass * 2.0 * p.zeta * p.omega)
    expected = -run.base_shear - drag + 20e3 * run.ground_acceleration
    np.testing.assert_allclose(run.horizontal_reaction, expected, rtol=0.0, atol=1e-9 * run.max_base_shear)


@pytest.mark.parametrize("label", ["2DOF-S-R", "MDOF-C-R", "5DOF-fixed-R", "fixed-R", "3DOF-C-E-R", "2DOF-S-BW-R"])
def test_labels(label):
    assert parse_model(label).missing_mass
    assert parse_model(label).label == label


def test_a_rigid_block_has_no_base_shear():
    with pytest.raises(rf.InputError, match=r"A rigid block has no base shear of its own to correct\."):
        rf.Model(0, missing_mass=True)


def test_the_mass_of_the_base_must_be_known():
    p = rf.RockingProperties(
        omega=(6.0,), effective_mass=(1e5,), effective_height=(10.0,), top_ordinate=(1.3,), i_theta=1.5e7, l0r=1.2e6,
        m_tot=1.6e5, half_width=1.0, zeta=0.02,
    )  # fmt: skip
    assert p.base_mass is None
    with pytest.raises(rf.InputError, match=r"2DOF-S-R needs the mass above the base.*Give Rocking.* the base"):
        rf.simulate(p, MOTION, "2DOF-S-R")
    known = replace(p, base_mass=2e4)
    assert known.mass_left_out[0] == pytest.approx(4e4)
    assert rf.simulate(known, MOTION, "2DOF-S-R", "peaks").max_base_shear > 0.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"base_mass": 7e4}, r"base_mass must leave the effective mass of the modes, 100000 kg, but 70000 kg of m_tot"),
        ({"base_mass": -1.0}, r"base_mass must be a zero or positive, finite number in kg, but -1\.0 was given"),
        ({"top_height": 0.0}, r"top_height must be a positive, finite number in m, but 0\.0 was given"),
    ],
)
def test_what_properties_refuse(given, message):
    with pytest.raises(rf.InputError, match=message):
        rf.RockingProperties(
            omega=(6.0,), effective_mass=(1e5,), effective_height=(10.0,), top_ordinate=(1.3,), i_theta=1.5e7,
            l0r=1.2e6, m_tot=1.6e5, half_width=1.0, zeta=0.02, **given,
        )  # fmt: skip
