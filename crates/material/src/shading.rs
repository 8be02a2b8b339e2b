//! Shading of a material at one point for one viewer: emission, opacity and BSDF.

use super::{TexturedPoint, lookup};
use juggler_bsdf::{Bsdf, fresnel};
use juggler_math::{Frame, Rgb, Vec3, hash};
use juggler_shape::MeshPoint;
use juggler_shape::surface::{Surface, Tangents};
use juggler_texture::TextureLookup;

/// Smallest cosine between the geometric normal and the mirror direction. At smaller cosines, a
/// mirror would reflect the surface itself.
const MIN_MIRROR_COSINE: f32 = 0.01;

/// Point of a surface with the direction to its viewer.
#[derive(Clone, Copy, Debug)]
pub struct ShadingView<'a> {
    /// Surface in world space, with the normals of its shape.
    pub surface: &'a Surface,
    /// Point of a mesh that has attributes or a second set of surface coordinates.
    pub mesh: Option<&'a MeshPoint<'a>>,
    /// Tangents of the surface along u and v, if known.
    pub tangents: Option<&'a Tangents>,
    /// Unit shading normal in world space, on the side of the shape's normals. The normal and bump
    /// maps around the material have been applied.
    pub normal: Vec3,
    /// Unit direction towards the viewer, in world space.
    pub wo: Vec3,
    /// Index of refraction outside the object, even if the viewer is inside.
    pub outside_ior: f32,
    /// Random number in [0, 1) that chooses one of the materials of a mixture.
    pub u_choice: f32,
}

impl<'a> ShadingView<'a> {
    /// View along the normal. Its random number is a hash of the point's coordinates.
    #[inline]
    pub fn along_normal(point: impl Into<TexturedPoint<'a>>) -> Self {
        let TexturedPoint { surface, mesh } = point.into();
        let [x, y, z] = surface.point.to_array().map(f32::to_bits);
        let u_choice = hash::unit_f32(hash::combine(hash::combine(x, y), z));
        let normal = surface.shading_normal;
        ShadingView { surface, mesh, tangents: None, normal, wo: surface.normal, outside_ior: 1.0, u_choice }
    }

    /// Whether the viewer is on the side of the geometric normal.
    #[inline]
    pub fn is_outside(&self) -> bool {
        self.surface.normal.dot(self.wo) >= 0.0
    }

    /// Texture lookup at the point.
    pub(super) fn lookup(&self) -> TextureLookup<'a> {
        lookup(TexturedPoint { surface: self.surface, mesh: self.mesh })
    }
}

/// Shading of a material at one point.
#[derive(Clone, Debug)]
pub struct Shading {
    /// Radiance emitted towards the viewer.
    pub emission: Rgb,
    /// Opacity, 0 to 1: share of the light that interacts with the surface. The rest passes
    /// straight through.
    pub opacity: f32,
    /// Frame of the BSDF in world space. Its z axis is the shading normal: outwards for materials
    /// with an interior, otherwise on the viewer's side.
    pub frame: Frame,
    /// Scattering function in `frame`.
    pub bsdf: Bsdf,
    /// Whether the BSDF may transmit light.
    pub transmissive: bool,
    /// Whether `emission` is the color of an unlit surface, which exists only for camera rays and
    /// their specular continuations.
    pub is_unlit: bool,
    /// Factor on the contribution of the scene's lights, but not of emissive shapes. It is π for
    /// the material `phong`, for which a light of radiance 1 makes a white surface white; it is 1
    /// for `phong` with the `diffuse_normalization` of `inverse_pi` and for all other materials.
    pub light_scale: f32,
}

impl Shading {
    /// Shading of a surface that absorbs all light; the caller sets its frame. A function, not a
    /// constant: a constant would be copied whole, unused lobes included.
    #[inline(always)]
    pub fn black() -> Self {
        Self {
            emission: Rgb::BLACK,
            opacity: 1.0,
            frame: Frame::AXES,
            bsdf: Bsdf::new(),
            transmissive: false,
            is_unlit: false,
            light_scale: 1.0,
        }
    }

    /// Sets the geometric normal, in world space, where a map has changed the shading normal;
    /// requires `frame`. See [`Bsdf::set_geometric_normal`].
    pub(super) fn set_geometric_normal(&mut self, normal: Vec3) {
        self.bsdf.set_geometric_normal(self.frame.to_local(normal));
    }

    /// Turns diffuse reflection about the normal of a map, where the frame's normal was bent
    /// towards the viewer: see [`facing_normal`].
    pub(super) fn tilt_diffuse(&mut self, view: &ShadingView) {
        let mapped = if view.is_outside() { view.normal } else { -view.normal };
        if mapped != self.frame.normal {
            self.bsdf.tilt_diffuse(self.frame.to_local(mapped));
        }
    }

    /// Directional albedo for `wo`, a unit vector in world space.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        self.bsdf.albedo(self.frame.to_local(wo))
    }
}

/// Shading normal on the viewer's side, bent towards the geometric normal until the mirror
/// direction lies above the surface (Keller et al., The Iray Light Transport Simulation and
/// Rendering System, 2017, appendix A.3). Prevents black edges where both normals differ much.
#[inline(always)]
pub fn facing_normal(view: &ShadingView, normal: Vec3) -> Vec3 {
    let sign = if view.is_outside() { 1.0 } else { -1.0 };
    if view.surface.normal == normal { normal * sign } else { bent_normal(view, normal * sign, sign) }
}

/// [`facing_normal`] where the normals differ; `sign` is that of the viewer's side. Kept out of line,
/// since most surfaces have no shading normals.
#[inline(never)]
fn bent_normal(view: &ShadingView, normal: Vec3, sign: f32) -> Vec3 {
    let ng = view.surface.normal * sign;
    let reflected = fresnel::reflect(view.wo, normal);
    let min_cosine = MIN_MIRROR_COSINE.min(0.9 * ng.dot(view.wo));
    let cosine = reflected.dot(ng);
    if cosine >= min_cosine && normal.dot(view.wo) > 0.0 {
        return normal;
    }
    let along = (reflected - ng * cosine).normalize_or_zero() * (1.0 - min_cosine * min_cosine).sqrt();
    (along + ng * min_cosine + view.wo).normalize_or(ng)
}
