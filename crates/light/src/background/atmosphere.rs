//! Light of the sun on its way through a clear atmosphere (Hillaire, A Scalable and Production Ready Sky and Atmosphere
//! Rendering Technique, 2020): scattered once along the way, and any number of times by the closed form of its
//! section 5.5. Coefficients of its table 1, with the absorption of haze as in Bruneton and Neyret (2008).
//!
//! Lengths in kilometres. Three channels, red, green and blue, travel as one vector. The sun's irradiance above the
//! atmosphere is 1.

use juggler_math::{DVec3, fun};
use std::f64::consts::PI;

/// Radius of the ground, and of where the atmosphere ends.
pub(super) const GROUND: f64 = 6360.0;
const TOP: f64 = 6460.0;
/// Scattering of air at sea level, per kilometre.
const AIR: DVec3 = DVec3::new(5.802e-3, 13.558e-3, 33.1e-3);
const AIR_HEIGHT: f64 = 8.0;
/// Scattering and extinction of haze at sea level, before the turbidity's factor.
const HAZE: f64 = 3.996e-3;
const HAZE_EXTINCTION: f64 = 4.44e-3;
const HAZE_HEIGHT: f64 = 1.2;
/// Absorption of ozone where it is densest, 25 km up; nothing 15 km below and above.
const OZONE: DVec3 = DVec3::new(0.650e-3, 1.881e-3, 0.085e-3);
/// Sine of the sun's angular radius.
const SUN_SINE: f64 = 0.004_651;

/// Sizes of tables: by height and by direction.
const CLEAR: [usize; 2] = [32, 64];
const REPEATED: [usize; 2] = [10, 24];

/// The atmosphere with tables of what gets through, and what arrives after many scatterings.
pub(super) struct Atmosphere {
    haze: f64,
    albedo: DVec3,
    clear: Vec<DVec3>,
    repeated: Vec<DVec3>,
}

/// What happens in a kilometre at some height.
struct Medium {
    air: DVec3,
    haze: f64,
    extinction: DVec3,
}

/// Light from a direction.
pub(super) struct Scattered {
    /// Scattered by air, or more than once.
    pub smooth: DVec3,
    /// Scattered once by haze, to be multiplied with its phase function.
    pub haze: DVec3,
}

impl Atmosphere {
    /// With this turbidity: how many times the air's own optical thickness straight up, in green, that of air and haze
    /// together is; 1 is air without haze. And with the share of light that the ground reflects.
    pub fn new(turbidity: f64, albedo: DVec3) -> Self {
        let haze = (turbidity - 1.0) * AIR.y * AIR_HEIGHT / (HAZE_EXTINCTION * HAZE_HEIGHT);
        let mut air = Self { haze, albedo, clear: Vec::new(), repeated: Vec::new() };
        air.clear = table(CLEAR, |y, x| air.depth_to_top(y, x).map(|depth| fun::exp_f64(-depth)));
        air.repeated = table(REPEATED, |y, x| air.often(GROUND + 0.001 + 99.0 * y * y, 2.0 * x - 1.0));
        air
    }

    fn medium(&self, radius: f64) -> Medium {
        let altitude = (radius - GROUND).max(0.0);
        let air = AIR * fun::exp_f64(-altitude / AIR_HEIGHT);
        let haze = self.haze * fun::exp_f64(-altitude / HAZE_HEIGHT);
        let ozone = (1.0 - (altitude - 25.0).abs() / 15.0).max(0.0);
        Medium { air, haze: haze * HAZE, extinction: air + DVec3::splat(haze * HAZE_EXTINCTION) + OZONE * ozone }
    }

    /// Optical depth to the end of the atmosphere, for the table's coordinates of height and direction, each from 0 to
    /// 1 (Bruneton, Precomputed Atmospheric Scattering: a New Implementation, 2017).
    fn depth_to_top(&self, y: f64, x: f64) -> DVec3 {
        const STEPS: u32 = 64;
        let horizon = (TOP * TOP - GROUND * GROUND).sqrt();
        let beside = horizon * y;
        let radius = (beside * beside + GROUND * GROUND).sqrt();
        let (least, most) = (TOP - radius, beside + horizon);
        let way = least + x * (most - least);
        let cos =
            if way > 0.0 { (horizon * horizon - beside * beside - way * way) / (2.0 * radius * way) } else { 1.0 };
        let step = |i: u32| {
            let (start, end) = (f64::from(i) / f64::from(STEPS), f64::from(i + 1) / f64::from(STEPS));
            let t = way * 0.5 * (start * start + end * end);
            let height = (radius * radius + t * t + 2.0 * radius * t * cos).sqrt();
            self.medium(height).extinction * (way * (end * end - start * start))
        };
        (0..STEPS).map(step).sum()
    }

