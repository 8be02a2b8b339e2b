//! A picture of everything around, from far away: an equirectangular panorama.
//!
//! ```json
//! {"environment": {"file": "meadow.exr", "scale": 1, "rotation_degrees": 30, "up": [0, 1, 0]}}
//! ```
//!
//! The picture's first row is up, +Y. From left to right it shows -Z, +X (at a quarter), +Z, -X. Between pixels colours
//! are blended linearly, round the seam too.
//!
//! Directions are picked by what is brighter than the mean (MIS compensation: Karlík, Šik, Vévoda, Skřivan, Křivánek,
//! 2019): the even rest is found by those that the surface picks. Deviation: a tenth of the brightness itself stays, so
//! that the density is above 0 wherever there is light, and samples are right on their own, too.

use super::directions::{Directions, turn};
use super::orientation::{Orientation, check_direction, in_range};
use super::{Background, BackgroundSample, InvalidBackground};
use juggler_math::{Image, MAX_LIGHT, Ray, Rgb, Vec2, Vec3, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// A picture of everything around.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Environment {
    /// The picture (OpenEXR, Radiance HDR, PNG, JPEG), relative to the scene file: twice as wide as high, its first row
    /// up.
    pub file: String,
    /// Factor on its light.
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1e30))]
    pub scale: f32,
    /// How far it is turned about its vertical axis, counter-clockwise as seen from above.
    #[serde(default)]
    pub rotation_degrees: f32,
    /// Where its top points, any length.
    #[serde(default = "up")]
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// The picture that [`Environment::load`] or [`Environment::set_panorama`] was given: clones share it.
    #[serde(skip)]
    panorama: Option<Arc<Panorama>>,
    /// What [`Background::prepare`] makes of the numbers.
    #[serde(skip)]
    orientation: Orientation,
}

fn one() -> f32 {
    1.0
}

fn up() -> Vec3 {
    Vec3::Y
}

/// A picture of all directions, with what directions are picked from. Costly to make, free to share.
#[derive(Clone, PartialEq)]
pub struct Panorama {
    image: Image,
    directions: Directions,
    /// Mean over all directions.
    mean: Rgb,
    /// The greatest channel of any pixel.
    greatest: f32,
}

impl fmt::Debug for Panorama {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {} pixels", self.image.width(), self.image.height())
    }
}

impl Environment {
    /// One whose picture is to be given to [`Environment::load`] or [`Environment::set_panorama`].
    pub fn from_file(file: impl Into<String>) -> Self {
        let (panorama, orientation) = (None, Orientation::default());
        Self { file: file.into(), scale: 1.0, rotation_degrees: 0.0, up: Vec3::Y, panorama, orientation }
    }

    /// Takes the picture that the file holds, to be [prepared](Background::prepare) then; an error when that cannot be.
    pub fn load(&mut self, image: Image) -> Result<(), InvalidBackground> {
        let wrong =
            |what: &str| InvalidBackground { field: "file", message: format!("`file` \"{}\" {what}", self.file) };
        self.panorama = Some(Arc::new(Panorama::new(image).map_err(wrong)?));
        Ok(())
    }

    /// The same with a picture that others may show, too, to be [prepared](Background::prepare) then.
    pub fn set_panorama(&mut self, panorama: Arc<Panorama>) {
        self.panorama = Some(panorama);
    }
}

impl Panorama {
    /// Of a picture: its first row is up, +Y. Light that is negative or no number counts as none. When there are no
    /// pixels, or some are infinite, what is wrong with it.
    pub fn new(mut image: Image) -> Result<Self, &'static str> {
        let light = |v: f32| if v > 0.0 { v } else { 0.0 };
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.map(light));
        let greatest = image.pixels().iter().fold(0.0, |most: f32, pixel| most.max(pixel.max_channel()));
        if greatest == f32::INFINITY {
            return Err("has pixels without end");
        }
        let rows = image.height() as usize;
        let borders = Directions::equal_angles(rows.max(1));
        let mean = mean(&image, &borders);
        let brightness = brightness(&image, mean.luminance());
        let directions = Directions::new(image.width() as usize, borders, &brightness).ok_or("has no pixels")?;
        Ok(Self { image, directions, mean, greatest })
    }

    /// Bytes on the heap of one of so many pixels.
    pub const fn bytes(pixels: usize) -> usize {
        // A pixel's colour, and for its cell two numbers and half a cut point at most.
        pixels.saturating_mul(size_of::<Rgb>() + 2 * size_of::<f32>() + size_of::<u32>() / 2)
    }
}

/// Mean over the sphere.
fn mean(image: &Image, borders: &[f64]) -> Rgb {
    let mut sum = [0.0; 3];
    let width = f64::from(image.width().max(1));
    for (row, height) in image.pixels().chunks(image.width().max(1) as usize).zip(borders.windows(2)) {
        let size = 0.5 * (height[0] - height[1]) / width;
        for pixel in row {
            for (channel, value) in sum.iter_mut().zip(pixel.to_array()) {
                *channel += f64::from(value) * size;
            }
        }
    }
    Rgb::from(sum.map(|v| v as f32))
}

