/* The tables of a phase for one time step, of one system at a time: what `tables.py` says in NumPy. Part of `march.c`.

   A matrix here has its rows `w` doubles apart, and zeros below and beside it, to multiples of 4 and of 8. */

enum { FINEST = 8, FEWEST = 10, MOST_TERMS = 60, WAYS = 2 * BLOCK }; /* as in `tables.py`; places of the grid of h/2 */
static const double LONGEST = 2.5, FAST = 3.0, POOR = 1e6, SMALL = 1e-18, VAGUE = 1e300;

typedef struct { /* room for the tables of one system: square matrices, and larger ones */
    int n, w;
    size_t size; /* of all, in doubles */
    double *G, *X, *term, *next, *slow, *step, *grown, *rates, *push[2], *change[FINEST + 2], *later[AHEAD + 1];
    double *rows, *found, *most, *here, *after, *centre, *sway;
} Room;

static Room room_for(const Shape *s, double *memory) {
    Room r = {.n = s->n, .w = up8(s->parts > s->n + AHEAD ? s->parts + 2 : s->n + AHEAD + 2)};
    const size_t square = (size_t)r.w * up8(s->n + 3);
    const size_t large = (size_t)r.w * (up8(8 * s->rows) + up8(s->n) + up8(s->parts) + 8);
    double **squares[] = {&r.G, &r.X, &r.term, &r.next, &r.slow, &r.step, &r.grown, &r.rates, r.push, r.push + 1};
    double **tables[] = {&r.rows, &r.found, &r.most, &r.here, &r.after, &r.centre, &r.sway};
    for (size_t k = 0; k < sizeof squares / sizeof *squares; k++, r.size += square) *squares[k] = memory + r.size;
    for (int k = 0; k < FINEST + 2; k++, r.size += square) r.change[k] = memory + r.size;
    for (int k = 0; k <= AHEAD; k++, r.size += square) r.later[k] = memory + r.size;
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++, r.size += large) *tables[k] = memory + r.size;
    return r;
}

static size_t room(const Shape *s) {
    double nowhere;
    return room_for(s, &nowhere).size;
}

/* Some columns of four rows of a product. */
static inline __attribute__((always_inline)) void four(int vectors, int inner, int w, const double *left, const double *right,
                                                       double *out) {
    vec sum[4][2] = {{{0}}};
    for (int k = 0; k < inner; k++)
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < vectors; j++) sum[i][j] += left[(size_t)i * w + k] * at(right + (size_t)k * w + j * LANES);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < vectors; j++) put(out + (size_t)i * w + j * LANES, sum[i][j]);
}

/* out = left · right, for so many rows of `left` and columns of `right`. No sum depends on how many there are. */
static void multiply(int rows, int inner, int columns, int w, const double *left, const double *right, double *out) {
    for (int i = 0; i < rows; i += 4) {
        int j = 0;
        for (; j + 2 * LANES <= up8(columns); j += 2 * LANES)
            four(2, inner, w, left + (size_t)i * w, right + j, out + (size_t)i * w + j);
        if (j < columns) four(1, inner, w, left + (size_t)i * w, right + j, out + (size_t)i * w + j);
    }
}

static void scale(int rows, int w, double factor, const double *from, double *to) {
    for (int i = 0; i < rows * w; i++) to[i] = factor * from[i];
}

/* How often a step must be halved so that no mode turns by more than `longest`, in rad. */
static int halvings_of(double turn, double longest) {
    double share = turn / longest;
    if (!(share < 1e300)) share = 1e300;
    return share > 1.0 ? (int)ceil(log2(share)) : 0;
}

/* A close upper estimate of the spectral radius. */
static double spectral_radius_bound(const Room *r, const double *A) {
    const double *power = A;
    double total = 0.0;
    for (int k = 0; k < 4; k++) multiply(r->n, r->n, r->n, r->w, power, power, r->push[k % 2]), power = r->push[k % 2];
    for (int i = 0; i < r->n; i++)
        for (int j = 0; j < r->n; j++) total += power[i * r->w + j] * power[i * r->w + j];
    return pow(total, 1.0 / 32.0);
}

