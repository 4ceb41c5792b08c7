"""What a phase that is not linear is made of, as compiled classes call each other. Declarations: `field.pxd`.

Their methods take addresses of arrays when compiled, and the arrays themselves when run as Python. A method that is
declared here does nothing; subclasses in `rockflex.models` say what it does.
"""

import ctypes

import cython
import numpy as np

from rockflex.foundation.errors import InputError

SIGNATURE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)


@cython.cclass
class Field:
    """y' = F(y, a, a_v) in one phase, its outputs that are not linear, and what its conditions depend on.

    The first m states move: their rates depend on them, on those that follow from the n-th on, which are constant
    during a phase, and on the accelerations of the ground. The states between them are integrals of functions of these,
    which no motion depends on; their rates are computed if `counted`.
    """

    def rates(self, y, a, a_v, out, counted):
        """Compute the rates of the states."""

    def sizes(self, y, a, a_v, out):
        """Compute the magnitudes of the terms of the rates of the moving states: what their rounding is relative to."""

    def observe(self, y, rates, a, a_v, out):
        """Replace the outputs that are not linear, of which `out` holds the rows."""

    def conditions(self, y, rates, a, a_v, out):
        """Replace the conditions that are not linear."""

    def enter(self, y, more):
        """As a phase begins, add to the constants of its conditions what the constant states say."""

    def rates_at(self, y, a, a_v, counted=True):
        """Return the rates of states, shape (n,)."""
        state: cython.double[::1] = y
        found: cython.double[::1] = np.zeros(max(len(y), 1))
        if cython.compiled:
            self.rates(cython.address(state[0]), a, a_v, cython.address(found[0]), counted)
        else:
            self.rates(state, a, a_v, found, counted)
        return np.asarray(found)

    def sizes_at(self, y, a, a_v):
        """Return what `sizes` computes, shape (n,)."""
        state: cython.double[::1] = y
        found: cython.double[::1] = np.zeros(max(len(y), 1))
        if cython.compiled:
            self.sizes(cython.address(state[0]), a, a_v, cython.address(found[0]))
        else:
            self.sizes(state, a, a_v, found)
        return np.asarray(found)

    def observe_at(self, y, rates, a, a_v, out):
        """Do what `observe` does, with arrays."""
        state: cython.double[::1] = y
        moves: cython.double[::1] = rates
        found: cython.double[::1] = out
        if cython.compiled:
            self.observe(cython.address(state[0]), cython.address(moves[0]), a, a_v, cython.address(found[0]))
        else:
            self.observe(state, moves, a, a_v, found)

    def conditions_at(self, y, rates, a, a_v, out):
        """Do what `conditions` does, with arrays."""
        state: cython.double[::1] = y
        moves: cython.double[::1] = rates
        found: cython.double[::1] = out
        if cython.compiled:
            self.conditions(cython.address(state[0]), cython.address(moves[0]), a, a_v, cython.address(found[0]))
        else:
            self.conditions(state, moves, a, a_v, found)

    def rates_along(self, states, a, a_v, counted=True):
        """Return the rates of many states, shape (k, n), each under its own accelerations."""
        given: cython.double[:, ::1] = states
        across: cython.double[::1] = a
        upwards: cython.double[::1] = a_v
        rates = np.zeros(states.shape)
        found: cython.double[:, ::1] = rates
        which: cython.bint = counted
        k: cython.Py_ssize_t
        for k in range(given.shape[0] if states.size else 0):
            if cython.compiled:
                self.rates(cython.address(given[k, 0]), across[k], upwards[k], cython.address(found[k, 0]), which)
            else:
                self.rates(given[k], across[k], upwards[k], found[k], which)
        return rates

    def observe_along(self, states, rates, a, a_v, out):
        """Do what `observe` does at many states, with arrays of a row for each."""
        given: cython.double[:, ::1] = states
        moves: cython.double[:, ::1] = rates
        across: cython.double[::1] = a
        upwards: cython.double[::1] = a_v
        found: cython.double[:, ::1] = out
        k: cython.Py_ssize_t
        for k in range(given.shape[0] if out.size else 0):
            if cython.compiled:
                self.observe(
                    cython.address(given[k, 0]),
                    cython.address(moves[k, 0]),
                    across[k],
                    upwards[k],
                    cython.address(found[k, 0]),
                )
            else:
                self.observe(given[k], moves[k], across[k], upwards[k], found[k])

    def enter_at(self, y, more):
        """Do what `enter` does, with arrays."""
        state: cython.double[::1] = y
        found: cython.double[::1] = more
        if cython.compiled:
            self.enter(cython.address(state[0]), cython.address(found[0]))
        else:
            self.enter(state, found)


@cython.final
@cython.cclass
class Function(Field):
    """A field that is a function in Python of y, a and a_v, for n states: slow."""

    def __init__(self, function, n):
        self.function, self.n = function, n

    def rates(self, y, a, a_v, out, counted):
        """Compute the rates; an exception is kept, and the rates are then not numbers."""
        with cython.gil:
            self.call(y, a, a_v, out)

    def call(self, y, a, a_v, out):
        """Call the function."""
        k: cython.int
        state = np.empty(self.n)
        given: cython.double[::1] = state
        for k in range(self.n):
            given[k], out[k] = y[k], np.nan
        if self.failure is not None:
            return
        try:
            found: cython.double[::1] = np.array(self.function(state, a, a_v), dtype=float)
            if found.shape[0] != self.n:
                raise InputError(f"A field must return {self.n} rates, but it returned {found.shape[0]}.")
        except BaseException as error:  # it goes on once the lock is taken again
            self.failure = error
            return
        for k in range(self.n):
            out[k] = found[k]

    def sizes(self, y, a, a_v, out):
        """Take the rates themselves."""
        k: cython.int
        self.rates(y, a, a_v, out, False)
        for k in range(self.n):
            out[k] = abs(out[k])


@cython.final
@cython.cclass
class Compiled(Field):
    """A field that is a compiled function: ``void f(const double *y, double a, double a_v, double *out)``.

    `source` is what holds it in memory at its address.
    """

    def __init__(self, source, address: cython.size_t, n):
        self.source, self.n = source, n
        if cython.compiled:
            self.function = cython.cast(CFunction, cython.cast(cython.p_void, address))  # noqa: F821
        else:
            self.function = SIGNATURE(address)

    def rates(self, y, a, a_v, out, counted):
        """Call the function."""
        if cython.compiled:
            self.function(y, a, a_v, out)
        else:
            self.function(y.ctypes.data, a, a_v, out.ctypes.data)

    def sizes(self, y, a, a_v, out):
        """Take the rates themselves."""
        k: cython.int
        self.rates(y, a, a_v, out, False)
        for k in range(self.n):
            out[k] = abs(out[k])


@cython.cclass
class Jump:
    """What happens to the state at an event, as a compiled method."""

    def apply(self, y, a, a_v):
        """Change the state; return 0 if `Event.target` follows, 1 if `Event.other` does, -1 after a failure.

        With 2 added the event counts as `Event.noted`, too.
        """
        return -1

    def error(self):
        """Return the exception after a failure."""
        return NotImplementedError("A jump must say what it does.")

    def apply_at(self, y, a, a_v):
        """Do what `apply` does, with an array."""
        state: cython.double[::1] = y
        if cython.compiled:
            return self.apply(cython.address(state[0]), a, a_v)
        return self.apply(state, a, a_v)
