//! Physical sky with the sun, for clear days and twilight.
//!
//! ```json
//! {"sky": {"sun_elevation_degrees": 35, "sun_azimuth_degrees": 135, "turbidity": 2,
//!     "ground_albedo": [0.3, 0.3, 0.3], "intensity": 1, "sun": true, "up": [0, 1, 0]}}
//! ```
//!
//! Scattering of sunlight in the atmosphere is computed in `atmosphere.rs`. With an intensity of 1,
//! a white diffuse surface above the atmosphere that faces the sun has a radiance of 1. On the
//! ground the radiance is slightly lower, and a blue sky has about a tenth of it. The sun is a disk
//! of its true size, without limb darkening. The region below the horizon is flat ground, lit by
//! sun and sky.
//!
//! The sun is sampled as a cone, the rest from a table; the density is that of the mixture.

use super::atmosphere::{Atmosphere, GROUND, haze_asymmetry, haze_phase};
use super::direction_table::{DirectionTable, direction};
use super::orientation::{Orientation, check_direction, in_range};
use super::{Background, BackgroundSample, InvalidBackground};
use juggler_math::{DVec3, Frame, MAX_LIGHT, Ray, Rgb, Vec2, Vec3, portable, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::fmt;
use std::sync::Arc;

/// Angular radius of the sun as seen from the earth, in degrees.
const SUN_DEGREES: f32 = 0.2665;

/// Grid of the radiance table: elevations, denser towards the horizon, by azimuths relative to the
/// sun.
const ELEVATIONS: usize = 40;
const AZIMUTHS: usize = 25;

/// Rows and columns of the sampling table; each cell evaluates 2 × 2 directions.
const CELLS: usize = 96;

/// Physical sky with the sun, for clear days and twilight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Sky {
    /// Elevation of the sun above the horizon in degrees; negative values give twilight.
    #[schemars(range(min = -90, max = 90), extend("x-unit" = "degrees"))]
    pub sun_elevation_degrees: f32,
    /// Azimuth of the sun in degrees, from -10,000 to 10,000, clockwise as on a compass: 0 at -Z,
    /// 90 at +X.
    #[schemars(range(min = -10000, max = 10000), extend("x-unit" = "degrees"))]
    pub sun_azimuth_degrees: f32,
    /// Direction towards the sun, of any length, in the sky's local space with +Y up; replaces both
    /// angles.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub sun_direction: Option<Vec3>,
    /// Haziness of the air: 1 is air without haze, 2 a clear day, 10 thick haze.
    #[schemars(range(min = 1, max = 10))]
    pub turbidity: f32,
    /// Diffuse reflectance of the ground, 0 to 1 in every channel. Light from the ground also
    /// brightens the sky.
    pub ground_albedo: Rgb,
    /// Factor on the radiance of sky, sun and ground.
    #[schemars(range(min = 0, max = 1e30))]
    pub intensity: f32,
    /// Whether the sun's disk and its direct light are included.
    pub sun: bool,
    /// Direction of the sky's zenith in world space, of any length.
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Tables computed by [`Background::prepare`], shared by clones; not part of the description.
    #[serde(skip)]
    pub prepared: PreparedSky,
}

/// Tables that [`Background::prepare`] computes for a [`Sky`]; empty before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PreparedSky(Option<Arc<Tables>>);

impl Default for Sky {
    fn default() -> Self {
        Self {
            sun_elevation_degrees: 35.0,
            sun_azimuth_degrees: 135.0,
            sun_direction: None,
            turbidity: 2.0,
            ground_albedo: Rgb::splat(0.3),
            intensity: 1.0,
            sun: true,
            up: Vec3::Y,
            prepared: PreparedSky::default(),
        }
    }
}

