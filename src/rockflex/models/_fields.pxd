cimport cython
from rockflex.engine.field cimport Field, Jump


@cython.final
cdef class RockingField(Field):
    cdef int n, side, branch, whole, memory, n_internal, kinds_count, stops_count
    cdef bint complete, hysteretic, viscous, pulled, held
    cdef double[::1] omega2, stiffness, drag, height, mass, lever
    cdef double[:, ::1] releases
    cdef double grip
    cdef double offset, left, inverse, levers_sum, weight_arm, total_mass, gravity, resting
    cdef double yields, loading, slip, ratio, gamma, beta, exponent
    cdef double[:, ::1] pulls
    cdef int[::1] kinds
    cdef double[:, ::1] levers
    cdef double[:, ::1] stops
    cdef int[:, ::1] stop_kinds

    cdef double pull(self, const double *y, int which) noexcept nogil
    cdef double imbalance(self, const double *y, const double *rates, double a, double a_v) noexcept nogil
    cdef double inertia_left(self, const double *y) noexcept nogil
    cdef inline void rates_of(self, int n, const double *y, double a, double a_v, double *out, bint counted) noexcept nogil
    cdef inline void in_contact(self, int n, const double *y, double a, double *out, bint counted) noexcept nogil
    cdef inline void by_small_rotations(self, int n, const double *y, double a, double a_v, double *out, bint counted) noexcept nogil
    cdef inline void by_large_rotations(self, int n, const double *y, double a, double a_v, double *out, bint counted) noexcept nogil
    cdef inline double restoring(self, int n, const double *y, double *out, bint counted) noexcept nogil
    cdef double power(self, double z) noexcept nogil
    cdef void enter_energies(self, const double *y, double turning, double pushing, double spin, double swing, double *out) noexcept nogil


@cython.final
cdef class LinearTurn(Field):
    cdef double[::1] row, vertical
    cdef int n, spin


@cython.final
cdef class Landing(Jump):
    cdef object gains
    cdef int n, side, slip
    cdef bint complete, follows, guarded, measured, scaled
    cdef double passes, shortest, unseen, total_mass, modal_inertia, arm
    cdef double own_offset, own_left, new_offset, new_left  # of the old pivot and of the new one
    cdef double[::1] mass, height
    cdef Field beyond
    cdef double[::1] rates
    cdef int[::1] places
    cdef double[::1] offsets

    cdef double inertia(self, const double *y, double left, double offset) noexcept nogil
    cdef double energy(self, const double *y, double inertia) noexcept nogil
    cdef double share(self, const double *y, double before, double after) noexcept nogil


@cython.final
cdef class Change(Jump):
    cdef bint chords, stops
    cdef int rotation
    cdef int[::1] places, marked
    cdef double[:, ::1] turnings
    cdef double[::1] marks


@cython.final
cdef class Reversal(Jump):
    cdef int velocity
    cdef double barely
