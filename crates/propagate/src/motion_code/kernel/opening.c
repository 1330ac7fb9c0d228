
#include <math.h>

#ifdef __FAST_MATH__
#error "rounding errors are computed here: compile without -ffast-math"
#endif

/* Attitude and angular velocity at a time: 1, or 0 beyond the bound, where nothing is written. */
int rotation(double time, double attitude[4], double angular_velocity[3]);

