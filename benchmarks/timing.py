"""Helpers shared by the benchmarks."""

import time
from collections.abc import Callable

import numpy as np

import rockflex as rf


def frame(n: int) -> rf.Frame:
    """A shear frame of n stories, T = 1 s, h*_1/B = 10: for five stories structure #1 of Table 1."""
    return rf.Frame(
        n_stories=n,
        story_height=3.0,
        story_mass=40e3,
        base_mass=40e3,
        stiffness_ratio=np.inf,
        period=1.0,
        aspect_ratio=10.0,
        damping_ratio=0.02,
    )


def least(function: Callable[[], object], repetitions: int, clock: Callable[[], float] = time.perf_counter) -> float:
    """Minimum time of a call, in s, by a clock."""
    function()
    times = []
    for _ in range(repetitions):
        started = clock()
        function()
        times.append(clock() - started)
    return min(times)


def milliseconds(seconds: float) -> str:
    return f"{seconds * 1e3:.3f}"
