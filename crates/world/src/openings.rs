//! Surfaces that rays may pass straight through: interfaces, masks, and the backs of one-sided
//! surfaces.

use super::{Vertex, World, WorldHit, starts_at};
use juggler_math::{Ray, Vec2, Vec3};

impl World {
    /// Whether the surface is absent for shadow rays that come from the side of `wo`.
    pub fn is_absent(&self, vertex: &Vertex, wo: Vec3) -> bool {
        self.has_absence && self.materials.is_absent(vertex.material, &vertex.surface, wo)
    }

    /// Whether rays from the side of `wo` pass straight through the surface at this point, because
    /// its opacity is 0. `u_choice`, in [0, 1), selects among mixed materials.
    pub fn is_cut_out(&self, vertex: &Vertex, wo: Vec3, u_choice: impl FnOnce() -> f32) -> bool {
        self.may_be_open(vertex) && self.shade(vertex, wo, 1.0, u_choice()).opacity == 0.0
    }

    /// Whether a ray from the side of `wo` passes straight through the surface at this point, because
    /// of its opacity or because it is unlit. Unlit surfaces exist only for rays that `sees_unlit`.
    /// `choice` selects among mixed materials and decides by opacity.
    pub fn is_open(&self, vertex: &Vertex, wo: Vec3, sees_unlit: bool, choice: impl FnOnce() -> Vec2) -> bool {
        if !self.may_be_open(vertex) {
            return false;
        }
        let choice = choice();
        let shading = self.shade(vertex, wo, 1.0, choice.x);
        shading.opacity < 1.0 && choice.y >= shading.opacity || shading.is_unlit && !sees_unlit
    }

    /// Whether a ray may pass the surface: into the interior of a solid, or straight through.
    #[inline]
    pub fn may_pass(&self, vertex: &Vertex) -> bool {
        self.interior(vertex).is_some() || self.may_be_open(vertex)
    }

    /// Whether `ray` may pass the surface. It meets an opaque surface of one side on its front, unless
    /// the ray starts at its place.
    #[inline]
    pub fn may_pass_along(&self, ray: &Ray, vertex: &Vertex) -> bool {
        self.interior(vertex).is_some()
            || self.may_be_open(vertex)
                && (self.materials.passes_front(vertex.material)
                    || self.is_absent(vertex, -ray.direction)
                    || starts_at(ray, vertex, vertex.surface.position_error))
    }

    /// Whether a camera ray sees no light at a hit: its surface neither emits nor lets light pass.
    #[inline]
    pub fn blocks_sight(&self, hit: &WorldHit) -> bool {
        hit.is_some() && self.materials.blocks_sight(self.top.material(hit.shape, None))
    }

    /// Whether light may pass through the surface, which bounds no solid: a pane or a translucent
    /// sheet.
    #[inline]
    pub fn is_sheet(&self, vertex: &Vertex) -> bool {
        self.has_sheets && self.materials.is_sheet(vertex.material)
    }

    /// Whether a ray that leaves a surface at the place of this one passes this one: surfaces that
    /// may be absent, and sheets, exist for light that arrives at their place only. `error` is the
    /// largest error of the surfaces at the place: see [`World::place_error`].
    #[inline]
    pub fn is_left(&self, ray: &Ray, vertex: &Vertex, error: f32) -> bool {
        self.interior(vertex).is_none()
            && (self.may_be_open(vertex) || self.is_sheet(vertex))
            && starts_at(ray, vertex, error)
    }

    /// Largest error of the surfaces at one place, as far as rays start beyond all of them: where
    /// sheets transmit light. Elsewhere the error of the first one.
    pub fn place_error(&self, first: &Vertex, others: impl Iterator<Item = Vertex>) -> f32 {
        let own = first.surface.position_error;
        if !self.has_sheets {
            return own;
        }
        others.fold(own, |error, other| error.max(other.surface.position_error))
    }

    /// Whether the material has an opacity below 1, or is absent for some rays.
    #[inline]
    pub fn may_be_open(&self, vertex: &Vertex) -> bool {
        self.has_opacity && self.materials.has_opacity(vertex.material)
            || self.has_absence && self.materials.has_absence(vertex.material)
    }
}