    /// The share of the sun's light that arrives at a height from a direction with this cosine to the vertical. Where
    /// the ground hides it, none; while it sets, a part.
    pub fn sunlight(&self, radius: f64, cos: f64) -> DVec3 {
        let at_horizon = -(1.0 - (GROUND / radius).min(1.0) * (GROUND / radius).min(1.0)).sqrt();
        let seen = (0.5 + 0.5 * (cos - at_horizon) / SUN_SINE).clamp(0.0, 1.0);
        if seen == 0.0 { DVec3::ZERO } else { self.clear_to_top(radius, cos.max(at_horizon)) * seen }
    }

    /// The share of light that comes through from the end of the atmosphere, above the horizon.
    pub fn clear_to_top(&self, radius: f64, cos: f64) -> DVec3 {
        let horizon = (TOP * TOP - GROUND * GROUND).sqrt();
        let beside = (radius * radius - GROUND * GROUND).max(0.0).sqrt();
        let way = (radius * radius * (cos * cos - 1.0) + TOP * TOP).max(0.0).sqrt() - radius * cos;
        let (least, most) = (TOP - radius, beside + horizon);
        look_up(&self.clear, CLEAR, beside / horizon, (way - least) / (most - least))
    }

    /// Light that was scattered twice or more and is scattered again into any direction, at a height for a sun with
    /// this cosine to the vertical (the paper's equations 5 to 10).
    fn often(&self, radius: f64, sun_cos: f64) -> DVec3 {
        const ROWS: u32 = 8;
        const COLUMNS: u32 = 4;
        let sun = DVec3::new((1.0 - sun_cos * sun_cos).max(0.0).sqrt(), sun_cos, 0.0);
        let (mut second, mut share) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..ROWS * COLUMNS {
            let cos = 1.0 - 2.0 * (f64::from(i / COLUMNS) + 0.5) / f64::from(ROWS);
            let (sin_turn, cos_turn) = fun::sin_cos_f64(PI * (f64::from(i % COLUMNS) + 0.5) / f64::from(COLUMNS));
            let ring = (1.0 - cos * cos).sqrt();
            let from = DVec3::new(0.0, radius, 0.0);
            let direction = DVec3::new(ring * cos_turn, cos, ring * sin_turn);
            let (end, grounded) = way_end(radius, cos);
            let clear = self.march::<20>(from, direction, end, |place, medium, weight| {
                let scattering = medium.air + DVec3::splat(medium.haze);
                let height = place.length();
                second += weight * scattering * self.sunlight(height, place.dot(sun) / height) / (4.0 * PI);
                share += weight * scattering;
            });
            if grounded {
                let place = from + direction * end;
                let cos = place.dot(sun) / place.length();
                second += clear * self.albedo * self.sunlight(GROUND, cos) * (cos.max(0.0) / PI);
            }
        }
        let count = f64::from(ROWS * COLUMNS);
        (second / count) / (DVec3::ONE - share / count)
    }

    /// Walks along a way in steps that grow, and gives each place with what light of unit density added there counts at
    /// the start. What is left of light from the end.
    fn march<const STEPS: u32>(
        &self,
        from: DVec3,
        direction: DVec3,
        end: f64,
        mut at: impl FnMut(DVec3, &Medium, DVec3),
    ) -> DVec3 {
        let mut clear = DVec3::ONE;
        for i in 0..STEPS {
            let (start, stop) = (f64::from(i) / f64::from(STEPS), f64::from(i + 1) / f64::from(STEPS));
            let place = from + direction * (end * 0.5 * (start * start + stop * stop));
            let medium = self.medium(place.length());
            let step = end * (stop * stop - start * start);
            let passes = (medium.extinction * -step).map(fun::exp_f64);
            at(place, &medium, clear * (DVec3::ONE - passes) / medium.extinction.max(DVec3::splat(1e-12)));
            clear *= passes;
        }
        clear
    }

    /// Light of the sky seen from the ground, for unit directions with +Y up, none below the horizon.
    pub fn sky(&self, direction: DVec3, sun: DVec3) -> Scattered {
        /// Eyes above the ground.
        const EYES: f64 = 0.01;
        let from = DVec3::new(0.0, GROUND + EYES, 0.0);
        let (end, _) = way_end(from.y, direction.y.max(0.0));
        let between = direction.dot(sun);
        let air_phase = 3.0 / (16.0 * PI) * (1.0 + between * between);
        let mut light = Scattered { smooth: DVec3::ZERO, haze: DVec3::ZERO };
        self.march::<48>(from, direction, end, |place, medium, weight| {
            let height = place.length();
            let cos = place.dot(sun) / height;
            let arrives = self.sunlight(height, cos);
            let altitude = ((height - GROUND - 0.001) / 99.0).clamp(0.0, 1.0);
            let repeated = look_up(&self.repeated, REPEATED, altitude.sqrt(), 0.5 + 0.5 * cos);
            let often = (medium.air + DVec3::splat(medium.haze)) * repeated;
            light.smooth += weight * (medium.air * arrives * air_phase + often);
            light.haze += weight * arrives * medium.haze;
        });
        light
    }
}

