/* Compiled once for every level of vector instructions; LEVEL names it. See march.h. */
#include "march.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX2__)
#define LANES 4
#else
#define LANES 2
#endif
#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define REGISTERS (GROUP_ROWS / LANES)
#define WIDE (MAX_STATES + MAX_ROWS + GROUP_ROWS)

typedef double vec __attribute__((vector_size(8 * LANES), aligned(8)));
typedef double line __attribute__((vector_size(8 * LANES))); /* at the start of a cache line */
typedef long long mask __attribute__((vector_size(8 * LANES), aligned(8)));

static inline int any(mask m) {
    long long found = 0;
    for (int k = 0; k < LANES; k++) found |= m[k];
    return found != 0;
}
static inline vec at(const double *x) { return *(const vec *)x; }
static inline void put(double *x, vec value) { *(vec *)x = value; }
static inline vec all(double x) { return x + (vec){0}; }
static inline vec chosen(mask m, vec a, vec b) { return (vec)((m & (mask)a) | (~m & (mask)b)); }
static inline vec larger(vec a, vec b) { return chosen(a > b, a, b); }
static inline vec absolute(vec a) { return (vec)((mask)a & 0x7fffffffffffffffLL); }
static inline vec counted(vec a, vec one_sided) { return chosen(one_sided > 0.0, a, absolute(a)); }
static inline int up8(int n) { return (n + 7) / 8 * 8; }

/* out = some columns of a table · x for a group of rows that fills so many registers. */
static inline __attribute__((always_inline)) void group(int registers, int columns, const double *table,
                                                        const double *x, double *out) {
    const line *t = (const line *)table;
    vec sum[REGISTERS] = {0};
    for (int k = 0; k < columns; k++, t += registers)
#pragma GCC unroll 16
        for (int j = 0; j < registers; j++) sum[j] += t[j] * x[k];
    memcpy(out, sum, registers * sizeof *sum);
}

/* out = table · x for the first rows of a table with `total` rows, in whole groups. */
static void product(int columns, int rows, int total, const double *table, const double *x, double *out) {
    for (int g = 0; g < rows; g += GROUP_ROWS) {
        int width = total - g < GROUP_ROWS ? total - g : GROUP_ROWS;
        switch (width / 8) {
        case 1: group(8 / LANES, columns, table, x, out); break;
        case 2: group(16 / LANES, columns, table, x, out); break;
        case 3: group(24 / LANES, columns, table, x, out); break;
        default: group(32 / LANES, columns, table, x, out);
        }
        table += (size_t)columns * width, out += width;
    }
}

/* Power series of states, outputs and conditions over a step h, a row for every term, from the acceleration a that
   changes by `rise`. Returns the number of terms at which it has converged to rounding; 0 if there is no room. */
static int expand(const Tables *p, double h, double a, double rise, const double *y, int room, int width,
                  double *series) {
    const int n = p->n, states = up8(n), rows = states + p->outputs + p->conditions;
    double x[MAX_STATES + 2], z[WIDE], most[MAX_STATES];
    memset(x, 0, sizeof *x * states);
    memcpy(x, y, sizeof *x * n);
    for (int i = 0; i < states; i++) most[i] = fabs(x[i]);
    for (int k = 0, calm = 0; k < room; k++, series += width) {
        memcpy(series, x, sizeof *x * states);
        x[n] = k == 0 ? a : k == 1 ? rise : 0.0, x[n + 1] = k == 0;
        product(n + 2, rows, rows, p->now, x, z);
        memcpy(series + states, z + states, sizeof *z * (rows - states));
        mask moves = {0};
        for (int i = 0; i < states; i += LANES) {
            vec next = at(z + i) * all(h / (k + 1)), top = larger(at(most + i), absolute(next));
            moves |= absolute(next) > top * 1e-17;
            put(x + i, next), put(most + i, top);
        }
        calm = k > 1 && !any(moves) ? calm + 1 : 0;
        if (calm == 2) return k + 1;
    }
    return 0;
}

/* Values of polynomials at t. */
static void evaluate(int rows, int terms, int width, const double *series, double t, double *out) {
    for (int j = 0; j < rows; j += LANES) {
        vec sum = {0};
        for (int k = terms - 1; k >= 0; k--) sum = sum * t + at(series + (size_t)k * width + j);
        put(out + j, sum);
    }
}

/* Sums of the magnitudes of all coefficients but the first. */
static void spread(int rows, int terms, int width, const double *series, double *out) {
    for (int j = 0; j < rows; j += LANES) {
        vec sum = {0};
        for (int k = 1; k < terms; k++) sum += absolute(at(series + (size_t)k * width + j));
        put(out + j, sum);
    }
}

typedef struct { /* bounds that hold for the samples of a block */
    int fine;    /* whether `sway` is known */
    double moves[MAX_STATES + 2], bend[MAX_ROWS + GROUP_ROWS], sway[MAX_ROWS + GROUP_ROWS];
} Block;

static void begin_block(const Tables *p, const double *a, int samples, const double *y, Block *b) {
    const int n = p->n, rows = p->outputs + p->conditions;
    double x[MAX_STATES + 2], rates[WIDE], varies = 0.0, steepest = 0.0;
    for (int k = 0; k < samples; k++) {
        double change = fabs(a[k + 1] - a[k]);
        varies += change;
        steepest = change > steepest ? change : steepest;
    }
    memcpy(x, y, sizeof *x * n);
    x[n] = a[0], x[n + 1] = 1.0;
    product(n + 2, n, up8(n) + rows, p->now, x, rates);
    for (int k = 0; k < n; k++) b->moves[k] = fabs(rates[k]);
    b->moves[n] = varies, b->moves[n + 1] = steepest / p->h;
    product(n + 2, rows, rows, p->bend, b->moves, b->bend);
    b->fine = 0;
}

