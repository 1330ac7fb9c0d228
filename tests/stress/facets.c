/* The full equations of a body under light on flat plates, whose torque is the sum over the plates that see the light, with max(0, cos) and no polynomials.

   Kicks by the torque stand between free rotations, which are turns about the body axes; the free rotation is composed to order 4 (H. Yoshida 1990).
   In: moments, attitude (x y z w), angular momentum in body axes, rate and inclination of a circular orbit of the light, step, steps, steps between rows, number of plates; for each plate normal, pressure times area,
   centroid, specular fraction, Lambert's factor. Out: time, attitude, angular momentum in body axes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct { double normal[3], force, centroid[3], specular, lambert; } Plate;

static double moments[3], q[4], momentum[3], motion, inclination;
static Plate *plates;
static int count;

/* A free turn about one axis. */
static void turn(int i, double time) {
  int j = (i + 1) % 3, k = (i + 2) % 3;
  double half = 0.5 * time * momentum[i] / moments[i], c = cos(half), s = sin(half);
  double cosine = c * c - s * s, sine = 2 * c * s, a = momentum[j], b = momentum[k], x = q[i], y = q[j], z = q[k], w = q[3];
  momentum[j] = cosine * a + sine * b;
  momentum[k] = cosine * b - sine * a;
  q[i] = x * c + w * s;
  q[j] = y * c + z * s;
  q[k] = z * c - y * s;
  q[3] = w * c - x * s;
}

static void rotate(double time) {
  turn(0, time / 2);
  turn(1, time / 2);
  turn(2, time);
  turn(1, time / 2);
  turn(0, time / 2);
}

static void kick(double at, double time) {
  double sun[3] = {cos(motion * at), sin(motion * at) * cos(inclination), sin(motion * at) * sin(inclination)};
  double x = q[0], y = q[1], z = q[2], w = q[3];
  double u[3] = {(1 - 2 * (y * y + z * z)) * sun[0] + 2 * (x * y + z * w) * sun[1] + 2 * (x * z - y * w) * sun[2],
                 2 * (x * y - z * w) * sun[0] + (1 - 2 * (x * x + z * z)) * sun[1] + 2 * (y * z + x * w) * sun[2],
                 2 * (x * z + y * w) * sun[0] + 2 * (y * z - x * w) * sun[1] + (1 - 2 * (x * x + y * y)) * sun[2]};
  for (int f = 0; f < count; f++) {
    const Plate *p = plates + f;
    double cosine = p->normal[0] * u[0] + p->normal[1] * u[1] + p->normal[2] * u[2], force[3];
    if (cosine <= 0)
      continue;
    for (int i = 0; i < 3; i++)
      force[i] = -p->force * cosine * ((1 - p->specular) * u[i] + (2 * p->specular * cosine + p->lambert) * p->normal[i]);
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      momentum[i] += time * (p->centroid[j] * force[k] - p->centroid[k] * force[j]);
    }
  }
}

int main(void) {
  double step, first = 1 / (2 - cbrt(2.0));
  long steps, every;
  int read = scanf("%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %ld %ld %d", moments, moments + 1, moments + 2, q, q + 1, q + 2, q + 3, momentum, momentum + 1,
                   momentum + 2, &motion, &inclination, &step, &steps, &every, &count);
  if (read != 16 || count < 1 || every < 1 || !(plates = calloc(count, sizeof *plates)))
    return 1;
  for (int f = 0; f < count; f++) {
    Plate *p = plates + f;
    if (scanf("%lf %lf %lf %lf %lf %lf %lf %lf %lf", p->normal, p->normal + 1, p->normal + 2, &p->force, p->centroid, p->centroid + 1, p->centroid + 2, &p->specular, &p->lambert) != 9)
      return 1;
  }
  for (long n = 0; n <= steps; n++) {
    if (n % every == 0)
      printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", n * step, q[0], q[1], q[2], q[3], momentum[0], momentum[1], momentum[2]);
    kick(n * step, step / 2);
    rotate(first * step);
    rotate((1 - 2 * first) * step);
    rotate(first * step);
    kick((n + 1) * step, step / 2);
  }
}
