"""Sums of stages, unrolled: loops over so few weights would cost more than the arithmetic."""

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel
from rockflex.solve.adaptive.tableau import A


@inlined_kernel
def place_stage(stage: int, step: float, start: Array, rates: Array, out: Array, moving: int) -> None:
    """Compute the state at which a stage is evaluated, `start` + step Σ A rates; stage 12 is the end of the step.

    Only the first `moving` entries are computed, on which the rates depend.
    """
    if stage == 1:
        for i in range(moving):
            total = A[1, 0] * rates[0, i]
            out[i] = start[i] + step * total
    elif stage == 2:
        for i in range(moving):
            total = A[2, 0] * rates[0, i] + A[2, 1] * rates[1, i]
            out[i] = start[i] + step * total
    elif stage == 3:
        for i in range(moving):
            total = A[3, 0] * rates[0, i] + A[3, 2] * rates[2, i]
            out[i] = start[i] + step * total
    elif stage == 4:
        for i in range(moving):
            total = A[4, 0] * rates[0, i] + A[4, 2] * rates[2, i] + A[4, 3] * rates[3, i]
            out[i] = start[i] + step * total
    elif stage == 5:
        for i in range(moving):
            total = A[5, 0] * rates[0, i] + A[5, 3] * rates[3, i] + A[5, 4] * rates[4, i]
            out[i] = start[i] + step * total
    elif stage == 6:
        for i in range(moving):
            total = A[6, 0] * rates[0, i] + A[6, 3] * rates[3, i] + A[6, 4] * rates[4, i] + A[6, 5] * rates[5, i]
            out[i] = start[i] + step * total
    elif stage == 7:
        for i in range(moving):
            total = A[7, 0] * rates[0, i] + A[7, 3] * rates[3, i] + A[7, 4] * rates[4, i] + A[7, 5] * rates[5, i]
            total += A[7, 6] * rates[6, i]
            out[i] = start[i] + step * total
    elif stage == 8:
        for i in range(moving):
            total = A[8, 0] * rates[0, i] + A[8, 3] * rates[3, i] + A[8, 4] * rates[4, i] + A[8, 5] * rates[5, i]
            total += A[8, 6] * rates[6, i] + A[8, 7] * rates[7, i]
            out[i] = start[i] + step * total
    elif stage == 9:
        for i in range(moving):
            total = A[9, 0] * rates[0, i] + A[9, 3] * rates[3, i] + A[9, 4] * rates[4, i] + A[9, 5] * rates[5, i]
            total += A[9, 6] * rates[6, i] + A[9, 7] * rates[7, i] + A[9, 8] * rates[8, i]
            out[i] = start[i] + step * total
    elif stage == 10:
        for i in range(moving):
            total = A[10, 0] * rates[0, i] + A[10, 3] * rates[3, i] + A[10, 4] * rates[4, i] + A[10, 5] * rates[5, i]
            total += A[10, 6] * rates[6, i] + A[10, 7] * rates[7, i] + A[10, 8] * rates[8, i] + A[10, 9] * rates[9, i]
            out[i] = start[i] + step * total
    elif stage == 11:
        for i in range(moving):
            total = A[11, 0] * rates[0, i] + A[11, 3] * rates[3, i] + A[11, 4] * rates[4, i] + A[11, 5] * rates[5, i]
            total += A[11, 6] * rates[6, i] + A[11, 7] * rates[7, i] + A[11, 8] * rates[8, i] + A[11, 9] * rates[9, i]
            total += A[11, 10] * rates[10, i]
            out[i] = start[i] + step * total
    elif stage == 12:
        for i in range(moving):
            total = A[12, 0] * rates[0, i] + A[12, 5] * rates[5, i] + A[12, 6] * rates[6, i]
            total += A[12, 7] * rates[7, i] + A[12, 8] * rates[8, i] + A[12, 9] * rates[9, i]
            total += A[12, 10] * rates[10, i] + A[12, 11] * rates[11, i]
            out[i] = start[i] + step * total
    elif stage == 13:
        for i in range(moving):
            total = A[13, 0] * rates[0, i] + A[13, 6] * rates[6, i] + A[13, 7] * rates[7, i]
            total += A[13, 8] * rates[8, i] + A[13, 9] * rates[9, i] + A[13, 10] * rates[10, i]
            total += A[13, 11] * rates[11, i] + A[13, 12] * rates[12, i]
            out[i] = start[i] + step * total
    elif stage == 14:
        for i in range(moving):
            total = A[14, 0] * rates[0, i] + A[14, 5] * rates[5, i] + A[14, 6] * rates[6, i]
            total += A[14, 7] * rates[7, i] + A[14, 10] * rates[10, i] + A[14, 11] * rates[11, i]
            total += A[14, 12] * rates[12, i] + A[14, 13] * rates[13, i]
            out[i] = start[i] + step * total
    elif stage == 15:
        for i in range(moving):
            total = A[15, 0] * rates[0, i] + A[15, 5] * rates[5, i] + A[15, 6] * rates[6, i]
            total += A[15, 7] * rates[7, i] + A[15, 8] * rates[8, i] + A[15, 12] * rates[12, i]
            total += A[15, 13] * rates[13, i] + A[15, 14] * rates[14, i]
            out[i] = start[i] + step * total


@inlined_kernel
def place_others(step: float, start: Array, rates: Array, out: Array, moving: int, counted: int) -> None:
    """Compute the other entries at the end of the step: up to `counted` they have rates, the rest is constant."""
    for i in range(moving, counted):
        total = A[12, 0] * rates[0, i] + A[12, 5] * rates[5, i] + A[12, 6] * rates[6, i]
        total += A[12, 7] * rates[7, i] + A[12, 8] * rates[8, i] + A[12, 9] * rates[9, i]
        total += A[12, 10] * rates[10, i] + A[12, 11] * rates[11, i]
        out[i] = start[i] + step * total
    for i in range(counted, start.size):
        out[i] = start[i]
