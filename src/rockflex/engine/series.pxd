cimport cython
from rockflex.engine.loops cimport Peaks, Phases


@cython.final
cdef class Series:
    cdef Phases phases
    cdef Peaks peaks
    cdef int n, states, outputs  # `states`: rows of the states in tables and series, a multiple of 8
    cdef double h
    cdef double[::1] y, sizes  # the state, and the magnitudes of the terms that it was summed from
    cdef double[::1] one_sided, high, when
    cdef double[:, ::1] series  # a row of coefficients for each power: states, outputs, conditions
    cdef double[:, ::1] sums  # the same for the first powers: magnitudes of the terms of a coefficient
    cdef double[::1] away  # of outputs and conditions: how far the expanded motion may get from its start
    cdef double[::1] workspace, q, slope

    cdef (double, int) expand(self, int place, double start, double end, double u) noexcept nogil
    cdef (double, int) first_event(self, int place, int terms, double h, double a, double rise) noexcept nogil
    cdef void sum_up(self, int place, int order, double h, double a, double rise) noexcept nogil
    cdef void jump_to_end(self, int terms) noexcept nogil
    cdef void move(self, int terms, double t) noexcept nogil
    cdef void raise_peaks(self, int terms, double stop, double sample, double part) noexcept nogil
    cdef void raise_peak(self, int j, int terms, double stop, double bound, double sample, double part) noexcept nogil
