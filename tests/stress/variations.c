/* Derivatives of a rotation with respect to the parameters of its torques: the variational equations in long doubles, by the midpoint rule of Gragg and Bulirsch, extrapolated to order 14 (Hairer, Norsett, Wanner 1993, II.9), with
   steps of one length. Parts of 2, 4, 6, 8, 10, … would multiply rounding errors by some thousands.

   In: inertia tensor (9), attitude (x y z w), rates (3); number of bodies, and the orbit of each; number of sources, and for each its kind (0 a direction, 1 an orbit, 2 the field of a dipole), power, reference distance and place: a
   direction (3), an orbit, or an orbit with the radius, the field on the equator, the axis (3) and its rate; number of columns; the terms of the torque and those that each column multiplies; step, number of times, times.
   An orbit is rate, eccentricity, time of the pericentre, inclination, node, argument of the pericentre, semi-major axis, attraction. Terms are their number, and for each the component (0 to 2), the coefficient,
   the exponents of the rates (3), the number of its sources, and for each its number and the exponents of its direction (3). Out: for each time and column a rotation vector about body axes and a change of the rates. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ORDERS 7
#define MOST_SOURCES 4
#define MOST_COLUMNS 80

typedef long double Real;
typedef struct { Real rate, eccentricity, pericentre, inclination, node, argument, size, attraction; } Orbit;
typedef struct { int kind; Real power, reference, direction[3], radius, equatorial, axis[3], turning; Orbit orbit; } Source;
typedef struct { int component, rates[3], count, source[MOST_SOURCES], exponents[MOST_SOURCES][3]; Real coefficient; } Term;
typedef struct { int count; Term *terms; } Sum;

static Real inertia[3][3], inverse[3][3];
static Orbit bodies[MOST_SOURCES];
static Source sources[MOST_SOURCES];
static Sum torque, forces[MOST_COLUMNS];
static int body_count, source_count, column_count;

static Real number(void) {
  Real value;
  if (scanf("%Lf", &value) != 1)
    exit(1);
  return value;
}

static int whole(void) { return (int)number(); }

static void cross(const Real *a, const Real *b, Real *out) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = a[j] * b[k] - a[k] * b[j];
  }
}

static Real dot(const Real *a, const Real *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void times(Real matrix[3][3], const Real *vector, Real *out) {
  for (int i = 0; i < 3; i++)
    out[i] = dot(matrix[i], vector);
}

static Real power(Real x, int exponent) {
  Real value = 1;
  while (exponent-- > 0)
    value *= x;
  return value;
}

/* The unit vector to a place on an orbit; the distance in semi-major axes is returned. */
static Real place(const Orbit *orbit, Real time, Real *unit) {
  Real mean = orbit->rate * (time - orbit->pericentre), e = orbit->eccentricity, anomaly = mean + e * sinl(mean);
  for (int n = 0; n < 12; n++)
    anomaly -= (anomaly - e * sinl(anomaly) - mean) / (1 - e * cosl(anomaly));
  Real x = cosl(anomaly) - e, y = sqrtl((1 - e) * (1 + e)) * sinl(anomaly), distance = 1 - e * cosl(anomaly);
  Real c = cosl(orbit->argument), s = sinl(orbit->argument), along = (c * x - s * y) / distance, across = (s * x + c * y) / distance;
  Real height = across * sinl(orbit->inclination);
  across *= cosl(orbit->inclination);
  c = cosl(orbit->node), s = sinl(orbit->node);
  unit[0] = c * along - s * across, unit[1] = s * along + c * across, unit[2] = height;
  return distance;
}

/* The unit vector of a source in the body's axes; the factor (r0/r)^p is returned. */
static Real towards(const Source *source, Real time, Real turn[3][3], Real *unit) {
  Real vector[3], distance = 1;
  if (source->kind == 0) {
    memcpy(vector, source->direction, sizeof vector);
  } else {
    Real r[3], from = place(&source->orbit, time, r) * source->orbit.size;
    memcpy(vector, r, sizeof vector);
    distance = from;
    if (source->kind == 2) {
      Real c = cosl(source->turning * time), s = sinl(source->turning * time), size = sqrtl(dot(source->axis, source->axis)), ratio = source->radius / from;
      Real moment[3] = {(c * source->axis[0] - s * source->axis[1]) / size, (s * source->axis[0] + c * source->axis[1]) / size, source->axis[2] / size};
      Real along = 3 * dot(moment, r), scale = source->equatorial * ratio * ratio * ratio;
      for (int i = 0; i < 3; i++)
        vector[i] = scale * (along * r[i] - moment[i]);
      distance = sqrtl(dot(vector, vector));
    }
  }
  Real size = sqrtl(dot(vector, vector));
  for (int i = 0; i < 3; i++)
    unit[i] = (turn[0][i] * vector[0] + turn[1][i] * vector[1] + turn[2][i] * vector[2]) / size;
  return source->power == 0 ? 1 : powl(source->reference / distance, source->power);
}