/// Tables of a sky in its local space.
#[derive(Clone, PartialEq)]
struct Tables {
    orientation: Orientation,
    /// Unit direction to the sun's center.
    sun: Vec3,
    /// Radiance of the sun's disk; black if the sun is not included.
    disk: Rgb,
    /// Radiance of the ground.
    ground: Rgb,
    /// Radiance table, rows of elevation: light scattered by air or more than once, and light
    /// scattered once by haze without the phase function.
    without_haze: Vec<Rgb>,
    haze: Vec<Rgb>,
    /// Asymmetry of the phase function of haze.
    haze_asymmetry: f32,
    directions: DirectionTable,
    /// Probability of sampling the sun.
    sun_probability: f32,
    mean: Rgb,
}

impl fmt::Debug for Tables {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tables").field("sun", &self.sun).field("mean", &self.mean).finish_non_exhaustive()
    }
}

/// 1 - cos of the sun's angular radius.
fn sun_size() -> f32 {
    warp::cone_size(SUN_DEGREES.to_radians())
}

impl Sky {
    /// Creates a clear sky with the sun at an elevation and an azimuth.
    pub fn new(sun_elevation_degrees: f32, sun_azimuth_degrees: f32) -> Self {
        Self { sun_elevation_degrees, sun_azimuth_degrees, ..Self::default() }
    }

    /// Unit direction to the sun in local space.
    fn sun(&self) -> Vec3 {
        if let Some(towards) = self.sun_direction {
            return towards.normalize_or(Vec3::Y);
        }
        let (sin, cos) = portable::sin_cos(self.sun_elevation_degrees.to_radians());
        let (sin_turn, cos_turn) = portable::sin_cos(self.sun_azimuth_degrees.to_radians());
        Vec3::new(cos * sin_turn, sin, -cos * cos_turn)
    }
}

impl Tables {
    fn new(sky: &Sky) -> Option<Self> {
        let sun = sky.sun();
        let [r, g, b] = sky.ground_albedo.to_array().map(f64::from);
        let atmosphere = Atmosphere::new(f64::from(sky.turbidity), DVec3::new(r, g, b));
        // Irradiance above the atmosphere.
        let irradiance = f64::from(PI * sky.intensity);
        let (without_haze, haze) = colors(&atmosphere, sun, irradiance);
        let is_risen = sky.sun && sun.y > -portable::sin(SUN_DEGREES.to_radians());
        let disk = atmosphere.transmittance_to_top(GROUND, f64::from(sun.y.max(0.0))) * irradiance
            / f64::from(TAU * sun_size());
        let directions = DirectionTable::new(1, vec![1.0, -1.0], &[0.0])?;
        let mut tables = Self {
            orientation: Orientation::new(sky.up, 0.0),
            sun,
            disk: if is_risen { rgb(disk) } else { Rgb::BLACK },
            ground: Rgb::BLACK,
            without_haze,
            haze,
            haze_asymmetry: haze_asymmetry(sky.turbidity),
            directions,
            sun_probability: 0.0,
            mean: Rgb::BLACK,
        };
        let direct = rgb(atmosphere.sunlight(GROUND, f64::from(sun.y)) * irradiance) * sun.y.max(0.0);
        tables.compute_ground_and_sampling(if sky.sun { direct } else { Rgb::BLACK }, sky.ground_albedo)?;
        Some(tables)
    }

