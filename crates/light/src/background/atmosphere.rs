//! Scattering of sunlight in a clear atmosphere (Hillaire, A Scalable and Production Ready Sky and
//! Atmosphere Rendering Technique, 2020): single scattering along the view ray, multiple scattering
//! by the closed form of its section 5.5. Coefficients of air and ozone from its table 1. The haze
//! deviates from the paper: its extinction follows Ångström's law (1929), and its phase function is
//! that of Henyey and Greenstein (1941), with an asymmetry that grows with the turbidity. Its amount
//! and exponent are fitted to the clear skies of Hosek and Wilkie (2012); `tests/sky/agree.py`
//! prints the comparison.
//!
//! Lengths are in kilometers. Each vector holds three channels: red, green and blue. The sun's
//! irradiance above the atmosphere is 1.

use juggler_math::{DVec3, portable};
use std::f64::consts::PI;

/// Radii of the ground and of the top of the atmosphere.
pub(super) const GROUND: f64 = 6360.0;
const TOP: f64 = 6460.0;
/// Scattering coefficient of air at sea level, per kilometer, and scale height.
const AIR: DVec3 = DVec3::new(5.802e-3, 13.558e-3, 33.1e-3);
const AIR_HEIGHT: f64 = 8.0;
/// Wavelengths of the three channels, in nanometers.
const WAVELENGTHS: DVec3 = DVec3::new(680.0, 550.0, 440.0);
/// Vertical optical thickness of haze at 550 nm for each unit of turbidity above 1, relative to that
/// of air.
const HAZE_PER_TURBIDITY: f64 = 0.4;
/// Exponent of Ångström's law: the extinction of haze is proportional to wavelength^-exponent.
const HAZE_EXPONENT: f64 = 1.1;
/// Single-scattering albedo of haze: scattering over extinction.
const HAZE_ALBEDO: f64 = 0.95;
const HAZE_HEIGHT: f64 = 1.2;
/// Asymmetry g of the phase function of haze: in the clearest air, and from turbidity 5 on.
const HAZE_ASYMMETRY: [f32; 2] = [0.65, 0.7];
/// Absorption coefficient of ozone at its densest, at 25 km; 0 from 15 km below and above.
const OZONE: DVec3 = DVec3::new(0.650e-3, 1.881e-3, 0.085e-3);
/// Sine of the sun's angular radius.
const SUN_SINE: f64 = 0.004_651;

/// Sizes of the tables: heights and directions.
const TRANSMITTANCE_SIZE: [usize; 2] = [32, 64];
const MULTIPLE_SCATTERING_SIZE: [usize; 2] = [10, 24];

/// Atmosphere with tables of transmittance and of multiple scattering.
pub(super) struct Atmosphere {
    /// Extinction coefficient of haze at sea level, per kilometer.
    haze_extinction: DVec3,
    albedo: DVec3,
    transmittance: Vec<DVec3>,
    multiple_scattering: Vec<DVec3>,
}

/// Coefficients of the medium at some height, per kilometer.
struct Medium {
    air: DVec3,
    haze: DVec3,
    extinction: DVec3,
}

/// Scattered radiance from a direction.
pub(super) struct Scattered {
    /// Light scattered by air, or more than once.
    pub without_haze: DVec3,
    /// Light scattered once by haze, without the phase function.
    pub haze: DVec3,
}

impl Atmosphere {
    /// Creates an atmosphere and its tables. `turbidity` has the scale of Hosek and Wilkie: 1 is air
    /// without haze, and each further unit adds haze with 0.4 times the vertical optical thickness
    /// of air at 550 nm. `albedo` is the reflectance of the ground.
    pub fn new(turbidity: f64, albedo: DVec3) -> Self {
        let thickness = (turbidity - 1.0) * HAZE_PER_TURBIDITY * AIR.y * AIR_HEIGHT;
        let haze_extinction = haze_spectrum() * (thickness / HAZE_HEIGHT);
        let mut atmosphere =
            Self { haze_extinction, albedo, transmittance: Vec::new(), multiple_scattering: Vec::new() };
        atmosphere.transmittance =
            table(TRANSMITTANCE_SIZE, |y, x| atmosphere.depth_to_top(y, x).map(|depth| portable::exp_f64(-depth)));
        atmosphere.multiple_scattering = table(MULTIPLE_SCATTERING_SIZE, |y, x| {
            atmosphere.multiple_scattering(GROUND + 0.001 + 99.0 * y * y, 2.0 * x - 1.0)
        });
        atmosphere
    }

