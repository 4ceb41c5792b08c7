"""Overturning spectra of a rigid block against the closed forms of the smallest pulses without impact.

The growing part of φ'' = p² (φ - s - a/(g α)) vanishes at the threshold: one equation each for half and full sine.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import rockflex as rf

BLOCK = rf.rigid_block(0.18, 2.0)
STICKS = rf.Restitution(0.0)  # no rotation is left after an impact, so it overturns before it, or never
STEPS = 4000


def half_sine(r, ratio):
    return math.sqrt(r**2 - 1) + r * math.exp(-(math.pi - math.asin(1 / r)) / ratio) - ratio


def full_sine(r, ratio):
    return math.sqrt(r**2 - 1) - r * math.exp(-(2 * math.pi - math.asin(1 / r)) / ratio) - ratio


@pytest.mark.parametrize(
    ("form", "pulse", "printed"),
    [
        (
            half_sine,
            lambda a, t: rf.half_sine_pulse(a, t / 2, t / 2 / STEPS),
            {2.0: 1.800724, 5.0: 3.289147, 10.0: 5.786522},
        ),
        (
            full_sine,
            lambda a, t: rf.one_sine_pulse(a, t, t / STEPS),
            {2.0: 2.349903, 3.0: 3.631150, 5.0: 7.168129},
        ),
    ],
)
def test_the_spectrum_without_impact_is_the_closed_form(form, pulse, printed):
    table = rf.overturning_spectrum(BLOCK, pulse, list(printed), impact=STICKS, tolerance=1e-8)
    exact = [brentq(form, 1.0, 100.0, args=(ratio,), xtol=1e-13) for ratio in printed]
    np.testing.assert_allclose(exact, list(printed.values()), atol=5.1e-7)
    # The pulse is piecewise linear: its amplitude is short by some (2 π/steps)²/12.
    np.testing.assert_allclose(table["lowest"], exact, rtol=2e-6)
    assert (table["impacts"] == 0).all()
    np.testing.assert_allclose(table["highest_standing"], table["lowest"], rtol=1e-7)


def test_with_housner_s_impact_the_upper_boundary_is_the_one_without_impact():
    ratios = [3.0, 5.0]
    table = rf.overturning_spectrum(BLOCK, lambda a, t: rf.one_sine_pulse(a, t, t / STEPS), ratios, tolerance=1e-8)
    exact = [brentq(full_sine, 1.0, 100.0, args=(ratio,), xtol=1e-13) for ratio in ratios]
    np.testing.assert_allclose(table["highest_standing"], exact, rtol=2e-6)
    assert (table["lowest"] < 0.5 * table["highest_standing"]).all()


def test_a_half_sine_overturns_without_impact_whatever_the_impact():
    def pulse(amplitude, period):
        return rf.half_sine_pulse(amplitude, period / 2, period / 2 / STEPS)

    stuck, rocking = (rf.overturning_spectrum(BLOCK, pulse, [2.0, 5.0], impact=law) for law in (STICKS, None))
    np.testing.assert_allclose(stuck["lowest"], rocking["lowest"], rtol=2e-6)
