//! Settings panel at the right, with the status above the settings.

use crate::controls::{Controls, Mode};
use crate::keys::Command;
use crate::lights;
use crate::models;
use crate::overlay;
use crate::saving::Saving;
use crate::style;
use crate::title::short;
use eframe::egui::scroll_area::ScrollAreaOutput;
use eframe::egui::{
    self, Button, CollapsingHeader, ComboBox, Grid, ProgressBar, RichText, ScrollArea, Slider, TextEdit, Ui, vec2,
};
use juggler::math::NamedKind;
use juggler::render::Scheduler;
use juggler_session::{Channel, Edit, Setting, Stage, Status};
use std::collections::BTreeMap;

/// Width of the panel, in points.
const WIDTH: f32 = 316.0;
/// Number of columns of channel buttons.
const CHANNEL_COLUMNS: usize = 4;
/// Offered image sizes.
const SIZES: [[u32; 2]; 6] = [[320, 240], [640, 480], [1280, 720], [1920, 1080], [2560, 1440], [3840, 2160]];

/// State of the panel.
pub struct Panel {
    cores: usize,
    bookmark: String,
    /// Last frame rate under each scheduler.
    rates: BTreeMap<Scheduler, f32>,
}

impl Default for Panel {
    fn default() -> Self {
        Self {
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            bookmark: String::new(),
            rates: BTreeMap::new(),
        }
    }
}

/// State that the panel reads, and outputs that it fills.
pub struct PanelContext<'a> {
    /// Status of the session.
    pub status: &'a Status,
    /// Settings of camera navigation.
    pub controls: &'a mut Controls,
    /// State of saving.
    pub saving: &'a mut Saving,
    /// Size of the image area, in screen pixels.
    pub window: [u32; 2],
    /// Receives edits for the session.
    pub edits: &'a mut Vec<Edit>,
    /// Receives commands for the window.
    pub commands: &'a mut Vec<Command>,
}

impl Panel {
    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        if context.status.stage == Stage::Moving && context.status.frames_per_second > 0.0 {
            self.rates.insert(context.status.scheduler, context.status.frames_per_second);
        }
        let frame = egui::Frame::new().fill(style::SURFACE).inner_margin(egui::Margin::symmetric(14, 12));
        egui::Panel::right("panel").frame(frame).resizable(false).exact_size(WIDTH).show(ui, |ui| {
            head(ui, context);
            ui.separator();
            self.sections(ui, context);
        });
    }

    /// Shows all sections; rarely used ones are closed at first.
    fn sections(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) -> ScrollAreaOutput<()> {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            section(ui, "Camera", true, |ui| self.camera(ui, context));
            section(ui, "Picture", true, |ui| self.picture(ui, context));
            if !context.status.light_groups.is_empty() {
                section(ui, "Lights", true, |ui| lights::show(ui, &context.status.light_groups, context.edits));
            }
            if !context.status.models.is_empty() {
                section(ui, "Models", true, |ui| models::show(ui, &context.status.models, context.edits));
            }
            section(ui, "Show", true, |ui| channels(ui, context));
            section(ui, "Save", true, |ui| save(ui, context));
            section(ui, "Machine", false, |ui| self.machine(ui, context));
        })
    }

    fn camera(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        row(ui, "drag", |ui| {
            for (mode, name) in [(Mode::Fly, "fly"), (Mode::Orbit, "orbit")] {
                ui.selectable_value(&mut context.controls.mode, mode, name);
            }
        });
        row(ui, "speed", |ui| {
            ui.add(Slider::new(&mut context.controls.speed, Controls::SPEEDS).logarithmic(true).max_decimals(2));
        });
        let cameras = &context.status.cameras;
        if !cameras.is_empty() {
            let chosen = row(ui, "go to", |ui| choice(ui, "camera", "a camera", cameras));
            context.edits.extend(chosen.map(Edit::Camera));
        }
        row(ui, "bookmark", |ui| {
            let hint = next_name(cameras);
            ui.add(TextEdit::singleline(&mut self.bookmark).hint_text(&hint).desired_width(118.0));
            if ui.button("Save").on_hover_text("saves this camera in the scene file, as a bookmark").clicked() {
                let name = std::mem::take(&mut self.bookmark);
                context.edits.push(Edit::Bookmark(if name.trim().is_empty() { hint } else { name }));
            }
        });
        row(ui, "", |ui| {
            button(ui, context, "Frame all", Command::FrameAll);
            button(ui, context, "Undo all", Command::Reset);
        });
    }

    fn picture(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let status = context.status;
        let mut set = |setting| context.edits.push(Edit::Setting(setting));
        if let Some(size) = row(ui, "size", |ui| sizes(ui, status.size, context.window)) {
            set(Setting::Size(size));
        }
        let integrator = row(ui, "integrator", |ui| kind_choice(ui, "integrator", status.integrator));
        integrator.map(Setting::Integrator).map(&mut set);
        let sampler = row(ui, "sampler", |ui| kind_choice(ui, "sampler", status.sampler));
        sampler.map(Setting::Sampler).map(&mut set);
        let samples = row(ui, "samples", |ui| number(ui, status.samples_wanted, 1..=16384, true));
        samples.map(Setting::Samples).map(&mut set);
        if let Some(depth) = status.max_depth {
            let [least, most] = status.depth_range;
            let depth = row(ui, "max depth", |ui| number(ui, depth, least..=most.min(64).max(depth), false));
            depth.map(Setting::MaxDepth).map(&mut set);
        }
        self.color(ui, context);
        row(ui, "when idle", |ui| {
            let mut denoise = status.denoise;
            if ui.checkbox(&mut denoise, "denoise").on_hover_text("key N").changed() {
                context.commands.push(Command::Denoise);
            }
            if status.region.is_some() {
                button(ui, context, "Whole picture", Command::WholePicture);
            }
        });
    }

    fn color(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let mut stops = context.status.exposure;
        let slider = Slider::new(&mut stops, -8.0..=8.0).fixed_decimals(2);
        if row(ui, "exposure", |ui| ui.add(slider).changed()) {
            context.edits.push(Edit::Setting(Setting::Exposure(stops)));
        }
        let curve = row(ui, "tone curve", |ui| kind_choice(ui, "curve", context.status.tone));
        context.edits.extend(curve.map(|curve| Edit::Setting(Setting::Tone(curve))));
    }

    fn machine(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let status = context.status;
        let most = self.cores.max(status.threads) as u32;
        if let Some(threads) = row(ui, "threads", |ui| number(ui, status.threads as u32, 1..=most, false)) {
            context.edits.push(Edit::Setting(Setting::Threads(threads as usize)));
        }
        for scheduler in Scheduler::ALL.iter().copied() {
            ui.horizontal(|ui| {
                let words = Button::selectable(status.scheduler == scheduler, scheduler.name());
                let does = scheduler_description(scheduler);
                if ui.add(words.min_size(vec2(118.0, 22.0))).on_hover_text(does).clicked() {
                    context.edits.push(Edit::Setting(Setting::Scheduler(scheduler)));
                }
                if let Some(rate) = self.rates.get(&scheduler) {
                    ui.label(RichText::new(format!("{rate:.1} frames/s")).color(style::QUIET));
                }
            });
        }
    }
}

