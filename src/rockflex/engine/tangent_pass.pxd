cimport cython
from rockflex.engine.tangent_steps cimport Motion


@cython.final
cdef class Crossing:
    cdef double[:, ::1] jump  # column after column; empty where the state is continuous
    cdef double[:, :, ::1] slopes
    cdef object ask


@cython.final
cdef class Pass:
    cdef list motions, crossings
    cdef int n, P, last, next, kept
    cdef bint free, keeps
    cdef double h, v, climb  # and the vertical acceleration in a sample, and its growth a second
    cdef double[::1] x, s, w, none, before, then, found
    cdef double[::1] times, ground, rise
    cdef const double[::1] record, vertical
    cdef double[:, ::1] states
    cdef int[::1] places, kinds, lows, highs, order, follows, observed
    cdef int[:, ::1] turns
    cdef double[::1] high, when, rates
    cdef unsigned char[::1] one_sided
    cdef double[:, ::1] at, delays, peaks, log

    cdef int arrive(self, int node) except -1
    cdef int note(self, double time, int node, double a, double v) except -1
    cdef double change(self, int sample) noexcept
    cdef double change_of_rise(self, int sample) noexcept
    cdef int advance(self, int node, double end) except -1
    cdef int sample(self, int k, double time) except -1
    cdef int move(self, Motion motion, int node, double now, double end, bint tangents) except -1
    cdef int slope_of_row(self, Motion motion, int r, double a, double v) except -1
    cdef int slope_at_node(self, int r) except -1
    cdef int take(self, int node) except -1
    cdef int cross(self, int node, int event) except -1
    cdef int delay(self, Motion motion, int node, int event) except -1
    cdef bint is_jump_of_ground(self, int node) noexcept
    cdef int end(self, int node, int event) except -1
