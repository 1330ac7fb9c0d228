//! Instruction sets: the operations of a kernel that `pulp` does not have for all sets.
//!
//! The program contains the kernels for every instruction set of its architecture and selects the best one at run time. All sets with a fused multiply-add give
//! the same bits, whatever their width, because only the stores combine lanes.

#[cfg(target_arch = "x86_64")]
use pulp::x86::V3_128b;
use pulp::{Arch, NullaryFnOnce, Simd, bytemuck};

/// An instruction set.
pub(crate) trait InstructionSet: Simd {
    /// Whether `mul_add` rounds once.
    const FUSED: bool = true;
    /// Vectors that are processed side by side, one or two.
    const STRANDS: usize = 2;

    /// A register of doubles. The vectors of pulp do not have its alignment ([`super::lanes`]).
    type Register: Copy;

    /// The set itself, or one of its machine whose vectors have four lanes.
    type Four: InstructionSet;

    /// The set for rows of four lanes.
    fn four(self) -> Self::Four;

    /// (sine, cosine) of the angle plus as many quarter turns as the lowest two bits of `quarters` say.
    fn turned(self, sine: Self::f64s, cosine: Self::f64s, quarters: Self::u64s) -> (Self::f64s, Self::f64s);

    /// Each four lanes of a row in another order, by two bits a lane from the lowest on.
    #[inline(always)]
    fn in_order<const ORDER: i32, const W: usize>(self, row: &[f64; W]) -> [f64; W] {
        std::array::from_fn(|lane| row[lane / 4 * 4 + (ORDER as usize >> (2 * (lane % 4)) & 3)])
    }

    /// Four columns to rows in memory order.
    #[inline(always)]
    fn fours(self, columns: [Self::f64s; 4]) -> [Self::f64s; 4] {
        rows::<Self, 4>(columns)
    }

    /// Three columns to rows in memory order.
    #[inline(always)]
    fn threes(self, columns: [Self::f64s; 3]) -> [Self::f64s; 3] {
        rows::<Self, 3>(columns)
    }
}

/// A computation that is compiled for each instruction set.
pub(crate) trait Task {
    type Output;

    /// Runs the computation. It must be inlined, so that it is compiled for the set.
    fn run<S: InstructionSet>(self, simd: S) -> Self::Output;
}

struct On<S, T>(S, T);

impl<S: InstructionSet, T: Task> NullaryFnOnce for On<S, T> {
    type Output = T::Output;

    #[inline(always)]
    fn call(self) -> T::Output {
        self.1.run(self.0)
    }
}

/// Runs a task with the best instruction set available. With debug assertions that is one of at most four lanes, to the same bits: the kernels are most of what is compiled.
pub(crate) fn dispatch<T: Task>(arch: Arch, task: T) -> T::Output {
    #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
    if let Arch::V4(simd) = arch {
        return simd.vectorize(On(simd, task));
    }
    dispatch_few(arch, task)
}

/// Runs a task whose work has rows of eight lanes or fewer. Wide vectors divide and take roots at half the speed, and the bits are the same; the task
/// is not compiled for them.
pub(crate) fn dispatch_few<T: Task>(arch: Arch, task: T) -> T::Output {
    match arch {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(simd) => (*simd).vectorize(On(*simd, task)),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => simd.vectorize(On(simd, task)),
        #[cfg(target_arch = "aarch64")]
        Arch::Neon(simd) => simd.vectorize(On(simd, task)),
        _ => On(pulp::Scalar, task).call(),
    }
}

/// Runs a task that has one lane to fill, to the same bits. Narrow vectors divide and take roots up to four times as fast as wide ones, and a second vector
/// would be idle.
pub(crate) fn dispatch_one<T: Task>(arch: Arch, task: T) -> T::Output {
    match arch {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(simd) => simd.vectorize(On(V3_128b(*simd), task)),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => simd.vectorize(On(V3_128b(simd), task)),
        #[cfg(target_arch = "aarch64")]
        Arch::Neon(simd) => simd.vectorize(On(simd, task)),
        _ => On(pulp::Scalar, task).call(),
    }
}

#[inline(always)]
fn rows<S: Simd, const N: usize>(columns: [S::f64s; N]) -> [S::f64s; N] {
    let mut rows = columns;
    let places: &mut [f64] = bytemuck::cast_slice_mut(&mut rows);
    for (column, vector) in columns.iter().enumerate() {
        let lanes: &[f64] = bytemuck::cast_slice(std::slice::from_ref(vector));
        for (lane, value) in lanes.iter().enumerate() {
            places[N * lane + column] = *value;
        }
    }
    rows
}

/// One lane without a fused multiply-add, available on every machine.
impl InstructionSet for pulp::Scalar {
    const FUSED: bool = false;

    type Register = f64;
    type Four = Self;

    #[inline(always)]
    fn four(self) -> Self {
        self
    }