/// How far it is from a height in a direction with this cosine to the ground, or else to where the atmosphere ends; and
/// whether it is the ground.
fn way_end(radius: f64, cos: f64) -> (f64, bool) {
    let beside = radius * radius * (cos * cos - 1.0);
    let ground = beside + GROUND * GROUND;
    if cos < 0.0 && ground >= 0.0 {
        return ((-radius * cos - ground.sqrt()).max(0.0), true);
    }
    ((beside + TOP * TOP).max(0.0).sqrt() - radius * cos, false)
}

/// A table over the unit square, its values on the lines of a grid.
fn table([rows, columns]: [usize; 2], value: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let share = |i: usize, count: usize| i as f64 / (count - 1) as f64;
    let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x)));
    cells.map(|(y, x)| value(share(y, rows), share(x, columns))).collect()
}

/// Blends the four nearest values of a table.
fn look_up(table: &[DVec3], [rows, columns]: [usize; 2], y: f64, x: f64) -> DVec3 {
    let split = |v: f64, count: usize| {
        let place = v.clamp(0.0, 1.0) * (count - 1) as f64;
        let low = (place as usize).min(count - 2);
        (low, place - low as f64)
    };
    let ((row, down), (column, right)) = (split(y, rows), split(x, columns));
    let at = |row: usize, column: usize| table.get(row * columns + column).copied().unwrap_or_default();
    let line = |row: usize| at(row, column).lerp(at(row, column + 1), right);
    line(row).lerp(line(row + 1), down)
}

/// How light that haze scatters spreads with the cosine to its old direction (Cornette and Shanks 1992, g = 0.8), per
/// steradian.
pub(super) fn haze_phase(cos: f32) -> f32 {
    const G: f32 = 0.8;
    let around = 1.0 + G * G - 2.0 * G * cos;
    3.0 / (8.0 * std::f32::consts::PI) * (1.0 - G * G) * (1.0 + cos * cos) / ((2.0 + G * G) * around * around.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_straight_down_passes_by_the_closed_form() {
        let air = Atmosphere::new(2.0, DVec3::ZERO);
        // Optical depths of layers that thin out, and of a tent of 15 km times its height; haze as much as air in green.
        let end = 1.0 - (-100.0f64 / 8.0).exp();
        let haze = AIR.y * AIR_HEIGHT;
        let depth = AIR * AIR_HEIGHT * end + DVec3::splat(haze) + OZONE * 15.0;
        let passes = air.clear_to_top(GROUND, 1.0);
        for channel in 0..3 {
            assert!((passes[channel] / (-depth[channel]).exp() - 1.0).abs() < 2e-3, "{passes} {depth}");
        }
        // The horizon is nearly forty times as thick (published for air: about 38).
        let thick = -air.clear_to_top(GROUND, 0.0).y.ln() / depth.y;
        assert!((30.0..80.0).contains(&thick), "{thick}");
        assert_eq!(air.sunlight(GROUND, -0.01), DVec3::ZERO);
    }

    #[test]
    fn phases_integrate_to_one() {
        let steps = 20_000;
        let cos = |i: i32| (f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0;
        let sum: f64 = (0..steps).map(|i| f64::from(haze_phase(cos(i) as f32))).sum();
        assert!((sum * 4.0 * PI / f64::from(steps) - 1.0).abs() < 1e-4);
    }

    /// What the air takes from the sun's rays and what the ground gets must not exceed what came in, and with a white
    /// ground and nothing that absorbs but ozone little is lost.
    #[test]
    fn the_sky_gives_no_more_light_than_the_sun() {
        for (turbidity, sun_sine) in [(1.0, 1.0), (3.0, 0.5), (3.0, 0.2f64)] {
            let air = Atmosphere::new(turbidity, DVec3::splat(0.3));
            let sun = DVec3::new((1.0 - sun_sine * sun_sine).sqrt(), sun_sine, 0.0);
            let mut diffuse = DVec3::ZERO;
            let (rows, columns) = (24, 24);
            for i in 0..rows * columns {
                let sine = (f64::from(i / columns) + 0.5) / f64::from(rows);
                let (s, c) = (PI * (f64::from(i % columns) + 0.5) / f64::from(columns)).sin_cos();
                let ring = (1.0 - sine * sine).sqrt();
                let direction = DVec3::new(ring * c, sine, ring * s);
                let light = air.sky(direction, sun);
                let phase = f64::from(haze_phase(direction.dot(sun) as f32));
                diffuse += (light.smooth + light.haze * phase) * sine * 2.0 * PI / f64::from(rows * columns);
            }
            let direct = air.sunlight(GROUND, sun_sine) * sun_sine;
            let total = diffuse + direct;
            assert!(total.max_element() < sun_sine * 1.02, "{turbidity}: {diffuse} {direct}");
            assert!(total.y > 0.5 * sun_sine, "{turbidity}: {diffuse} {direct}");
            // Blue above all in clear air.
            assert!(turbidity > 2.0 || diffuse.z > 1.5 * diffuse.x, "{diffuse}");
        }
    }
}
