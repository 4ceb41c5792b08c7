/* The loops over vectors: products of a matrix and a vector for a few samples at once, and power series.

   Rows come in multiples of 8. A table is cut into groups of rows, column after column, that are held in registers while
   columns are added: those with even and those with odd numbers apart, so that a sum does not depend on its group. */
#ifndef ROCKFLEX_MARCH_H
#define ROCKFLEX_MARCH_H

#include <stddef.h>

enum { UNCOUPLED = -1, DENSE = -2 };
enum {
    AHEAD = 4,        /* samples in one product */
    BLOCK = 16,       /* samples that share bounds */
    MAX_STATES = 1000,
    MAX_ROWS = 4096,  /* outputs and conditions */
    MAX_FED = 4,      /* states that a_v multiplies in samples that are not left to power series */
    MAX_NODES = 16
};

typedef struct { /* what a phase has under vertical acceleration; columns y, a, 1, a_v, and a_v times some states */
    int fed, shift;        /* so many states are multiplied by a_v; as of Tables */
    const int *places;     /* theirs */
    const double *now;     /* rates of the other states, conditions; null if a_v does not act in this phase */
    const double *outs;    /* outputs */
    const double *magnitude, *most; /* |now| and |outs| */
    int nodes;             /* in a sample, for the polynomial through each p = a_v y */
    const double *limit;   /* the largest |a_v| of samples for which that is exact; 0 for none */
    const double *times;   /* of the nodes, parts of a sample */
    const double *known;   /* columns y, a0, a1, 1, a_v0, a_v1: change of the states, then y without p at the nodes */
    const double *given;   /* columns p at the nodes: their part of the change */
    const double *feedback; /* the same columns: their part of y at the nodes */
    const double *rows;    /* outputs and conditions */
    const double *speeds;  /* rates of those states */
    const double *slope;   /* columns as all, and then p': rates of the rows, without the parts of a' and a_v' */
    const double *direct;  /* of every row, the factor of a_v */
    const double *moves;   /* as of Tables */
    const double *bend, *sway, *jolt; /* as of Tables, with more columns before the parts: variation of a_v, |a_v'|, of
                                         each p its variation and |p'|, of all |p''|, |p'''| and |p''''| */
    const double *loop;    /* columns: variations of p, which add so much to |y'| of those states */
    const double *swell[4]; /* the same columns as `bend`: |y'|, |y''|, |y'''| and |y''''| of those states */
} Shaken;

typedef struct { /* the vertical acceleration at the start of a power series, and its change */
    double start, rise;
} Climb;

typedef struct {
    int n, outputs, rows; /* states, outputs, outputs and conditions */
    int shift;            /* the first states, whose rates are as many states after them: y'[i] = y[shift + i] */
    int parts;            /* of y', whose magnitudes bound the rows */
    int capped;           /* whether modes are so fast that there are `cap` and `centre` */
    double h;
    const double *block;     /* columns y, a0, a1 .., 1: each row after all of the next samples, then change of the states */
    const double *step;      /* columns y, a0, a1, 1: change of the states in one sample */
    const double *moves;     /* columns y, a, 1: parts of y', amplitudes of modes and what is not parted into them */
    const double *now;       /* columns y, a, 1: rates of the other states, or as `border` says; conditions */
    const double *outs;      /* the same columns: outputs */
    const double *slope;     /* the same columns, 8 rows for each row: its rates at these samples, without the part of a' */
    const double *bend;      /* columns: variation of a, largest |a'|, parts of y': h²/8 |r''| in a block */
    const double *cap;       /* the same columns: distance from the chord due to fast modes */
    const double *centre;    /* as `slope`: what the rows swing about at these samples, within half of that */
    const double *sway;      /* the same columns: h³/96 |r'''| */
    const double *jolt;      /* of conditions, the same columns: h⁴/384 |r''''| */
    const double *direct;    /* of every row, the factor of a */
    const double *magnitude; /* |now| */
    const double *most;      /* |outs| */
    const double *border;    /* a place q, UNCOUPLED, or DENSE. If it is not DENSE, the rates of modes are not in `now`, but
                                y'[s + i] = α y[i] + β y[s + i] + ε z[q] + γ a + δ with z = now · x, i < s = shift; `now`
                                has one row after another; the next 7 numbers say of its first rows which state alone they
                                have, or -1; then follow all α, β, ε, γ and δ, and their magnitudes */
    const double *one_sided; /* 1 for outputs whose largest value counts, 0 where it is the largest magnitude */
    Shaken shaken;
} Tables;

typedef struct {
    double *high, *when;     /* highest value of every output, and the sample at which it was reached */
    double passed;           /* samples before the first of this acceleration */
    double *states;          /* a row for every sample, if a history is kept; otherwise null */
    double *candidates;      /* samples that may have a higher value within: phase, sample, how many samples before it
                                the following y was, y, bound of every output */
    double *seen;            /* rows where the march has begun, or stopped for want of room */
    int resumes;             /* whether it has, or has paused: it goes on from there with the same bits */
    int count, room, width;  /* rows of candidates, at most so many; doubles in a row */
    void *workspace;         /* of `Loops.workspace` bytes for the phase with most rows */
    long long pause;         /* the work from which on it stops where a block begins */
    int looks;               /* whether the march has stopped before a sample in which a condition may fail */
    long long work;          /* samples and expansions so far */
} Log;

