//! Emissive shapes in world space.

use super::emitters::{EmitterId, EmitterSample, LightSampleContext, bsdf_sampled};
use super::world_shapes::{WorldMotion, WorldShape, collect_shapes};
use super::{Geometry, InstanceAttributes, Vertex};
use juggler_light::emitter::LightBounds;
use juggler_material::{MaterialId, MaterialTable, ShadingView, Sides, SurfaceEmission, TexturedPoint};
use juggler_math::{Ray, Rgb, Transform, Vec2, Vec3};
use juggler_shape::{AnyShape, Mesh, SurfacePoint};
use std::f32::consts::PI;
use std::sync::Arc;

/// An emissive shape.
#[derive(Clone, Debug)]
pub struct EmissiveShape {
    /// Index of the shape, counting the contents of every instance.
    pub shape_index: u32,
    shape: Arc<AnyShape>,
    motion: WorldMotion,
    /// Motion of the sampled points, if it differs: that of a moving sphere without rotation.
    sphere_motion: Option<Box<WorldMotion>>,
    material: MaterialId,
    emission: SurfaceEmission,
    attributes: Option<InstanceAttributes>,
}

impl EmissiveShape {
    /// Collects all emissive shapes of finite area in the top level and the levels below.
    pub fn collect(top: &Geometry, materials: &MaterialTable) -> Vec<Self> {
        let emission = |shape: &AnyShape, id| materials.emission(id).filter(|_| shape.area().is_finite());
        let emissive = collect_shapes(top, usize::MAX, &|shape, id| emission(shape, id).is_some());
        let with_emission = |world_shape: WorldShape| {
            let WorldShape { shape_index, shape, motion, sphere_motion, material, attributes } = world_shape;
            let emission = emission(&shape, material)?;
            Some(Self { shape_index, emission, shape, motion, sphere_motion, material, attributes })
        };
        emissive.into_iter().filter_map(with_emission).collect()
    }

    /// Emissive shape, in object space.
    pub fn shape(&self) -> &AnyShape {
        &self.shape
    }

    /// Transform to world space; `None` if the shape moves or deforms.
    pub fn static_transform(&self) -> Option<Transform> {
        self.motion.static_transform().filter(|_| self.moving_mesh().is_none())
    }

    /// The mesh, if it deforms while the shutter is open.
    fn moving_mesh(&self) -> Option<&Mesh> {
        self.shape.mesh().filter(|mesh| mesh.moves())
    }

    /// Transform of the sampled points at a time.
    fn transform_at(&self, time: f32) -> Transform {
        self.sphere_motion.as_deref().unwrap_or(&self.motion).at(time)
    }

    /// Whether both sides of the surface emit.
    pub fn is_two_sided(&self) -> bool {
        self.emission.sides == Sides::Both
    }

    /// Luminance of the emitted radiance. Textured emission counts as white.
    pub fn luminance(&self) -> f32 {
        self.emission.radiance.unwrap_or(Rgb::WHITE).luminance()
    }

    /// Bounds for the light tree.
    pub fn bounds(&self) -> LightBounds {
        let scale = self.motion.max_scale();
        // Upper bound: as if the whole area faced the receiver.
        let power = 4.0 * PI * self.shape.area() * scale * scale * self.luminance();
        // Normals of an arbitrary shape may point anywhere.
        let bounds = self.motion.aabb(&self.shape.bounds());
        let two_sided = self.is_two_sided();
        LightBounds { bounds, axis: Vec3::Z, cos_theta_o: -1.0, cos_theta_e: 0.0, power, two_sided }
    }

    /// Samples a point on the shape. `probability` is the probability of having selected this
    /// shape.
    pub fn sample(
        &self,
        materials: &MaterialTable,
        context: &LightSampleContext,
        u: Vec2,
        probability: f32,
    ) -> Option<EmitterSample> {
        let transform = self.transform_at(context.time);
        let from = transform.point_to_local(context.point);
        let sample = match self.moving_mesh() {
            Some(mesh) => mesh.sample_at(from, u, context.time)?,
            None => self.shape.sample(from, u)?,
        };
        let offset = transform.point(sample.point) - context.point;
        let distance = offset.length();
        let wi = offset / distance;
        let pdf = sample.pdf * solid_angle_ratio(&transform, context.point, sample.point, sample.normal);
        if !(distance > 0.0 && pdf > 0.0 && pdf < f32::INFINITY) {
            return None;
        }
        let normal = transform.normal(sample.normal);
        if context.is_coplanar(wi, distance, normal) {
            return None;
        }
        let radiance = self.radiance(materials, context, wi, normal)?;
        Some(bsdf_sampled(EmitterId::Shape(self.shape_index), wi, distance, radiance, pdf * probability, normal))
    }

    /// Emitted radiance that arrives from the direction `wi`, at a point with outward normal
    /// `normal`; `None` if there is none.
    pub fn radiance(
        &self,
        materials: &MaterialTable,
        context: &LightSampleContext,
        wi: Vec3,
        normal: Vec3,
    ) -> Option<Rgb> {
        if let Some(radiance) = self.emission.radiance {
            return (self.is_two_sided() || normal.dot(wi) < 0.0).then_some(radiance);
        }
        let transform = &self.motion.at(context.time);
        let ray = transform.ray_to_local(&Ray { time: context.time, ..Ray::new(context.point, wi) });
        let hit = self.shape.intersect(&ray)?;
        let surface = self.shape.surface(&ray, &hit).to_world(transform);
        let mut mesh = self.shape.mesh_point(hit.primitive, &surface);
        if let Some(attributes) = &self.attributes {
            mesh = Some(mesh.unwrap_or_default().with_instances(attributes, self.shape_index, surface.uv.y));
        }
        let point = TexturedPoint { surface: &surface, mesh: mesh.as_ref() };
        let view = ShadingView { wo: -wi, ..ShadingView::along_normal(point) };
        Some(materials.radiance(self.material, &view)).filter(|light| !light.is_black())
    }

    /// Density per steradian, seen from `from`, with which [`EmissiveShape::sample`] picks the
    /// point `vertex` of this shape.
    pub fn pdf(&self, from: &LightSampleContext, vertex: &Vertex) -> f32 {
        let transform = self.transform_at(from.time);
        let normal = (transform.matrix().transpose() * vertex.surface.normal).normalize_or(Vec3::Y);
        let point = transform.point_to_local(vertex.surface.point);
        let local = SurfacePoint { point, normal, primitive: vertex.primitive };
        let pdf = match self.moving_mesh() {
            Some(mesh) => mesh.pdf_at(transform.point_to_local(from.point), &local, from.time),
            None => self.shape.pdf(transform.point_to_local(from.point), &local),
        };
        pdf * solid_angle_ratio(&transform, from.point, point, normal)
    }
}

/// Ratio of the solid angle in object space to that in world space, of a surface element at `point`
/// seen from the world-space point `from`. It is 1 for transforms that preserve angles.
fn solid_angle_ratio(transform: &Transform, from: Vec3, point: Vec3, normal: Vec3) -> f32 {
    if transform.uniform_scale().is_some() {
        return 1.0;
    }
    let local = point - transform.point_to_local(from);
    let world = transform.point(point) - from;
    let across = transform.matrix().determinant().abs() * (transform.inverse_matrix().transpose() * normal).length();
    let angle = |offset: Vec3, normal: Vec3| offset.dot(normal).abs() / (offset.length_squared() * offset.length());
    angle(local, normal) / (angle(world, transform.normal(normal)) * across)
}
