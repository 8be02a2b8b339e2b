//! What belongs together: which entry of the scene a shape comes from, and which group of lights what shines is of.

use super::{Origin, World};
use crate::layer::LightGroup;

/// What belongs together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// The first shape of each entry of the scene, rising; an entry may have none.
    pub entries: Vec<u32>,
    /// The group that each entry's light is of; nothing where none has one.
    pub groups: Vec<LightGroup>,
    /// The group that the background's light is of.
    pub background: LightGroup,
}

impl World {
    /// With what belongs together.
    #[must_use]
    pub fn with_labels(mut self, labels: Labels) -> Self {
        self.has_groups = !labels.groups.is_empty()
            || labels.background != LightGroup::REST
            || self.lamps.iter().any(|lamp| lamp.group != LightGroup::REST);
        self.labels = labels;
        self
    }

    /// The entry of the scene that a shape comes from, by number.
    pub fn entry_of(&self, shape: u32) -> u32 {
        (self.labels.entries.partition_point(|first| *first <= shape) as u32).saturating_sub(1)
    }

    /// The group of lights that a shape's light is of.
    #[inline]
    pub fn shape_group(&self, shape: u32) -> LightGroup {
        if self.labels.groups.is_empty() {
            return LightGroup::REST;
        }
        self.labels.groups.get(self.entry_of(shape) as usize).copied().unwrap_or_default()
    }

    /// The group of lights that the background's light is of.
    pub fn background_group(&self) -> LightGroup {
        self.labels.background
    }

    /// The group of lights that light is of.
    #[inline]
    pub fn light_group(&self, origin: Origin) -> LightGroup {
        if !self.has_groups {
            return LightGroup::REST;
        }
        match origin {
            Origin::Lamp(number) => self.lamps.get(number as usize).map_or(LightGroup::REST, |lamp| lamp.group),
            Origin::Shape(number) => self.shape_group(number),
            Origin::Background => self.background_group(),
        }
    }
}
