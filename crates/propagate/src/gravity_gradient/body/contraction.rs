//! The contraction c_m of the tensor Θ for m = 0, 1, 2, and Θ on an ellipse as a combination of 1, cos 2f and sin 2f.

use crate::numerics::C64;
use nalgebra::Vector3;

/// A symmetric tensor: components 11, 22, 33, 12, 13, 23.
pub(crate) type SymmetricTensor = [f64; 6];
/// The contraction of a tensor for one m, and its derivatives when the frame turns about its axes 1 and 2.
pub(crate) type Contraction = [C64; 3];

/// c_m, X₁c_m and X₂c_m of a tensor, with c₀ = Θ33 − tr Θ/3, c₁ = Θ13 − iΘ23, c₂ = Θ11 − Θ22 − 2iΘ12 and X_i the derivative when the frame turns about its axis i.
pub(crate) fn contraction(&[xx, yy, zz, xy, xz, yz]: &SymmetricTensor, multiple: i32) -> Contraction {
    let c = C64::new;
    match multiple {
        0 => [c(zz - (xx + yy + zz) / 3.0, 0.0), c(-2.0 * yz, 0.0), c(2.0 * xz, 0.0)],
        1 => [c(xz, -yz), c(-xy, yy - zz), c(xx - zz, -xy)],
        _ => [c(xx - yy, -2.0 * xy), c(-2.0 * yz, -2.0 * xz), c(-2.0 * xz, 2.0 * yz)],
    }
}

/// (ab + ba)/2 of two vectors.
pub(crate) fn product(a: &Vector3<f64>, b: &Vector3<f64>) -> SymmetricTensor {
    const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    COMPONENTS.map(|(i, k)| 0.5 * (a[i] * b[k] + a[k] * b[i]))
}

/// The factors of (a/r)³ times 1, cos 2f and sin 2f in (a/r)³ r̂r̂, from the axes of the ellipse.
pub(crate) fn factors([first, second]: [Vector3<f64>; 2]) -> [SymmetricTensor; 3] {
    let (one, other) = (product(&first, &first), product(&second, &second));
    let half = |sign: f64| std::array::from_fn(|i| 0.5 * (one[i] + sign * other[i]));
    [half(1.0), half(-1.0), product(&first, &second)]
}

/// Coefficients of e^(ijl) in (a/r)³ times 1, cos 2f and sin 2f for either sign of j, from those of an [`OrbitSeries`](crate::gravity_gradient::orbit::hansen::OrbitSeries) for |j|.
pub(crate) fn coefficients(&[one, cosine, sine]: &[f64; 3], j: f64) -> [C64; 3] {
    [one.into(), cosine.into(), C64::new(0.0, -sine * j.signum())]
}

/// Θ, X₁Θ and X₂Θ of a tensor.
pub(crate) fn with_turns(tensor: &SymmetricTensor) -> [SymmetricTensor; 3] {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    [*tensor, [0.0, 2.0 * yz, -2.0 * yz, xz, -xy, zz - yy], [-2.0 * xz, 0.0, 2.0 * xz, -yz, xx - zz, xy]]
}
