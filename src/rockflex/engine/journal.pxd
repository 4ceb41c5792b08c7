cimport cython


@cython.final
cdef class Journal:
    cdef int n
    cdef readonly int n_events
    cdef int n_nodes
    cdef double[::1] times
    cdef int[:, ::1] exits  # of each event: place of its phase, its number, and number of the state after it
    cdef int[::1] often  # events of each kind
    cdef int[:, ::1] kinds, notes  # numbers of the names of events and of their second names, by phase and event
    cdef dict names  # those numbers by name
    cdef double[:, ::1] rows
    cdef int[::1] places

    cpdef long long size(self) noexcept nogil
    cpdef bint wants(self, double a, double v) noexcept nogil
    cpdef int keep(self, double sample, double a, double v, double[::1] y, int place) except -1 nogil
    cpdef void begin(self) noexcept nogil
    cpdef int count(self, int kind) noexcept nogil
    cpdef int kind(self, object name)
    cpdef register_phase(self, int place, tuple events)
    cpdef int happen(self, double time, int place, int event) except -1 nogil
    cpdef int note(self, int place, int event) except -1 nogil
    cdef int tally(self, int kind) except -1 nogil
