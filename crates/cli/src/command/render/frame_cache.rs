//! State that frames share: threads, and the world if only the camera moves. Mesh files are loaded
//! once in any case, since all frames of a scene share its mesh library.

use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::plan::Plan;
use juggler::scene::Scene;
use juggler::{BuildControl, Error, Picture};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads and world of the previous frame.
#[derive(Default)]
pub struct FrameCache {
    pool: Option<ThreadPool>,
    last: Option<(Scene, Picture)>,
}

impl FrameCache {
    /// Creates a pool of this many threads, unless the current one fits.
    pub fn set_threads(&mut self, threads: usize) -> Result<(), Failure> {
        if self.pool.as_ref().is_none_or(|pool| pool.current_num_threads() != threads) {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            self.pool = Some(pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?);
        }
        Ok(())
    }

    /// Runs `work` in the thread pool.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Picture of a frame. It shares the world of the previous frame if no object moved; otherwise
    /// the old world is dropped before the new one is built, so that memory never holds both.
    /// `interrupts` end the build; until signals are caught, they end the program.
    pub fn picture(&mut self, plan: &Plan, scene: &Scene, interrupts: Option<&Interrupts>) -> Result<Picture, Failure> {
        // Apply the shutter first, since it decides what moves.
        let scene = plan.settings.apply(scene)?;
        let last = self.last.take().filter(|(last, _)| scene.has_world_of(last));
        let build = |control: &BuildControl| match &last {
            Some((last, picture)) => picture.rebuild_with_control(last, &scene, &plan.settings, control),
            None => Picture::new_with_control(&scene, &plan.settings, control),
        };
        let picture = match interrupts {
            Some(interrupts) => interrupts.cancelling(|control| self.install(|| build(control))),
            None => self.install(|| build(&BuildControl::default())),
        };
        let caught = || interrupts.and_then(Interrupts::caught);
        picture.map_err(|error: Error| match error {
            Error::Cancelled(_) => caught().unwrap_or_else(|| error.into()),
            error => error.into(),
        })
    }

    /// Keeps the world of a frame for the next one.
    pub fn keep(&mut self, plan: &Plan, scene: &Scene, picture: Picture) -> Result<(), Failure> {
        self.last = Some((plan.settings.apply(scene)?, picture));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::RenderArgs;
    use std::sync::Arc;

    /// Whether the second frame of a scene shares the world of the first.
    fn stays(eye: &str, ball: &str, flags: &str) -> bool {
        let text = format!(
            r#"{{"version": 1, "camera": {{"perspective": {{"eye": [{eye}, 1, 6]}}}},
                "objects": [{{"shape": "sphere", "transform": [{{"translate": [{ball}, 0, 0]}}]}}]}}"#
        );
        let plan = Plan::new(RenderArgs::from_words(flags.split(' ')).unwrap()).unwrap();
        let first = Scene::from_json(text, "a.json").unwrap();
        let second = first.at_frame(1.0).unwrap();
        let mut frame_cache = FrameCache::default();
        frame_cache.set_threads(1).unwrap();
        let picture = frame_cache.picture(&plan, &first, None).unwrap();
        let world = Arc::clone(picture.world());
        frame_cache.keep(&plan, &first, picture).unwrap();
        let again = frame_cache.picture(&plan, &second, None).unwrap();
        assert_eq!(again.fingerprint(), Picture::new(&second, &plan.settings).unwrap().fingerprint());
        Arc::ptr_eq(&world, again.world())
    }

    #[test]
    fn a_world_stays_while_only_the_camera_moves() {
        assert!(stays("\"=frame\"", "0", "a"));
        assert!(!stays("0", "\"=frame\"", "a"));
        // The position is 0 at both frames, but not in between.
        let swings = "\"=(frame - 1) * frame * frame\"";
        assert!(stays("0", swings, "a") && !stays("0", swings, "a --shutter 0..0.5"));
    }
}
