cimport cython
from rockflex.engine.journal cimport Journal


@cython.final
cdef class Batch:
    cdef public int place  # the present run
    cdef readonly int count
    cdef readonly tuple names, keys
    cdef double[::1] samples, scales, record, rise  # of all records; factors; room for the longest one, twice
    cdef Py_ssize_t[:, ::1] bounds  # of the record of each run in them, and of the vertical one
    cdef const long long[:] free  # samples without excitation after each record
    cdef const int[:] which  # system of the stack
    cdef const double[:, :] starts  # states at time 0
    cdef int[:] phase  # of the first phase, among the keys
    cdef int[::1] first  # places of the phases of the keys, in a run
    cdef bint settles
    cdef int[::1] kinds  # of the events that are counted
    cdef int[:, ::1] numbers  # a row for each run: how it has ended, place of the phase, numbers of events
    cdef double[:, ::1] values  # a row for each run: time, highest values, their times, the last state or that at rest
    cdef int outputs, n

    cdef double[::1] scaled(self) noexcept nogil
    cdef double[::1] scaled_vertical(self) noexcept nogil
    cdef void close(
        self, int outcome, int place, double time, double h, double[::1] high, double[::1] when, double[::1] y, Journal journal
    ) noexcept nogil
