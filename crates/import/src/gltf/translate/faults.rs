//! Faults that a translation collects, so that all are reported at once.

use crate::gltf::error::{Fault, GltfError};

/// Faults in the order of their discovery, each once, up to a limit.
#[derive(Clone, Debug)]
pub struct Faults {
    list: Vec<Fault>,
    omitted: usize,
    limit: usize,
}

impl Faults {
    /// No faults; at most `limit` are kept.
    pub fn new(limit: usize) -> Self {
        Self { list: Vec::new(), omitted: 0, limit: limit.max(1) }
    }

    /// Adds a fault, unless it is known.
    pub fn add(&mut self, fault: Fault) {
        if self.list.contains(&fault) {
            return;
        }
        if self.list.len() < self.limit {
            self.list.push(fault);
        } else {
            self.omitted = self.omitted.saturating_add(1);
        }
    }

    /// The value of a result; the fault is added.
    pub fn take<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.add(fault)).ok()
    }

    /// Whether there are no faults.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Error of all faults.
    pub fn into_error(self, file: &str) -> GltfError {
        GltfError { file: file.to_owned(), faults: self.list, omitted: self.omitted }
    }
}
