//! What stays from one frame to the next: threads, and the world where only the camera moves. Mesh files are read and
//! their trees built once in any case: a scene's frames share its library.

use crate::failure::Failure;
use crate::plan::Plan;
use juggler::scene::Scene;
use juggler::{Error, Picture};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// What stays from one frame to the next.
#[derive(Default)]
pub struct Studio {
    pool: Option<ThreadPool>,
    last: Option<(Scene, Picture)>,
}

impl Studio {
    /// Sees to it that so many threads are there.
    pub fn gather(&mut self, threads: usize) -> Result<(), Failure> {
        if self.pool.as_ref().is_none_or(|pool| pool.current_num_threads() != threads) {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            self.pool = Some(pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?);
        }
        Ok(())
    }

    /// Does what takes all threads.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// A frame with its world, which is that of the frame before where the same things stand in the same places. The old
    /// world goes before a new one is built, so that there is never room needed for two.
    pub fn picture(&mut self, plan: &Plan, scene: &Scene) -> Result<Picture, Failure> {
        // How long the shutter is open may be wished for, and decides what moves.
        let scene = plan.settings.apply(scene)?;
        let last = self.last.take().filter(|(last, _)| scene.has_world_of(last));
        let picture = self.on_threads(|| match &last {
            Some((last, picture)) => picture.after(last, &scene, &plan.settings),
            None => Picture::new(&scene, &plan.settings),
        });
        picture.map_err(|error: Error| error.into())
    }

    /// Keeps a frame's world for the next.
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

    /// Whether the second frame of a scene has the world of the first.
    fn stays(eye: &str, ball: &str, flags: &str) -> bool {
        let text = format!(
            r#"{{"version": 1, "camera": {{"perspective": {{"eye": [{eye}, 1, 6]}}}},
                "objects": [{{"shape": "sphere", "transform": [{{"translate": [{ball}, 0, 0]}}]}}]}}"#
        );
        let plan = Plan::new(RenderArgs::of(flags.split(' ')).unwrap()).unwrap();
        let first = Scene::from_json(text, "a.json").unwrap();
        let second = first.at_frame(1.0).unwrap();
        let mut studio = Studio::default();
        studio.gather(1).unwrap();
        let picture = studio.picture(&plan, &first).unwrap();
        let world = Arc::clone(picture.world());
        studio.keep(&plan, &first, picture).unwrap();
        let again = studio.picture(&plan, &second).unwrap();
        assert_eq!(again.fingerprint(), Picture::new(&second, &plan.settings).unwrap().fingerprint());
        Arc::ptr_eq(&world, again.world())
    }

    #[test]
    fn a_world_stays_while_only_the_camera_moves() {
        assert!(stays("\"=frame\"", "0", "a"));
        assert!(!stays("0", "\"=frame\"", "a"));
        // In the same place whenever a frame begins, but not of the same speed.
        let swings = "\"=(frame - 1) * frame * frame\"";
        assert!(stays("0", swings, "a") && !stays("0", swings, "a --shutter 0..0.5"));
    }
}
