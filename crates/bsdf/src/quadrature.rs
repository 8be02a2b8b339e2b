//! Cosine-weighted means over directions above, by five-point Gauss-Legendre quadrature:
//! ∫ 2 μ f(μ) dμ = ∫ 4 s³ f(s²) ds.
//!
//! Functions are evaluated for all nodes side by side.

use crate::lanes::lanes;
use juggler_math::Vec3;

/// Number of nodes.
pub const NODES: usize = 5;

/// s at each node.
const ROOTS: [f32; NODES] = [0.046_910_077, 0.230_765_34, 0.5, 0.769_234_66, 0.953_089_9];
/// Weight of each node; all of them add up to 1.
const WEIGHTS: [f32; NODES] = [0.118_463_44, 0.239_314_34, 0.284_444_45, 0.239_314_34, 0.118_463_44];

/// Azimuth of the directions of all nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Azimuth {
    /// 22.5 degrees.
    NearX,
    /// 45 degrees.
    Diagonal,
    /// 67.5 degrees.
    NearY,
}

impl Azimuth {
    /// Direction of each node.
    pub fn directions(self) -> [Vec3; NODES] {
        // Squared cosine of 22.5 and of 45 degrees.
        let near = if self == Self::Diagonal { 0.5 } else { 0.853_553_4 };
        cosines().map(|cos| {
            let sin2 = 1.0 - cos * cos;
            let (x, y) = ((sin2 * near).max(0.0).sqrt(), (sin2 * (1.0 - near)).max(0.0).sqrt());
            if self == Self::NearY { Vec3::new(y, x, cos) } else { Vec3::new(x, y, cos) }
        })
    }
}

/// Cosine μ of each node.
#[inline(always)]
pub fn cosines() -> [f32; NODES] {
    lanes(|node| ROOTS[node] * ROOTS[node])
}

/// Cosine-weighted mean of a function, whose values for the directions of an azimuth `f` returns.
/// Functions of anisotropic surfaces are evaluated at azimuths of 22.5 and 67.5 degrees, others at
/// 45.
#[inline]
pub fn mean(is_anisotropic: bool, f: impl Fn(Azimuth) -> [f32; NODES]) -> f32 {
    let (values, scale) = if is_anisotropic {
        let (values, others) = (f(Azimuth::NearX), f(Azimuth::NearY));
        (lanes(|node| values[node] + others[node]), 0.5)
    } else {
        (f(Azimuth::Diagonal), 1.0)
    };
    let nodes = ROOTS.iter().zip(&WEIGHTS).zip(&values);
    nodes.fold(0.0, |sum, ((s, weight), value)| sum + weight * 4.0 * s * (s * s) * value * scale)
}
