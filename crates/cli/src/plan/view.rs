//! What a picture is of and how it is sampled, for all that render.

use crate::args::ViewArgs;
use juggler::Settings;

impl ViewArgs {
    /// What is wished for beyond what the scene says.
    pub fn settings(&self) -> Settings {
        Settings {
            size: self.size,
            samples: self.samples,
            integrator: self.integrator.clone(),
            max_depth: self.max_depth,
            camera: self.camera.clone(),
            shutter: self.shutter,
            seed: self.seed,
            ..Settings::default()
        }
    }

    /// The frame that is looked at, for an animation of this pace.
    pub fn frame(&self, frames_per_second: f64) -> f64 {
        match (self.frame, self.at) {
            (Some(frame), _) => f64::from(frame),
            (None, Some(seconds)) => seconds * frames_per_second,
            (None, None) => 0.0,
        }
    }
}
