"""What must not change a response, for random frames under random stretches of records and noise."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from builders import frame_values
from rockflex import Frame, GroundMotion, load_suite, simulate
from strategies import GRAVITY, frame_arguments, noises, stretches
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

TINY = 1e-13  # rad, of a slenderness of about 0.1: rounding, below which a rotation has no digits
VALUES = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")
TIMES = tuple(f"time_of_{name}" for name in VALUES)

frames = frame_arguments(8, 2.5, damping_ratio=st.floats(0.01, 0.1))


def motions(samples=400):
    return stretches(samples, (0.3, 5.0)) | noises(samples // 2, (0.3, 5.0), [0.005, 0.02, 0.05])


def examples(count):
    return settings(max_examples=count, deadline=None)


def sensitivity(structure, motion, model="MDOF-S"):
    """By how much the peaks move where the record is changed in its last digits."""
    base = simulate(structure, motion, model, output="peaks")
    others = [simulate(structure, motion.scaled(1.0 + k * 1e-15), model, output="peaks") for k in (-2, -1, 1, 2)]
    return max(
        abs(getattr(other, name) - getattr(base, name)) / (getattr(base, name) or 1.0)
        for other in others
        for name in VALUES
    )


def turned(response):
    """The one peak with a sign, of the mirror image."""
    return {"residual_rotation": pytest.approx(-response.residual_rotation, rel=0.0, abs=0.0, nan_ok=True)}


def assert_same_peaks(one, other, rtol, *, later=0.0, forces=1.0):
    assert (one.status, one.nominal_overturning) == (other.status, other.nominal_overturning)
    for name in VALUES:
        factor = forces if "base" in name else 1.0
        least = TINY if name == "max_rotation" else 1e-300
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=rtol, abs=least), name
    if rtol <= 1e-9:
        assert (one.n_uplifts, one.n_impacts) == (other.n_uplifts, other.n_impacts)
        assert other.end_time == pytest.approx(one.end_time + later, abs=1e-6)


@examples(80)
@given(frames, motions(), st.sampled_from(["MDOF-S", "2DOF-S", "fixed"]))
def test_a_mirrored_record_mirrors_the_response(given_, motion, model):
    structure = Frame(**given_)
    one, other = simulate(structure, motion, model), simulate(structure, motion.scaled(-1.0), model)
    assert one.peaks() == other.peaks() | turned(other)
    assert np.array_equal(one.history.states[:, 0], other.history.states[:, 0])
    assert np.array_equal(one.history.states[:, 1:], -other.history.states[:, 1:])


@examples(60)
@given(frames, motions())
def test_a_base_too_wide_to_lift_is_fixed(given_, motion):
    properties = Frame(**given_).rocking()
    wide = 1e5 * properties.half_width
    inertia = properties.translational_inertia
    structure = dataclasses.replace(
        properties,
        half_width=wide,
        i_theta=inertia + properties.m_tot * wide**2,
        translational_inertia=inertia,
    )
    free, fixed = simulate(structure, motion), simulate(structure, motion, "fixed")
    assert free.status == "no_uplift"
    assert_same_peaks(fixed, free, 1e-12)
    np.testing.assert_allclose(free.base_moment, fixed.base_moment, rtol=0.0, atol=1e-12 * fixed.max_base_moment)


@examples(40)
@given(frames, motions())
def test_as_many_modes_as_there_are_is_all_of_them(given_, motion):
    structure = Frame(**given_)
    one, other = simulate(structure, motion, f"{given_['n_stories'] + 1}DOF-S"), simulate(structure, motion)
    assert np.array_equal(one.history.states, other.history.states)
    assert {**one.peaks(), "model": "MDOF-S"} == other.peaks()


@examples(60)
@given(frames, motions(), st.integers(2, 5), st.sampled_from(["MDOF-S", "2DOF-S", "fixed"]))
def test_refining_the_record_changes_no_peak(given_, motion, k, model):
    structure = Frame(**given_)
    bound = max(1e-9, 100.0 * sensitivity(structure, motion, model))
    one = simulate(structure, motion, model, output="peaks")
    other = simulate(structure, motion.refined(k), model, output="peaks")
    assert_same_peaks(one, other, bound)


@examples(60)
@given(frames, motions(), st.integers(1, 200))
def test_a_late_start_shifts_the_response(given_, motion, quiet):
    structure = Frame(**given_)
    early = GroundMotion(np.concatenate(([0.0], motion.acceleration)), motion.dt)
    late = GroundMotion(np.concatenate((np.zeros(quiet + 1), motion.acceleration)), motion.dt)
    one, other = simulate(structure, early), simulate(structure, late)
    assert_same_peaks(one, other, max(1e-12, 100.0 * sensitivity(structure, early)), later=quiet * motion.dt)
    assert not other.history.states[: quiet + 1, 1:].any()
    if one.n_uplifts:
        assert other.uplift_times[0] == pytest.approx(one.uplift_times[0] + quiet * motion.dt, abs=1e-9)


@examples(60)
@given(frames, motions(), st.floats(1e-3, 1e3))
def test_heavier_by_a_factor_is_stronger_by_it(given_, motion, factor):
    """All masses times c leave rotations and displacements, and multiply forces by c."""
    one = Frame(**given_)
    heavy = Frame(**{**given_, "story_mass": factor * given_["story_mass"], "base_mass": factor * given_["base_mass"]})
    bound = max(1e-9, 100.0 * sensitivity(one, motion))
    assert_same_peaks(
        simulate(one, motion, output="peaks"), simulate(heavy, motion, output="peaks"), bound, forces=factor
    )


@examples(60)
@given(frames, motions(), st.floats(0.1, 10.0))
def test_larger_by_a_factor_is_slower_by_its_root(given_, motion, factor):
    """Froude's similarity: lengths times c and times by √c leave rotations, and multiply displacements by c."""
    one = Frame(**given_)
    large = Frame(
        **{
            **given_,
            "story_height": factor * given_["story_height"],
            "period": np.sqrt(factor) * given_["period"],
        }
    )
    slow = GroundMotion(motion.acceleration, np.sqrt(factor) * motion.dt)
    bound = max(1e-9, 100.0 * sensitivity(one, motion))
    small, big = simulate(one, motion, output="peaks"), simulate(large, slow, output="peaks")
    assert big.max_rotation == pytest.approx(small.max_rotation, rel=bound, abs=TINY)
    assert big.max_top_displacement == pytest.approx(factor * small.max_top_displacement, rel=bound)
    assert big.max_base_moment == pytest.approx(factor * small.max_base_moment, rel=bound)
    assert big.max_base_shear == pytest.approx(small.max_base_shear, rel=bound)


