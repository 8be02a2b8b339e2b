//! A scene around a mesh file, for a model that comes without one: on a floor, in the light of a
//! soft sun and a grey sky, seen by a camera that holds all of it.
//!
//! Everything is written out as a person would write it, so that `juggler convert model.obj
//! scene.json` gives a file to begin with.

use crate::description::{Backdrop, Description, Object, Render};
use juggler_camera::{AnyCamera, Perspective};
use juggler_integrator::Path as PathIntegrator;
use juggler_light::background::Gradient;
use juggler_light::{AnyLight, Directional};
use juggler_material::{AnyMaterial, Diffuse, Plastic};
use juggler_math::{Aabb, DVec3, Rgb, Vec3, fun};
use juggler_shape::{Mesh, Plane};
use std::path::Path;

/// Direction from the middle of the model to the camera: in front, a little right of and above it.
const TOWARDS_CAMERA: DVec3 = DVec3::new(0.45, 0.4, 1.0);
/// Vertical field of view, in degrees: that of a portrait lens.
const FOV_DEGREES: f32 = 30.0;
/// Share of the picture's width and height that the model may fill.
const FILLED: f64 = 0.8;
/// Direction of the sun's light: from above the camera's left shoulder.
const SUNLIGHT: Vec3 = Vec3::new(0.7, -1.2, -0.7);
/// Color of the sun's light.
const SUN_COLOR: Rgb = Rgb::new(1.0, 0.94, 0.86);
/// Depth of the floor below the model, in radii of the model: nothing of the model lies in the
/// floor's own plane.
const FLOOR_DEPTH: f64 = 1e-4;
/// Largest coordinates that a camera and a floor are made for.
const FARTHEST: f64 = 1e15;

/// The scene around the mesh in `file`, which lies within `bounds`. With `z_up`, the mesh is turned
/// so that its z axis points up.
pub fn describe(file: &str, bounds: &Aabb, z_up: bool) -> Description {
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
        description: format!("A scene made around the mesh {file}"),
        title,
        render: render.into(),
        background: Some(Backdrop::Kind(sky().into()).into()),
        lights: [AnyLight::from(sun()).into()].into_iter().collect(),
        ..Description::default()
    };
    let clay = Plastic { reflectance: Rgb::new(0.5, 0.34, 0.24).into(), roughness: 0.5.into(), ..Plastic::default() };
    scene.materials.insert("model".into(), AnyMaterial::from(clay).into());
    scene.objects.push(model.material_named("model").into());
    if let Some(placed) = Placed::of(bounds, z_up) {
        let floor = Diffuse { reflectance: Rgb::splat(0.42).into(), ..Diffuse::default() };
        scene.materials.insert("floor".into(), AnyMaterial::from(floor).into());
        let plane = Object::new(Plane {}).named("floor").at(0.0, placed.floor(), 0.0);
        scene.objects.push(plane.material_named("floor").into());
        scene.camera = Some(AnyCamera::from(placed.camera(scene.render.size)).into());
    }
    scene
}

/// A sun that is wider than the true one, for soft shadows.
fn sun() -> Directional {
    let direction = SUNLIGHT;
    Directional { direction, color: SUN_COLOR, intensity: 2.6, angle_degrees: 8.0, ..Directional::default() }
}

/// An overcast sky over a grey ground.
fn sky() -> Gradient {
    Gradient {
        horizon: Rgb::new(0.62, 0.66, 0.7),
        zenith: Rgb::new(0.3, 0.36, 0.45),
        nadir: Some(Rgb::splat(0.3)),
        ..Gradient::default()
    }
}

/// Where the model stands when it is upright, in double precision.
struct Placed {
    low: DVec3,
    high: DVec3,
    center: DVec3,
    radius: f64,
    /// Coordinates are rounded to multiples of this power of ten.
    step: f64,
}

