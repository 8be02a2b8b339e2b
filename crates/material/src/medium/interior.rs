//! Which solids a path is in: nested dielectrics by priority (Schmidt and Budge, Simple Nested Dielectrics in Ray Traced
//! Images, 2002).

use super::Medium;

/// Solids that a path can be in at once and know of.
pub const MAX_INTERIORS: usize = 4;

/// What is behind a surface that light goes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Index of refraction.
    pub ior: f32,
    /// Where solids overlap, the one with the highest priority is there, and the others are not.
    pub priority: i32,
    /// What fills it.
    pub medium: Medium,
}

/// An interior's place among those of the world's materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InteriorId(u16);

impl InteriorId {
    /// For one of a table's interiors; `None` when there are too many.
    pub fn new(place: usize) -> Option<Self> {
        u16::try_from(place).ok().filter(|place| *place < u16::MAX).map(Self)
    }

    /// Its place in the table.
    #[inline]
    pub fn place(self) -> usize {
        usize::from(self.0)
    }
}

/// The solids that a path is in, in the order in which it came in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interiors {
    /// Places plus one; zeros at the end.
    solids: [u16; MAX_INTERIORS],
}

impl Interiors {
    /// In the open.
    pub const NONE: Self = Self { solids: [0; MAX_INTERIORS] };

    /// Whether it is in none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.solids[0] == 0
    }

    /// After it came into one more; unchanged when it is in too many already.
    #[must_use]
    #[inline]
    pub fn entered(mut self, id: InteriorId) -> Self {
        if let Some(free) = self.solids.iter_mut().find(|solid| **solid == 0) {
            *free = id.0 + 1;
        }
        self
    }

    /// After it left one, the last of that kind that it came into; unchanged when it is not in it.
    #[must_use]
    #[inline]
    pub fn left(self, id: InteriorId) -> Self {
        let Some(at) = self.solids.iter().rposition(|solid| *solid == id.0 + 1) else { return self };
        let mut solids = [0; MAX_INTERIORS];
        let others = self.solids.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, solid)| *solid);
        solids.iter_mut().zip(others).for_each(|(place, solid)| *place = solid);
        Self { solids }
    }

    /// After it crossed the surface of one.
    #[must_use]
    #[inline]
    pub fn crossed(self, id: InteriorId, inwards: bool) -> Self {
        if inwards { self.entered(id) } else { self.left(id) }
    }

    /// Whether the surface of a solid is not there where a path that is in these meets it, on its way in or out: in another
    /// one, of higher priority.
    #[inline]
    pub fn hide(&self, id: InteriorId, inwards: bool, interiors: &[Interior]) -> bool {
        if self.is_empty() {
            return false;
        }
        let others = if inwards { *self } else { self.left(id) };
        let own = interiors.get(id.place()).map(|own| own.priority);
        others.top(interiors).map(|other| other.priority) > own
    }

    /// What it really is in: of the solids with the highest priority the one it came into last. `interiors` is the table
    /// of all.
    #[inline]
    pub fn top<'i>(&self, interiors: &'i [Interior]) -> Option<&'i Interior> {
        if self.is_empty() {
            return None;
        }
        let known = self.solids.iter().filter_map(|solid| interiors.get(usize::from(solid.checked_sub(1)?)));
        known.reduce(|best, next| if next.priority >= best.priority { next } else { best })
    }
}
