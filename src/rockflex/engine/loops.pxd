cimport cython

from rockflex.engine.levels cimport Log, Phase, Step


@cython.final
cdef class Peaks:
    cdef Log log
    cdef double[::1] high_, when_, seen
    cdef size_t space  # of the workspace, bytes
    cdef readonly double[:, ::1] candidates

    cdef int widen(self, int rows) except -1
    cdef void begin(self, double[::1] one_sided) noexcept nogil
    cdef void set_sample_offset(self, double samples) noexcept nogil
    cdef int looks(self) noexcept nogil
    cdef int count(self) noexcept nogil
    cdef void keep(self, int count) noexcept nogil
    cdef long long work(self) noexcept nogil
    cdef long long pause(self) noexcept nogil
    cdef void pause_at(self, long long work) noexcept nogil
    cdef void add_work(self, long long more) noexcept nogil
    cdef void look(self, bint looks) noexcept nogil
    cdef double before(self) noexcept nogil


@cython.final
cdef class Phases:
    cdef Phase *phases
    cdef readonly int count
    cdef readonly int n, states
    cdef double[::1] one_sided
    cdef list contents, offsets, shaken, fields
    cdef int[::1] known  # of each phase: 0 if its tables are forgotten, 2 if there are those for vertical acceleration
    cdef Step step
    cdef readonly double[:, ::1] rows, found  # of a step: states and rates, outputs and conditions; see `tableau`

    cdef void release(self, int place) noexcept nogil
    cdef void select(self, int which) noexcept nogil
    cdef void switch_system(self, int place, int which) noexcept nogil
    cdef bint has_tables(self, int place, bint shakes) noexcept nogil
    cdef int events(self, int place) noexcept nogil
    cdef int halvings(self, int place) noexcept nogil
    cdef int shift(self, int place, (double, double) v) noexcept nogil
    cdef double scale(self, int place, int event) noexcept nogil
    cdef int following(self, int place, int outcome) noexcept nogil
    cdef int jump(self, int place, int outcome, bint magnitudes, double[::1] y, double[::1] workspace) noexcept nogil
    cdef int rests(self, int place, int event, double[::1] y, double a, double v) noexcept nogil
    cdef int march(self, int place, const double[::1] a, const double[::1] v, int i, int last, double[::1] y, Peaks peaks, double[:, ::1] states) noexcept nogil
    cdef void advance(self, int place, const double[::1] a, int i, double[::1] y) noexcept nogil
    cdef int expand(self, int place, double h, double a, double rise, (double, double) v, double[::1] y, double[:, ::1] series, double[::1] away) noexcept nogil
    cdef void reach(self, int place, (double, double) v, int terms, double[:, ::1] series, double[::1] start, double[::1] away) noexcept nogil
    cdef void complete(self, int place, (double, double) v, int terms, double[:, ::1] series) noexcept nogil
    cdef void evaluate(self, double[:, ::1] series, int terms, double t, double[::1] out) noexcept nogil
    cdef void move(self, double[:, ::1] series, int terms, double t, double[::1] out, double[::1] sizes) noexcept nogil
    cdef void magnitudes(self, int place, (double, double) v, int order, double[::1] before, double[::1] x, double[::1] out) noexcept nogil
    cdef bint nonlinear(self, int place) noexcept nogil
    cdef int leap(self, int place, int event, double[::1] y, double a, double a_v) noexcept nogil
    cdef double *row(self, int number) noexcept nogil
    cdef void begin(self, int place) noexcept nogil
    cdef void rates(self, int place, double a, double a_v, int at, int to, bint counted) noexcept nogil
    cdef void terms_of_rates(self, int place, double a, double a_v, int at, int to) noexcept nogil
    cdef double attempt(self, int place, double length, double a, double rise, double v, double climb, bint counted) noexcept nogil
    cdef void within(self, int place, int stage) noexcept nogil
    cdef void bend(self, int place, bint counted, double[:, ::1] series) noexcept nogil
    cdef void look(self, int place, bint outputs, (double, double) v, int k, int before, int at, int to) noexcept nogil
    cdef void observe(self, int place, double a, double a_v, int at, int rates, int to) noexcept nogil
    cdef void check(self, int place, double a, double a_v, int at, int rates, int to) noexcept nogil
    cdef int moving(self, int place) noexcept nogil
