from rockflex.engine.batch cimport Batch
from rockflex.engine.flow cimport Flow
from rockflex.engine.journal cimport Journal
from rockflex.engine.loops cimport Peaks, Phases
from rockflex.engine.rest cimport PhaseDecay
from rockflex.engine.series cimport Series


cdef class Run:
    cdef readonly object system
    cdef readonly double h
    cdef readonly int which
    cdef long long phase_bytes  # memory of the phases
    cdef public long long memory
    cdef readonly bint ended
    cdef public object watch
    cdef public long long limit
    cdef public bint marks
    cdef long long stretch  # work without a look at Ctrl-C
    cdef readonly str failure
    cdef bint failed
    cdef Py_ssize_t reached  # samples of this call of `advance` that have passed
    cdef list met  # phases met so far: keys and phases, or None where forgotten
    cdef long long[::1] used  # when each of them was used last, by the clock
    cdef long long clock
    cdef dict places  # of the phases, by their keys
    cdef PhaseDecay decay
    cdef Phases phases
    cdef int now  # place of the present phase
    cdef int n
    cdef int states  # rows of the states in tables and series, a multiple of 8
    cdef int outputs
    cdef double[::1] y  # and room, to a multiple of 8; so in `sizes` and `before`
    cdef double[::1] one_sided
    cdef Peaks peaks_
    cdef double[::1] high
    cdef double[::1] when
    cdef Flow flow
    cdef Series series
    cdef double[::1] unbounded  # of outputs whose highest values are not known
    cdef double[::1] sizes  # of the states: magnitudes of the terms that they were summed from
    cdef double[::1] workspace
    cdef double[:, ::1] scratch  # the states of a march, if there is a history
    cdef double[:, ::1] unkept  # of one row: none are kept
    cdef double[::1] still  # the vertical acceleration where there is none: empty
    cdef bint shakes  # whether there is one
    cdef double[::1] quiet
    cdef double[::1] start  # the state at time 0, and the place of its phase
    cdef int first
    cdef double[::1] before  # the state, while the motion in another sample is expanded
    cdef Py_ssize_t passed  # samples, before this call of `advance`
    cdef double end  # time of the last event
    cdef readonly Journal journal
    cdef int n_searched  # samples expanded for peaks

    cdef void begin(self) noexcept nogil
    cdef int enter(self, key) except -1
    cdef int place_of(self, key) except -1
    cdef int meet_first(self, Batch batch) except -1
    cdef refuse_step(self, int place)
    cdef int load(self, int place) except -1 nogil
    cdef int renew(self, int place) except -1
    cdef int prepare(self, key, int place) except -1
    cdef forget(self)
    cdef void choose(self, int which) noexcept nogil
    cdef int follow_all(self, Batch batch, bint history) except -1 nogil
    cdef int proceed(self, const double[::1] ground, const double[::1] rise, bint history) except -1 nogil
    cdef bint overflows(self) noexcept nogil
    cdef int coast_over(self, long long samples, bint history) except -1 nogil
    cdef int advance_over(self, const double[::1] a, const double[::1] v, double[:, ::1] states) except -1 nogil
    cdef double rise_at(self, const double[::1] v, int i) noexcept nogil
    cdef int check_stop_request(self) except -1 nogil
    cdef int settle_over(self, long long most, bint history) except -1 nogil
    cdef int advance_sample(self, int i, double start, double end, (double, double) v, bint history) except -1 nogil
    cdef int leave(self, int event, double sample, double a, double v) except -1 nogil
    cdef int resolve_next_phase(self, int event, int outcome) except -1
    cdef refuse(self, int event, double sample)
    cdef void apply_jump_matrix(self, int outcome) noexcept nogil
    cdef raise_step_too_small(self, double sample)
    cdef call_jump_function(self, int event, double a, double v)
    cdef int search(self, const double[::1] a, const double[::1] v, bint finish) except -1 nogil
