//! Every key and every gesture in one table: the input acts by it, the help shows it.

use eframe::egui::{Event, InputState, Key, Modifiers};
use std::collections::HashSet;

/// What keys do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Goes on as long as the key is held.
    Hold(Motion),
    /// Happens once when the key goes down.
    Press(Command),
}

/// A motion of the camera along or about its own axes, or of its lens.
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

/// What happens once.
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

/// Which of the modifiers has to be held. Motions and most keys do not ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum With {
    /// Any but control.
    Any,
    /// Control; on a Mac, command.
    Control,
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Any of these keys.
    pub keys: &'static [Key],
    /// Together with it.
    pub with: With,
    /// What it does.
    pub action: Action,
    /// What the help says; rows with the same words in a row are shown as one.
    pub says: &'static str,
}

/// A heading of the help with its rows.
pub struct Group {
    /// The heading.
    pub name: &'static str,
    /// Things to do with the mouse, and what they do.
    pub gestures: &'static [(&'static str, &'static str)],
    /// Keys.
    pub bindings: &'static [Binding],
}

/// The key that turns a drag into the choice of a region.
pub const REGION: Key = Key::R;

/// What the digits are for.
const CHANNELS: &str = "what is shown: the picture, albedo, normals ...";

const fn hold(keys: &'static [Key], motion: Motion, says: &'static str) -> Binding {
    Binding { keys, with: With::Any, action: Action::Hold(motion), says }
}

const fn press(keys: &'static [Key], command: Command, says: &'static str) -> Binding {
    Binding { keys, with: With::Any, action: Action::Press(command), says }
}

const fn control(keys: &'static [Key], command: Command, says: &'static str) -> Binding {
    Binding { keys, with: With::Control, action: Action::Press(command), says }
}

/// The table.
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
            press(&[Key::F], Command::FrameAll, "everything into view"),
            press(&[Key::V], Command::NextCamera, "next camera of the scene"),
            press(&[Key::B], Command::Bookmark, "keep this camera"),
        ],
    },
    Group {
        name: "Picture",
        gestures: &[
            ("R drag", "refine only this part"),
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
            press(&[Key::Space], Command::Play, "play, stop"),
            press(&[Key::Comma], Command::PreviousFrame, "frame before, after"),
            press(&[Key::Period], Command::NextFrame, "frame before, after"),
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
            press(&[Key::Escape], Command::Close, "close what lies over the picture"),
            control(&[Key::Q], Command::Quit, "quit"),
        ],
    },
];

/// All rows of the table.
fn bindings() -> impl Iterator<Item = &'static Binding> {
    GROUPS.iter().flat_map(|group| group.bindings)
}

impl Binding {
    fn fits(&self, key: Key, modifiers: Modifiers) -> bool {
        self.keys.contains(&key) && modifiers.command == (self.with == With::Control)
    }
}

/// Keys that are held, and what they move.
#[derive(Default)]
pub struct Held(HashSet<Key>);

impl Held {
    /// The motions whose keys are held now. A press counts with the modifiers that it came with: those that are held by now
    /// may be others, and Control with S must not move anything while its keys come up.
    pub fn look(&mut self, input: &InputState) -> Vec<Motion> {
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

/// Rows of the table that move something.
fn motions() -> impl Iterator<Item = (&'static Binding, Motion)> {
    bindings().filter_map(|row| match row.action {
        Action::Hold(motion) => Some((row, motion)),
        Action::Press(_) => None,
    })
}

/// What was asked for since the last look. A press counts with the modifiers that it came with, and once however long it
/// lasts.
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

    /// What egui makes of keys that go down with some modifiers, which then are others.
    fn input(keys: &[Key], modifiers: Modifiers, then: Modifiers) -> InputState {
        let context = eframe::egui::Context::default();
        let event = |key: &Key| Event::Key { key: *key, physical_key: None, pressed: true, repeat: false, modifiers };
        let events = keys.iter().map(event).chain([Event::ModifiersChanged(then)]).collect();
        let mut seen = InputState::default();
        let mut output = context.run_ui(RawInput { events, ..RawInput::default() }, |ui| {
            seen = ui.input(Clone::clone);
        });
        output.textures_delta.clear();
        seen
    }

    fn held(input: &InputState) -> Vec<Motion> {
        Held::default().look(input)
    }

    #[test]
    fn no_key_means_two_things() {
        let mut seen = HashSet::new();
        for row in bindings() {
            for key in row.keys {
                assert!(seen.insert((*key, row.with == With::Control)), "{key:?}");
                assert_ne!(*key, REGION);
            }
            assert!(!row.says.is_empty());
        }
    }

    #[test]
    fn keys_are_what_the_table_says() {
        let both = input(&[Key::W, Key::ArrowLeft, Key::Tab], Modifiers::NONE, Modifiers::NONE);
        assert_eq!(held(&both), [Motion::Forward, Motion::Left]);
        assert_eq!(pressed(&both), [Command::Panel]);
        let mut keys = Held::default();
        keys.look(&both);
        assert_eq!(keys.look(&InputState::default()), [], "they came up");
    }

    #[test]
    fn control_is_another_key() {
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
