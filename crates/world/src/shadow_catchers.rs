//! Hidden backgrounds, and shadow catchers: objects of a transparent picture that show only the light that other objects
//! take from them.
//!
//! A camera path that reaches a shadow catcher continues twice: in the world, and in a world of which
//! only shadow catchers and emitting objects are left. The ratio of the two radiances is the
//! fraction of the light that the others leave.

use super::geometry_stats::geometries;
use super::{Content, Object, World, WorldHit};
use juggler_light::background::AnyBackground;
use juggler_material::MaterialTable;
use juggler_math::{BuildControl, Cancelled};
use std::sync::Arc;

/// Shadow catchers of a world.
#[derive(Clone)]
pub(super) struct ShadowCatchers {
    /// Whether each scene entry is a shadow catcher.
    entries: Arc<[bool]>,
    /// The world without objects that neither catch shadows nor emit light.
    unoccluded: Arc<World>,
}

impl ShadowCatchers {
    /// Replaces materials, lights and background.
    pub(super) fn with_shading(
        &self,
        materials: MaterialTable,
        lights: Vec<super::SceneLight>,
        background: AnyBackground,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let unoccluded = self.unoccluded.with_shading(materials, lights, background, control)?;
        let unoccluded = Arc::new(unoccluded.with_hidden_background(true));
        Ok(Self { entries: Arc::clone(&self.entries), unoccluded })
    }

    /// Sets the SIMD instruction set of ray queries.
    pub(super) fn with_simd_level(self, level: super::SimdLevel) -> Self {
        let unoccluded = Arc::new(Arc::unwrap_or_clone(self.unoccluded).with_simd_level(level));
        Self { unoccluded, ..self }
    }
}

impl Object {
    /// Whether any surface of the object may emit light.
    pub fn may_emit(&self, materials: &MaterialTable) -> bool {
        let emits = |id| materials.emission(id).is_some();
        self.material.is_some_and(emits)
            || match &self.content {
                Content::Shape(_) => false,
                Content::Geometry(geometry) => {
                    let geometries = geometries(geometry);
                    geometries.iter().flat_map(|geometry| &geometry.objects).filter_map(|it| it.material()).any(emits)
                }
            }
    }
}

impl World {
    /// Hides the background from camera rays, also through glass. Its light stays.
    #[must_use]
    pub fn with_hidden_background(self, hides_background: bool) -> Self {
        Self { hides_background, ..self }
    }

    /// Whether camera rays see black in place of the background.
    #[inline]
    pub fn hides_background(&self) -> bool {
        self.hides_background
    }

    /// Makes scene entries shadow catchers, by `entries`. `unoccluded` is the world without all
    /// objects that neither are in such entries nor emit light.
    #[must_use]
    pub fn with_shadow_catchers(mut self, entries: Vec<bool>, unoccluded: Self) -> Self {
        let unoccluded = Arc::new(unoccluded.with_hidden_background(true));
        self.shadow_catchers = Some(ShadowCatchers { entries: entries.into(), unoccluded });
        self
    }

    /// The world in which nothing takes light from shadow catchers; `None` if the picture shows the
    /// background, or if there are no shadow catchers.
    pub fn unoccluded(&self) -> Option<&Self> {
        let catchers = self.shadow_catchers.as_ref().filter(|_| self.hides_background)?;
        Some(&catchers.unoccluded)
    }

    /// Whether a ray hit a shadow catcher.
    pub fn is_on_shadow_catcher(&self, hit: &WorldHit) -> bool {
        hit.is_some()
            && self.shadow_catchers.as_ref().is_some_and(|catchers| {
                catchers.entries.get(self.entry_of(hit.shape) as usize).copied().unwrap_or_default()
            })
    }
}
