//! Colours of a thin film on something: soap, oil, anodised titanium (Belcour and Barla 2017, "A practical extension to
//! microfacet theory for the modeling of varying iridescence"), in the RGB form of KHR_materials_iridescence of glTF.
//!
//! Light is mirrored at the film's top and, any number of times, at its ground; waves that come out beside each other
//! differ by the optical path D = 2 η d cos θ2 and by half a wave where they are mirrored by something denser. The sum of
//! all is a Fourier series in D over the wavelength; the eye's sensitivities, as Gaussians in wave number, have closed
//! Fourier transforms, of which two terms suffice.

use super::fresnel::head_on;
use juggler_math::{Rgb, fun};
use std::f32::consts::{PI, TAU};

/// A film in air on something of the colour `f0` head on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Colour of what is below in air, head on, 0 to 1.
    pub f0: Rgb,
    /// Index of refraction of the film, above 1.
    pub ior: f32,
    /// Thickness in nanometres.
    pub thickness_nm: f32,
}

impl Film {
    /// The share that is mirrored at an angle of cosine `cos`, 0 to 1.
    pub fn at(&self, cos: f32) -> Rgb {
        // A film much thinner than waves is none.
        let t = (self.thickness_nm / 0.03).clamp(0.0, 1.0);
        let ior = 1.0 + (self.ior - 1.0) * (t * t * (3.0 - 2.0 * t));
        let sin2 = (1.0 - cos * cos) / (ior * ior);
        if sin2 >= 1.0 {
            return Rgb::WHITE;
        }
        let below = (1.0 - sin2).sqrt();
        let top = schlick(head_on(ior), cos);
        let path = 2.0 * ior * self.thickness_nm * below;
        let ground = self.f0.map(|f0| schlick(head_on(index_of(f0) / ior), below));
        let phases = self.f0.map(|f0| if index_of(f0) < ior { PI } else { 0.0 });
        // At its top the film mirrors from within, denser side first: half a wave if it is the thinner medium.
        let turned = if ior < 1.0 { 0.0 } else { PI };
        let through = 1.0 - top;
        let both = ground.map(|g| (top * g).clamp(1e-5, 0.9999));
        let all =
            Rgb::new(rest(ground.r, both.r), rest(ground.g, both.g), rest(ground.b, both.b)) * (through * through);
        let mut sum = all + Rgb::splat(top);
        let mut term = all - Rgb::splat(through);
        for m in [1.0, 2.0] {
            term *= both.map(f32::sqrt);
            sum += term * sensitivity(m * path, phases.map(|p| m * (p + turned))) * 2.0;
        }
        sum.map(|share| share.clamp(0.0, 1.0))
    }
}

fn schlick(f0: f32, cos: f32) -> f32 {
    let m = 1.0 - cos;
    let m2 = m * m;
    f0 + (1.0 - f0) * m2 * m2 * m
}

/// A share of what comes out after any number of bounces.
fn rest(ground: f32, both: f32) -> f32 {
    ground / (1.0 - both)
}

/// The index of refraction that mirrors `f0` in air, head on.
fn index_of(f0: f32) -> f32 {
    let root = f0.clamp(0.0, 0.9999).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// What red, green and blue see of the wave cos(2π D / λ + phase), for a path D in nanometres and a phase each.
fn sensitivity(path_nm: f32, phase: Rgb) -> Rgb {
    let wave = TAU * path_nm * 1e-9;
    let lobe = |scale: f32, centre: f32, variance: f32, phase: f32| {
        scale * (TAU * variance).sqrt() * fun::cos(centre * wave + phase) * fun::exp(-variance * wave * wave)
    };
    let x = lobe(5.4856e-13, 1.681e6, 4.3278e9, phase.r) + lobe(9.747e-14, 2.2399e6, 4.5282e9, phase.r);
    let y = lobe(4.4201e-13, 1.7953e6, 9.3046e9, phase.g);
    let z = lobe(5.2481e-13, 2.2084e6, 6.6121e9, phase.b);
    // XYZ to linear sRGB (IEC 61966-2-1).
    Rgb::new(
        3.240_45 * x - 1.537_14 * y - 0.498_53 * z,
        -0.969_27 * x + 1.876_01 * y + 0.041_56 * z,
        0.055_64 * x - 0.204_03 * y + 1.057_23 * z,
    ) / 1.0685e-7
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close;

    #[test]
    fn no_film_is_schlicks_curve() {
        let film = Film { f0: Rgb::new(0.04, 0.3, 0.9), ior: 1.4, thickness_nm: 0.0 };
        for cos in [1.0, 0.9, 0.8] {
            let shown = film.at(cos).to_array();
            for (f, f0) in shown.into_iter().zip(film.f0.to_array()) {
                assert!(close(f, schlick(f0, cos), 0.02), "{cos}: {shown:?}");
            }
        }
    }

    #[test]
    fn a_film_between_two_indices_hides_what_is_below_and_a_thick_one_shows_no_colours() {
        // A quarter of a wave of index √1.5² on glass of 2.25: waves at top and ground cancel each other out in green.
        let glass = Rgb::splat(head_on(2.25));
        let coated = Film { f0: glass, ior: 1.5, thickness_nm: 550.0 / 4.0 / 1.5 };
        assert!(coated.at(1.0).g < 0.02 && glass.g > 0.14, "{:?}", coated.at(1.0));
        // Half a wave is no film for that colour.
        let half = Film { thickness_nm: 550.0 / 2.0 / 1.5, ..coated };
        assert!(close(half.at(1.0).g, glass.g, 0.03), "{:?}", half.at(1.0));
        let thick = Film { thickness_nm: 50_000.0, ..coated };
        let color = thick.at(0.9);
        assert!(close(color.r, color.g, 1e-3) && close(color.g, color.b, 1e-3), "{color:?}");
    }
}