/* Adds the value of a sum of terms and, if there is room for them, its derivatives with respect to a turn about the body's axes and to the rates. */
static void add(const Sum *sum, Real units[][3], const Real *factors, const Real *rates, Real *value, Real by_turn[3][3], Real by_rates[3][3]) {
  for (int n = 0; n < sum->count; n++) {
    const Term *term = sum->terms + n;
    Real scale = term->coefficient, w = 1, u[MOST_SOURCES], whole = 1;
    for (int k = 0; k < 3; k++)
      w *= power(rates[k], term->rates[k]);
    for (int m = 0; m < term->count; m++) {
      scale *= factors[term->source[m]];
      u[m] = 1;
      for (int k = 0; k < 3; k++)
        u[m] *= power(units[term->source[m]][k], term->exponents[m][k]);
      whole *= u[m];
    }
    value[term->component] += scale * w * whole;
    if (!by_turn)
      continue;
    for (int k = 0; k < 3; k++) {
      if (term->rates[k] == 0)
        continue;
      Real slope = term->rates[k];
      for (int l = 0; l < 3; l++)
        slope *= power(rates[l], term->rates[l] - (l == k));
      by_rates[term->component][k] += scale * slope * whole;
    }
    for (int m = 0; m < term->count; m++) {
      const Real *unit = units[term->source[m]];
      Real slope[3], others = scale * w, turned[3];
      for (int o = 0; o < term->count; o++)
        others *= o == m ? 1 : u[o];
      for (int k = 0; k < 3; k++) {
        slope[k] = term->exponents[m][k];
        for (int l = 0; l < 3 && term->exponents[m][k]; l++)
          slope[k] *= power(unit[l], term->exponents[m][l] - (l == k));
      }
      /* δu = u × δθ. */
      cross(slope, unit, turned);
      for (int k = 0; k < 3; k++)
        by_turn[term->component][k] += others * turned[k];
    }
  }
}

/* The state is attitude, rates, and a turn and a change of the rates for each column. */
static void slope(Real time, const Real *state, Real *out) {
  const Real *w = state + 4;
  Real size = sqrtl(state[0] * state[0] + state[1] * state[1] + state[2] * state[2] + state[3] * state[3]);
  Real x = state[0] / size, y = state[1] / size, z = state[2] / size, s = state[3] / size;
  Real turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * s), 2 * (x * z + y * s)},
                     {2 * (x * y + z * s), 1 - 2 * (x * x + z * z), 2 * (y * z - x * s)},
                     {2 * (x * z - y * s), 2 * (y * z + x * s), 1 - 2 * (x * x + y * y)}};
  Real units[MOST_SOURCES][3], factors[MOST_SOURCES], total[3] = {0, 0, 0}, by_turn[3][3] = {{0}}, by_rates[3][3] = {{0}}, momentum[3], part[3];
  for (int k = 0; k < source_count; k++)
    factors[k] = towards(sources + k, time, turn, units[k]);
  add(&torque, units, factors, w, total, by_turn, by_rates);
  for (int b = 0; b < body_count; b++) {
    Source body = {.kind = 1, .power = 3, .reference = 1, .orbit = bodies[b]};
    body.orbit.size = 1;
    Real u[3], scale = 3 * bodies[b].attraction * towards(&body, time, turn, u), moved[3], other[3], image[3];
    times(inertia, u, image);
    cross(u, image, part);
    for (int i = 0; i < 3; i++)
      total[i] += scale * part[i];
    for (int k = 0; k < 3; k++) {
      Real unit[3] = {k == 0, k == 1, k == 2}, change[3];
      cross(u, unit, change);
      cross(change, image, moved);
      times(inertia, change, part);
      cross(u, part, other);
      for (int i = 0; i < 3; i++)
        by_turn[i][k] += scale * (moved[i] + other[i]);
    }
  }
  times(inertia, w, momentum);
  cross(w, momentum, part);
  for (int i = 0; i < 3; i++)
    total[i] -= part[i];
  for (int k = 0; k < 3; k++) {
    Real unit[3] = {k == 0, k == 1, k == 2}, one[3], other[3];
    cross(unit, momentum, one);
    times(inertia, unit, part);
    cross(w, part, other);
    for (int i = 0; i < 3; i++)
      by_rates[i][k] -= one[i] + other[i];
  }
  out[0] = 0.5L * (state[3] * w[0] - state[2] * w[1] + state[1] * w[2]);
  out[1] = 0.5L * (state[2] * w[0] + state[3] * w[1] - state[0] * w[2]);
  out[2] = 0.5L * (-state[1] * w[0] + state[0] * w[1] + state[3] * w[2]);
  out[3] = -0.5L * (state[0] * w[0] + state[1] * w[1] + state[2] * w[2]);
  times(inverse, total, out + 4);
  for (int c = 0; c < column_count; c++) {
    const Real *change = state + 7 + 6 * c;
    Real force[3] = {0, 0, 0};
    add(forces + c, units, factors, w, force, NULL, NULL);
    cross(change, w, out + 7 + 6 * c);
    for (int i = 0; i < 3; i++) {
      out[7 + 6 * c + i] += change[3 + i];
      force[i] += dot(by_turn[i], change) + dot(by_rates[i], change + 3);
    }
    times(inverse, force, out + 10 + 6 * c);
  }
}

