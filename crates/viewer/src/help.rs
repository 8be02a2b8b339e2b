//! Help dialog with all keys and gestures of the table.

use crate::keys::{Binding, GROUPS, Group, Modifier};
use crate::style;
use eframe::egui::{self, Context, Grid, Id, Key, RichText, Ui};

/// Shows the help, and returns whether to close it.
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
            for (keys, help) in rows(group) {
                ui.label(RichText::new(keys).monospace());
                ui.label(RichText::new(help).color(style::QUIET));
                ui.end_row();
            }
        });
        ui.add_space(10.0);
    }
}

/// Returns rows of keys and their effect; consecutive keys with the same effect share a row.
fn rows(group: &Group) -> Vec<(String, &'static str)> {
    let mut rows: Vec<(String, &'static str)> =
        group.gestures.iter().map(|(gesture, help)| ((*gesture).to_owned(), *help)).collect();
    let gestures = rows.len();
    for binding in group.bindings {
        match rows.get_mut(gestures..).and_then(<[_]>::last_mut) {
            Some((keys, help)) if *help == binding.help => *keys = format!("{keys}  {}", written(binding)),
            _ => rows.push((written(binding), binding.help)),
        }
    }
    rows
}

/// Formats the keys of a binding: `W ↑`, `Ctrl S`.
fn written(binding: &Binding) -> String {
    let keys: Vec<&str> = binding.keys.iter().map(|key| name(*key)).collect();
    let control = if binding.modifier == Modifier::Control { "Ctrl " } else { "" };
    format!("{control}{}", keys.join(" "))
}

/// Returns the name of a key; arrows as characters of the font.
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
    fn help_lists_every_key_binding() {
        let all: Vec<(String, &str)> = GROUPS.iter().flat_map(rows).collect();
        for binding in GROUPS.iter().flat_map(|group| group.bindings) {
            let row = all.iter().find(|(keys, help)| *help == binding.help && keys.contains(&written(binding)));
            assert!(row.is_some(), "{binding:?}");
        }
        let yaw = all.iter().filter(|(_, help)| *help == "yaw").count();
        assert_eq!(yaw, 1);
    }

    #[test]
    fn documentation_lists_every_key_binding() {
        let page = include_str!("../../../docs/viewer.md");
        for (keys, help) in GROUPS.iter().flat_map(rows) {
            let row = format!("| {keys} | {help} |");
            assert!(page.contains(&row), "docs/viewer.md lacks the row\n{row}");
        }
    }
}
