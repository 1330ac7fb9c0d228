
int rotation(double time, double attitude[4], double angular_velocity[3])
{
    const double high = time - EPOCH;
    /* The rounding error of the difference (Knuth). */
    const double virtual_epoch = time - high;
    const double low = (time - (high + virtual_epoch)) + (virtual_epoch - EPOCH);
    double sine, cosine, sums[4], upper, lower, norm, root, relative[4], momentum[3];
    int n;
    if (!(high >= -BOUND && high <= BOUND))
        return 0;
    circle(ANOMALY, high, low, &sine, &cosine);
    pair(sine, cosine, sums);
    upper = sums[0] * sums[0] + sums[1] * sums[1];
    lower = sums[2] * sums[2] + sums[3] * sums[3];
    norm = upper + lower;
    momentum[0] = 2.0 * (sums[2] * sums[1] - sums[3] * sums[0]) / norm;
    momentum[1] = 2.0 * (sums[2] * sums[0] + sums[3] * sums[1]) / norm;
    momentum[2] = (upper - lower) / norm;
    circle(HALF_LONGITUDE, high, low, &sine, &cosine);
    root = sqrt(norm);
    sine /= root;
    cosine /= root;
    relative[0] = sums[2] * cosine - sums[3] * sine;
    relative[1] = sums[2] * sine + sums[3] * cosine;
    relative[2] = sums[0] * sine + sums[1] * cosine;
    relative[3] = sums[0] * cosine - sums[1] * sine;
    for (n = 0; n < 4; n++)
        attitude[n] = ATTITUDE[n][0] * relative[0] + ATTITUDE[n][1] * relative[1]
            + ATTITUDE[n][2] * relative[2] + ATTITUDE[n][3] * relative[3];
    for (n = 0; n < 3; n++)
        angular_velocity[n] = RATES[n][0] * momentum[0] + RATES[n][1] * momentum[1] + RATES[n][2] * momentum[2];
    return 1;
}
