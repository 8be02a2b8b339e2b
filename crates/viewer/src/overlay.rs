//! Messages over the image: errors, notices, and a status line while the panel is hidden.

use crate::style;
use eframe::egui::{self, Align2, Context, Id, Rect, RichText, ScrollArea, vec2};
use juggler_session::{Stage, Status};

/// Shows an error over the last valid image, as `juggler check` prints it.
pub fn error(context: &Context, area: Rect, text: &str) {
    egui::Area::new(Id::unique("mistake"))
        .order(egui::Order::Foreground)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(area.left_bottom() + vec2(16.0, -16.0))
        .show(context, |ui| {
            style::floating().stroke(egui::Stroke::new(1.0, style::WRONG)).show(ui, |ui| {
                ui.set_max_width(area.width() - 56.0);
                ScrollArea::both().max_height(area.height() * 0.7).auto_shrink(true).show(ui, |ui| {
                    let words = RichText::new(text.trim_end()).monospace().color(style::TEXT);
                    ui.add(egui::Label::new(words).extend().selectable(true));
                });
            });
        });
}

/// Shows a success or failure at the middle of the upper edge.
pub fn notice(context: &Context, area: Rect, notice: &Result<String, String>) {
    egui::Area::new(Id::unique("notice"))
        .order(egui::Order::Foreground)
        .interactable(false)
        .pivot(Align2::CENTER_TOP)
        .fixed_pos(area.center_top() + vec2(0.0, 12.0))
        .show(context, |ui| {
            let (text, color) = match notice {
                Ok(text) => (text, style::TEXT),
                Err(text) => (text, style::WRONG),
            };
            style::floating().show(ui, |ui| {
                ui.set_max_width((area.width() - 48.0).max(120.0));
                ui.label(RichText::new(text).color(color));
            });
        });
}

/// Shows the status line at the lower left.
pub fn line(context: &Context, area: Rect, status: &Status) {
    egui::Area::new(Id::unique("line"))
        .interactable(false)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(area.left_bottom() + vec2(12.0, -12.0))
        .show(context, |ui| {
            style::floating().inner_margin(egui::Margin::symmetric(10, 5)).show(ui, |ui| {
                ui.label(RichText::new(summary(status)).color(style::QUIET));
            });
        });
}

/// Formats the status: `12 of 64 samples · noise 1.2 % · 12.3 Mrays/s`.
pub fn summary(status: &Status) -> String {
    let mut parts = Vec::new();
    match status.stage {
        Stage::Loading => parts.push("loading".to_owned()),
        Stage::Moving => parts.push(moving(status)),
        Stage::Refining if status.coarseness > 1 => parts.push(format!("1/{} size", status.coarseness)),
        Stage::Refining => parts.push(format!("{} of {} samples", status.samples.floor(), status.samples_wanted)),
        Stage::Finished => parts.push(format!("{} samples, finished", status.samples.floor())),
    }
    if status.denoised {
        parts.push("denoised".to_owned());
    }
    if let Some(noise) = status.noise {
        parts.push(format!("noise {:.1} %", noise * 100.0));
    }
    if let Some(share) = status.clamped {
        parts.push(format!("clamping removed {:.1} %", share * 100.0));
    }
    if status.rays_per_second > 0.0 && status.stage != Stage::Finished {
        parts.push(rays(status.rays_per_second));
    }
    parts.join(" · ")
}

fn moving(status: &Status) -> String {
    let fps = format!("{:.0} frames/s", status.frames_per_second);
    if status.coarseness > 1 { format!("{fps}, 1/{} size", status.coarseness) } else { fps }
}

/// Formats a ray rate: `12.3 Mrays/s`.
pub fn rays(per_second: f32) -> String {
    if per_second >= 1e6 {
        format!("{:.1} Mrays/s", per_second / 1e6)
    } else {
        format!("{:.0} krays/s", per_second / 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlay_summarizes_the_status() {
        let mut status = Status { stage: Stage::Moving, frames_per_second: 51.7, coarseness: 2, ..Status::default() };
        assert_eq!(summary(&status), "52 frames/s, 1/2 size");
        (status.stage, status.samples, status.samples_wanted, status.coarseness) = (Stage::Refining, 12.5, 64, 1);
        (status.noise, status.rays_per_second) = (Some(0.0123), 12.34e6);
        assert_eq!(summary(&status), "12 of 64 samples · noise 1.2 % · 12.3 Mrays/s");
        status.stage = Stage::Finished;
        assert_eq!(summary(&status), "12 samples, finished · noise 1.2 %");
        (status.stage, status.coarseness) = (Stage::Refining, 4);
        assert_eq!(summary(&status), "1/4 size · noise 1.2 % · 12.3 Mrays/s");
        (status.stage, status.denoised) = (Stage::Finished, true);
        assert_eq!(summary(&status), "12 samples, finished · denoised · noise 1.2 %");
        (status.denoised, status.clamped) = (false, Some(0.0346));
        assert_eq!(summary(&status), "12 samples, finished · noise 1.2 % · clamping removed 3.5 %");
    }
}
