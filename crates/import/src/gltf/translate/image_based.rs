//! Image-based lights of scenes (EXT_lights_image_based) as environments: the faces of level 0 of
//! the cube map become an equirectangular picture, in which the light's rotation is applied.
//!
//! Deviation: the coefficients of irradiance and the other levels are not used, since paths compute
//! what they approximate.

use super::objects::View;
use crate::gltf::data::GltfData;
use crate::gltf::document::{Document, ImageBasedLight, Index};
use crate::gltf::error::Fault;
use glam::{DQuat, DVec3};
use juggler_imaging::{Limits, Raster, RasterSamples, decode_raster};
use juggler_light::background::{AnyBackground, Environment};
use juggler_math::{Rgb, portable};
use juggler_scene::Asset;
use std::io::Cursor;
use std::sync::OnceLock;

/// Maximum height of the picture, in pixels.
const MAX_HEIGHT: u32 = 2048;
/// Samples of a pixel along each axis.
const SAMPLES: u32 = 2;

/// Pictures of the image-based lights of a file, each computed at its first use.
#[derive(Debug, Default)]
pub struct ImageBased(Vec<OnceLock<Result<Asset, Fault>>>);

impl ImageBased {
    /// Lights of a document, none of them computed.
    pub fn new(document: &Document) -> Self {
        let count = document.extensions.lights_image_based.as_ref().map_or(0, |lights| lights.lights.len());
        Self((0..count).map(|_| OnceLock::new()).collect())
    }

    /// Environment of the chosen scene with its picture, if it has one. Radiance is taken as
    /// W/(m² sr), or divided by `efficacy`.
    ///
    /// # Errors
    ///
    /// A picture is broken, or the six of a cube map are not squares of the same size.
    pub fn environment(
        &self,
        view: &View<'_>,
        document: &Document,
        efficacy: f64,
    ) -> Result<Option<(AnyBackground, String, Asset)>, Fault> {
        let scene = view.selection.scene.and_then(|scene| document.scenes.get(scene));
        let index = scene.and_then(|scene| scene.extensions.light_image_based).map(|light| light.light.get());
        let lights = document.extensions.lights_image_based.as_ref().map(|lights| lights.lights.as_slice());
        let Some((index, light)) = index.and_then(|index| Some((index, lights?.get(index)?))) else { return Ok(None) };
        let Some(entry) = self.0.get(index) else { return Ok(None) };
        let picture = entry.get_or_init(|| equirectangular(light, index, &view.content.data)).clone()?;
        let file = format!("{}image-based light {index}.pfm", view.prefix);
        let mut environment = Environment::from_file(file.clone());
        environment.scale = (light.intensity / efficacy).clamp(0.0, f64::from(juggler_math::MAX_LIGHT)) as f32;
        Ok(Some((environment.into(), file, picture)))
    }
}

/// A decoded face of a cube map: a square.
struct Face {
    size: u32,
    pixels: Vec<Rgb>,
}

/// Equirectangular picture of a light, as a PFM file. Its first row is up; from left to right it
/// shows -z, +x, +z, -x.
fn equirectangular(light: &ImageBasedLight, index: usize, data: &GltfData) -> Result<Asset, Fault> {
    let at = format!("/extensions/EXT_lights_image_based/lights/{index}/specularImages/0");
    let images = light.specular_images.first().ok_or_else(|| Fault::at(&at, "there are no images"))?;
    let faces: Result<Vec<Face>, Fault> = images.iter().map(|image| face(image.get(), data)).collect();
    let faces = faces?;
    let size = faces.iter().map(|face| face.size).find(|size| *size > 0).unwrap_or(1);
    if faces.iter().any(|face| face.size != size && face.size > 0) {
        return Err(Fault::at(at, "the six pictures have different sizes"));
    }
    let height = size.saturating_mul(2).min(MAX_HEIGHT);
    let width = height * 2;
    let [x, y, z, w] = light.rotation;
    let inverse = DQuat::from_xyzw(x, y, z, w).normalize().inverse();
    let mut file = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    // PFM stores the lowest row first.
    for row in (0..height).rev() {
        for column in 0..width {
            let color = pixel(&faces, inverse, [column, row], [width, height]);
            file.extend(color.to_array().into_iter().flat_map(f32::to_le_bytes));
        }
    }
    Ok(Asset::from_bytes(file))
}

