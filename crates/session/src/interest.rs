//! Where one looks: what is seen at a pixel, and the point that orbits turn about.

use crate::subject::Subject;
use juggler::math::{Aabb, Ray, Vec2, Vec3};
use juggler::world::Vertex;

impl Subject {
    /// The point and the vertex that is seen at a place of the film, in pixels.
    pub fn seen_at(&self, pixel: [f32; 2]) -> Option<(Vec3, Vertex)> {
        let mut ray = self.ray(pixel);
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let world = self.picture.world();
        let hit = world.closest(&mut ray);
        hit.is_some().then(|| world.vertex(&ray, &hit)).map(|vertex| (vertex.surface.point, vertex))
    }

    /// The ray through a place of the film, in pixels, and the middle of the lens.
    pub fn ray(&self, pixel: [f32; 2]) -> Ray {
        self.picture.job().camera.at(0.5).ray(Vec2::from_array(pixel), Vec2::splat(0.5), 0.5)
    }

    /// Box around the object at a pixel; around everything where no pixel is given or nothing is seen there.
    pub(crate) fn to_frame(&self, pixel: Option<[f32; 2]>) -> Aabb {
        let world = self.picture.world();
        let object = pixel.and_then(|pixel| self.seen_at(pixel)).map(|(_, vertex)| world.shape_bounds(vertex.object));
        let all = world.bounds();
        let all = if all.is_empty() { Aabb { min: -Vec3::ONE, max: Vec3::ONE } } else { all };
        object.filter(|bounds| !bounds.is_empty()).unwrap_or(all)
    }

    /// Finds the point of interest of a camera that one has not looked through before: its `look_at`, or what is seen in the
    /// picture's middle.
    pub(crate) fn begin_interest(&mut self) {
        let target =
            self.picture.view().camera.target().filter(|point| self.is_in_view(*point) && self.is_near(*point));
        self.held = target.is_some();
        match target {
            Some(point) => self.interest = point,
            None => self.look_for_interest(),
        }
    }

    /// What is seen at a pixel becomes the point of interest, unless `look_at` or a person has chosen one.
    pub(crate) fn pivot(&mut self, pixel: [f32; 2]) {
        if !self.held
            && let Some((point, _)) = self.seen_at(pixel)
        {
            (self.interest, self.held) = (point, true);
        }
    }

    /// Forgets a point of interest that has left the picture.
    pub(crate) fn lose_interest(&mut self) {
        if self.held && !self.is_in_view(self.interest) {
            self.held = false;
            self.look_for_interest();
        }
    }

    /// Whether a point is not farther away than the scene reaches: a `look_at` beyond it is meant as a direction.
    fn is_near(&self, point: Vec3) -> bool {
        let bounds = self.picture.world().bounds();
        let Ok(axes) = self.picture.view().camera.axes() else { return false };
        let reach = axes.eye.distance(bounds.center()) + bounds.extent().length() * 0.5;
        bounds.is_empty() || axes.eye.distance(point) <= reach
    }

    /// Whether a point is ahead, and not farther from the picture's middle than its corners are.
    fn is_in_view(&self, point: Vec3) -> bool {
        let Ok(axes) = self.picture.view().camera.axes() else { return false };
        let (corner, depth) = (self.ray([0.0, 0.0]), (point - axes.eye).dot(axes.forward));
        let along = corner.direction.dot(axes.forward);
        let middle = axes.eye + axes.forward * depth;
        let corner = corner.origin + corner.direction * ((middle - corner.origin).dot(axes.forward) / along);
        depth > 0.0 && point.distance_squared(middle) <= corner.distance_squared(middle)
    }

    /// What is seen in the picture's middle, or as far ahead as the middle of everything.
    pub(crate) fn look_for_interest(&mut self) {
        let middle = self.picture.size().map(|edge| edge as f32 * 0.5);
        if let Some((point, _)) = self.seen_at(middle) {
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
