//! Count of the values that a writer clamps to the range of half floats.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Largest finite half float.
pub const LARGEST_HALF: f32 = 65_504.0;

/// Number of clamped values; clones share the count.
#[derive(Clone, Debug, Default)]
pub struct ClampCount(Arc<AtomicU64>);

/// The count belongs to a run of the writer, not to the image, so all counts are equal.
impl PartialEq for ClampCount {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl ClampCount {
    /// Number of values clamped so far.
    pub fn count(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(crate) fn add(&self, values: u64) {
        self.0.fetch_add(values, Ordering::Relaxed);
    }

    /// Warning about the clamped values of `file`; `None` if there are none.
    pub fn warning(&self, file: &str) -> Option<String> {
        let values = match self.count() {
            0 => return None,
            1 => "1 value is".to_owned(),
            count => format!("{count} values are"),
        };
        Some(format!(
            "warning: `{file}`: {values} beyond the range of 16-bit floats and clamped to ±65504; --bits 32 keeps them"
        ))
    }
}
