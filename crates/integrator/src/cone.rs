//! Ray cones for texture filtering (Akenine-Möller, Crassin, Boksansky, Belcour, Panteleev, Wright:
//! Improved Shader and Texture Level of Detail Using Ray Cones, 2021).

use std::f32::consts::PI;

/// Width of a scattered ray's cone, as a fraction of the cone that its density implies: the many
/// scattered rays filter each other.
const SCATTER_FRACTION: f32 = 0.125;

/// Cone around a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCone {
    /// Diameter at the ray's origin, in scene units.
    pub width: f32,
    /// Increase of the diameter per unit of distance.
    pub spread: f32,
}

impl RayCone {
    /// Cone of zero width.
    pub const SHARP: Self = Self { width: 0.0, spread: 0.0 };

    /// Cone after `distance` along the ray. Specular surfaces keep the spread: their curvature is
    /// neglected.
    #[inline]
    #[must_use]
    pub fn after(self, distance: f32) -> Self {
        Self { width: self.width + self.spread * distance, ..self }
    }

    /// Cone after scattering in a direction of density `pdf` per steradian, infinite for specular
    /// surfaces. Its width is at least an eighth of that of the cone with the solid angle 1 /
    /// `pdf`.
    #[inline]
    #[must_use]
    pub fn scattered(self, pdf: f32) -> Self {
        let spread = 2.0 * SCATTER_FRACTION / (PI * pdf).sqrt();
        Self { spread: self.spread.max(spread.min(1.0)), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_grow_with_distance_and_by_scattering() {
        let cone = RayCone { width: 0.5, spread: 0.1 };
        assert_eq!(cone.after(5.0), RayCone { width: 1.0, spread: 0.1 });
        assert_eq!(cone.scattered(f32::INFINITY), cone);
        // Along the normal of a diffuse surface: a cone of solid angle π is 2 wide at distance 1.
        assert!((cone.scattered(1.0 / PI).spread - 0.25).abs() < 1e-6);
        assert_eq!(cone.scattered(0.0), RayCone { width: 0.5, spread: 1.0 });
        assert!(cone.scattered(1e4).spread == 0.1);
    }
}
