//! Groups of lights in the panel: how strong each is, and in which colour. The picture is mixed anew, not traced.

use crate::panel::row;
use eframe::egui::{Slider, SliderClamping, Ui};
use juggler_session::{Edit, Setting};

/// The strongest that a slider makes a group.
const MOST: f32 = 4.0;

/// A row for each group; `edits` receives what is changed.
pub fn show(ui: &mut Ui, groups: &[(String, [f32; 3])], edits: &mut Vec<Edit>) {
    for (name, gain) in groups {
        let (mut strength, mut color) = parts(*gain);
        let changed = row(ui, name, |ui| {
            let slider = Slider::new(&mut strength, 0.0..=MOST).clamping(SliderClamping::Never).fixed_decimals(2);
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

/// A gain as a strength and a colour whose strongest channel is 1: white where there is none.
fn parts(gain: [f32; 3]) -> (f32, [f32; 3]) {
    let strength = gain.into_iter().fold(0.0, f32::max);
    (strength, if strength > 0.0 { gain.map(|factor| factor / strength) } else { [1.0; 3] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_strengths_times_colours() {
        assert_eq!(parts([1.0, 1.0, 1.0]), (1.0, [1.0, 1.0, 1.0]));
        assert_eq!(parts([2.0, 1.0, 0.5]), (2.0, [1.0, 0.5, 0.25]));
        assert_eq!(parts([0.0; 3]), (0.0, [1.0; 3]));
    }
}
