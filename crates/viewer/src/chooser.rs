//! Scene chooser: thumbnails of the built-in scenes, and a text field for files.

use crate::style;
use crate::thumbnails::Thumbnails;
use eframe::egui::{
    self, Align2, Color32, Context, FontId, Id, Key, Pos2, Rect, ScrollArea, Sense, Stroke, StrokeKind, TextEdit, Ui,
    Vec2, pos2, vec2,
};
use juggler::scene::{BuiltIn, built_in_scenes};

/// Size of a card's thumbnail, in points.
const CARD: Vec2 = vec2(208.0, 117.0);
/// Height of a card's caption, in points.
const NAME: f32 = 26.0;

/// State of the scene chooser.
#[derive(Default)]
pub struct Chooser {
    open: bool,
    just_opened: bool,
    text: String,
    thumbnails: Thumbnails,
}

impl Chooser {
    /// Returns whether the chooser is open.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Opens or closes the chooser.
    pub fn set_open(&mut self, open: bool) {
        (self.open, self.just_opened) = (open, open);
        self.text.clear();
    }

    /// Shows the chooser if it is open, and returns the chosen scene.
    pub fn show(&mut self, context: &Context, current: &str) -> Option<String> {
        if !self.open {
            return None;
        }
        let room = context.content_rect().shrink(32.0);
        let columns = ((room.width() - 40.0) / (CARD.x + 10.0)).floor().clamp(1.0, 5.0) as usize;
        let frame = style::floating().fill(style::SURFACE).inner_margin(16);
        let modal = egui::Modal::new(Id::unique("scenes")).frame(frame).show(context, |ui| {
            ui.set_width(columns as f32 * (CARD.x + 10.0));
            ui.set_height(room.height() - 40.0);
            let typed = self.field(ui);
            ui.add_space(8.0);
            let height = room.height() - 90.0;
            let clicked = ScrollArea::vertical().max_height(height).auto_shrink(false).show(ui, |ui| {
                ui.set_min_height(height);
                self.cards(ui, columns, current)
            });
            typed.or(clicked.inner)
        });
        if modal.inner.is_some() || modal.should_close() {
            self.set_open(false);
        }
        modal.inner
    }

    /// Shows the text field. Enter returns the path in it, or the first matching scene.
    fn field(&mut self, ui: &mut Ui) -> Option<String> {
        let hint = "name of a scene, or path of a file";
        let field = ui.add(TextEdit::singleline(&mut self.text).hint_text(hint).desired_width(f32::INFINITY));
        if std::mem::take(&mut self.just_opened) {
            field.request_focus();
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if entered { chosen(&self.text) } else { None }
    }

    fn cards(&mut self, ui: &mut Ui, columns: usize, current: &str) -> Option<String> {
        let mut clicked = None;
        ui.spacing_mut().item_spacing = vec2(10.0, 10.0);
        let matching: Vec<&BuiltIn> = matching(&self.text).collect();
        for row in matching.chunks(columns) {
            ui.horizontal(|ui| {
                for scene in row {
                    if self.card(ui, scene, scene.name == current) {
                        clicked = Some(scene.name.to_owned());
                    }
                }
            });
        }
        clicked
    }

    /// Shows one scene, and returns whether it was clicked.
    fn card(&mut self, ui: &mut Ui, scene: &BuiltIn, current: bool) -> bool {
        let (rect, response) = ui.allocate_exact_size(CARD + vec2(0.0, NAME), Sense::click());
        if ui.is_rect_visible(rect) {
            let picture = Rect::from_min_size(rect.min, CARD);
            let painter = ui.painter();
            painter.rect_filled(picture, 4, style::BACKGROUND);
            if let Some(texture) = self.thumbnails.get(scene.name, ui.ctx()) {
                painter.image(texture.id(), picture, cover(texture.size_vec2()), Color32::WHITE);
            }
            let color = if response.hovered() || current { style::ACCENT } else { style::EDGE };
            painter.rect_stroke(picture, 4, Stroke::new(if current { 2.0 } else { 1.0 }, color), StrokeKind::Outside);
            let below = pos2(rect.left() + 2.0, picture.bottom() + NAME / 2.0);
            let color = if response.hovered() || current { style::TEXT } else { style::QUIET };
            painter.text(below, Align2::LEFT_CENTER, scene.name, FontId::proportional(13.0), color);
        }
        response.on_hover_ui(|ui| drop(ui.label(scene.description()))).clicked()
    }
}

/// Returns the scenes whose names contain all words.
fn matching(text: &str) -> impl Iterator<Item = &'static BuiltIn> {
    let words: Vec<String> = text.to_lowercase().split_whitespace().map(str::to_owned).collect();
    built_in_scenes().iter().filter(move |scene| words.iter().all(|word| scene.name.contains(word.as_str())))
}

/// Returns the scene that a text selects: a file, or the first matching built-in scene.
fn chosen(text: &str) -> Option<String> {
    let text = text.trim();
    if text.is_empty() {
        return None;
    }
    let is_path = std::path::Path::new(text).is_file() || text.contains(['/', '\\', '.']);
    let exact = built_in_scenes().iter().find(|scene| scene.name == text);
    let first = || exact.or_else(|| matching(text).next()).map(|scene| scene.name.to_owned());
    if is_path { Some(text.to_owned()) } else { first().or_else(|| Some(text.to_owned())) }
}

/// Returns the central part of an image with the aspect ratio of a card, in texture coordinates.
fn cover(size: Vec2) -> Rect {
    let scale = (CARD.x / size.x).max(CARD.y / size.y);
    let share = vec2(CARD.x / (size.x * scale), CARD.y / (size.y * scale));
    Rect::from_center_size(Pos2::new(0.5, 0.5), share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typed_text_finds_scenes_by_name_and_path() {
        let names = |text| matching(text).map(|scene| scene.name).collect::<Vec<_>>();
        assert_eq!(names("").len(), built_in_scenes().len());
        assert_eq!(names("Blitz pool"), ["scalablitz-pool"]);
        assert_eq!(chosen("pool"), Some("scalablitz-pool".into()));
        assert_eq!(chosen("step-13"), Some("step-13".into()));
        assert_eq!(chosen(" no/such.json "), Some("no/such.json".into()));
        assert_eq!(chosen("unheard"), Some("unheard".into()));
        assert_eq!(chosen("  "), None);
    }

    #[test]
    fn scene_cards_crop_thumbnails_to_the_center() {
        let square = cover(vec2(100.0, 100.0));
        assert!((square.width() - 1.0).abs() < 1e-6 && square.height() < 0.6);
        assert!((square.center() - pos2(0.5, 0.5)).length() < 1e-6);
        let wide = cover(vec2(400.0, 100.0));
        assert!((wide.height() - 1.0).abs() < 1e-6 && wide.width() < 0.5);
    }
}
