/* Compiled once for every level of vector instructions; LEVEL names it. See march.h. */
#include "march.h"

#include <math.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
#define LANES 8
#define UNITS 8 /* of 8 rows in a group, at most: two sums of a group must leave room in the registers */
#elif defined(__AVX2__)
#define LANES 4
#define UNITS 3
#else
#define LANES 2
#define UNITS 1
#endif
#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define WIDE (MAX_STATES + MAX_ROWS)
#define MORE (2 * MAX_STATES + 3) /* columns of a product under vertical acceleration, at most */

typedef double vec __attribute__((vector_size(8 * LANES), aligned(8)));
typedef double line __attribute__((vector_size(8 * LANES))); /* at the start of a cache line */
typedef long long mask __attribute__((vector_size(8 * LANES), aligned(8)));

/* Whether a lane of a comparison is true. */
static inline int any(mask m) {
#if defined(__AVX512F__)
    return _mm512_test_epi64_mask((__m512i)m, (__m512i)m) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_pd((__m256d)m) != 0;
#elif defined(__SSE2__)
    return _mm_movemask_pd((__m128d)m) != 0;
#else
    return (m[0] | m[1]) != 0;
#endif
}
static inline vec at(const double *x) { return *(const vec *)x; }
static inline void put(double *x, vec value) { *(vec *)x = value; }
static inline vec all(double x) { return x + (vec){0}; }
static inline vec chosen(mask m, vec a, vec b) { return (vec)((m & (mask)a) | (~m & (mask)b)); }
static inline vec larger(vec a, vec b) { return chosen(a > b, a, b); }
static inline vec absolute(vec a) { return (vec)((mask)a & 0x7fffffffffffffffLL); }
static inline int up8(int n) { return (n + 7) / 8 * 8; }

/* out = table · x for a group of rows that fills so many registers. */
static inline __attribute__((always_inline)) void group(int registers, int columns, const double *table,
                                                        const double *x, double *out) {
    const line *t = (const line *)table;
    vec even[UNITS * 8 / LANES] = {0}, odd[UNITS * 8 / LANES] = {0};
    int k = 0;
    for (; k + 1 < columns; k += 2, t += 2 * registers)
#pragma GCC unroll 16
        for (int j = 0; j < registers; j++) {
            even[j] += t[j] * x[k];
            odd[j] += t[registers + j] * x[k + 1];
        }
#pragma GCC unroll 16
    for (int j = 0; j < registers; j++) put(out + j * LANES, (k < columns ? even[j] + t[j] * x[k] : even[j]) + odd[j]);
}

/* out = table · x; groups are of nearly the same size, as in `tables.packed`. */
static void product(int columns, int rows, const double *table, const double *x, double *out) {
    int units = rows / 8, groups = (units + UNITS - 1) / UNITS;
    for (int g = 0; g < groups; g++) {
        int width = units * (g + 1) / groups - units * g / groups;
        switch (width) {
        case 1: group(1 * 8 / LANES, columns, table, x, out); break;
#if UNITS > 1
        case 2: group(2 * 8 / LANES, columns, table, x, out); break;
        case 3: group(3 * 8 / LANES, columns, table, x, out); break;
#endif
#if UNITS > 3
        case 4: group(4 * 8 / LANES, columns, table, x, out); break;
        case 5: group(5 * 8 / LANES, columns, table, x, out); break;
        case 6: group(6 * 8 / LANES, columns, table, x, out); break;
        case 7: group(7 * 8 / LANES, columns, table, x, out); break;
        case 8: group(8 * 8 / LANES, columns, table, x, out); break;
#endif
        }
        table += (size_t)columns * width * 8, out += width * 8;
    }
}

/* to = factor · from; the largest magnitudes are kept. Whether one of them still changes by more than rounding. */
static inline int follow(int count, const double *from, double factor, double *most, double *to) {
    mask moves = {0};
    int i = 0, some;
    for (; i + LANES <= count; i += LANES) {
        vec next = at(from + i) * factor, top = larger(at(most + i), absolute(next));
        moves |= absolute(next) > top * 1e-17;
        put(to + i, next), put(most + i, top);
    }
    some = any(moves);
    for (; i < count; i++) {
        to[i] = from[i] * factor;
        if (fabs(to[i]) > most[i]) most[i] = fabs(to[i]);
        some |= fabs(to[i]) > most[i] * 1e-17;
    }
    return some;
}

