//! From what is pressed and dragged to what the session is asked for. No window in here.

use crate::keys::Motion;
use crate::lens::Lens;
use juggler_session::{Edit, Fly, Orbit};

/// How much of its reach the camera flies in a second at speed 1.
const REACH_PER_SECOND: f32 = 0.25;
/// How fast keys turn it.
const DEGREES_PER_SECOND: f32 = 60.0;
/// How fast keys zoom: the logarithm of the factor of a second.
const ZOOM_PER_SECOND: f32 = 1.0;
/// What Shift does to all three.
const FAST: f32 = 4.0;
/// What a press of the speed keys does.
const SPEED_STEP: f32 = 1.5;
/// How far a drag over a point of the screen turns the scene, degrees.
const ORBIT_DEGREES: f32 = 0.35;
/// How far a drag turns a camera whose pixels span no angle.
const PARALLEL_DEGREES: f32 = 0.15;
/// Points of the wheel for a factor of e.
const WHEEL_POINTS: f32 = 400.0;
/// The longest step of time that is believed: after a pause, nothing jumps.
const LONGEST_STEP: f32 = 0.1;

/// What a drag does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Turns the camera where it stands.
    #[default]
    Fly,
    /// Turns the scene about the point of interest.
    Orbit,
}

impl Mode {
    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Fly => Self::Orbit,
            Self::Orbit => Self::Fly,
        }
    }
}

/// How the camera is steered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// What a drag does.
    pub mode: Mode,
    /// Speed of the keys, 1 being a quarter of the lens's reach a second.
    pub speed: f32,
}

impl Default for Controls {
    fn default() -> Self {
        Self { mode: Mode::default(), speed: 1.0 }
    }
}

impl Controls {
    /// Speeds that can be chosen.
    pub const SPEEDS: std::ops::RangeInclusive<f32> = 0.01..=100.0;

    /// So many steps faster, or slower.
    pub fn change_speed(&mut self, steps: i32) {
        self.speed = (self.speed * SPEED_STEP.powi(steps)).clamp(*Self::SPEEDS.start(), *Self::SPEEDS.end());
    }

    /// Keys that are held for some seconds.
    pub fn keys(&self, held: &[Motion], fast: bool, seconds: f32, reach: f32) -> Vec<Edit> {
        let seconds = seconds.min(LONGEST_STEP) * if fast { FAST } else { 1.0 };
        let mut zoom = 0.0;
        let (step, turn) = (reach * REACH_PER_SECOND * self.speed * seconds, DEGREES_PER_SECOND * seconds);
        let mut fly = Fly::default();
        for motion in held {
            match motion {
                Motion::Forward => fly.forward += step,
                Motion::Back => fly.forward -= step,
                Motion::Left => fly.right -= step,
                Motion::Right => fly.right += step,
                Motion::Up => fly.up += step,
                Motion::Down => fly.up -= step,
                Motion::YawLeft => fly.yaw_degrees -= turn,
                Motion::YawRight => fly.yaw_degrees += turn,
                Motion::PitchUp => fly.pitch_degrees += turn,
                Motion::PitchDown => fly.pitch_degrees -= turn,
                Motion::RollLeft => fly.roll_degrees -= turn,
                Motion::RollRight => fly.roll_degrees += turn,
                Motion::Closer => zoom += ZOOM_PER_SECOND * seconds,
                Motion::Wider => zoom -= ZOOM_PER_SECOND * seconds,
            }
        }
        let flown = (fly != Fly::default()).then_some(Edit::Fly(fly));
        flown.into_iter().chain((zoom != 0.0).then(|| Edit::Zoom(zoom.exp()))).collect()
    }

    /// A drag with the main button over so many points of the screen, each of which shows `pixels` of the picture: what
    /// was under the pointer stays there.
    pub fn drag(&self, [x, y]: [f32; 2], pixels: f32, lens: &Lens) -> Option<Edit> {
        if x == 0.0 && y == 0.0 {
            return None;
        }
        Some(match self.mode {
            Mode::Fly => {
                let angle = lens.degrees_per_pixel * pixels;
                let degrees = if angle > 0.0 { angle } else { PARALLEL_DEGREES };
                Edit::Fly(Fly { yaw_degrees: -x * degrees, pitch_degrees: y * degrees, ..Fly::default() })
            }
            Mode::Orbit => {
                let (yaw_degrees, pitch_degrees) = (x * ORBIT_DEGREES, y * ORBIT_DEGREES);
                Edit::Orbit(Orbit { yaw_degrees, pitch_degrees, ..Orbit::default() })
            }
        })
    }

    /// A drag with Shift or the middle button: the point of interest stays under the pointer.
    pub fn slide(&self, [x, y]: [f32; 2], pixels: f32, lens: &Lens) -> Option<Edit> {
        let units = lens.units_per_pixel * pixels;
        (x != 0.0 || y != 0.0).then(|| Edit::Fly(Fly { right: -x * units, up: y * units, ..Fly::default() }))
    }