    fn medium(&self, radius: f64) -> Medium {
        let altitude = (radius - GROUND).max(0.0);
        let air = AIR * portable::exp_f64(-altitude / AIR_HEIGHT);
        let haze = self.haze_extinction * portable::exp_f64(-altitude / HAZE_HEIGHT);
        let ozone = (1.0 - (altitude - 25.0).abs() / 15.0).max(0.0);
        Medium { air, haze: haze * HAZE_ALBEDO, extinction: air + haze + OZONE * ozone }
    }

    /// Optical depth to the top of the atmosphere, for table coordinates of height and direction,
    /// each from 0 to 1 (Bruneton, Precomputed Atmospheric Scattering: a New Implementation, 2017).
    fn depth_to_top(&self, y: f64, x: f64) -> DVec3 {
        const STEPS: u32 = 64;
        let horizon = (TOP * TOP - GROUND * GROUND).sqrt();
        let to_horizon = horizon * y;
        let radius = (to_horizon * to_horizon + GROUND * GROUND).sqrt();
        let (min_distance, max_distance) = (TOP - radius, to_horizon + horizon);
        let distance = min_distance + x * (max_distance - min_distance);
        let cos = if distance > 0.0 {
            (horizon * horizon - to_horizon * to_horizon - distance * distance) / (2.0 * radius * distance)
        } else {
            1.0
        };
        let step = |i: u32| {
            let (start, end) = (f64::from(i) / f64::from(STEPS), f64::from(i + 1) / f64::from(STEPS));
            let t = distance * 0.5 * (start * start + end * end);
            let height = (radius * radius + t * t + 2.0 * radius * t * cos).sqrt();
            self.medium(height).extinction * (distance * (end * end - start * start))
        };
        (0..STEPS).map(step).sum()
    }

    /// Transmittance of sunlight at a radius, from a direction whose cosine to the vertical is
    /// `cos`; 0 if the ground hides the sun, partial while the sun sets.
    pub fn sunlight(&self, radius: f64, cos: f64) -> DVec3 {
        let at_horizon = -(1.0 - (GROUND / radius).min(1.0) * (GROUND / radius).min(1.0)).sqrt();
        let visible_fraction = (0.5 + 0.5 * (cos - at_horizon) / SUN_SINE).clamp(0.0, 1.0);
        if visible_fraction == 0.0 {
            DVec3::ZERO
        } else {
            self.transmittance_to_top(radius, cos.max(at_horizon)) * visible_fraction
        }
    }

    /// Transmittance from the top of the atmosphere, above the horizon.
    pub fn transmittance_to_top(&self, radius: f64, cos: f64) -> DVec3 {
        let horizon = (TOP * TOP - GROUND * GROUND).sqrt();
        let to_horizon = (radius * radius - GROUND * GROUND).max(0.0).sqrt();
        let distance = (radius * radius * (cos * cos - 1.0) + TOP * TOP).max(0.0).sqrt() - radius * cos;
        let (min_distance, max_distance) = (TOP - radius, to_horizon + horizon);
        look_up(
            &self.transmittance,
            TRANSMITTANCE_SIZE,
            to_horizon / horizon,
            (distance - min_distance) / (max_distance - min_distance),
        )
    }

    /// Isotropic radiance of multiple scattering at a radius, for a sun whose cosine to the
    /// vertical is `sun_cos` (equations 5 to 10 of the paper).
    fn multiple_scattering(&self, radius: f64, sun_cos: f64) -> DVec3 {
        const ROWS: u32 = 8;
        const COLUMNS: u32 = 4;
        let sun = DVec3::new((1.0 - sun_cos * sun_cos).max(0.0).sqrt(), sun_cos, 0.0);
        let (mut second, mut transfer) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..ROWS * COLUMNS {
            let cos = 1.0 - 2.0 * (f64::from(i / COLUMNS) + 0.5) / f64::from(ROWS);
            let (sin_turn, cos_turn) = portable::sin_cos_f64(PI * (f64::from(i % COLUMNS) + 0.5) / f64::from(COLUMNS));
            let ring = (1.0 - cos * cos).sqrt();
            let from = DVec3::new(0.0, radius, 0.0);
            let direction = DVec3::new(ring * cos_turn, cos, ring * sin_turn);
            let (end, grounded) = ray_end(radius, cos);
            let transmittance = self.march::<20>(from, direction, end, |point, medium, weight| {
                let scattering = medium.air + medium.haze;
                let height = point.length();
                second += weight * scattering * self.sunlight(height, point.dot(sun) / height) / (4.0 * PI);
                transfer += weight * scattering;
            });
            if grounded {
                let point = from + direction * end;
                let cos = point.dot(sun) / point.length();
                second += transmittance * self.albedo * self.sunlight(GROUND, cos) * (cos.max(0.0) / PI);
            }
        }
        let count = f64::from(ROWS * COLUMNS);
        (second / count) / (DVec3::ONE - transfer / count)
    }

