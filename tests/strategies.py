"""Random frames and random shaking for the laws that hold for all of them."""

import numpy as np
from hypothesis import strategies as st

from rockflex import GroundMotion, load_suite, suite_names

GRAVITY = 9.81


def frame_arguments(most_stories, longest_period, **more):
    """Arguments of frames from shear buildings to cantilevers; a damping ratio by name."""
    return st.fixed_dictionaries(
        {
            "n_stories": st.integers(1, most_stories),
            "story_height": st.just(3.0),
            "story_mass": st.just(40e3),
            "base_mass": st.sampled_from([0.0, 40e3, 200e3]),
            "stiffness_ratio": st.sampled_from([0.0, 0.125, 1.0, np.inf]),
            "period": st.floats(0.2, longest_period),
            "aspect_ratio": st.floats(3.0, 12.0),
            **more,
        }
    )


def to_lift(draw, values, dt, factors, name=""):
    """Scale to peaks of some factors times what lifts a rigid block of aspect ratio 8."""
    peak = GRAVITY / 8.0 * draw(st.floats(*factors))
    return GroundMotion(values * (peak / np.abs(values).max()), dt, name=name)


@st.composite
def stretches(draw, samples=300, factors=(0.3, 5.0), suites=None):
    """Stretches of embedded records."""
    suite = load_suite(draw(st.sampled_from(suites or suite_names())))
    record = suite[draw(st.integers(0, len(suite) - 1))]
    first = draw(st.integers(0, record.acceleration.size - samples))
    return to_lift(draw, record.acceleration[first : first + samples], record.dt, factors, "drawn")


@st.composite
def noises(draw, samples, factors, steps):
    """White noise."""
    values = np.random.default_rng(draw(st.integers(0, 10**6))).standard_normal(samples)
    return to_lift(draw, values, draw(st.sampled_from(steps)), factors, "drawn")
