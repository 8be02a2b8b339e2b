//! Environment map: an equirectangular image of infinitely distant surroundings.
//!
//! ```json
//! {"environment": {"file": "meadow.exr", "scale": 1, "rotation_degrees": 30, "up": [0, 1, 0]}}
//! ```
//!
//! The image's first row is up, +Y. From left to right it shows -Z, +X (at a quarter), +Z, -X.
//! Lookups use bilinear interpolation, across the seam too.
//!
//! Directions are importance-sampled by the luminance above its mean (MIS compensation: Karlík,
//! Šik, Vévoda, Skřivan, Křivánek, 2019); BSDF sampling covers the rest. Deviation: a tenth of the
//! luminance is added, so the density is above 0 wherever there is light, and light sampling alone
//! is unbiased.

use super::direction_table::{DirectionTable, azimuth_turns};
use super::orientation::{Orientation, check_direction, in_range};
use super::{Background, BackgroundSample, InvalidBackground, check_color};
use juggler_math::{Image, MAX_LIGHT, Ray, Rgb, Vec2, Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// Environment map: an equirectangular image of infinitely distant surroundings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Environment {
    /// Path of the image (OpenEXR, Radiance HDR, TIFF, PNG, JPEG or another format of textures),
    /// relative to the scene file. The image is equirectangular, twice as wide as high, with the
    /// first row up.
    pub file: String,
    /// Factor on the radiance of the image.
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1e30))]
    pub scale: f32,
    /// Rotation about the vertical axis in degrees, from -10,000 to 10,000, counterclockwise as
    /// seen from above.
    #[serde(default)]
    #[schemars(range(min = -10000, max = 10000), extend("x-unit" = "degrees"))]
    pub rotation_degrees: f32,
    /// Direction of the image's top in world space, of any length.
    #[serde(default = "up")]
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Radiance that camera rays see instead, also through masks and through clear or rough glass
    /// without reflection inside. All other rays see the image. By default camera rays see it, too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub visible_as: Option<Rgb>,
    /// Image from [`Environment::load`] or [`Environment::set_panorama`], shared by clones.
    #[serde(skip)]
    panorama: Option<Arc<Panorama>>,
    /// Rotation computed by [`Background::prepare`].
    #[serde(skip)]
    orientation: Orientation,
}

fn one() -> f32 {
    1.0
}

fn up() -> Vec3 {
    Vec3::Y
}

/// Image of all directions with its sampling tables. Costly to create, shared at no cost.
#[derive(Clone, PartialEq)]
pub struct Panorama {
    image: Image,
    directions: DirectionTable,
    /// Mean radiance over all directions.
    mean: Rgb,
    /// Maximum channel of all pixels.
    max_channel: f32,
    /// Number of pixels that were infinite in the image.
    infinite_pixels: usize,
}

/// Largest finite half float, which replaces infinity.
const LARGEST_HALF: f32 = 65_504.0;

impl fmt::Debug for Panorama {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {} pixels", self.image.width(), self.image.height())
    }
}

impl Environment {
    /// Creates an environment without an image; see [`Environment::load`] and
    /// [`Environment::set_panorama`].
    pub fn from_file(file: impl Into<String>) -> Self {
        let (visible_as, panorama, orientation) = (None, None, Orientation::default());
        Self { file: file.into(), scale: 1.0, rotation_degrees: 0.0, up: Vec3::Y, visible_as, panorama, orientation }
    }

    /// Sets the image of the file; call [`Background::prepare`] afterwards. Returns an error if the
    /// image is unusable.
    pub fn load(&mut self, image: Image) -> Result<(), InvalidBackground> {
        let wrong =
            |what: &str| InvalidBackground { field: "file", message: format!("`file` \"{}\" {what}", self.file) };
        self.panorama = Some(Arc::new(Panorama::new(image).map_err(wrong)?));
        Ok(())
    }

    /// Sets an image that several environments may share; call [`Background::prepare`] afterwards.
    pub fn set_panorama(&mut self, panorama: Arc<Panorama>) {
        self.panorama = Some(panorama);
    }
}

impl Panorama {
    /// Creates a panorama from an image whose first row is up, +Y. Negative and NaN channels become
    /// black, infinite ones the largest finite half float. Returns an error if there are no pixels.
    pub fn new(mut image: Image) -> Result<Self, &'static str> {
        let infinite_pixels = image.pixels().iter().filter(|pixel| pixel.max_channel() == f32::INFINITY).count();
        let light = |v: f32| match v {
            f32::INFINITY => LARGEST_HALF,
            v if v > 0.0 => v,
            _ => 0.0,
        };
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.map(light));
        let max_channel = image.pixels().iter().fold(0.0, |most: f32, pixel| most.max(pixel.max_channel()));
        let rows = image.height() as usize;
        let row_heights = DirectionTable::equal_angles(rows.max(1));
        let mean = mean(&image, &row_heights);
        let sampling_weights = sampling_weights(&image, mean.luminance());
        let directions =
            DirectionTable::new(image.width() as usize, row_heights, &sampling_weights).ok_or("has no pixels")?;
        Ok(Self { image, directions, mean, max_channel, infinite_pixels })
    }

    /// Number of pixels that were infinite in the image.
    pub fn infinite_pixels(&self) -> usize {
        self.infinite_pixels
    }

    /// Heap memory in bytes for a number of pixels.
    pub const fn bytes(pixels: usize) -> usize {
        // A pixel stores its color; its cell stores two numbers and at most half a cut point.
        pixels.saturating_mul(size_of::<Rgb>() + 2 * size_of::<f32>() + size_of::<u32>() / 2)
    }
}

