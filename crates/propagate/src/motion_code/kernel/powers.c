
/* Re a, Im a, Re b and Im b by Horner's rule in cos 2l'. */
static void pair(double sine, double cosine, double sums[4])
{
    const double double_cosine = 1.0 - 2.0 * sine * sine;
    int k, n;
    for (n = 0; n < 4; n++)
        sums[n] = 0.0;
    for (k = (int)(sizeof TERMS / sizeof TERMS[0]) - 1; k >= 0; k--)
        for (n = 0; n < 4; n++)
            sums[n] = sums[n] * double_cosine + TERMS[k][n];
    sums[1] *= 2.0 * sine * cosine;
    sums[2] *= cosine;
    sums[3] *= sine;
}