/// Shows the scene's name and the progress of its image.
fn head(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let status = context.status;
    ui.horizontal(|ui| {
        let name = RichText::new(short(&status.scene)).size(17.0);
        let width = ui.available_width() - 70.0;
        ui.allocate_ui(vec2(width, 24.0), |ui| {
            ui.set_min_width(width);
            ui.add(egui::Label::new(name).truncate());
        });
        button(ui, context, "Scenes", Command::Scenes);
    });
    let share = if status.samples_wanted == 0 { 0.0 } else { status.samples / status.samples_wanted as f32 };
    let color = if status.stage == Stage::Finished { style::QUIET } else { style::ACCENT };
    ui.add(ProgressBar::new(share.clamp(0.0, 1.0)).desired_height(4.0).fill(color));
    ui.label(RichText::new(overlay::summary(status)).color(style::QUIET));
}

fn section(ui: &mut Ui, name: &str, open: bool, contents: impl FnOnce(&mut Ui)) {
    let head = RichText::new(name).color(style::ACCENT);
    CollapsingHeader::new(head).id_salt(name).default_open(open).show_unindented(ui, |ui| {
        contents(ui);
        ui.add_space(4.0);
    });
}

/// Shows a label with a control beside it.
pub fn row<R>(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let (place, _) = ui.allocate_exact_size(vec2(76.0, 22.0), egui::Sense::hover());
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().text(place.left_center(), egui::Align2::LEFT_CENTER, name, font, style::QUIET);
        contents(ui)
    })
    .inner
}

fn button(ui: &mut Ui, context: &mut PanelContext<'_>, words: &str, command: Command) {
    if ui.button(words).clicked() {
        context.commands.push(command);
    }
}

/// Shows a choice of all kinds of a closed set, and returns the kind if another is selected.
fn kind_choice<Kind: NamedKind>(ui: &mut Ui, id: &str, current: Option<Kind>) -> Option<Kind> {
    let mut chosen = None;
    let selected = current.map_or("", NamedKind::name);
    ComboBox::from_id_salt(id).width(190.0).selected_text(selected).show_ui(ui, |ui| {
        for kind in Kind::ALL.iter().copied() {
            if ui.selectable_label(Some(kind) == current, kind.name()).clicked() && Some(kind) != current {
                chosen = Some(kind);
            }
        }
    });
    chosen
}

fn scheduler_description(scheduler: Scheduler) -> &'static str {
    match scheduler {
        Scheduler::WorkStealing => "idle threads steal tiles from busy ones",
        Scheduler::RowQueue => "a shared counter hands out rows",
        Scheduler::StaticRows => "each thread has its own block of rows",
    }
}

/// Shows a choice of names, and returns the name if another is selected.
pub fn choice(ui: &mut Ui, id: &str, current: &str, names: &[String]) -> Option<String> {
    let mut chosen = None;
    ComboBox::from_id_salt(id).width(190.0).selected_text(current).show_ui(ui, |ui| {
        for name in names {
            if ui.selectable_label(name == current, name).clicked() && name != current {
                chosen = Some(name.clone());
            }
        }
    });
    chosen
}

