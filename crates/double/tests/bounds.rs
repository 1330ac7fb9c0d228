//! Each error bound of the crate's documentation against exact arithmetic.

use andoyer_double::{DoubleDouble, arithmetic_geometric_mean, carlson_rf, two_product, two_sum};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

/// 2^−53.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;
/// Binary digits after the point of the numbers that have no fraction, and thus of the reference of roots.
const DIGITS: u32 = 400;

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).expect("finite")
}

fn exact_sum(value: DoubleDouble) -> BigRational {
    exact(value.high) + exact(value.low)
}

/// |found − expected| / |expected|; 0 for two zeros, infinite for one.
fn relative(found: DoubleDouble, expected: &BigRational) -> f64 {
    let difference = exact_sum(found) - expected;
    let zero = BigRational::from_integer(0.into());
    if difference == zero {
        return 0.0;
    }
    if *expected == zero {
        return f64::INFINITY;
    }
    // Rounded to 2^−400: enough for a figure of 2^−106.
    let ratio = difference / expected;
    let scaled = (ratio.numer() << DIGITS) / ratio.denom();
    let digits = i32::try_from(scaled.bits()).expect("small");
    let leading = if digits > 60 { scaled >> (digits - 60) } else { scaled };
    let mantissa: f64 = leading.to_string().parse::<f64>().expect("a number");
    (mantissa * 2.0_f64.powi((digits - 60).max(0) - DIGITS as i32)).abs()
}

/// Fixed-point numbers with [`DIGITS`] binary digits: what roots are exact to.
fn fixed(value: &BigRational) -> BigInt {
    (value.numer() << DIGITS) / value.denom()
}

fn rational(value: BigInt) -> BigRational {
    BigRational::new(value, BigInt::from(1) << DIGITS)
}

fn fixed_root(value: &BigInt) -> BigInt {
    (value << DIGITS).sqrt()
}

fn fixed_product(a: &BigInt, b: &BigInt) -> BigInt {
    (a * b) >> DIGITS
}

/// A double-double with both parts at work: 2^e (1 + x) + a tail below half an ulp.
fn number() -> impl Strategy<Value = DoubleDouble> {
    (1.0..2.0_f64, -0.5..0.5_f64, -30..30_i32, any::<bool>()).prop_map(|(high, tail, power, negative)| {
        let sign = if negative { -1.0 } else { 1.0 };
        let high = sign * high * 2.0_f64.powi(power);
        DoubleDouble::sum(high, tail * UNIT * high)
    })
}

fn positive() -> impl Strategy<Value = DoubleDouble> {
    number().prop_map(|value| if value.high < 0.0 { -value } else { value })
}