/// Mean radiance of a pixel.
fn pixel(faces: &[Face], inverse: DQuat, [column, row]: [u32; 2], [width, height]: [u32; 2]) -> Rgb {
    let place = |pixel: u32, sample: u32, count: u32| {
        (f64::from(pixel) + (f64::from(sample) + 0.5) / f64::from(SAMPLES)) / f64::from(count)
    };
    let mut sum = Rgb::BLACK;
    for (i, j) in (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j))) {
        let (u, v) = (place(column, i, width), place(row, j, height));
        let (sin_phi, cos_phi) = portable::sin_cos_f64(std::f64::consts::TAU * u);
        let (sin_theta, cos_theta) = portable::sin_cos_f64(std::f64::consts::PI * v);
        let direction = DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
        sum += lookup(faces, inverse * direction);
    }
    sum * (1.0 / (SAMPLES * SAMPLES) as f32)
}

/// Radiance from a direction. The faces +x, -x, +y, -y, +z, -z are as seen from inside the cube: the
/// extension mirrors the pictures of the usual cube maps.
fn lookup(faces: &[Face], direction: DVec3) -> Rgb {
    let DVec3 { x, y, z } = direction;
    let (face, right, down, depth) = if x.abs() >= y.abs().max(z.abs()) {
        if x > 0.0 { (0, z, -y, x) } else { (1, -z, -y, -x) }
    } else if y.abs() >= z.abs() {
        if y > 0.0 { (2, -x, z, y) } else { (3, -x, -z, -y) }
    } else if z > 0.0 {
        (4, -x, -y, z)
    } else {
        (5, x, -y, -z)
    };
    faces.get(face).map_or(Rgb::BLACK, |face| face.bilinear([right, down].map(|side| side / depth * 0.5 + 0.5)))
}

impl Face {
    /// Bilinear interpolation between pixel centers, at a place from 0 to 1 that begins at the left
    /// and at the top.
    fn bilinear(&self, place: [f64; 2]) -> Rgb {
        let last = self.size.saturating_sub(1);
        let [x, y] = place.map(|side| (side * f64::from(self.size) - 0.5).clamp(0.0, f64::from(last)));
        let [left, top] = [x, y].map(|side| side as u32);
        let [fx, fy] = [x - f64::from(left), y - f64::from(top)].map(|fraction| fraction as f32);
        let row = |y: u32| self.pixel(left, y) * (1.0 - fx) + self.pixel((left + 1).min(last), y) * fx;
        row(top) * (1.0 - fy) + row((top + 1).min(last)) * fy
    }

    fn pixel(&self, x: u32, y: u32) -> Rgb {
        let index = u64::from(y) * u64::from(self.size) + u64::from(x);
        usize::try_from(index).ok().and_then(|index| self.pixels.get(index)).copied().unwrap_or(Rgb::BLACK)
    }
}

/// Decodes a face. Pictures with alpha are RGBD: linear colors are divided by alpha. A picture that
/// lenient files lack is black, of size 0.
fn face(image: usize, data: &GltfData) -> Result<Face, Fault> {
    let index = Index::from(u32::try_from(image).unwrap_or(u32::MAX));
    let (at, name) = (data.image_place(index), data.image_name(index));
    if data.is_lost(image) {
        return Ok(Face { size: 0, pixels: Vec::new() });
    }
    let missing = || Fault::at(&at, "the picture has not been read");
    let asset = data.image_asset(image).ok_or_else(missing)?;
    let bytes = Cursor::new(asset.bytes().unwrap_or_default());
    let raster = decode_raster(&name, bytes, &Limits::default());
    let raster = raster.map_err(|error| Fault::at(&at, error))?;
    let layout = raster.layout;
    if layout.width != layout.height {
        let text = format!("a face of a cube map must be a square, this one has {}×{}", layout.width, layout.height);
        return Err(Fault::at(at, text));
    }
    Ok(Face { size: layout.width, pixels: linear(&raster) })
}