fn sizes(ui: &mut Ui, current: [u32; 2], window: [u32; 2]) -> Option<[u32; 2]> {
    let mut chosen = None;
    let words = |[width, height]: [u32; 2]| format!("{width} × {height}");
    ComboBox::from_id_salt("size").width(190.0).selected_text(words(current)).show_ui(ui, |ui| {
        let of_window = format!("{} (window)", words(window));
        for (size, words) in SIZES.iter().map(|size| (*size, words(*size))).chain([(window, of_window)]) {
            if ui.selectable_label(size == current, words).clicked() {
                chosen = Some(size);
            }
        }
    });
    chosen
}

fn number(ui: &mut Ui, current: u32, range: std::ops::RangeInclusive<u32>, logarithmic: bool) -> Option<u32> {
    let mut value = current;
    let slider = Slider::new(&mut value, range).logarithmic(logarithmic).update_while_editing(false);
    (ui.add(slider).changed() && value != current).then_some(value)
}

fn channels(ui: &mut Ui, context: &mut PanelContext<'_>) {
    ui.spacing_mut().button_padding.x = 3.0;
    Grid::new("channels").num_columns(CHANNEL_COLUMNS).spacing(vec2(4.0, 4.0)).show(ui, |ui| {
        for (place, channel) in Channel::ALL.into_iter().enumerate() {
            let words = Button::selectable(channel == context.status.channel, channel_name(channel));
            let hint = format!("key {}", place + 1);
            if ui.add(words.min_size(vec2(68.0, 22.0))).on_hover_text(hint).clicked() {
                context.edits.push(Edit::Show(channel));
            }
            if (place + 1).is_multiple_of(CHANNEL_COLUMNS) {
                ui.end_row();
            }
        }
    });
}

fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::Color => "picture",
        Channel::Albedo => "albedo",
        Channel::Normals => "normals",
        Channel::Depth => "depth",
        Channel::Objects => "objects",
        Channel::Materials => "materials",
        Channel::Samples => "samples",
        Channel::Noise => "noise",
    }
}

fn save(ui: &mut Ui, context: &mut PanelContext<'_>) {
    row(ui, "file", |ui| {
        let hint = context.saving.path(&context.status.scene).display().to_string();
        ui.add(TextEdit::singleline(&mut context.saving.text).hint_text(hint).desired_width(134.0));
        let busy = context.saving.is_busy();
        if ui.add_enabled(!busy, Button::new("Save")).clicked() {
            context.commands.push(Command::Save);
        }
    });
}

/// Returns a name that no camera has.
pub fn next_name(cameras: &[String]) -> String {
    let free = |number: &usize| !cameras.contains(&format!("view-{number}"));
    format!("view-{}", (1..=cameras.len() + 1).find(free).unwrap_or(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the hidden height of the panel's sections, in points, in a window of this size.
    fn hidden(status: &Status, size: [f32; 2]) -> f32 {
        let context = egui::Context::default();
        style::apply(&context);
        let (mut panel, mut controls, mut saving) = (Panel::default(), Controls::default(), Saving::default());
        let mut hidden = 0.0;
        // The layout of a section uses its size in the previous pass.
        for _ in 0..3 {
            let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size.into()));
            let mut output = context.run_ui(egui::RawInput { screen_rect, ..egui::RawInput::default() }, |ui| {
                let (mut edits, mut commands) = (Vec::new(), Vec::new());
                let (edits, commands) = (&mut edits, &mut commands);
                let mut context = PanelContext {
                    status,
                    controls: &mut controls,
                    saving: &mut saving,
                    window: [1; 2],
                    edits,
                    commands,
                };
                let frame = egui::Frame::new().inner_margin(egui::Margin::symmetric(14, 12));
                egui::Panel::right("panel").frame(frame).resizable(false).exact_size(WIDTH).show(ui, |ui| {
                    head(ui, &mut context);
                    ui.separator();
                    let output = panel.sections(ui, &mut context);
                    hidden = output.content_size.y - output.inner_rect.height();
                });
            });
            output.textures_delta.clear();
        }
        hidden
    }

    #[test]
    fn the_panel_fits_a_window_of_1280_by_800() {
        let region = Some(juggler::camera::film::Rect { x: 0, y: 0, width: 9, height: 9 });
        let light_groups = vec![("key".to_owned(), [1.0; 3]), ("rest".to_owned(), [1.0; 3])];
        let cameras = vec!["main".to_owned(), "top".to_owned()];
        let status = Status { max_depth: Some(5), region, light_groups, cameras, ..Status::default() };
        assert!(hidden(&status, [1280.0, 800.0]) <= 0.0, "{}", hidden(&status, [1280.0, 800.0]));
        assert!(hidden(&status, [1280.0, 500.0]) > 0.0, "it is measured");
    }

    #[test]
    fn new_bookmarks_get_unused_names() {
        assert_eq!(next_name(&[]), "view-1");
        assert_eq!(next_name(&["view-1".into(), "top".into(), "view-3".into()]), "view-2");
    }
}