fn double() -> impl Strategy<Value = f64> {
    number().prop_map(|value| value.high)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn two_sum_and_two_product_are_exact(a in double(), b in double()) {
        let (sum, rest) = two_sum(a, b);
        prop_assert_eq!(exact(sum) + exact(rest), exact(a) + exact(b));
        let (product, rest) = two_product(a, b);
        prop_assert_eq!(exact(product) + exact(rest), exact(a) * exact(b));
    }

    #[test]
    fn parts_do_not_overlap(a in number(), b in number()) {
        for value in [a + b, a - b, a * b, a / b, a.times_double(b.high), a.over(b.high)] {
            prop_assert_eq!(value.high, value.high + value.low);
        }
    }

    #[test]
    fn sums_and_differences_are_within_three_square_units(a in number(), b in number()) {
        for (found, expected) in [(a + b, exact_sum(a) + exact_sum(b)), (a - b, exact_sum(a) - exact_sum(b))] {
            prop_assert!(relative(found, &expected) <= 3.0001 * UNIT * UNIT, "{:e}", relative(found, &expected));
        }
    }

    #[test]
    fn near_numbers_are_subtracted_within_the_same_bound(a in number(), step in -8..8_i32) {
        let b = DoubleDouble::sum(a.high * (1.0 + 2.0 * f64::from(step) * UNIT), a.low * 0.7);
        let expected = exact_sum(a) - exact_sum(b);
        prop_assert!(relative(a - b, &expected) <= 3.0001 * UNIT * UNIT);
    }

    #[test]
    fn products_are_within_five_square_units(a in number(), b in number()) {
        prop_assert!(relative(a * b, &(exact_sum(a) * exact_sum(b))) <= 5.0 * UNIT * UNIT);
    }

    #[test]
    fn products_and_quotients_with_a_double_are_within_three_square_units(a in number(), b in double()) {
        prop_assert!(relative(a.times_double(b), &(exact_sum(a) * exact(b))) <= 3.0 * UNIT * UNIT);
        prop_assert!(relative(a.over(b), &(exact_sum(a) / exact(b))) <= 3.0 * UNIT * UNIT);
    }

    #[test]
    fn quotients_are_within_ten_square_units(a in number(), b in number()) {
        prop_assert!(relative(a / b, &(exact_sum(a) / exact_sum(b))) <= 10.0 * UNIT * UNIT);
    }

    #[test]
    fn roots_are_within_four_square_units(a in positive()) {
        let root = rational(fixed_root(&fixed(&exact_sum(a))));
        prop_assert!(relative(a.sqrt(), &root) <= 4.0 * UNIT * UNIT, "{:e}", relative(a.sqrt(), &root));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn means_in_both_precisions_are_those_of_400_digits(a in positive(), b in positive()) {
        let (mut first, mut second) = (fixed(&exact_sum(a)), fixed(&exact_sum(b)));
        for _ in 0..40 {
            (first, second) = ((&first + &second) >> 1, fixed_root(&fixed_product(&first, &second)));
        }
        let expected = rational(first);
        prop_assert!(relative(arithmetic_geometric_mean(a, b), &expected) <= 2.0_f64.powi(-99));
        let doubles = rational({
            let (mut first, mut second) = (fixed(&exact(a.high)), fixed(&exact(b.high)));
            for _ in 0..40 {
                (first, second) = ((&first + &second) >> 1, fixed_root(&fixed_product(&first, &second)));
            }
            first
        });
        let found = DoubleDouble::from(arithmetic_geometric_mean(a.high, b.high));
        prop_assert!(relative(found, &doubles) <= 8.0 * UNIT, "{:e}", relative(found, &doubles));
    }

    #[test]
    fn elliptic_integrals_in_both_precisions_are_those_of_400_digits(x in positive(), y in positive(), z in positive()) {
        let integral = |arguments: [BigRational; 3]| {
            let [mut x, mut y, mut z] = arguments.map(|value| fixed(&value));
            // Each step divides the spread by four: 200 of them leave 2^−360.
            for _ in 0..200 {
                let (rx, ry, rz) = (fixed_root(&x), fixed_root(&y), fixed_root(&z));
                let lambda: BigInt = fixed_product(&rx, &(&ry + &rz)) + fixed_product(&ry, &rz);
                (x, y, z) = ((x + &lambda) >> 2, (y + &lambda) >> 2, (z + &lambda) >> 2);
            }
            rational(fixed(&(BigRational::from_integer(1.into()) / rational(fixed_root(&x)))))
        };
        let expected = integral([x, y, z].map(exact_sum));
        prop_assert!(relative(carlson_rf(x, y, z), &expected) <= 2e-20);
        let doubles = integral([x.high, y.high, z.high].map(exact));
        let found = DoubleDouble::from(carlson_rf(x.high, y.high, z.high));
        prop_assert!(relative(found, &doubles) <= 6.0 * UNIT, "{:e}", relative(found, &doubles));
    }
}

#[test]
fn mean_is_zero_beside_a_zero() {
    assert_eq!(arithmetic_geometric_mean(1.0, 0.0), 0.0);
    assert_eq!(arithmetic_geometric_mean(DoubleDouble::ONE, DoubleDouble::ZERO), DoubleDouble::ZERO);
}
