//! Warns about pictures that show nothing: a scene without objects, a camera that looks past all of
//! them, and a camera or a light inside of a solid that lets no light through.

use super::{Assembly, darkness};
use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_math::{Aabb, Ray, UVec2, Vec2, Vec3};
use juggler_world::{Content, Object};

/// Directions of test rays, off the axes and diagonals along which scenes are built.
const DIRECTIONS: [Vec3; 6] = [
    Vec3::new(0.1237, 0.9631, 0.2391),
    Vec3::new(-0.7219, 0.1433, 0.6770),
    Vec3::new(0.8563, -0.3319, 0.3959),
    Vec3::new(-0.3671, -0.8923, -0.2629),
    Vec3::new(0.2903, 0.3467, -0.8919),
    Vec3::new(-0.5591, 0.6353, -0.5327),
];
/// Maximum number of surfaces of an object along a test ray.
const MAX_SURFACES: usize = 64;
/// Maximum number of lights that are checked.
const MAX_LIGHTS: usize = 64;
/// Maximum number of pairs of a light and an object that are checked.
const MAX_PAIRS: usize = 4_000_000;

impl Assembly {
    /// Adds warnings about a scene that does not change.
    pub(super) fn check_sight(&self, scene: &Description, findings: &mut Vec<Finding>) {
        if scene.animation.frames != 1 || findings.iter().any(Finding::is_error) {
            return;
        }
        if self.objects.is_empty() {
            let message = if scene.objects.is_empty() { "the scene has no objects" } else { "no object is visible" };
            findings.push(Finding::warning(message).at(Path::root().key("objects")));
            return;
        }
        let Some((name, camera)) = self.cameras.first() else { return };
        let path = camera_path(scene, name);
        let [width, height] = scene.render.size;
        if looks_past(camera, UVec2::new(width, height), &self.objects) {
            let message = "the camera sees no object: all of them are beside or behind its field of view";
            findings.push(Finding::warning(message).at(path).help("turn it with `look_at`"));
        } else if self.integrator.follows_paths() || self.integrator.is_classic() {
            Solids { scene, assembly: self }.check(camera, &path, findings);
        }
    }
}

fn camera_path(scene: &Description, name: &str) -> Path {
    let cameras = Path::root().key("cameras");
    if scene.cameras.contains_key(name) { cameras.key(name) } else { Path::root().key("camera") }
}

/// Whether the boxes of all objects are outside of the camera's field of view. Objects without a
/// finite extent are always inside.
fn looks_past(camera: &AnyCamera, size: UVec2, objects: &[Object]) -> bool {
    let Some(planes) = frustum(camera, size) else { return false };
    let is_outside = |object: &Object| {
        let bounds = object.bounds();
        object.is_bounded() && planes.iter().any(|plane| plane.excludes(&bounds.grown(blur(camera, &bounds))))
    };
    objects.iter().all(is_outside)
}

/// Distance by which a camera's lens spreads the points of a box.
fn blur(camera: &AnyCamera, bounds: &Aabb) -> f32 {
    let AnyCamera::ThinLens(lens) = camera else { return 0.0 };
    let reach = bounds.corners().into_iter().map(|corner| corner.distance(lens.eye)).fold(0.0, f32::max);
    lens.lens_radius * (1.0 + reach / lens.focus_distance)
}

/// Plane with the field of view on the side of its normal.
struct Plane {
    point: Vec3,
    normal: Vec3,
}

impl Plane {
    fn excludes(&self, bounds: &Aabb) -> bool {
        bounds.corners().into_iter().all(|corner| (corner - self.point).dot(self.normal) < 0.0)
    }
}

/// The four sides of a camera's field of view, and the plane of its eye.
fn frustum(camera: &AnyCamera, size: UVec2) -> Option<[Plane; 5]> {
    let projection = camera.projection(size).ok()?;
    let film = size.as_vec2();
    let ray = |x: f32, y: f32| projection.ray(Vec2::new(x, y) * film, Vec2::splat(0.5), 0.0);
    let [a, b, c, d] = [ray(0.0, 0.0), ray(1.0, 0.0), ray(1.0, 1.0), ray(0.0, 1.0)];
    let middle = ray(0.5, 0.5);
    let side = |from: &Ray, to: &Ray| {
        let normal = from.direction.cross(to.origin + to.direction - from.origin - from.direction);
        let inwards = (middle.origin + middle.direction - from.origin).dot(normal);
        Plane { point: from.origin, normal: normal * inwards.signum() }
    };
    let behind = Plane { point: middle.origin, normal: middle.direction };
    Some([side(&a, &b), side(&b, &c), side(&c, &d), side(&d, &a), behind])
}

/// Solids that let no light through.
struct Solids<'s> {
    scene: &'s Description,
    assembly: &'s Assembly,
}

