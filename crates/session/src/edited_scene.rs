//! Scene with its edits, as values: an edit makes the next scene from the one before.

use juggler::scene::{Scene, SceneError};
use serde_json::Value;
use std::collections::BTreeSet;
use std::sync::Arc;

/// JSON pointer of the clip of the model in a scene around a model file.
const SHOWN_CLIP: &str = "/objects/0/model/animation";

/// Number of edits above which the list drops edits whose value a later edit replaced.
const MAX_EDITS: usize = 1000;

/// Opened scene, the same scene with edited values, and its displayed frame. A copy shares all
/// scenes.
#[derive(Clone)]
pub struct EditedScene {
    /// Scene as its file describes it, at frame 0.
    file: Arc<Scene>,
    /// Scene with the edited values, at frame 0.
    edited: Arc<Scene>,
    /// Scene with the edited values, at the displayed frame.
    displayed: Arc<Scene>,
    /// Displayed frame.
    frame: f64,
    /// Values that the scene was opened with, which a reset keeps.
    given: Arc<[(String, Value)]>,
    /// Edited values by JSON pointer in the order of the edits, beginning with the given ones; a
    /// reload repeats them.
    edits: Vec<(String, Value)>,
}

impl EditedScene {
    /// Opens a scene with given values, at frame 0.
    pub fn new(file: Arc<Scene>, given: Arc<[(String, Value)]>) -> Result<Self, SceneError> {
        let edited = with_values(&file, &given)?;
        let (displayed, edits) = (Arc::clone(&edited), given.to_vec());
        Ok(Self { file, edited, displayed, frame: 0.0, given, edits })
    }

    /// The scene as its file describes it, at frame 0.
    pub fn file(&self) -> &Arc<Scene> {
        &self.file
    }

    /// The scene with the edited values, at the displayed frame.
    pub fn displayed(&self) -> &Arc<Scene> {
        &self.displayed
    }

    /// The displayed frame.
    pub fn frame(&self) -> f64 {
        self.frame
    }

    /// The scene with another value; `null` removes the old one. Another clip begins at frame 0.
    pub fn with_value(&self, path: &str, value: &Value) -> Result<Self, SceneError> {
        let mut edits = self.edits.clone();
        record(&mut edits, path, value);
        let edited = fitted(Arc::new(self.edited.with_value(path, value.clone())?), &edits);
        let frame = if path == SHOWN_CLIP { 0.0 } else { self.frame };
        Self { edited, edits, ..self.clone() }.at_frame(frame)
    }

    /// The scene at another frame.
    pub fn at_frame(&self, frame: f64) -> Result<Self, SceneError> {
        let edited = &self.edited;
        let displayed = if frame == 0.0 { Arc::clone(edited) } else { Arc::new(edited.at_frame(frame)?) };
        Ok(Self { displayed, frame, ..self.clone() })
    }

    /// The scene as it was opened.
    pub fn reset(&self) -> Result<Self, SceneError> {
        Self::new(Arc::clone(&self.file), Arc::clone(&self.given))
    }

    /// The scene of another version of its file, at the same frame. Edited values are kept unless
    /// the file changed there too.
    pub fn with_file(&self, file: Arc<Scene>) -> Result<Self, SceneError> {
        let mut edits = self.edits.clone();
        if !edits.is_empty() {
            let [before, after] = [&self.file, &file].map(|scene| scene.to_value());
            edits.retain(|(path, _)| before.pointer(path) == after.pointer(path));
        }
        Self { edited: with_values(&file, &edits)?, file, edits, ..self.clone() }.at_frame(self.frame)
    }
}

/// Appends an edit to the edits that a reload repeats. It replaces the edit before it if both set
/// the same value; removals stay, since each removes another element of an array.
fn record(edits: &mut Vec<(String, Value)>, path: &str, value: &Value) {
    match edits.last_mut() {
        Some((last, old)) if last == path && !old.is_null() && !value.is_null() => *old = value.clone(),
        _ => edits.push((path.to_owned(), value.clone())),
    }
    if edits.len() > MAX_EDITS {
        forget_replaced(edits);
    }
}

/// Keeps removals and the last edit of each value.
fn forget_replaced(edits: &mut Vec<(String, Value)>) {
    let mut later = BTreeSet::new();
    let is_kept: Vec<bool> =
        edits.iter().rev().map(|(path, value)| value.is_null() || later.insert(path.clone())).collect();
    let mut is_kept = is_kept.into_iter().rev();
    edits.retain(|_| is_kept.next().unwrap_or(true));
}

/// The scene with these values, set in turn.
fn with_values(scene: &Arc<Scene>, values: &[(String, Value)]) -> Result<Arc<Scene>, SceneError> {
    let mut scene = Arc::clone(scene);
    for (path, value) in values {
        scene = Arc::new(scene.with_value(path, value.clone())?);
    }
    Ok(fitted(scene, values))
}