@examples(25)
@given(frames, motions(200), st.data())
def test_the_twin_agrees(given_, motion, data):
    """Dense exponentials on 64 exact sub-samples a sample; the bound is that of a record changed by 1e-14."""
    n = data.draw(st.integers(1, given_["n_stories"]))
    mine = simulate(Frame(**given_), motion, f"{n + 1}DOF-S")
    parameters = frame_properties(**given_, n_modes=n).kwargs()
    looks = 64 if motion.dt < 0.05 else 256

    def look(factor):
        return simulate_fine(**parameters, acceleration=factor * motion.acceleration, dt=motion.dt, substeps=looks)

    twin, moved = look(1.0), look(1.0 + 1e-14)
    moves = max(abs(getattr(moved, name) - getattr(twin, name)) / (getattr(twin, name) or 1.0) for name in VALUES)
    assert (mine.status, mine.n_uplifts, mine.n_impacts) == (twin.status, twin.n_uplifts, twin.n_impacts)
    for name in VALUES:
        assert getattr(mine, name) == pytest.approx(getattr(twin, name), rel=max(1e-8, 1e4 * moves), abs=TINY), name


@examples(40)
@given(frames, motions(), st.floats(1e-3, 2.0))
def test_stronger_shaking_of_a_fixed_base_is_proportional(given_, motion, factor):
    structure = Frame(**given_)
    one, other = (simulate(structure, motion.scaled(f), "fixed", output="peaks") for f in (1.0, factor))
    for name in VALUES:
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=1e-10, abs=1e-300)


def test_such_frames_do_rock():
    """Otherwise these laws would say little."""
    statuses = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        given_ = frame_values(
            n_stories=int(rng.integers(1, 9)),
            stiffness_ratio=rng.choice([0.0, 0.125, 1.0, np.inf]),
            period=rng.uniform(0.2, 2.5),
            aspect_ratio=rng.uniform(3.0, 12.0),
            damping_ratio=rng.uniform(0.01, 0.1),
        )
        suite = load_suite("fema-p695-far-field")
        record = suite[int(rng.integers(len(suite)))].acceleration[500:900]
        motion = GroundMotion(record * (GRAVITY / 8.0 * rng.uniform(0.3, 5.0) / np.abs(record).max()), 0.01)
        statuses.append(simulate(Frame(**given_), motion, output="peaks").status)
    assert statuses.count("rocking") > 20
    assert statuses.count("no_uplift") > 3
