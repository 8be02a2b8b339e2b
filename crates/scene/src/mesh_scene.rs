//! A default scene around a mesh file that comes without one: a floor, a soft sun, a gray sky and a
//! camera that frames the whole model.
//!
//! The scene is written out as a person would write it, so that `juggler convert model.obj
//! scene.json` gives a scene file to start from.

use crate::description::{BackgroundInput, Description, Object, Render};
use juggler_camera::{AnyCamera, Perspective};
use juggler_integrator::Path as PathIntegrator;
use juggler_light::background::Gradient;
use juggler_light::{AnyLight, Directional};
use juggler_material::{AnyMaterial, Diffuse, Principled};
use juggler_math::{Aabb, DVec3, Rgb, Vec3, portable};
use juggler_shape::{Mesh, Plane};
use juggler_texture::{AnyTexture, Attribute, Image, Input};
use std::path::Path;

/// Direction from the center of the model to the camera: in front, slightly right and above.
const TO_CAMERA: DVec3 = DVec3::new(0.45, 0.4, 1.0);
/// Vertical field of view of a portrait lens, in degrees.
const FOV_DEGREES: f32 = 30.0;
/// Fraction of the picture's width and height that the model may fill.
const FILL_FRACTION: f64 = 0.8;
/// Direction in which the sun's light travels: from above the camera's left shoulder.
const SUNLIGHT: Vec3 = Vec3::new(0.7, -1.2, -0.7);
/// Color of the sunlight.
const SUN_COLOR: Rgb = Rgb::new(1.0, 0.94, 0.86);
/// Distance of the floor below the model, as a fraction of the model's radius. It keeps the model's
/// base off the plane of the floor.
const FLOOR_DEPTH: f64 = 1e-4;
/// Maximum absolute coordinate for which a camera and a floor are made.
const MAX_COORDINATE: f64 = 1e15;

/// Properties of a mesh file that decide the scene around it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshOverview {
    /// Bounding box in object space.
    pub bounds: Aabb,
    /// Whether the mesh has the attribute `color`.
    pub has_colors: bool,
    /// Name of the picture of the surface, in the folder of the file; `None` if the file names none
    /// or the mesh has no surface coordinates.
    pub texture_file: Option<String>,
}

/// Describes a scene around the mesh in `file`. With `z_up`, the mesh is rotated so that its z axis
/// points up. The mesh shows its picture, or else its attribute `color`, or else gray.
pub fn describe_mesh_scene(file: &str, overview: &MeshOverview, z_up: bool) -> Description {
    let title = Path::new(file).file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned());
    let mut model = Object::new(Mesh::from_file(file)).named(title.as_str());
    if z_up {
        model = model.rotated(Vec3::X, -90.0);
    }
    let render = Render {
        size: [800, 600],
        samples: 64,
        integrator: Some(PathIntegrator::default().into()),
        ..Render::default()
    };
    let mut scene = Description {
        description: format!("Scene generated for the mesh {file}"),
        title,
        render: render.into(),
        background: Some(BackgroundInput::Kind(sky().into()).into()),
        lights: [AnyLight::from(sun()).into()].into_iter().collect(),
        ..Description::default()
    };
    let texture = overview.texture_file.as_ref().map(|name| {
        let picture = Path::new(file).with_file_name(name);
        ("surface", AnyTexture::from(Image::new(picture.to_string_lossy())))
    });
    let texture = texture.or_else(|| overview.has_colors.then(|| ("color", AnyTexture::from(Attribute::default()))));
    let base_color = texture.as_ref().map_or(Rgb::splat(0.8).into(), |(name, _)| Input::Texture((*name).into()));
    scene.textures.extend(texture.map(|(name, texture)| (name.into(), texture.into())));
    let surface = Principled { base_color, roughness: 0.5.into(), ..Principled::default() };
    scene.materials.insert("model".into(), AnyMaterial::from(surface).into());
    scene.objects.push(model.material_named("model").into());
    if let Some(bounds) = ModelBounds::from_bounds(&overview.bounds, z_up) {
        let floor = Diffuse { reflectance: Rgb::splat(0.42).into(), ..Diffuse::default() };
        scene.materials.insert("floor".into(), AnyMaterial::from(floor).into());
        let plane = Object::new(Plane {}).named("floor").at(0.0, bounds.floor(), 0.0);
        scene.objects.push(plane.material_named("floor").into());
        scene.camera = Some(AnyCamera::from(bounds.camera(scene.render.size)).into());
    }
    scene
}