/* exp(G/2^k) - 1 for k from 0 to `kept`, by the Taylor series of G/2^halvings, and squaring; of n + `more` states. */
static void exponentials_less_identity(const Room *r, int n, const double *G, int halvings, int kept, double *const *found) {
    const int w = r->w, rows = up8(n);
    double *X = r->X, *total = r->push[0], *term = r->term, *next = r->next;
    scale(rows, w, halvings < 1000 ? ldexp(1.0, -halvings) : 0x1p-1000, G, X);
    memcpy(term, X, sizeof *X * rows * w), memcpy(total, X, sizeof *X * rows * w);
    for (int k = 2, ends = 0; k < MOST_TERMS && !ends; k++) {
        multiply(n, n, n, w, term, X, next);
        mask moves = {0};
        for (int i = 0; i < rows * w; i += LANES) {
            vec here = at(next + i) * (1.0 / k);
            moves |= absolute(here) > SMALL * absolute(at(total + i));
            put(next + i, here);
        }
        ends = k >= FEWEST && !any(moves);
        for (int i = 0; !ends && i < rows * w; i += LANES) put(total + i, at(total + i) + at(next + i));
        double *last = term;
        term = next, next = last;
    }
    for (int q = halvings;; q--) {
        if (q <= kept) memcpy(found[q], total, sizeof *total * rows * w);
        if (q == 0) break;
        double *other = total == r->push[0] ? r->push[1] : r->push[0];
        multiply(n, n, n, w, total, total, other);
        for (int i = 0; i < rows * w; i += LANES) put(other + i, at(other + i) + 2.0 * at(total + i));
        total = other;
    }
}

/* The inverse of a matrix, in place, by elimination; whether there is one. */
static int invert(int n, int w, double *X) {
    int pivots[MAX_STATES];
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(X[i * w + k]) > fabs(X[pivot * w + k])) pivot = i;
        double share = X[pivot * w + k];
        if (!(fabs(share) > 0.0)) return 0;
        pivots[k] = pivot, X[pivot * w + k] = 1.0;
        for (int j = 0; j < n; j++) {
            double value = X[pivot * w + j] / share;
            X[pivot * w + j] = X[k * w + j], X[k * w + j] = value;
        }
        for (int i = 0; i < n; i++) {
            const double factor = X[i * w + k];
            if (i == k || factor == 0.0) continue;
            X[i * w + k] = 0.0;
            for (int j = 0; j < n; j++) X[i * w + j] -= factor * X[k * w + j];
        }
    }
    for (int k = n - 1; k >= 0; k--)
        for (int i = 0; i < n; i++) {
            double value = X[i * w + k];
            X[i * w + k] = X[i * w + pivots[k]], X[i * w + pivots[k]] = value;
        }
    return 1;
}

static void set_rows(int rows, int columns, int w, const double *from, double *to) {
    for (int i = 0; i < rows; i++) memcpy(to + (size_t)i * w, from + (size_t)i * columns, sizeof *to * columns);
}

/* How far a mode of a phase turns within a step, at most, in rad. */
static double turn(const Shape *s, const double *rates, double *memory) {
    Room r = room_for(s, memory);
    memset(r.G, 0, sizeof *memory * (size_t)r.w * up8(s->n + 3));
    set_rows(s->n, s->n + 2, r.w, rates, r.G);
    for (int i = 0; i < s->n; i++) r.G[i * r.w + s->n] = r.G[i * r.w + s->n + 1] = 0.0;
    scale(s->n, r.w, s->h, r.G, r.G);
    return spectral_radius_bound(&r, r.G);
}

/* The modes that turn by more than FAST in a step: roots, columns V and rows W of each, real and imaginary parts apart, in
   `modes`. Given are all roots, real parts and then imaginary ones, and all vectors, the real and the imaginary part in place
   of two that are conjugate. Returns their number; 0 if they cannot be parted from the others. */