/// Mean over the sphere by solid angle.
fn mean(image: &Image, row_heights: &[f64]) -> Rgb {
    let mut sum = [0.0; 3];
    let width = f64::from(image.width().max(1));
    for (row, height) in image.pixels().chunks(image.width().max(1) as usize).zip(row_heights.windows(2)) {
        let size = 0.5 * (height[0] - height[1]) / width;
        for pixel in row {
            for (channel, value) in sum.iter_mut().zip(pixel.to_array()) {
                *channel += f64::from(value) * size;
            }
        }
    }
    Rgb::from(sum.map(|v| v as f32))
}

/// Sampling weight of each pixel's cell: the mean luminance of the interpolated image over the cell
/// above `mean`, plus a tenth of it.
fn sampling_weights(image: &Image, mean: f32) -> Vec<f32> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let luminance: Vec<f32> = image.pixels().iter().map(|pixel| pixel.luminance()).collect();
    let blend = |a: f32, b: f32, c: f32| 0.125 * a + 0.75 * b + 0.125 * c;
    let across = |row: usize, x: usize| {
        let at = |x: usize| luminance[row * width + x % width];
        blend(at(x + width - 1), at(x), at(x + 1))
    };
    let cell = |i: usize| {
        let (x, y) = (i % width, i / width);
        let value = blend(across(y.saturating_sub(1), x), across(y, x), across((y + 1).min(height - 1), x));
        (value - mean).max(0.0) + 0.1 * value
    };
    (0..luminance.len()).map(cell).collect()
}

impl Panorama {
    /// Bilinear interpolation of the image in a local direction.
    fn radiance(&self, direction: Vec3) -> Rgb {
        let (width, height) = (self.image.width() as usize, self.image.height() as usize);
        let ring = (direction.x * direction.x + direction.z * direction.z).sqrt();
        let down = portable::atan2(ring, direction.y) * std::f32::consts::FRAC_1_PI;
        let (x, y) = (azimuth_turns(direction) * width as f32 - 0.5, down * height as f32 - 0.5);
        let (left, top) = (portable::floor(x), portable::floor(y));
        let (right_share, low_share) = (x - left, y - top);
        let column = |step: i64| match left as i64 + step {
            -1 => width.saturating_sub(1),
            column if column < width as i64 => column as usize,
            _ => 0,
        };
        let row = |step: i64| (top as i64 + step).clamp(0, height as i64 - 1) as usize;
        let pixel = |x: usize, y: usize| self.image.pixels().get(y * width + x).copied().unwrap_or_default();
        let (left, right, top, low) = (column(0), column(1), row(0), row(1));
        let upper = pixel(left, top).lerp(pixel(right, top), right_share);
        upper.lerp(pixel(left, low).lerp(pixel(right, low), right_share), low_share)
    }
}

impl Background for Environment {
    fn check(&self) -> Result<(), InvalidBackground> {
        in_range("scale", self.scale, 0.0, MAX_LIGHT)?;
        in_range("rotation_degrees", self.rotation_degrees, -1e4, 1e4)?;
        check_direction("up", self.up)?;
        self.visible_as.map_or(Ok(()), |color| check_color("visible_as", color))
    }

    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()?;
        let Some(panorama) = &self.panorama else {
            let message = format!("the picture \"{}\" is not loaded", self.file);
            return Err(InvalidBackground { field: "file", message });
        };
        in_range("scale", self.scale, 0.0, MAX_LIGHT / panorama.max_channel.max(1.0))?;
        self.orientation = Orientation::new(self.up, self.rotation_degrees);
        Ok(())
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        let Some(panorama) = &self.panorama else { return Rgb::BLACK };
        panorama.radiance(self.orientation.to_local(ray.direction)) * self.scale
    }

    fn visible_as(&self) -> Option<Rgb> {
        self.visible_as
    }

    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let panorama = self.panorama.as_ref()?;
        let (local, pdf) = panorama.directions.sample(u)?;
        Some(BackgroundSample { wi: self.orientation.to_world(local), pdf })
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        let pdf = |panorama: &Arc<Panorama>| panorama.directions.pdf(self.orientation.to_local(direction));
        self.panorama.as_ref().map_or(0.0, pdf)
    }

    fn mean_radiance(&self) -> Rgb {
        self.panorama.as_ref().map_or(Rgb::BLACK, |panorama| panorama.mean * self.scale)
    }

    fn heap_bytes(&self) -> usize {
        self.panorama.as_ref().map_or(0, |panorama| Panorama::bytes(panorama.image.pixels().len()))
    }
}

