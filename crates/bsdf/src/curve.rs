//! Reflectance curves over the angle of incidence, by which materials are described.

use super::energy;
use super::fresnel::{
    conductor_reflectance, dielectric_reflectance, f0_from_ior, mean_dielectric_reflectance, schlick,
};
use super::lanes::lanes;
use super::thin_film::ThinFilm;
use juggler_math::Rgb;

/// Reflectance of a conductor, or of a coat that is treated like one, over the angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Complex index of refraction: exact for unpolarized light.
    Complex {
        /// Real part of the index, per channel.
        eta: Rgb,
        /// Imaginary part of the index (extinction coefficient), per channel.
        k: Rgb,
    },
    /// Schlick's curve, bent so that it is `edge` times as high at an angle of cosine 1/7, some 82
    /// degrees (Kutz, Hašan and Edmondson 2021; Hoffman 2023: "F82 tint").
    Tinted {
        /// Reflectance at normal incidence, 0 to 1.
        f0: Rgb,
        /// `17.65 (f0 + (1 - f0) (6/7)⁵) (1 - edge)`: black for plain Schlick. See
        /// [`Fresnel::tinted`].
        bend: Rgb,
    },
    /// Schlick's curve to any reflectance at grazing angles.
    Schlick {
        /// Reflectance at normal incidence, 0 to 1.
        f0: Rgb,
        /// Reflectance at grazing angles, 0 to 1.
        f90: Rgb,
    },
    /// Exact dielectric interface; transmitted light is left to other lobes.
    Dielectric {
        /// Index of refraction behind over in front.
        ior: f32,
        /// Factor on the reflectance, 0 to 1.
        color: Rgb,
    },
    /// Thin film over a base of Schlick's curve from `thin_film.f0` to white.
    ThinFilm {
        /// The film.
        thin_film: ThinFilm,
        /// Fraction of the surface that the film covers, 0 to 1.
        amount: f32,
    },
}

impl Fresnel {
    /// Perfect mirror: reflects all light at every angle.
    pub const WHITE: Self = Self::Tinted { f0: Rgb::WHITE, bend: Rgb::BLACK };

    /// Curve of reflectance `f0` at normal incidence and `edge` times Schlick's curve at 82
    /// degrees, both 0 to 1.
    pub fn tinted(f0: Rgb, edge: Rgb) -> Self {
        // At cosine 1/7, Schlick's weight is (6/7)⁵, and one over the bend's weight is 7 (7/6)⁶.
        let there = f0 + (Rgb::WHITE - f0) * 0.462_664_4;
        Self::Tinted { f0, bend: there * (Rgb::WHITE - edge) * 17.651_278 }
    }

    /// Reflectance at an angle of cosine `cos`, 0 to 1.
    #[inline]
    pub fn reflectance(&self, cos: f32) -> Rgb {
        match self {
            Self::Complex { eta, k } => Rgb::new(
                conductor_reflectance(cos, eta.r, k.r),
                conductor_reflectance(cos, eta.g, k.g),
                conductor_reflectance(cos, eta.b, k.b),
            ),
            Self::Tinted { f0, bend } => {
                let m = (1.0 - cos).clamp(0.0, 1.0);
                let m5 = m * m * m * m * m;
                let curve = *f0 + (Rgb::WHITE - *f0) * m5 - *bend * (cos * m5 * m);
                curve.map(|share| share.clamp(0.0, 1.0))
            }
            Self::Schlick { f0, f90 } => schlick(cos, *f0, *f90),
            Self::Dielectric { ior, color } => *color * dielectric_reflectance(cos, *ior),
            Self::ThinFilm { thin_film, amount } => {
                schlick(cos, thin_film.f0, Rgb::WHITE).lerp(thin_film.reflectance(cos), *amount)
            }
        }
    }

    /// Reflectances at normal incidence and grazing angles, and the bend of [`Fresnel::Tinted`], of
    /// the Schlick curve that fits best.
    fn schlick_fit(&self) -> (Rgb, Rgb, Rgb) {
        match self {
            Self::Tinted { f0, bend } => (*f0, Rgb::WHITE, *bend),
            Self::Schlick { f0, f90 } => (*f0, *f90, Rgb::BLACK),
            Self::Dielectric { ior, color } => (*color * f0_from_ior(*ior), *color, Rgb::BLACK),
            Self::Complex { .. } | Self::ThinFilm { .. } => {
                let f0 = self.reflectance(1.0);
                let there = f0 + (Rgb::WHITE - f0) * 0.462_664_4;
                (f0, Rgb::WHITE, (there - self.reflectance(1.0 / 7.0)) * 17.651_278)
            }
        }
    }

    /// Directional albedo of single scattering at an angle of cosine `cos`, for isotropic `alpha`, at
    /// which a perfect mirror loses `lost`: [`energy::isotropic_mirror_loss`].
    pub fn rough_albedo(&self, cos: f32, alpha: f32, lost: f32) -> Rgb {
        let [[r], [g], [b]] = self.rough_albedos([cos], alpha, [lost]);
        Rgb::new(r, g, b)
    }

