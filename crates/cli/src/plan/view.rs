//! View and sampling of a picture, for all commands that render.

use crate::args::{RenderArgs, ViewArgs};
use crate::output::{STANDARD_OUTPUT, pattern};
use juggler::{Error, Settings, by_name};

impl ViewArgs {
    /// Overrides of the scene's settings.
    ///
    /// # Errors
    ///
    /// Fails for an unknown integrator.
    pub fn settings(&self) -> Result<Settings, Error> {
        Ok(Settings {
            size: self.size,
            samples: self.samples,
            integrator: self.integrator.as_deref().map(|name| by_name("integrator", name)).transpose()?,
            max_depth: self.max_depth,
            camera: self.camera.clone(),
            shutter: self.shutter,
            seed: self.seed,
            ..Settings::default()
        })
    }

    /// Frame number of the view; fractional for times between frames.
    pub fn frame(&self, frames_per_second: f64) -> f64 {
        match (self.frame, self.at) {
            (Some(frame), _) => f64::from(frame),
            (None, Some(seconds)) => seconds * frames_per_second,
            (None, None) => 0.0,
        }
    }
}

/// Warning for a frame beyond the end of an animation, which is rendered nevertheless. Scenes of
/// one frame have no end.
pub fn end_warning(frame: u32, frames: u32) -> Option<String> {
    (frames > 1 && frame >= frames).then(|| {
        let last = frames - 1;
        format!("warning: frame {frame} is beyond the end of the animation, which has {frames} frames, 0 to {last}")
    })
}

/// Note for a command that turns a model and writes one picture, of which no frame is chosen.
pub fn turn_note(args: &RenderArgs, output: &str, is_one_picture: bool) -> Option<String> {
    let is_unchosen = is_one_picture && args.turns_in_all_frames();
    let frames = args.model.stage.turntable.filter(|frames| *frames > 1 && is_unchosen)?;
    let pattern = if output == STANDARD_OUTPUT { "turn_####.png".to_owned() } else { pattern(output) };
    Some(format!(
        "note: --turntable {frames} has {frames} frames, and this picture is frame 0: -o '{pattern}' writes all of \
         them, and --frame N selects another"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_state_the_range_of_frames() {
        assert_eq!((end_warning(29, 30), end_warning(7, 1)), (None, None));
        assert!(end_warning(40, 30).is_some_and(|message| message.contains("30 frames, 0 to 29")));
    }
}
