//! Models of a scene: contents and support of their extensions.

use juggler::scene::Scene;
use juggler::scene::model::{ExtensionSupport, ModelSummary, SceneModel};
use serde_json::{Value, json};

/// Rows of the output for all models of a scene.
pub fn rows(scene: &Scene) -> Vec<(String, String)> {
    scene.model_summaries().iter().flat_map(|found| model_rows(&found.path.to_string(), &found.summary)).collect()
}

fn model_rows(path: &str, summary: &ModelSummary) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut row = |key: &str, value: String| rows.push((key.to_owned(), value));
    let generator = summary.generator.as_ref().map(|generator| format!(", by {generator}")).unwrap_or_default();
    row("model", format!("{path}: {}{generator}", summary.format));
    let drawn = format!("{} nodes, {} triangles", summary.nodes, summary.drawn_triangles);
    row("", format!("{drawn}, {} of them distinct", summary.distinct_triangles));
    for (key, names) in [("scenes", &summary.scenes), ("variants", &summary.variants), ("lights", &summary.lights)] {
        if !names.is_empty() {
            row(key, names.join(", "));
        }
    }
    for (i, clip) in summary.clips.iter().enumerate() {
        let shown = if summary.clip == Some(i) { ", shown" } else { "" };
        row("clip", format!("{}, {:.3} s{shown}", clip.name, clip.seconds));
    }
    for extension in &summary.extensions {
        row("extension", format!("{}: {}", extension.name, support_text(extension.support)));
    }
    for warning in &summary.warnings {
        row("warning", warning.clone());
    }
    rows
}

fn support_text(support: ExtensionSupport) -> &'static str {
    match support {
        ExtensionSupport::Whole => "whole",
        ExtensionSupport::Approximated => "approximated",
        ExtensionSupport::Ignored => "ignored",
    }
}

/// The models of a scene as JSON.
pub fn json(scene: &Scene) -> Value {
    let model = |SceneModel { path, summary, .. }: &SceneModel| {
        let clips = summary.clips.iter().map(|clip| json!({"name": clip.name, "seconds": clip.seconds}));
        let extensions = summary.extensions.iter();
        let extensions = extensions.map(|e| json!({"name": e.name, "support": support_text(e.support)}));
        json!({
            "path": path.to_string(),
            "format": summary.format,
            "generator": summary.generator,
            "nodes": summary.nodes,
            "triangles": summary.drawn_triangles,
            "distinct_triangles": summary.distinct_triangles,
            "scenes": summary.scenes,
            "variants": summary.variants,
            "clips": clips.collect::<Vec<_>>(),
            "materials": summary.materials,
            "lights": summary.lights,
            "images": summary.textures.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            "extensions": extensions.collect::<Vec<_>>(),
            "warnings": summary.warnings,
        })
    };
    scene.model_summaries().iter().map(model).collect()
}