    /// Marches along a ray in growing steps. Passes each point, its medium and the contribution of
    /// a unit source density there to the radiance at the start. Returns the transmittance of the
    /// whole ray.
    fn march<const STEPS: u32>(
        &self,
        from: DVec3,
        direction: DVec3,
        end: f64,
        mut at: impl FnMut(DVec3, &Medium, DVec3),
    ) -> DVec3 {
        let mut transmittance = DVec3::ONE;
        for i in 0..STEPS {
            let (start, stop) = (f64::from(i) / f64::from(STEPS), f64::from(i + 1) / f64::from(STEPS));
            let point = from + direction * (end * 0.5 * (start * start + stop * stop));
            let medium = self.medium(point.length());
            let step = end * (stop * stop - start * start);
            let step_transmittance = (medium.extinction * -step).map(portable::exp_f64);
            at(
                point,
                &medium,
                transmittance * (DVec3::ONE - step_transmittance) / medium.extinction.max(DVec3::splat(1e-12)),
            );
            transmittance *= step_transmittance;
        }
        transmittance
    }

    /// Radiance of the sky as seen from the ground, for unit directions with +Y up, above the
    /// horizon.
    pub fn sky(&self, direction: DVec3, sun: DVec3) -> Scattered {
        /// Height of the eye above the ground.
        const EYE_HEIGHT: f64 = 0.01;
        let from = DVec3::new(0.0, GROUND + EYE_HEIGHT, 0.0);
        let (end, _) = ray_end(from.y, direction.y.max(0.0));
        let between = direction.dot(sun);
        let air_phase = 3.0 / (16.0 * PI) * (1.0 + between * between);
        let mut light = Scattered { without_haze: DVec3::ZERO, haze: DVec3::ZERO };
        self.march::<48>(from, direction, end, |point, medium, weight| {
            let height = point.length();
            let cos = point.dot(sun) / height;
            let arrives = self.sunlight(height, cos);
            let altitude = ((height - GROUND - 0.001) / 99.0).clamp(0.0, 1.0);
            let multiple_scattering =
                look_up(&self.multiple_scattering, MULTIPLE_SCATTERING_SIZE, altitude.sqrt(), 0.5 + 0.5 * cos);
            let scattered_again = (medium.air + medium.haze) * multiple_scattering;
            light.without_haze += weight * (medium.air * arrives * air_phase + scattered_again);
            light.haze += weight * arrives * medium.haze;
        });
        light
    }
}

/// Distance from a radius to the ground, or otherwise to the top of the atmosphere, in a direction
/// with this cosine to the vertical; and whether the ray hits the ground.
fn ray_end(radius: f64, cos: f64) -> (f64, bool) {
    let minus_squared_offset = radius * radius * (cos * cos - 1.0);
    let ground = minus_squared_offset + GROUND * GROUND;
    if cos < 0.0 && ground >= 0.0 {
        return ((-radius * cos - ground.sqrt()).max(0.0), true);
    }
    ((minus_squared_offset + TOP * TOP).max(0.0).sqrt() - radius * cos, false)
}

/// Table over the unit square with values at the grid points.
fn table([rows, columns]: [usize; 2], value: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let fraction = |i: usize, count: usize| i as f64 / (count - 1) as f64;
    let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x)));
    cells.map(|(y, x)| value(fraction(y, rows), fraction(x, columns))).collect()
}

/// Bilinear interpolation of a table.
fn look_up(table: &[DVec3], [rows, columns]: [usize; 2], y: f64, x: f64) -> DVec3 {
    let split = |v: f64, count: usize| {
        let position = v.clamp(0.0, 1.0) * (count - 1) as f64;
        let low = (position as usize).min(count - 2);
        (low, position - low as f64)
    };
    let ((row, down), (column, right)) = (split(y, rows), split(x, columns));
    let at = |row: usize, column: usize| table.get(row * columns + column).copied().unwrap_or_default();
    let line = |row: usize| at(row, column).lerp(at(row, column + 1), right);
    line(row).lerp(line(row + 1), down)
}

/// Extinction of haze in each channel relative to that at 550 nm, by Ångström's law.
fn haze_spectrum() -> DVec3 {
    WAVELENGTHS.map(|wavelength| portable::exp_f64(-HAZE_EXPONENT * portable::ln_f64(wavelength / WAVELENGTHS.y)))
}

