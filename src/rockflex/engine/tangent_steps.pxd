cimport cython


cdef void add(
    double[:, ::1] table, int first, double[::1] x, int at, int count, double factor, double[::1] out, int to, int width
) noexcept


@cython.final
cdef class Motion:
    cdef readonly int n, P
    cdef int outputs, levels, whole
    cdef double h, speed
    cdef bint shakes  # whether a vertical acceleration matters for the rates
    cdef double[:, ::1] rates, rates_v  # columns: y, a, 1; and y, 1
    cdef double[:, ::1] d_rates, d_rates_v  # of all parameters, one after another
    cdef double[:, ::1] rows, rows_v
    cdef double[:, :, ::1] d_rows, d_rows_v
    cdef double[::1] scales
    cdef double[:, ::1] tables, slopes  # columns y, a, a', 1 of each level
    cdef double[::1] out, more, term, before, tangent, passed

    cdef int step(self, int level, double[::1] x, double[::1] s, bint tangents) except -1
    cdef int expand(self, double[::1] x, double[::1] s, bint tangents, double v, double climb, double length) except -1
    cdef int expand_piece(
        self, double[::1] x, double[::1] s, bint tangents, double v, double climb, double tau, int terms
    ) except -1
    cdef int advance_freely(self, double[::1] x, double[::1] s, bint tangents, double length) except -1
    cdef int advance_in_sample(
        self, double[::1] x, double[::1] s, bint tangents, double v, double climb, double part
    ) except -1
    cdef int rates_at(self, double[::1] y, double a, double v, double[::1] out) except -1
    cdef double value(self, int row, double[::1] y, double a, double v) noexcept
    cdef double slope(self, int row, int p, double[::1] y, double[::1] s, double a, double v) noexcept
    cdef double rate(self, int row, double[::1] y, double[::1] rates, double grows, double v, double climbs) noexcept
