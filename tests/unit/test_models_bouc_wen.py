"""The Bouc-Wen spring: its range, its law, and the bound of z."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from builders import make_frame, vector_field
from rockflex import BoucWen, GroundMotion, InitialState, InputError, quiet_motion, simulate
from rockflex.models import Model
from twins.complete_model import BoucWen as Twin

FRAME = make_frame(n_stories=1, story_height=6.0, period=0.6, aspect_ratio=5.0)
RANGE = "gamma must be positive and -gamma < beta <= gamma, but gamma={!r} and beta={!r} were given"


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        (
            {"exponent": 0.99},
            "exponent must be at least 1, but 0.99 was given. 8 gives a sharp yield, 1 a gradual one.",
        ),
        ({"gamma": 0.0, "beta": 0.0}, RANGE.format(0.0, 0.0)),
        ({"gamma": -0.5}, RANGE.format(-0.5, 0.5)),
        ({"gamma": 0.4, "beta": 0.5}, RANGE.format(0.4, 0.5)),
        ({"gamma": 0.5, "beta": -0.5}, RANGE.format(0.5, -0.5) + ": the spring would return more energy than it"),
    ],
)
def test_springs_that_are_none(changes, text):
    with pytest.raises(InputError, match=re.escape(text)):
        BoucWen(**{"yield_displacement": 0.05, **changes})


def test_springs_are_values():
    assert BoucWen(0.05) == BoucWen(0.05, 0.01, 0.5, 0.5, 8)
    assert type(BoucWen(1).yield_displacement) is float
    assert BoucWen(0.05, gamma=0.5, beta=-0.49).beta == -0.49
    assert BoucWen(0.05, post_yield_ratio=0.0, exponent=1.0).post_yield_ratio == 0.0


def rate(spring, velocity, z):
    """Rate of z in the vector field, on the ground."""
    model = Model(1, lifts=False).of(FRAME.rocking(), bouc_wen=spring)
    motion = np.zeros(model.layout.size)
    motion[1], motion[4] = velocity, z
    return vector_field(model, 0, 1 if velocity >= 0.0 else -1).rates_at(motion, 0.0, 0.0)[4]


@st.composite
def springs(draw):
    gamma = draw(st.floats(0.1, 2.0))
    return BoucWen(
        draw(st.floats(0.005, 0.2)),
        draw(st.floats(0.0, 0.9)),
        gamma,
        draw(st.floats(-0.9, 1.0)) * gamma,
        draw(st.sampled_from([1.0, 1.5, 2.0, 3.0, 7.3, 8.0, 16.0])),
    )


@pytest.mark.slow
@given(springs(), st.floats(-3.0, 3.0, allow_subnormal=False), st.floats(-1.3, 1.3))
def test_the_rate_of_z_is_that_of_equation_38(spring, velocity, z):
    b = spring
    twin = Twin(b.yield_displacement, b.post_yield_ratio, b.gamma, b.beta, b.exponent)
    expected = float(twin.rate(velocity, np.array(z)))
    size = abs(velocity) * (1.0 + 2.0 * b.gamma * abs(z) ** b.exponent) / b.yield_displacement
    assert rate(spring, velocity, z) == pytest.approx(expected, rel=1e-12, abs=1e-13 * size)


def test_whole_exponents_and_others_are_one_law():
    for z in (-1.02, -0.9, 0.3, 0.99):
        for velocity in (-1.0, 0.7):
            one, other = (rate(BoucWen(0.05, exponent=n), velocity, z) for n in (8.0, 8.0 + 1e-12))
            assert one == pytest.approx(other, rel=1e-10, abs=1e-9)
    motion = GroundMotion(6.0 * np.sin(0.2 * np.arange(200)), 0.02)
    one, other = (
        simulate(FRAME, motion, "2DOF-S", output="peaks", bouc_wen=BoucWen(0.05, exponent=n))
        for n in (8.0, 8.0 + 1e-12)
    )
    assert one.n_impacts > 2
    assert other.max_rotation == pytest.approx(one.max_rotation, rel=1e-8)
    assert other.max_top_displacement == pytest.approx(one.max_top_displacement, rel=1e-8)


@settings(max_examples=25, deadline=None)
@given(springs(), st.integers(0, 10**6), st.sampled_from(["2DOF-S", "2DOF-C", "1DOF-fixed"]), st.floats(0.5, 10.0))
def test_z_stays_within_its_bound(spring, seed, model, peak):
    values = np.random.default_rng(seed).standard_normal(150)
    motion = GroundMotion(values * peak / np.abs(values).max(), 0.02)
    run = simulate(FRAME, motion, model, bouc_wen=spring)
    bound = (spring.gamma + spring.beta) ** (-1.0 / spring.exponent)
    assert np.abs(run.yielding).max() <= bound * (1.0 + 1e-7)


def test_a_strong_push_reaches_the_bound():
    spring = BoucWen(0.01, 0.0, 0.7, 0.2, 4.0)
    start = InitialState(modal_velocity=[3.0])
    run = simulate(FRAME, quiet_motion(0.1, dt=0.001), "1DOF-fixed", bouc_wen=spring, initial=start)
    assert run.yielding.max() == pytest.approx(0.9 ** (-1.0 / 4.0), rel=1e-6)
    p = FRAME.rocking()
    yielded = p.effective_mass[0] * p.omega[0] ** 2 * 0.01 * run.yielding.max()
    assert run.max_base_shear == pytest.approx(yielded, rel=1e-6)  # plastic: the spring bears no more


@pytest.mark.parametrize("model", ["2DOF-S", "1DOF-fixed", "2DOF-C"])
def test_a_spring_that_does_not_yield_is_elastic(model):
    motion = GroundMotion(3.0 * np.sin(0.2 * np.arange(250)) + 1.5 * np.sin(0.53 * np.arange(250)), 0.02)
    elastic = simulate(FRAME, motion, model, free_vibration=1.0)
    stiff = simulate(FRAME, motion, model, free_vibration=1.0, bouc_wen=BoucWen(1e3, post_yield_ratio=0.3))
    assert stiff.n_impacts == elastic.n_impacts
    assert stiff.n_impacts > 2 or model == "1DOF-fixed"
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear"):
        assert getattr(stiff, name) == pytest.approx(getattr(elastic, name), rel=1e-8), name
    np.testing.assert_allclose(stiff.rotation[-1], elastic.rotation[-1], atol=1e-8 * (elastic.max_rotation + 1e-9))
