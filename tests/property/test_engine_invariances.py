"""What must not change a response, for random frames under random stretches of records and noise."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from builders import frame_values
from rockflex import BoucWen, Frame, GroundMotion, Restitution, load_suite, simulate
from strategies import GRAVITY, frame_arguments, noises, stretches
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

TINY = 1e-13  # rad, of a slenderness of about 0.1: rounding, below which a rotation has no digits
VALUES = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")
LINEAR = ("MDOF-S", "2DOF-S", "fixed")  # between events; the others are integrated with error control
NONLINEAR = ("2DOF-C", "2DOF-C-SI", "MDOF-C", "MDOF-C-E", "rigid-C")

frames = frame_arguments(6, 2.5, damping_ratio=st.floats(0.01, 0.1))
models = st.sampled_from([*LINEAR, *NONLINEAR])
springs = st.builds(
    BoucWen,
    st.floats(0.01, 0.1),
    st.floats(0.0, 0.3),
    st.just(0.5),
    st.floats(-0.3, 0.5),
    st.sampled_from([1.0, 2.0, 3.5, 8.0]),
)
STEPS = (0.005, 0.02, 0.05)  # s, of noise


def motions(samples=300, steps=STEPS[:2]):
    return stretches(samples, (0.3, 5.0)) | noises(samples // 2, (0.3, 5.0), steps)


def examples(count):
    return settings(max_examples=count, deadline=None)


def is_linear(model, options):
    return model in LINEAR and "bouc_wen" not in options


def bound_of(structure, motion, model="MDOF-S", least=None, **options):
    """A hundred times what a change of the record in its last digits, or by the error of integration, does to peaks."""
    linear = is_linear(model, options)
    changes = (-2e-15, -1e-15, 1e-15, 2e-15) if linear else (-1e-11, 1e-11)
    base = simulate(structure, motion, model, output="peaks", **options)
    others = [simulate(structure, motion.scaled(1.0 + each), model, output="peaks", **options) for each in changes]
    moves = [
        abs(getattr(other, name) - getattr(base, name)) / (getattr(base, name) or 1.0)
        for other in others
        for name in VALUES
    ]
    return max(least or (1e-9 if linear else 1e-8), 100.0 * max(moves))


def assert_same_peaks(one, other, rtol, *, later=0.0, forces=1.0):
    if rtol > 1e-4:  # such a motion tells rounding from nothing
        return
    assert (one.status, one.nominal_overturning) == (other.status, other.nominal_overturning)
    for name in VALUES:
        factor = forces if "base" in name else 1.0
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=rtol, abs=TINY), name
    if rtol <= 1e-9:
        assert (one.n_uplifts, one.n_impacts) == (other.n_uplifts, other.n_impacts)
        assert other.end_time == pytest.approx(one.end_time + later, abs=1e-6)


def mirrored(structure, motion, model, **options):
    return [simulate(structure, motion.scaled(f), model, **options) for f in (1.0, -1.0)]


def assert_mirrored(one, other):
    """To the last bit; of the peaks, the residual rotation alone has a sign."""
    turned = pytest.approx(-other.residual_rotation, rel=0.0, abs=0.0, nan_ok=True)
    assert one.peaks() == other.peaks() | {"residual_rotation": turned}
    nodes, opposite = one.history.states, other.history.states
    n = one.history.model.properties.n_modes
    assert np.array_equal(nodes[:, 0], opposite[:, 0])
    assert np.array_equal(nodes[:, 1 : 6 + 2 * n], -opposite[:, 1 : 6 + 2 * n])
    assert np.array_equal(nodes[:, 6 + 2 * n :], opposite[:, 6 + 2 * n :])  # energies


@pytest.mark.slow
@examples(120)
@given(frames, motions(), models)
def test_a_mirrored_record_mirrors_the_response(given_, motion, model):
    assert_mirrored(*mirrored(Frame(**given_), motion, model))


@pytest.mark.slow
@examples(25)
@given(frames, motions(), springs, st.sampled_from(["2DOF-S", "2DOF-C", "1DOF-fixed"]))
def test_a_mirrored_record_mirrors_a_yielding_response(given_, motion, spring, model):
    """Nearly: a spring at rest may start on either branch, and the steps then fall elsewhere."""
    structure = Frame(**given_)
    one, other = mirrored(structure, motion, model, bouc_wen=spring)
    bound = bound_of(structure, motion, model, 1e-9, bouc_wen=spring)
    assert_same_peaks(one, other, bound)
    size = np.abs(one.yielding).max()
    if bound < 1e-4:
        np.testing.assert_allclose(one.yielding[-1], -other.yielding[-1], atol=bound * size)


@examples(20)
@given(frames, motions(), st.floats(0.0, 0.9))
def test_a_mirrored_record_mirrors_rocking_that_passes(given_, motion, e):
    assert_mirrored(*mirrored(Frame(**given_), motion, "rigid-C", impact=Restitution(e)))


@pytest.mark.slow
@examples(80)
@given(frames, motions(), st.integers(2, 5), models)
def test_refining_the_record_changes_no_peak(given_, motion, k, model):
    structure = Frame(**given_)
    one = simulate(structure, motion, model, output="peaks")
    other = simulate(structure, motion.refined(k), model, output="peaks")
    assert_same_peaks(one, other, bound_of(structure, motion, model))


@examples(20)
@given(frames, motions(), st.integers(2, 4), springs, st.sampled_from(["2DOF-S", "1DOF-fixed"]))
def test_refining_the_record_changes_no_yielding(given_, motion, k, spring, model):
    structure = Frame(**given_)
    # With a small exponent the law has a corner of higher order at z = 0, which the steps do not know of.
    least = 1e-8 if spring.exponent >= 8.0 else 1e-6
    bound = bound_of(structure, motion, model, least, bouc_wen=spring)
    one = simulate(structure, motion, model, output="peaks", bouc_wen=spring)
    other = simulate(structure, motion.refined(k), model, output="peaks", bouc_wen=spring)
    assert_same_peaks(one, other, bound)


@pytest.mark.slow
@examples(80)
@given(frames, motions(), st.sampled_from([("MDOF-S", "fixed"), ("2DOF-C", "1DOF-fixed"), ("MDOF-C-SI", "fixed")]))
def test_a_base_too_wide_to_lift_is_fixed(given_, motion, labels):
    properties = Frame(**given_).rocking()
    wide = 1e5 * properties.half_width
    inertia = properties.translational_inertia
    structure = dataclasses.replace(
        properties, half_width=wide, i_theta=inertia + properties.m_tot * wide**2, translational_inertia=inertia
    )
    free, fixed = (simulate(structure, motion, label) for label in labels)
    bound = 1e-12 if labels[0] in LINEAR else 1e-11
    assert free.status == "no_uplift"
    assert_same_peaks(fixed, free, bound)
    np.testing.assert_allclose(free.base_moment, fixed.base_moment, rtol=0.0, atol=bound * fixed.max_base_moment)


@examples(40)
@given(frames, motions())
def test_as_many_modes_as_there_are_is_all_of_them(given_, motion):
    structure = Frame(**given_)
    one, other = simulate(structure, motion, f"{given_['n_stories'] + 1}DOF-S"), simulate(structure, motion)
    assert np.array_equal(one.history.states, other.history.states)
    assert {**one.peaks(), "model": "MDOF-S"} == other.peaks()


@pytest.mark.slow
@examples(60)
@given(frames, motions(steps=STEPS), st.integers(1, 200))
def test_a_late_start_shifts_the_response(given_, motion, quiet):
    structure = Frame(**given_)
    early = GroundMotion(np.concatenate(([0.0], motion.acceleration)), motion.dt)
    late = GroundMotion(np.concatenate((np.zeros(quiet + 1), motion.acceleration)), motion.dt)
    one, other = simulate(structure, early), simulate(structure, late)
    assert_same_peaks(one, other, bound_of(structure, early, least=1e-12), later=quiet * motion.dt)
    assert not other.history.states[: quiet + 1, 1:].any()
    if one.n_uplifts:
        assert other.uplift_times[0] == pytest.approx(one.uplift_times[0] + quiet * motion.dt, abs=1e-9)


@pytest.mark.slow
@examples(80)
@given(frames, motions(), models, st.floats(1e-3, 1e3))
def test_heavier_by_a_factor_is_stronger_by_it(given_, motion, model, factor):
    """All masses times c leave rotations and displacements, and multiply forces by c."""
    one = Frame(**given_)
    heavy = Frame(**{**given_, "story_mass": factor * given_["story_mass"], "base_mass": factor * given_["base_mass"]})
    runs = (simulate(each, motion, model, output="peaks") for each in (one, heavy))
    assert_same_peaks(*runs, bound_of(one, motion, model), forces=factor)


@pytest.mark.slow
@examples(60)
@given(frames, motions(steps=STEPS), st.floats(0.1, 10.0))
def test_larger_by_a_factor_is_slower_by_its_root(given_, motion, factor):
    """Froude's similarity: lengths times c and times by √c leave rotations, and multiply displacements by c."""
    one = Frame(**given_)
    lengths = {"story_height": factor * given_["story_height"], "period": np.sqrt(factor) * given_["period"]}
    large = Frame(**given_ | lengths)
    slow = GroundMotion(motion.acceleration, np.sqrt(factor) * motion.dt)
    bound = bound_of(one, motion)
    small, big = simulate(one, motion, output="peaks"), simulate(large, slow, output="peaks")
    assert big.max_rotation == pytest.approx(small.max_rotation, rel=bound, abs=TINY)
    assert big.max_top_displacement == pytest.approx(factor * small.max_top_displacement, rel=bound)
    assert big.max_base_moment == pytest.approx(factor * small.max_base_moment, rel=bound)
    assert big.max_base_shear == pytest.approx(small.max_base_shear, rel=bound)