/// What each pixel's cell counts: the mean of the blended colours over it, above `mean` in full.
fn brightness(image: &Image, mean: f32) -> Vec<f32> {
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
    /// The blended colour in a direction of its own space.
    fn at(&self, direction: Vec3) -> Rgb {
        let (width, height) = (self.image.width() as usize, self.image.height() as usize);
        let ring = (direction.x * direction.x + direction.z * direction.z).sqrt();
        let down = fun::atan2(ring, direction.y) * std::f32::consts::FRAC_1_PI;
        let (x, y) = (turn(direction) * width as f32 - 0.5, down * height as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
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
        check_direction("up", self.up)
    }

    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()?;
        let Some(panorama) = &self.panorama else {
            let message = format!("the picture \"{}\" was not read", self.file);
            return Err(InvalidBackground { field: "file", message });
        };
        in_range("scale", self.scale, 0.0, MAX_LIGHT / panorama.greatest.max(1.0))?;
        self.orientation = Orientation::new(self.up, self.rotation_degrees);
        Ok(())
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        let Some(panorama) = &self.panorama else { return Rgb::BLACK };
        panorama.at(self.orientation.to_local(ray.direction)) * self.scale
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

    fn mean(&self) -> Rgb {
        self.panorama.as_ref().map_or(Rgb::BLACK, |panorama| panorama.mean * self.scale)
    }

    fn heap_bytes(&self) -> usize {
        self.panorama.as_ref().map_or(0, |panorama| Panorama::bytes(panorama.image.pixels().len()))
    }
}

#[cfg(any(test, feature = "testing"))]
#[allow(clippy::unwrap_used, reason = "examples for tests")]
impl Environment {
    /// A picture for tests, by a function of column and row.
    pub fn painted(width: u32, height: u32, paint: impl Fn(u32, u32) -> Rgb) -> Self {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| paint(x, y)).collect();
        let mut environment = Self::from_file("painted");
        environment.load(Image::from_pixels(width, height, pixels).unwrap()).unwrap();
        environment.prepare().unwrap();
        environment
    }

    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let spots = Self::painted(32, 16, |x, y| Rgb::splat(if (x * 7 + y * 5) % 23 == 0 { 9.0 } else { 0.3 }));
        let mut turned = Self { scale: 2.5, rotation_degrees: 77.0, up: Vec3::new(0.3, 0.2, -2.0), ..spots.clone() };
        turned.prepare().unwrap();
        let single =
            Self::painted(24, 12, |x, y| if (x, y) == (23, 3) { Rgb::new(50.0, 40.0, 30.0) } else { Rgb::BLACK });
        vec![spots, turned, single, Self::painted(3, 1, |_, _| Rgb::WHITE), Self::painted(8, 4, |_, _| Rgb::BLACK)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(environment: &Environment, direction: Vec3) -> Rgb {
        environment.radiance(&Ray::new(Vec3::new(1.0, -7.0, 3.0), direction.normalize()))
    }

    #[test]
    fn the_picture_lies_as_documented() {
        // Red grows to the right, green grows downwards.
        let panorama = Environment::painted(64, 32, |x, y| Rgb::new(x as f32, y as f32, 0.0));
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
        // The poles are the mean of nothing but their own row, the seam blends both ends.
        assert!(at(&panorama, Vec3::Y).g == 0.0 && at(&panorama, -Vec3::Y).g == 31.0);
        assert!((at(&panorama, -Vec3::Z).r - 31.5).abs() < 0.01);
        let mut turned = Environment { rotation_degrees: 90.0, ..panorama.clone() };
        turned.prepare().unwrap();
        // Counter-clockwise from above +X goes to -Z.
        assert!((at(&turned, -Vec3::Z).r - 15.5).abs() < 1e-3);
    }

    #[test]
    fn one_colour_is_that_everywhere_and_picked_evenly() {
        let flat = Environment::painted(16, 8, |_, _| Rgb::new(0.5, 1.0, 2.0));
        for u in [Vec2::new(0.1, 0.9), Vec2::ZERO, Vec2::splat(0.999)] {
            let sample = flat.sample(u).unwrap();
            assert!((sample.pdf * 4.0 * std::f32::consts::PI - 1.0).abs() < 1e-5, "{sample:?}");
            assert!((at(&flat, sample.wi).g - 1.0).abs() < 1e-6);
        }
        assert!((flat.mean().b - 2.0).abs() < 1e-6);
    }

    #[test]
    fn pictures_that_cannot_be_are_refused_and_odd_pixels_are_dark() {
        let mut environment = Environment::from_file("a.exr");
        assert_eq!(environment.prepare().unwrap_err().field, "file");
        assert!(environment.sample(Vec2::ZERO).is_none());
        let panorama = |v: f32| Panorama::new(Image::filled(2, 1, Rgb::splat(v)));
        assert_eq!(environment.load(Image::filled(0, 0, Rgb::BLACK)).unwrap_err().field, "file");
        assert_eq!(panorama(f32::INFINITY).err(), Some("has pixels without end"));
        for nothing in [-3.0, f32::NAN] {
            environment.set_panorama(Arc::new(panorama(nothing).unwrap()));
            environment.prepare().unwrap();
            assert_eq!((environment.mean(), at(&environment, Vec3::X)), (Rgb::BLACK, Rgb::BLACK));
        }
        environment.set_panorama(Arc::new(panorama(1e30).unwrap()));
        assert!(environment.prepare().is_ok());
        assert_eq!(Environment { scale: 10.0, ..environment }.prepare().unwrap_err().field, "scale");
    }
}
