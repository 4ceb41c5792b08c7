"""Vector fields of a user's own, in Python and compiled, against SciPy: a pendulum isolator in a moat."""

import ctypes
import itertools
import shutil
import subprocess

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rockflex as rf
from engine.test_systems import uncompiled
from rockflex import InputError
from rockflex.engine import Event, NonlinearPhase, Run, StateLayout, System
from rockflex.engine.field import Field

GRAVITY, RADIUS, DAMPING = 9.81, 2.2, 0.3  # m/s², m, 1/s
MOAT, RESTITUTION = 0.06, 0.5  # rad
RECORD = rf.load_suite("el-centro-1940")[0].scaled(1.5)
VERTICAL = 0.5 * np.roll(RECORD.acceleration, 40)
C_FIELD = """
#include <math.h>
void swing(const double *y, double a, double a_v, double *out) {
  out[0] = y[1];
  out[1] = -((9.81 + a_v) * sin(y[0]) + a * cos(y[0])) / 2.2 - 0.3 * y[1];
}
"""


def swing(y, a, a_v):
    """A pendulum whose pivot moves with the ground."""
    return [y[1], -((GRAVITY + a_v) * np.sin(y[0]) + a * np.cos(y[0])) / RADIUS - DAMPING * y[1]]


Rates = ctypes.CFUNCTYPE(
    None, ctypes.POINTER(ctypes.c_double), ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double)
)


@Rates
def swing_by_address(y, a, a_v, out):
    out[0], out[1] = swing(y, a, a_v)


class Numba:
    """What `numba.cfunc` returns, as far as it matters: callable in Python, and an address."""

    address = ctypes.cast(swing_by_address, ctypes.c_void_p).value

    def __call__(self, *_):
        raise AssertionError("Python must not be called.")


def isolator(field):
    def phase(_key):
        back = np.diag([1.0, -RESTITUTION])
        walls = tuple(
            Event("impact", np.array([-side, 0.0]), "swings", constant=MOAT, jump=back) for side in (1.0, -1.0)
        )
        return NonlinearPhase(
            field, np.eye(2), np.zeros(2), np.zeros(2), walls, scale=np.array([1e-4, 1e-3]), velocities={0: 1}
        )

    return System(StateLayout(angle=1, velocity=1), ("angle", "velocity"), phase, "swings")


@pytest.fixture(scope="module")
def reference():
    """Times and states at samples, and times of impacts, by SciPy from sample to sample."""

    def wall(side):
        def touches(_t, y):
            return MOAT - side * y[0]

        touches.terminal, touches.direction = True, -1
        return touches

    times = np.arange(RECORD.acceleration.size) * RECORD.dt
    state, impacts, states = np.zeros(2), [], [np.zeros(2)]
    for k, (t, until) in enumerate(itertools.pairwise(times)):

        def rates(time, y, k=k, t=t):
            part = (time - t) / RECORD.dt
            a, a_v = (each[k] + (each[k + 1] - each[k]) * part for each in (RECORD.acceleration, VERTICAL))
            return swing(y, a, a_v)

        while t < until:
            moved = solve_ivp(
                rates, (t, until), state, "DOP853", rtol=1e-13, atol=1e-16, events=[wall(1.0), wall(-1.0)]
            )
            t, state = moved.t[-1], moved.y[:, -1].copy()
            if moved.status == 1:
                impacts.append(t)
                state = np.array([np.sign(state[0]) * MOAT * (1.0 - 1e-15), -RESTITUTION * state[1]])
        states.append(state)
    return times, np.array(states), impacts


def compare(run, reference):
    times, states, impacts = reference
    run.advance(RECORD.acceleration, VERTICAL, history=True)
    assert len(impacts) > 5
    np.testing.assert_allclose([t for t, _, _ in run.events], impacts, rtol=0.0, atol=1e-10)
    when, _, _, found, _ = run.history
    kept = np.isin(when, times)
    np.testing.assert_allclose(found[kept][:, 0], states[:, 0], rtol=0.0, atol=1e-10 * MOAT)
    np.testing.assert_allclose(found[kept][:, 1], states[:, 1], rtol=0.0, atol=1e-10 * np.abs(states[:, 1]).max())


@pytest.mark.parametrize("field", [swing, swing_by_address, Numba()], ids=["Python", "ctypes", "numba"])
def test_a_field_of_a_users_own_moves_as_scipy_says(field, reference):
    compare(Run(isolator(field), RECORD.dt), reference)


def test_so_does_the_engine_in_python(reference):
    compare(uncompiled().Run(isolator(swing_by_address), RECORD.dt), reference)


def test_a_compiled_field(reference, tmp_path):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    (tmp_path / "swing.c").write_text(C_FIELD)
    library = tmp_path / "swing.so"
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "swing.c", "-o", library, "-lm"], cwd=tmp_path, check=True)
    compare(Run(isolator(ctypes.CDLL(str(library)).swing), RECORD.dt), reference)


def test_a_field_that_the_engine_would_not_call_is_refused():
    class Mine(Field):
        def rates(self, y, a, a_v, out, counted):
            out[0] = 1.0

    with pytest.raises(InputError, match="Mine is a Field in plain Python"):
        Run(isolator(Mine()), 0.01)
