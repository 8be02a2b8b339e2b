//! Juggler in the browser alone: compiled for WebAssembly, rendered by workers of a page that needs no server.
//!
//! Each worker has a [`Painter`]: the whole scene, from the same camera as all others, and a [`Share`] of the picture. It
//! renders in slices of some milliseconds and sends what became better as [`Patches`]. The page puts them together on a
//! [`Board`], which shows, hashes and saves the picture. Workers share no memory, so the page needs no special headers.
//!
//! Here is all that can be tested without a browser; `glue` names it for JavaScript, the page is in `web/page`.

mod board;
#[cfg(target_family = "wasm")]
mod glue;
mod painter;
mod patches;
mod share;
mod slice;

pub use board::{Board, Outline};
pub use painter::Painter;
pub use patches::Patches;
pub use share::Share;

/// The built-in scenes in JSON: `[{"name": ..., "title": ...}, ...]`.
pub fn scenes() -> String {
    let title = |scene: &juggler::scene::BuiltIn| {
        let known = juggler::scene::Scene::built_in(scene.name);
        known.map(|scene| scene.description.title).unwrap_or_default()
    };
    let scenes = juggler::scene::built_in_scenes().iter();
    let scenes = scenes.map(|scene| serde_json::json!({ "name": scene.name, "title": title(scene) }));
    serde_json::Value::from_iter(scenes).to_string()
}
