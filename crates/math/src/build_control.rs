//! Progress and cancellation of builds: of everything from a scene's text to the hierarchies of its
//! world.
//!
//! Long loops look at the control between files, meshes, images and subtrees of a few thousand
//! primitives. Cancellation is final: the flag is never reset. So whoever starts a build and finds
//! the control not cancelled at its end has a complete result, even if inner steps return incomplete
//! results after cancellation.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering::Relaxed};

/// The work was cancelled before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the render was interrupted")
    }
}

impl std::error::Error for Cancelled {}

/// Stage of a build.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum BuildStage {
    /// Scene files and model files are read and parsed.
    #[default]
    Reading,
    /// Meshes and images are read, and the hierarchies of meshes are built.
    Preparing,
    /// The hierarchy of the world is built.
    Building,
}

impl BuildStage {
    /// All stages, in their order.
    pub const ALL: [Self; 3] = [Self::Reading, Self::Preparing, Self::Building];

    /// Name for people: `reading`, `preparing` or `building`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reading => "reading",
            Self::Preparing => "preparing",
            Self::Building => "building",
        }
    }
}

/// Progress of a build, and the request to cancel it. All methods may be called from any thread.
#[derive(Debug, Default)]
pub struct BuildControl {
    is_cancelled: AtomicBool,
    /// Index of the stage in [`BuildStage::ALL`].
    stage: AtomicU8,
    /// Amounts of work of this stage: found so far, and done.
    expected: AtomicU64,
    done: AtomicU64,
}

impl BuildControl {
    /// Creates a control that is not cancelled.
    pub const fn new() -> Self {
        let (stage, expected, done) = (AtomicU8::new(0), AtomicU64::new(0), AtomicU64::new(0));
        Self { is_cancelled: AtomicBool::new(false), stage, expected, done }
    }

    /// Requests cancellation.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Relaxed);
    }

    /// Whether cancellation was requested.
    pub fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Relaxed)
    }

    /// Fails if cancellation was requested.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Begins a stage.
    pub fn begin(&self, stage: BuildStage) {
        self.expected.store(0, Relaxed);
        self.done.store(0, Relaxed);
        self.stage.store(stage as u8, Relaxed);
    }

    /// Adds work to the current stage, in units of the stage, such as primitives of hierarchies.
    pub fn expect(&self, amount: usize) {
        self.expected.fetch_add(amount as u64, Relaxed);
    }

    /// Marks expected work as done.
    pub fn advance(&self, amount: usize) {
        self.done.fetch_add(amount as u64, Relaxed);
    }

    /// Current stage.
    pub fn stage(&self) -> BuildStage {
        BuildStage::ALL.get(usize::from(self.stage.load(Relaxed))).copied().unwrap_or_default()
    }

    /// Finished share of the work that the stage has found so far, 0 to 1. It decreases when the
    /// stage finds more work.
    pub fn share(&self) -> f64 {
        let (done, expected) = (self.done.load(Relaxed), self.expected.load(Relaxed));
        if expected == 0 { 0.0 } else { (done as f64 / expected as f64).min(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_have_shares_of_their_own() {
        let control = BuildControl::default();
        assert_eq!((control.stage(), control.share()), (BuildStage::Reading, 0.0));
        for stage in BuildStage::ALL {
            control.begin(stage);
            assert_eq!((control.stage(), control.share()), (stage, 0.0));
            control.expect(8);
            control.advance(2);
            assert_eq!(control.share(), 0.25);
            control.advance(100);
            assert_eq!(control.share(), 1.0, "no share exceeds 1");
        }
    }

    #[test]
    fn cancellation_is_final() {
        let control = BuildControl::default();
        assert_eq!(control.check(), Ok(()));
        control.cancel();
        control.begin(BuildStage::Building);
        assert_eq!(control.check(), Err(Cancelled));
    }
}