static int acts(const Tables *p, Climb v) { return p->shaken.now && (v.start != 0.0 || v.rise != 0.0); }

/* Term k of a series, with the vertical acceleration v and what it multiplies; `before` is the term before. */
static const double *shaken_term(const Tables *p, Climb v, int k, const double *before, const double *x, double *found) {
    const int n = p->n;
    memcpy(found, x, sizeof *x * (n + 2));
    found[n + 2] = k == 0 ? v.start : k == 1 ? v.rise : 0.0;
    for (int j = 0; j < p->shaken.fed; j++) {
        int place = p->shaken.places[j];
        found[n + 3 + j] = v.start * x[place] + (k > 0 ? v.rise * before[place] : 0.0);
    }
    return found;
}

/* Power series of states and conditions over a step h, from the acceleration a that changes by `rise`: a row for every
   term, with states, acceleration, 1 and, from `up8(n + 2)` on, conditions. Returns the number of terms at which it has
   converged to rounding; 0 if there is no room. */
static int expand(const Tables *p, double h, double a, double rise, Climb v, const double *y, int room, int width,
                  double *series) {
    const int shakes = acts(p, v), n = p->n, s = shakes ? p->shaken.shift : p->shift, rates = n - s;
    const int first = up8(n + 2), conditions = p->rows - p->outputs, columns = shakes ? n + 3 + p->shaken.fed : n + 2;
    const double *now = shakes ? p->shaken.now : p->now;
    double z[WIDE], most[2][MAX_STATES], more[MORE], *x = series, *next;
    memset(x, 0, sizeof *x * first);
    memcpy(x, y, sizeof *x * n);
    x[n] = a, x[n + 1] = 1.0;
    for (int i = 0; i < s; i++) most[0][i] = fabs(x[i]);
    for (int i = 0; i < rates; i++) most[1][i] = fabs(x[s + i]);
    for (int k = 0, calm = 0; k < room; k++, x = next) {
        product(columns, up8(rates + conditions), now, shakes ? shaken_term(p, v, k, x - width, x, more) : x, z);
        for (int j = 0; j < conditions; j++) x[first + j] = z[rates + j];
        if (k + 1 == room) break;
        next = x + width;
        int moves = follow(s, x + s, h / (k + 1), most[0], next);
        moves |= follow(rates, z, h / (k + 1), most[1], next + s);
        next[n] = k == 0 ? rise : 0.0;
        for (int i = n + 1; i < first; i++) next[i] = 0.0;
        calm = k > 1 && !moves ? calm + 1 : 0;
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

/* The same of their coefficients' magnitudes. */
static void amounts(int rows, int terms, int width, const double *series, double t, double *out) {
    for (int j = 0; j < rows; j += LANES) {
        vec sum = {0};
        for (int k = terms - 1; k >= 0; k--) sum = sum * t + absolute(at(series + (size_t)k * width + j));
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

/* Outputs at the start of a series, and how far they may get from there. */
static void reach(const Tables *p, Climb v, int terms, int width, const double *series, double *start, double *away) {
    double strays[MORE], more[MORE];
    if (acts(p, v)) {
        const int columns = p->n + 3 + p->shaken.fed;
        memset(strays, 0, sizeof strays);
        product(columns, up8(p->outputs), p->shaken.outs, shaken_term(p, v, 0, 0, series, more), start);
        for (int k = 1; k < terms; k++) {
            series += width, shaken_term(p, v, k, series - width, series, more);
            for (int j = 0; j < columns; j++) strays[j] += fabs(more[j]);
        }
        product(columns, up8(p->outputs), p->shaken.most, strays, away);
        return;
    }
    product(p->n + 2, up8(p->outputs), p->outs, series, start);
    spread(up8(p->n + 2), terms, width, series, strays);
    product(p->n + 2, up8(p->outputs), p->most, strays, away);
}

/* The series of the outputs, after those of states and conditions. */
static void complete(const Tables *p, Climb v, int terms, int width, double *series) {
    const int first = up8(p->n + 2) + up8(p->rows - p->outputs), shakes = acts(p, v);
    const int columns = shakes ? p->n + 3 + p->shaken.fed : p->n + 2;
    const double *outs = shakes ? p->shaken.outs : p->outs;
    double more[MORE];
    for (int k = 0; k < terms; k++, series += width) {
        const double *x = shakes ? shaken_term(p, v, k, series - width, series, more) : series;
        product(columns, up8(p->outputs), outs, x, series + first);
    }
}

/* The sums of the magnitudes that rates and conditions of an order are summed from, from those of the term x. */
static void magnitudes(const Tables *p, Climb v, int order, const double *before, const double *x, double *out) {
    const int shakes = acts(p, v), rows = up8(p->n - (shakes ? p->shaken.shift : p->shift) + p->rows - p->outputs);
    double more[MORE];
    if (shakes) {
        Climb most = {fabs(v.start), fabs(v.rise)};
        product(p->n + 3 + p->shaken.fed, rows, p->shaken.magnitude, shaken_term(p, most, order, before, x, more), out);
    } else {
        product(p->n + 2, rows, p->magnitude, x, out);
    }
}

typedef struct { /* what is known of every row, once for each sample of a product, one sample after another */
    int flat;      /* of them, to a multiple of 8 */
    unsigned char *sample;      /* the sample of each */
    mask *flip, *keep;          /* a value counts as (value ^ flip) & keep */
    double *limit;              /* the peak, or 0, which a condition must not pass */
    double *bend4, *over, *cap; /* in this block: 4 b and 1/16 b with b = h²/8 |r''|, and the cap */
    double *quiet;              /* what counts may be so high at the ends of a sample, whatever is between */
} Watch;

typedef struct { /* bounds that hold for the samples of a block */
    int fine;    /* whether `sway` and `jolt` are known */
    int shakes;  /* whether a_v acts: the bounds of `shaken` hold */
    double *moves, *bend, *sway, *jolt;
} Block;

enum { LINE = 8 }; /* doubles in a line of the cache */

/* Some of the room. Arrays lie close together, and do not begin at the same place of a page, so that all fit in the cache. */
static double *taken(double **from, int count) {
    double *found = *from;
    *from += up8(count) + LINE;
    return found;
}

static void begin_watch(const Tables *p, const Log *log, Watch *w, double **arena) {
    const int m = p->outputs, rows = p->rows, flat = up8(AHEAD * rows);
    w->flat = flat, w->sample = (unsigned char *)taken(arena, flat / 8);
    w->flip = (mask *)taken(arena, flat), w->keep = (mask *)taken(arena, flat), w->limit = taken(arena, flat);
    w->quiet = taken(arena, flat), w->bend4 = taken(arena, flat), w->over = taken(arena, flat), w->cap = taken(arena, flat);
    long long *flip = (long long *)w->flip, *keep = (long long *)w->keep;
    for (int k = 0, f = 0; k < AHEAD; k++)
        for (int j = 0; j < rows; j++, f++) {
            flip[f] = j < m ? 0 : (long long)(1ULL << 63);
            keep[f] = j < m && !(p->one_sided[j] > 0.0) ? 0x7fffffffffffffffLL : -1;
            w->limit[f] = j < m ? log->high[j] : -1e-300, w->sample[f] = k;
        }
    for (int f = AHEAD * rows; f < flat; f++) {
        flip[f] = keep[f] = 0, w->sample[f] = 0;
        w->limit[f] = INFINITY, w->bend4[f] = w->over[f] = w->cap[f] = 0.0;
    }
}

static inline double counted(const Watch *w, int f, double value) {
    union {
        double value;
        long long bits;
    } x = {value};
    x.bits = (x.bits ^ ((const long long *)w->flip)[f]) & ((const long long *)w->keep)[f];
    return x.value;
}

/* How much an input varies in some samples, and its largest slope. */
static void vary(const double *a, int samples, double h, double *found) {
    double varies = 0.0, steepest = 0.0;
    for (int k = 0; k < samples; k++) {
        double change = fabs(a[k + 1] - a[k]);
        varies += change;
        steepest = change > steepest ? change : steepest;
    }
    found[0] = varies, found[1] = steepest / h;
}

typedef struct { /* of rows, one sample after another */
    double *lowest, *highest, *slopes, *centres, *sway;
    double *ends; /* slopes at the ends of the samples; where a_v acts they are not those at the start of the next one */
} Bounds;

typedef double States[AHEAD + 1][MAX_STATES]; /* at the samples of a product */

#include "shaken.h"

/* Returns the number of samples that the bounds hold for: BLOCK, or AHEAD. */
static int begin_block(const Tables *p, const double *a, const double *v, int samples, const double *y, Block *b, Watch *w) {
    const int n = p->n, rows = p->rows, parts = p->parts;
    double x[MORE], found[2 * MAX_STATES], more[MORE];
    const Climb climb = {v ? v[0] : 0.0, 0.0};
    b->shakes = v && marches_shaken(p) && any_rise(v, samples);
    memcpy(x, y, sizeof *x * n);
    x[n] = a[0], x[n + 1] = 1.0;
    if (b->shakes)
        product(n + 3 + p->shaken.fed, up8(parts), p->shaken.moves, shaken_term(p, climb, 0, 0, x, more), found);
    else
        product(n + 2, up8(parts), p->moves, x, found);
    for (int k = 0; k < n; k++) b->moves[k] = fabs(found[k]);
    for (int k = n; k < parts; k++) b->moves[k + 2] = fabs(found[k]);
    vary(a, samples, p->h, b->moves + n);
    int length = BLOCK;
    if (b->shakes) {
        if (!vary_shaken(p, v, samples, y, b->moves)) {
            length = AHEAD, samples = samples < AHEAD ? samples : AHEAD;
            vary(a, samples, p->h, b->moves + n);
            vary_shaken(p, v, samples, y, b->moves);
        }
        product(shaken_columns(p), up8(rows), p->shaken.bend, b->moves, b->bend);
    } else {
        product(parts + 2, up8(rows), p->bend, b->moves, b->bend);
    }
    memset(w->cap, 0, sizeof *w->cap * rows);
    if (parts > n) product(parts + 2, up8(rows), p->cap, b->moves, w->cap);
    b->fine = 0;
    for (int j = 0; j < rows; j++) {
        const double bend = b->bend[j] < 1e300 ? b->bend[j] : 1e300; /* products of vague bounds may not be numbers */
        w->bend4[j] = 4.0 * bend, w->over[j] = 1.0 / (16.0 * bend + 1e-305);
    }
    for (int k = 1; k < AHEAD; k++) {
        memcpy(w->bend4 + k * rows, w->bend4, sizeof *w->bend4 * rows);
        memcpy(w->over + k * rows, w->over, sizeof *w->over * rows);
        memcpy(w->cap + k * rows, w->cap, sizeof *w->cap * rows);
    }
    return length;
}

/* How far a row may get beyond both ends of a sample, between which it changes: h²/8 |r''| is at most `bend`. A parabola
   of that curvature gets furthest; where the change is too large for one, the row is monotonic. */
static inline vec excess(vec change, vec bend4, vec over) {
    vec turns = larger(bend4 - absolute(change), all(0.0));
    return turns * (turns * over); /* squares of forces in any unit might overflow, or vanish */
}

/* What counts of some rows. */
static inline vec counts(const Watch *w, int f, vec row) {
    return (vec)(((mask)row ^ w->flip[f / LANES]) & w->keep[f / LANES]);
}

/* After a change of limits or bounds. */
static void begin_quiet(Watch *w) {
    for (int f = 0; f < w->flat; f += LANES)
        put(w->quiet + f, at(w->limit + f) - 0.25000001 * at(w->bend4 + f) - at(w->cap + f));
}

/* Whether some rows are too high at the ends of samples for them to be passed over. */
static int quiet(const Watch *w, const double *rows) {
    mask some = {0};
    for (int f = 0; f < w->flat; f += LANES) some |= counts(w, f, at(rows + f)) > at(w->quiet + f);
    return !any(some);
}

/* Whether any sample of a product asks for a closer look. */
static int asks(const Watch *w, const double *before, const double *after) {
    mask some = {0};
    for (int f = 0; f < w->flat; f += LANES) {
        vec r0 = at(before + f), r1 = at(after + f);
        vec beyond = excess(r1 - r0, at(w->bend4 + f), at(w->over + f)) + at(w->cap + f);
        some |= larger(counts(w, f, r0), counts(w, f, r1)) + beyond > at(w->limit + f);
    }
    return any(some);
}

typedef struct { /* samples of a product, a bit for each */
    unsigned at_end, within, fails; /* in which a peak is at the end, may be within, and in which a condition may fail */
} Asking;

/* A lower bound of a row r0 + change t + t (1 - t) ((1 - t) first - t last) for t from 0 to 1, which `away` may take off. */
static double lowest_of(double r0, double change, double first, double last, double away) {
    double b = change + first, c = -2.0 * first - last, d = first + last, least = change < 0.0 ? r0 + change : r0;
    double root = c * c - 3.0 * b * d, unit = 1.0;
    if (!(fabs(root) > 1e-240 && fabs(root) < 1e280)) { /* squares that vanish or overflow */
        const int size = ilogb(fabs(b) + fabs(c) + fabs(d) + 1e-305);
        unit = ldexp(1.0, size > -1000 ? -size : 1000); /* a power of two, which changes no bit of a place */
        root = (unit * c) * (unit * c) - 3.0 * (unit * b) * (unit * d);
    }
    if (root > 0.0) {
        double q = -unit * c - (c > 0.0 ? sqrt(root) : -sqrt(root)); /* below: where it is level */
        double at[2] = {q / (3.0 * unit * d), unit * b / q};
        for (int k = 0; k < 2; k++)
            if (at[k] > 0.0 && at[k] < 1.0) {
                double value = r0 + at[k] * (b + at[k] * (c + at[k] * d));
                if (value < least) least = value;
            }
    }
    return least - away;
}

/* Whether the condition of a row may fail: it stays near the cubic through both ends of a sample, and their slopes. */
static int may_fail(const Tables *p, const double *ground, const double *rise, int sample, double r0, double r1, double s0, double s1,
                    int row, const Block *b) {
    double change = r1 - r0, chord = change - p->direct[row] * (ground[sample + 1] - ground[sample]);
    if (rise) chord -= p->shaken.direct[row] * (rise[sample + 1] - rise[sample]);
    return !(lowest_of(r0, change, p->h * s0 - chord, p->h * s1 - chord, b->jolt[row - p->outputs]) > 0.0);
}

/* Closer bounds of the rows in every sample of a product, and the samples that still ask. A row stays
   near its chord by the change of its slope and its third derivative, or near what fast modes swing about. The slopes are
   known where a_v acts, as `rise`. */
static Asking asking(const Tables *p, const double *ground, const double *rise, const double *x, const double *before,
                     const double *after, Block *b, const Watch *w, Bounds *bounds) {
    const int rows = p->rows, columns = p->n + AHEAD + 2, whole = up8((AHEAD + 1) * rows);
    const int parted = !b->shakes && p->parts > p->n; /* otherwise the amplitudes of fast modes are not known */
    double *slopes = bounds->slopes, *centres = bounds->centres, *sway = bounds->sway;
    const double *ends = rise ? bounds->ends : slopes + rows;
    Asking found = {0};
    if (!b->fine && b->shakes) {
        product(shaken_columns(p), up8(rows), p->shaken.sway, b->moves, b->sway);
        product(shaken_columns(p), up8(rows - p->outputs), p->shaken.jolt, b->moves, b->jolt);
    } else if (!b->fine) {
        product(p->parts + 2, up8(rows), p->sway, b->moves, b->sway);
        product(p->parts + 2, up8(rows - p->outputs), p->jolt, b->moves, b->jolt);
    }
    b->fine = 1;
    for (int k = 0; k < AHEAD; k++) memcpy(sway + k * rows, b->sway, sizeof *sway * rows);
    for (int f = AHEAD * rows; f < w->flat; f++) sway[f] = 0.0;
    if (!rise) product(columns, whole, p->slope, x, slopes);
    if (parted) product(columns, whole, p->centre, x, centres);
    for (int f = 0; f < w->flat; f += LANES) {
        vec r0 = at(before + f), r1 = at(after + f), s0 = at(slopes + f), s1 = at(ends + f);
        vec beyond = excess(r1 - r0, at(w->bend4 + f), at(w->over + f)) + at(w->cap + f);
        vec closer = absolute(s1 - s0) * (p->h / 8.0) + at(sway + f);
        beyond = chosen(closer < beyond, closer, beyond);
        vec low = -larger(-r0, -r1) - beyond, high = larger(r0, r1) + beyond;
        if (parted) {
            vec c0 = at(centres + f), c1 = at(centres + rows + f), away = 0.5 * at(w->cap + f) + 0.25 * at(w->bend4 + f);
            low = larger(low, -larger(-c0, -c1) - away), high = -larger(-high, -larger(c0, c1) - away);
        }
        put(bounds->lowest + f, low), put(bounds->highest + f, high);
        vec limit = at(w->limit + f), end = counts(w, f, r1), top = larger(counts(w, f, low), counts(w, f, high));
        mask above = top > limit, within = top > larger(limit, end), condition = w->flip[f / LANES] < 0;
        if (any(above))
            for (int k = 0; k < LANES; k++) {
                if (above[k] && !(condition[k] && !may_fail(p, ground, rise, w->sample[f + k], r0[k], r1[k], s0[k], s1[k],
                                                            (f + k) % rows, b)))
                    *(condition[k] ? &found.fails : within[k] ? &found.within : &found.at_end) |= 1u << w->sample[f + k];
            }
    }
    return found;
}

/* The state a sample later. */
static void advance(const Tables *p, const double *a, const double *y, double *next) {
    const int n = p->n;
    double x[MAX_STATES + 3], z[MAX_STATES];
    memcpy(x, y, sizeof *x * n);
    x[n] = a[0], x[n + 1] = a[1], x[n + 2] = 1.0;
    product(n + 3, up8(n), p->step, x, z);
    for (int k = 0; k < n; k++) next[k] = z[k] + y[k];
}

/* Raise the peaks to the outputs at a sample. */
static inline void raise_peaks(const Tables *p, const double *rows, double sample, const Watch *w, Log *log) {
    for (int j = 0; j < p->outputs; j += LANES) {
        vec value = counts(w, j, at(rows + j)), high = at(log->high + j);
        put(log->when + j, chosen(value > high, all(log->passed + sample), at(log->when + j)));
        put(log->high + j, larger(high, value));
    }
}

enum { MOVES = 2 * MAX_STATES + 4 + 5 * MAX_FED };

typedef struct { /* room for one march; on the stack of a thread it might be too large */
    States states;
    double arena[];
} Workspace;

/* The memory of what `march` takes, at most, in phases of so many rows. */
static size_t workspace(int rows) {
    return sizeof(Workspace) + (15 * up8(AHEAD * rows) + 8 * up8(rows) + MAX_STATES + MOVES + 32 * LINE) * sizeof(double);
}

/* Look at the samples of a product that ask for it, whose rows have these bounds. Returns how many there are before the
   first in which a condition may fail. */
static int inspect(const Tables *p, int phase, const double *a, int i, int samples, Asking asking, const double *rows,
                   const Bounds *bounds, States y, int *known, Watch *w, Log *log) {
    const int n = p->n, m = p->outputs, count = p->rows;
    const double *lowest = bounds->lowest, *highest = bounds->highest;
    int k = 0;
    for (; k < samples; k++, rows += count, lowest += count, highest += count) {
        const double *r1 = rows + count;
        if (!((asking.at_end | asking.within | asking.fails) >> k & 1)) continue;
        double *row = log->candidates + (size_t)log->count * log->width, *above = row + 2 + n;
        int fails = asking.fails >> k & 1, higher = 0;
        if (asking.within >> k & 1)
            for (int j = 0; j < m; j++) {
                double end = counted(w, j, r1[j]), high = log->high[j], low = counted(w, j, lowest[j]);
                above[j] = counted(w, j, highest[j]);
                above[j] = low > above[j] ? low : above[j];
                higher |= above[j] > (high > end ? high : end);
            }
        if (fails || higher)
            for (; *known < k; ++*known) advance(p, a + *known, y[*known], y[*known + 1]);
        if (fails) {
            log->looks = 1;
            break;
        }
        if (higher) {
            row[0] = phase, row[1] = i + k;
            memcpy(row + 2, y[k], sizeof **y * n);
            log->count++;
        }
        raise_peaks(p, r1, i + k + 1, w, log);
    }
    for (int j = 0; j < AHEAD; j++) memcpy(w->limit + j * count, log->high, sizeof *log->high * m);
    return k;
}

/* Advance whole samples from i, up to `last`. Returns the number of the sample at which the motion stands: before the
   first in which a condition may fail, or where a block begins for which there is no room for candidates, or after so much
   work that the run looks up. What is logged does not change the motion. */
static int march(const Tables *p, int phase, const double *a, const double *v, int i, int last, double *y, Log *log) {
    const int n = p->n, states = up8(n), rows = p->rows, flat = up8(AHEAD * rows);
    Workspace *room = log->workspace;
    double *arena = room->arena;
    double x[MAX_STATES + AHEAD + 2], padded[AHEAD + 1], lifted[AHEAD + 1];
    double *after = taken(&arena, up8(rows) + flat + states) + up8(rows), *before = after - rows, *change = after + flat;
    Watch seen = {0}, *watch = &seen;
    Block block = {0};
    Bounds bounds;
    double(*at_samples)[MAX_STATES] = room->states;
    block.moves = taken(&arena, MOVES), block.bend = taken(&arena, rows), block.sway = taken(&arena, rows);
    block.jolt = taken(&arena, rows);
    bounds.lowest = taken(&arena, flat), bounds.highest = taken(&arena, flat), bounds.sway = taken(&arena, flat);
    bounds.slopes = taken(&arena, flat + up8(rows)), bounds.centres = taken(&arena, flat + up8(rows));
    bounds.ends = taken(&arena, flat + up8(rows));
    begin_watch(p, log, watch, &arena);
    memcpy(x, y, sizeof *x * n);
    if (log->resumes) {
        memcpy(before, log->seen, sizeof *x * rows);
    } else {
        x[n] = a[i], x[n + 1] = 1.0;
        rows_at(p, x, v ? v[i] : 0.0, after, before);
        raise_peaks(p, before, i, watch, log);
    }
    log->looks = log->resumes = 0;
    for (int left = 0, calm = 0, fresh = 0; i < last && !log->looks; left -= AHEAD) {
        if (left == 0) {
            if (log->count + BLOCK > log->room || log->work >= log->pause) {
                memcpy(log->seen, before, sizeof *x * rows);
                log->resumes = 1;
                break;
            }
            left = begin_block(p, a + i, v ? v + i : 0, last - i < BLOCK ? last - i : BLOCK, x, &block, watch);
            begin_quiet(watch);
            fresh = 1;
        }
        int samples = last - i < AHEAD ? last - i : AHEAD, known = 0; /* samples after which the state is known */
        const double *ground = a + i, *rise = v && p->shaken.now && any_rise(v + i, samples) ? v + i : 0;
        if (samples < AHEAD) {
            for (int k = 0; k <= AHEAD; k++) padded[k] = a[k < samples ? i + k : last];
            for (int k = 0; rise && k <= AHEAD; k++) lifted[k] = v[k < samples ? i + k : last];
            ground = padded, rise = rise ? lifted : 0;
        }
        if (rise) {
            memcpy(at_samples[0], x, sizeof *x * n);
            known = go_shaken(p, ground, rise, samples, at_samples, before, after);
        } else {
            for (int k = 0; k <= AHEAD; k++) x[n + k] = ground[k];
            x[n + AHEAD + 1] = 1.0;
            product(n + AHEAD + 2, flat + states, p->block, x, after);
        }
        const int left_over = rise && known < samples; /* to a power series */
        int passed = samples;
        int was_calm = fresh ? quiet(watch, before) : calm;
        fresh = 0;
        calm = quiet(watch, after);
        int look = left_over || (!(was_calm && calm) && asks(watch, before, after));
        if (log->states || samples < AHEAD || look) {
            memcpy(at_samples[0], x, sizeof *x * n);
            if (look) {
                if (rise) slopes_shaken(p, ground, rise, known, at_samples, &bounds);
                Asking which = asking(p, ground, rise, x, before, after, &block, watch, &bounds);
                if (left_over) which.fails |= 1u << known;
                passed = inspect(p, phase, ground, i, samples, which, before, &bounds, at_samples, &known, watch, log);
                begin_quiet(watch);
            }
            if (log->states || passed < AHEAD)
                for (; known < passed; known++) advance(p, ground + known, at_samples[known], at_samples[known + 1]);
            if (log->states) /* the last one may yet be replaced */
                for (int k = 1; k <= passed; k++) memcpy(log->states + (size_t)(i + k) * n, at_samples[k], sizeof *x * n);
        }
        if (passed == AHEAD && !rise) {
            for (int k = 0; k < n; k++) x[k] += change[k];
            if (log->states) memcpy(log->states + (size_t)(i + passed) * n, x, sizeof *x * n);
        } else {
            memcpy(x, at_samples[passed], sizeof *x * n);
        }
        if (passed) memcpy(before, before + passed * rows, sizeof *x * rows);
        i += passed;
        log->work += passed;
    }
    memcpy(y, x, sizeof *x * n);
    return i;
}

#include "steps.h"
#include "prepare.h"

const Loops JOIN(rockflex_loops_, LEVEL) = {TEXT(LEVEL), UNITS * 8, workspace, product, expand, evaluate, amounts, spread,
                                            reach, complete, magnitudes, march, attempt, look, within, bend,
                                            room, turn, fast_modes, prepare};
