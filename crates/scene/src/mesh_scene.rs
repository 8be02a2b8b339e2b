//! A default scene around a mesh file that comes without one: a floor, a soft sun and a gray sky. The
//! default camera frames the mesh.
//!
//! The scene is written out as a person would write it, so that `juggler convert model.obj
//! scene.json` gives a scene file to start from.

use crate::description::{BackgroundInput, Description, Object, Render};
use juggler_integrator::Path as PathIntegrator;
use juggler_light::background::Gradient;
use juggler_light::{AnyLight, Directional};
use juggler_material::{AnyMaterial, Diffuse, Principled};
use juggler_math::portable::power_of_ten;
use juggler_math::{Aabb, DVec3, Rgb, Vec3};
use juggler_shape::{Mesh, Plane};
use juggler_texture::{AnyTexture, Attribute, Image, Input};
use std::path::Path;

/// Direction in which the sun's light travels: from above the camera's left shoulder.
const SUNLIGHT: Vec3 = Vec3::new(0.7, -1.2, -0.7);
/// Color of the sunlight.
const SUN_COLOR: Rgb = Rgb::new(1.0, 0.94, 0.86);
/// Distance of the floor below the model, as a fraction of the model's radius. It keeps the model's
/// base off the plane of the floor.
const FLOOR_DEPTH: f64 = 1e-4;
/// Maximum absolute coordinate for which a floor is made.
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
        let radius = (high - low).length() * 0.5;
        let fits = |number: f64| number.abs() <= MAX_COORDINATE;
        let is_valid = low.to_array().into_iter().chain(high.to_array()).all(fits) && radius > 1.0 / MAX_COORDINATE;
        is_valid.then(|| Self { low, radius, step: power_of_ten(radius) * 1e-3 })
    }

    /// Height of a floor just below the model.
    fn floor(&self) -> f32 {
        let below = ((self.low.y - FLOOR_DEPTH * self.radius) / self.step).floor() * self.step;
        let height = below as f32;
        // Far from the origin, the conversion to single precision may round up.
        if f64::from(height) < self.low.y { height } else { height.next_down() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let height = json["objects"][1]["transform"][0]["translate"][1].as_f64().unwrap();
        assert!((height + 0.001).abs() < 1e-9, "{height}");
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

    #[test]
    fn empty_huge_and_tiny_bounds_give_no_floor() {
        for bounds in [Aabb::EMPTY, bounds([0.0; 3], [1e30; 3]), bounds([0.0; 3], [1e-30; 3])] {
            let scene = describe_mesh_scene("a.obj", &overview(bounds), false);
            assert_eq!(scene.objects.len(), 1);
        }
    }
}