@pytest.mark.slow
@examples(25)
@given(frames, motions(200, STEPS), st.data())
def test_the_twin_agrees(given_, motion, data):
    """Dense exponentials on 32 exact sub-samples a sample or more; the bound is that of a record changed by 1e-14."""
    n = data.draw(st.integers(1, given_["n_stories"]))
    mine = simulate(Frame(**given_), motion, f"{n + 1}DOF-S")
    parameters = frame_properties(**given_, n_modes=n)
    looks = 32 if motion.dt < 0.05 else 128

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


@examples(30)
@given(frames, motions(), st.sampled_from(NONLINEAR))
def test_both_outputs_have_the_same_peaks(given_, motion, model):
    """And the peaks are those of the history, or between its samples."""
    structure = Frame(**given_)
    run = simulate(structure, motion, model)
    peaks = simulate(structure, motion, model, output="peaks")
    assert_same_peaks(run, peaks, bound_of(structure, motion, model, 1e-9))
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
    bound = bound_of(structure, motion, model)
    if bound > 1e-4:
        return
    run, fine = simulate(structure, motion, model), simulate(structure, motion.refined(50), model)
    for name, values in (("max_rotation", fine.rotation), ("max_base_moment", fine.base_moment)):
        largest = np.abs(values).max()
        assert largest <= getattr(run, name) * (1.0 + bound) + TINY
        assert largest >= getattr(run, name) * (1.0 - 0.01) - 1e-6
    np.testing.assert_allclose(run.uplift_times, fine.uplift_times, atol=1e-5)


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
