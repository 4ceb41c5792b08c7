cimport cython


@cython.final
cdef class Batch:
    cdef public int place  # the present run
    cdef readonly int count
    cdef readonly tuple names
    cdef double[::1] samples, scales, record  # of all records; factors; room for the longest one
    cdef Py_ssize_t[:, ::1] bounds  # of the record of each run in them
    cdef long long free  # samples without excitation after each record
    cdef bint settles
    cdef int[::1] kinds  # of the events that are counted
    cdef unsigned char[::1] ended_, rested_
    cdef double[::1] times_
    cdef int[:, ::1] counts_
    cdef double[:, ::1] high_, when_, states_
    cdef int outputs, n

    cdef double[::1] scaled(self) noexcept nogil
    cdef void close(self, bint rested, double time, double h, double[::1] high, double[::1] when, double[::1] y) noexcept nogil
