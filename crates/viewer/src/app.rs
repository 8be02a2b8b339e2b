//! The window: its state, and one pass over it.

use crate::ViewerOptions;
use crate::chooser::Chooser;
use crate::frame_rate::FrameRate;
use crate::keys::{self, Command, HeldKeys};
use crate::overlay;
use crate::panel::{Panel, PanelContext, next_name};
use crate::picture::{FrameTexture, Placement};
use crate::pointer::PointerInput;
use crate::probe::{self, Probing};
use crate::saving::Saving;
use crate::title::title;
use crate::{help, region, style, timeline};
use eframe::egui::{self, Context, EventFilter, Rect, Response, Sense, Ui, ViewportCommand};
use juggler_session::{Channel, Edit, Session, Setting, Stage, Status};
use std::sync::Arc;
use std::time::Duration;

/// Time between two steps of the camera while a key is held.
const STEP: Duration = Duration::from_millis(15);
/// Time between two checks whether a notice has expired.
const NOTICE: Duration = Duration::from_millis(500);
/// Exposure step of the keys, in photographic stops.
const STOPS: f32 = 0.25;

/// State of the window.
pub struct Viewer {
    session: Session,
    texture: FrameTexture,
    pointer: PointerInput,
    held: HeldKeys,
    panel: Panel,
    shows_panel: bool,
    chooser: Chooser,
    shows_help: bool,
    probing: Probing,
    saving: Saving,
    rate: FrameRate,
    title: String,
    /// Index of the scene's camera that was selected last.
    camera: usize,
    /// Area of the window that is left for the image, then the pixel under the pointer.
    area: Rect,
    hovered_pixel: Option<[u32; 2]>,
}

impl Viewer {
    /// Creates the window of a session, which is repainted on every new frame or status.
    pub fn new(session: Session, options: ViewerOptions, context: &eframe::CreationContext<'_>) -> Self {
        style::apply(&context.egui_ctx);
        let context = context.egui_ctx.clone();
        session.on_update(move || context.request_repaint());
        let mut chooser = Chooser::default();
        chooser.set_open(options.choose);
        Self {
            session,
            texture: FrameTexture::default(),
            pointer: PointerInput::default(),
            held: HeldKeys::default(),
            panel: Panel::default(),
            shows_panel: true,
            chooser,
            shows_help: false,
            probing: Probing::default(),
            saving: Saving::default(),
            rate: FrameRate::default(),
            title: String::new(),
            camera: 0,
            area: Rect::NOTHING,
            hovered_pixel: None,
        }
    }

    /// Returns whether a dialog covers the image.
    fn is_covered(&self) -> bool {
        self.chooser.is_open() || self.shows_help
    }

    /// Reads the keys, unless a text field has the focus.
    fn keys(&mut self, context: &Context, status: &Status, edits: &mut Vec<Edit>) -> Vec<Command> {
        if context.text_edit_focused() {
            return Vec::new();
        }
        let mut commands = context.input(keys::pressed);
        if self.is_covered() {
            let over = [Command::Close, Command::Help, Command::Scenes, Command::FullScreen, Command::Quit];
            commands.retain(|command| over.contains(command));
            return commands;
        }
        let (held, fast, seconds) =
            context.input(|input| (self.held.update(input), input.modifiers.shift, input.stable_dt));
        if !held.is_empty() {
            edits.extend(self.pointer.controls.keys(&held, fast, seconds, status.flight_speed));
            context.request_repaint_after(STEP);
        }
        commands
    }

    fn execute(&mut self, context: &Context, command: Command, status: &Status, edits: &mut Vec<Edit>) {
        match command {
            Command::Faster => self.pointer.controls.change_speed(1),
            Command::Slower => self.pointer.controls.change_speed(-1),
            Command::OtherMode => self.pointer.controls.mode = self.pointer.controls.mode.other(),
            Command::Probe => self.probing = self.probing.next(self.hovered_pixel),
            Command::Magnify => self.pointer.view.toggle(),
            Command::Panel => self.shows_panel = !self.shows_panel,
            Command::Scenes => self.chooser.set_open(!self.chooser.is_open()),
            Command::Help => self.shows_help = !self.shows_help,
            Command::FullScreen => {
                let full = context.input(|input| input.viewport().fullscreen.unwrap_or(false));
                context.send_viewport_cmd(ViewportCommand::Fullscreen(!full));
            }
            Command::Save => {
                let context = context.clone();
                self.saving.start(&self.session, &status.scene, move || context.request_repaint());
            }
            Command::Close => {
                (self.shows_help, self.probing) = (false, Probing::Off);
                self.saving.dismiss();
                self.chooser.set_open(false);
            }
            Command::NextCamera => {
                self.camera = (self.camera + 1) % status.cameras.len().max(1);
                edits.extend(status.cameras.get(self.camera).cloned().map(Edit::Camera));
            }
            Command::Quit => context.send_viewport_cmd(ViewportCommand::Close),
            other => edits.extend(edit_of(other, status)),
        }
    }

