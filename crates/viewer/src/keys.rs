//! Table of all keys and gestures, used by the input and by the help.

use eframe::egui::{Event, InputState, Key, Modifiers};
use std::collections::HashSet;

/// Effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Continuous motion while the key is held.
    Hold(Motion),
    /// Single command when the key is pressed.
    Press(Command),
}

/// Motion of the camera along or about its own axes, or zoom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    Forward,
    Back,
    Left,
    Right,
    Up,
    Down,
    YawLeft,
    YawRight,
    PitchUp,
    PitchDown,
    RollLeft,
    RollRight,
    Closer,
    Wider,
}

/// Command that is executed once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    Faster,
    Slower,
    OtherMode,
    FrameAll,
    NextCamera,
    Bookmark,
    Play,
    NextFrame,
    PreviousFrame,
    Brighter,
    Darker,
    Channel(u8),
    Probe,
    Denoise,
    WholePicture,
    Magnify,
    Panel,
    Scenes,
    Help,
    FullScreen,
    Save,
    Reload,
    Reset,
    Close,
    Quit,
}

/// Modifiers that a binding requires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modifier {
    /// Any modifiers except Control.
    Any,
    /// Control; Command on a Mac.
    Control,
}

/// Row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Alternative keys.
    pub keys: &'static [Key],
    /// Required modifiers.
    pub modifier: Modifier,
    /// Effect of the keys.
    pub action: Action,
    /// Help text; consecutive rows with the same text are merged.
    pub help: &'static str,
}

/// Section of the help.
pub struct Group {
    /// Heading.
    pub name: &'static str,
    /// Mouse gestures with their effects.
    pub gestures: &'static [(&'static str, &'static str)],
    /// Key bindings.
    pub bindings: &'static [Binding],
}

/// Key that turns a drag into the selection of a region.
pub const REGION: Key = Key::R;

/// Help text of the digit keys.
const CHANNELS: &str = "what is shown: the picture, albedo, normals ...";

const fn hold(keys: &'static [Key], motion: Motion, help: &'static str) -> Binding {
    Binding { keys, modifier: Modifier::Any, action: Action::Hold(motion), help }
}

const fn press(keys: &'static [Key], command: Command, help: &'static str) -> Binding {
    Binding { keys, modifier: Modifier::Any, action: Action::Press(command), help }
}

const fn control(keys: &'static [Key], command: Command, help: &'static str) -> Binding {
    Binding { keys, modifier: Modifier::Control, action: Action::Press(command), help }
}

/// All sections of the table.
pub const GROUPS: &[Group] = &[
    Group {
        name: "Camera",
        gestures: &[
            ("drag", "look around (fly), turn the scene about the point to orbit (orbit)"),
            ("Shift drag, middle drag", "move sideways and up"),
            ("wheel", "zoom (fly), come closer (orbit)"),
            ("click", "set the point to orbit, and the focus of a lens"),
            ("double click", "bring an object into view"),
            ("Shift with keys", "four times as fast"),
        ],
        bindings: &[
            hold(&[Key::W, Key::ArrowUp], Motion::Forward, "forward"),
            hold(&[Key::S, Key::ArrowDown], Motion::Back, "back"),
            hold(&[Key::A, Key::ArrowLeft], Motion::Left, "left"),
            hold(&[Key::D, Key::ArrowRight], Motion::Right, "right"),
            hold(&[Key::E, Key::PageUp], Motion::Up, "up"),
            hold(&[Key::Q, Key::PageDown], Motion::Down, "down"),
            hold(&[Key::J], Motion::YawLeft, "yaw"),
            hold(&[Key::L], Motion::YawRight, "yaw"),
            hold(&[Key::I], Motion::PitchUp, "pitch"),
            hold(&[Key::K], Motion::PitchDown, "pitch"),
            hold(&[Key::U], Motion::RollLeft, "roll"),
            hold(&[Key::O], Motion::RollRight, "roll"),
            hold(&[Key::X], Motion::Closer, "zoom"),
            hold(&[Key::C], Motion::Wider, "zoom"),
            press(&[Key::Plus, Key::Equals], Command::Faster, "speed"),
            press(&[Key::Minus], Command::Slower, "speed"),
            press(&[Key::M], Command::OtherMode, "fly or orbit"),
            press(&[Key::F], Command::FrameAll, "bring everything into view"),
            press(&[Key::V], Command::NextCamera, "next camera of the scene"),
            press(&[Key::B], Command::Bookmark, "bookmark this camera"),
        ],
    },
    Group {
        name: "Picture",
        gestures: &[
            ("R drag", "refine only this region"),
            ("Ctrl wheel", "magnify the picture"),
            ("right drag", "shift the magnified picture"),
        ],
        bindings: &[
            press(&[Key::T], Command::WholePicture, "refine the whole picture"),
            press(&[Key::Z], Command::Magnify, "fit the window, or 100 %"),
            press(&[Key::P], Command::Probe, "probe the pixel: follow, pin, off"),
            press(&[Key::N], Command::Denoise, "denoise, when nothing moves"),
            press(&[Key::OpenBracket], Command::Darker, "exposure"),
            press(&[Key::CloseBracket], Command::Brighter, "exposure"),
            press(&[Key::Num1], Command::Channel(0), CHANNELS),
            press(&[Key::Num2], Command::Channel(1), CHANNELS),
            press(&[Key::Num3], Command::Channel(2), CHANNELS),
            press(&[Key::Num4], Command::Channel(3), CHANNELS),
            press(&[Key::Num5], Command::Channel(4), CHANNELS),
            press(&[Key::Num6], Command::Channel(5), CHANNELS),
            press(&[Key::Num7], Command::Channel(6), CHANNELS),
            press(&[Key::Num8], Command::Channel(7), CHANNELS),
            control(&[Key::S], Command::Save, "save the picture"),
        ],
    },
    Group {
        name: "Time",
        gestures: &[],
        bindings: &[
            press(&[Key::Space], Command::Play, "play or stop"),
            press(&[Key::Comma], Command::PreviousFrame, "previous, next frame"),
            press(&[Key::Period], Command::NextFrame, "previous, next frame"),
        ],
    },
    Group {
        name: "Window",
        gestures: &[("drop a file", "open it")],
        bindings: &[
            press(&[Key::Tab], Command::Panel, "show or fold the panel"),
            press(&[Key::G], Command::Scenes, "choose a scene"),
            press(&[Key::Questionmark, Key::F1], Command::Help, "these keys"),
            press(&[Key::F11], Command::FullScreen, "full screen"),
            press(&[Key::F5], Command::Reload, "read the scene again"),
            press(&[Key::Home], Command::Reset, "undo all changes"),
            press(&[Key::Escape], Command::Close, "close dialogs and overlays"),
            control(&[Key::Q], Command::Quit, "quit"),
        ],
    },
];

