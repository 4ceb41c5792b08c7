/* A step of a Runge-Kutta pair, for `march.c`: sums of stages, the error of a step, and its polynomial. */

enum { FEW = 8 }; /* states */

/* out = start + h Σ weights[k] rates[which[k]], the newest stage last; start may be null. Of a few states the newest rates
   are read one by one (hence volatile), as they were written: a vector could not be loaded before all of it has reached
   the cache. */
static void combine(int count, int terms, const int *which, const double *weights, double h, const double *start,
                    const double *rates, int width, double *out) {
    const int older = count <= FEW ? terms - 1 : terms;
    for (int i = 0; i < count; i += LANES) {
        vec sum = {0};
        for (int k = 0; k < older; k++) sum += at(rates + (size_t)which[k] * width + i) * weights[k];
        sum = start ? at(start + i) + sum * h : sum * h;
        if (i + LANES <= count)
            put(out + i, sum);
        else
            for (int j = 0; i + j < count; j++) out[i + j] = sum[j];
    }
    if (older < terms) {
        const volatile double *newest = rates + (size_t)which[older] * width;
        const double weight = h * weights[older];
        for (int i = 0; i < count; i++) out[i] += weight * newest[i];
    }
}

/* The sums of the squares of two error estimates over the sizes of the states, of which each has a least one. */
static void errors(int count, const double *coarse, const double *fine, const double *size, const double *y,
                   const double *end, const double *floor, double *out) {
    vec third = {0}, fifth = {0};
    out[0] = out[1] = 0.0;
    for (int i = 0; i < count; i += LANES) {
        vec most = larger(larger(at(size + i), at(floor + i)), larger(absolute(at(y + i)), absolute(at(end + i))));
        vec one = at(coarse + i) / most, other = at(fine + i) / most;
        third += one * one, fifth += other * other;
    }
    for (int j = 0; j < LANES; j++) out[0] += third[j], out[1] += fifth[j];
}

/* The coefficients of the polynomial over a step h, of degree 7, in rows of a series: from u (F_0 + v (F_1 + u (F_2 + v
   (F_3 + u (F_4 + v (F_5 + u F_6)))))), v = 1 - u, with F_3 to F_6 in the rows `bends`. */
static void powers(int count, double h, const double *y, const double *end, const double *first, const double *last,
                   const double *bends, int stride, int width, double *series) {
    for (int i = 0; i < count; i++) {
        double f0 = end[i] - y[i], f1 = h * first[i] - f0, f2 = 2.0 * f0 - h * (first[i] + last[i]);
        double f3 = bends[i], f4 = bends[stride + i], f5 = bends[2 * stride + i], f6 = bends[3 * stride + i];
        double b0 = f4 + f5, b1 = f6 - f5, b2 = -f6;                       /* F_4 + v (F_5 + u F_6) */
        double d0 = f2 + f3, d1 = b0 - f3, d2 = b1 - b0, d3 = b2 - b1, d4 = -b2; /* F_2 + v (F_3 + u (..)) */
        series[i] = y[i];
        series[width + i] = h * first[i];
        series[2 * width + i] = d0 - f1;
        series[3 * width + i] = d1 - d0;
        series[4 * width + i] = d2 - d1;
        series[5 * width + i] = d3 - d2;
        series[6 * width + i] = d4 - d3;
        series[7 * width + i] = -d4;
    }
}
