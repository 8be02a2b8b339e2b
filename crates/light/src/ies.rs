//! The way a luminaire shines as it was measured: candelas by vertical angle, from straight down, and by horizontal
//! angle, counter-clockwise as seen from above (IES type C).

use super::photometry::{self, InvalidIes};
use super::{InvalidLight, check_direction};
use juggler_math::{Vec3, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// A photometric file (IES LM-63) that says how strongly a lamp shines into each direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Ies {
    /// The file, relative to the scene file. Its photometry is of type C.
    pub file: String,
    /// Where its vertical angle 0 points, any length; without it, that of a spot light is its own direction, and that of
    /// others points down, along -Y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// How far the luminaire is turned about that direction, counter-clockwise as seen from behind it; at 0 its
    /// horizontal angle 0 points along +X when it hangs down.
    #[serde(default)]
    pub rotation_degrees: f32,
    /// Whether its candelas count as they are, times the light's intensity; otherwise the greatest counts as 1.
    #[serde(default)]
    pub absolute: bool,
    /// What the file holds: clones share it.
    #[serde(skip)]
    profile: Option<Arc<Profile>>,
}

impl Ies {
    /// One whose file is to be given to [`Ies::load`] or [`Ies::set_profile`].
    pub fn from_file(file: impl Into<String>) -> Self {
        Self { file: file.into(), direction: None, rotation_degrees: 0.0, absolute: false, profile: None }
    }

    /// Takes what the file holds; an error names the line at fault.
    pub fn load(&mut self, text: &str) -> Result<(), InvalidIes> {
        self.profile = Some(Arc::new(Profile::read(text)?));
        Ok(())
    }

    /// What the file holds, once it is loaded.
    pub fn profile(&self) -> Option<&Arc<Profile>> {
        self.profile.as_ref()
    }

    /// Takes what the file holds, which lights may share.
    pub fn set_profile(&mut self, profile: Arc<Profile>) {
        self.profile = Some(profile);
    }

    /// Checks the numbers, not the file.
    pub(super) fn check(&self) -> Result<(), InvalidLight> {
        check_direction(self.direction.unwrap_or(Vec3::NEG_Y))
            .map_err(|invalid| InvalidLight { field: "ies.direction", ..invalid })?;
        super::in_range("ies.rotation_degrees", self.rotation_degrees, -1e4, 1e4)
    }

    /// The factor on light that leaves in a unit direction; `default` is where the vertical angle 0 points unless this
    /// says otherwise. Nothing while the file is not loaded.
    pub(super) fn share(&self, leaving: Vec3, default: Vec3) -> f32 {
        let Some(profile) = &self.profile else { return 0.0 };
        let down = self.direction.unwrap_or(default).normalize_or(Vec3::NEG_Y);
        let cos = leaving.dot(down).clamp(-1.0, 1.0);
        // From -Y to `down` the shortest way: what that turns +X and -Z into.
        let turned = |axis: Vec3| {
            let way = Vec3::NEG_Y.cross(down);
            let along = -down.y;
            if along < -0.9999 {
                Vec3::new(axis.x, 0.0, -axis.z)
            } else {
                axis * along + way.cross(axis) + way * (way.dot(axis) / (1.0 + along))
            }
        };
        let (x, y) = (leaving.dot(turned(Vec3::X)), leaving.dot(turned(Vec3::NEG_Z)));
        let horizontal = fun::atan2(y, x).to_degrees() - self.rotation_degrees;
        let value = profile.at(fun::acos(cos).to_degrees(), horizontal);
        if self.absolute { value } else { value / profile.greatest.max(f32::MIN_POSITIVE) }
    }

    /// The greatest [`Ies::share`].
    pub(super) fn greatest(&self) -> f32 {
        let greatest = self.profile.as_ref().map_or(0.0, |profile| profile.greatest);
        if self.absolute { greatest } else { f32::from(u8::from(greatest > 0.0)) }
    }
}

/// Candelas over all directions: what an IES file holds.
#[derive(Clone, PartialEq)]
pub struct Profile {
    /// Vertical angles in degrees, growing.
    vertical: Vec<f32>,
    /// Horizontal angles in degrees, growing, from 0 to 360.
    horizontal: Vec<f32>,
    /// Plane by plane.
    candelas: Vec<f32>,
    greatest: f32,
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {} candelas", self.vertical.len(), self.horizontal.len())
    }
}

