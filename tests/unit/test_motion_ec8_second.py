"""The elastic spectrum of the second generation of Eurocode 8, against its formulas written out once more."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rockflex as rf

G = 9.81


def formula(period, s_alpha, s_beta, factors, rock, zeta):
    """S_e of EN 1998-1-1:2024, 5.2.2.2, case by case; `rock` is S_β,RP."""
    plateau, second = factors[0] * s_alpha, factors[1] * s_beta
    t_c = second / plateau
    t_b = 0.05 if t_c / 4 < 0.05 else 0.1 if t_c / 4 > 0.1 else t_c / 4
    t_d = 2.0 if rock <= 1.0 else 1.0 + rock
    eta = max(math.sqrt(10 / (5 + 100 * zeta)), 0.55)
    if period <= 0.02:
        return plateau / 2.5
    if period <= t_b:
        return plateau / (t_b - 0.02) * (eta * (period - 0.02) + (t_b - period) / 2.5)
    if period <= t_c:
        return eta * plateau
    return eta * second / period if period <= t_d else eta * t_d * second / period**2


@settings(deadline=None, max_examples=100)
@given(st.floats(1.0, 12.0), st.floats(0.15, 0.6), st.floats(0.0, 0.3), st.floats(0.0, 10.0))
def test_formulas_for_given_factors(s_alpha, share, zeta, period):
    s_beta = share * s_alpha
    target = rf.ec8_second_spectrum(s_alpha, s_beta, amplification=(1.2, 1.5), damping_ratio=zeta)
    expected = formula(period, s_alpha, s_beta, (1.2, 1.5), s_beta, zeta)
    assert target.at([period])[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("site", "of_alpha", "of_beta"),
    [("A", 1.0, 1.0), ("B", 1.3 * 0.96, 1.6 * 0.98), ("C", 1.6 * 0.92, 2.3 * 0.97), ("D", 1.8 * 0.88, 3.2 * 0.9)],
)
def test_default_factors(site, of_alpha, of_beta):
    target = rf.ec8_second_spectrum(0.4 * G, 0.1 * G, site, topography=1.2)
    assert target.at([0.0, 0.15, 1.0]) == pytest.approx(
        1.2 * G * np.array([0.4 * of_alpha / 2.5, 0.4 * of_alpha, 0.1 * of_beta])
    )
    assert f"site {site}, S_α 0.4 g, S_β 0.1 g" in target.name


@pytest.mark.parametrize(
    ("arguments", "options", "text"),
    [
        ((0.0, 1.0), {}, r"s_alpha must be a positive, finite number in m/s²"),
        ((5.0, -1.0), {}, r"s_beta must be a positive, finite number"),
        ((5.0, 1.0, "E"), {}, r"site must be one of A, B, C, D, .* but 'E' was given\. For E and F, .*amplification="),
        ((5.0, 1.0), {"amplification": (1.0,)}, r"amplification must be the two positive factors F_α and F_β"),
        ((5.0, 1.0), {"amplification": (1.0, 0.0)}, r"amplification must be the two positive factors F_α and F_β"),
        ((5.0, 1.0), {"amplification": "ab"}, "amplification must be a sequence of numbers, but"),
        ((5.0, 1.0, "C"), {"amplification": (1.2, 1.5)}, "site='C' and amplification were both given. Give one"),
        ((5.0, 1.0), {"topography": 0.0}, "topography must be a positive, finite number, but 0.0 was"),
        ((5.0, 1.0), {"damping_ratio": 2.0}, "damping_ratio must lie in"),
        (
            (5.0, 0.1),
            {},
            r"T_B = 0\.05 s, T_C = 0\.02 s and T_D = 2 s, which must increase and stay below 10 s\. Check",
        ),
        (
            (5.0, 8.0, "D"),
            {},
            r"F_α = 1\.52 and F_β = 0\.59, below 1\. Give those of the site: amplification=\(F_α, F_β",
        ),
    ],
)
def test_refuses(arguments, options, text):
    with pytest.raises(rf.InputError, match=text):
        rf.ec8_second_spectrum(*arguments, **options)
