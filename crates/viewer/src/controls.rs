//! Conversion of key presses and drags to edits, independent of the window.

use crate::keys::Motion;
use crate::pixel_extent::PixelExtent;
use juggler_session::{Edit, Fly, Orbit};

/// Rotation speed of the keys, in degrees per second.
const DEGREES_PER_SECOND: f32 = 60.0;
/// Zoom speed of the keys: logarithm of the factor per second.
const ZOOM_PER_SECOND: f32 = 1.0;
/// Factor of all three speeds while Shift is held.
const FAST: f32 = 4.0;
/// Factor of one press of a speed key.
const SPEED_STEP: f32 = 1.5;
/// Orbit angle of a drag, in degrees per point.
const ORBIT_DEGREES: f32 = 0.35;
/// Rotation of an orthographic camera by a drag, in degrees per point.
const PARALLEL_DEGREES: f32 = 0.15;
/// Scroll distance of a zoom by the factor e, in points.
const WHEEL_POINTS: f32 = 400.0;
/// Maximum time step, in seconds, which avoids jumps after a pause.
const LONGEST_STEP: f32 = 0.1;

/// Effect of a drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Rotates the camera about its own position.
    #[default]
    Fly,
    /// Rotates the camera about the point of interest.
    Orbit,
}

impl Mode {
    /// Returns the other mode.
    pub fn other(self) -> Self {
        match self {
            Self::Fly => Self::Orbit,
            Self::Orbit => Self::Fly,
        }
    }
}

/// Settings of camera navigation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Effect of a drag.
    pub mode: Mode,
    /// Factor of [`Status::flight_speed`](juggler_session::Status) of the keys.
    pub speed: f32,
}

impl Default for Controls {
    fn default() -> Self {
        Self { mode: Mode::default(), speed: 1.0 }
    }
}

impl Controls {
    /// Range of `speed`.
    pub const SPEEDS: std::ops::RangeInclusive<f32> = 0.01..=100.0;

    /// Increases the speed by some steps; negative steps decrease it.
    pub fn change_speed(&mut self, steps: i32) {
        self.speed = (self.speed * SPEED_STEP.powi(steps)).clamp(*Self::SPEEDS.start(), *Self::SPEEDS.end());
    }

    /// Returns the edits of keys that were held for some seconds; `flight_speed` is in scene units
    /// per second.
    pub fn keys(&self, held: &[Motion], fast: bool, seconds: f32, flight_speed: f32) -> Vec<Edit> {
        let seconds = seconds.min(LONGEST_STEP) * if fast { FAST } else { 1.0 };
        let mut zoom = 0.0;
        let (step, turn) = (flight_speed * self.speed * seconds, DEGREES_PER_SECOND * seconds);
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

    /// Returns the edit of a drag with the primary button over some points, each of which spans
    /// `pixels` image pixels. In fly mode, the content under the pointer follows it.
    pub fn drag(&self, [x, y]: [f32; 2], pixels: f32, extent: &PixelExtent) -> Option<Edit> {
        if x == 0.0 && y == 0.0 {
            return None;
        }
        Some(match self.mode {
            Mode::Fly => {
                let angle = extent.degrees_per_pixel * pixels;
                let degrees = if angle > 0.0 { angle } else { PARALLEL_DEGREES };
                Edit::Fly(Fly { yaw_degrees: -x * degrees, pitch_degrees: y * degrees, ..Fly::default() })
            }
            Mode::Orbit => {
                let (yaw_degrees, pitch_degrees) = (x * ORBIT_DEGREES, y * ORBIT_DEGREES);
                Edit::Orbit(Orbit { yaw_degrees, pitch_degrees, ..Orbit::default() })
            }
        })
    }

    /// Returns the edit of a drag with Shift or the middle button: the point of interest follows
    /// the pointer.
    pub fn pan(&self, [x, y]: [f32; 2], pixels: f32, extent: &PixelExtent) -> Option<Edit> {
        let units = extent.units_per_pixel * pixels;
        (x != 0.0 || y != 0.0).then(|| Edit::Fly(Fly { right: -x * units, up: y * units, ..Fly::default() }))
    }

    /// Returns the edit of a scroll by some points; positive values zoom in.
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

    const EXTENT: PixelExtent = PixelExtent { degrees_per_pixel: 0.1, units_per_pixel: 0.02 };

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
        assert_eq!(slow, Fly { forward: 10.0 * 0.02, ..Fly::default() });
        let large = flown(only(controls.keys(&[Motion::Forward], false, 0.02, 1e6)));
        assert!((large.forward / slow.forward - 1e5).abs() < 1.0);
        let fast = flown(only(controls.keys(&[Motion::Forward], true, 0.02, 10.0)));
        assert!((fast.forward / slow.forward - FAST).abs() < 1e-4);
        let late = flown(only(controls.keys(&[Motion::YawLeft], false, 30.0, 10.0)));
        assert_eq!(late.yaw_degrees, -DEGREES_PER_SECOND * LONGEST_STEP);
    }

    #[test]
    fn opposite_keys_cancel() {
        let controls = Controls::default();
        assert_eq!(controls.keys(&[Motion::Left, Motion::Right], false, 0.02, 10.0), []);
        assert_eq!(controls.keys(&[Motion::Closer, Motion::Wider], false, 0.02, 10.0), []);
        assert_eq!(controls.keys(&[], false, 0.02, 10.0), []);
        let both = flown(only(controls.keys(&[Motion::Up, Motion::RollRight], false, 0.02, 10.0)));
        assert!(both.up > 0.0 && both.roll_degrees > 0.0 && both.right == 0.0);
    }

    #[test]
    fn dragging_keeps_the_point_under_the_pointer() {
        let fly = flown(Controls::default().drag([10.0, 4.0], 2.0, &EXTENT));
        assert!((fly.yaw_degrees + 2.0).abs() < 1e-4 && (fly.pitch_degrees - 0.8).abs() < 1e-4, "{fly:?}");
        let pan = flown(Controls::default().pan([10.0, 4.0], 2.0, &EXTENT));
        assert!((pan.right + 0.4).abs() < 1e-5 && (pan.up - 0.16).abs() < 1e-5, "{pan:?}");
        assert_eq!(Controls::default().drag([0.0, 0.0], 2.0, &EXTENT), None);
        let parallel =
            flown(Controls::default().drag([1.0, 0.0], 1.0, &PixelExtent { degrees_per_pixel: 0.0, ..EXTENT }));
        assert!(parallel.yaw_degrees < 0.0);
    }

    #[test]
    fn orbiting_turns_the_scene() {
        let controls = Controls { mode: Mode::Fly.other(), ..Controls::default() };
        let Some(Edit::Orbit(orbit)) = controls.drag([20.0, 10.0], 2.0, &EXTENT) else { panic!("no orbit") };
        assert!(orbit.yaw_degrees > 0.0 && orbit.pitch_degrees > 0.0 && orbit.closer == 1.0);
        let Some(Edit::Orbit(closer)) = controls.wheel(40.0) else { panic!("no orbit") };
        assert!(closer.closer > 1.05 && closer.yaw_degrees == 0.0);
    }

    #[test]
    fn wheel_zoom_is_invertible_and_limited() {
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
