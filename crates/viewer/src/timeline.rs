//! Timeline of an animated scene.

use crate::style;
use eframe::egui::{self, Button, RichText, Slider, Ui};
use juggler_session::{Edit, Status};

/// Distance that the slider keeps from the last frame, where the animation repeats, in frames.
const END: f64 = 0.01;

/// Shows the timeline at the bottom if the scene is animated.
pub fn show(ui: &mut Ui, status: &Status, edits: &mut Vec<Edit>) {
    if status.frames < 2 {
        return;
    }
    let frame = egui::Frame::new().fill(style::SURFACE).inner_margin(egui::Margin::symmetric(12, 6));
    egui::Panel::bottom("time").frame(frame).show(ui, |ui| {
        ui.horizontal(|ui| {
            let word = if status.playing { "Stop" } else { "Play" };
            if ui.add(Button::new(word).min_size(egui::vec2(48.0, 22.0))).clicked() {
                edits.push(Edit::Play(!status.playing));
            }
            let seconds = if status.frame_rate > 0.0 { status.frame / status.frame_rate } else { 0.0 };
            let words = format!("frame {:>6.2} of {}   {seconds:.2} s", status.frame, status.frames);
            let width = 250.0;
            ui.spacing_mut().slider_width = (ui.available_width() - width).max(80.0);
            let mut frame = status.frame;
            let slider = Slider::new(&mut frame, 0.0..=f64::from(status.frames)).show_value(false);
            if ui.add(slider).changed() {
                edits.push(Edit::At(frame.min(f64::from(status.frames) - END)));
            }
            ui.label(RichText::new(words).monospace().color(style::QUIET));
        });
    });
}

/// Returns the edit to the whole frame some frames away; the animation repeats.
pub fn step(status: &Status, frames: f64) -> Option<Edit> {
    (status.frames > 1).then(|| Edit::At((status.frame.round() + frames).rem_euclid(f64::from(status.frames))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_steps_wrap_around() {
        let status = Status { frames: 30, frame: 29.0, ..Status::default() };
        assert_eq!(step(&status, 1.0), Some(Edit::At(0.0)));
        assert_eq!(step(&Status { frame: 0.25, ..status.clone() }, -1.0), Some(Edit::At(29.0)));
        assert_eq!(step(&Status { frames: 0, ..status }, 1.0), None);
    }
}
