"""Where two eigenvalues of the rocking phase merge, its eigenvectors are useless: the motion needs none."""

import numpy as np
import pytest
from scipy.optimize import brentq

from builders import frame_values
from rockflex import Frame, load_suite, simulate
from twins.exact import Exact
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

MOTION = load_suite("el-centro-1940")[0].scaled(1.5)
PEAKS = ("rotation", "top_displacement", "base_moment", "base_shear")


def frame(**changes):
    given = frame_values(n_stories=3, stiffness_ratio=0.125, period=0.5, aspect_ratio=9.0)
    return {**given, **changes}


def assert_same_peaks(one, other, rtol):
    assert (one.status, one.n_uplifts, one.n_impacts) == (other.status, other.n_uplifts, other.n_impacts)
    for name in PEAKS:
        assert getattr(one, f"max_{name}") == pytest.approx(getattr(other, f"max_{name}"), rel=rtol, abs=0.0), name


def discriminant(damping_ratio):
    """Of the three roots of the rocking phase with one mode that are left beside its growing one."""
    parameters = frame_properties(**frame(damping_ratio=damping_ratio), n_modes=1)
    matrix = Exact(**parameters, dt=0.02, substeps=1).generator[True][:4, :4]
    characteristic = np.poly(matrix)
    growing = max(np.roots(characteristic), key=lambda root: root.real).real
    a, b, c, d = np.polydiv(characteristic, [1.0, -growing])[0]
    return 18 * a * b * c * d - 4 * b**3 * d + b**2 * c**2 - 4 * a * c**3 - 27 * a**2 * d**2


def test_where_two_eigenvalues_merge():
    """At one damping ratio an oscillation while rocking becomes critical, and its two eigenvectors one."""
    damping_ratio = brentq(discriminant, 0.1, 0.6, xtol=1e-15, rtol=1e-15)
    given = frame(damping_ratio=damping_ratio)
    run = simulate(Frame(**given), MOTION, "2DOF-S", free_vibration=1.0)
    parameters = frame_properties(**given, n_modes=1)
    twin = simulate_fine(**parameters, acceleration=MOTION.acceleration, dt=MOTION.dt, free_vibration=1.0)
    assert run.n_impacts > 3
    assert_same_peaks(run, twin, 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("offset", [1e-12, 1e-9, 1e-7, 1e-5, 1e-3, -1e-12, -1e-9, -1e-7, -1e-5, -1e-3])
def test_close_to_the_merger(offset):
    """The answer moves by no more than the damping does."""
    damping_ratio = brentq(discriminant, 0.1, 0.6, xtol=1e-15, rtol=1e-15) * (1.0 + offset)
    given = frame(damping_ratio=damping_ratio)
    run = simulate(Frame(**given), MOTION, "2DOF-S", output="peaks")
    parameters = frame_properties(**given, n_modes=1)
    assert_same_peaks(run, simulate_fine(**parameters, acceleration=MOTION.acceleration, dt=MOTION.dt), 1e-9)
