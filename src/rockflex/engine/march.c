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

/* So many units of 8 rows are in the first group of those that are left; the last two groups are of nearly the same size. */
static inline int units_of(int left) { return left <= UNITS ? left : left < 2 * UNITS ? (left + 1) / 2 : UNITS; }

/* out = table · x. */
static void product(int columns, int rows, const double *table, const double *x, double *out) {
    for (int left = rows / 8, width; left > 0; left -= width) {
        width = units_of(left);
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

/* to = factor · from, for `count` numbers and what fills the last register; the largest magnitudes are kept. Whether one of
   the numbers still changes by more than rounding: not by what is beside them, since no count of terms may depend on it. */
static inline int follow(int count, const double *from, double factor, double *most, double *to) {
    static const long long counted[16] = {-1, -1, -1, -1, -1, -1, -1, -1};
    mask moves = {0};
    for (int i = 0; i < count; i += LANES) {
        vec next = at(from + i) * factor, top = larger(at(most + i), absolute(next));
        const int left = count - i < LANES ? count - i : LANES;
        moves |= (absolute(next) > top * 1e-17) & *(const mask *)(counted + 8 - left);
        put(to + i, next), put(most + i, top);
    }
    return any(moves);
}

/* Σ row[i] x[i], for a multiple of 8. */
static inline double dot(int count, const double *row, const double *x) {
    vec even = {0}, odd = {0};
    for (int i = 0; i < count; i += 2 * LANES)
        even += at(row + i) * at(x + i), odd += i + LANES < count ? at(row + i + LANES) * at(x + i + LANES) : (vec){0};
    even += odd;
    double total = even[0];
    for (int i = 1; i < LANES; i++) total += even[i];
    return total;
}

/* The rates of the states from `shift` on, and the conditions, of x with y, a, 1 and zeros up to a multiple of 8; or of
   magnitudes, with the magnitudes of all factors. */
static void rates_of(const Tables *p, int magnitudes, const double *x, double *z) {
    const int n = p->n, s = p->shift, count = n - s + p->rows - p->outputs, q = *p->border, wide = up8(n + 2), size = up8(s);
    const double *now = magnitudes ? p->magnitude : p->now, *terms = p->border + 8 + (magnitudes ? 5 * size : 0);
    if (q == DENSE) {
        product(n + 2, up8(count), now, x, z);
        return;
    }
    const int pushed = x[n] != 0.0 || x[n + 1] != 0.0;
    double found[MAX_ROWS];
    for (int i = 0; i < count - s; i++) {
        const double *row = now + (size_t)i * wide;
        const int sole = i < 7 ? (int)p->border[1 + i] : -1;
        found[i] = sole < 0 ? dot(wide, row, x) : row[sole] * x[sole] + (pushed ? row[n] * x[n] + row[n + 1] * x[n + 1] : 0.0);
    }
    const double coupled = q == UNCOUPLED ? 0.0 : found[q];
    for (int i = 0; i < s; i += LANES, terms += LANES) {
        vec sum = at(terms) * at(x + i) + at(terms + size) * at(x + s + i) + at(terms + 2 * size) * coupled;
        if (pushed) sum += at(terms + 3 * size) * x[n] + at(terms + 4 * size) * x[n + 1];
        put(z + i, sum);
    }
    for (int i = 0; i < count - s; i++) z[s + i] = found[i];
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
    const int first = up8(n + 2), conditions = p->rows - p->outputs;
    double z[WIDE + 8], most[2][MAX_STATES + 8], more[MORE], *x = series, *next;
    memset(x, 0, sizeof *x * first);
    memcpy(x, y, sizeof *x * n);
    x[n] = a, x[n + 1] = 1.0;
    for (int i = 0; i < s; i += LANES) put(most[0] + i, absolute(at(x + i)));
    for (int i = 0; i < rates; i += LANES) put(most[1] + i, absolute(at(x + s + i)));
    for (int k = 0, calm = 0; k < room; k++, x = next) {
        if (shakes)
            product(n + 3 + p->shaken.fed, up8(rates + conditions), p->shaken.now, shaken_term(p, v, k, x - width, x, more), z);
        else
            rates_of(p, 0, x, z);
        for (int j = 0; j < conditions; j++) x[first + j] = z[rates + j];
        if (k + 1 == room) break;
        next = x + width;
        const double factor = h / (k + 1);
        int moves = follow(s, x + s, factor, most[0], next);
        moves |= follow(rates, z, factor, most[1], next + s);
        for (int i = n; i < first; i++) next[i] = 0.0;
        if (k == 0) next[n] = rise;
        calm = k > 1 && !moves ? calm + 1 : 0;
        if (calm == 2) return k;
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

/* The same, and of their coefficients' magnitudes. */
static void move(int rows, int terms, int width, const double *series, double t, double *out, double *sizes) {
    for (int j = 0; j < rows; j += LANES) {
        vec sum = {0}, size = {0};
        for (int k = terms - 1; k >= 0; k--) {
            const vec here = at(series + (size_t)k * width + j);
            sum = sum * t + here, size = size * t + absolute(here);
        }
        put(out + j, sum), put(sizes + j, size);
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
    double more[MORE];
    if (acts(p, v)) {
        const Climb most = {fabs(v.start), fabs(v.rise)};
        const int rows = up8(p->n - p->shaken.shift + p->rows - p->outputs);
        product(p->n + 3 + p->shaken.fed, rows, p->shaken.magnitude, shaken_term(p, most, order, before, x, more), out);
    } else {
        rates_of(p, 1, x, out);
    }
}

typedef double quad __attribute__((vector_size(8 * AHEAD), aligned(8))); /* of a row, at the samples of a product */
typedef long long quadmask __attribute__((vector_size(8 * AHEAD), aligned(8)));

static inline quad quad_at(const double *x) { return *(const quad *)x; }
static inline void quad_put(double *x, quad value) { *(quad *)x = value; }
static inline quad quad_all(double x) { return x + (quad){0}; }
static inline quad quad_chosen(quadmask m, quad a, quad b) { return (quad)((m & (quadmask)a) | (~m & (quadmask)b)); }
static inline quad quad_larger(quad a, quad b) { return quad_chosen(a > b, a, b); }
static inline quad quad_absolute(quad a) { return (quad)((quadmask)a & 0x7fffffffffffffffLL); }

/* The samples in which a comparison is true, a bit for each. */
static inline unsigned bits(quadmask m) {
#if defined(__AVX2__)
    return _mm256_movemask_pd((__m256d)m);
#elif defined(__SSE2__)
    union {
        quadmask all;
        __m128d half[2];
    } x = {m};
    return _mm_movemask_pd(x.half[0]) | _mm_movemask_pd(x.half[1]) << 2;
#else
    return (m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8);
#endif
}

typedef struct { /* of every row; arrays of quads have it once for each sample of a product */
    double *low, *high;         /* a condition must not pass 0, nor an output unnoticed its peak */
    double *bend, *cap, *sway, *jolt; /* in this block: h²/8 |r''|, and as of Tables; `jolt` of conditions alone */
    double *calm_low, *calm_high;     /* quads: between these at the ends of a sample, a row is so within it */
    int fine;                   /* whether `sway` and `jolt` are known */
    int shakes;                 /* whether a_v acts: the bounds of `shaken` hold */
    double *moves;              /* what bounds are products with */
} Watch;

typedef struct { /* what is found in the samples of a product; samples have a bit each */
    unsigned at_end, within, fails; /* in which a peak is at the end, may be within, and in which a condition may fail */
    int count, *rows;       /* rows that ask */
    double *top;            /* quads: how high each of these may get, if it is an output */
    double *slopes, *ends;  /* where a_v acts, of all rows at the ends of each sample, without the parts of a' and a_v' */
} Asking;

enum { LINE = 8, MOVES = 2 * MAX_STATES + 4 + 5 * MAX_FED }; /* LINE: doubles in a line of the cache */

typedef double States[AHEAD + 1][MAX_STATES]; /* at the samples of a product */

typedef struct { /* room for one march; on the stack of a thread it might be too large */
    States states;
    double arena[];
} Workspace;

/* The memory of what `march` takes, at most, in phases of so many rows. */
static size_t workspace(int rows) {
    return sizeof(Workspace) + (7 * up8(AHEAD * rows) + 8 * up8(rows) + 2 * MAX_STATES + MOVES + 24 * LINE) * sizeof(double);
}

/* Some of the room. Arrays lie close together, and do not begin at the same place of a page, so that all fit in the cache. */
static double *taken(double **from, int count) {
    double *found = *from;
    *from += up8(count) + LINE;
    return found;
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

#include "shaken.h"

/* After a change of limits or bounds. */
static void set_calm(int rows, Watch *w) {
    for (int j = 0; j < rows; j++) {
        const double margin = 1.00000001 * w->bend[j] + w->cap[j];
        quad_put(w->calm_low + AHEAD * j, quad_all(w->low[j] + margin));
        quad_put(w->calm_high + AHEAD * j, quad_all(w->high[j] - margin));
    }
}

/* Take the peaks as limits of the outputs. */
static void set_limits(const Tables *p, const Log *log, Watch *w) {
    for (int j = 0; j < p->outputs; j++)
        w->high[j] = log->high[j], w->low[j] = p->one_sided[j] > 0.0 ? -INFINITY : -log->high[j];
}

/* Returns the number of samples that the bounds hold for: BLOCK, or AHEAD. */
static int begin_block(const Tables *p, const double *a, const double *v, int samples, const double *y, Watch *w) {
    const int n = p->n, rows = p->rows, parts = p->parts;
    double x[MORE], found[2 * MAX_STATES], more[MORE];
    const Climb climb = {v ? v[0] : 0.0, 0.0};
    w->shakes = v && marches_shaken(p) && any_rise(v, samples);
    memcpy(x, y, sizeof *x * n);
    x[n] = a[0], x[n + 1] = 1.0;
    if (w->shakes)
        product(n + 3 + p->shaken.fed, up8(parts), p->shaken.moves, shaken_term(p, climb, 0, 0, x, more), found);
    else
        product(n + 2, up8(parts), p->moves, x, found);
    for (int k = 0, first = w->shakes ? shaken_columns(p) - parts : 2; k < parts; k++) w->moves[first + k] = fabs(found[k]);
    vary(a, samples, p->h, w->moves);
    int length = BLOCK;
    if (w->shakes) {
        if (!vary_shaken(p, v, samples, y, w->moves)) {
            length = AHEAD, samples = samples < AHEAD ? samples : AHEAD;
            vary(a, samples, p->h, w->moves);
            vary_shaken(p, v, samples, y, w->moves);
        }
        product(shaken_columns(p), up8(rows), p->shaken.bend, w->moves, w->bend);
    } else {
        product(parts + 2, up8(rows), p->bend, w->moves, w->bend);
    }
    for (int j = 0; j < rows; j += LANES) /* products of vague bounds may not be numbers */
        put(w->bend + j, chosen(at(w->bend + j) < all(1e300), at(w->bend + j), all(1e300)));
    if (p->capped && !w->shakes) product(parts + 2, up8(rows), p->cap, w->moves, w->cap);
    else memset(w->cap, 0, sizeof *w->cap * rows);
    w->fine = 0;
    set_calm(rows, w);
    return length;
}

/* Whether all rows are so far from their limits that nothing can happen between samples such as these. */
static int calm(int rows, const double *values, const Watch *w) {
    quadmask some = {0};
    for (int f = 0; f < AHEAD * rows; f += AHEAD)
        some |= (quad_at(values + f) > quad_at(w->calm_high + f)) | (quad_at(values + f) < quad_at(w->calm_low + f));
    return !bits(some);
}

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

/* The samples in which the condition of a row may fail, of those asked for: it stays near the cubic through both ends of a
   sample, and their slopes. */
static unsigned failing(const Tables *p, const double *ground, const double *rise, int row, quad r0, quad r1, quad s0, quad s1,
                        unsigned asked, double jolt) {
    for (int k = 0; k < AHEAD; k++) {
        double change = r1[k] - r0[k], chord = change - p->direct[row] * (ground[k + 1] - ground[k]);
        if (!(asked >> k & 1)) continue;
        if (rise) chord -= p->shaken.direct[row] * (rise[k + 1] - rise[k]);
        if (lowest_of(r0[k], change, p->h * s0[k] - chord, p->h * s1[k] - chord, jolt) > 0.0) asked &= ~(1u << k);
    }
    return asked;
}

/* The slopes of a row, or what it swings about, at both ends of the samples, of which the table has eight rows each. */
static void ends_of(const Tables *p, const double *table, int row, const double *x, quad *start, quad *end) {
    double found[8];
    product(p->n + AHEAD + 2, 8, table + (size_t)row * 8 * (p->n + AHEAD + 2), x, found);
    *start = quad_at(found), *end = quad_at(found + 1);
}

/* Look closer at the rows that are not calm in the samples of a product. Between two samples a row gets beyond its larger
   end by at most b (1 - |Δr|/4b)², as a parabola with b = h²/8 |r''|; where |Δr| is larger than 4b it is monotonic. It also
   stays near its chord by the change of its slope and its third derivative, or near what fast modes swing about. */
static void examine(const Tables *p, const double *ground, const double *rise, int samples, const double *x, const double *before,
                    const double *after, Watch *w, Asking *found) {
    const int parted = p->capped && !w->shakes;
    unsigned left = (1u << samples) - 1; /* samples before the first in which a condition may fail */
    found->at_end = found->within = found->fails = found->count = 0;
    for (int k = 0; k < p->rows && left; k++) {
        const int j = (k + p->outputs) % p->rows, f = AHEAD * j; /* conditions first */
        const quad r1 = quad_at(after + f), calm_low = quad_at(w->calm_low + f), calm_high = quad_at(w->calm_high + f);
        quad r0 = quad_at(after + f - 1);
        r0[0] = before[f + AHEAD - 1];
        if (!bits((r1 > calm_high) | (r1 < calm_low) | (r0 > calm_high) | (r0 < calm_low))) continue;
        const quad bend = quad_all(w->bend[j]), cap = quad_all(w->cap[j]), least = quad_all(w->low[j]), most = quad_all(w->high[j]);
        const quad turns = quad_larger(4.0 * bend - quad_absolute(r1 - r0), quad_all(0.0));
        quad beyond = turns * (turns / (16.0 * bend + 1e-305)) + cap; /* squares of forces might overflow, or vanish */
        quad low = -quad_larger(-r0, -r1), high = quad_larger(r0, r1), s0 = {0}, s1 = {0};
        if (!(bits((high + beyond > most) | (low - beyond < least)) & left)) continue;
        if (!w->fine && w->shakes) {
            product(shaken_columns(p), up8(p->rows), p->shaken.sway, w->moves, w->sway);
            product(shaken_columns(p), up8(p->rows - p->outputs), p->shaken.jolt, w->moves, w->jolt);
        } else if (!w->fine) {
            product(p->parts + 2, up8(p->rows), p->sway, w->moves, w->sway);
            product(p->parts + 2, up8(p->rows - p->outputs), p->jolt, w->moves, w->jolt);
        }
        w->fine = 1;
        if (rise)
            for (int i = 0; i < AHEAD; i++) s0[i] = found->slopes[i * p->rows + j], s1[i] = found->ends[i * p->rows + j];
        else
            ends_of(p, p->slope, j, x, &s0, &s1);
        const quad closer = quad_absolute(s1 - s0) * (p->h / 8.0) + w->sway[j];
        beyond = quad_chosen(closer < beyond, closer, beyond), low -= beyond, high += beyond;
        if (parted && w->cap[j] > 0.0) {
            quad c0, c1, away = 0.5 * cap + bend;
            ends_of(p, p->centre, j, x, &c0, &c1);
            low = quad_larger(low, -quad_larger(-c0, -c1) - away), high = -quad_larger(-high, -quad_larger(c0, c1) - away);
        }
        const unsigned above = bits((high > most) | (low < least)) & left;
        if (!above) continue;
        if (j >= p->outputs) {
            const unsigned fails = failing(p, ground, rise, j, r0, r1, s0, s1, above, w->jolt[j - p->outputs]);
            if (fails) found->fails = fails & -fails, left &= found->fails - 1;
            continue;
        }
        const int one = p->one_sided[j] > 0.0;
        const quad top = one ? high : quad_larger(high, -low), end = one ? r1 : quad_absolute(r1);
        const unsigned within = bits(top > quad_larger(most, end)) & above;
        found->within |= within, found->at_end |= above & ~within;
        quad_put(found->top + AHEAD * found->count, top), found->rows[found->count++] = j;
    }
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

/* Raise the peak of an output to its value at a sample. */
static inline void raise_peak(const Tables *p, int j, double value, double sample, Log *log) {
    value = p->one_sided[j] > 0.0 ? value : fabs(value);
    if (value > log->high[j]) log->high[j] = value, log->when[j] = log->passed + sample;
}

/* Log what is found in the samples of a product from sample i on, of which `known` states are known, and raise the peaks.
   Returns how many samples there are before the first in which a condition may fail. */
static int inspect(const Tables *p, int phase, int i, int samples, const Asking *asking, const double *after, int known, States y,
                   Watch *w, Log *log) {
    int k = 0;
    for (; k < samples; k++) {
        double *row = log->candidates + (size_t)log->count * log->width, *above = row + 3 + p->n;
        if (asking->fails >> k & 1) {
            log->looks = 1;
            break;
        }
        if (!((asking->at_end | asking->within) >> k & 1)) continue;
        int higher = 0;
        for (int q = 0; q < asking->count && asking->within >> k & 1; q++) {
            const int j = asking->rows[q];
            const double end = after[AHEAD * j + k], top = asking->top[AHEAD * q + k];
            higher |= top > log->high[j] && top > (p->one_sided[j] > 0.0 ? end : fabs(end));
        }
        if (higher) { /* the state there is not needed if the value turns out not to be a peak */
            const int from = k < known ? k : known;
            row[0] = phase, row[1] = i + k, row[2] = k - from;
            memcpy(row + 3, y[from], sizeof **y * p->n);
            for (int j = 0; j < p->outputs; j++) above[j] = -INFINITY;
            for (int q = 0; q < asking->count; q++) above[asking->rows[q]] = asking->top[AHEAD * q + k];
            log->count++;
        }
        for (int q = 0; q < asking->count; q++)
            raise_peak(p, asking->rows[q], after[AHEAD * asking->rows[q] + k], i + k + 1, log);
    }
    set_limits(p, log, w), set_calm(p->rows, w);
    return k;
}

/* Advance whole samples from i, up to `last`. Returns the number of the sample at which the motion stands: before the
   first in which a condition may fail, or where a block begins for which there is no room for candidates, or after so much
   work that the run looks up. What is logged does not change the motion. */
static int march(const Tables *p, int phase, const double *a, const double *v, int i, int last, double *y, Log *log) {
    const int n = p->n, states = up8(n), rows = p->rows, flat = up8(AHEAD * rows);
    Workspace *room = log->workspace;
    double(*at_samples)[MAX_STATES] = room->states, *arena = room->arena;
    double x[MAX_STATES + 16], padded[AHEAD + 1], lifted[AHEAD + 1];
    double *after = taken(&arena, flat + states), *before = taken(&arena, flat + states);
    Watch watch = {.fine = 0}, *w = &watch;
    Asking asking = {.count = 0};
    double **of_rows[] = {&w->low, &w->high, &w->bend, &w->cap, &w->sway, &w->jolt};
    double **of_samples[] = {&w->calm_low, &w->calm_high, &asking.top, &asking.slopes, &asking.ends};
    for (size_t k = 0; k < sizeof of_rows / sizeof *of_rows; k++) *of_rows[k] = taken(&arena, rows);
    for (size_t k = 0; k < sizeof of_samples / sizeof *of_samples; k++) *of_samples[k] = taken(&arena, AHEAD * rows);
    w->moves = taken(&arena, MOVES), asking.rows = (int *)taken(&arena, rows);
    memcpy(x, y, sizeof *x * n);
    if (!log->resumes) {
        memset(x + n, 0, 10 * sizeof *x);
        x[n] = a[i], x[n + 1] = 1.0;
        rows_at(p, x, v ? v[i] : 0.0, after, log->seen);
        for (int j = 0; j < p->outputs; j++) raise_peak(p, j, log->seen[j], i, log);
    }
    set_limits(p, log, w);
    for (int j = 0; j < rows; j++) {
        quad_put(before + AHEAD * j, quad_all(log->seen[j]));
        if (j >= p->outputs) w->low[j] = 1e-300, w->high[j] = INFINITY;
    }
    log->looks = log->resumes = 0;
    for (int left = 0, was_calm = 0; i < last && !log->looks; left -= AHEAD) {
        if (left == 0) {
            if (log->count + BLOCK > log->room || log->work >= log->pause) {
                for (int j = 0; j < rows; j++) log->seen[j] = before[AHEAD * j + AHEAD - 1];
                log->resumes = 1;
                break;
            }
            left = begin_block(p, a + i, v ? v + i : 0, last - i < BLOCK ? last - i : BLOCK, x, w);
            was_calm = calm(rows, before, w);
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
        const int is_calm = calm(rows, after, w);
        int passed = samples, steps = samples < AHEAD || rise || log->states;
        if (left_over || !(was_calm && is_calm)) {
            if (rise) slopes_shaken(p, ground, rise, known, at_samples, &asking);
            examine(p, ground, rise, samples, x, before, after, w, &asking);
            if (left_over) asking.fails |= 1u << known;
            was_calm = is_calm;
            if (asking.at_end | asking.within | asking.fails) {
                memcpy(at_samples[0], x, sizeof *x * n);
                passed = inspect(p, phase, i, samples, &asking, after, known, at_samples, w, log);
                steps |= log->looks;
                was_calm = calm(rows, after, w);
            }
        }
        if (steps) {
            memcpy(at_samples[0], x, sizeof *x * n);
            for (; known < passed; known++) advance(p, ground + known, at_samples[known], at_samples[known + 1]);
            if (passed == AHEAD && !rise)
                for (int k = 0; k < n; k++) at_samples[AHEAD][k] = x[k] + after[flat + k];
            memcpy(x, at_samples[passed], sizeof *x * n);
            if (log->states)
                for (int k = 1; k <= passed; k++) memcpy(log->states + (size_t)(i + k) * n, at_samples[k], sizeof *x * n);
        } else {
            for (int k = 0; k < n; k++) x[k] += after[flat + k];
        }
        double *other = before;
        before = after, after = other;
        i += passed;
        log->work += passed;
    }
    memcpy(y, x, sizeof *x * n);
    return i;
}

#include "steps.h"
#include "prepare.h"
#include "oscillators.h"

const Loops JOIN(rockflex_loops_, LEVEL) = {TEXT(LEVEL), UNITS * 8, workspace, product, expand, evaluate, move, spread,
                                            reach, complete, magnitudes, advance, march, attempt, look, within, bend,
                                            room, turn, modes_of, amplitudes, bound, prepare, oscillate, exceed};
