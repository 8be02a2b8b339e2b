//! Juggler in the browser: compiled to WebAssembly and run by the workers of a page that needs no
//! server.
//!
//! Each worker has a [`WorkerRenderer`] with the whole scene, the same camera, and a
//! [`WorkerShare`] of the image. It renders in slices of some milliseconds and sends updated tiles
//! as [`PixelRects`]. The page assembles them in a [`Compositor`], which displays, hashes and saves
//! the image. Workers share no memory, so the page needs no special HTTP headers.
//!
//! The modules other than `bindings`, the JavaScript interface, are tested without a browser. The
//! page is in `web/page`.

#[cfg(target_family = "wasm")]
mod bindings;
mod compositor;
mod pixel_rects;
mod renderer;
mod share;
mod worker_film;

pub use compositor::{Compositor, RenderInfo};
pub use pixel_rects::PixelRects;
pub use renderer::WorkerRenderer;
pub use share::WorkerShare;

/// Returns the built-in scenes in JSON: `[{"name": ..., "title": ...}, ...]`.
pub fn scenes() -> String {
    let title = |scene: &juggler::scene::BuiltIn| {
        let known = juggler::scene::Scene::built_in(scene.name);
        known.map(|scene| scene.description.title).unwrap_or_default()
    };
    let scenes = juggler::scene::built_in_scenes().iter();
    let scenes = scenes.map(|scene| serde_json::json!({ "name": scene.name, "title": title(scene) }));
    serde_json::Value::from_iter(scenes).to_string()
}
