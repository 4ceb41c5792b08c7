/* The loops over vectors: a product of matrix and vector for every sample, and power series.

   Rows come in multiples of 8, and tables in groups of 32 rows or, at the end, fewer, column after column, so that a
   group is held in registers while a column is added: 4 registers of AVX-512, 8 of AVX2, 16 of SSE2 and NEON. */
#ifndef ROCKFLEX_MARCH_H
#define ROCKFLEX_MARCH_H

enum {
    GROUP_ROWS = 32,
    BLOCK = 8,      /* samples that share bounds */
    MAX_STATES = 320,
    MAX_ROWS = 640  /* outputs and conditions */
};

typedef struct {
    int n, outputs, conditions; /* states, outputs, conditions; the latter two in multiples of 8 */
    double h;
    const double *step;      /* columns y, a0, a1, 1: change of the states in a sample; outputs, conditions after it */
    const double *now;       /* columns y, a, 1: rates of the states, outputs, conditions */
    const double *slope;     /* columns y, a, 1: rates of outputs and conditions, without the part of a' */
    const double *bend;      /* columns |y'|, variation of a, largest |a'|: h²/8 |r''| within a block */
    const double *sway;      /* the same columns: h³/96 |r'''| */
    const double *magnitude; /* |now| */
    const double *one_sided; /* 1 for outputs whose largest value counts, 0 where it is the largest magnitude */
} Tables;

typedef struct {
    double *high, *when;     /* highest value of every output, and the sample at which it was reached */
    double passed;           /* samples before the first of this acceleration */
    double *states;          /* a row for every sample, if a history is kept; otherwise null */
    double *candidates;      /* samples that may have a higher value within: phase, sample, y, bound of every output */
    double *rows;            /* outputs and conditions where the march has stopped for want of room */
    int resumes;             /* whether it has: it goes on from there with the same bits */
    int count, room, width;  /* rows of candidates, at most so many; doubles in a row */
    int looks;               /* whether the march has stopped before a sample in which a condition may fail */
} Log;

typedef struct { /* the loops for one level of vector instructions */
    const char *level;
    void (*product)(int columns, int rows, int total, const double *table, const double *x, double *out);
    int (*expand)(const Tables *p, double h, double a, double rise, const double *y, int room, int width, double *series);
    void (*evaluate)(int rows, int terms, int width, const double *series, double t, double *out);
    void (*spread)(int rows, int terms, int width, const double *series, double *out);
    int (*march)(const Tables *p, int phase, const double *a, int i, int last, double *y, Log *log);
} Loops;

/* Those of the best level that this processor has, or of the named one; null if it has not. */
const Loops *rockflex_loops(const char *level);
#endif
