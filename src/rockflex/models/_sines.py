"""Sine and cosine of a rotation in one evaluation, without a call of the C library in every stage of a step."""

import math

from rockflex._kernel import inlined_kernel

SMALL, SMALLER = math.pi / 4, 0.125  # rad: largest rotation for the series, and for fewer of its terms

# 1/n! with alternating signs, for sin θ = θ + θ³ (S_1 + S_2 θ² + ...) and cos θ = 1 + θ² (C_1 + C_2 θ² + ...). The
# first term left out is below a quarter of the rounding error.
S = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(9))
C = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(9))


@inlined_kernel
def sine_and_cosine(theta: float) -> tuple[float, float]:
    """Return sin θ and cos θ."""
    x = theta * theta
    y = x * x
    # Terms in pairs: shorter chains of dependent operations than one term after the other.
    if abs(theta) <= SMALLER:
        sine = (S[1] + S[2] * x) + y * (S[3] + S[4] * x)
        cosine = (C[1] + C[2] * x) + y * ((C[3] + C[4] * x) + y * C[5])
    elif abs(theta) <= SMALL:
        sine = (S[1] + S[2] * x) + y * ((S[3] + S[4] * x) + y * ((S[5] + S[6] * x) + y * (S[7] + S[8] * x)))
        cosine = (C[1] + C[2] * x) + y * ((C[3] + C[4] * x) + y * ((C[5] + C[6] * x) + y * (C[7] + C[8] * x)))
    else:
        return math.sin(theta), math.cos(theta)
    return theta + theta * x * sine, 1.0 + x * cosine
