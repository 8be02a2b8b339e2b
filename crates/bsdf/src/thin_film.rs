//! Thin-film interference: soap, oil, anodized titanium (Belcour and Barla 2017, "A practical
//! extension to microfacet theory for the modeling of varying iridescence"), in the RGB form of
//! KHR_materials_iridescence of glTF.
//!
//! Light is reflected at the film's top and, any number of times, at its base. Successive orders of
//! reflection differ by the optical path D = 2 η d cos θ2, and by half a wave where a reflection
//! inverts the phase. Their sum is a Fourier series in D over the wavelength. The eye's
//! sensitivities, as Gaussians in wave number, have closed Fourier transforms, of which two terms
//! suffice.

use super::fresnel::f0_from_ior;
use juggler_math::{Rgb, portable};
use std::f32::consts::{PI, TAU};

/// Thin film in air on a base of reflectance `f0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Reflectance of the base in air at normal incidence, 0 to 1.
    pub f0: Rgb,
    /// Index of refraction of the film, above 1.
    pub ior: f32,
    /// Thickness in nanometers.
    pub thickness_nm: f32,
}

impl ThinFilm {
    /// Reflectance at an angle of cosine `cos`, 0 to 1.
    pub fn reflectance(&self, cos: f32) -> Rgb {
        // Fade out a film that is much thinner than waves.
        let t = (self.thickness_nm / 0.03).clamp(0.0, 1.0);
        let ior = 1.0 + (self.ior - 1.0) * (t * t * (3.0 - 2.0 * t));
        let sin2 = (1.0 - cos * cos) / (ior * ior);
        if sin2 >= 1.0 {
            return Rgb::WHITE;
        }
        let below = (1.0 - sin2).sqrt();
        let top = schlick(f0_from_ior(ior), cos);
        let path = 2.0 * ior * self.thickness_nm * below;
        let ground = self.f0.map(|f0| schlick(f0_from_ior(ior_from_f0(f0) / ior), below));
        let phases = self.f0.map(|f0| if ior_from_f0(f0) < ior { PI } else { 0.0 });
        // Phase of internal reflection at the film's top.
        let top_phase = if ior < 1.0 { 0.0 } else { PI };
        let through = 1.0 - top;
        let round_trip = ground.map(|g| (top * g).clamp(1e-5, 0.9999));
        let all = Rgb::new(
            reflection_series(ground.r, round_trip.r),
            reflection_series(ground.g, round_trip.g),
            reflection_series(ground.b, round_trip.b),
        ) * (through * through);
        let mut sum = all + Rgb::splat(top);
        let mut term = all - Rgb::splat(through);
        for m in [1.0, 2.0] {
            term *= round_trip.map(f32::sqrt);
            sum += term * spectral_response(m * path, phases.map(|p| m * (p + top_phase))) * 2.0;
        }
        sum.map(|share| share.clamp(0.0, 1.0))
    }
}

fn schlick(f0: f32, cos: f32) -> f32 {
    let m = 1.0 - cos;
    let m2 = m * m;
    f0 + (1.0 - f0) * m2 * m2 * m
}

/// Sum of the geometric series of internal reflections, per transmittance of the film's top.
fn reflection_series(ground: f32, round_trip: f32) -> f32 {
    ground / (1.0 - round_trip)
}

/// Index of refraction of reflectance `f0` in air at normal incidence.
fn ior_from_f0(f0: f32) -> f32 {
    let root = f0.clamp(0.0, 0.9999).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// Response of red, green and blue to the wave cos(2π D / λ + phase), for a path D in nanometers
/// and a phase for each channel.
fn spectral_response(path_nm: f32, phase: Rgb) -> Rgb {
    let wave = TAU * path_nm * 1e-9;
    let lobe = |scale: f32, center: f32, variance: f32, phase: f32| {
        scale * (TAU * variance).sqrt() * portable::cos(center * wave + phase) * portable::exp(-variance * wave * wave)
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
    fn zero_thickness_thin_film_matches_schlick() {
        let thin_film = ThinFilm { f0: Rgb::new(0.04, 0.3, 0.9), ior: 1.4, thickness_nm: 0.0 };
        for cos in [1.0, 0.9, 0.8] {
            let shown = thin_film.reflectance(cos).to_array();
            for (f, f0) in shown.into_iter().zip(thin_film.f0.to_array()) {
                assert!(close(f, schlick(f0, cos), 0.02), "{cos}: {shown:?}");
            }
        }
    }

    #[test]
    fn quarter_wave_film_cancels_reflection_and_thick_film_is_colorless() {
        // A quarter-wave film of index √2.25 on glass of 2.25: reflections at top and base cancel
        // in green.
        let glass = Rgb::splat(f0_from_ior(2.25));
        let coated = ThinFilm { f0: glass, ior: 1.5, thickness_nm: 550.0 / 4.0 / 1.5 };
        assert!(coated.reflectance(1.0).g < 0.02 && glass.g > 0.14, "{:?}", coated.reflectance(1.0));
        // A half-wave film has no effect on its color.
        let half = ThinFilm { thickness_nm: 550.0 / 2.0 / 1.5, ..coated };
        assert!(close(half.reflectance(1.0).g, glass.g, 0.03), "{:?}", half.reflectance(1.0));
        let thick = ThinFilm { thickness_nm: 50_000.0, ..coated };
        let color = thick.reflectance(0.9);
        assert!(close(color.r, color.g, 1e-3) && close(color.g, color.b, 1e-3), "{color:?}");
    }
}