/* How far a row may get beyond both ends of a sample, between which it changes: h²/8 |r''| is at most `bend`. A parabola
   of that curvature gets furthest; where the change is too large for one, the row is monotonic. */
static inline vec excess(vec change, vec bend) {
    vec turns = larger(4.0 * bend - absolute(change), all(0.0));
    return turns * turns / larger(16.0 * bend, all(1e-300));
}

/* The same by the distance from the chord, from the change of the slope and the third derivative. */
static void refine(const Tables *p, const double *a, const double *y0, const double *y1, Block *b, double *beyond) {
    const int n = p->n, rows = p->outputs + p->conditions;
    double x[MAX_STATES + 2], before[MAX_ROWS + GROUP_ROWS], after[MAX_ROWS + GROUP_ROWS];
    if (!b->fine) product(n + 2, rows, rows, p->sway, b->moves, b->sway);
    b->fine = 1;
    memcpy(x, y0, sizeof *x * n);
    x[n] = a[0], x[n + 1] = 1.0;
    product(n + 2, rows, rows, p->slope, x, before);
    memcpy(x, y1, sizeof *x * n);
    x[n] = a[1];
    product(n + 2, rows, rows, p->slope, x, after);
    for (int j = 0; j < rows; j++) {
        double closer = fabs(after[j] - before[j]) * (p->h / 8.0) + b->sway[j];
        beyond[j] = closer < beyond[j] ? closer : beyond[j];
    }
}

static void raise_peaks(const Tables *p, const double *rows, double sample, Log *log) {
    for (int j = 0; j < p->outputs; j += LANES) {
        vec value = counted(at(rows + j), at(p->one_sided + j)), high = at(log->high + j);
        put(log->when + j, chosen(value > high, all(log->passed + sample), at(log->when + j)));
        put(log->high + j, larger(high, value));
    }
}

/* Advance whole samples from i, up to `last`. Returns the number of the sample at which the motion stands: before the
   first in which a condition may fail, or where a block begins for which there is no room for candidates. Blocks begin
   at multiples of their length, so that what is logged does not change the motion. */
static int march(const Tables *p, int phase, const double *a, int i, int last, double *y, Log *log) {
    const int n = p->n, states = up8(n), m = p->outputs, rows = m + p->conditions;
    double buffers[2][WIDE], x[MAX_STATES + 3], beyond[MAX_ROWS];
    double *old = buffers[0], *new = buffers[1];
    Block block;
    memcpy(x, y, sizeof *x * n);
    x[n] = a[i], x[n + 1] = 1.0;
    if (log->resumes) {
        memcpy(old + states, log->rows, sizeof *x * rows);
    } else {
        product(n + 2, states + rows, states + rows, p->now, x, old);
        raise_peaks(p, old + states, i, log);
    }
    log->looks = log->resumes = 0;
    for (int begins = 1; i < last; i++, begins = i % BLOCK == 0) {
        if (begins) {
            if (log->count + BLOCK > log->room) {
                memcpy(log->rows, old + states, sizeof *x * rows);
                log->resumes = 1;
                break;
            }
            int end = i - i % BLOCK + BLOCK;
            begin_block(p, a + i, (end < last ? end : last) - i, x, &block);
        }
        x[n] = a[i], x[n + 1] = a[i + 1], x[n + 2] = 1.0;
        product(n + 3, states + rows, states + rows, p->step, x, new);
        for (int k = 0; k < n; k++) new[k] += x[k];
        const double *r0 = old + states, *r1 = new + states;
        double *row = log->candidates + (size_t)log->count * log->width, *above = row + 2 + n;
        for (int j = 0; j < rows; j += LANES) put(beyond + j, excess(at(r1 + j) - at(r0 + j), at(block.bend + j)));
        for (int fine = 0;; fine = 1) {
            mask fails = {0}, higher = {0};
            for (int j = m; j < rows; j += LANES)
                fails |= (at(r0 + j) <= at(beyond + j)) | (at(r1 + j) <= at(beyond + j));
            for (int j = 0; j < m; j += LANES) {
                vec side = at(p->one_sided + j), end = counted(at(r1 + j), side);
                vec top = larger(counted(at(r0 + j), side), end) + at(beyond + j);
                put(above + j, top);
                higher |= top > larger(at(log->high + j), end);
            }
            int peaks = any(higher);
            log->looks = any(fails);
            if ((log->looks || peaks) && !fine) {
                refine(p, a + i, x, new, &block, beyond);
                continue;
            }
            if (log->looks) goto out;
            if (peaks) {
                row[0] = phase, row[1] = i;
                memcpy(row + 2, x, sizeof *x * n);
                log->count++;
            }
            break;
        }
        raise_peaks(p, r1, i + 1, log);
        memcpy(x, new, sizeof *x * n);
        if (log->states) memcpy(log->states + (size_t)(i + 1) * n, x, sizeof *x * n);
        double *swap = old;
        old = new, new = swap;
    }
out:
    memcpy(y, x, sizeof *x * n);
    return i;
}

const Loops JOIN(rockflex_loops_, LEVEL) = {TEXT(LEVEL), product, expand, evaluate, spread, march};
