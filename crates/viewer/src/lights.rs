//! Light mixer in the panel: intensity and color of each light group. Changes relight the image
//! without tracing it again.

use crate::panel::row;
use eframe::egui::{Slider, SliderClamping, Ui};
use juggler_session::{Edit, Setting};

/// Maximum intensity of the slider.
const MAX_INTENSITY: f32 = 4.0;

/// Shows a row for each light group, and appends changes to `edits`.
pub fn show(ui: &mut Ui, groups: &[(String, [f32; 3])], edits: &mut Vec<Edit>) {
    for (name, gain) in groups {
        let (mut strength, mut color) = intensity_and_color(*gain);
        let changed = row(ui, name, |ui| {
            let slider =
                Slider::new(&mut strength, 0.0..=MAX_INTENSITY).clamping(SliderClamping::Never).fixed_decimals(2);
            let strength = ui.add(slider);
            let color = ui.color_edit_button_rgb(&mut color);
            strength.changed() || color.changed()
        });
        if changed {
            let gain = color.map(|factor| (factor * strength).max(0.0));
            edits.push(Edit::Setting(Setting::Gain(name.clone(), gain)));
        }
    }
}

/// Splits a gain into intensity and a color whose largest channel is 1; white for a gain of 0.
fn intensity_and_color(gain: [f32; 3]) -> (f32, [f32; 3]) {
    let strength = gain.into_iter().fold(0.0, f32::max);
    (strength, if strength > 0.0 { gain.map(|factor| factor / strength) } else { [1.0; 3] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_intensities_times_colors() {
        assert_eq!(intensity_and_color([1.0, 1.0, 1.0]), (1.0, [1.0, 1.0, 1.0]));
        assert_eq!(intensity_and_color([2.0, 1.0, 0.5]), (2.0, [1.0, 0.5, 0.25]));
        assert_eq!(intensity_and_color([0.0; 3]), (0.0, [1.0; 3]));
    }
}