static int fast_modes(const Shape *s, const double *roots, const double *vectors, double *memory, double *modes) {
    const Room r = room_for(s, memory);
    const int n = s->n, w = r.w;
    const double *real = roots, *imaginary = roots + n;
    double *inverse = r.after;
    int count = 0;
    set_rows(n, n, w, vectors, inverse);
    if (!invert(n, w, inverse)) return 0;
    for (int k = 0; k < n; k++) {
        if (imaginary[k] < 0.0 || !(hypot(real[k], imaginary[k]) * s->h > FAST)) continue;
        const int pair = imaginary[k] > 0.0;
        double *mode = modes + (size_t)count++ * (2 + 4 * n), sum = 0.0;
        mode[0] = real[k], mode[1] = imaginary[k], mode += 2;
        for (int i = 0; i < n; i++) {
            mode[i] = vectors[i * n + k], mode[n + i] = pair ? vectors[i * n + k + 1] : 0.0;
            mode[2 * n + i] = inverse[k * w + i] * (pair ? 0.5 : 1.0);
            mode[3 * n + i] = pair ? -0.5 * inverse[(k + 1) * w + i] : 0.0;
            sum += hypot(mode[i], mode[n + i]) * hypot(mode[2 * n + i], mode[3 * n + i]);
        }
        if (!(sum < POOR)) return 0;
    }
    return count;
}

/* Bounds of the entries of e^{At} for all t in [0, h/2], in `grown`, from its changes in h/2, h/4, .. h/2^(fine + 1). */
static void bound_growth(const Room *r, double h, int fine) {
    const int n = r->n, w = r->w;
    double *here = r->X, *next = r->term, *most = r->grown, *between = r->next, *inverse = r->G;
    memset(here, 0, sizeof *here * n * w), memset(most, 0, sizeof *most * n * w);
    for (int i = 0; i < n; i++) here[i * w + i] = most[i * w + i] = 1.0;
    for (int k = 1; k < 1 << fine; k++) {
        multiply(n, n, n, w, here, r->change[fine + 1], next);
        for (int i = 0; i < n * w; i += LANES) {
            vec value = at(here + i) + at(next + i);
            put(here + i, value), put(most + i, larger(at(most + i), absolute(value)));
        }
    }
    for (int i = 0; i < n * w; i++) between[i] = fabs(r->slow[i]) * ldexp(0.5 * h, -fine);
    const double turns = spectral_radius_bound(r, between);
    if (turns <= 0.5) {
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) inverse[i * w + j] = (i == j) - between[i * w + j];
        invert(n, w, inverse);
        multiply(n, n, n, w, most, inverse, next);
        memcpy(most, next, sizeof *most * n * w);
    } else {
        memcpy(inverse, between, sizeof *inverse * n * w);
        exponentials_less_identity(r, n, inverse, halvings_of(turns, 1.0) + 1, 0, r->change);
        multiply(n, n, n, w, most, r->change[0], next);
        for (int i = 0; i < n * w; i++) most[i] += next[i];
    }
}

/* A table column after column, in groups of rows as in `product`; zeros below its rows. */
static void lay(int rows, int columns, int w, const double *from, double *to) {
    for (int first = 0, last; first < up8(rows); first = last) {
        last = first + 8 * units_of((up8(rows) - first) / 8);
        for (int j = 0; j < columns; j++)
            for (int i = first; i < last; i++) *to++ = i < rows ? from[(size_t)i * w + j] : 0.0;
    }
}

/* Put what rows are at some samples, from one sample after another, into one row after another, each with so many slots. */
static void by_row(int rows, int samples, int slots, int w, const double *from, double *to) {
    memset(to, 0, sizeof *to * (size_t)up8(rows * slots) * w);
    for (int j = 0; j < rows; j++)
        for (int k = 0; k < samples; k++)
            memcpy(to + (size_t)(j * slots + k) * w, from + (size_t)(k * rows + j) * w, sizeof *to * w);
}

/* Rows with columns y, a and 1, a number of samples later: with columns y, a0, a1 .., 1. */
static void rows_later(const Room *r, int rows, const double *from, int samples, double *to) {
    const int n = r->n, w = r->w;
    multiply(rows, n, n + AHEAD + 2, w, from, r->later[samples], to);
    for (int i = 0; i < rows; i++, from += w, to += w) {
        for (int j = 0; j < n; j++) to[j] += from[j];
        to[n + samples] += from[n], to[n + AHEAD + 1] += from[n + 1];
    }
}

