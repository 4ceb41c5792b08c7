cdef extern from "march.h" nogil:
    int BLOCK, MAX_STATES, MAX_ROWS
    ctypedef struct Tables:
        int n, outputs, conditions
        double h
        const double *step
        const double *now
        const double *slope
        const double *bend
        const double *sway
        const double *magnitude
        const double *one_sided
    ctypedef struct Log:
        double *high
        double *when
        double passed
        double *states
        double *candidates
        double *rows
        int resumes, count, room, width, looks
    ctypedef struct Loops:
        const char *level
        void (*product)(int columns, int rows, int total, const double *table, const double *x, double *out) noexcept nogil
        int (*expand)(const Tables *p, double h, double a, double rise, const double *y, int room, int width, double *series) noexcept nogil
        void (*evaluate)(int rows, int terms, int width, const double *series, double t, double *out) noexcept nogil
        void (*spread)(int rows, int terms, int width, const double *series, double *out) noexcept nogil
        int (*march)(const Tables *p, int phase, const double *a, int i, int last, double *y, Log *log) noexcept nogil
    const Loops *rockflex_loops(const char *level)


cdef class Peaks:
    cdef Log log
    cdef readonly object high, when, rows
    cdef readonly double[:, ::1] candidates


cdef class PhaseLoops:
    cdef Tables tables
    cdef readonly tuple kept
    cdef int states

    cdef int march(self, int phase, const double[::1] a, int i, int last, double[::1] y, Peaks peaks, double[:, ::1] states)
    cdef int expand(self, double h, double a, double rise, const double[::1] y, double[:, ::1] series, double[::1] away)
    cdef void evaluate(self, double[:, ::1] series, int terms, double t, double[::1] out)
    cdef void magnitudes(self, double[::1] x, double[::1] out)
