//! Shapes that shine, in the world's space.

use super::emitters::{Lighting, Origin, Receiver, met};
use super::standing::{Standing, standing};
use super::{Level, Vertex};
use juggler_light::emitter::LightBounds;
use juggler_material::{Glow, MaterialId, MaterialTable, Sides, View};
use juggler_math::{Motion, Ray, Rgb, Transform, Vec2, Vec3};
use juggler_shape::{AnyShape, SurfacePoint};
use std::f32::consts::PI;
use std::sync::Arc;

/// A shape that shines.
#[derive(Clone, Debug)]
pub struct Glowing {
    /// Number of the shape.
    pub number: u32,
    shape: Arc<AnyShape>,
    motion: Motion,
    material: MaterialId,
    glow: Glow,
}

impl Glowing {
    /// All shapes of the world's own level, and of those below, that shine.
    pub fn all(top: &Level, materials: &MaterialTable) -> Vec<Self> {
        let glow = |shape: &AnyShape, id| materials.glow(id).filter(|_| shape.area().is_finite());
        let shining = standing(top, usize::MAX, &|shape, id| glow(shape, id).is_some());
        let with_glow = |standing: Standing| {
            let Standing { number, shape, motion, material } = standing;
            Some(Self { number, glow: glow(&shape, material)?, shape, motion, material })
        };
        shining.into_iter().filter_map(with_glow).collect()
    }

    /// The shape.
    pub fn shape(&self) -> &AnyShape {
        &self.shape
    }

    /// Where it is, if it stays there.
    pub fn still(&self) -> Option<&Transform> {
        match &self.motion {
            Motion::Still(transform) => Some(transform),
            Motion::Moving(_) => None,
        }
    }

    /// Whether it shines to both sides.
    pub fn is_two_sided(&self) -> bool {
        self.glow.sides == Sides::Both
    }

    /// Luminance of what it gives off; of a textured one as if it were white.
    pub fn luminance(&self) -> f32 {
        self.glow.radiance.unwrap_or(Rgb::WHITE).luminance()
    }

    /// What the light tree needs to know of it as a whole.
    pub fn bounds(&self) -> LightBounds {
        let stretch = self.motion.at(0.0).max_stretch();
        // As if all of it were seen at once.
        let power = 4.0 * PI * self.shape.area() * stretch * stretch * self.luminance();
        // Whatever its form: normals may stand everywhere.
        let bounds = self.motion.aabb(&self.shape.bounds());
        let two_sided = self.is_two_sided();
        LightBounds { bounds, axis: Vec3::Z, cos_theta_o: -1.0, cos_theta_e: 0.0, power, two_sided }
    }

    /// Light from one place of it; `chance` is that of having picked it.
    pub fn sample(&self, materials: &MaterialTable, to: &Receiver, u: Vec2, chance: f32) -> Option<Lighting> {
        let transform = self.motion.at(to.time);
        let sample = self.shape.sample(transform.point_to_local(to.point), u)?;
        let way = transform.point(sample.point) - to.point;
        let distance = way.length();
        let wi = way / distance;
        let pdf = sample.pdf * density(&transform, to.point, sample.point, sample.normal);
        if !(distance > 0.0 && pdf > 0.0 && pdf < f32::INFINITY) {
            return None;
        }
        let normal = transform.normal(sample.normal);
        if to.is_coplanar(wi, distance, normal) {
            return None;
        }
        let radiance = self.radiance(materials, to, wi, normal)?;
        Some(met(Origin::Shape(self.number), wi, distance, radiance, pdf * chance, normal))
    }

    /// Radiance that comes from a place in the direction `wi`, whose outward normal is `normal`; `None` where nothing
    /// does.
    pub fn radiance(&self, materials: &MaterialTable, to: &Receiver, wi: Vec3, normal: Vec3) -> Option<Rgb> {
        if let Some(radiance) = self.glow.radiance {
            return (self.is_two_sided() || normal.dot(wi) < 0.0).then_some(radiance);
        }
        let transform = &self.motion.at(to.time);
        let ray = transform.ray_to_local(&Ray { time: to.time, ..Ray::new(to.point, wi) });
        let surface = self.shape.surface(&ray, &self.shape.intersect(&ray)?).to_world(transform);
        let view = View { wo: -wi, ..View::of(&surface) };
        Some(materials.radiance(self.material, &view)).filter(|light| !light.is_black())
    }

    /// Density per steradian with which [`Glowing::sample`] picks the point `vertex` of this shape.
    pub fn pdf(&self, from: &Receiver, vertex: &Vertex) -> f32 {
        let transform = self.motion.at(from.time);
        let normal = (transform.matrix().transpose() * vertex.surface.normal).normalize_or(Vec3::Y);
        let point = transform.point_to_local(vertex.surface.point);
        let pdf =
            self.shape.pdf(transform.point_to_local(from.point), &SurfacePoint { point, normal, part: vertex.part });
        pdf * density(&transform, from.point, point, normal)
    }
}

/// Solid angle in object space over that in the world, of a place seen from the world's point `from`: 1 where the
/// transform keeps angles.
fn density(transform: &Transform, from: Vec3, point: Vec3, normal: Vec3) -> f32 {
    if transform.uniform_scale().is_some() {
        return 1.0;
    }
    let local = point - transform.point_to_local(from);
    let world = transform.point(point) - from;
    let across = transform.matrix().determinant().abs() * (transform.inverse_matrix().transpose() * normal).length();
    let angle = |way: Vec3, normal: Vec3| way.dot(normal).abs() / (way.length_squared() * way.length());
    angle(local, normal) / (angle(world, transform.normal(normal)) * across)
}
