//! Scene entries of shapes, and light groups of emitters.

use super::{EmitterId, World};
use juggler_camera::aov::LightGroup;

/// Scene entries of shapes, and light groups of emitters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// Index of the first shape of each scene entry, ascending; an entry may be empty.
    pub entries: Vec<u32>,
    /// Light group of each scene entry; empty if no entry has one.
    pub groups: Vec<LightGroup>,
    /// Light group of the background.
    pub background: LightGroup,
}

/// A source of light in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightSource {
    /// Ambient light, or a source beyond the number of available groups.
    Other,
    /// A light of the scene, by index in [`World::lights`].
    Light(u32),
    /// An emissive scene entry, by index.
    Entry(u32),
    /// The background.
    Background,
}

/// Light sources of a world in which each source is a light group of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SeparateLights {
    /// Source and original group of each light group, by number.
    sources: Vec<(LightSource, LightGroup)>,
}

impl SeparateLights {
    /// Source of a light group, and the source's original group.
    pub fn source(&self, group: LightGroup) -> (LightSource, LightGroup) {
        self.sources.get(usize::from(group.0)).copied().unwrap_or((LightSource::Other, LightGroup::REST))
    }

    /// All sources that have a group of their own.
    pub fn sources(&self) -> impl Iterator<Item = LightSource> {
        self.sources.iter().skip(1).map(|(source, _)| *source)
    }

    /// Assigns a group to a source; [`LightGroup::REST`] if all numbers are taken.
    fn assign_group(&mut self, source: LightSource, original: LightGroup) -> LightGroup {
        let Ok(number) = u16::try_from(self.sources.len()) else { return LightGroup::REST };
        self.sources.push((source, original));
        LightGroup(number)
    }
}

impl World {
    /// Makes each light source a light group of its own, which identifies the origin of all light.
    /// Pictures stay the same.
    #[must_use]
    pub fn with_separate_lights(mut self) -> (Self, SeparateLights) {
        let mut separate = SeparateLights { sources: vec![(LightSource::Other, LightGroup::REST)] };
        let background = separate.assign_group(LightSource::Background, self.background_group());
        for (index, light) in (0..).zip(&mut self.lights) {
            light.group = separate.assign_group(LightSource::Light(index), light.group);
        }
        let mut entries: Vec<(u32, LightGroup)> = Vec::new();
        for shape in self.emitters.emissive_shapes() {
            let entry = self.entry_of(shape);
            if entries.last().is_none_or(|(last, _)| *last != entry) {
                entries.push((entry, self.shape_group(shape)));
            }
        }
        let last = entries.last().map_or(0, |(last, _)| *last as usize + 1);
        let mut groups = vec![LightGroup::REST; last];
        for (entry, original) in entries {
            if let Some(group) = groups.get_mut(entry as usize) {
                *group = separate.assign_group(LightSource::Entry(entry), original);
            }
        }
        let labels = Labels { groups, background, ..self.labels.clone() };
        (self.with_labels(labels), separate)
    }

    /// Sets the labels.
    #[must_use]
    pub fn with_labels(mut self, labels: Labels) -> Self {
        self.has_groups = !labels.groups.is_empty()
            || labels.background != LightGroup::REST
            || self.lights.iter().any(|light| light.group != LightGroup::REST);
        self.labels = labels;
        self
    }

    /// Index of the scene entry that a shape belongs to.
    pub fn entry_of(&self, shape: u32) -> u32 {
        (self.labels.entries.partition_point(|first| *first <= shape) as u32).saturating_sub(1)
    }

    /// Light group of a shape's emission.
    #[inline]
    pub fn shape_group(&self, shape: u32) -> LightGroup {
        if self.labels.groups.is_empty() {
            return LightGroup::REST;
        }
        self.labels.groups.get(self.entry_of(shape) as usize).copied().unwrap_or_default()
    }

    /// Light group of the background.
    pub fn background_group(&self) -> LightGroup {
        self.labels.background
    }

    /// Light group of a light sample.
    #[inline]
    pub fn light_group(&self, emitter: EmitterId) -> LightGroup {
        if !self.has_groups {
            return LightGroup::REST;
        }
        match emitter {
            EmitterId::Light(index) => self.lights.get(index as usize).map_or(LightGroup::REST, |light| light.group),
            EmitterId::Shape(shape) => self.shape_group(shape),
            EmitterId::Background => self.background_group(),
        }
    }
}
