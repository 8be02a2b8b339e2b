//! Edits that a page may send. A page sees and edits the scene; it reads no file but the scene with
//! which the server was started. It writes none, except for bookmarks of users at this machine.

use juggler::MAX_GAIN;
use juggler::scene::built_in_scenes;
use juggler_session::wire::EditMessage;
use juggler_session::{Edit, Fly, Orbit, Setting};
use serde_json::Value;

/// Maximum edge of an image, in pixels.
pub const MAX_EDGE: u32 = 8192;
/// Maximum number of pixels of an image.
pub const MAX_PIXELS: u64 = 1 << 24;
/// Maximum number of samples per pixel.
pub const MAX_SAMPLES: u32 = 1 << 24;
/// Maximum number of threads.
pub const MAX_THREADS: usize = 256;
/// Maximum length of a name, in characters.
const MAX_NAME: usize = 100;
/// Prefixes of JSON pointers that may be set. None of these values names a file or determines a
/// size.
const EDITABLE_PATHS: [&str; 6] = ["/materials/", "/lights/", "/background", "/camera/", "/cameras/", "/tone/"];

/// Reads and checks an edit; an error is the reason of the refusal. The result of an accepted
/// message is the edit, or the error that the session reports for a name or a camera that is not
/// valid. `scene` is the file with which the server was started; `local` is true for pages on this
/// machine.
pub fn read(message: EditMessage, scene: Option<&str>, local: bool) -> Result<Result<Edit, String>, String> {
    message.kind_name().map_or(Ok(()), short)?;
    message.camera().map_or(Ok(()), check_value)?;
    match message.read() {
        Ok(edit) => check(&edit, scene, local).map(|()| Ok(edit)),
        Err(error) => Ok(Err(error)),
    }
}

fn check(edit: &Edit, scene: Option<&str>, local: bool) -> Result<(), String> {
    match edit {
        Edit::Scene(name) => check_scene(name, scene),
        Edit::Files(_) => Err("pages open dropped files by their number".into()),
        Edit::Fly(Fly { right, up, forward, yaw_degrees, pitch_degrees, roll_degrees }) => {
            finite(&[right, up, forward, yaw_degrees, pitch_degrees, roll_degrees].map(|number| f64::from(*number)))
        }
        Edit::Orbit(Orbit { yaw_degrees, pitch_degrees, closer }) => {
            finite(&[*yaw_degrees, *pitch_degrees, *closer].map(f64::from))
        }
        Edit::Zoom(factor) => finite(&[f64::from(*factor)]),
        Edit::Focus(pixel) | Edit::Pivot(pixel) | Edit::Frame(Some(pixel)) => finite(&pixel.map(f64::from)),
        Edit::At(frame) => finite(&[*frame]),
        Edit::Camera(name) => short(name),
        Edit::Bookmark(_) if !local => {
            Err("bookmarks change the scene file: only pages on this machine may save them".into())
        }
        Edit::Bookmark(name) if name.trim().is_empty() => Err("a bookmark needs a name".into()),
        Edit::Bookmark(name) => short(name),
        Edit::Set { path, value } if is_model_choice(path) => check_choice(value),
        Edit::Set { path, value } => check_path(path).and_then(|()| check_value(value)),
        Edit::Setting(setting) => check_setting(setting),
        Edit::Reload
        | Edit::Frame(None)
        | Edit::Look(_)
        | Edit::Play(_)
        | Edit::Show(_)
        | Edit::Region(_)
        | Edit::Reset => Ok(()),
    }
}

fn check_scene(name: &str, own: Option<&str>) -> Result<(), String> {
    if own == Some(name) {
        return Ok(());
    }
    // A file with the name of a built-in scene would take precedence over it.
    let built_in = built_in_scenes().iter().any(|scene| scene.name == name);
    if built_in && !std::path::Path::new(name).exists() {
        return Ok(());
    }
    Err("pages may choose built-in scenes and the scene that the server was started with".into())
}

fn check_setting(setting: &Setting) -> Result<(), String> {
    match setting {
        Setting::Size([width, height]) => {
            let edges = 1..=MAX_EDGE;
            let fits = edges.contains(width) && edges.contains(height);
            let pixels = u64::from(*width) * u64::from(*height);
            let most = format!("width and height are 1 to {MAX_EDGE} pixels, at most {MAX_PIXELS} pixels in all");
            if fits && pixels <= MAX_PIXELS { Ok(()) } else { Err(most) }
        }
        Setting::Samples(samples) if !(1..=MAX_SAMPLES).contains(samples) => {
            Err(format!("samples are 1 to {MAX_SAMPLES}"))
        }
        Setting::Threads(threads) if !(1..=MAX_THREADS).contains(threads) => {
            Err(format!("threads are 1 to {MAX_THREADS}"))
        }
        Setting::Exposure(stops) if !(-64.0..=64.0).contains(stops) => Err("an exposure is -64 to 64 stops".into()),
        Setting::Gain(name, factors) => {
            let fits = factors.iter().all(|factor| (0.0..=MAX_GAIN).contains(factor));
            short(name)
                .and_then(|()| if fits { Ok(()) } else { Err(format!("factors of light groups are 0 to {MAX_GAIN}")) })
        }
        Setting::Samples(_)
        | Setting::Threads(_)
        | Setting::Exposure(_)
        | Setting::MaxDepth(_)
        | Setting::Denoise(_)
        | Setting::Seed(_)
        | Setting::Integrator(_)
        | Setting::Sampler(_)
        | Setting::Tone(_)
        | Setting::Scheduler(_) => Ok(()),
    }
}