    /// Computes the radiance of the ground and the sampling table.
    fn compute_ground_and_sampling(&mut self, direct: Rgb, albedo: Rgb) -> Option<()> {
        let row_heights = DirectionTable::equal_heights(CELLS);
        let cell_directions: Vec<Vec3> = (0..4 * CELLS * CELLS).map(|i| cell_direction(&row_heights, i)).collect();
        // All directions have the same solid angle.
        let size = 4.0 * PI / cell_directions.len() as f32;
        let above = || cell_directions.iter().filter(|direction| direction.y > 0.0);
        let irradiance = above().fold(direct, |sum, direction| sum + self.scattered(*direction) * (direction.y * size));
        self.ground = albedo * irradiance / PI;
        let colors: Vec<Rgb> = cell_directions.iter().map(|direction| self.scattered(*direction)).collect();
        let sampling_weights: Vec<f32> =
            colors.chunks_exact(4).map(|cell| cell.iter().map(|color| color.luminance()).sum::<f32>() * 0.25).collect();
        self.directions = DirectionTable::new(CELLS, row_heights, &sampling_weights)?;
        let around = colors.iter().fold(Rgb::BLACK, |sum, color| sum + *color) * size;
        let sun = self.disk * (TAU * sun_size() * self.visible_sun_fraction());
        self.mean = (around + sun) / (4.0 * PI);
        let total = (around + sun).luminance();
        self.sun_probability = if total > 0.0 { sun.luminance() / total } else { 0.0 };
        Some(())
    }

    /// Fraction of the sun's disk above the horizon.
    fn visible_sun_fraction(&self) -> f32 {
        let x = (self.sun.y / portable::sin(SUN_DEGREES.to_radians())).clamp(-1.0, 1.0);
        (portable::acos(-x) + x * (1.0 - x * x).sqrt()) / PI
    }

    /// Radiance of air and ground.
    fn scattered(&self, direction: Vec3) -> Rgb {
        if direction.y < 0.0 {
            return self.ground;
        }
        let row = (portable::asin(direction.y) / FRAC_PI_2).sqrt() * (ELEVATIONS - 1) as f32;
        let across = direction.x * self.sun.z - direction.z * self.sun.x;
        let along = direction.x * self.sun.x + direction.z * self.sun.z;
        let column = portable::atan2(across.abs(), along) / PI * (AZIMUTHS - 1) as f32;
        let (top, left) = ((row as usize).min(ELEVATIONS - 2), (column as usize).min(AZIMUTHS - 2));
        let (down, right) = (row - top as f32, column - left as f32);
        let look_up = |table: &[Rgb]| {
            let at = |row: usize, column: usize| table.get(row * AZIMUTHS + column).copied().unwrap_or_default();
            let line = |row: usize| at(row, left).lerp(at(row, left + 1), right);
            line(top).lerp(line(top + 1), down)
        };
        look_up(&self.without_haze) + look_up(&self.haze) * haze_phase(self.haze_asymmetry, direction.dot(self.sun))
    }

    /// Whether a direction hits the sun's disk. The chord stays accurate where cosines lose
    /// precision.
    fn in_sun(&self, direction: Vec3) -> bool {
        (direction - self.sun).length_squared() <= 2.0 * sun_size()
    }

    fn radiance(&self, direction: Vec3) -> Rgb {
        let scattered = self.scattered(direction);
        if direction.y >= 0.0 && self.in_sun(direction) { scattered + self.disk } else { scattered }
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        let sun = if self.in_sun(direction) { warp::uniform_cone_pdf(sun_size()) } else { 0.0 };
        self.sun_probability * sun + (1.0 - self.sun_probability) * self.directions.pdf(direction)
    }
}

fn rgb(v: DVec3) -> Rgb {
    Rgb::new(v.x as f32, v.y as f32, v.z as f32)
}

/// Radiance of the sky at the grid points of its table.
fn colors(atmosphere: &Atmosphere, sun: Vec3, irradiance: f64) -> (Vec<Rgb>, Vec<Rgb>) {
    let sun = sun.as_dvec3();
    let aside = DVec3::new(sun.x, 0.0, sun.z).normalize_or(DVec3::X);
    let across = DVec3::new(-aside.z, 0.0, aside.x);
    let color = |i: usize| {
        let fraction = (i / AZIMUTHS) as f64 / (ELEVATIONS - 1) as f64;
        let (sin, cos) = portable::sin_cos_f64(fraction * fraction * f64::from(FRAC_PI_2));
        let turn = (i % AZIMUTHS) as f64 / (AZIMUTHS - 1) as f64 * std::f64::consts::PI;
        let (sin_turn, cos_turn) = portable::sin_cos_f64(turn);
        let light = atmosphere.sky((aside * cos_turn + across * sin_turn) * cos + DVec3::Y * sin, sun);
        (rgb(light.without_haze * irradiance), rgb(light.haze * irradiance))
    };
    (0..ELEVATIONS * AZIMUTHS).map(color).unzip()
}