impl Solids<'_> {
    fn check(&self, camera: &AnyCamera, path: &Path, findings: &mut Vec<Finding>) {
        let Ok(axes) = camera.axes() else { return };
        let most = (MAX_PAIRS / self.assembly.objects.len().max(1)).clamp(1, MAX_LIGHTS);
        let lights = self.scene.lights.iter().map(|light| position(light)).enumerate();
        let lights: Vec<(usize, Vec3)> =
            lights.filter_map(|(number, position)| Some((number, position?))).take(most).collect();
        let around_camera: Vec<usize> = self.around(axes.eye).collect();
        for (number, position) in &lights {
            if let Some(solid) = self.around(*position).find(|solid| !around_camera.contains(solid)) {
                let message = format!("this light is inside of `{}`, which lets no light out", self.name(solid));
                let light = Path::root().key("lights").index(*number);
                findings.push(Finding::warning(message).at(light).help("move it out, or make that object transparent"));
            }
        }
        let is_dark = |solid: &usize| !lights.iter().any(|(_, at)| self.encloses(*solid, *at)) && !self.is_lit(*solid);
        if let Some(solid) = around_camera.iter().copied().find(is_dark) {
            let message = format!("the camera is inside of `{}`, and no light is", self.name(solid));
            findings
                .push(Finding::warning(message).at(path.clone()).help("move it out, or make that object transparent"));
        }
    }

    /// Indices of the solids around a point.
    fn around(&self, point: Vec3) -> impl Iterator<Item = usize> {
        (0..self.assembly.objects.len()).filter(move |object| self.encloses(*object, point))
    }

    /// Whether an object encloses a point in all directions and lets no light through.
    fn encloses(&self, object: usize, point: Vec3) -> bool {
        let Some(object) = self.assembly.objects.get(object).filter(|object| object.bounds().contains(point)) else {
            return false;
        };
        let materials = &self.assembly.materials;
        let is_opaque = |id| {
            let is_clear =
                materials.is_transparent(id) || materials.has_opacity(id) || materials.interior(id).is_some();
            !is_clear && !materials.has_absence(id) && !darkness::is_seen(id, materials)
        };
        object.material.is_some_and(is_opaque) && DIRECTIONS.iter().all(|direction| leaves(object, point, *direction))
    }

    /// Whether the inside of a solid may be lit otherwise than by lights: by ambient light or by an
    /// object that emits light or shows its color without any.
    fn is_lit(&self, solid: usize) -> bool {
        let Assembly { objects, materials, .. } = self.assembly;
        let bounds = objects.get(solid).map_or(Aabb::EMPTY, Object::bounds);
        let emits = |object: &Object| {
            let meets = !object.is_bounded() || overlap(&object.bounds(), &bounds);
            meets && object.material.is_none_or(|id| darkness::is_seen(id, materials))
        };
        let is_ambient = |light: &AnyLight| matches!(light, AnyLight::Ambient(_));
        self.scene.lights.iter().any(|light| is_ambient(light)) || objects.iter().any(emits)
    }

    fn name(&self, object: usize) -> String {
        let first: u64 = self.assembly.objects.iter().take(object).map(Object::shapes).fold(0, u64::saturating_add);
        let entries = &self.assembly.labels.entries;
        let entry = entries.partition_point(|entry| u64::from(*entry) <= first).saturating_sub(1);
        Path::root().key("objects").index(entry).to_string()
    }
}

/// Position of a light; `None` for infinite lights. Area lights are part of the objects.
fn position(light: &AnyLight) -> Option<Vec3> {
    match light {
        AnyLight::Point(light) => Some(light.position),
        AnyLight::Spot(light) => Some(light.position),
        AnyLight::Area(light) => Some(light.position),
        AnyLight::Ambient(_) | AnyLight::Directional(_) => None,
    }
}

/// Whether a ray from a point crosses the surface of a shape an odd number of times.
fn leaves(object: &Object, point: Vec3, direction: Vec3) -> bool {
    let Content::Shape(shape) = &object.content else { return false };
    let mut ray = object.motion.at(0.0).ray_to_local(&Ray::new(point, direction.normalize()));
    let mut count = 0;
    while let Some(hit) = shape.intersect(&ray) {
        count += 1;
        if count > MAX_SURFACES {
            return false;
        }
        ray.t_min = hit.t * (1.0 + 1e-5) + f32::MIN_POSITIVE;
    }
    count % 2 == 1
}

