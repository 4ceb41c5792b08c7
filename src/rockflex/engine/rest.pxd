cimport cython


@cython.final
cdef class Decay:
    cdef bint parted, swings  # whether the modes are independent; whether all that move oscillate
    cdef int n, outputs
    cdef readonly Py_ssize_t size  # bytes
    cdef double fastest  # largest rate at which a mode fades, 1/s
    cdef double[:, ::1] A
    cdef double[::1] c, constants
    cdef double[:, ::1] rows  # outputs and conditions, (R, n)
    cdef double[:, :, ::1] inverse  # of the vectors: real and imaginary parts, magnitudes
    cdef double[:, :, ::1] seen  # C V_k/λ_k, zero where held: real and imaginary parts, magnitudes
    cdef double[:, ::1] sizes  # |V|
    cdef double[:, :, ::1] ends  # V_k/λ_k, zero where held: real and imaginary parts
    cdef int[::1] kinds  # of the modes: 0 held, 1 steady, 2 swings; and 4 if it grows
    cdef double[::1] rate, terms  # y', and the sums of the magnitudes of its terms
    cdef double[:, ::1] parts  # w: real and imaginary parts, magnitudes

    cdef bint moves(self, int kind) noexcept nogil
    cdef (double, double, double, double, double) look(self, int j, double[::1] y) noexcept nogil
    cdef void bring_to_rest(self, double[::1] y) noexcept nogil
    cpdef double time_to_rest(self, double[::1] y, double[::1] high, double[::1] one_sided) noexcept nogil


@cython.final
cdef class PhaseDecay:
    cdef dict known
    cdef readonly Decay decay  # in the last phase that was taken, with its place and system
    cdef readonly int place, which

    cpdef Py_ssize_t prepare_phase(self, phase, int place, int which) except -1