/* Part fast modes from y': the matrices of the slow ones, moves, caps and what fast ones swing about; see `tables.Split`. */
static void part(const Shape *s, const Room *r, int count, const double *modes, double *driven, double *moves, double *cap) {
    const int n = s->n, w = r->w, R = s->rows;
    double *swing = r->here;
    memset(swing, 0, sizeof *swing * up8(R) * w);
    for (int k = 0; k < count; k++, modes += 2 + 4 * n) {
        const double re = modes[0], im = modes[1], root = hypot(re, im), both = im > 0.0 ? 2.0 : 1.0, h = s->h;
        const double *v = modes + 2, *vi = v + n, *u = vi + n, *ui = u + n, fades = re < 0.0 ? -re : 0.0;
        double drive[2] = {0.0, 0.0};
        for (int i = 0; i < n; i++) {
            const double turned = re * v[i] - im * vi[i], other = re * vi[i] + im * v[i];
            for (int j = 0; j < n; j++) {
                moves[i * w + j] -= both * (v[i] * u[j] - vi[i] * ui[j]);
                r->slow[i * w + j] -= both * (turned * u[j] - other * ui[j]);
            }
            moves[(n + k) * w + i] = u[i], moves[(n + count + k) * w + i] = ui[i];
            drive[0] += u[i] * r->rates[i * w + n], drive[1] += ui[i] * r->rates[i * w + n];
        }
        const double push = hypot(drive[0], drive[1]), steady = push / (fades > 1e-300 ? fades : 1e-300);
        const int soon = fades * BLOCK * h > 1.0;
        for (int j = 0; j < R; j++) {
            double seen[2] = {0.0, 0.0};
            for (int i = 0; i < n; i++) seen[0] += r->rows[j * w + i] * v[i], seen[1] += r->rows[j * w + i] * vi[i];
            const double size = both * hypot(seen[0], seen[1]) * exp((re > 0.0 ? re : 0.0) * BLOCK * h);
            const double most[2] = {2.0 * size / root, size * root * root * (h * h * h / 96.0)};
            for (int q = 0; q < 2; q++) {
                double *row = (q ? r->sway : cap) + j * w;
                row[n] += soon ? 0.0 : most[q] * push, row[n + 1] += soon ? most[q] * steady : 0.0;
                row[n + 2 + k] = row[n + 2 + count + k] = most[q];
            }
            r->sway[j * w + n + 1] += most[1] / root * push;
            const double share = both / (root * root);
            const double x = share * (seen[0] * re + seen[1] * im), z = share * (seen[1] * re - seen[0] * im);
            for (int i = 0; i < n; i++) swing[j * w + i] += x * u[i] - z * ui[i];
        }
    }
    for (int i = 0; i < n; i++) {
        driven[i] = 0.0;
        for (int j = 0; j < n; j++) driven[i] += moves[i * w + j] * r->rates[j * w + n];
    }
    multiply(R, n, n + 2, w, swing, r->rates, r->after);
    for (int i = 0; i < R * w; i++) r->centre[i] -= r->after[i];
}

/* Factors of |y'|, of the variation of a and of |a'| in bounds of the rows' derivatives, in `after`: h²/8 |r''| of all
   rows, h³/96 |r'''| of all, and h⁴/384 |r''''| of the conditions; see `tables.derivative_bound_factors`. */
static void bound_derivatives(const Shape *s, const Room *r, const double *driven, int fine) {
    const int n = s->n, w = r->w, m = s->outputs, R = s->rows, count = 3 * R - m, all = up8(count) * w;
    double *here = r->here, *most = r->most, *after = r->after, *direct = r->found;
    const double *rows[] = {r->rows, here, here + (R + m) * w}, h = s->h;
    for (int k = 0; k < 3; k++) {
        const int some = k < 2 ? R : R - m;
        multiply(some, n, n, w, rows[k], r->slow, here + k * R * w);
        for (int i = 0; i < some; i++) {
            double sum = 0.0;
            for (int j = 0; j < n; j++) sum += rows[k][i * w + j] * driven[j];
            direct[k * R + i] = fabs(sum);
        }
    }
    for (int i = 0; i < all; i += LANES) put(most + i, absolute(at(here + i)));
    for (int k = 1; k < WAYS; k++) {
        multiply(count, n, n, w, here, r->change[1], after);
        for (int i = 0; i < all; i += LANES) {
            vec value = at(here + i) + at(after + i);
            put(here + i, value), put(most + i, larger(at(most + i), absolute(value)));
        }
    }
    bound_growth(r, h, fine);
    multiply(count, n, n, w, most, r->grown, after);
    for (int i = 0; i < count; i++) {
        const double factor = i < R ? h * h / 8.0 : i < 2 * R ? h * h * h / 96.0 : h * h * h * h / 384.0;
        double *row = after + i * w, sum = 0.0;
        for (int j = 0; j < n; j++) sum += row[j] * fabs(driven[j]);
        row[n] = sum, row[n + 1] = direct[i];
        for (int j = 0; j < n + 2; j++) row[j] = row[j] * factor < VAGUE ? row[j] * factor : VAGUE; /* NaN is vague, too */
        for (int j = n + 2; j < w; j++) row[j] = 0.0;
    }
}

