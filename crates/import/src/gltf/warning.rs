//! Warnings: content that is ignored, approximated or repaired. They are collected, never printed.

use super::error::{Fault, Place};
use std::collections::BTreeMap;
use std::fmt;

/// Maximum number of different warnings of a file.
const MAX_WARNINGS: usize = 200;

/// Content of a file that is ignored, approximated or repaired.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// First place that the warning is about, and its text.
    pub fault: Fault,
    /// Number of items, such as vertices or objects, that the warning is about.
    pub count: u64,
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            1 => write!(formatter, "{}", self.fault),
            count => write!(formatter, "{} ({count} of them)", self.fault),
        }
    }
}

/// Warnings in the order of their discovery, one for each text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Warnings {
    list: Vec<Warning>,
    /// Position of each text in the list.
    by_text: BTreeMap<String, usize>,
    omitted: u64,
}

impl Warnings {
    /// Adds `count` items at a JSON pointer. The warning of the same text counts them if there is
    /// one; its place stays.
    pub fn add(&mut self, pointer: impl fmt::Display, text: impl fmt::Display, count: u64) {
        self.push(Warning { fault: Fault::at(pointer, text), count });
    }

    /// Adds a warning at a place.
    pub fn add_at(&mut self, place: Place, text: impl fmt::Display) {
        self.push(Warning { fault: Fault::new(place, text), count: 1 });
    }

    /// Adds all warnings of `other`, in their order.
    pub fn append(&mut self, other: Self) {
        other.list.into_iter().for_each(|warning| self.push(warning));
        self.omitted = self.omitted.saturating_add(other.omitted);
    }

    /// The warnings.
    pub fn list(&self) -> &[Warning] {
        &self.list
    }

    /// Texts of the warnings; the last text counts the warnings that are not kept.
    pub fn texts(&self) -> Vec<String> {
        let further = (self.omitted > 0).then(|| format!("{} further warnings", self.omitted));
        self.list.iter().map(ToString::to_string).chain(further).collect()
    }

    /// Number of further warnings, whose texts are not kept.
    pub fn omitted(&self) -> u64 {
        self.omitted
    }

    fn push(&mut self, warning: Warning) {
        if warning.count == 0 {
            return;
        }
        let known = self.by_text.get(&warning.fault.message).and_then(|position| self.list.get_mut(*position));
        if let Some(known) = known {
            known.count = known.count.saturating_add(warning.count);
        } else if self.list.len() < MAX_WARNINGS {
            self.by_text.insert(warning.fault.message.clone(), self.list.len());
            self.list.push(warning);
        } else {
            self.omitted = self.omitted.saturating_add(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_texts_are_counted() {
        let mut warnings = Warnings::default();
        warnings.add("/meshes/0", "has degenerate triangles", 3);
        warnings.add("/meshes/1", "has another fault", 1);
        warnings.add("/meshes/2", "has degenerate triangles", 2);
        warnings.add("/meshes/3", "has nothing", 0);
        let mut all = Warnings::default();
        all.append(warnings);
        let texts: Vec<String> = all.list().iter().map(Warning::to_string).collect();
        assert_eq!(texts, ["/meshes/0: has degenerate triangles (5 of them)", "/meshes/1: has another fault"]);
        (0..300).for_each(|number| all.add("", number, 1));
        assert_eq!((all.list().len(), all.omitted()), (MAX_WARNINGS, 102));
    }
}
