//! Properties of compiled materials that ray queries read without shading a point.

use super::SurfaceEmission;
use crate::medium::InteriorId;

/// Properties of a material that hold at all points.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialProperties {
    /// Whether shadow rays of the classic integrator pass somewhere.
    pub transparent: bool,
    /// Whether opacity is below 1 somewhere.
    pub has_opacity: bool,
    /// Whether the surface is absent for some rays, whatever the point.
    pub has_absence: bool,
    /// Whether light may pass straight through the front.
    pub passes_front: bool,
    /// Whether the BSDF transmits light.
    pub transmits: bool,
    /// Whether shading varies over the surface.
    pub textured: bool,
    /// Whether shading needs the surface's tangents.
    pub tangents: bool,
    /// Emission, if any.
    pub emission: Option<SurfaceEmission>,
    /// Interior behind the surface, if any.
    pub interior: Option<InteriorId>,
}

impl MaterialProperties {
    pub(super) const NONE: Self = Self {
        transparent: false,
        has_opacity: false,
        has_absence: false,
        passes_front: false,
        transmits: false,
        textured: false,
        tangents: false,
        emission: None,
        interior: None,
    };
}
