/* Samples in which the vertical acceleration acts; a part of `march.c`. */

/* Outputs and conditions from y, a, 1, zeros up to a multiple of 8, and a_v; there is room for rates and conditions. */
static void rows_at(const Tables *p, const double *x, double v, double *room, double *rows) {
    const Climb climb = {v, 0.0};
    const int shakes = acts(p, climb), n = p->n, m = p->outputs, conditions = p->rows - m;
    const int rates = n - (shakes ? p->shaken.shift : p->shift), columns = shakes ? n + 3 + p->shaken.fed : n + 2;
    double more[MORE];
    if (shakes)
        x = shaken_term(p, climb, 0, 0, x, more), product(columns, up8(rates + conditions), p->shaken.now, x, room);
    else
        rates_of(p, 0, x, room);
    memcpy(rows + m, room + rates, sizeof *x * conditions);
    product(columns, up8(m), shakes ? p->shaken.outs : p->outs, x, room);
    memcpy(rows, room, sizeof *x * m);
}

/* Whether some samples are shaken vertically. */
static int any_rise(const double *v, int samples) {
    for (int k = 0; k <= samples; k++)
        if (v[k] != 0.0) return 1;
    return 0;
}

/* Whether a phase takes such samples in the march at all; otherwise all are left to power series. */
static int marches_shaken(const Tables *p) { return p->shaken.now && *p->shaken.limit > 0.0; }

/* Columns of the bounds of a shaken block. */
static int shaken_columns(const Tables *p) { return p->parts + 4 + 5 * p->shaken.fed; }

/* Replace b by the solution of x = b + M x for b and M that are not negative; 0, and x very large, if there is none. */
static int solve(int count, double M[MAX_FED][MAX_FED], double *x) {
    int good = 1;
    for (int k = 0; k < count; k++) {
        double pivot = 1.0 - M[k][k];
        good &= pivot > 0.0;
        for (int i = 0; i < count; i++) {
            if (i == k) continue;
            double factor = M[i][k] / pivot;
            for (int j = k + 1; j < count; j++) M[i][j] += factor * M[k][j];
            x[i] += factor * x[k];
        }
        for (int j = k + 1; j < count; j++) M[k][j] /= pivot;
        x[k] /= pivot;
    }
    for (int k = 0; k < count; k++)
        if (!good || !(x[k] < 1e100)) x[k] = 1e100;
    return good;
}

/* Bounds of a_v and of p = a_v y within a block, after those of the other inputs. With T its length and V the variation
   of a_v, |y| is at most |y0| + T |y'|, and p varies by at most V |y| + T |a_v| |y'|, of which |y'| has a share again.
   p' = a_v' y + a_v y', p'' = 2 a_v' y' + a_v y'' and so on. Returns 0 if the block is too long for such bounds. */
static int vary_shaken(const Tables *p, const double *v, int samples, const double *y, double *moves) {
    const Shaken *s = &p->shaken;
    const int fed = s->fed, width = shaken_columns(p);
    double *more = moves + 2, *varies = more + 2, most = 0.0, M[MAX_FED][MAX_FED], loop[8], unit[MAX_FED];
    double bound[5][8] = {{0}}; /* of y, y', .. */
    const double T = samples * p->h;
    vary(v, samples, p->h, more);
    for (int k = 0; k <= samples; k++) most = fabs(v[k]) > most ? fabs(v[k]) : most;
    memset(varies, 0, sizeof *varies * 5 * fed);
    if (fed == 0) return 1;
    product(width, 8, s->swell[0], moves, bound[1]);
    for (int j = 0; j < fed; j++) {
        for (int k = 0; k < fed; k++) unit[k] = k == j;
        product(fed, 8, s->loop, unit, loop);
        for (int i = 0; i < fed; i++) {
            M[i][j] = loop[i] * (more[0] + most) * T;
            bound[1][i] += loop[i] * more[0] * fabs(y[s->places[j]]);
        }
    }
    const int good = solve(fed, M, bound[1]);
    for (int j = 0; j < fed; j++) {
        bound[0][j] = fabs(y[s->places[j]]) + T * bound[1][j];
        varies[2 * j] = more[0] * bound[0][j] + T * most * bound[1][j];
    }
    for (int order = 1; order < 5; order++) {
        for (int j = 0; j < fed; j++)
            varies[order > 1 ? order * fed + j : 2 * j + 1] = order * more[1] * bound[order - 1][j] + most * bound[order][j];
        if (order < 4) product(width, 8, s->swell[order], moves, bound[order + 1]);
    }
    return good;
}

