//! Visual style: dark and low in contrast, so that the image stands out.

use eframe::egui::{self, Color32, Context, CornerRadius, FontId, IconData, Stroke, TextStyle, Theme, vec2};

/// Background of the image.
pub const BACKGROUND: Color32 = Color32::from_rgb(14, 15, 17);
/// Outlines, also that of the image.
pub const EDGE: Color32 = Color32::from_rgb(34, 36, 40);
/// Panels and dialogs.
pub const SURFACE: Color32 = Color32::from_rgb(23, 24, 28);
/// Fields and buttons.
const FIELD: Color32 = Color32::from_rgb(37, 39, 45);
/// Fields and buttons under the pointer.
const FIELD_HOVERED: Color32 = Color32::from_rgb(48, 51, 58);
/// Text.
pub const TEXT: Color32 = Color32::from_rgb(214, 216, 221);
/// Secondary text.
pub const QUIET: Color32 = Color32::from_rgb(139, 144, 154);
/// Selected items and progress.
pub const ACCENT: Color32 = Color32::from_rgb(240, 168, 72);
/// Errors.
pub const WRONG: Color32 = Color32::from_rgb(240, 110, 95);

/// Applies colors, fonts and spacing.
pub fn apply(context: &Context) {
    context.set_theme(Theme::Dark);
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(11.0)),
            (TextStyle::Body, FontId::proportional(13.5)),
            (TextStyle::Button, FontId::proportional(13.5)),
            (TextStyle::Heading, FontId::proportional(18.0)),
            (TextStyle::Monospace, FontId::monospace(12.5)),
        ]
        .into();
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = vec2(8.0, 4.0);
        style.spacing.button_padding = vec2(8.0, 3.0);
        style.spacing.slider_width = 118.0;
        style.spacing.slider_rail_height = 4.0;
        style.spacing.interact_size.y = 22.0;
        style.animation_time = 0.08;
        colors(&mut style.visuals);
    });
}

fn colors(visuals: &mut egui::Visuals) {
    visuals.panel_fill = SURFACE;
    visuals.window_fill = SURFACE;
    visuals.extreme_bg_color = Color32::from_rgb(16, 17, 20);
    visuals.faint_bg_color = FIELD;
    visuals.window_stroke = Stroke::new(1.0, EDGE);
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.selection.bg_fill = Color32::from_rgb(92, 66, 32);
    visuals.selection.stroke = Stroke::new(1.0, ACCENT);
    visuals.slider_trailing_fill = true;
    visuals.error_fg_color = WRONG;
    visuals.weak_text_color = Some(QUIET);
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke.color = TEXT;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, EDGE);
    for (state, fill) in [
        (&mut widgets.inactive, FIELD),
        (&mut widgets.hovered, FIELD_HOVERED),
        (&mut widgets.active, FIELD_HOVERED),
        (&mut widgets.open, FIELD_HOVERED),
    ] {
        (state.bg_fill, state.weak_bg_fill) = (fill, fill);
        state.bg_stroke = Stroke::NONE;
        state.fg_stroke.color = TEXT;
        state.corner_radius = CornerRadius::same(4);
        state.expansion = 0.0;
    }
}

/// Returns the frame of dialogs over the image.
pub fn floating() -> egui::Frame {
    egui::Frame::new()
        .fill(SURFACE.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, EDGE))
        .corner_radius(8)
        .inner_margin(10)
}

/// Returns the window icon: three shaded spheres.
pub fn icon() -> IconData {
    const EDGE: u32 = 64;
    let balls = [(20.0, 42.0, 13.0), (44.0, 42.0, 13.0), (32.0, 19.0, 13.0)];
    let pixel = |x: u32, y: u32| {
        let at = [x as f32 + 0.5, y as f32 + 0.5];
        let shade = balls.iter().find_map(|(cx, cy, radius)| {
            let (dx, dy) = ((at[0] - cx) / radius, (at[1] - cy) / radius);
            let height = 1.0 - dx * dx - dy * dy;
            (height > 0.0).then(|| (0.35 + 0.65 * (0.5 * height.sqrt() - 0.5 * dx - 0.6 * dy)).clamp(0.15, 1.0))
        });
        shade.map_or([0; 4], |shade| [255.0 * shade, 190.0 * shade, 110.0 * shade, 255.0].map(|part| part as u8))
    };
    let rgba = (0..EDGE).flat_map(|y| (0..EDGE).flat_map(move |x| pixel(x, y))).collect();
    IconData { rgba, width: EDGE, height: EDGE }
}
