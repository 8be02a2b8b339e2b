//! Probe display for the pixel under the pointer, or for a pinned pixel.

use crate::picture::Placement;
use crate::style;
use eframe::egui::{self, Color32, Grid, Id, Painter, Pos2, RichText, Stroke, StrokeKind, Ui, vec2};
use juggler_session::{PixelInfo, Session};

/// Mode of the probe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Probing {
    /// No pixel is probed.
    #[default]
    Off,
    /// Probes the pixel under the pointer.
    Follow,
    /// Probes this pixel.
    Pinned([u32; 2]),
}

impl Probing {
    /// Returns the mode after a press of the key: follow, pin, off.
    pub fn next(self, hovered: Option<[u32; 2]>) -> Self {
        match (self, hovered) {
            (Self::Off, _) => Self::Follow,
            (Self::Follow, Some(pixel)) => Self::Pinned(pixel),
            _ => Self::Off,
        }
    }

    /// Returns the probed pixel.
    pub fn pixel(self, hovered: Option<[u32; 2]>) -> Option<[u32; 2]> {
        match self {
            Self::Off => None,
            Self::Follow => hovered,
            Self::Pinned(pixel) => Some(pixel),
        }
    }
}

/// Shows the data of a pixel beside it.
pub fn show(ui: &Ui, painter: &Painter, session: &Session, placement: &Placement, pixel: [u32; 2]) {
    let spot = placement.span(pixel, pixel);
    let mark = spot.expand((6.0 - spot.width() / 2.0).max(1.0));
    painter.rect_stroke(mark.expand(1.0), 1, Stroke::new(1.0, Color32::BLACK), StrokeKind::Outside);
    painter.rect_stroke(mark, 1, Stroke::new(1.0, style::ACCENT), StrokeKind::Outside);
    let Some(info) = session.probe(pixel) else { return };
    egui::Area::new(Id::unique("probe"))
        .order(egui::Order::Foreground)
        .interactable(false)
        .constrain_to(ui.ctx().content_rect())
        .fixed_pos(beside(mark.right_bottom()))
        .show(ui.ctx(), |ui| style::floating().show(ui, |ui| table(ui, &info)));
}

fn beside(corner: Pos2) -> Pos2 {
    corner + vec2(10.0, 10.0)
}

fn table(ui: &mut Ui, info: &PixelInfo) {
    ui.spacing_mut().item_spacing = vec2(12.0, 3.0);
    Grid::new("probe").num_columns(2).show(ui, |ui| {
        for (name, value) in rows(info) {
            ui.label(RichText::new(name).color(style::QUIET));
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

/// Returns the rows of the table.
fn rows(info: &PixelInfo) -> Vec<(&'static str, String)> {
    let [x, y] = info.pixel;
    let three = |[a, b, c]: [f32; 3]| format!("{} {} {}", number(a), number(b), number(c));
    let noise = |level: f32| format!("{:.1} %", level * 100.0);
    let rows = [
        ("pixel", Some(format!("{x}, {y}"))),
        ("color", Some(info.color.map_or("none yet".into(), three))),
        ("samples", Some(info.samples.to_string())),
        ("noise", info.noise.map(noise)),
        ("depth", Some(info.depth.map_or("nothing there".into(), number))),
        ("position", info.position.map(three)),
        ("normal", info.normal.map(three)),
        ("object", info.object.map(|object| object.to_string())),
        ("shape", info.shape.clone()),
        ("material", info.material.clone()),
    ];
    rows.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
}

/// Formats a number with four digits.
fn number(value: f32) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if (0.001..100_000.0).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let written: Vec<String> = [0.0, 0.12345, 1.5, -123.456, 54321.0, 1e-9].into_iter().map(number).collect();
        assert_eq!(written, ["0", "0.1235", "1.500", "-123.5", "54321", "1.000e-9"]);
    }

    #[test]
    fn probe_key_cycles_through_follow_pin_and_off() {
        let follow = Probing::Off.next(None);
        assert_eq!((follow, follow.pixel(Some([3, 4]))), (Probing::Follow, Some([3, 4])));
        let pinned = follow.next(Some([3, 4]));
        assert_eq!(pinned.pixel(Some([9, 9])), Some([3, 4]));
        assert_eq!(pinned.next(Some([9, 9])), Probing::Off);
        assert_eq!(follow.next(None), Probing::Off);
    }

    #[test]
    fn probe_omits_unknown_values() {
        let names = |info: &PixelInfo| rows(info).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(names(&PixelInfo::default()), ["pixel", "color", "samples", "depth"]);
        let hit = PixelInfo { depth: Some(2.0), material: Some("red".into()), ..PixelInfo::default() };
        assert_eq!(names(&hit), ["pixel", "color", "samples", "depth", "material"]);
    }
}
