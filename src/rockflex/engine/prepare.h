/* The tables of a phase for one time step, of one system at a time: what `tables.py` says in NumPy. Part of `march.c`.

   A matrix here has its rows `w` doubles apart, and zeros below and beside it, to multiples of 4 and of 8. */

enum { FINEST = 8, FEWEST = 10, MOST_TERMS = 60, WAYS = 2 * BLOCK }; /* as in `tables.py`; places of the grid of h/2 */
static const double LONGEST = 2.5, FAST = 4.0, POOR = 1e4, SMALL = 1e-18, VAGUE = 1e300;

typedef struct { /* room for the tables of one system: square matrices, and larger ones */
    int n, w;
    size_t size; /* of all, in doubles */
    double *G, *X, *term, *next, *slow, *step, *grown, *rates, *push[2], *change[FINEST + 2], *later[AHEAD + 1];
    double *rows, *found, *most, *here, *after, *centre, *sway;
} Room;

static Room room_for(const Shape *s, double *memory) {
    const int bounds = 2 * s->inputs + s->parts;
    Room r = {.n = s->n, .w = up8(bounds > s->n + AHEAD + 2 ? bounds : s->n + AHEAD + 2)};
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
static double turn(const Shape *s, const double *A, double *memory) {
    Room r = room_for(s, memory);
    memset(r.G, 0, sizeof *memory * (size_t)r.w * up8(s->n + 3));
    set_rows(s->n, s->n, r.w, A, r.G);
    scale(s->n, r.w, s->h, r.G, r.G);
    return spectral_radius_bound(&r, r.G);
}

typedef struct { /* of a root; columns and rows V and W, real and imaginary parts apart; two that are conjugate count as one */
    double re, im, root, both;
    const double *v, *vi, *u, *ui;
} Mode;

static Mode mode_at(int n, const double *modes, int k) {
    const double *m = modes + (size_t)k * (2 + 4 * n);
    return (Mode){m[0], m[1], hypot(m[0], m[1]), m[1] > 0.0 ? 2.0 : 1.0, m + 2, m + 2 + n, m + 2 + 2 * n, m + 2 + 3 * n};
}

/* Columns of the amplitudes of so many modes: two where they are complex. */
static int amplitudes(int n, const double *modes, int count) {
    int found = count;
    for (int k = 0; k < count; k++) found += mode_at(n, modes, k).im > 0.0;
    return found;
}

/* The modes that can be parted from the others to rounding, in `modes`. Given are all roots, real parts and then imaginary
   ones, and all vectors, the real and the imaginary part in place of two that are conjugate. Returns their number. */
static int modes_of(const Shape *s, const double *A, const double *roots, const double *vectors, double *memory,
                    double *modes) {
    const Room r = room_for(s, memory);
    const int n = s->n, w = r.w;
    const double *real = roots, *imaginary = roots + n;
    double *inverse = r.after;
    int count = 0;
    set_rows(n, n, w, vectors, inverse);
    if (!invert(n, w, inverse)) return 0;
    for (int k = 0; k < n; k++) {
        if (imaginary[k] < 0.0) continue;
        const int pair = imaginary[k] > 0.0;
        double *mode = modes + (size_t)count * (2 + 4 * n), sum = 0.0, most = 0.0, wrong = 0.0;
        mode[0] = real[k], mode[1] = imaginary[k], mode += 2;
        for (int i = 0; i < n; i++) {
            mode[i] = vectors[i * n + k], mode[n + i] = pair ? vectors[i * n + k + 1] : 0.0;
            mode[2 * n + i] = inverse[k * w + i] * (pair ? 0.5 : 1.0);
            mode[3 * n + i] = pair ? -0.5 * inverse[(k + 1) * w + i] : 0.0;
            sum += hypot(mode[i], mode[n + i]) * hypot(mode[2 * n + i], mode[3 * n + i]);
        }
        for (int j = 0; j < n; j++) { /* where others are nearly alike, the rows of the inverse may be wrong */
            const double *u = mode + 2 * n, *ui = u + n;
            double left = imaginary[k] * ui[j] - real[k] * u[j], other = -real[k] * ui[j] - imaginary[k] * u[j], all = 0.0;
            for (int i = 0; i < n; i++) {
                const double entry = A[i * n + j];
                left += u[i] * entry, other += ui[i] * entry, all += hypot(u[i], ui[i]) * fabs(entry);
            }
            wrong = fmax(wrong, hypot(left, other)), most = fmax(most, all);
        }
        count += sum < POOR && wrong <= 1e-11 * most;
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

/* The column of an input in `rates`: a, a_v, and a_v times each state that it multiplies. */
static int column_of(const Room *r, int input) { return r->n + (input ? input + 1 : 0); }

/* Part modes from y', so that y' = v + Σ V w, v' = A_s v + f_s a', w' = λ w + W f a': A_s, f_s for each input, what v and all
   w are made of, and what fast modes add to every row beside what changes linearly in a sample, all from y'. */
static void part(const Shape *s, const Room *r, int count, const double *modes, double *driven, double *moves, double *swing) {
    const int n = s->n, w = r->w;
    const int some = amplitudes(n, modes, count) < n; /* is not parted; what is left otherwise is rounding */
    int place = s->slow;
    for (int i = 0; i < n && some; i++) {
        memcpy(r->slow + i * w, r->rates + i * w, sizeof *moves * n);
        moves[i * w + i] = 1.0;
    }
    for (int k = 0; k < count; k++) {
        const Mode m = mode_at(n, modes, k);
        for (int i = 0; i < n && some; i++) {
            const double turned = m.re * m.v[i] - m.im * m.vi[i], other = m.re * m.vi[i] + m.im * m.v[i];
            for (int j = 0; j < n; j++) {
                moves[i * w + j] -= m.both * (m.v[i] * m.u[j] - m.vi[i] * m.ui[j]);
                r->slow[i * w + j] -= m.both * (turned * m.u[j] - other * m.ui[j]);
            }
        }
        memcpy(moves + place++ * w, m.u, sizeof *moves * n);
        if (m.im > 0.0) memcpy(moves + place++ * w, m.ui, sizeof *moves * n);
        for (int j = 0; j < s->rows && swing && m.root * s->h > FAST; j++) {
            const double *row = r->rows + j * w, share = m.both / (m.root * m.root);
            double seen[2] = {0.0, 0.0};
            for (int i = 0; i < n; i++) seen[0] += row[i] * m.v[i], seen[1] += row[i] * m.vi[i];
            const double x = share * (seen[0] * m.re + seen[1] * m.im), z = share * (seen[1] * m.re - seen[0] * m.im);
            for (int i = 0; i < n; i++) swing[j * w + i] += x * m.u[i] - z * m.ui[i];
        }
    }
    for (int q = 0; q < s->inputs; q++)
        for (int i = 0; i < n && some; i++) {
            double sum = 0.0;
            for (int j = 0; j < n; j++) sum += moves[i * w + j] * r->rates[j * w + column_of(r, q)];
            driven[q * n + i] = sum;
        }
}

typedef struct { /* the bounds of one order of derivatives: of the rows from the first one on, in `after` from `place` on */
    int order, first, count, place;
    double factor;
} Bound;

/* Of h²/8 |r''| and h³/96 |r'''| of all rows, of h⁴/384 |r''''| of conditions, and of |r'| of the states that a_v multiplies,
   which are the last rows. Returns the number of all. */
static int bounds_of(const Shape *s, Bound *b) {
    const int R = s->rows, m = s->outputs, fed = s->inputs > 1 ? s->inputs - 2 : 0;
    const double h = s->h;
    b[0] = (Bound){2, 0, R, 0, h * h / 8.0}, b[1] = (Bound){3, 0, R, R, h * h * h / 96.0};
    b[2] = (Bound){4, m, R - m, 2 * R, h * h * h * h / 384.0}, b[3] = (Bound){1, R - fed, fed, 3 * R - m, 1.0};
    return 3 * R - m + fed;
}

/* The factors of inputs and of |v| in these bounds. With r'' = C A v + C f a', r''' = C A² v + C A f a' and so on, they are
   at most |C A e^{At}| |v(0)| and so on; between the places of a grid of h/2 the matrices grow at most by `bound_growth`,
   entry by entry. Each input has two columns, of its variation in a block and of its largest slope; those of v follow. */
static void bound_slow(const Shape *s, const Room *r, int some, const double *driven, int fine) {
    const int n = s->n, w = r->w, first = 2 * s->inputs;
    Bound all[4];
    const int count = bounds_of(s, all);
    double *here = r->here, *most = r->most, *after = r->after, *seen = r->found;
    memset(after, 0, sizeof *after * up8(count) * w);
    if (!some) return;
    for (int k = 0; k < 3; k++) { /* rows times A, A² and A³ */
        const double *from = k ? here + (all[k - 1].place + all[k].first - all[k - 1].first) * w : r->rows;
        multiply(all[k].count, n, n, w, from, r->slow, here + all[k].place * w);
        for (int i = 0; i < all[k].count; i++)
            for (int q = 0; q < s->inputs; q++) {
                double sum = 0.0;
                for (int j = 0; j < n; j++) sum += from[i * w + j] * driven[q * n + j];
                seen[(all[k].place + i) * w + q] = fabs(sum);
            }
    }
    for (int i = 0; i < all[3].count; i++) {
        memcpy(here + (all[3].place + i) * w, r->rows + (all[3].first + i) * w, sizeof *here * n);
        memset(seen + (all[3].place + i) * w, 0, sizeof *seen * s->inputs);
    }
    for (int i = 0; i < count * w; i += LANES) put(most + i, absolute(at(here + i)));
    for (int k = 1; k < WAYS; k++) {
        multiply(count, n, n, w, here, r->change[1], after);
        for (int i = 0; i < count * w; i += LANES) {
            vec value = at(here + i) + at(after + i);
            put(here + i, value), put(most + i, larger(at(most + i), absolute(value)));
        }
    }
    bound_growth(r, s->h, fine);
    multiply(count, n, n, w, most, r->grown, here);
    memset(after, 0, sizeof *after * up8(count) * w);
    for (int b = 0; b < 4; b++)
        for (int i = all[b].place; i < all[b].place + all[b].count; i++) {
            double *row = after + i * w;
            for (int j = 0; j < n; j++) row[first + j] = here[i * w + j] * all[b].factor;
            for (int q = 0; q < s->inputs; q++) {
                row[2 * q + 1] = seen[i * w + q] * all[b].factor;
                for (int j = 0; j < n; j++) row[2 * q] += row[first + j] * fabs(driven[q * n + j]);
            }
        }
}

/* Add those of the modes, whose amplitudes grow by the inputs' variation or, if they fade soon, by their slopes. What fast
   modes add to a row never gets further from its chord in a sample than 2 |C V/λ| |w|: this goes to `cap`, if that is given. */
static void bound_modes(const Shape *s, const Room *r, int count, const double *modes, double *cap) {
    const int n = s->n, w = r->w;
    int place = 2 * s->inputs + s->slow;
    Bound all[4];
    bounds_of(s, all);
    for (int k = 0; k < count; k++) {
        const Mode m = mode_at(n, modes, k);
        const double fades = m.re < 0.0 ? -m.re : 0.0, span = BLOCK * s->h;
        double push[2 + MAX_FED];
        for (int q = 0; q < s->inputs; q++) {
            double drive[2] = {0.0, 0.0};
            for (int i = 0; i < n; i++) {
                const double f = r->rates[i * w + column_of(r, q)];
                drive[0] += m.u[i] * f, drive[1] += m.ui[i] * f;
            }
            push[q] = hypot(drive[0], drive[1]);
        }
        for (int j = 0; j < s->rows; j++) {
            double seen[2] = {0.0, 0.0};
            for (int i = 0; i < n; i++) seen[0] += r->rows[j * w + i] * m.v[i], seen[1] += r->rows[j * w + i] * m.vi[i];
            const double size = m.both * hypot(seen[0], seen[1]) * exp((m.re > 0.0 ? m.re : 0.0) * span);
            for (int b = 0; b < 4; b++) {
                const int i = j - all[b].first, order = all[b].order, capped = cap && order == 2 && m.root * s->h > FAST;
                if (i < 0 || i >= all[b].count) continue;
                double *row = capped ? cap + j * w : r->after + (all[b].place + i) * w;
                const double once = capped ? 2.0 * size / m.root : all[b].factor * size * pow(m.root, order - 1);
                row[place] += once;
                if (m.im > 0.0) row[place + 1] += once;
                for (int q = 0; q < s->inputs; q++) {
                    if (fades * span > 1.0 && !(order == 1 && q > 1)) /* |y'| bounds the slope of what a_v multiplies */
                        row[2 * q + 1] += once * push[q] / fades;
                    else
                        row[2 * q] += once * push[q];
                    if (order > 1 && !capped) row[2 * q + 1] += all[b].factor * size * pow(m.root, order - 2) * push[q];
                }
            }
        }
        place += m.im > 0.0 ? 2 : 1;
    }
    for (int i = 0; i < bounds_of(s, all) * w; i++) /* NaN is vague, too */
        r->after[i] = r->after[i] < VAGUE ? r->after[i] : VAGUE;
}

/* How fine the grid must be between which bounds allow for the growth of v. */
static int fineness(const Shape *s, const Room *r) {
    for (int i = 0; i < s->n * r->w; i++) r->here[i] = s->h * fabs(r->slow[i]);
    const int most = halvings_of(spectral_radius_bound(r, r->here), 1.0);
    return most < FINEST ? most : FINEST;
}

/* The exponentials of what is left where modes are parted. */
static void slow_exponentials(const Shape *s, const Room *r, int fine) {
    memset(r->G, 0, sizeof *r->G * up8(s->n + 3) * r->w);
    scale(s->n, r->w, s->h, r->slow, r->G);
    exponentials_less_identity(r, s->n, r->G, fine + 1, fine + 1, r->change);
}

/* What `Shaken` bounds rows by: the parts of y', and from the tables' rates and rows, with the states that a_v multiplies as
   further rows, the factors of inputs and parts. */
static void bound(const Shape *s, const double *rates, const double *rows, int count, const double *modes, double *memory,
                  double *moves, double *to) {
    const Room given = room_for(s, memory), *r = &given;
    const int n = s->n, w = r->w, columns = n + 1 + s->inputs, width = 2 * s->inputs + s->parts;
    double driven[MAX_STATES * (2 + MAX_FED)];
    Bound all[4];
    memset(memory, 0, sizeof *memory * r->size);
    set_rows(n, columns, w, rates, r->rates), set_rows(s->rows, n, w, rows, r->rows);
    part(s, r, count, modes, driven, r->found, 0);
    multiply(s->parts, n, columns, w, r->found, r->rates, r->here);
    for (int i = 0; i < s->parts; i++) memcpy(moves + (size_t)i * columns, r->here + i * w, sizeof *moves * columns);
    const int fine = fineness(s, r);
    const int some = amplitudes(n, modes, count) < n;
    if (some) slow_exponentials(s, r, fine);
    bound_slow(s, r, some, driven, fine);
    bound_modes(s, r, count, modes, 0);
    for (int i = 0; i < bounds_of(s, all); i++) memcpy(to + (size_t)i * width, r->after + i * w, sizeof *to * width);
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
    double driven[MAX_STATES], *moves = r->found, *cap = r->sway, *here = r->here, *step = r->step;
    memset(memory, 0, sizeof *memory * r->size);
    set_rows(n, n + 2, w, rates, r->rates), set_rows(R, n + 2, w, rows, r->rows), set_rows(R, n + 2, w, rows, r->centre);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) r->G[i * w + j] = h * r->rates[i * w + j];
    const double turns = spectral_radius_bound(r, r->G);
    part(s, r, count, modes, driven, moves, r->most);
    multiply(parts, n, n + 2, w, moves, r->rates, here);
    lay(parts, n + 2, w, here, to + places[2]);
    if (s->capped) {
        multiply(R, n, n + 2, w, r->most, r->rates, r->after);
        for (int i = 0; i < R * w; i++) r->centre[i] -= r->after[i];
    }
    const int squared = halvings_of(turns, 1.0), fine = fineness(s, r), halvings = count || squared > fine ? squared : fine;
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
    const int some = amplitudes(n, modes, count) < n;
    if (count && some) slow_exponentials(s, r, fine);
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
    for (int q = 0; q < 1 + s->capped; q++) {
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

    bound_slow(s, r, some, driven, fine);
    bound_modes(s, r, count, modes, s->capped ? cap : 0);
    if (s->capped) lay(R, parts + 2, w, cap, to + places[7]);
    lay(R, parts + 2, w, r->after, to + places[6]), lay(R, parts + 2, w, r->after + R * w, to + places[9]);
    lay(R - m, parts + 2, w, r->after + 2 * R * w, to + places[10]);
    return halvings_of(turns, LONGEST);
}