fn overlap(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

#[cfg(test)]
mod tests {
    use crate::Scene;

    /// Warnings of a path traced scene.
    fn warnings(objects: &str, members: &str) -> String {
        let render = r#""render": {"integrator": "path", "size": [160, 90]}"#;
        let text = format!(r#"{{"version": 1, "objects": [{objects}], {render}, "background": 0.1, {members}}}"#);
        let problems = Scene::from_json(text, "test.json").unwrap().check();
        assert_eq!(problems.errors(), 0, "{problems}");
        problems.list().iter().map(|problem| format!("{}: {}\n", problem.path, problem.message)).collect()
    }

    fn point(position: &str) -> String {
        format!(r#""lights": [{{"point": {{"position": {position}, "intensity": 9}}}}]"#)
    }

    const BALL: &str = r#"{"shape": "sphere", "material": {"diffuse": {}}}"#;
    const EYE: &str = r#""camera": {"perspective": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}"#;

    #[test]
    fn scenes_without_objects_are_warned_of() {
        assert_eq!(warnings("", EYE), "objects: the scene has no objects\n");
        let hidden = r#"{"shape": "sphere", "visible": false}"#;
        assert_eq!(warnings(hidden, EYE), "objects: no object is visible\n");
        assert_eq!(warnings(BALL, EYE), "");
    }

    #[test]
    fn lights_and_cameras_inside_of_opaque_solids_are_warned_of() {
        let inside = "lights[0]: this light is inside of `objects[0]`, which lets no light out\n";
        let near = r#""camera": {"perspective": {"eye": [0, 0, 0.5], "look_at": [0, 0, 0]}}"#;
        let shell = |material: &str| format!(r#"{{"shape": "sphere", "material": {material}}}"#);
        let open = r#"{"shape": {"tube": {"radius": 2}}, "material": {"diffuse": {}}}"#;
        let cube = r#"{"shape": "cuboid", "material": {"diffuse": {}}, "transform": {"scale": 3}}"#;
        for (objects, light, camera, expected) in [
            (BALL, "[0, 0, 0]", EYE, inside),
            (cube, "[1.4, 1.4, 1.4]", EYE, inside),
            (cube, "[1.6, 0, 0]", EYE, ""),
            (BALL, "[0, 2, 0]", EYE, ""),
            (&*shell(r#"{"dielectric": {}}"#), "[0, 0, 0]", EYE, ""),
            (&*shell(r#"{"mask": {"opacity": 0.5, "material": {"diffuse": {}}}}"#), "[0, 0, 0]", EYE, ""),
            (&*shell(r#"{"emissive": {"radiance": 1}}"#), "[0, 0, 0]", EYE, ""),
            (r#"{"shape": "plane", "material": {"diffuse": {}}}"#, "[0, -1, 0]", EYE, ""),
            (open, "[0, 0, 0]", EYE, ""),
            (BALL, "[0, 0.1, 0]", near, ""),
            (BALL, "[0, 2, 0]", near, "camera: the camera is inside of `objects[0]`, and no light is\n"),
        ] {
            let members = format!("{}, {camera}", point(light));
            assert_eq!(warnings(objects, &members), expected, "{objects} {light} {camera}");
        }
        // An emitter or ambient light inside of the same solid lights it.
        let bulb = r#"{"shape": {"sphere": {"radius": 0.1}}, "material": {"emissive": {"radiance": 1}}}"#;
        assert_eq!(warnings(&format!("{BALL}, {bulb}"), near), "");
    }

    #[test]
    fn cameras_that_look_past_all_objects_are_warned_of() {
        let message = "camera: the camera sees no object: all of them are beside or behind its field of view\n";
        let camera = |kind: &str, members: &str, look_at: &str| {
            format!(r#""camera": {{"{kind}": {{"eye": [0, 0, 5], "look_at": {look_at}, {members}}}}}"#)
        };
        let fov = r#""vertical_fov_degrees": 40"#;
        for (camera, expected) in [
            (camera("perspective", fov, "[0, 0, 9]"), message),
            (camera("perspective", fov, "[0, 0, 4]"), ""),
            (camera("perspective", fov, "[0, 5, 0]"), message),
            (camera("perspective", fov, "[0, 2.6, 0]"), ""),
            (camera("orthographic", r#""height": 2"#, "[0, 0, 0]"), ""),
            (camera("orthographic", r#""height": 2"#, "[0, 0, 9]"), message),
            (camera("thin_lens", r#""lens_radius": 0.1, "focus_distance": 5"#, "[0, 0, 9]"), message),
            (camera("thin_lens", r#""lens_radius": 9, "focus_distance": 5"#, "[0, 5, 0]"), ""),
        ] {
            assert_eq!(warnings(BALL, &camera), expected, "{camera}");
        }
        let plane = r#"{"shape": "plane", "material": {"diffuse": {}}}"#;
        assert_eq!(warnings(plane, &camera("perspective", fov, "[0, 9, 5]").replace("[0, 0, 5]", "[0, 1, 5]")), "");
    }
}
