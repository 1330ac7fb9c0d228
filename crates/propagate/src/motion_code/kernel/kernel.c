
/* Adding and subtracting 1.5 * 2^52 rounds to the nearest integer. */
static double nearest(double x)
{
    return (x + 6755399441055744.0) - 6755399441055744.0;
}

/* Sine and cosine of a phase. Only the reduction in turns is to 32 digits; it is exact where numbers cancel. */
static void circle(const double phase[5], double high, double low, double *sine, double *cosine)
{
    const double first = phase[0], second = phase[1], third = phase[2];
    const double product = (first + second) * high;
#ifdef FP_FAST_FMA
    const double error = fma(first + second, high, -product);
#else
    /* The time in two halves (Veltkamp), and the rounding error of the product (Dekker). */
    const double scaled = 134217729.0 * high;
    const double upper = scaled - (scaled - high);
    const double lower = high - upper;
    const double error = ((first * upper - product) + first * lower + second * upper) + second * lower;
#endif
    const double rest = (first + second) * low + (third * high + (error + phase[4]));
    const double fraction = product - nearest(product);
    const double quarters = nearest(4.0 * (phase[3] + (fraction + rest)));
    const double x = ((phase[3] - 0.25 * quarters) + fraction) + rest;
    /* Minimax polynomials for |x| <= 1/8. */
    const double s = x * x;
    double p = ((((3.7794529249619515 * s - 15.093736267536418) * s + 42.05868379747909) * s
        - 76.70585969420165) * s + 81.60524927591186) * s - 41.3417022403996;
    double q = (((((-1.6862683429441374 * s + 7.902528501565459) * s - 26.42623923109041) * s
        + 60.244641210418315) * s - 85.45681720592083) * s + 64.93939402266658) * s - 19.739208802178716;
    p = x * 6.283185307179586 + x * (s * p + 2.4492935982947064e-16);
    q = 1.0 + s * q;
    switch ((int)quarters & 3) {
    case 0: *sine = p; *cosine = q; break;
    case 1: *sine = q; *cosine = -p; break;
    case 2: *sine = -p; *cosine = -q; break;
    default: *sine = -q; *cosine = p; break;
    }
}