impl Placed {
    /// Nothing for bounds that are empty or too far away.
    fn of(bounds: &Aabb, z_up: bool) -> Option<Self> {
        let turned = |point: Vec3| {
            let DVec3 { x, y, z } = point.as_dvec3();
            if z_up { DVec3::new(x, z, -y) } else { DVec3::new(x, y, z) }
        };
        let (a, b) = (turned(bounds.min), turned(bounds.max));
        let (low, high) = (a.min(b), a.max(b));
        let (center, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let fits = |number: f64| number.abs() <= FARTHEST;
        let sound = low.to_array().into_iter().chain(high.to_array()).all(fits) && radius > 1.0 / FARTHEST;
        sound.then(|| Self { low, high, center, radius, step: power_of_ten(radius) * 1e-3 })
    }

    /// A number of few digits near `value`.
    fn rounded(&self, value: f64) -> f64 {
        (value / self.step).round() * self.step
    }

    /// Height of a floor just below the model.
    fn floor(&self) -> f32 {
        let below = ((self.low.y - FLOOR_DEPTH * self.radius) / self.step).floor() * self.step;
        let height = below as f32;
        // Far from the origin, single precision may round up.
        if f64::from(height) < self.low.y { height } else { height.next_down() }
    }

    /// A camera that sees all corners of the bounds.
    fn camera(&self, [width, height]: [u32; 2]) -> Perspective {
        let back = TOWARDS_CAMERA.normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let (sin, cos) = fun::sin_cos_f64(f64::from(FOV_DEGREES).to_radians() * 0.5);
        let vertical = sin / cos * FILLED;
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

/// The largest power of ten up to `value`, by multiplications alone, which give the same bits
/// everywhere.
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
    use juggler_camera::Finder;
    use juggler_math::UVec2;

    fn bounds(min: [f32; 3], max: [f32; 3]) -> Aabb {
        Aabb { min: min.into(), max: max.into() }
    }

    #[test]
    fn numbers_are_those_that_people_write() {
        assert_eq!([0.5, 1.0, 7.0, 10.0, 12345.0].map(power_of_ten), [0.1, 1.0, 1.0, 10.0, 10000.0]);
        let scene = describe("models/cow.obj", &bounds([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]), false);
        let json = serde_json::to_value(&scene).unwrap();
        assert_eq!(json["title"], "cow");
        assert_eq!(json["objects"][0]["shape"]["mesh"]["file"], "models/cow.obj");
        assert_eq!(json["camera"]["perspective"]["look_at"], serde_json::json!([0.0, 1.0, 0.0]));
        assert_eq!(scene.objects.len(), 2);
    }

    /// All corners of the box lie within the picture, and one of them near its edge.
    #[test]
    fn the_camera_holds_the_whole_model() {
        for (min, max, z_up) in [
            ([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0], false),
            ([100.0, 5.0, -1.0], [101.0, 45.0, 2.0], false),
            ([0.0, 0.0, 0.0], [1e-3, 1e-3, 7e-3], true),
            ([0.0, 0.0, 0.0], [3e4, 2e4, 0.0], true),
        ] {
            let scene = describe("a.stl", &bounds(min, max), z_up);
            let placed = Placed::of(&bounds(min, max), z_up).unwrap();
            let projection = scene.camera.unwrap().project(UVec2::new(800, 600)).unwrap();
            let finder = Finder::new(&projection).unwrap();
            let mut most = 0.0_f64;
            for corner in 0..8 {
                let side = |bit: i32, low: f64, high: f64| if corner & bit == 0 { low } else { high };
                let point = DVec3::new(
                    side(1, placed.low.x, placed.high.x),
                    side(2, placed.low.y, placed.high.y),
                    side(4, placed.low.z, placed.high.z),
                );
                let at = finder.point(point.as_vec3()).unwrap();
                let off = [at.x / 400.0 - 1.0, at.y / 300.0 - 1.0].map(f64::abs);
                most = off.into_iter().fold(most, f64::max);
            }
            assert!((0.6..=0.85).contains(&most), "{min:?} {max:?}: {most}");
        }
    }

    #[test]
    fn odd_bounds_leave_the_camera_to_the_scene() {
        for bounds in [Aabb::EMPTY, bounds([0.0; 3], [1e30; 3]), bounds([0.0; 3], [1e-30; 3])] {
            let scene = describe("a.obj", &bounds, false);
            assert!(scene.camera.is_none() && scene.objects.len() == 1);
        }
    }
}