/* The only state that a row has, or 0 if it has none; -1 if it has several. */
static int sole_state(int n, const double *row) {
    int found = 0, count = 0;
    for (int j = 0; j < n; j++)
        if (row[j] != 0.0) count++, found = j;
    return count > 1 ? -1 : found;
}

/* Write the rates of the first states' rates as those of modes, of which one other rate may add a share to each: `border` of
   `Tables`. Rates that are not so to rounding are DENSE. */
static int border(const Shape *s, const Room *r, double *to) {
    const int n = s->n, w = r->w, size = up8(s->shift);
    int several = 0;
    *to = DENSE;
    for (int i = 2 * s->shift; i < n; i++) several += sole_state(n, r->rates + i * w) < 0;
    for (int i = s->outputs; i < s->rows; i++) several += sole_state(n, r->rows + i * w) < 0;
    if (up8(n - s->shift + s->rows - s->outputs) <= 16 || several > 4) return DENSE; /* a product takes less time */
    for (int q = UNCOUPLED; s->shift && q < n - 2 * s->shift && *to == DENSE; q++) {
        const double *other = r->rates + (2 * s->shift + (q > 0 ? q : 0)) * w;
        int fits = 1;
        for (int i = 0; fits && i < s->shift; i++) {
            const double *row = r->rates + (s->shift + i) * w;
            const int own[] = {i, s->shift + i, n, n + 1};
            double share = 0.0, most = 0.0;
            for (int j = 0; q != UNCOUPLED && j < n; j++)
                if (j != own[0] && j != own[1] && fabs(other[j]) > most) most = fabs(other[j]), share = row[j] / other[j];
            for (int j = 0; fits && j < n; j++)
                if (j != own[0] && j != own[1])
                    fits = q == UNCOUPLED ? row[j] == 0.0 : fabs(row[j] - share * other[j]) <= 1e-15 * fabs(row[j]);
            for (int k = 0; k < 4; k++)
                to[8 + (k < 2 ? k : k + 1) * size + i] = row[own[k]] - (share != 0.0 ? share * other[own[k]] : 0.0);
            to[8 + 2 * size + i] = share;
        }
        if (fits) *to = q;
    }
    for (int k = 0; k < 5 * size; k++) to[8 + 5 * size + k] = fabs(to[8 + k]);
    return *to;
}

/* The tables of one system, each at its place of `to`, from [A f c] and the rows [C d e], with so many fast modes. Returns
   the halvings of a step so that power series converge; -1 if the motion overflows within it. */