fn finite(numbers: &[f64]) -> Result<(), String> {
    if numbers.iter().all(|number| number.is_finite()) { Ok(()) } else { Err("a number is too large".into()) }
}

fn short(name: &str) -> Result<(), String> {
    if name.chars().count() <= MAX_NAME { Ok(()) } else { Err(format!("a name has at most {MAX_NAME} characters")) }
}

/// Whether a JSON pointer names the variant or the clip of a model, which are no files.
fn is_model_choice(path: &str) -> bool {
    let mut steps = path.rsplit('/');
    let choice = matches!(steps.next(), Some("variant" | "animation")) && steps.next() == Some("model");
    choice && path.starts_with("/objects/") && steps.all(|step| step != "file")
}

fn check_choice(value: &Value) -> Result<(), String> {
    match value {
        Value::Null => Ok(()),
        Value::String(name) => short(name),
        _ => Err("variants and clips of models are chosen by name".into()),
    }
}

fn check_path(path: &str) -> Result<(), String> {
    let file = path.split('/').any(|step| step == "file");
    if !file && EDITABLE_PATHS.iter().any(|prefix| path.starts_with(prefix)) {
        return Ok(());
    }
    Err(format!("pages may change values below {}", EDITABLE_PATHS.join(" ")))
}

/// Checks that a value names no file: numbers, colors, and arrays and objects of them.
fn check_value(value: &Value) -> Result<(), String> {
    match value {
        Value::Array(values) => values.iter().try_for_each(check_value),
        Value::Object(members) if members.contains_key("file") => Err("pages may not name files".into()),
        Value::Object(members) => members.values().try_for_each(check_value),
        Value::String(text) if !text.starts_with('#') => {
            Err("pages may set numbers and colors, no other strings".into())
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn allowed(edit: Value) -> bool {
        let message = serde_json::from_value(edit).unwrap();
        read(message, Some("mine/scene.json"), false).is_ok()
    }

    #[test]
    fn edits_cannot_read_other_files() {
        assert!(allowed(json!({"scene": "juggler"})) && allowed(json!({"scene": "mine/scene.json"})));
        for name in ["/etc/passwd", "../scenes/juggler.json", "mine/./scene.json", "juggler.json", "", "-"] {
            assert!(!allowed(json!({"scene": name})), "{name}");
        }
        let set = |path: &str, value: Value| allowed(json!({"set": {"path": path, "value": value}}));
        assert!(set("/materials/red/phong/diffuse", json!("#ff0000")) && set("/lights/0/point/intensity", json!(3)));
        assert!(set("/materials/red/phong", json!({"diffuse": [1, 0, 0]})));
        for path in ["", "/", "/include", "/render/size", "/objects/0", "/textures/a/image/file", "/materials/a/file"] {
            assert!(!set(path, json!(1)), "{path}");
        }
        for value in [json!("/etc/passwd"), json!({"image": {"file": "#a"}}), json!([["a"]])] {
            assert!(!set("/materials/red/phong/diffuse", value.clone()), "{value}");
        }
        assert!(set("/objects/0/model/variant", json!("red")) && set("/objects/0/model/variant", json!(null)));
        assert!(set("/objects/3/objects/1/model/animation", json!("Run")));
        for path in
            ["/objects/0/model", "/objects/0/model/file", "/objects/0/shape/mesh/file", "/include/model/variant"]
        {
            assert!(!set(path, json!("a")), "{path}");
        }
        assert!(!set("/objects/0/model/variant", json!({"file": "a"})) && !set("/objects/0/model/variant", json!(1)));
        assert!(allowed(json!({"look": {"perspective": {"eye": [0, 1, 2]}}})));
    }

    #[test]
    fn bookmarks_are_accepted_only_from_local_pages() {
        let bookmark = |name: &str, local| check(&Edit::Bookmark(name.into()), None, local).is_ok();
        assert!(bookmark("a", true) && !bookmark("a", false) && !bookmark(" ", true));
        assert!(!bookmark(&"a".repeat(101), true));
    }

    #[test]
    fn edits_beyond_limits_of_size_and_range_are_rejected() {
        let size = |width: u32, height: u32| allowed(json!({"setting": {"size": [width, height]}}));
        assert!(size(4096, 4096) && size(8192, 2048) && size(1, 1));
        assert!(!size(0, 5) && !size(8192, 8192) && !size(u32::MAX, u32::MAX) && !size(8193, 1));
        assert!(!allowed(json!({"setting": {"threads": 100_000}})) && !allowed(json!({"setting": {"samples": 0}})));
        assert!(!allowed(json!({"zoom": 1e39})) && !allowed(json!({"fly": {"up": -1e300}})));
        assert!(!allowed(json!({"setting": {"exposure": 1e30}})));
        let gain = |factor: f64| allowed(json!({"setting": {"gain": ["key", [factor, 1, 1]]}}));
        assert!(gain(0.0) && gain(3.5) && !gain(-0.1) && !gain(1e7));
    }
}
