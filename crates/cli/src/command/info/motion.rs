//! Length of an animation and a list of its moving values, for `juggler info`.

use crate::format::counted;
use juggler::scene::animate::{FormSummary, Survey};
use juggler::scene::description::Animation;
use serde_json::{Value, json};

/// Maximum number of listed value forms.
const MAX_LISTED: usize = 20;

/// Rows of the text output: key and value.
pub fn rows(animation: &Animation, survey: &Survey) -> Vec<(&'static str, String)> {
    let mut rows = vec![("animation", length(animation))];
    let Survey { forms, expressions } = survey;
    if *expressions > 0 {
        rows.push(("expressions", format!("{expressions} depend on time")));
    }
    if !forms.is_empty() {
        rows.push(("tracks", forms.len().to_string()));
        rows.extend(forms.iter().take(MAX_LISTED).map(|track| ("", format!("{}: {}", track.path, track_text(track)))));
        let more = forms.len().saturating_sub(MAX_LISTED);
        rows.extend((more > 0).then(|| ("", format!("... and {more} more"))));
    }
    rows
}

/// JSON output.
pub fn json(animation: &Animation, survey: &Survey) -> Value {
    let tracks: Vec<Value> = survey.forms.iter().take(MAX_LISTED).map(as_json).collect();
    json!({
        "frames": animation.frames,
        "frames_per_second": animation.frames_per_second,
        "seconds": seconds(animation),
        "expressions": survey.expressions,
        "tracks": survey.forms.len(),
        "listed": tracks,
    })
}

fn seconds(animation: &Animation) -> f64 {
    f64::from(animation.frames) / animation.frames_per_second
}

/// `30 frames, 1.25 s, 24 frames a second`.
fn length(animation: &Animation) -> String {
    if animation.frames <= 1 {
        return "none".into();
    }
    let frames = counted(animation.frames.into(), "frame");
    format!("{frames}, {} s, {} frames a second", rounded(seconds(animation)), rounded(animation.frames_per_second))
}

/// `animate, 4 keys, 0 to 2.5 s, smooth, loop`.
fn track_text(track: &FormSummary) -> String {
    let mut parts = vec![track.kind.clone()];
    parts.extend(track.along.clone().or_else(|| track.node.clone()));
    parts.extend(track.keys.map(|keys| counted(keys as u128, "key")));
    parts.extend(track.time_range.map(|[first, last]| format!("{} to {} s", rounded(first), rounded(last))));
    parts.extend(track.interpolation.map(|interpolation| word(&interpolation)));
    parts.extend(track.repeat.map(|repeat| word(&repeat)));
    parts.join(", ")
}

fn as_json(track: &FormSummary) -> Value {
    let mut json = json!({
        "path": track.path.to_string(),
        "kind": track.kind,
        "along": track.along,
        "node": track.node,
        "keys": track.keys,
        "span": track.time_range,
        "interpolation": track.interpolation,
        "repeat": track.repeat,
    });
    if let Some(members) = json.as_object_mut() {
        members.retain(|_, value| !value.is_null());
    }
    json
}

/// Name of a variant as in the scene file.
fn word(choice: &impl serde::Serialize) -> String {
    serde_json::to_value(choice).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default()
}

fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler::scene::Scene;

    fn survey(count: usize) -> Survey {
        let object =
            r#"{"shape": {"sphere": {"radius": {"animate": {"keys": [[0.5, 1], [2, 3]], "repeat": "ping_pong"}}}}}"#;
        let objects = vec![object; count].join(",");
        let text = format!(r#"{{"version": 1, "variables": {{"a": "seconds"}}, "objects": [{objects}]}}"#);
        Scene::from_json(text, "a.json").unwrap().survey()
    }

    #[test]
    fn info_names_the_length_of_a_movie_and_what_moves() {
        let animation = Animation { frames: 36, frames_per_second: 24.0 };
        let rows = rows(&animation, &survey(1));
        assert_eq!(rows[0], ("animation", "36 frames, 1.5 s, 24 frames a second".into()));
        assert_eq!(rows[1], ("expressions", "1 depend on time".into()));
        assert_eq!(rows[3].1, "objects[0].shape.sphere.radius: animate, 2 keys, 0.5 to 2 s, linear, ping_pong");
        let json = json(&animation, &survey(1));
        assert_eq!((&json["seconds"], &json["listed"][0]["span"]), (&1.5.into(), &json!([0.5, 2.0])));
        assert_eq!(json["listed"][0]["repeat"], "ping_pong");
    }

    #[test]
    fn long_lists_are_truncated_and_stills_have_one_row() {
        let many = rows(&Animation::default(), &survey(25));
        assert_eq!((many.len(), many.last().unwrap().1.as_str()), (24, "... and 5 more"));
        assert_eq!(rows(&Animation::default(), &Survey::default()), [("animation", "none".into())]);
    }
}
