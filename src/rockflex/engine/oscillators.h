/* The march of eight linear oscillators at once, for `march.c`: each waits for its own last sample, not for the others. */

enum { VECS = TOGETHER / LANES };

/* Fill displacements us and velocities vs, eight of each sample, from a sample to another one, and raise the peaks to those
   at samples. The change of the state is summed, not the state: over thousands of steps that rounds less. */
static void oscillate(const double *a, ptrdiff_t first, ptrdiff_t last, double *factors, double *us, double *vs) {
#pragma GCC unroll 4
    for (int part = 0; part < VECS; part++) {
        const double *f = factors + part * LANES;
        double *u_at = us + part * LANES, *v_at = vs + part * LANES;
        const vec uu = at(f + UU * TOGETHER), uv = at(f + UV * TOGETHER), u0 = at(f + U0 * TOGETHER);
        const vec u1 = at(f + U1 * TOGETHER), vu = at(f + VU * TOGETHER), vv = at(f + VV * TOGETHER);
        const vec v0 = at(f + V0 * TOGETHER), v1 = at(f + V1 * TOGETHER);
        vec u = at(u_at + first * TOGETHER), v = at(v_at + first * TOGETHER);
        vec sd = at(f + SD * TOGETHER), sv = at(f + SV * TOGETHER);
        for (ptrdiff_t k = first; k < last; k++) {
            const vec change = (uv * v - (u0 * a[k] + u1 * a[k + 1])) - uu * u;
            v -= (vv * v + (v0 * a[k] + v1 * a[k + 1])) + vu * u;
            u += change;
            put(u_at + (k + 1) * TOGETHER, u), put(v_at + (k + 1) * TOGETHER, v);
            sd = larger(sd, absolute(u)), sv = larger(sv, absolute(v));
        }
        put(factors + SD * TOGETHER + part * LANES, sd), put(factors + SV * TOGETHER + part * LANES, sv);
    }
}

/* Fill a row of `room` places for each oscillator: how many there are, and the samples after which it may exceed its peaks.
   Between two samples |u''| is not larger than that of a free vibration with its values at the first one. */
static void exceed(const double *a, double h, ptrdiff_t first, ptrdiff_t last, const double *factors, const double *us,
                   const double *vs, ptrdiff_t room, ptrdiff_t *places) {
    const double bend = h * h / 8.0;
    for (int j = 0; j < TOGETHER; j++) places[j * room] = 0;
    for (int part = 0; part < VECS; part++) {
        const double *f = factors + part * LANES, *u_at = us + part * LANES, *v_at = vs + part * LANES;
        const vec square = at(f + SQUARE * TOGETHER), drag = at(f + DRAG * TOGETHER), sway = at(f + SWAY * TOGETHER);
        const vec spread = at(f + SPREAD * TOGETHER), sd = at(f + SD * TOGETHER), sv = at(f + SV * TOGETHER);
        vec u = absolute(at(u_at + first * TOGETHER)), v = absolute(at(v_at + first * TOGETHER));
        for (ptrdiff_t k = first; k < last; k++) {
            const vec here = at(u_at + k * TOGETHER), speed = square * at(v_at + k * TOGETHER);
            const vec w = -(a[k] + drag * at(v_at + k * TOGETHER) + square * here);
            const vec size = absolute(w) + spread * absolute((a[k + 1] - a[k]) / h + 0.5 * drag * w + speed);
            const vec u_next = absolute(at(u_at + (k + 1) * TOGETHER)), v_next = absolute(at(v_at + (k + 1) * TOGETHER));
            const mask over = ~((larger(u, u_next) + size * bend <= sd) & (larger(v, v_next) + size * sway <= sv));
            u = u_next, v = v_next;
            if (any(over))
                for (int j = 0; j < LANES; j++) {
                    ptrdiff_t *row = places + (part * LANES + j) * room;
                    if (over[j]) row[++row[0]] = k;
                }
        }
    }
}
