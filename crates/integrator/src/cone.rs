//! The cone that a ray stands for: what is finer than it is wide, textures smooth away (Akenine-Möller, Crassin, Boksansky,
//! Belcour, Panteleev, Wright: Improved Shader and Texture Level of Detail Using Ray Cones, 2021).

use std::f32::consts::PI;

/// How wide a scattered ray's cone is, as a share of the one that its density stands for: many such rays come together.
const SCATTERED: f32 = 0.125;

/// How wide a ray is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Diameter where the ray begins, scene units.
    pub width: f32,
    /// How much the diameter grows on each unit of the way.
    pub spread: f32,
}

impl Cone {
    /// Of a ray that stands for a point alone.
    pub const SHARP: Self = Self { width: 0.0, spread: 0.0 };

    /// The cone of a ray that goes on where this one has come `distance` far. Mirrors and clear glass keep the spread:
    /// their curvature is left out.
    #[inline]
    #[must_use]
    pub fn after(self, distance: f32) -> Self {
        Self { width: self.width + self.spread * distance, ..self }
    }

    /// After scattering into a direction that was chosen with this density per steradian; infinite for mirrors. It becomes
    /// no narrower than an eighth of the cone whose solid angle is 1 / density.
    #[inline]
    #[must_use]
    pub fn scattered(self, pdf: f32) -> Self {
        let spread = 2.0 * SCATTERED / (PI * pdf).sqrt();
        Self { spread: self.spread.max(spread.min(1.0)), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_grow_with_the_way_and_by_scattering() {
        let cone = Cone { width: 0.5, spread: 0.1 };
        assert_eq!(cone.after(5.0), Cone { width: 1.0, spread: 0.1 });
        assert_eq!(cone.scattered(f32::INFINITY), cone);
        // Straight up from a matte surface: the cone of a solid angle π is 2 wide at a distance of 1.
        assert!((cone.scattered(1.0 / PI).spread - 0.25).abs() < 1e-6);
        assert_eq!(cone.scattered(0.0), Cone { width: 0.5, spread: 1.0 });
        assert!(cone.scattered(1e4).spread == 0.1);
    }
}
