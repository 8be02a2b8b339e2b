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

/// Warns of a frame beyond the end of an animation, which is rendered all the same. A scene of one
/// frame does not say how long it goes on.
pub fn beyond_the_end(frame: u32, frames: u32) -> Option<String> {
    (frames > 1 && frame >= frames).then(|| {
        let last = frames - 1;
        format!("warning: frame {frame} is beyond the end of the animation, which has {frames} frames, 0 to {last}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_there_are_are_told() {
        assert_eq!((beyond_the_end(29, 30), beyond_the_end(7, 1)), (None, None));
        assert!(beyond_the_end(40, 30).is_some_and(|message| message.contains("30 frames, 0 to 29")));
    }
}
