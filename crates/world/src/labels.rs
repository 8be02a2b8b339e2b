//! What belongs together: which entry of the scene a shape comes from, and which group of lights what shines is of.

use super::{Origin, World};
use juggler_camera::layer::LightGroup;

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

/// Something that gives off light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightSource {
    /// One of those that are not told apart: there are too many, or it is light from everywhere.
    Rest,
    /// A light of the scene, by its number among [`World::lamps`].
    Lamp(u32),
    /// An entry of the scene that shines, by number.
    Entry(u32),
    /// What lies behind everything.
    Background,
}

/// What stands behind the groups of lights of a world in which each light is a group of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightsApart {
    /// By number: the light, and the group that it was of.
    sources: Vec<(LightSource, LightGroup)>,
}

impl LightsApart {
    /// The light behind a group, and the group that it was of.
    pub fn source(&self, group: LightGroup) -> (LightSource, LightGroup) {
        self.sources.get(usize::from(group.0)).copied().unwrap_or((LightSource::Rest, LightGroup::REST))
    }

    /// All that are told apart.
    pub fn all(&self) -> impl Iterator<Item = LightSource> {
        self.sources.iter().skip(1).map(|(source, _)| *source)
    }

    /// A group for that light, while there are numbers.
    fn add(&mut self, source: LightSource, was: LightGroup) -> LightGroup {
        let Ok(number) = u16::try_from(self.sources.len()) else { return LightGroup::REST };
        self.sources.push((source, was));
        LightGroup(number)
    }
}

impl World {
    /// The same world, each of its lights a group of its own: its pictures are the same, and of all light it is known where
    /// it comes from.
    #[must_use]
    pub fn with_lights_apart(mut self) -> (Self, LightsApart) {
        let mut apart = LightsApart { sources: vec![(LightSource::Rest, LightGroup::REST)] };
        let background = apart.add(LightSource::Background, self.background_group());
        for (number, lamp) in (0..).zip(&mut self.lamps) {
            lamp.group = apart.add(LightSource::Lamp(number), lamp.group);
        }
        let mut entries: Vec<(u32, LightGroup)> = Vec::new();
        for shape in self.emitters.glowing() {
            let entry = self.entry_of(shape);
            if entries.last().is_none_or(|(last, _)| *last != entry) {
                entries.push((entry, self.shape_group(shape)));
            }
        }
        let last = entries.last().map_or(0, |(last, _)| *last as usize + 1);
        let mut groups = vec![LightGroup::REST; last];
        for (entry, was) in entries {
            if let Some(group) = groups.get_mut(entry as usize) {
                *group = apart.add(LightSource::Entry(entry), was);
            }
        }
        let labels = Labels { groups, background, ..self.labels.clone() };
        (self.with_labels(labels), apart)
    }

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
