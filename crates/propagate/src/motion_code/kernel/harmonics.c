
/* Re a, Im a, Re b and Im b by a rotation from each multiple of 2l' to the next. */
static void pair(double sine, double cosine, double sums[4])
{
    const double double_sine = 2.0 * sine * cosine, double_cosine = 1.0 - 2.0 * sine * sine;
    double c = 1.0, s = 0.0, ar = 0.0, ai = 0.0, b_cosine = 0.0, b_sine = 0.0, odd_cosine = 0.0, odd_sine = 0.0;
    int k;
    for (k = 0; k < (int)(sizeof TERMS / sizeof TERMS[0]); k++) {
        const double next = c * double_cosine - s * double_sine;
        ar += TERMS[k][0] * c;
        ai += TERMS[k][1] * s;
        b_cosine += TERMS[k][2] * c;
        odd_sine += TERMS[k][2] * s;
        odd_cosine += TERMS[k][3] * c;
        b_sine += TERMS[k][3] * s;
        s = s * double_cosine + c * double_sine;
        c = next;
    }
    sums[0] = ar;
    sums[1] = ai;
    sums[2] = b_cosine * cosine - odd_sine * sine;
    sums[3] = b_sine * cosine + odd_cosine * sine;
}
