//! How much a surface mirrors at which angle: one of the curves that materials are described by.

use super::energy;
use super::film::Film;
use super::fresnel::{conductor, dielectric, dielectric_average, head_on, schlick};
use juggler_math::Rgb;

/// How a metal, or what is treated like one, mirrors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// By its complex index of refraction: exact for unpolarised light.
    Complex {
        /// Real part of the index, per channel.
        eta: Rgb,
        /// Extinction, per channel.
        k: Rgb,
    },
    /// By colours: Schlick's curve, bent so that it is `edge` times as high at an angle of cosine 1/7, some 82
    /// degrees (Kutz, Hašan and Edmondson 2021; Hoffman 2023: "F82 tint").
    Tinted {
        /// Colour head on, 0 to 1.
        f0: Rgb,
        /// `17.65 (f0 + (1 - f0) (6/7)⁵) (1 - edge)`: black for plain Schlick. See [`Fresnel::tinted`].
        bend: Rgb,
    },
    /// Schlick's curve to any colour at grazing angles.
    Schlick {
        /// Colour head on, 0 to 1.
        f0: Rgb,
        /// Colour at a grazing angle, 0 to 1.
        f90: Rgb,
    },
    /// The border of a clear medium, exactly; nothing is said of what goes through.
    Dielectric {
        /// Index of refraction behind over in front.
        ior: f32,
        /// Factor on what is mirrored, 0 to 1.
        color: Rgb,
    },
    /// A thin film over what mirrors like Schlick's curve from `film.f0` to white.
    Film {
        /// The film.
        film: Film,
        /// How much of the surface it covers, 0 to 1.
        amount: f32,
    },
}

impl Fresnel {
    /// Mirrors everything.
    pub const WHITE: Self = Self::Tinted { f0: Rgb::WHITE, bend: Rgb::BLACK };

    /// By the colour `f0` head on and the factor `edge` on Schlick's curve at 82 degrees, both 0 to 1.
    pub fn tinted(f0: Rgb, edge: Rgb) -> Self {
        // (6/7)⁵ and 7 (7/6)⁶: Schlick's curve there, and over what the bend's own curve is there.
        let there = f0 + (Rgb::WHITE - f0) * 0.462_664_4;
        Self::Tinted { f0, bend: there * (Rgb::WHITE - edge) * 17.651_278 }
    }

    /// The share that is mirrored at an angle of cosine `cos`, 0 to 1.
    #[inline]
    pub fn at(&self, cos: f32) -> Rgb {
        match self {
            Self::Complex { eta, k } => {
                Rgb::new(conductor(cos, eta.r, k.r), conductor(cos, eta.g, k.g), conductor(cos, eta.b, k.b))
            }
            Self::Tinted { f0, bend } => {
                let m = (1.0 - cos).clamp(0.0, 1.0);
                let m5 = m * m * m * m * m;
                let curve = *f0 + (Rgb::WHITE - *f0) * m5 - *bend * (cos * m5 * m);
                curve.map(|share| share.clamp(0.0, 1.0))
            }
            Self::Schlick { f0, f90 } => schlick(cos, *f0, *f90),
            Self::Dielectric { ior, color } => *color * dielectric(cos, *ior),
            Self::Film { film, amount } => schlick(cos, film.f0, Rgb::WHITE).lerp(film.at(cos), *amount),
        }
    }

    /// Colours head on and grazing, and the bend of [`Fresnel::Tinted`], of the Schlick curve that fits best.
    fn colors(&self) -> (Rgb, Rgb, Rgb) {
        match self {
            Self::Tinted { f0, bend } => (*f0, Rgb::WHITE, *bend),
            Self::Schlick { f0, f90 } => (*f0, *f90, Rgb::BLACK),
            Self::Dielectric { ior, color } => (*color * head_on(*ior), *color, Rgb::BLACK),
            Self::Complex { .. } | Self::Film { .. } => {
                let f0 = self.at(1.0);
                let there = f0 + (Rgb::WHITE - f0) * 0.462_664_4;
                (f0, Rgb::WHITE, (there - self.at(1.0 / 7.0)) * 17.651_278)
            }
        }
    }

    /// What rough metal mirrors in single scattering of light at an angle of cosine `cos`.
    pub fn mirrored(&self, cos: f32, alpha: f32) -> Rgb {
        if alpha == 0.0 {
            return self.at(cos);
        }
        if let Self::Dielectric { ior, color } = self {
            return *color * energy::dielectric_mirrored(cos, alpha, *ior);
        }
        let (lost, grazing) = (energy::mirror_loss(cos, alpha), energy::mirror_grazing(cos, alpha));
        // What is bent, and a film's colours, at the typical angle: rough surfaces turn their facets to the viewer.
        let tilted = cos + (1.0 - cos) * 1.2 * alpha / (1.0 + alpha);
        if let Self::Film { .. } = self {
            return self.at(tilted) * (1.0 - lost);
        }
        let (f0, f90, bend) = self.colors();
        let m = 1.0 - tilted;
        let bent = bend * (tilted * m * m * m * m * m * m * (1.0 - lost));
        (f0 * (1.0 - lost - grazing) + f90 * grazing - bent).map(|share| share.clamp(0.0, 1.0))
    }

    /// The mean over all directions, each weighted by its cosine: what is mirrored of even light. Exact for colours
    /// and clear media; a metal's index of refraction is taken by the colours that fit it best, within 0.01.
    pub fn average(&self) -> Rgb {
        if let Self::Dielectric { ior, color } = self {
            return *color * dielectric_average(*ior);
        }
        if let Self::Film { .. } = self {
            // Gauss and Legendre's three places.
            let [a, b, c] = [0.112_701_67, 0.5, 0.887_298_35].map(|cos| self.at(cos) * (2.0 * cos));
            return (a + c) * (5.0 / 18.0) + b * (8.0 / 18.0);
        }
        let (f0, f90, bend) = self.colors();
        (f0 + (f90 - f0) / 21.0 - bend / 126.0).map(|share| share.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close;

    #[test]
    fn tinted_curves_pass_through_their_colours_and_averages_are_means() {
        let (f0, edge) = (Rgb::new(0.9, 0.5, 0.2), Rgb::new(0.8, 1.0, 0.6));
        let fresnel = Fresnel::tinted(f0, edge);
        assert_eq!(fresnel.at(1.0), f0);
        let plain = schlick(1.0 / 7.0, f0, Rgb::WHITE);
        let at = fresnel.at(1.0 / 7.0);
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
                sum + fresnel.at(cos) * (2.0 * cos)
            });
            let (mean, average) = (sum / steps as f32, fresnel.average());
            for (a, b) in mean.to_array().into_iter().zip(average.to_array()) {
                assert!(close(a, b, tolerance), "{fresnel:?}: {mean:?} {average:?}");
            }
        }
    }
}