typedef struct {
    Tables tables;
    int events, halvings;  /* of the step, so that its power series converge */
    int which;             /* system of the stack whose tables these are */
    const int *halvings_of; /* of every system of the stack */
    ptrdiff_t stride, shaken_stride; /* from the tables of a system to those of the next one */
    const double *scale;   /* of every event */
    const double **jump;   /* of every event, and of the rest after it: a matrix J and |J|; null if the state is continuous */
    const double **rest;   /* of every event: columns y, a, 1; null if nothing can follow instead */
    int *following;        /* of every event, and of the rest after it: place of the phase, or one of the numbers below */
    void **leaps;          /* of every event: its `Jump`; null if it has none */
    void *field;           /* of a phase that is not linear, its `Field`, and what follows; otherwise null */
    int moving, counted;   /* states on which the rates depend, and states that have rates; the others are constant */
    const double *floor;   /* sizes of the moving states below which errors do not matter; infinite for others */
} Phase;
enum { UNKNOWN = -1, ENDS = -2, ASKED = -3 };

typedef struct { /* a step of a phase that is not linear */
    int width;                 /* doubles in a row; those of the states follow one another */
    double *rates;             /* of every stage */
    double *start, *end;       /* the states there */
    double *place;             /* at a further stage */
    double *largest;           /* magnitudes of the moving states so far */
    const double *weights;     /* of the sums before each stage, then of two error estimates and of what bends a step */
    const double *nodes;       /* of the stages, parts of a step */
    double length, a, rise, v, climb; /* s; the accelerations at the start, each with its change */
} Step;

/* y' = F(y, a, a_v), as `Field.rates`. */
typedef void (*Rates)(void *field, const double *y, double a, double a_v, double *out, int counted);

typedef struct { /* a phase of which tables are to be made; of `Tables`, and the step */
    int n, outputs, rows, shift, parts, capped;
    int slow;   /* first parts of y' that are what is not parted into modes, an even number; 0 if there is nothing */
    int inputs; /* a; and with a_v that, and its products with states */
    double h;
} Shape;

enum { TOGETHER = 8 }; /* oscillators that march at once */
/* Rows of their factors: of the changes of u and u' until the next sample, by u, u' and the accelerations at both; ω²;
   2ζω; the largest distance of u' from its chord for u'' up to 1; over 1, the damped frequency; the peaks so far. */
enum { UU, UV, U0, U1, VU, VV, V0, V1, SQUARE, DRAG, SWAY, SPREAD, SD, SV, FACTORS };

typedef struct { /* the loops for one level of vector instructions */
    const char *level;
    int group; /* rows in a group of a table, at most */
    size_t (*workspace)(int rows); /* bytes */
    void (*product)(int columns, int rows, const double *table, const double *x, double *out);
    int (*expand)(const Tables *p, double h, double a, double rise, Climb v, const double *y, int room, int width,
                  double *series);
    void (*evaluate)(int rows, int terms, int width, const double *series, double t, double *out);
    void (*move)(int rows, int terms, int width, const double *series, double t, double *out, double *sizes);
    void (*spread)(int rows, int terms, int width, const double *series, double *out);
    void (*reach)(const Tables *p, Climb v, int terms, int width, const double *series, double *start, double *away);
    void (*complete)(const Tables *p, Climb v, int terms, int width, double *series);
    void (*magnitudes)(const Tables *p, Climb v, int order, const double *before, const double *x, double *out);
    void (*advance)(const Tables *p, const double *a, const double *y, double *next);
    int (*march)(const Tables *p, int phase, const double *a, const double *v, int i, int last, double *y, Log *log);
    double (*attempt)(const Phase *p, const Step *s, Rates rates, int counted);
    void (*look)(const Phase *p, int outputs, Climb v, int k, const double *before, const double *x, double *out);
    void (*within)(const Phase *p, const Step *s, int stage);
    void (*bend)(const Phase *p, const Step *s, Rates rates, int counted, int width, double *series);
    size_t (*room)(const Shape *s); /* doubles */
    double (*turn)(const Shape *s, const double *A, double *memory);
    int (*modes_of)(const Shape *s, const double *A, const double *roots, const double *vectors, double *memory, double *modes);
    int (*amplitudes)(int n, const double *modes, int count);
    void (*bound)(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory,
                  double *moves, double *to);
    int (*prepare)(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory,
                   const ptrdiff_t *places, double *to);
    void (*oscillate)(const double *a, ptrdiff_t first, ptrdiff_t last, double *factors, double *us, double *vs);
    void (*exceed)(const double *a, double h, ptrdiff_t first, ptrdiff_t last, const double *factors, const double *us,
                   const double *vs, ptrdiff_t room, ptrdiff_t *places);
} Loops;

/* Those of the best level that this processor has, or of the named one; null if it has not. */
const Loops *rockflex_loops(const char *level);
#endif