/// Asymmetry g of the phase function of haze: the mean cosine of the scattering angle.
pub(super) fn haze_asymmetry(turbidity: f32) -> f32 {
    let [clear, hazy] = HAZE_ASYMMETRY;
    clear + (hazy - clear) * ((turbidity - 1.0) / 4.0).clamp(0.0, 1.0)
}

/// Phase function of haze with asymmetry `g`, per steradian, for the cosine of the scattering angle
/// (Henyey and Greenstein 1941).
pub(super) fn haze_phase(g: f32, cos: f32) -> f32 {
    let around = 1.0 + g * g - 2.0 * g * cos;
    (1.0 - g * g) / (4.0 * std::f32::consts::PI * around * around.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_straight_down_passes_by_the_closed_form() {
        let atmosphere = Atmosphere::new(2.0, DVec3::ZERO);
        // Optical depths of two exponential profiles and of a tent of half width 15 km; the haze is
        // 0.4 times as thick as air in green.
        let end = 1.0 - (-100.0f64 / 8.0).exp();
        let haze = [680.0f64, 550.0, 440.0].map(|nm| 0.4 * AIR.y * AIR_HEIGHT * (nm / 550.0).powf(-1.1));
        let depth = AIR * AIR_HEIGHT * end + DVec3::from(haze) + OZONE * 15.0;
        let transmittance = atmosphere.transmittance_to_top(GROUND, 1.0);
        for channel in 0..3 {
            assert!((transmittance[channel] / (-depth[channel]).exp() - 1.0).abs() < 2e-3, "{transmittance} {depth}");
        }
        // The horizon is nearly 40 times as thick (published for air: about 38).
        let thick = -atmosphere.transmittance_to_top(GROUND, 0.0).y.ln() / depth.y;
        assert!((30.0..80.0).contains(&thick), "{thick}");
        assert_eq!(atmosphere.sunlight(GROUND, -0.01), DVec3::ZERO);
    }

    #[test]
    fn haze_phase_function_integrates_to_one() {
        let steps = 20_000;
        let cos = |i: i32| (f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0;
        for turbidity in [1.0, 2.0, 5.0, 10.0] {
            let g = haze_asymmetry(turbidity);
            let phase = |i: i32| f64::from(haze_phase(g, cos(i) as f32)) * 4.0 * PI / f64::from(steps);
            let sum: f64 = (0..steps).map(phase).sum();
            let mean_cosine: f64 = (0..steps).map(|i| phase(i) * cos(i)).sum();
            assert!((sum - 1.0).abs() < 1e-4 && (mean_cosine - f64::from(g)).abs() < 1e-4, "{sum} {mean_cosine}");
            assert!((0.65..=0.7).contains(&g));
        }
    }

    /// The irradiance of sky and sun does not exceed the sun's above the atmosphere, and more than
    /// half of it remains in green.
    #[test]
    fn the_sky_gives_no_more_light_than_the_sun() {
        for (turbidity, sun_sine) in [(1.0, 1.0), (3.0, 0.5), (3.0, 0.2f64)] {
            let atmosphere = Atmosphere::new(turbidity, DVec3::splat(0.3));
            let sun = DVec3::new((1.0 - sun_sine * sun_sine).sqrt(), sun_sine, 0.0);
            let mut diffuse = DVec3::ZERO;
            let (rows, columns) = (24, 24);
            for i in 0..rows * columns {
                let sine = (f64::from(i / columns) + 0.5) / f64::from(rows);
                let (s, c) = (PI * (f64::from(i % columns) + 0.5) / f64::from(columns)).sin_cos();
                let ring = (1.0 - sine * sine).sqrt();
                let direction = DVec3::new(ring * c, sine, ring * s);
                let light = atmosphere.sky(direction, sun);
                let phase = f64::from(haze_phase(haze_asymmetry(turbidity as f32), direction.dot(sun) as f32));
                diffuse += (light.without_haze + light.haze * phase) * sine * 2.0 * PI / f64::from(rows * columns);
            }
            let direct = atmosphere.sunlight(GROUND, sun_sine) * sun_sine;
            let total = diffuse + direct;
            assert!(total.max_element() < sun_sine * 1.02, "{turbidity}: {diffuse} {direct}");
            assert!(total.y > 0.5 * sun_sine, "{turbidity}: {diffuse} {direct}");
            // Clear air scatters mostly blue.
            assert!(turbidity > 2.0 || diffuse.z > 1.5 * diffuse.x, "{diffuse}");
        }
    }
}