/// One of the four directions in each cell of the sampling table.
fn cell_direction(row_heights: &[f64], i: usize) -> Vec3 {
    let (cell, corner) = (i / 4, i % 4);
    let row = (cell / CELLS) as f64 + 0.25 + 0.5 * (corner / 2) as f64;
    let column = (cell % CELLS) as f32 + 0.25 + 0.5 * (corner % 2) as f32;
    direction(column / CELLS as f32, DirectionTable::row_height(row_heights, row))
}

impl Background for Sky {
    fn check(&self) -> Result<(), InvalidBackground> {
        in_range("sun_elevation_degrees", self.sun_elevation_degrees, -90.0, 90.0)?;
        in_range("sun_azimuth_degrees", self.sun_azimuth_degrees, -1e4, 1e4)?;
        in_range("turbidity", self.turbidity, 1.0, 10.0)?;
        self.ground_albedo.to_array().iter().try_for_each(|v| in_range("ground_albedo", *v, 0.0, 1.0))?;
        in_range("intensity", self.intensity, 0.0, MAX_LIGHT)?;
        check_direction("sun_direction", self.sun_direction.unwrap_or(Vec3::Y))?;
        check_direction("up", self.up)
    }

    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()?;
        self.prepared = PreparedSky(Tables::new(self).map(Arc::new));
        Ok(())
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        let Some(tables) = &self.prepared.0 else { return Rgb::BLACK };
        tables.radiance(tables.orientation.to_local(ray.direction))
    }

    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let tables = self.prepared.0.as_ref()?;
        let probability = tables.sun_probability;
        let local = if u.x < probability {
            let u = Vec2::new((u.x / probability).min(1f32.next_down()), u.y);
            Frame::around(tables.sun).to_world(warp::uniform_cone(u, sun_size() * (1.0 - 1e-4)))
        } else {
            let u = Vec2::new(((u.x - probability) / (1.0 - probability)).min(1f32.next_down()), u.y);
            tables.directions.sample(u)?.0
        };
        let pdf = tables.pdf(local);
        let wi = tables.orientation.to_world(local);
        (pdf > 0.0).then_some(BackgroundSample { wi, pdf })
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        self.prepared.0.as_ref().map_or(0.0, |tables| tables.pdf(tables.orientation.to_local(direction)))
    }

    fn mean_radiance(&self) -> Rgb {
        self.prepared.0.as_ref().map_or(Rgb::BLACK, |tables| tables.mean)
    }

    fn heap_bytes(&self) -> usize {
        self.prepared.0.as_ref().map_or(0, |_| {
            size_of::<Tables>() + 2 * ELEVATIONS * AZIMUTHS * size_of::<Rgb>() + 2 * CELLS * CELLS * size_of::<f32>()
        })
    }
}

#[cfg(any(test, feature = "testing"))]
#[allow(clippy::unwrap_used, reason = "examples for tests")]
impl Sky {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let dusk = Self { sun_elevation_degrees: -4.0, turbidity: 4.0, ..Self::default() };
        let setting = Self { sun_elevation_degrees: 0.1, up: Vec3::new(0.3, 0.1, 1.0), ..Self::default() };
        let pale =
            Self { sun_direction: Some(Vec3::Y * 3.0), sun: false, ground_albedo: Rgb::BLACK, ..Self::default() };
        let mut all = vec![Self::default(), dusk, setting, pale];
        all.iter_mut().for_each(|sky| sky.prepare().unwrap());
        all
    }
}

#[cfg(test)]
mod tests;
