//! Choices of models in the panel: material variants and animation clips.

use crate::panel::{choice, row};
use eframe::egui::{RichText, Ui};
use juggler_session::{Edit, ModelStatus};
use serde_json::Value;

/// Choice of the materials without a variant.
const NO_VARIANT: &str = "none";
/// Choice of no clip.
const REST_POSE: &str = "rest pose";

/// Shows rows for each model, and appends changes to `edits`.
pub fn show(ui: &mut Ui, models: &[ModelStatus], edits: &mut Vec<Edit>) {
    for model in models {
        let file = model.file.rsplit(['/', '\\']).next().unwrap_or_default();
        ui.label(RichText::new(file).color(crate::style::QUIET));
        let mut select = |name: &str, none: &str, names: &[String], current: &Option<String>| {
            let all: Vec<String> = std::iter::once(none.to_owned()).chain(names.iter().cloned()).collect();
            let id = format!("{name} of {}", model.pointer);
            let current = current.as_deref().unwrap_or(none);
            (!names.is_empty()).then(|| row(ui, name, |ui| choice(ui, &id, current, &all))).flatten()
        };
        if let Some(variant) = select("variant", NO_VARIANT, &model.variants, &model.variant) {
            let value = if variant == NO_VARIANT { Value::Null } else { variant.into() };
            edits.push(Edit::Set { path: format!("{}/variant", model.pointer), value });
        }
        if let Some(clip) = select("clip", REST_POSE, &model.clips, &model.clip) {
            let value = if clip == REST_POSE { "none".into() } else { clip.into() };
            edits.push(Edit::Set { path: format!("{}/animation", model.pointer), value });
        }
    }
}