/* The state a sample later; 0 if the fixed point of p is not found. */
static int advance_shaken(const Tables *p, const double *a, const double *v, const double *y, double *next) {
    const Shaken *s = &p->shaken;
    const int n = p->n, states = up8(n), count = s->fed * s->nodes;
    double x[MAX_STATES + 5], z[MAX_STATES + MAX_FED * MAX_NODES], added[MAX_STATES];
    double rise[MAX_FED * MAX_NODES], fed[MAX_FED * MAX_NODES], back[MAX_FED * MAX_NODES], last = 0.0;
    memcpy(x, y, sizeof *x * n);
    x[n] = a[0], x[n + 1] = a[1], x[n + 2] = 1.0, x[n + 3] = v[0], x[n + 4] = v[1];
    product(n + 5, states + count, s->known, x, z);
    if (count == 0) {
        for (int k = 0; k < n; k++) next[k] = y[k] + z[k];
        return 1;
    }
    for (int k = 0; k < count; k++) {
        rise[k] = v[0] + (v[1] - v[0]) * s->times[k % s->nodes];
        fed[k] = rise[k] * z[states + k];
        last = fabs(fed[k]) > last ? fabs(fed[k]) : last;
    }
    for (int turns = 0;; turns++) {
        double change = 0.0, top = 0.0;
        product(count, count, s->feedback, fed, back);
        for (int k = 0; k < count; k++) {
            double better = rise[k] * (z[states + k] + back[k]), moved = fabs(better - fed[k]);
            change = moved > change ? moved : change;
            top = fabs(better) > top ? fabs(better) : top;
            fed[k] = better;
        }
        if (change * change <= 1e-17 * top * last) break; /* the next change would be rounding */
        if (turns == 30) return 0;
        last = change;
    }
    product(count, states, s->given, fed, added);
    for (int k = 0; k < n; k++) next[k] = y[k] + (z[k] + added[k]);
    return 1;
}

/* Advance some samples: states, and rows after each of them. Returns the number of samples before one that is left to a
   power series; the rows from there on are those before it. */
static int go_shaken(const Tables *p, const double *a, const double *v, int samples, States y, const double *before,
                     double *after) {
    const Shaken *s = &p->shaken;
    const int n = p->n, rows = p->rows;
    double x[MAX_STATES + 2], more[MORE], found[MAX_ROWS];
    int k = 0;
    for (; k < samples && marches_shaken(p); k++) {
        if (!(fabs(v[k]) <= *s->limit && fabs(v[k + 1]) <= *s->limit)) break;
        if (!advance_shaken(p, a + k, v + k, y[k], y[k + 1])) break;
        memcpy(x, y[k + 1], sizeof *x * n);
        x[n] = a[k + 1], x[n + 1] = 1.0;
        const Climb climb = {v[k + 1], 0.0};
        product(n + 3 + s->fed, up8(rows), s->rows, shaken_term(p, climb, 0, 0, x, more), found);
        for (int j = 0; j < rows; j++) after[AHEAD * j + k] = found[j];
    }
    for (int j = 0; j < rows; j++)
        for (int q = k; q < AHEAD; q++) after[AHEAD * j + q] = q ? after[AHEAD * j + q - 1] : before[AHEAD * j + AHEAD - 1];
    return k;
}

/* The slopes of the rows at both ends of some samples, without the parts of a' and a_v'. */
static void slopes_shaken(const Tables *p, const double *a, const double *v, int samples, States y, const Asking *asking) {
    const Shaken *s = &p->shaken;
    const int n = p->n, rows = p->rows, columns = n + 3 + s->fed;
    double x[MAX_STATES + 2], more[MORE + MAX_FED], speeds[MAX_FED + 8], found[MAX_ROWS];
    for (int k = 0; k < samples; k++)
        for (int end = 0; end < 2; end++) {
            const Climb climb = {v[k + end], 0.0};
            memcpy(x, y[k + end], sizeof *x * n);
            x[n] = a[k + end], x[n + 1] = 1.0;
            shaken_term(p, climb, 0, 0, x, more);
            product(columns, up8(s->fed), s->speeds, more, speeds);
            for (int j = 0; j < s->fed; j++)
                more[columns + j] = (v[k + 1] - v[k]) / p->h * x[s->places[j]] + v[k + end] * speeds[j];
            product(columns + s->fed, up8(rows), s->slope, more, found);
            memcpy((end ? asking->ends : asking->slopes) + k * rows, found, sizeof *found * rows);
        }
    for (int f = samples * rows; f < AHEAD * rows; f++) asking->slopes[f] = asking->ends[f] = 0.0;
}