/// Returns all key bindings.
fn bindings() -> impl Iterator<Item = &'static Binding> {
    GROUPS.iter().flat_map(|group| group.bindings)
}

impl Binding {
    fn fits(&self, key: Key, modifiers: Modifiers) -> bool {
        self.keys.contains(&key) && modifiers.command == (self.modifier == Modifier::Control)
    }
}

/// Set of motion keys that are held.
#[derive(Default)]
pub struct HeldKeys(HashSet<Key>);

impl HeldKeys {
    /// Updates the held keys and returns their motions. A press counts with the modifiers of its
    /// event: Control S must not move the camera when Control is released first.
    pub fn update(&mut self, input: &InputState) -> Vec<Motion> {
        for event in &input.events {
            if let Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event {
                self.0.remove(key);
                self.0.extend(motions().any(|(row, _)| row.fits(*key, *modifiers)).then_some(*key));
            }
        }
        self.0.retain(|key| input.key_down(*key));
        motions().filter(|(row, _)| row.keys.iter().any(|key| self.0.contains(key))).map(|(_, motion)| motion).collect()
    }
}

/// Returns all bindings of motions.
fn motions() -> impl Iterator<Item = (&'static Binding, Motion)> {
    bindings().filter_map(|row| match row.action {
        Action::Hold(motion) => Some((row, motion)),
        Action::Press(_) => None,
    })
}

/// Returns the commands of the pressed keys. A press counts once, with the modifiers of its event.
pub fn pressed(input: &InputState) -> Vec<Command> {
    let presses = input.events.iter().filter_map(|event| match event {
        Event::Key { key, pressed: true, repeat: false, modifiers, .. } => Some((*key, *modifiers)),
        _ => None,
    });
    presses.filter_map(|(key, modifiers)| command(key, modifiers)).collect()
}

fn command(key: Key, modifiers: Modifiers) -> Option<Command> {
    let row = bindings().find(|row| row.fits(key, modifiers))?;
    match row.action {
        Action::Press(command) => Some(command),
        Action::Hold(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::RawInput;

    /// Returns egui's input after key presses with some modifiers, which then change.
    fn input(keys: &[Key], modifiers: Modifiers, then: Modifiers) -> InputState {
        let context = eframe::egui::Context::default();
        let event = |key: &Key| Event::Key { key: *key, physical_key: None, pressed: true, repeat: false, modifiers };
        let events = keys.iter().map(event).chain([Event::ModifiersChanged(then)]).collect();
        let mut state = InputState::default();
        let mut output = context.run_ui(RawInput { events, ..RawInput::default() }, |ui| {
            state = ui.input(Clone::clone);
        });
        output.textures_delta.clear();
        state
    }

    fn held(input: &InputState) -> Vec<Motion> {
        HeldKeys::default().update(input)
    }

    #[test]
    fn no_key_has_two_actions() {
        let mut seen = HashSet::new();
        for row in bindings() {
            for key in row.keys {
                assert!(seen.insert((*key, row.modifier == Modifier::Control)), "{key:?}");
                assert_ne!(*key, REGION);
            }
            assert!(!row.help.is_empty());
        }
    }

    #[test]
    fn held_and_pressed_keys_match_the_key_table() {
        let both = input(&[Key::W, Key::ArrowLeft, Key::Tab], Modifiers::NONE, Modifiers::NONE);
        assert_eq!(held(&both), [Motion::Forward, Motion::Left]);
        assert_eq!(pressed(&both), [Command::Panel]);
        let mut keys = HeldKeys::default();
        keys.update(&both);
        assert_eq!(keys.update(&InputState::default()), [], "they came up");
    }

    #[test]
    fn control_key_distinguishes_commands_from_motion() {
        for then in [Modifiers::COMMAND, Modifiers::NONE] {
            let save = input(&[Key::S], Modifiers::COMMAND, then);
            assert_eq!((held(&save), pressed(&save)), (vec![], vec![Command::Save]));
        }
        for then in [Modifiers::SHIFT, Modifiers::COMMAND] {
            let fast = input(&[Key::S], Modifiers::SHIFT, then);
            assert_eq!((held(&fast), pressed(&fast)), (vec![Motion::Back], vec![]));
        }
    }
}
