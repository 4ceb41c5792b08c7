/* A step of a Runge-Kutta pair, for `march.c`: its stages, its error, and its polynomial. */

enum { STAGES = 16, LAST = 12, COARSE = 16, FINE, BENDS };
enum { FEW = 8, NARROW = 16 }; /* states that move; doubles in a row of theirs */
#define INLINED static inline __attribute__((always_inline))

/* Σ weights[k] rates[k] over the stages 0 and `from` to `to` - 1, for as many states as there are lanes. */
INLINED vec weighted(int from, int to, const double *weights, const double *rates, int width) {
    vec sum = at(rates) * weights[0];
#pragma GCC unroll 16
    for (int k = from; k < to; k++) sum += at(rates + (size_t)k * width) * weights[k];
    return sum;
}

/* The states at a stage, from the stages 0 and `from` on. The states that follow up to a whole vector have no rates, or
   nothing depends on them. Of a few states the newest rates are read one by one (hence volatile), as they were written: a
   vector could not be loaded before all of it has reached the cache. */
INLINED void place(int stage, int from, const Step *s, int count, int few, int width, double *out) {
    const double *weights = s->weights + stage * STAGES;
    const int older = few && stage > 1 ? stage - 1 : stage;
    for (int i = 0; i < count; i += LANES)
        put(out + i, at(s->start + i) + weighted(from, older, weights, s->rates + i, width) * s->length);
    if (older < stage) {
        const volatile double *newest = s->rates + (size_t)older * width;
        const double weight = s->length * weights[older];
        for (int i = 0; i < count; i++) out[i] += weight * newest[i];
    }
}

INLINED void stage(int stage, int from, const Phase *p, const Step *s, Rates rates, int counted, int few, int width,
                   double *out) {
    const double t = s->nodes[stage];
    place(stage, from, s, counted ? p->counted : p->moving, few, width, out);
    rates(p->field, out, s->a + s->rise * t, s->v + s->climb * t, s->rates + (size_t)stage * width, counted);
}

INLINED double steps(const Phase *p, const Step *s, Rates rates, int counted, int few, int width) {
    const int n = p->tables.n;
    vec third = {0}, fifth = {0};
    double coarse = 0.0, fine = 0.0;
    for (int i = p->moving; i < n; i++) s->end[i] = s->start[i];
    stage(1, 1, p, s, rates, counted, few, width, s->end);
    stage(2, 1, p, s, rates, counted, few, width, s->end);
    stage(3, 2, p, s, rates, counted, few, width, s->end);
    stage(4, 2, p, s, rates, counted, few, width, s->end);
    stage(5, 3, p, s, rates, counted, few, width, s->end);
    stage(6, 3, p, s, rates, counted, few, width, s->end);
    stage(7, 3, p, s, rates, counted, few, width, s->end);
    stage(8, 3, p, s, rates, counted, few, width, s->end);
    stage(9, 3, p, s, rates, counted, few, width, s->end);
    stage(10, 3, p, s, rates, counted, few, width, s->end);
    stage(11, 3, p, s, rates, counted, few, width, s->end);
    stage(12, 5, p, s, rates, counted, few, width, s->end);
    for (int i = counted ? p->counted : p->moving; i < n; i++) s->end[i] = s->start[i];
    s->end[n] = s->a + s->rise, s->end[n + 1] = 1.0;
    for (int i = 0; i < p->moving; i += LANES) { /* the least sizes of states that do not move are infinite */
        vec most = larger(at(s->largest + i), at(p->floor + i));
        most = larger(most, larger(absolute(at(s->start + i)), absolute(at(s->end + i))));
        vec one = weighted(5, LAST, s->weights + COARSE * STAGES, s->rates + i, width) / most;
        vec other = weighted(5, LAST, s->weights + FINE * STAGES, s->rates + i, width) / most;
        third += one * one, fifth += other * other;
    }
    for (int j = 0; j < LANES; j++) coarse += third[j], fine += fifth[j];
    return fine == 0.0 ? 0.0 : s->length * fine / sqrt((fine + 0.01 * coarse) * p->moving);
}

/* Take the stages of a step from the first one on; its error over the sizes of the states. */
static double attempt(const Phase *p, const Step *s, Rates rates, int counted) {
    if (p->moving > FEW) return steps(p, s, rates, counted, 0, s->width); /* whatever is counted, the sums are the same */
    return s->width == NARROW ? steps(p, s, rates, counted, 1, NARROW) : steps(p, s, rates, counted, 1, s->width);
}

/* The outputs or conditions of a term of order k of a series, with y, a and 1; those that are not linear as their rows say.
   `before` is the term before. */
static void look(const Phase *p, int outputs, Climb v, int k, const double *before, const double *x, double *out) {
    const Tables *t = &p->tables;
    const int count = up8(outputs ? t->outputs : p->events);
    double more[MORE];
    if (acts(t, v)) {
        x = shaken_term(t, v, k, before, x, more);
        product(t->n + 3 + t->shaken.fed, count, outputs ? t->shaken.outs : t->shaken.now, x, out);
    } else {
        product(t->n + 2, count, outputs ? t->outs : t->now, x, out);
    }
}

/* The state at a stage of a step, from 4 to 11. */
static void within(const Phase *p, const Step *s, int stage) {
    place(stage, 3, s, p->moving, 0, s->width, s->place);
    for (int i = p->moving; i < p->tables.n; i++) s->place[i] = s->start[i];
}

/* Fill a series with the polynomials of the states over a step, of degree 7: u (F_0 + v (F_1 + u (F_2 + v (F_3 + u (F_4
   + v (F_5 + u F_6)))))), v = 1 - u. */
static void bend(const Phase *p, const Step *s, Rates rates, int counted, int width, double *series) {
    const double h = s->length, *last = s->rates + (size_t)LAST * s->width, *weights = s->weights + BENDS * STAGES;
    const int n = p->tables.n, count = counted ? p->counted : p->moving;
    for (int i = p->moving; i < n; i++) s->place[i] = s->start[i];
    stage(13, 6, p, s, rates, counted, 0, s->width, s->place);
    stage(14, 5, p, s, rates, counted, 0, s->width, s->place);
    stage(15, 5, p, s, rates, counted, 0, s->width, s->place);
    for (int k = 0; k < 8; k++)
        for (int i = count; i < up8(n + 2); i++) series[(size_t)k * width + i] = k == 0 && i < n ? s->start[i] : 0.0;
    series[n] = s->a, series[width + n] = s->rise, series[n + 1] = 1.0;
    for (int i = 0; i < count; i++) {
        double f[4] = {0.0};
        for (int k = 0; k < STAGES; k++)
            for (int j = 0; j < 4; j++) f[j] += h * weights[j * STAGES + k] * s->rates[(size_t)k * s->width + i];
        double f0 = s->end[i] - s->start[i], f1 = h * s->rates[i] - f0, f2 = 2.0 * f0 - h * (s->rates[i] + last[i]);
        double b0 = f[1] + f[2], b1 = f[3] - f[2], b2 = -f[3];                   /* F_4 + v (F_5 + u F_6) */
        double d0 = f2 + f[0], d1 = b0 - f[0], d2 = b1 - b0, d3 = b2 - b1, d4 = -b2; /* F_2 + v (F_3 + u (..)) */
        double found[] = {s->start[i], h * s->rates[i], d0 - f1, d1 - d0, d2 - d1, d3 - d2, d4 - d3, -d4};
        for (int k = 0; k < 8; k++) series[(size_t)k * width + i] = found[k];
    }
}
