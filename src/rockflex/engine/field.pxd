cimport cython


cdef class Field:
    cdef public object failure  # an exception of a function in Python

    cdef void rates(self, const double *y, double a, double a_v, double *out, bint counted) noexcept nogil
    cdef void sizes(self, const double *y, double a, double a_v, double *out) noexcept nogil
    cdef void observe(self, const double *y, const double *rates, double a, double a_v, double *out) noexcept nogil
    cdef void conditions(self, const double *y, const double *rates, double a, double a_v, double *out) noexcept nogil
    cdef void enter(self, const double *y, double *more) noexcept nogil


@cython.final
cdef class Function(Field):
    cdef object function
    cdef int n

    cdef call(self, const double *y, double a, double a_v, double *out)


ctypedef void (*CFunction)(const double *y, double a, double a_v, double *out) noexcept nogil


@cython.final
cdef class Compiled(Field):
    cdef object source
    cdef CFunction function
    cdef int n


cdef class Jump:
    cdef int apply(self, double *y, double a, double a_v) noexcept nogil