#[cfg(any(test, feature = "testing"))]
#[allow(clippy::unwrap_used, reason = "examples for tests")]
impl Environment {
    /// Image for tests, from a function of column and row.
    pub fn from_function(width: u32, height: u32, paint: impl Fn(u32, u32) -> Rgb) -> Self {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| paint(x, y)).collect();
        let mut environment = Self::from_file("painted");
        environment.load(Image::from_pixels(width, height, pixels).unwrap()).unwrap();
        environment.prepare().unwrap();
        environment
    }

    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let spots = Self::from_function(32, 16, |x, y| Rgb::splat(if (x * 7 + y * 5) % 23 == 0 { 9.0 } else { 0.3 }));
        let mut rotated = Self { scale: 2.5, rotation_degrees: 77.0, up: Vec3::new(0.3, 0.2, -2.0), ..spots.clone() };
        rotated.visible_as = Some(Rgb::new(0.9, 0.5, 0.2));
        rotated.prepare().unwrap();
        let single =
            Self::from_function(24, 12, |x, y| if (x, y) == (23, 3) { Rgb::new(50.0, 40.0, 30.0) } else { Rgb::BLACK });
        vec![
            spots,
            rotated,
            single,
            Self::from_function(3, 1, |_, _| Rgb::WHITE),
            Self::from_function(8, 4, |_, _| Rgb::BLACK),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(environment: &Environment, direction: Vec3) -> Rgb {
        environment.radiance(&Ray::new(Vec3::new(1.0, -7.0, 3.0), direction.normalize()))
    }

    #[test]
    fn panorama_orientation_matches_the_documentation() {
        // Red increases to the right, green increases downward.
        let panorama = Environment::from_function(64, 32, |x, y| Rgb::new(x as f32, y as f32, 0.0));
        for (direction, x, y) in [
            (Vec3::X, 16.0, 16.0),
            (Vec3::Z, 32.0, 16.0),
            (-Vec3::X, 48.0, 16.0),
            (Vec3::new(1.0, 2f32.sqrt(), -1.0), 8.0, 8.0),
            (Vec3::new(1.0, -(2f32.sqrt()), 1.0), 24.0, 24.0),
        ] {
            let color = at(&panorama, direction);
            assert!((color.r - x + 0.5).abs() < 1e-3 && (color.g - y + 0.5).abs() < 1e-3, "{direction} {color:?}");
        }
        // The poles use only their own row; the seam interpolates between both ends.
        assert!(at(&panorama, Vec3::Y).g == 0.0 && at(&panorama, -Vec3::Y).g == 31.0);
        assert!((at(&panorama, -Vec3::Z).r - 31.5).abs() < 0.01);
        let mut rotated = Environment { rotation_degrees: 90.0, ..panorama.clone() };
        rotated.prepare().unwrap();
        // Counterclockwise as seen from above, +X goes to -Z.
        assert!((at(&rotated, -Vec3::Z).r - 15.5).abs() < 1e-3);
    }

    #[test]
    fn uniform_panorama_is_sampled_uniformly() {
        let flat = Environment::from_function(16, 8, |_, _| Rgb::new(0.5, 1.0, 2.0));
        for u in [Vec2::new(0.1, 0.9), Vec2::ZERO, Vec2::splat(0.999)] {
            let sample = flat.sample(u).unwrap();
            assert!((sample.pdf * 4.0 * std::f32::consts::PI - 1.0).abs() < 1e-5, "{sample:?}");
            assert!((at(&flat, sample.wi).g - 1.0).abs() < 1e-6);
        }
        assert!((flat.mean_radiance().b - 2.0).abs() < 1e-6);
    }

    #[test]
    fn invalid_panoramas_are_rejected_and_invalid_pixels_are_black() {
        let mut environment = Environment::from_file("a.exr");
        assert_eq!(environment.prepare().unwrap_err().field, "file");
        assert!(environment.sample(Vec2::ZERO).is_none());
        let panorama = |v: f32| Panorama::new(Image::filled(2, 1, Rgb::splat(v)));
        assert_eq!(environment.load(Image::filled(0, 0, Rgb::BLACK)).unwrap_err().field, "file");
        let endless = panorama(f32::INFINITY).unwrap();
        assert_eq!((endless.max_channel, endless.infinite_pixels()), (65_504.0, 2));
        assert_eq!(panorama(1e30).unwrap().infinite_pixels(), 0);
        for nothing in [-3.0, f32::NAN] {
            environment.set_panorama(Arc::new(panorama(nothing).unwrap()));
            environment.prepare().unwrap();
            assert_eq!((environment.mean_radiance(), at(&environment, Vec3::X)), (Rgb::BLACK, Rgb::BLACK));
        }
        environment.set_panorama(Arc::new(panorama(1e30).unwrap()));
        assert!(environment.prepare().is_ok());
        assert_eq!(Environment { scale: 10.0, ..environment }.prepare().unwrap_err().field, "scale");
    }
}
