//! The period of a pendulum of large amplitude, in doubles and in double-doubles: T = 4 √(l/g) K, with K = π/(2 agm(1, cos(θ/2))) = R_F(0, k′², 1).

#![expect(clippy::print_stdout, reason = "an example prints what it computes")]

use andoyer_double::{DoubleDouble, arithmetic_geometric_mean, carlson_rf};

/// π to 32 digits.
const PI: DoubleDouble = DoubleDouble { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

fn main() {
    let length_over_gravity = DoubleDouble::from(1.0).over(9.81); // 1 m
    for degrees in [1.0, 90.0, 179.0] {
        let half = PI.times_double(degrees).over(360.0);
        let (_, cosine) = half.sin_cos();
        let quarter = PI.over(2.0) / arithmetic_geometric_mean(DoubleDouble::ONE, cosine);
        let period = length_over_gravity.sqrt().times_double(4.0) * quarter;

        let carlson = carlson_rf(DoubleDouble::ZERO, cosine * cosine, DoubleDouble::ONE);
        let apart = ((carlson - quarter) / quarter).to_f64().abs();
        println!("{degrees:3} degrees: {:.15} s, and the two formulas differ by {apart:.0e}", period.to_f64());
        assert!(apart < 1e-30);
    }
}