    /// [`Fresnel::rough_albedo`] at several cosines, by channel.
    #[inline(always)]
    pub(crate) fn rough_albedos<const N: usize>(&self, cos: [f32; N], alpha: f32, lost: [f32; N]) -> [[f32; N]; 3] {
        if alpha == 0.0 {
            return channels(cos.map(|cos| self.reflectance(cos)));
        }
        if let Self::Dielectric { ior, color } = self {
            let albedos = energy::dielectric_reflection_albedos(cos, alpha, *ior, lost);
            let tinted = |color: f32| lanes(|lane| color * albedos[lane]);
            return [tinted(color.r), tinted(color.g), tinted(color.b)];
        }
        // Evaluate bend and film at the typical angle of visible microfacets, which tilt towards
        // the viewer.
        let tilted = |cos: f32| cos + (1.0 - cos) * 1.2 * alpha / (1.0 + alpha);
        if let Self::ThinFilm { .. } = self {
            return channels(std::array::from_fn(|i| self.reflectance(tilted(cos[i])) * (1.0 - lost[i])));
        }
        let grazing = energy::grazing_albedos(cos, alpha, lost);
        let (f0, f90, bend) = self.schlick_fit();
        let bent = |cos: f32, lost: f32| {
            let (tilted, m) = (tilted(cos), 1.0 - tilted(cos));
            tilted * m * m * m * m * m * m * (1.0 - lost)
        };
        let bends = if bend.is_black() { [0.0; N] } else { lanes(|lane| bent(cos[lane], lost[lane])) };
        let channel = |f0: f32, f90: f32, bend: f32| {
            lanes(|lane| {
                let (lost, grazing, bent) = (lost[lane], grazing[lane], bends[lane]);
                (f0 * (1.0 - lost - grazing) + f90 * grazing - bend * bent).clamp(0.0, 1.0)
            })
        };
        [channel(f0.r, f90.r, bend.r), channel(f0.g, f90.g, bend.g), channel(f0.b, f90.b, bend.b)]
    }

    /// Cosine-weighted mean over all directions: the reflectance of uniform light. Exact for colors
    /// and dielectrics; a conductor's index of refraction is replaced by the Schlick curve that
    /// fits best, within 0.01.
    pub fn mean_reflectance(&self) -> Rgb {
        if let Self::Dielectric { ior, color } = self {
            return *color * mean_dielectric_reflectance(*ior);
        }
        if let Self::ThinFilm { .. } = self {
            // Three-point Gauss-Legendre quadrature.
            let [a, b, c] = [0.112_701_67, 0.5, 0.887_298_35].map(|cos| self.reflectance(cos) * (2.0 * cos));
            return (a + c) * (5.0 / 18.0) + b * (8.0 / 18.0);
        }
        let (f0, f90, bend) = self.schlick_fit();
        (f0 + (f90 - f0) / 21.0 - bend / 126.0).map(|share| share.clamp(0.0, 1.0))
    }
}

/// The channels of several colors.
#[inline]
fn channels<const N: usize>(colors: [Rgb; N]) -> [[f32; N]; 3] {
    [colors.map(|color| color.r), colors.map(|color| color.g), colors.map(|color| color.b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close;

    #[test]
    fn tinted_fresnel_interpolates_its_colors_and_averages_match_integrals() {
        let (f0, edge) = (Rgb::new(0.9, 0.5, 0.2), Rgb::new(0.8, 1.0, 0.6));
        let fresnel = Fresnel::tinted(f0, edge);
        assert_eq!(fresnel.reflectance(1.0), f0);
        let plain = schlick(1.0 / 7.0, f0, Rgb::WHITE);
        let at = fresnel.reflectance(1.0 / 7.0);
        assert!(close(at.r, plain.r * 0.8, 1e-5) && close(at.g, plain.g, 1e-5) && close(at.b, plain.b * 0.6, 1e-5));
        let gold = Fresnel::Complex { eta: Rgb::new(0.156, 0.424, 1.383), k: Rgb::new(3.602, 2.472, 1.915) };
        let glossy = Fresnel::Schlick { f0: Rgb::splat(0.04), f90: Rgb::splat(0.5) };
        for (fresnel, tolerance) in [
            (fresnel, 1e-4),
            (gold, 0.01),
            (glossy, 1e-4),
            (Fresnel::WHITE, 1e-6),
            (Fresnel::Dielectric { ior: 1.5, color: f0 }, 1e-3),
        ] {
            let steps = 4000;
            let sum = (0..steps).fold(Rgb::BLACK, |sum, i| {
                let cos = (i as f32 + 0.5) / steps as f32;
                sum + fresnel.reflectance(cos) * (2.0 * cos)
            });
            let (mean, average) = (sum / steps as f32, fresnel.mean_reflectance());
            for (a, b) in mean.to_array().into_iter().zip(average.to_array()) {
                assert!(close(a, b, tolerance), "{fresnel:?}: {mean:?} {average:?}");
            }
        }
    }
}
