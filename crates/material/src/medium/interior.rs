//! Solids around a path: nested dielectrics by priority (Schmidt and Budge, Simple Nested
//! Dielectrics in Ray Traced Images, 2002).

use super::{Medium, Wavelength};
use std::cmp::Reverse;

/// Maximum number of nested solids that a path tracks.
pub const MAX_INTERIORS: usize = 4;

/// Interior of a solid, behind a surface that transmits light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Index of refraction, at 587.56 nm.
    pub ior: f32,
    /// Dispersion: 20 divided by the Abbe number, 0 for none.
    pub dispersion: f32,
    /// Priority where solids overlap: the highest priority fills the overlap.
    pub priority: i32,
    /// Medium inside.
    pub medium: Medium,
}

impl Interior {
    /// Index of refraction for light of a wavelength, or of all wavelengths.
    #[inline]
    pub fn ior_at(&self, wavelength: Option<Wavelength>) -> f32 {
        wavelength.map_or(self.ior, |wavelength| wavelength.ior(self.ior, self.dispersion))
    }
}

/// Index of an interior in the table of a world's interiors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct InteriorId(u16);

impl InteriorId {
    /// Id of the interior at `index` in the table; `None` beyond the largest id.
    pub fn new(index: usize) -> Option<Self> {
        u16::try_from(index).ok().filter(|index| *index < u16::MAX).map(Self)
    }

    /// Index in the table.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Solids around a path, in order of entry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interiors {
    /// Places in the table plus 1; unused elements are 0 and stand at the end.
    solids: [u16; MAX_INTERIORS],
}

impl Interiors {
    /// Outside of all solids.
    pub const NONE: Self = Self { solids: [0; MAX_INTERIORS] };

    /// Whether the path is outside of all solids.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.solids[0] == 0
    }

    /// Interiors after entering a solid; unchanged if [`MAX_INTERIORS`] solids are tracked already.
    #[must_use]
    #[inline]
    pub fn entered(mut self, id: InteriorId) -> Self {
        if let Some(free) = self.solids.iter_mut().find(|solid| **solid == 0) {
            *free = id.0 + 1;
        }
        self
    }

    /// Interiors after leaving a solid: the last entry of that solid is removed; unchanged if there
    /// is none.
    #[must_use]
    #[inline]
    pub fn exited(self, id: InteriorId) -> Self {
        let Some(at) = self.solids.iter().rposition(|solid| *solid == id.0 + 1) else { return self };
        let mut solids = [0; MAX_INTERIORS];
        let others = self.solids.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, solid)| *solid);
        solids.iter_mut().zip(others).for_each(|(slot, solid)| *slot = solid);
        Self { solids }
    }

    /// Interiors after crossing the interface of a solid.
    #[must_use]
    #[inline]
    pub fn crossed(self, id: InteriorId, inwards: bool) -> Self {
        if inwards { self.entered(id) } else { self.exited(id) }
    }

    /// Whether another solid hides the interface of solid `id`, which the path crosses inwards or
    /// outwards: one of higher priority, or of equal priority with the same or a lower id.
    /// `interiors` is the table of all interiors.
    #[inline]
    pub fn hides_interface(&self, id: InteriorId, inwards: bool, interiors: &[Interior]) -> bool {
        if self.is_empty() {
            return false;
        }
        let others = if inwards { *self } else { self.exited(id) };
        let rank = |id: InteriorId| interiors.get(id.index()).map(|own| (own.priority, Reverse(id.0)));
        others.top_id(interiors).and_then(rank) >= rank(id)
    }

    /// Interior that the path is in: that of [`Interiors::top_id`].
    #[inline]
    pub fn top<'i>(&self, interiors: &'i [Interior]) -> Option<&'i Interior> {
        if self.is_empty() {
            return None;
        }
        self.top_id(interiors).and_then(|id| interiors.get(id.index()))
    }

    /// Id of the interior that the path is in: among the solids of the highest priority, the one of
    /// the lowest id. The order of entry does not count, so that the medium of an overlap is the
    /// same for all paths. `interiors` is the table of all interiors.
    pub fn top_id(&self, interiors: &[Interior]) -> Option<InteriorId> {
        let ids = self.solids.iter().filter_map(|solid| solid.checked_sub(1)).map(InteriorId);
        let known = ids.filter_map(|id| Some((Reverse(interiors.get(id.index())?.priority), id.0)));
        known.min().map(|(_, id)| InteriorId(id))
    }
}