/// A sun of a larger angle than the real one, for soft shadows.
fn sun() -> Directional {
    let direction = SUNLIGHT;
    Directional { direction, color: SUN_COLOR, intensity: 2.6, angle_degrees: 8.0, ..Directional::default() }
}

/// An overcast sky over gray ground.
fn sky() -> Gradient {
    Gradient {
        horizon: Rgb::new(0.62, 0.66, 0.7),
        zenith: Rgb::new(0.3, 0.36, 0.45),
        nadir: Some(Rgb::splat(0.3)),
        ..Gradient::default()
    }
}

/// Bounds of the upright model in world space, in double precision.
struct ModelBounds {
    low: DVec3,
    high: DVec3,
    center: DVec3,
    radius: f64,
    /// Power of ten to whose multiples coordinates are rounded.
    step: f64,
}

impl ModelBounds {
    /// Computes the bounds of the upright model; `None` if they are empty or too far away.
    fn from_bounds(bounds: &Aabb, z_up: bool) -> Option<Self> {
        let turned = |point: Vec3| {
            let DVec3 { x, y, z } = point.as_dvec3();
            if z_up { DVec3::new(x, z, -y) } else { DVec3::new(x, y, z) }
        };
        let (a, b) = (turned(bounds.min), turned(bounds.max));
        let (low, high) = (a.min(b), a.max(b));
        let (center, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let fits = |number: f64| number.abs() <= MAX_COORDINATE;
        let is_valid = low.to_array().into_iter().chain(high.to_array()).all(fits) && radius > 1.0 / MAX_COORDINATE;
        is_valid.then(|| Self { low, high, center, radius, step: power_of_ten(radius) * 1e-3 })
    }

    /// Rounds to a number of few digits.
    fn rounded(&self, value: f64) -> f64 {
        (value / self.step).round() * self.step
    }

    /// Height of a floor just below the model.
    fn floor(&self) -> f32 {
        let below = ((self.low.y - FLOOR_DEPTH * self.radius) / self.step).floor() * self.step;
        let height = below as f32;
        // Far from the origin, the conversion to single precision may round up.
        if f64::from(height) < self.low.y { height } else { height.next_down() }
    }

    /// Creates a camera that frames all corners of the bounds.
    fn camera(&self, [width, height]: [u32; 2]) -> Perspective {
        let back = TO_CAMERA.normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let (sin, cos) = portable::sin_cos_f64(f64::from(FOV_DEGREES).to_radians() * 0.5);
        let vertical = sin / cos * FILL_FRACTION;
        let horizontal = vertical * f64::from(width) / f64::from(height.max(1));
        let distance = (0..8).map(|corner| {
            let side = |bit: i32, low: f64, high: f64| if corner & bit == 0 { low } else { high };
            let (low, high) = (self.low, self.high);
            let corner = DVec3::new(side(1, low.x, high.x), side(2, low.y, high.y), side(4, low.z, high.z));
            let from = corner - self.center;
            let (across, along) = (from.dot(right).abs() / horizontal, from.dot(up).abs() / vertical);
            from.dot(back) + across.max(along)
        });
        let distance = distance.fold(self.radius, f64::max);
        let point = |at: DVec3| at.to_array().map(|number| self.rounded(number) as f32).into();
        Perspective {
            eye: point(self.center + back * distance),
            look_at: Some(point(self.center)),
            vertical_fov_degrees: Some(FOV_DEGREES),
            ..Perspective::default()
        }
    }
}

/// Largest power of ten up to `value`, computed by multiplications and divisions only, which give
/// the same bits on every machine.
fn power_of_ten(value: f64) -> f64 {
    let mut power = 1.0;
    while power > value && power > 1e-300 {
        power /= 10.0;
    }
    while power * 10.0 <= value {
        power *= 10.0;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_camera::WorldToFilm;
    use juggler_math::UVec2;

    fn bounds(min: [f32; 3], max: [f32; 3]) -> Aabb {
        Aabb { min: min.into(), max: max.into() }
    }

    fn overview(bounds: Aabb) -> MeshOverview {
        MeshOverview { bounds, has_colors: false, texture_file: None }
    }

    #[test]
    fn mesh_scenes_use_round_numbers() {
        assert_eq!([0.5, 1.0, 7.0, 10.0, 12345.0].map(power_of_ten), [0.1, 1.0, 1.0, 10.0, 10000.0]);
        let scene = describe_mesh_scene("models/cow.obj", &overview(bounds([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0])), false);
        let json = serde_json::to_value(&scene).unwrap();
        assert_eq!(json["title"], "cow");
        assert_eq!(json["objects"][0]["shape"]["mesh"]["file"], "models/cow.obj");
        assert_eq!(json["camera"]["perspective"]["look_at"], serde_json::json!([0.0, 1.0, 0.0]));
        assert_eq!(scene.objects.len(), 2);
    }

    #[test]
    fn a_mesh_shows_its_picture_or_else_its_colors() {
        let bounds = bounds([0.0; 3], [1.0; 3]);
        let textures = |has_colors, texture_file: Option<&str>| {
            let overview = MeshOverview { bounds, has_colors, texture_file: texture_file.map(str::to_owned) };
            let json = serde_json::to_value(describe_mesh_scene("models/a.ply", &overview, false)).unwrap();
            (json["materials"]["model"]["principled"]["base_color"].clone(), json["textures"].clone())
        };
        let (color, pictures) = textures(true, Some("skin.png"));
        assert_eq!(color, "surface");
        assert_eq!(pictures["surface"]["image"]["file"], "models/skin.png");
        assert_eq!(textures(true, None).0, "color");
        assert!(textures(false, None).0.is_array());
    }

    /// All corners of the bounds are inside the picture, and one of them is near its edge.
    #[test]
    fn the_camera_holds_the_whole_model() {
        for (min, max, z_up) in [
            ([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0], false),
            ([100.0, 5.0, -1.0], [101.0, 45.0, 2.0], false),
            ([0.0, 0.0, 0.0], [1e-3, 1e-3, 7e-3], true),
            ([0.0, 0.0, 0.0], [3e4, 2e4, 0.0], true),
        ] {
            let scene = describe_mesh_scene("a.stl", &overview(bounds(min, max)), z_up);
            let bounds = ModelBounds::from_bounds(&bounds(min, max), z_up).unwrap();
            let projection = scene.camera.unwrap().projection(UVec2::new(800, 600)).unwrap();
            let world_to_film = WorldToFilm::new(&projection).unwrap();
            let mut most = 0.0_f64;
            for corner in 0..8 {
                let side = |bit: i32, low: f64, high: f64| if corner & bit == 0 { low } else { high };
                let point = DVec3::new(
                    side(1, bounds.low.x, bounds.high.x),
                    side(2, bounds.low.y, bounds.high.y),
                    side(4, bounds.low.z, bounds.high.z),
                );
                let at = world_to_film.point(point.as_vec3()).unwrap();
                let off = [at.x / 400.0 - 1.0, at.y / 300.0 - 1.0].map(f64::abs);
                most = off.into_iter().fold(most, f64::max);
            }
            assert!((0.6..=0.85).contains(&most), "{min:?} {max:?}: {most}");
        }
    }

    #[test]
    fn empty_huge_and_tiny_bounds_give_no_camera() {
        for bounds in [Aabb::EMPTY, bounds([0.0; 3], [1e30; 3]), bounds([0.0; 3], [1e-30; 3])] {
            let scene = describe_mesh_scene("a.obj", &overview(bounds), false);
            assert!(scene.camera.is_none() && scene.objects.len() == 1);
        }
    }
}
