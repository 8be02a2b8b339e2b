//! Warns about flat emitters that light nothing: the front touches another surface, or the whole
//! scene is behind it. An emissive rectangle faces up unless it is rotated, a common mistake with
//! ceiling lights.

use super::area_lights;
use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_camera::AnyCamera;
use juggler_material::{MaterialId, MaterialTable, Sides};
use juggler_math::{Ray, Transform, Vec3};
use juggler_shape::SolidAngleShape;
use juggler_world::{Content, Object};

/// Maximum number of emitters that are checked.
const MAX_EMITTERS_CHECKED: usize = 64;
/// Maximum number of pairs of an emitter and an object that are checked.
const MAX_PAIRS: usize = 4_000_000;
/// Maximum distance of a touching surface, as a fraction of the emitter's size.
const TOUCHING: f32 = 0.01;

/// Flat surface that emits from its front only, in world space.
struct Emitter {
    /// Index of its object.
    place: usize,
    /// Index of its shape.
    number: u32,
    kind: &'static str,
    center: Vec3,
    /// Unit normal of the front.
    normal: Vec3,
    /// Sample points on the surface.
    points: [Vec3; 5],
    /// Shorter edge, or diameter.
    size: f32,
}

/// Objects and materials around the emitters.
pub struct SceneObjects<'s> {
    pub scene: &'s Description,
    pub objects: &'s [Object],
    /// Index of the first shape of each scene entry.
    pub entries: &'s [u32],
    pub materials: &'s MaterialTable,
}

impl Emitter {
    fn of(place: usize, number: u32, object: &Object, materials: &MaterialTable) -> Option<Self> {
        let Content::Shape(shape) = &object.content else { return None };
        let transform = object.motion.still()?;
        let (kind, x, z) = match shape.solid_angle_shape()? {
            SolidAngleShape::Rectangle { size } => ("rectangle", 0.5 * size[0], 0.5 * size[1]),
            SolidAngleShape::Disk { radius } => ("disk", radius, radius),
            SolidAngleShape::Sphere { .. } | SolidAngleShape::Triangle { .. } => return None,
        };
        materials.emission(object.material?).filter(|emission| emission.sides == Sides::Front)?;
        let (x, z) = (Vec3::X * x, Vec3::Z * z);
        let points = [Vec3::ZERO, x * 0.7, x * -0.7, z * 0.7, z * -0.7].map(|point| transform.point(point));
        let size = 2.0 * transform.vector(x).length().min(transform.vector(z).length());
        let normal = transform.normal(Vec3::Y);
        Some(Self { place, number, kind, center: transform.origin(), normal, points, size })
    }

    /// Tolerance for rounding errors of positions.
    fn tolerance(&self) -> f32 {
        1e-4 * self.size + 1e-5 * self.center.abs().max_element()
    }

    /// Index of the first object that touches the front, if the front is covered at all sample
    /// points.
    fn covering_object(&self, scene_objects: &SceneObjects<'_>) -> Option<usize> {
        let covers =
            |point: &Vec3| scene_objects.others(self).find(|(_, object)| self.touches(*point, object, scene_objects));
        let mut first = None;
        for point in &self.points {
            let (place, _) = covers(point)?;
            first = first.or(Some(place));
        }
        first
    }

    /// Whether an object's surface touches the front at a point.
    fn touches(&self, point: Vec3, object: &Object, scene_objects: &SceneObjects<'_>) -> bool {
        let Content::Shape(shape) = &object.content else { return false };
        let reach = self.size * TOUCHING + self.tolerance();
        let bounds = object.bounds();
        let is_near = bounds.is_empty() || bounds.grown(reach).contains(point);
        if !is_near || object.material.is_none_or(|id| scene_objects.lets_light_through(id)) {
            return false;
        }
        let ray = Ray::new(point - self.normal * self.tolerance(), self.normal).with_t_max(reach + self.tolerance());
        shape.intersect(&object.motion.at(0.0).ray_to_local(&ray)).is_some()
    }