/// Radiance of all pixels of a picture.
fn linear(raster: &Raster) -> Vec<Rgb> {
    let levels: Vec<f64> = match &raster.samples {
        RasterSamples::Bytes(levels) => levels.iter().map(|level| f64::from(*level) / 255.0).collect(),
        RasterSamples::Words(levels) => levels.iter().map(|level| f64::from(*level) / 65535.0).collect(),
        RasterSamples::Floats(levels) => levels.iter().map(|level| f64::from(*level)).collect(),
    };
    let decode = |level: f64| raster.transfer_function.decode(level);
    let color = |pixel: &[f64]| {
        let (color, alpha) = match *pixel {
            [gray] => ([gray; 3], 1.0),
            [gray, alpha] => ([gray; 3], alpha),
            [r, g, b] => ([r, g, b], 1.0),
            [r, g, b, alpha] => ([r, g, b], alpha),
            _ => ([0.0; 3], 1.0),
        };
        let [r, g, b] = color.map(|level| if alpha > 0.0 { (decode(level) / alpha) as f32 } else { 0.0 });
        Rgb::new(r, g, b)
    };
    levels.chunks(usize::from(raster.layout.channels).max(1)).map(color).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::GltfFormat;
    use crate::gltf::testing::Builder;
    use juggler_imaging::decode;
    use juggler_scene::model::{ModelChoice, ModelFormat};
    use std::collections::BTreeMap;

    /// A face whose pixels are red to the right and green downwards, and blue by its number.
    fn faces(size: u32) -> Vec<Face> {
        let side = |pixel: u32| (pixel as f32 + 0.5) / size as f32;
        let pixels = |number: usize| {
            let places = (0..size).flat_map(|y| (0..size).map(move |x| [x, y]));
            places.map(|[x, y]| Rgb::new(side(x), side(y), number as f32)).collect()
        };
        (0..6).map(|number| Face { size, pixels: pixels(number) }).collect()
    }

    #[test]
    fn faces_are_seen_from_inside() {
        let faces = faces(16);
        let at = |x, y, z| lookup(&faces, DVec3::new(x, y, z)).to_array();
        for (number, sign) in [1.0, -1.0].into_iter().enumerate() {
            assert_eq!(at(sign, 0.0, 0.0), [0.5, 0.5, number as f32]);
            assert_eq!(at(0.0, sign, 0.0), [0.5, 0.5, number as f32 + 2.0]);
            assert_eq!(at(0.0, 0.0, sign), [0.5, 0.5, number as f32 + 4.0]);
        }
        // Whoever looks along -z sees +x on the right, +y above; along +z sees -x on the right.
        assert_eq!(at(0.25, 0.25, -1.0), [0.625, 0.375, 5.0]);
        assert_eq!(at(0.25, 0.25, 1.0), [0.375, 0.375, 4.0]);
        assert_eq!(at(1.0, 0.25, 0.25), [0.625, 0.375, 0.0]);
        assert_eq!(at(-1.0, 0.25, 0.25), [0.375, 0.375, 1.0]);
        // Neighbors of the horizontal faces: the lower edge of the face above joins the face +z.
        assert_eq!(at(0.25, 1.0, 0.25), [0.375, 0.625, 2.0]);
        assert_eq!(at(0.25, -1.0, 0.25), [0.375, 0.375, 3.0]);
    }

    #[test]
    fn alpha_divides_linear_colors() {
        let layout = juggler_imaging::RasterLayout {
            format: juggler_imaging::ImageFormat::Png,
            width: 2,
            height: 1,
            channels: 4,
            sample_bytes: 1,
            to_srgb: None,
        };
        let samples = RasterSamples::Bytes(vec![255, 188, 0, 51, 255, 255, 255, 0]);
        let transfer_function = juggler_imaging::TransferFunction::Srgb;
        let raster = Raster { layout, samples, transfer_function, is_first_of_several: false };
        let [color, clear] = linear(&raster)[..] else { panic!("two pixels") };
        let expected = Rgb::new(5.0, 5.0 * juggler_math::color::srgb_decode(188.0 / 255.0), 0.0);
        assert!((color - expected).max_channel().abs() < 1e-5, "{color:?}");
        assert_eq!(clear, Rgb::BLACK);
    }

    /// A document with faces of one pixel of the brightness 1 to 6, rotated about y by a quarter.
    fn document(size_of_last: u32) -> Builder {
        let mut builder = Builder::default();
        let faces = (1..=6).map(|number| {
            let size = if number == 6 { size_of_last } else { 1 };
            let mut file = format!("PF\n{size} {size}\n-1.0\n").into_bytes();
            file.extend((0..size * size * 3).flat_map(|_| (number as f32).to_le_bytes()));
            format!(r#"{{"bufferView": {}, "mimeType": "image/png"}}"#, builder.view(&file, ""))
        });
        let images = faces.collect::<Vec<_>>().join(", ");
        builder.member(format!(r#""images": [{images}]"#));
        builder.member(r#""extensionsUsed": ["EXT_lights_image_based"]"#);
        let light = r#"{"intensity": 3, "rotation": [0, 0.70710678, 0, 0.70710678], "specularImageSize": 1,
            "irradianceCoefficients": [[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]],
            "specularImages": [[0, 1, 2, 3, 4, 5]]}"#;
        builder.member(format!(r#""extensions": {{"EXT_lights_image_based": {{"lights": [{light}]}}}}"#));
        builder.member(
            r#""nodes": [{}], "scenes": [{"nodes": [0], "extensions": {"EXT_lights_image_based": {"light": 0}}}]"#,
        );
        builder.member(r#""scene": 0"#);
        builder
    }

    #[test]
    fn scenes_have_the_environment_of_their_light() {
        let model = GltfFormat::default().open("a.glb", document(1).glb(), &BTreeMap::new()).unwrap();
        let parts = model.parts(&ModelChoice::default(), "a/").unwrap();
        let Some(AnyBackground::Environment(environment)) = parts.background else { panic!("no environment") };
        assert_eq!((&*environment.file, environment.scale), ("a/image-based light 0.pfm", 3.0));
        let asset = parts.assets.get("a/image-based light 0.pfm").unwrap();
        let image = decode("a", Cursor::new(asset.bytes().unwrap()), &Limits::default()).unwrap();
        assert_eq!([image.width(), image.height()], [4, 2]);
        // The rotation takes the faces +x, +z, -x, -z to -z, +x, +z, -x. Half of each pixel's
        // samples are of the face below, a quarter of each of two neighbors.
        let levels: Vec<f32> = image.row(1).unwrap().iter().map(|pixel| pixel.r).collect();
        assert!(model.summary(&ModelChoice::default()).unwrap().has_environment);
        assert_eq!(levels, [3.5, 3.75, 4.0, 3.75]);
    }

    #[test]
    fn faces_of_different_sizes_are_an_error() {
        let model = GltfFormat::default().open("a.glb", document(2).glb(), &BTreeMap::new()).unwrap();
        let error = model.parts(&ModelChoice::default(), "").unwrap_err().to_string();
        assert!(error.contains("/extensions/EXT_lights_image_based/lights/0/specularImages/0"), "{error}");
    }
}
