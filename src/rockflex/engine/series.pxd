cimport cython
from rockflex.engine.flow cimport Flow
from rockflex.engine.loops cimport Peaks, Phases


@cython.final
cdef class Series:
    cdef Phases phases
    cdef Peaks peaks
    cdef Flow flow
    cdef int n, states, outputs  # `states`: rows of the states in tables and series, a multiple of 8
    cdef double h
    cdef double[::1] y, sizes  # the state, and the magnitudes of the terms that it was summed from
    cdef double[::1] one_sided, high, when
    cdef double[:, ::1] series  # a row of coefficients for each power: states, conditions, outputs
    cdef double[:, ::1] sums  # the same for the first powers: magnitudes of the terms of a coefficient
    cdef double[::1] away  # of conditions: how far the expanded motion may get from its start
    cdef double[::1] start, reach  # of outputs: there, and how far they may get
    cdef int place, terms  # of the phase, and of the expansion
    cdef double part, a, rise  # the part of a sample that it covers, the acceleration at its start, and its change
    cdef (double, double) v  # the same of the vertical acceleration
    cdef double[::1] workspace, q, slope
    cdef double[::1] term  # of the series before that in `workspace`: magnitudes

    cdef double expand(self, int place, double start, double end, (double, double) v, double u) noexcept nogil
    cdef (double, int) first_event(self) noexcept nogil
    cdef void sum_up(self, int order) noexcept nogil
    cdef void skip(self) noexcept nogil
    cdef void move(self, double t) noexcept nogil
    cdef int drop_hopeless_samples(self) noexcept nogil
    cdef int candidate(self, int r) noexcept nogil
    cdef int phase_of(self, int r) noexcept nogil
    cdef void begin_search(self, int r, const double[::1] a) noexcept nogil
    cdef double search(self, int r, double start, double end, (double, double) v, double sample, double u) noexcept nogil
    cdef void raise_peaks(self, double stop, double sample, double[::1] highest) noexcept nogil
    cdef void reach_of_step(self) noexcept nogil
    cdef void raise_peak(self, int j, double stop, double sample, double highest) noexcept nogil