impl Profile {
    /// Reads a file's text; an error names the line at fault.
    pub fn read(text: &str) -> Result<Self, InvalidIes> {
        photometry::read(text)
    }

    /// From planes of the horizontal angles that the file has, the others by symmetry; an error where they cover neither
    /// a quarter, a half nor the whole turn.
    pub(super) fn new(vertical: Vec<f32>, horizontal: &[f32], candelas: &[f32]) -> Result<Self, String> {
        let rows = vertical.len();
        let plane = |i: usize| candelas.get(i * rows..(i + 1) * rows).unwrap_or_default();
        let mut planes: Vec<(f32, &[f32])> =
            horizontal.iter().enumerate().map(|(i, angle)| (*angle, plane(i))).collect();
        let (first, last) = (horizontal.first().copied(), horizontal.last().copied());
        match (first, last) {
            (Some(_), Some(_)) if horizontal.len() == 1 => planes = vec![(0.0, plane(0)), (360.0, plane(0))],
            (Some(0.0), Some(90.0)) => {
                planes.extend(mirrored(&planes, 180.0));
                planes.extend(mirrored(&planes, 360.0));
            }
            (Some(0.0), Some(180.0)) => planes.extend(mirrored(&planes, 360.0)),
            // Mirrored at the plane through 90 and 270.
            (Some(90.0), Some(270.0)) => {
                let left: Vec<_> = planes.iter().filter(|(angle, _)| *angle <= 180.0).copied().collect();
                let right: Vec<_> = planes.iter().filter(|(angle, _)| *angle >= 180.0).copied().collect();
                planes.extend(mirrored(&left, 180.0));
                planes.extend(mirrored(&right, 540.0));
            }
            (Some(0.0), Some(last)) if last > 180.0 => planes.push((360.0, plane(0))),
            _ => {
                return Err(
                    "horizontal angles should be 0 alone, or go from 0 to 90, 180 or 360, or from 90 to 270".into()
                );
            }
        }
        planes.sort_by(|a, b| a.0.total_cmp(&b.0));
        planes.dedup_by(|a, b| a.0 == b.0);
        let greatest = candelas.iter().copied().fold(0.0, f32::max);
        let candelas = planes.iter().flat_map(|(_, plane)| plane.iter().copied()).collect();
        Ok(Self { vertical, horizontal: planes.iter().map(|(angle, _)| *angle).collect(), candelas, greatest })
    }

    /// The greatest value.
    #[cfg(test)]
    pub(super) fn greatest(&self) -> f32 {
        self.greatest
    }

    /// Candelas at angles in degrees, blended between those measured; none beyond the vertical ones.
    fn at(&self, vertical: f32, horizontal: f32) -> f32 {
        let (Some(first), Some(last)) = (self.vertical.first(), self.vertical.last()) else { return 0.0 };
        // What is measured to the end shines to the end; rounding of an angle must not make it dark.
        if vertical < first - 1e-3 || vertical > last + 1e-3 {
            return 0.0;
        }
        let (row, down) = between(&self.vertical, vertical);
        let (plane, round) = between(&self.horizontal, horizontal.rem_euclid(360.0));
        let rows = self.vertical.len();
        let value =
            |plane: usize, row: usize| self.candelas.get(plane * rows + row.min(rows - 1)).copied().unwrap_or(0.0);
        let line = |plane: usize| value(plane, row) + (value(plane, row + 1) - value(plane, row)) * down;
        (line(plane) + (line(plane + 1) - line(plane)) * round).max(0.0)
    }
}

/// Planes mirrored so that their angles and the new ones have this sum.
fn mirrored<'a>(planes: &[(f32, &'a [f32])], sum: f32) -> Vec<(f32, &'a [f32])> {
    planes.iter().map(|(angle, plane)| (sum - angle, *plane)).collect()
}

