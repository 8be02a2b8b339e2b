//! What a material is at one point, seen from one side: light given off, what it lets by, how it scatters.

use super::lookup;
use juggler_bsdf::{Bsdf, fresnel};
use juggler_math::{Frame, Rgb, Vec3, hash};
use juggler_shape::surface::{Surface, Tangents};
use juggler_texture::Lookup;

/// Least sine above the surface at which shading normals may mirror: below it a mirror would look into the ground.
const LEAST_RISE: f32 = 0.01;

/// A point as it is looked at.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The surface, world space, normals as the shape gives them.
    pub surface: &'a Surface,
    /// How the surface runs along its coordinates, where that is known.
    pub tangents: Option<&'a Tangents>,
    /// Unit shading normal on the side of the surface's own, as maps have turned it by now.
    pub normal: Vec3,
    /// Unit, towards the viewer, world space.
    pub wo: Vec3,
    /// Index of refraction around the object, whatever the side that is looked at.
    pub around_ior: f32,
    /// A number in [0, 1) for materials that are one thing or another by chance.
    pub pick: f32,
}

impl<'a> View<'a> {
    /// A point as it is looked at from straight above. What is one thing or another by chance is decided by the digits of
    /// its place.
    #[inline]
    pub fn of(surface: &'a Surface) -> Self {
        let [x, y, z] = surface.point.to_array().map(f32::to_bits);
        let pick = hash::unit_f32(hash::combine(hash::combine(x, y), z));
        let normal = surface.shading_normal;
        View { surface, tangents: None, normal, wo: surface.normal, around_ior: 1.0, pick }
    }

    /// Whether it is looked at from the side to which the true normal points.
    #[inline]
    pub fn is_outside(&self) -> bool {
        self.surface.normal.dot(self.wo) >= 0.0
    }

    /// Where textures are asked.
    pub(super) fn lookup(&self) -> Lookup {
        lookup(self.surface)
    }
}

/// A material at one point.
#[derive(Clone, Debug)]
pub struct Shade {
    /// Radiance that it gives off towards the viewer.
    pub emission: Rgb,
    /// Share of light that meets it; the rest goes straight on as if nothing were there. 0 to 1.
    pub opacity: f32,
    /// Frame of the scattering function. Its z is the shading normal: on the outside of what has an inside, on the viewer's
    /// side of all else.
    pub frame: Frame,
    /// How light is scattered.
    pub bsdf: Bsdf,
    /// Whether light may come through.
    pub transmissive: bool,
    /// Factor on what the scene's lights bring (not shapes that glow): π for the classic material, whose lights always
    /// were so measured that one of radiance 1 makes a white surface white.
    pub lamp_scale: f32,
}

impl Shade {
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
            lamp_scale: 1.0,
        }
    }

    /// Sets the geometric normal, in world space, of a surface whose shading normal a map has
    /// turned; the frame is known by then. See [`Bsdf::set_geometric_normal`].
    pub(super) fn set_geometric_normal(&mut self, normal: Vec3) {
        self.bsdf.set_geometric_normal(self.frame.to_local(normal));
    }

    /// The share of light from everywhere that comes back towards `wo`, a unit vector of the world: its colour without light.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        self.bsdf.albedo(self.frame.to_local(wo))
    }
}

/// The shading normal `normal` on the viewer's side, bent so far towards the true one that a mirror there shows
/// something above the surface (Keller et al., The Iray Light Transport Simulation and Rendering System, 2017,
/// appendix A.3): no black edges where the two differ much.
#[inline]
pub fn facing_normal(view: &View, normal: Vec3) -> Vec3 {
    let turned = if view.is_outside() { 1.0 } else { -1.0 };
    let (truth, normal) = (view.surface.normal * turned, normal * turned);
    if truth == normal {
        return normal;
    }
    let mirrored = fresnel::reflect(view.wo, normal);
    let least = LEAST_RISE.min(0.9 * truth.dot(view.wo));
    let rise = mirrored.dot(truth);
    if rise >= least && normal.dot(view.wo) > 0.0 {
        return normal;
    }
    let along = (mirrored - truth * rise).normalize_or_zero() * (1.0 - least * least).sqrt();
    (along + truth * least + view.wo).normalize_or(truth)
}