static int size;

static void midpoint(Real time, const Real *state, Real length, int parts, Real *out) {
  Real step = length / parts, before[size], here[size], rate[size];
  memcpy(before, state, sizeof before);
  slope(time, state, rate);
  for (int i = 0; i < size; i++)
    here[i] = state[i] + step * rate[i];
  for (int n = 1; n < parts; n++) {
    slope(time + n * step, here, rate);
    for (int i = 0; i < size; i++) {
      Real next = before[i] + 2 * step * rate[i];
      before[i] = here[i];
      here[i] = next;
    }
  }
  slope(time + length, here, rate);
  for (int i = 0; i < size; i++)
    out[i] = 0.5L * (here[i] + before[i] + step * rate[i]);
}

static void advance(Real time, Real *state, Real length) {
  static const int parts[ORDERS] = {2, 4, 6, 8, 12, 16, 24};
  Real table[ORDERS][size];
  for (int j = 0; j < ORDERS; j++) {
    midpoint(time, state, length, parts[j], table[j]);
    for (int k = j - 1; k >= 0; k--) {
      Real ratio = (Real)parts[j] / parts[k], divisor = ratio * ratio - 1;
      for (int i = 0; i < size; i++)
        table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / divisor;
    }
  }
  memcpy(state, table[0], size * sizeof *state);
}

static Orbit read_orbit(void) {
  Orbit orbit;
  orbit.rate = number(), orbit.eccentricity = number(), orbit.pericentre = number(), orbit.inclination = number();
  orbit.node = number(), orbit.argument = number(), orbit.size = number(), orbit.attraction = number();
  return orbit;
}

static Sum read_sum(void) {
  Sum sum = {.count = whole()};
  if (!(sum.terms = calloc(sum.count + 1, sizeof *sum.terms)))
    exit(1);
  for (Term *term = sum.terms; term < sum.terms + sum.count; term++) {
    term->component = whole(), term->coefficient = number();
    for (int k = 0; k < 3; k++)
      term->rates[k] = whole();
    if ((term->count = whole()) > MOST_SOURCES)
      exit(1);
    for (int m = 0; m < term->count; m++) {
      term->source[m] = whole();
      for (int k = 0; k < 3; k++)
        term->exponents[m][k] = whole();
    }
  }
  return sum;
}

int main(void) {
  for (int i = 0; i < 9; i++)
    inertia[i / 3][i % 3] = number();
  for (int i = 0; i < 3; i++) {
    Real column[3], image[3];
    cross(inertia[(i + 1) % 3], inertia[(i + 2) % 3], column);
    times(inertia, column, image);
    for (int k = 0; k < 3; k++)
      inverse[k][i] = column[k] / image[i];
  }
  Real start[7];
  for (int i = 0; i < 7; i++)
    start[i] = number();
  if ((body_count = whole()) > MOST_SOURCES)
    return 1;
  for (int b = 0; b < body_count; b++)
    bodies[b] = read_orbit();
  if ((source_count = whole()) > MOST_SOURCES)
    return 1;
  for (Source *source = sources; source < sources + source_count; source++) {
    source->kind = whole(), source->power = number(), source->reference = number();
    if (source->kind)
      source->orbit = read_orbit();
    for (int k = 0; k < 3 && source->kind == 0; k++)
      source->direction[k] = number();
    if (source->kind == 2) {
      source->radius = number(), source->equatorial = number();
      for (int k = 0; k < 3; k++)
        source->axis[k] = number();
      source->turning = number();
    }
  }
  if ((column_count = whole()) > MOST_COLUMNS)
    return 1;
  torque = read_sum();
  for (int c = 0; c < column_count; c++)
    forces[c] = read_sum();
  size = 7 + 6 * column_count;
  Real longest = number(), time = 0;
  Real *state = calloc(size, sizeof *state), norm = sqrtl(start[0] * start[0] + start[1] * start[1] + start[2] * start[2] + start[3] * start[3]);
  if (!state)
    return 1;
  for (int i = 0; i < 7; i++)
    state[i] = i < 4 ? start[i] / norm : start[i];
  for (int count = whole(); count > 0; count--) {
    Real end = number();
    int steps = (int)ceill(fabsl(end - time) / longest);
    Real first = time;
    for (int n = 0; n < steps; n++) {
      Real here = first + (end - first) * n / steps;
      advance(here, state, first + (end - first) * (n + 1) / steps - here);
    }
    time = end;
    for (int i = 7; i < size; i++)
      printf("%.20Lg%c", state[i], (i - 7) % 6 == 5 ? '\n' : ' ');
  }
}