/// The last of growing numbers that is not above `value`, and how far it is to the next one, from 0 to 1.
fn between(numbers: &[f32], value: f32) -> (usize, f32) {
    let index = numbers.partition_point(|number| *number <= value).clamp(1, numbers.len().max(2) - 1) - 1;
    match (numbers.get(index), numbers.get(index + 1)) {
        (Some(low), Some(high)) => (index, ((value - low) / (high - low)).clamp(0.0, 1.0)),
        _ => (index, 0.0),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A lamp that shines down and to one side.
    pub fn lamp() -> Ies {
        let mut ies = Ies::from_file("lamp.ies");
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 4 1 2 0 0 0\n1 1 20\n0 30 90 120\n0 90 180 270\n\
            100 80 20 5\n100 60 10 0\n100 40 5 0\n100 60 30 1\n";
        ies.load(text).unwrap();
        ies
    }

    fn profile(horizontal: &[f32], candelas: &[f32]) -> Profile {
        Profile::new(vec![0.0, 90.0], horizontal, candelas).unwrap()
    }

    #[test]
    fn symmetric_planes_are_expanded() {
        let round = profile(&[0.0], &[8.0, 4.0]);
        assert!([0.0, 77.0, 359.0, -10.0].iter().all(|h| round.at(45.0, *h) == 6.0) && round.at(90.5, 0.0) == 0.0);
        let quarter = profile(&[0.0, 45.0, 90.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        for (angle, value) in
            [(0.0, 1.0), (45.0, 2.0), (90.0, 3.0), (135.0, 2.0), (180.0, 1.0), (225.0, 2.0), (300.0, 7.0 / 3.0)]
        {
            assert!((quarter.at(90.0, angle) - value).abs() < 1e-5, "{angle}");
        }
        let half = profile(&[0.0, 180.0], &[0.0, 1.0, 0.0, 3.0]);
        assert!((half.at(90.0, 90.0) - 2.0).abs() < 1e-5 && (half.at(90.0, 270.0) - 2.0).abs() < 1e-5);
        let side = profile(&[90.0, 180.0, 270.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        for (angle, value) in [(0.0, 2.0), (90.0, 1.0), (180.0, 2.0), (270.0, 3.0), (45.0, 1.5), (315.0, 2.5)] {
            assert!((side.at(90.0, angle) - value).abs() < 1e-5, "{angle} {}", side.at(90.0, angle));
        }
        let whole = profile(&[0.0, 120.0, 240.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        assert!((whole.at(90.0, 300.0) - 2.0).abs() < 1e-5 && (whole.at(90.0, 360.0) - 1.0).abs() < 1e-5);
        assert!(Profile::new(vec![0.0], &[0.0, 77.0], &[1.0, 1.0]).is_err());
        assert_eq!(Profile::new(vec![0.0], &[0.0], &[5.0]).unwrap().at(0.0, 12.0), 5.0);
    }

    #[test]
    fn angles_lie_as_documented() {
        let mut ies = lamp();
        let (sin, cos) = fun::sin_cos(30f32.to_radians());
        let at = |ies: &Ies, x: f32, z: f32| ies.share(Vec3::new(x * sin, -cos, z * sin), Vec3::NEG_Y);
        for (x, z, value) in [(1.0, 0.0, 0.8), (0.0, -1.0, 0.6), (-1.0, 0.0, 0.4), (0.0, 1.0, 0.6)] {
            assert!((at(&ies, x, z) - value).abs() < 1e-5, "{x} {z} {}", at(&ies, x, z));
        }
        assert_eq!((ies.share(Vec3::NEG_Y, Vec3::NEG_Y), ies.share(Vec3::Y, Vec3::NEG_Y)), (1.0, 0.0));
        ies.rotation_degrees = 90.0;
        assert!((at(&ies, 0.0, -1.0) - 0.8).abs() < 1e-5);
        ies.absolute = true;
        assert!((at(&ies, 0.0, -1.0) - 80.0).abs() < 1e-3);
        // Turned to shine along +X, its +X becomes +Y.
        let side = Ies { direction: Some(Vec3::X * 2.0), ..lamp() };
        assert!((side.share(Vec3::new(cos, sin, 0.0), Vec3::NEG_Y) - 0.8).abs() < 1e-5);
        assert!((side.share(Vec3::new(cos, 0.0, -sin), Vec3::NEG_Y) - 0.6).abs() < 1e-5);
        let up = Ies { direction: Some(Vec3::Y), ..lamp() };
        assert!((up.share(Vec3::new(sin, cos, 0.0), Vec3::NEG_Y) - 0.8).abs() < 1e-5);
    }
}