    #[inline(always)]
    fn turned(self, sine: f64, cosine: f64, quarters: u64) -> (f64, f64) {
        // Without a branch: it would be mispredicted every other time.
        let (s, c) = (sine.to_bits(), cosine.to_bits());
        let exchange = (s ^ c) & (quarters & 1).wrapping_neg();
        let sign = |bits: u64| (bits << 62) & (1 << 63);
        (f64::from_bits(s ^ exchange ^ sign(quarters)), f64::from_bits(c ^ exchange ^ sign(quarters + 1)))
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m128d, __m256d, __m512d};

    use super::{InstructionSet, Simd};
    use pulp::x86::{V3, V3_128b, V4};
    use pulp::{cast, f64x2, f64x4, f64x8, u64x2, u64x4, u64x8};

    /// One vector of two lanes, with fused multiply-add.
    impl InstructionSet for V3_128b {
        const STRANDS: usize = 1;

        type Register = __m128d;
        type Four = V3;

        #[inline(always)]
        fn four(self) -> V3 {
            self.0
        }

        #[inline(always)]
        fn turned(self, sine: f64x2, cosine: f64x2, quarters: u64x2) -> (f64x2, f64x2) {
            let one = self.splat_u64s(1);
            let odd = self.equal_u64s(self.and_u64s(quarters, one), one);
            let (s, c) = (self.select_f64s(odd, cosine, sine), self.select_f64s(odd, sine, cosine));
            let top = self.splat_u64s(1 << 63);
            let s_sign = self.and_u64s(self.shl_const_u64x2::<62>(quarters), top);
            let c_sign = self.and_u64s(self.shl_const_u64x2::<62>(self.add_u64s(quarters, one)), top);
            (self.xor_f64s(s, cast(s_sign)), self.xor_f64s(c, cast(c_sign)))
        }
    }

    /// AVX2 and FMA: four lanes.
    impl InstructionSet for V3 {
        type Register = __m256d;
        type Four = Self;

        #[inline(always)]
        fn four(self) -> Self {
            self
        }

        #[inline(always)]
        fn turned(self, sine: f64x4, cosine: f64x4, quarters: u64x4) -> (f64x4, f64x4) {
            let odd = cast(self.shl_const_u64x4::<63>(quarters));
            let (s, c) = (cast(sine), cast(cosine));
            let (s, c) = (cast(self.avx._mm256_blendv_pd(s, c, odd)), cast(self.avx._mm256_blendv_pd(c, s, odd)));
            // Bit 1 of k and of k + 1, where the sign is.
            let top = self.splat_u64s(1 << 63);
            let next = self.add_u64s(quarters, self.splat_u64s(1));
            let s_sign = self.and_u64s(self.shl_const_u64x4::<62>(quarters), top);
            let c_sign = self.and_u64s(self.shl_const_u64x4::<62>(next), top);
            (self.xor_f64s(s, cast(s_sign)), self.xor_f64s(c, cast(c_sign)))
        }

        #[inline(always)]
        fn in_order<const ORDER: i32, const W: usize>(self, row: &[f64; W]) -> [f64; W] {
            let mut out = [0.0; W];
            for (to, from) in Self::as_mut_simd_f64s(&mut out).0.iter_mut().zip(Self::as_simd_f64s(row).0) {
                *to = cast(self.avx2._mm256_permute4x64_pd::<ORDER>(cast(*from)));
            }
            out
        }

        #[inline(always)]
        fn fours(self, columns: [f64x4; 4]) -> [f64x4; 4] {
            let [x, y, z, w] = columns;
            let (x, y, z, w, avx) = (cast(x), cast(y), cast(z), cast(w), self.avx);
            let (xy, zw) = (avx._mm256_unpacklo_pd(x, y), avx._mm256_unpacklo_pd(z, w));
            let (odd_xy, odd_zw) = (avx._mm256_unpackhi_pd(x, y), avx._mm256_unpackhi_pd(z, w));
            [
                cast(avx._mm256_permute2f128_pd::<0x20>(xy, zw)),
                cast(avx._mm256_permute2f128_pd::<0x20>(odd_xy, odd_zw)),
                cast(avx._mm256_permute2f128_pd::<0x31>(xy, zw)),
                cast(avx._mm256_permute2f128_pd::<0x31>(odd_xy, odd_zw)),
            ]
        }

        #[inline(always)]
        fn threes(self, columns: [f64x4; 3]) -> [f64x4; 3] {
            let [x, y, z] = columns;
            let (x, y, z, avx) = (cast(x), cast(y), cast(z), self.avx);
            let xy = avx._mm256_unpacklo_pd(x, y); // x0 y0 x2 y2
            let yz = avx._mm256_unpackhi_pd(y, z); // y1 z1 y3 z3
            let zx = avx._mm256_shuffle_pd::<0b1010>(z, x); // z0 x1 z2 x3
            [
                cast(avx._mm256_permute2f128_pd::<0x20>(xy, zx)),
                cast(avx._mm256_permute2f128_pd::<0x30>(yz, xy)),
                cast(avx._mm256_permute2f128_pd::<0x31>(zx, yz)),
            ]
        }
    }

