cimport cython
from rockflex.engine.loops cimport Peaks, Phases


@cython.final
cdef class Flow:
    cdef Phases phases
    cdef Peaks peaks
    cdef readonly int n, states, outputs, terms
    cdef double h
    cdef double[::1] high, when, one_sided
    cdef double[:, ::1] rows, found  # of `Phases`: states and rates, outputs and conditions, see `tableau`
    cdef double[::1] shaking  # a at the start of the step and its change, and those of a_v
    cdef bint counts  # whether the states on which nothing depends are integrated
    cdef int place  # of the phase
    cdef bint known, told, entered, tried  # whether its first rates, its first rows, its conditions, and a whole step are
    cdef int young  # steps that are left in which an output may rise above its peak and fall again within one
    cdef double step  # the next one, in samples
    cdef double part  # that which was tried
    cdef double reached  # the part of a sample that has passed where a march has stopped
    cdef double[::1] nodes  # where outputs that are not linear are computed
    cdef double[:, ::1] fits, tilts  # their coefficients from that, and slopes of a cubic from its values
    cdef list facts  # what follows, by phase
    cdef int[:, ::1] curved  # numbers of the outputs that are not linear, by phase; the first is how many
    cdef double[:, ::1] least  # sizes of these outputs below which it does not matter how far they are from a peak
    cdef int[:, ::1] velocities  # places of the states that are the rates of the states, -1 if there are none
    cdef int[:, ::1] exact  # conditions of states that have such rates
    cdef int[:, ::1] straight  # whether an output is linear, by phase
    cdef int[:, ::1] checked  # numbers of the conditions that are not linear, by phase; the first is how many
    cdef double[::1] slopes  # of a cubic, at both ends

    cdef void begin(self) noexcept nogil
    cdef void resume(self, bint counts) noexcept nogil
    cdef void forget(self) noexcept nogil
    cdef void enter(self, int place) noexcept nogil
    cdef void arrive(self, int place, double a, double v) noexcept nogil
    cdef double take_step(self, int place, double start, double end, (double, double) v, double u) noexcept nogil
    cdef void accept(self) noexcept nogil
    cdef void leave(self) noexcept nogil
    cdef void enlarge(self, double[::1] sizes) noexcept nogil
    cdef int march(self, int place, const double[::1] a, const double[::1] v, int i, int last, double[:, ::1] states) noexcept nogil
    cdef double cross(self, int place, double start, double end, (double, double) v, double u, double sample) noexcept nogil
    cdef void look(self, int place, double a, double v, int at, int rates, int to) noexcept nogil
    cdef void check(self, int place, double a, double v, int at, int rates, int to) noexcept nogil
    cdef void check_within(self, int place, int stage, double t, int to) noexcept nogil
    cdef void check_at(self, double[:, ::1] series, double t) noexcept nogil
    cdef void fit(self, double[:, ::1] series, double[::1] away) noexcept nogil
    cdef double sharpened(self, double[:, ::1] series, int e, double t) noexcept nogil
    cdef void tilt(self, int first, int early, int late, int last, int j) noexcept nogil
    cdef void look_ahead(self, int place) noexcept nogil
    cdef double counted(self, int j, double value) noexcept nogil
    cdef void raise_to(self, int outs, double sample) noexcept nogil
    cdef bint may_fail_within_step(self, int place) noexcept nogil
    cdef bint may_have_interior_peak(self, int place) noexcept nogil
    cdef bint curves_hide(self, int place) noexcept nogil
    cdef void look_within(self, int place, int stage, double t, int outs) noexcept nogil
    cdef void slopes_of(self, bint outputs, int place) noexcept nogil
    cdef bint clear(self, double t, double sample) noexcept nogil
    cdef int fill(self, double[:, ::1] series, double[::1] away) noexcept nogil
    cdef void complete(self, double[:, ::1] series, int first) noexcept nogil
    cdef void sum_up(self, int order, double[:, ::1] series, double[::1] sizes, double[::1] away, double[:, ::1] sums) noexcept nogil
    cdef double time_to_rest(self, int place) noexcept nogil
