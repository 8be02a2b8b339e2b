//! Directional emission of groups of lights.

use super::LightBounds;
use super::child_bounds::BuildLight;
use juggler_math::Vec3;

/// Emission profile of a group of lights: the approximate fraction of the maximum intensity that
/// they emit in a direction ω, averaged by power. It is a + b·ω + ω·C ω, spherical harmonics up to
/// the second order, with C symmetric and traceless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EmissionProfile {
    pub constant: f32,
    pub linear: Vec3,
    /// Terms xx, yy, xy, xz, yz; the last three doubled.
    pub quadratic: [f32; 5],
}

impl EmissionProfile {
    /// Profile that leaves the emission to the bounds.
    const UNIFORM: Self = Self { constant: 1.0, linear: Vec3::ZERO, quadratic: [0.0; 5] };

    /// Profile of flat lights by the clamped cosine (Ramamoorthi and Hanrahan, An Efficient
    /// Representation for Irradiance Environment Maps, 2001, equation 8): 1/4 + c/2 + 5/32 (3 c² -
    /// 1), for two sides 1/2 + 5/16 (3 c² - 1). Other lights, and single lights, use only their
    /// bounds. `power` is the total power.
    pub fn from_lights(items: &[BuildLight], power: f64) -> Self {
        if items.len() < 2 {
            return Self::UNIFORM;
        }
        let mut sum = [0.0; 9];
        for item in items {
            let weight = f64::from(item.light.power);
            let terms = Self::terms(&item.light);
            sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        }
        let [constant, x, y, z, quadratic @ ..] = sum.map(|sum| (sum / power) as f32);
        Self { constant, linear: Vec3::new(x, y, z), quadratic }
    }

    fn terms(light: &LightBounds) -> [f64; 9] {
        const FLAT: f32 = 0.999;
        let mut terms = [0.0; 9];
        if light.cos_theta_o < FLAT || light.cos_theta_e.abs() > 1.0 - FLAT {
            terms[0] = 1.0;
            return terms;
        }
        let n = light.axis.as_dvec3();
        let (constant, linear, quadratic) =
            if light.two_sided { (0.5, 0.0, 15.0 / 16.0) } else { (0.25, 0.5, 15.0 / 32.0) };
        let third = 1.0 / 3.0;
        let squares = [n.x * n.x - third, n.y * n.y - third];
        let products = [2.0 * n.x * n.y, 2.0 * n.x * n.z, 2.0 * n.y * n.z];
        terms[0] = constant;
        terms[1..4].copy_from_slice(&(n * linear).to_array());
        terms[4..6].copy_from_slice(&squares.map(|square| quadratic * square));
        terms[6..].copy_from_slice(&products.map(|product| quadratic * product));
        terms
    }
}
