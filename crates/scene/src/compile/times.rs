//! Objects while the shutter is open.

use crate::description::Object;
use crate::item::Item;
use crate::motion::{ListTracks, ObjectTrack};

/// Objects of a list at even times while the shutter is open.
pub enum Times<'t> {
    /// Moving objects only.
    Tracks(&'t ListTracks),
    /// The whole list at each time.
    Lists(Vec<&'t [Item<Object>]>),
    /// Static objects.
    Still,
}

impl<'t> Times<'t> {
    /// Checks the times for a list of `count` objects: if the length of the list changes, all
    /// objects are static.
    pub fn fitting(self, count: usize) -> Self {
        match self {
            Self::Lists(lists) if lists.iter().any(|list| list.len() != count) => Self::Still,
            times => times,
        }
    }

    /// An object at each time if it moves as a whole, and the times of its child objects.
    pub fn object(&self, i: usize) -> (Vec<&'t Object>, Times<'t>) {
        match self {
            Self::Tracks(tracks) => match tracks.get(&i) {
                Some(ObjectTrack::Whole(keys)) => (keys.iter().map(|key| &**key).collect(), Times::Still),
                Some(ObjectTrack::Inner(inner)) => (Vec::new(), Times::Tracks(inner)),
                None => (Vec::new(), Times::Still),
            },
            Self::Lists(lists) => (lists.iter().filter_map(|list| list.get(i).map(|o| &**o)).collect(), Times::Still),
            Self::Still => (Vec::new(), Times::Still),
        }
    }
}