/// The scene with an animation as long as the clip of its model, if an edit chose the clip of a
/// scene around a model file.
fn fitted(mut scene: Arc<Scene>, edits: &[(String, Value)]) -> Arc<Scene> {
    if scene.is_around_model() && edits.iter().any(|(path, _)| path == SHOWN_CLIP) {
        Arc::make_mut(&mut scene).fit_animation();
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const TWO: &str = r#"{"version": 1, "animation": {"frames": 10}, "lights": [{"ambient": {}}, {"directional": {}}],
        "materials": {"red": {"phong": {"diffuse": [1, 0, 0]}}},
        "objects": [{"shape": {"sphere": {"radius": "=1 + frame/10"}}, "material": "red"}]}"#;

    fn scene(text: &str) -> Arc<Scene> {
        Arc::new(Scene::from_json(text, "scene.json").unwrap())
    }

    fn opened(given: &[(String, Value)]) -> EditedScene {
        EditedScene::new(scene(TWO), given.into()).unwrap()
    }

    fn set(scene: &EditedScene, path: &str, value: &Value) -> EditedScene {
        scene.with_value(path, value).unwrap()
    }

    fn at(scene: &EditedScene, pointer: &str) -> Value {
        scene.displayed().to_value().pointer(pointer).cloned().unwrap_or_default()
    }

    #[test]
    fn each_removal_removes_an_element() {
        let first = set(&opened(&[]), "/lights/0", &Value::Null);
        assert!(at(&first, "/lights/0/directional").is_object());
        let second = set(&first, "/lights/0", &Value::Null);
        assert!(at(&second, "/lights/0").is_null() && at(&first, "/lights/0").is_object());
        let reloaded = second.with_file(scene(&TWO.replace("[1, 0, 0]", "[0, 1, 0]"))).unwrap();
        assert!(at(&reloaded, "/lights/0").is_null());
        assert_eq!(at(&reloaded, "/materials/red/phong/diffuse"), json!([0, 1, 0]));
    }

    #[test]
    fn values_may_use_names_of_earlier_edits_and_replace_them() {
        let blue = set(&opened(&[]), "/materials/blue", &json!({"diffuse": {}}));
        let used = set(&blue, "/objects/0/material", &json!("blue"));
        let other = set(&used, "/materials/blue", &json!({"phong": {}}));
        let reloaded = other.with_file(scene(TWO)).unwrap();
        for scene in [&other, &reloaded] {
            assert_eq!(
                (at(scene, "/objects/0/material"), at(scene, "/materials/blue/phong").is_object()),
                (json!("blue"), true)
            );
        }
    }

    #[test]
    fn a_reload_keeps_edits_unless_the_file_changed_there() {
        let edited = set(&opened(&[]), "/materials/red/phong/diffuse", &json!([0, 0, 1]));
        let edited = set(&edited, "/objects/0/shape/sphere/radius", &json!("=2 + frame")).at_frame(3.0).unwrap();
        let same = edited.with_file(scene(&TWO.replace("\"ambient\": {}", "\"ambient\": {\"intensity\": 2}"))).unwrap();
        assert_eq!(same.frame(), 3.0);
        assert_eq!(at(&same, "/materials/red/phong/diffuse"), json!([0, 0, 1]));
        assert_eq!(at(&same, "/objects/0/shape/sphere/radius"), json!("=2 + frame"));
        let other = edited.with_file(scene(&TWO.replace("[1, 0, 0]", "[0, 1, 0]"))).unwrap();
        assert_eq!(at(&other, "/materials/red/phong/diffuse"), json!([0, 1, 0]));
        assert_eq!(at(&other, "/objects/0/shape/sphere/radius"), json!("=2 + frame"));
    }

    #[test]
    fn a_reset_keeps_given_values() {
        let given = [("/materials/red/phong/diffuse".to_owned(), json!([0, 0, 1]))];
        let edited = set(&opened(&given), "/materials/red/phong/diffuse", &json!([1, 1, 1]));
        let reset = set(&edited, "/lights", &Value::Null).at_frame(2.0).unwrap().reset().unwrap();
        assert_eq!((reset.frame(), at(&reset, "/materials/red/phong/diffuse")), (0.0, json!([0, 0, 1])));
        assert!(at(&reset, "/lights/1").is_object());
    }

    #[test]
    fn edits_that_follow_each_other_use_no_memory() {
        let mut edits = Vec::new();
        for i in 0..10_000 {
            record(&mut edits, "/tone/exposure_stops", &json!(i));
        }
        assert_eq!(edits, [("/tone/exposure_stops".to_owned(), json!(9999))]);
        for i in 0..10_000 {
            record(&mut edits, if i % 2 == 0 { "/a" } else { "/b" }, &json!(i));
            assert!(edits.len() <= MAX_EDITS);
        }
        forget_replaced(&mut edits);
        let expected = [("/tone/exposure_stops", 9999), ("/a", 9998), ("/b", 9999)];
        assert_eq!(edits, expected.map(|(path, value)| (path.to_owned(), json!(value))));
    }
}
