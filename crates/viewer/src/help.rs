//! All keys and gestures over the picture, as the table has them.

use crate::keys::{Binding, GROUPS, Group, With};
use crate::style;
use eframe::egui::{self, Context, Grid, Id, Key, RichText, Ui};

/// Shows them; whether they are to be closed.
pub fn show(context: &Context) -> bool {
    let modal = egui::Modal::new(Id::unique("help"))
        .frame(style::floating().fill(style::SURFACE).inner_margin(18))
        .show(context, |ui| {
            ui.spacing_mut().item_spacing = egui::vec2(14.0, 4.0);
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| groups(ui, &GROUPS[..1]));
                ui.add_space(24.0);
                ui.vertical(|ui| groups(ui, &GROUPS[1..]));
            });
        });
    modal.should_close()
}

fn groups(ui: &mut Ui, groups: &[Group]) {
    for group in groups {
        ui.label(RichText::new(group.name).color(style::ACCENT).size(15.0));
        Grid::new(group.name).num_columns(2).show(ui, |ui| {
            for (keys, says) in rows(group) {
                ui.label(RichText::new(keys).monospace());
                ui.label(RichText::new(says).color(style::QUIET));
                ui.end_row();
            }
        });
        ui.add_space(10.0);
    }
}

/// What is to be pressed, and what it does; keys that follow each other and do the same share a row.
fn rows(group: &Group) -> Vec<(String, &'static str)> {
    let mut rows: Vec<(String, &'static str)> =
        group.gestures.iter().map(|(gesture, says)| ((*gesture).to_owned(), *says)).collect();
    let gestures = rows.len();
    for binding in group.bindings {
        match rows.get_mut(gestures..).and_then(<[_]>::last_mut) {
            Some((keys, says)) if *says == binding.says => *keys = format!("{keys}  {}", written(binding)),
            _ => rows.push((written(binding), binding.says)),
        }
    }
    rows
}

/// `W ↑`, `Ctrl S`.
fn written(binding: &Binding) -> String {
    let keys: Vec<&str> = binding.keys.iter().map(|key| name(*key)).collect();
    let control = if binding.with == With::Control { "Ctrl " } else { "" };
    format!("{control}{}", keys.join(" "))
}

/// Arrows as the letters at hand have them.
fn name(key: Key) -> &'static str {
    match key {
        Key::ArrowUp => "↑",
        Key::ArrowDown => "↓",
        Key::ArrowLeft => "←",
        Key::ArrowRight => "→",
        other => other.symbol_or_name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_binding_is_there() {
        let all: Vec<(String, &str)> = GROUPS.iter().flat_map(rows).collect();
        for binding in GROUPS.iter().flat_map(|group| group.bindings) {
            let row = all.iter().find(|(keys, says)| *says == binding.says && keys.contains(&written(binding)));
            assert!(row.is_some(), "{binding:?}");
        }
        let yaw = all.iter().filter(|(_, says)| *says == "yaw").count();
        assert_eq!(yaw, 1);
    }

    #[test]
    fn the_documentation_has_them_all() {
        let page = include_str!("../../../docs/viewer.md");
        for (keys, says) in GROUPS.iter().flat_map(rows) {
            let row = format!("| {keys} | {says} |");
            assert!(page.contains(&row), "docs/viewer.md lacks the row\n{row}");
        }
    }
}
