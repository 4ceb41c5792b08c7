cimport cython

cdef extern from "march.h" nogil:
    int AHEAD, BLOCK, MAX_STATES, MAX_ROWS
    ctypedef struct Shaken:
        int fed, shift
        const int *places
        const double *now
        const double *outs
        const double *magnitude
        const double *most
        int nodes
        const double *limit
        const double *times
        const double *known
        const double *given
        const double *feedback
        const double *rows
        const double *speeds
        const double *slope
        const double *direct
        const double *moves
        const double *bend
        const double *sway
        const double *jolt
        const double *loop
        const double *swell[4]
    ctypedef struct Climb:
        double start, rise
    ctypedef struct Tables:
        int n, outputs, rows, shift, parts
        double h
        const double *block
        const double *step
        const double *moves
        const double *now
        const double *outs
        const double *slope
        const double *bend
        const double *cap
        const double *centre
        const double *sway
        const double *jolt
        const double *direct
        const double *magnitude
        const double *most
        const double *border
        const double *one_sided
        Shaken shaken
    ctypedef struct Log:
        double *high
        double *when
        double passed
        double *states
        double *candidates
        double *seen
        int resumes, count, room, width, looks
        void *workspace
        long long pause, work
    ctypedef struct Phase:
        Tables tables
        int events, halvings, which
        const int *halvings_of
        Py_ssize_t stride, shaken_stride
        const double *scale
        const double **jump
        const double **rest
        int *following
        void **leaps
        void *field
        int moving, counted
        const double *floor
    int UNKNOWN, ENDS, ASKED
    ctypedef struct Step:
        int width
        double *rates
        double *start
        double *end
        double *place
        double *largest
        const double *weights
        const double *nodes
        double length, a, rise, v, climb
    ctypedef void (*Rates)(void *field, const double *y, double a, double a_v, double *out, int counted) noexcept nogil
    ctypedef struct Shape:
        int n, outputs, rows, shift, parts
        double h
    ctypedef struct Loops:
        const char *level
        int group
        size_t (*workspace)(int rows) noexcept nogil
        void (*product)(int columns, int rows, const double *table, const double *x, double *out) noexcept nogil
        int (*expand)(const Tables *p, double h, double a, double rise, Climb v, const double *y, int room, int width, double *series) noexcept nogil
        void (*evaluate)(int rows, int terms, int width, const double *series, double t, double *out) noexcept nogil
        void (*move)(int rows, int terms, int width, const double *series, double t, double *out, double *sizes) noexcept nogil
        void (*spread)(int rows, int terms, int width, const double *series, double *out) noexcept nogil
        void (*reach)(const Tables *p, Climb v, int terms, int width, const double *series, double *start, double *away) noexcept nogil
        void (*complete)(const Tables *p, Climb v, int terms, int width, double *series) noexcept nogil
        void (*magnitudes)(const Tables *p, Climb v, int order, const double *before, const double *x, double *out) noexcept nogil
        void (*advance)(const Tables *p, const double *a, const double *y, double *next) noexcept nogil
        int (*march)(const Tables *p, int phase, const double *a, const double *v, int i, int last, double *y, Log *log) noexcept nogil
        double (*attempt)(const Phase *p, const Step *s, Rates rates, int counted) noexcept nogil
        void (*look)(const Phase *p, int outputs, Climb v, int k, const double *before, const double *x, double *out) noexcept nogil
        void (*within)(const Phase *p, const Step *s, int stage) noexcept nogil
        void (*bend)(const Phase *p, const Step *s, Rates rates, int counted, int width, double *series) noexcept nogil
        size_t (*room)(const Shape *s) noexcept nogil
        double (*turn)(const Shape *s, const double *rates, double *memory) noexcept nogil
        int (*fast_modes)(const Shape *s, const double *roots, const double *vectors, double *memory, double *modes) noexcept nogil
        int (*prepare)(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory, const Py_ssize_t *places, double *to) noexcept nogil
    const Loops *rockflex_loops(const char *level)


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
    cdef int parts(self, int place) noexcept nogil
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