    /// Shows the image with its overlays.
    fn picture(&mut self, ui: &mut Ui, status: &Status, edits: &mut Vec<Edit>) {
        let response = ui.allocate_rect(ui.max_rect(), Sense::click_and_drag());
        self.area = response.rect;
        if !self.is_covered() {
            take_focus(ui, &response);
        }
        let frame = self.session.frame();
        let size = frame.as_ref().map_or(status.size, |frame| frame.size);
        let placement = self.pointer.view.place(response.rect, size, ui.ctx().pixels_per_point());
        if let Some(frame) = frame {
            let still = status.stage != Stage::Moving;
            if self.texture.upload(ui.ctx(), &frame, placement.scale, still) {
                self.rate.count(ui.input(|input| input.time));
            }
        }
        self.hovered_pixel = response.hover_pos().and_then(|at| placement.pixel(at));
        self.pointer.handle(ui, &response, &placement, status, edits);
        self.draw(ui, &placement, status);
    }

    fn draw(&self, ui: &Ui, placement: &Placement, status: &Status) {
        let painter = ui.painter_at(self.area);
        self.texture.draw(&painter, placement);
        if let Some(part) = &status.region {
            region::draw(&painter, placement, part, 1.0);
        }
        region::draw_selection(&painter, placement, self.pointer.drag, ui.input(|input| input.pointer.latest_pos()));
        if let Some(pixel) = self.probing.pixel(self.hovered_pixel) {
            probe::show(ui, &painter, &self.session, placement, pixel);
        }
    }

    /// Shows dialogs and messages over the image.
    fn overlays(&mut self, context: &Context, status: &Status, edits: &mut Vec<Edit>) {
        if let Some(text) = &status.error {
            overlay::error(context, self.area, text);
        } else if !self.shows_panel {
            overlay::line(context, self.area, status);
        }
        let now = context.input(|input| input.time);
        if let Some(notice) = self.saving.notice(now) {
            overlay::notice(context, self.area, &notice);
            context.request_repaint_after(NOTICE);
        }
        edits.extend(self.chooser.show(context, &status.scene).map(Edit::Scene));
        if self.shows_help && help::show(context) {
            self.shows_help = false;
        }
        let dropped = context.input(|input| input.raw.dropped_files.last().map(|file| file.path().to_owned()));
        edits.extend(dropped.map(|path| Edit::Scene(path.display().to_string())));
    }

    fn panels(&mut self, ui: &mut Ui, status: &Status, edits: &mut Vec<Edit>, commands: &mut Vec<Command>) {
        if self.shows_panel {
            let scale = ui.ctx().pixels_per_point();
            let window = [self.area.width(), self.area.height()].map(|edge| (edge * scale).max(16.0) as u32);
            let (controls, saving) = (&mut self.pointer.controls, &mut self.saving);
            self.panel.show(ui, &mut PanelContext { status, controls, saving, window, edits, commands });
        }
        timeline::show(ui, status, edits);
    }

    fn update_title(&mut self, context: &Context, status: &Status) {
        let title = title(status, self.rate.per_second());
        if title != self.title {
            context.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        let status: Arc<Status> = self.session.status();
        self.saving.poll(context.input(|input| input.time));
        let mut edits = Vec::new();
        let mut commands = self.keys(&context, &status, &mut edits);
        self.panels(ui, &status, &mut edits, &mut commands);
        egui::CentralPanel::no_frame()
            .frame(egui::Frame::new().fill(style::BACKGROUND))
            .show(ui, |ui| self.picture(ui, &status, &mut edits));
        self.overlays(&context, &status, &mut edits);
        if !commands.is_empty() {
            // The next pass shows the effect of the commands.
            context.request_repaint();
        }
        for command in commands {
            self.execute(&context, command, &status, &mut edits);
        }
        for edit in edits {
            self.session.edit(edit);
        }
        self.update_title(&context, &status);
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        style::BACKGROUND.to_normalized_gamma_f32()
    }
}

/// Gives Tab and the arrow keys to the image unless a field has the focus.
fn take_focus(ui: &Ui, picture: &Response) {
    let filter = EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: true };
    ui.memory_mut(|memory| {
        if memory.focused().is_none() {
            memory.request_focus(picture.id);
        }
        memory.set_focus_lock_filter(picture.id, filter);
    });
}

/// Returns the edit of a command, if it has one.
fn edit_of(command: Command, status: &Status) -> Option<Edit> {
    Some(match command {
        Command::FrameAll => Edit::Frame(None),
        Command::Bookmark => Edit::Bookmark(next_name(&status.cameras)),
        Command::Play => (status.frames > 1).then_some(Edit::Play(!status.playing))?,
        Command::NextFrame => timeline::step(status, 1.0)?,
        Command::PreviousFrame => timeline::step(status, -1.0)?,
        Command::Brighter => Edit::Setting(Setting::Exposure(status.exposure + STOPS)),
        Command::Darker => Edit::Setting(Setting::Exposure(status.exposure - STOPS)),
        Command::Channel(place) => Edit::Show(*Channel::ALL.get(usize::from(place))?),
        Command::WholePicture => Edit::Region(None),
        Command::Denoise => Edit::Setting(Setting::Denoise(!status.denoise)),
        Command::Reload => Edit::Reload,
        Command::Reset => Edit::Reset,
        _ => return None,
    })
}
