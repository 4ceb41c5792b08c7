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
        int n, outputs, rows, shift, parts, capped
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
    int TOGETHER, UU, UV, U0, U1, VU, VV, V0, V1, SQUARE, DRAG, SWAY, SPREAD, SD, SV, FACTORS
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
        int n, outputs, rows, shift, parts, capped, slow, inputs
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
        double (*turn)(const Shape *s, const double *A, double *memory) noexcept nogil
        int (*modes_of)(const Shape *s, const double *A, const double *roots, const double *vectors, double *memory, double *modes) noexcept nogil
        int (*amplitudes)(int n, const double *modes, int count) noexcept nogil
        void (*bound)(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory, double *moves, double *to) noexcept nogil
        int (*prepare)(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory, const Py_ssize_t *places, double *to) noexcept nogil
        void (*oscillate)(const double *a, Py_ssize_t first, Py_ssize_t last, double *factors, double *us, double *vs) noexcept nogil
        void (*exceed)(const double *a, double h, Py_ssize_t first, Py_ssize_t last, const double *factors, const double *us, const double *vs, Py_ssize_t room, Py_ssize_t *places) noexcept nogil
    const Loops *rockflex_loops(const char *level)

cdef const Loops *LOOPS
