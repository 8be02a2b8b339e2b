//! What a scene is while the shutter is open: its description at even times from opening to closing.

use crate::animate;
use crate::description::Description;
use crate::document::Document;
use crate::report::Finding;
use crate::scene::described;
use std::sync::{Arc, Mutex, PoisonError};

/// Moments that are looked at. What moves goes straight between them, and round where it turns.
pub const MOMENTS: usize = 17;

/// The moments of a scene at a frame, worked out once for each shutter.
#[derive(Debug, Default)]
pub struct Moments {
    known: Mutex<Option<Known>>,
}

#[derive(Debug)]
struct Known {
    shutter: [f64; 2],
    moments: Arc<Vec<Description>>,
    findings: Vec<Finding>,
}

impl Moments {
    /// The descriptions at all moments, and what is wrong with them. None when the shutter is not open, and for a
    /// scene that is the same at every time.
    pub fn of(&self, document: &Document, frame: f64, shutter: [f64; 2]) -> (Arc<Vec<Description>>, Vec<Finding>) {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.as_ref().filter(|known| known.shutter == shutter) {
            return (Arc::clone(&known.moments), known.findings.clone());
        }
        let (moments, findings) = look(document, frame, shutter);
        let moments = Arc::new(moments);
        *known = Some(Known { shutter, moments: Arc::clone(&moments), findings: findings.clone() });
        (moments, findings)
    }
}

fn look(document: &Document, frame: f64, [open, close]: [f64; 2]) -> (Vec<Description>, Vec<Finding>) {
    let is_open = open < close && open.is_finite() && close.is_finite();
    if !is_open || !animate::depends_on_time(&document.tree) {
        return Default::default();
    }
    let mut moments = Vec::with_capacity(MOMENTS);
    for moment in 0..MOMENTS {
        let share = moment as f64 / (MOMENTS - 1) as f64;
        let (tree, mut findings) =
            animate::resolve(&document.tree, &document.sources, frame + open + (close - open) * share);
        let description = described(&tree, &mut findings);
        match description.filter(|_| findings.iter().all(|finding| !finding.is_error())) {
            Some(description) => moments.push(description),
            // What is wrong at one moment is likely to be so at the next: once is enough.
            None => return (Vec::new(), findings),
        }
    }
    (moments, Vec::new())
}
