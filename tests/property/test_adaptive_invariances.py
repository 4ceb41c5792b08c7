"""What must not change a nonlinear response, for random frames under random stretches of records and noise."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockflex import BoucWen, Frame, Restitution, simulate
from strategies import frame_arguments, noises, stretches

VALUES = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")
TINY = 1e-13  # rad: rounding, below which a rotation has no digits

frames = frame_arguments(5, 2.0, damping_ratio=st.floats(0.01, 0.1))
models = st.sampled_from(["2DOF-C", "2DOF-C-SI", "MDOF-C", "MDOF-C-E", "rigid-C"])
springs = st.builds(
    BoucWen,
    st.floats(0.01, 0.1),
    st.floats(0.0, 0.3),
    st.just(0.5),
    st.floats(-0.3, 0.5),
    st.sampled_from([1.0, 2.0, 3.5, 8.0]),
)


def motions(samples=300):
    return stretches(samples, (0.3, 4.0)) | noises(samples // 2, (0.3, 4.0), [0.005, 0.02])


def examples(count):
    return settings(max_examples=count, deadline=None)


def sensitivity(structure, motion, model, **options):
    """By how much the peaks move where the record is changed by the error of the integration."""
    base = simulate(structure, motion, model, output="peaks", **options)
    others = [simulate(structure, motion.scaled(1.0 + k * 1e-11), model, output="peaks", **options) for k in (-1, 1)]
    return max(
        abs(getattr(other, name) - getattr(base, name)) / (getattr(base, name) or 1.0)
        for other in others
        for name in VALUES
    )


def turned(response):
    """The one peak with a sign, of the mirror image."""
    return {"residual_rotation": pytest.approx(-response.residual_rotation, rel=0.0, abs=0.0, nan_ok=True)}


def assert_same_peaks(one, other, rtol, forces=1.0):
    if rtol > 1e-4:  # such a motion tells rounding from nothing
        return
    assert (one.status, one.nominal_overturning) == (other.status, other.nominal_overturning)
    for name in VALUES:
        factor = forces if "base" in name else 1.0
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=rtol, abs=TINY), name


def mirrored(structure, motion, model, **options):
    return [simulate(structure, motion.scaled(f), model, **options) for f in (1.0, -1.0)]


def assert_mirrored(one, other):
    """To the last bit."""
    assert one.peaks() == other.peaks() | turned(other)
    nodes, opposite = one.history.states, other.history.states
    n = one.history.model.properties.n_modes
    assert np.array_equal(nodes[:, 0], opposite[:, 0])
    assert np.array_equal(nodes[:, 1 : 6 + 2 * n], -opposite[:, 1 : 6 + 2 * n])
    assert np.array_equal(nodes[:, 6 + 2 * n :], opposite[:, 6 + 2 * n :])  # energies


@examples(50)
@given(frames, motions(), models)
def test_a_mirrored_record_mirrors_a_complete_response(given_, motion, model):
    assert_mirrored(*mirrored(Frame(**given_), motion, model))


@examples(25)
@given(frames, motions(), springs, st.sampled_from(["2DOF-S", "2DOF-C", "1DOF-fixed"]))
def test_a_mirrored_record_mirrors_a_yielding_response(given_, motion, spring, model):
    """Nearly: a spring at rest may start on either branch, and the steps then fall elsewhere."""
    structure = Frame(**given_)
    one, other = mirrored(structure, motion, model, bouc_wen=spring)
    bound = max(1e-9, 100.0 * sensitivity(structure, motion, model, bouc_wen=spring))
    assert_same_peaks(one, other, bound)
    size = np.abs(one.yielding).max()
    if bound < 1e-4:
        np.testing.assert_allclose(one.yielding[-1], -other.yielding[-1], atol=bound * size)


@examples(20)
@given(frames, motions(), st.floats(0.0, 0.9))
def test_a_mirrored_record_mirrors_rocking_that_passes(given_, motion, e):
    assert_mirrored(*mirrored(Frame(**given_), motion, "rigid-C", impact=Restitution(e)))


@examples(30)
@given(frames, motions(), st.integers(2, 4), models)
def test_refining_the_record_changes_no_peak(given_, motion, k, model):
    structure = Frame(**given_)
    bound = max(1e-8, 100.0 * sensitivity(structure, motion, model))
    one = simulate(structure, motion, model, output="peaks")
    other = simulate(structure, motion.refined(k), model, output="peaks")
    assert_same_peaks(one, other, bound)


@examples(20)
@given(frames, motions(), st.integers(2, 4), springs, st.sampled_from(["2DOF-S", "1DOF-fixed"]))
def test_refining_the_record_changes_no_yielding(given_, motion, k, spring, model):
    structure = Frame(**given_)
    # With a small exponent the law has a corner of higher order at z = 0, which the steps do not know of.
    least = 1e-8 if spring.exponent >= 8.0 else 1e-6
    bound = max(least, 100.0 * sensitivity(structure, motion, model, bouc_wen=spring))
    one = simulate(structure, motion, model, output="peaks", bouc_wen=spring)
    other = simulate(structure, motion.refined(k), model, output="peaks", bouc_wen=spring)
    assert_same_peaks(one, other, bound)


@examples(30)
@given(frames, motions(), st.sampled_from(["2DOF-C", "MDOF-C-SI"]))
def test_a_base_too_wide_to_lift_is_fixed(given_, motion, model):
    properties = Frame(**given_).rocking()
    wide = 1e5 * properties.half_width
    inertia = properties.translational_inertia
    structure = dataclasses.replace(
        properties, half_width=wide, i_theta=inertia + properties.m_tot * wide**2, translational_inertia=inertia
    )
    fixed = simulate(structure, motion, "1DOF-fixed" if model == "2DOF-C" else "fixed")
    free = simulate(structure, motion, model)
    assert free.status == "no_uplift"
    assert_same_peaks(fixed, free, 1e-11)
    np.testing.assert_allclose(free.base_moment, fixed.base_moment, rtol=0.0, atol=1e-11 * fixed.max_base_moment)


@examples(30)
@given(frames, motions(), models, st.floats(1e-3, 1e3))
def test_heavier_by_a_factor_is_stronger_by_it(given_, motion, model, factor):
    one = Frame(**given_)
    heavy = Frame(**{**given_, "story_mass": factor * given_["story_mass"], "base_mass": factor * given_["base_mass"]})
    bound = max(1e-8, 100.0 * sensitivity(one, motion, model))
    runs = (simulate(each, motion, model, output="peaks") for each in (one, heavy))
    assert_same_peaks(*runs, bound, forces=factor)


@examples(30)
@given(frames, motions(), models)
def test_both_outputs_have_the_same_peaks(given_, motion, model):
    """And the peaks are those of the history, or between its samples."""
    structure = Frame(**given_)
    bound = max(1e-9, 100.0 * sensitivity(structure, motion, model))
    run = simulate(structure, motion, model)
    assert_same_peaks(run, simulate(structure, motion, model, output="peaks"), bound)
    for name, values in (
        ("max_rotation", run.rotation),
        ("max_top_displacement", run.top_displacement),
        ("max_base_moment", run.base_moment),
        ("max_base_shear", run.base_shear),
    ):
        largest = np.abs(values).max()
        assert largest <= getattr(run, name) * (1.0 + 1e-12) + TINY
    assert np.all(np.diff(run.time) >= 0.0)
    rocking = run.rotation != 0.0
    assert np.array_equal(np.sign(run.rotation[rocking]), run.side[rocking])
    if model != "rigid-C":  # whose rocking passes from side to side without an uplift
        assert run.n_uplifts - run.n_impacts in (0, 1)


@examples(20)
@given(frames, motions(150), st.sampled_from(["MDOF-C", "2DOF-C-SI", "rigid-C"]))
def test_no_peak_hides_between_samples(given_, motion, model):
    """Against a history fifty times as fine."""
    structure = Frame(**given_)
    bound = max(1e-8, 100.0 * sensitivity(structure, motion, model))
    if bound > 1e-4:
        return
    run, fine = simulate(structure, motion, model), simulate(structure, motion.refined(50), model)
    for name, values in (("max_rotation", fine.rotation), ("max_base_moment", fine.base_moment)):
        largest = np.abs(values).max()
        assert largest <= getattr(run, name) * (1.0 + bound) + TINY
        assert largest >= getattr(run, name) * (1.0 - 0.01) - 1e-6
    np.testing.assert_allclose(run.uplift_times, fine.uplift_times, atol=1e-5)