    /// The wheel, turned by so many points, away from the hand being positive.
    pub fn wheel(&self, points: f32) -> Option<Edit> {
        let factor = (points / WHEEL_POINTS).exp().clamp(0.1, 10.0);
        (points != 0.0).then(|| match self.mode {
            Mode::Fly => Edit::Zoom(factor),
            Mode::Orbit => Edit::Orbit(Orbit { closer: factor, ..Orbit::default() }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Lens = Lens { degrees_per_pixel: 0.1, units_per_pixel: 0.02, reach: 10.0 };

    fn flown(edit: Option<Edit>) -> Fly {
        match edit {
            Some(Edit::Fly(fly)) => fly,
            other => panic!("{other:?}"),
        }
    }

    fn only(mut edits: Vec<Edit>) -> Option<Edit> {
        assert_eq!(edits.len(), 1, "{edits:?}");
        edits.pop()
    }

    #[test]
    fn keys_zoom_and_fly_at_once() {
        let controls = Controls::default();
        let edits = controls.keys(&[Motion::Closer, Motion::Left], false, 0.05, 10.0);
        let [Edit::Fly(fly), Edit::Zoom(there)] = edits[..] else { panic!("{edits:?}") };
        let Some(Edit::Zoom(back)) = only(controls.keys(&[Motion::Wider], false, 0.05, 10.0)) else {
            panic!("no zoom")
        };
        assert!(fly.right < 0.0 && there > 1.0 && (there * back - 1.0).abs() < 1e-5);
    }

    #[test]
    fn speed_follows_the_scene_and_the_time() {
        let controls = Controls::default();
        let slow = flown(only(controls.keys(&[Motion::Forward], false, 0.02, 10.0)));
        assert_eq!(slow, Fly { forward: 0.02 * 10.0 * REACH_PER_SECOND, ..Fly::default() });
        let large = flown(only(controls.keys(&[Motion::Forward], false, 0.02, 1e6)));
        assert!((large.forward / slow.forward - 1e5).abs() < 1.0);
        let fast = flown(only(controls.keys(&[Motion::Forward], true, 0.02, 10.0)));
        assert!((fast.forward / slow.forward - FAST).abs() < 1e-4);
        let late = flown(only(controls.keys(&[Motion::YawLeft], false, 30.0, 10.0)));
        assert_eq!(late.yaw_degrees, -DEGREES_PER_SECOND * LONGEST_STEP);
    }

    #[test]
    fn keys_against_each_other_do_nothing() {
        let controls = Controls::default();
        assert_eq!(controls.keys(&[Motion::Left, Motion::Right], false, 0.02, 10.0), []);
        assert_eq!(controls.keys(&[Motion::Closer, Motion::Wider], false, 0.02, 10.0), []);
        assert_eq!(controls.keys(&[], false, 0.02, 10.0), []);
        let both = flown(only(controls.keys(&[Motion::Up, Motion::RollRight], false, 0.02, 10.0)));
        assert!(both.up > 0.0 && both.roll_degrees > 0.0 && both.right == 0.0);
    }

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        let fly = flown(Controls::default().drag([10.0, 4.0], 2.0, &LENS));
        assert!((fly.yaw_degrees + 2.0).abs() < 1e-4 && (fly.pitch_degrees - 0.8).abs() < 1e-4, "{fly:?}");
        let slide = flown(Controls::default().slide([10.0, 4.0], 2.0, &LENS));
        assert!((slide.right + 0.4).abs() < 1e-5 && (slide.up - 0.16).abs() < 1e-5, "{slide:?}");
        assert_eq!(Controls::default().drag([0.0, 0.0], 2.0, &LENS), None);
        let parallel = flown(Controls::default().drag([1.0, 0.0], 1.0, &Lens { degrees_per_pixel: 0.0, ..LENS }));
        assert!(parallel.yaw_degrees < 0.0);
    }

    #[test]
    fn orbiting_turns_the_scene() {
        let controls = Controls { mode: Mode::Fly.other(), ..Controls::default() };
        let Some(Edit::Orbit(orbit)) = controls.drag([20.0, 10.0], 2.0, &LENS) else { panic!("no orbit") };
        assert!(orbit.yaw_degrees > 0.0 && orbit.pitch_degrees > 0.0 && orbit.closer == 1.0);
        let Some(Edit::Orbit(closer)) = controls.wheel(40.0) else { panic!("no orbit") };
        assert!(closer.closer > 1.05 && closer.yaw_degrees == 0.0);
    }

    #[test]
    fn the_wheel_goes_back_and_forth() {
        let controls = Controls::default();
        let (Some(Edit::Zoom(there)), Some(Edit::Zoom(back))) = (controls.wheel(40.0), controls.wheel(-40.0)) else {
            panic!("no zoom")
        };
        assert!(there > 1.0 && (there * back - 1.0).abs() < 1e-5);
        assert_eq!(controls.wheel(0.0), None);
        assert_eq!(controls.wheel(1e9), Some(Edit::Zoom(10.0)));
    }

    #[test]
    fn speed_has_bounds() {
        let mut controls = Controls::default();
        controls.change_speed(2);
        assert_eq!(controls.speed, SPEED_STEP * SPEED_STEP);
        controls.change_speed(1000);
        assert_eq!(controls.speed, *Controls::SPEEDS.end());
    }
}