    /// Whether all other objects and all cameras are behind the front.
    fn faces_away(&self, scene_objects: &SceneObjects<'_>) -> bool {
        let is_ahead = |point: Vec3| (point - self.center).dot(self.normal) > self.tolerance();
        let eye = |camera: &AnyCamera| camera.axes().is_ok_and(|axes| is_ahead(axes.eye));
        let mut others = scene_objects.others(self).peekable();
        others.peek().is_some()
            && !others.any(|(_, object)| match plane(object) {
                Some(plane) => plane.normal(Vec3::Y).dot(self.normal).abs() < 0.9999 || is_ahead(plane.origin()),
                None => object.bounds().is_empty() || object.bounds().corners().into_iter().any(is_ahead),
            })
            && !scene_objects.scene.camera.iter().chain(scene_objects.scene.cameras.values()).any(|camera| eye(camera))
    }
}

impl SceneObjects<'_> {
    /// Adds a warning for each flat emitter that lights nothing.
    pub fn check(&self, findings: &mut Vec<Finding>) {
        let most = (MAX_PAIRS / self.objects.len().max(1)).clamp(1, MAX_EMITTERS_CHECKED);
        let mut number = 0u64;
        let numbered = self.objects.iter().enumerate().map(|(place, object)| {
            let first = number;
            number = number.saturating_add(object.shapes());
            (place, u32::try_from(first).unwrap_or(u32::MAX), object)
        });
        let emitters =
            numbered.filter_map(|(place, number, object)| Emitter::of(place, number, object, self.materials));
        for emitter in emitters.take(most).collect::<Vec<_>>() {
            findings.extend(self.warning(&emitter));
        }
    }

    fn warning(&self, emitter: &Emitter) -> Option<Finding> {
        let Emitter { kind, normal, .. } = emitter;
        let path = self.path(emitter.number);
        let [x, y, z] = normal.to_array().map(|axis| (axis * 1e3).round() / 1e3 + 0.0);
        if let Some(covering_object) = emitter.covering_object(self) {
            let number = self.objects.iter().take(covering_object).map(Object::shapes).sum::<u64>();
            let other = self.path(u32::try_from(number).unwrap_or(u32::MAX));
            let message =
                format!("the front of this {kind}, which emits light along [{x}, {y}, {z}], lies on `{other}`");
            let help = "its light is blocked: move it away from that surface, or turn it around";
            return Some(Finding::warning(message).at(path).help(help));
        }
        if !emitter.faces_away(self) {
            return None;
        }
        let message = format!("this {kind} emits light along [{x}, {y}, {z}], away from everything in the scene");
        let is_light =
            emitter.place >= self.objects.len().saturating_sub(area_lights::iter(&self.scene.lights).count());
        let help = if is_light {
            "turn it with `direction` or `look_at`"
        } else {
            "turn it around, {\"rotate\": {\"axis\": [1, 0, 0], \"degrees\": 180}}, or write \"sides\": \"both\""
        };
        Some(Finding::warning(message).at(path).help(help))
    }

    /// All objects except the emitter's.
    fn others(&self, emitter: &Emitter) -> impl Iterator<Item = (usize, &Object)> {
        let place = emitter.place;
        self.objects.iter().enumerate().filter(move |(other, _)| *other != place)
    }

    fn lets_light_through(&self, id: MaterialId) -> bool {
        self.materials.is_transparent(id) || self.materials.has_opacity(id) || self.materials.interior(id).is_some()
    }

    /// Path of the shape of an index: an entry of the scene's objects, or an area light behind
    /// them.
    fn path(&self, shape: u32) -> Path {
        let entry = self.entries.partition_point(|first| *first <= shape).saturating_sub(1);
        let root = Path::root();
        match entry.checked_sub(self.scene.objects.len()) {
            None => root.key("objects").index(entry),
            Some(area) => {
                let light = area_lights::iter(&self.scene.lights).nth(area).map_or(0, |(light, _)| light);
                root.key("lights").index(light)
            }
        }
    }
}

/// Transform of a static object that is an infinite plane.
fn plane(object: &Object) -> Option<Transform> {
    object.content.as_shape().filter(|shape| shape.is_plane()).and_then(|_| object.motion.still())
}