    /// AVX-512: eight lanes.
    impl InstructionSet for V4 {
        type Register = __m512d;
        type Four = V3;

        #[inline(always)]
        fn four(self) -> V3 {
            *self
        }

        #[inline(always)]
        fn turned(self, sine: f64x8, cosine: f64x8, quarters: u64x8) -> (f64x8, f64x8) {
            let odd = self.avx512f._mm512_test_epi64_mask(cast(quarters), cast(self.splat_u64s(1)));
            let (s, c) = (cast(sine), cast(cosine));
            let avx = self.avx512f;
            let (s, c) = (cast(avx._mm512_mask_blend_pd(odd, s, c)), cast(avx._mm512_mask_blend_pd(odd, c, s)));
            let top = self.splat_u64s(1 << 63);
            let next = self.add_u64s(quarters, self.splat_u64s(1));
            let s_sign = self.and_u64s(self.shl_const_u64x8::<62>(quarters), top);
            let c_sign = self.and_u64s(self.shl_const_u64x8::<62>(next), top);
            (self.xor_f64s(s, cast(s_sign)), self.xor_f64s(c, cast(c_sign)))
        }

        #[inline(always)]
        fn in_order<const ORDER: i32, const W: usize>(self, row: &[f64; W]) -> [f64; W] {
            let mut out = [0.0; W];
            for (to, from) in Self::as_mut_simd_f64s(&mut out).0.iter_mut().zip(Self::as_simd_f64s(row).0) {
                *to = cast(self.avx512f._mm512_permutex_pd::<ORDER>(cast(*from)));
            }
            out
        }

        #[inline(always)]
        fn fours(self, columns: [f64x8; 4]) -> [f64x8; 4] {
            let [x, y, z, w] = columns;
            let near = [0, 8, 1, 9, 2, 10, 3, 11];
            let far = [4, 12, 5, 13, 6, 14, 7, 15];
            let (xy, zw) = (picked(self, x, y, near), picked(self, z, w, near));
            let (far_xy, far_zw) = (picked(self, x, y, far), picked(self, z, w, far));
            let first = [0, 1, 8, 9, 2, 3, 10, 11];
            let second = [4, 5, 12, 13, 6, 7, 14, 15];
            [
                picked(self, xy, zw, first),
                picked(self, xy, zw, second),
                picked(self, far_xy, far_zw, first),
                picked(self, far_xy, far_zw, second),
            ]
        }

        #[inline(always)]
        fn threes(self, columns: [f64x8; 3]) -> [f64x8; 3] {
            let [x, y, z] = columns;
            // The x and y of each vector in place, then its z.
            let first = picked(self, x, y, [0, 8, 0, 1, 9, 0, 2, 10]);
            let second = picked(self, x, y, [0, 3, 11, 0, 4, 12, 0, 5]);
            let third = picked(self, x, y, [13, 0, 6, 14, 0, 7, 15, 0]);
            [
                picked(self, first, z, [0, 1, 8, 3, 4, 9, 6, 7]),
                picked(self, second, z, [10, 1, 2, 11, 4, 5, 12, 7]),
                picked(self, third, z, [0, 13, 2, 3, 14, 5, 6, 15]),
            ]
        }
    }

    /// The lanes of `a` (0 to 7) and `b` (8 to 15) with these indices.
    #[inline(always)]
    fn picked(simd: V4, a: f64x8, b: f64x8, lanes: [u64; 8]) -> f64x8 {
        let lanes: u64x8 = cast(lanes);
        cast(simd.avx512f._mm512_permutex2var_pd(cast(a), cast(lanes), cast(b)))
    }
}

#[cfg(target_arch = "aarch64")]
mod aarch64 {
    use std::arch::aarch64::float64x2_t;

    use super::{InstructionSet, Simd};
    use pulp::aarch64::Neon;
    use pulp::{cast, f64x2, u64x2};

    /// NEON: two lanes.
    impl InstructionSet for Neon {
        type Register = float64x2_t;
        type Four = Self;

        #[inline(always)]
        fn four(self) -> Self {
            self
        }

        #[inline(always)]
        fn turned(self, sine: f64x2, cosine: f64x2, quarters: u64x2) -> (f64x2, f64x2) {
            let one = self.splat_u64s(1);
            let odd = self.greater_than_u64s(self.and_u64s(quarters, one), self.splat_u64s(0));
            let (s, c) = (self.select_f64s(odd, cosine, sine), self.select_f64s(odd, sine, cosine));
            let top = self.splat_u64s(1 << 63);
            let s_sign = self.and_u64s(self.shl_const_u64x2::<62>(quarters), top);
            let c_sign = self.and_u64s(self.shl_const_u64x2::<62>(self.add_u64s(quarters, one)), top);
            (self.xor_f64s(s, cast(s_sign)), self.xor_f64s(c, cast(c_sign)))
        }
    }
}
