//! Picking, and the point of interest that orbits rotate about.

use crate::subject::Subject;
use juggler::math::{Aabb, Ray, Vec2, Vec3};
use juggler::world::Vertex;

impl Subject {
    /// Returns the visible point at a film position, in pixels, with its vertex.
    pub fn pick(&self, pixel: [f32; 2]) -> Option<(Vec3, Vertex)> {
        let mut ray = self.ray(pixel);
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let world = self.picture.world();
        let hit = world.closest(&mut ray);
        hit.is_some().then(|| world.vertex(&ray, &hit)).map(|vertex| (vertex.surface.point, vertex))
    }

    /// Returns the camera ray through a film position, in pixels, at the center of lens and shutter
    /// interval.
    pub fn ray(&self, pixel: [f32; 2]) -> Ray {
        self.picture.job().camera.projection_at(0.5).ray(Vec2::from_array(pixel), Vec2::splat(0.5), 0.5)
    }

    /// Returns the bounding box of the object at a pixel, or of all bounded objects if there is
    /// none.
    pub(crate) fn framing_bounds(&self, pixel: Option<[f32; 2]>) -> Aabb {
        let world = self.picture.world();
        let object = pixel.and_then(|pixel| self.pick(pixel)).map(|(_, vertex)| world.shape_bounds(vertex.shape));
        let all = world.bounds();
        let all = if all.is_empty() { Aabb { min: -Vec3::ONE, max: Vec3::ONE } } else { all };
        object.filter(|bounds| !bounds.is_empty()).unwrap_or(all)
    }

    /// Returns the speed of the keys that move the camera, in scene units per second: the camera
    /// covers its distance to the point of interest in one second. The speed is at least 1/400 and
    /// at most 1/4 of the scene's extent, so that neither a surface in front of the camera stops it
    /// nor a distant one makes it too fast.
    pub fn flight_speed(&self) -> f32 {
        let extent = self.extent();
        let distance = self.picture.view().camera.axes().map_or(extent, |axes| axes.eye.distance(self.interest));
        distance.clamp(extent / 400.0, extent / 4.0)
    }

    /// Sets the point of interest of a new camera: its `look_at` if in view and within the scene,
    /// else the visible point at the image center.
    pub(crate) fn init_interest(&mut self) {
        let target =
            self.picture.view().camera.target().filter(|point| self.is_in_view(*point) && self.is_near(*point));
        self.interest_is_chosen = target.is_some();
        match target {
            Some(point) => self.interest = point,
            None => self.center_interest(),
        }
    }

    /// Makes the visible point at a pixel the point of interest, unless one is chosen already.
    pub(crate) fn pivot(&mut self, pixel: [f32; 2]) {
        if !self.interest_is_chosen
            && let Some((point, _)) = self.pick(pixel)
        {
            (self.interest, self.interest_is_chosen) = (point, true);
        }
    }

    /// Discards a chosen point of interest that is no longer in view.
    pub(crate) fn drop_hidden_interest(&mut self) {
        if self.interest_is_chosen && !self.is_in_view(self.interest) {
            self.interest_is_chosen = false;
            self.center_interest();
        }
    }

    /// Returns whether a point is within the scene's reach; a `look_at` farther away only gives a
    /// direction.
    fn is_near(&self, point: Vec3) -> bool {
        let bounds = self.picture.world().bounds();
        let Ok(axes) = self.picture.view().camera.axes() else { return false };
        let reach = axes.eye.distance(bounds.center()) + bounds.extent().length() * 0.5;
        bounds.is_empty() || axes.eye.distance(point) <= reach
    }

    /// Returns whether a point is in front of the camera and at most as far from the optical axis
    /// as the image corners.
    fn is_in_view(&self, point: Vec3) -> bool {
        let Ok(axes) = self.picture.view().camera.axes() else { return false };
        let (corner, depth) = (self.ray([0.0, 0.0]), (point - axes.eye).dot(axes.forward));
        let along = corner.direction.dot(axes.forward);
        let middle = axes.eye + axes.forward * depth;
        let corner = corner.origin + corner.direction * ((middle - corner.origin).dot(axes.forward) / along);
        depth > 0.0 && point.distance_squared(middle) <= corner.distance_squared(middle)
    }

    /// Sets the point of interest to the visible point at the image center, else to a point on the
    /// optical axis at the depth of the scene's center.
    pub(crate) fn center_interest(&mut self) {
        let middle = self.picture.size().map(|edge| edge as f32 * 0.5);
        if let Some((point, _)) = self.pick(middle) {
            self.interest = point;
            return;
        }
        let Ok(axes) = self.picture.view().camera.axes() else { return };
        let bounds = self.picture.world().bounds();
        let center = if bounds.is_empty() { Vec3::ZERO } else { bounds.center() };
        let ahead = (center - axes.eye).dot(axes.forward);
        let ahead = if ahead > 0.0 { ahead } else { self.extent() };
        self.interest = axes.eye + axes.forward * ahead;
    }
}

#[cfg(test)]
mod tests {
    use crate::{BuildRequest, Edit, Fly, Subject};
    use juggler::scene::Scene;

    /// A sphere at the origin, seen from a distance of 100, between spheres 20,000 apart.
    fn subject() -> Subject {
        let sphere = |x: i32| format!(r#"{{"shape": "sphere", "transform": [{{"translate": [{x}, 0, 0]}}]}}"#);
        let objects = [-10_000, 0, 10_000].map(sphere).join(", ");
        let text = format!(
            r#"{{"version": 1, "render": {{"size": [32, 24]}}, "objects": [{objects}],
                "camera": {{"perspective": {{"eye": [0, 0, 101], "direction": [0, 0, -1]}}}}}}"#
        );
        let scene = Scene::from_json(text, "scene.json").unwrap();
        BuildRequest::from_scene(scene, "scene.json", None).run().unwrap()
    }

    #[test]
    fn flying_slows_down_near_objects() {
        let mut subject = subject();
        let mut at = |forward: f32| {
            subject.apply(&Edit::Fly(Fly { forward, ..Fly::default() })).unwrap();
            subject.flight_speed()
        };
        // The camera sees the front of the sphere, at z = 1.
        assert!((at(0.0) - 100.0).abs() < 1e-2);
        assert!((at(25.0) - 75.0).abs() < 1e-2);
        let least = at(74.99);
        assert!((least - 20_002.0 / 400.0).abs() < 0.1, "{least}");
        let most = at(-1e6);
        assert!((most - 20_002.0 / 4.0).abs() < 1.0, "{most}");
    }
}