static int prepare(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory,
                   const ptrdiff_t *places, double *to) {
    const Room given = room_for(s, memory), *r = &given;
    const int n = s->n, w = r->w, m = s->outputs, R = s->rows, parts = s->parts, columns = n + AHEAD + 2;
    const double h = s->h;
    double driven[MAX_STATES], *moves = r->found, *cap = r->most, *here = r->here, *step = r->step;
    memset(memory, 0, sizeof *memory * r->size);
    set_rows(n, n + 2, w, rates, r->rates), set_rows(R, n + 2, w, rows, r->rows), set_rows(R, n + 2, w, rows, r->centre);
    for (int i = 0; i < n; i++) {
        memcpy(r->slow + i * w, r->rates + i * w, sizeof *rates * n);
        for (int j = 0; j < n; j++) r->G[i * w + j] = h * r->rates[i * w + j];
        driven[i] = r->rates[i * w + n], moves[i * w + i] = 1.0;
    }
    const double turns = spectral_radius_bound(r, r->G);
    if (count) part(s, r, count, modes, driven, moves, cap);
    multiply(parts, n, n + 2, w, moves, r->rates, here);
    lay(parts, n + 2, w, here, to + places[2]);
    if (parts > n) lay(R, parts + 2, w, cap, to + places[7]);

    for (int i = 0; i < n * w; i++) here[i] = h * fabs(r->slow[i]);
    const int squared = halvings_of(turns, 1.0), most = halvings_of(spectral_radius_bound(r, here), 1.0);
    const int fine = most < FINEST ? most : FINEST, halvings = count || squared > fine ? squared : fine;
    for (int i = 0; i < n; i++) r->G[i * w + n] = h * r->rates[i * w + n], r->G[i * w + n + 2] = h * r->rates[i * w + n + 1];
    r->G[n * w + n + 1] = 1.0;
    exponentials_less_identity(r, n + 3, r->G, halvings + !count, fine + 1, r->change);
    int endless = 0;
    for (int i = 0; i < n; i++) {
        memcpy(step + i * w, r->change[0] + i * w, sizeof *step * (n + 3));
        step[i * w + n] -= step[i * w + n + 1];
        for (int j = 0; j < n + 3; j++) endless |= !isfinite(step[i * w + j]);
    }
    if (endless) return -1;
    if (count) {
        scale(n, w, h, r->slow, r->G);
        memset(r->G + n * w, 0, sizeof *step * (up8(n + 3) - n) * w);
        exponentials_less_identity(r, n, r->G, fine + 1, fine + 1, r->change);
    }
    lay(n, n + 3, w, step, to + places[1]);
    for (int k = 0; k < AHEAD; k++) {
        multiply(n, n, columns, w, step, r->later[k], r->later[k + 1]);
        for (int i = 0; i < n; i++) {
            double *next = r->later[k + 1] + i * w;
            for (int j = 0; j < columns; j++) next[j] += r->later[k][i * w + j] + (j < n ? step[i * w + j] : 0.0);
            next[n + k] += step[i * w + n], next[n + k + 1] += step[i * w + n + 1], next[columns - 1] += step[i * w + n + 2];
        }
    }
    for (int k = 0; k < AHEAD; k++) rows_later(r, R, r->rows, k + 1, here + k * R * w);
    by_row(R, AHEAD, AHEAD, w, here, r->after);
    memcpy(r->after + up8(AHEAD * R) * w, r->later[AHEAD], sizeof *here * n * w);
    lay(up8(AHEAD * R) + n, columns, w, r->after, to + places[0]);
    multiply(R, n, n + 2, w, r->rows, r->rates, r->found);
    const double *ends[] = {r->found, r->centre};
    for (int q = 0; q < 1 + (parts > n); q++) {
        for (int k = 0; k <= AHEAD; k++) rows_later(r, R, ends[q], k, here + k * R * w);
        by_row(R, AHEAD + 1, 8, w, here, r->after);
        for (int j = 0; j < R; j++)
            lay(8, columns, w, r->after + (size_t)j * 8 * w, to + places[q ? 8 : 5] + (size_t)j * 8 * columns);
    }

    const int skipped = s->shift + (border(s, r, to + places[14]) == DENSE ? 0 : s->shift), now = n - skipped + R - m;
    memcpy(here, r->rates + skipped * w, sizeof *here * (n - skipped) * w);
    memcpy(here + (n - skipped) * w, r->rows + m * w, sizeof *here * (R - m) * w);
    if (skipped > s->shift)
        for (int i = 0; i < now; i++) {
            if (i < 7) to[places[14] + 1 + i] = sole_state(n, here + i * w);
            memcpy(to + places[3] + i * up8(n + 2), here + i * w, sizeof *to * (n + 2));
        }
    else
        lay(now, n + 2, w, here, to + places[3]);
    lay(m, n + 2, w, r->rows, to + places[4]);
    lay(R, 1, w, r->rows + n, to + places[11]);
    for (int i = 0; i < places[4] - places[3]; i++) to[places[12] + i] = fabs(to[places[3] + i]);
    for (int i = 0; i < up8(m) * (n + 2); i++) to[places[13] + i] = fabs(to[places[4] + i]);

    bound_derivatives(s, r, driven, fine);
    double *jolt = r->after + 2 * R * w;
    for (int i = 0; i < R * w; i++) r->sway[i] += r->after[R * w + i];
    for (int i = 0; count && i < (R - m) * w; i++) jolt[i] = VAGUE;
    lay(R, parts + 2, w, r->after, to + places[6]), lay(R, parts + 2, w, r->sway, to + places[9]);
    lay(R - m, parts + 2, w, jolt, to + places[10]);
    return halvings_of(turns, LONGEST);
}
