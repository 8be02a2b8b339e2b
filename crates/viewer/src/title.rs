//! Window title with the status, for people and for scripts.

use juggler_session::{Stage, Status};
use std::path::Path;

/// Formats the title: `juggler - marbles - 12/64`, with `loading`, `error` and `frame 7` where they
/// apply, and the displayed frame rate during a motion.
pub fn title(status: &Status, shown_per_second: f32) -> String {
    let mut title = format!("juggler - {}", short(&status.scene));
    let mut add = |text: String| {
        title.push_str(" - ");
        title.push_str(&text);
    };
    if status.frames > 1 {
        add(format!("frame {}", (status.frame * 100.0).round() / 100.0));
    }
    match status.stage {
        Stage::Loading => add("loading".into()),
        Stage::Moving => add(format!("moving, {shown_per_second:.0} fps")),
        Stage::Refining | Stage::Finished => add(format!("{}/{}", status.samples.floor(), status.samples_wanted)),
    }
    if status.error.is_some() {
        add("error".into());
    }
    title
}

/// Returns a scene's name without folder and extension.
pub fn short(scene: &str) -> &str {
    Path::new(scene).file_stem().and_then(|stem| stem.to_str()).unwrap_or("picture")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_short() {
        assert_eq!([short("marbles"), short("a/b.scene.json"), short("")], ["marbles", "b.scene", "picture"]);
    }

    #[test]
    fn title_states_the_progress() {
        let mut status = Status { scene: "marbles".into(), samples: 12.75, samples_wanted: 64, ..Status::default() };
        assert_eq!(title(&status, 0.0), "juggler - marbles - loading");
        status.stage = Stage::Refining;
        assert_eq!(title(&status, 0.0), "juggler - marbles - 12/64");
        (status.frames, status.frame, status.stage) = (48, 7.5, Stage::Moving);
        assert_eq!(title(&status, 51.6), "juggler - marbles - frame 7.5 - moving, 52 fps");
        status.error = Some("no".into());
        assert!(title(&status, 0.0).ends_with(" - error"));
    }
}
