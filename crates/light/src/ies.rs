//! Measured distribution of a luminaire: candelas by vertical angle, from straight down, and by
//! horizontal angle, counterclockwise as seen from above (IES type C).

use super::photometry::{self, InvalidIes};
use super::{InvalidLight, check_direction};
use juggler_math::{Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// Photometric file (IES LM-63): the measured distribution of a luminaire's intensity over
/// directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Ies {
    /// Path of the file, relative to the scene file. Its photometry must be of type C.
    pub file: String,
    /// Direction of vertical angle 0, of any length. The default is the direction of a spot light,
    /// and straight down, along -Y, for other lights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// Rotation of the luminaire about that direction, in degrees from -10,000 to 10,000,
    /// counterclockwise as seen from behind the luminaire. At 0, the horizontal angle 0 points
    /// along +X if the luminaire hangs down.
    #[serde(default)]
    #[schemars(range(min = -10000, max = 10000), extend("x-unit" = "degrees"))]
    pub rotation_degrees: f32,
    /// Whether the intensity is multiplied by the file's candelas. By default it is multiplied by
    /// the candelas relative to their maximum, so that the file changes only the distribution.
    #[serde(default)]
    pub absolute: bool,
    /// Data of the file, shared by clones.
    #[serde(skip)]
    profile: Option<Arc<IesProfile>>,
}

impl Ies {
    /// Creates a light distribution without data; see [`Ies::load`] and [`Ies::set_profile`].
    pub fn from_file(file: impl Into<String>) -> Self {
        Self { file: file.into(), direction: None, rotation_degrees: 0.0, absolute: false, profile: None }
    }

    /// Parses the text of the file. The error names the line at fault.
    pub fn load(&mut self, text: &str) -> Result<(), InvalidIes> {
        self.profile = Some(Arc::new(IesProfile::parse(text)?));
        Ok(())
    }

    /// Data of the file; `None` before it is loaded.
    pub fn profile(&self) -> Option<&Arc<IesProfile>> {
        self.profile.as_ref()
    }

    /// Sets the data of the file, which several lights may share.
    pub fn set_profile(&mut self, profile: Arc<IesProfile>) {
        self.profile = Some(profile);
    }

    /// Checks the fields, not the file.
    pub(super) fn check(&self) -> Result<(), InvalidLight> {
        check_direction(self.direction.unwrap_or(Vec3::NEG_Y))
            .map_err(|invalid| InvalidLight { field: "ies.direction", ..invalid })?;
        super::in_range("ies.rotation_degrees", self.rotation_degrees, -1e4, 1e4)
    }

    /// Factor on the intensity in the unit direction `leaving`. `default` is the direction of
    /// vertical angle 0 if the description has none. 0 before the file is loaded.
    pub(super) fn factor(&self, leaving: Vec3, default: Vec3) -> f32 {
        let Some(profile) = &self.profile else { return 0.0 };
        let down = self.direction.unwrap_or(default).normalize_or(Vec3::NEG_Y);
        let cos = leaving.dot(down).clamp(-1.0, 1.0);
        // Rotate +X and -Z by the shortest rotation from -Y to `down`.
        let rotate = |v: Vec3| {
            let axis = Vec3::NEG_Y.cross(down);
            let cos_angle = -down.y;
            if cos_angle < -0.9999 {
                Vec3::new(v.x, 0.0, -v.z)
            } else {
                v * cos_angle + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cos_angle))
            }
        };
        let (x, y) = (leaving.dot(rotate(Vec3::X)), leaving.dot(rotate(Vec3::NEG_Z)));
        let horizontal = portable::atan2(y, x).to_degrees() - self.rotation_degrees;
        let value = profile.candelas_at(portable::acos(cos).to_degrees(), horizontal);
        if self.absolute { value } else { value / profile.max_candelas.max(f32::MIN_POSITIVE) }
    }

    /// Maximum of [`Ies::factor`] over all directions.
    pub(super) fn max_factor(&self) -> f32 {
        let max_candelas = self.profile.as_ref().map_or(0.0, |profile| profile.max_candelas);
        if self.absolute { max_candelas } else { f32::from(u8::from(max_candelas > 0.0)) }
    }
}

/// Intensity in candelas over all directions: the data of an IES file.
#[derive(Clone, PartialEq)]
pub struct IesProfile {
    /// Vertical angles in degrees, increasing.
    vertical: Vec<f32>,
    /// Horizontal angles in degrees, increasing from 0 to 360.
    horizontal: Vec<f32>,
    /// Candelas by horizontal angle, then by vertical angle: `horizontal.len() × vertical.len()`
    /// values.
    candelas: Vec<f32>,
    max_candelas: f32,
}

impl fmt::Debug for IesProfile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {} candelas", self.vertical.len(), self.horizontal.len())
    }
}

impl IesProfile {
    /// Parses the text of a file. The error names the line at fault.
    pub fn parse(text: &str) -> Result<Self, InvalidIes> {
        photometry::parse(text)
    }

    /// Creates a profile from the planes of the file's horizontal angles; symmetry gives the
    /// others. Returns an error unless the planes cover a quarter turn, a half turn or a full turn.
    pub(super) fn from_planes(vertical: Vec<f32>, horizontal: &[f32], candelas: &[f32]) -> Result<Self, String> {
        let rows = vertical.len();
        let plane = |i: usize| candelas.get(i * rows..(i + 1) * rows).unwrap_or_default();
        let mut planes: Vec<(f32, &[f32])> =
            horizontal.iter().enumerate().map(|(i, angle)| (*angle, plane(i))).collect();
        let (first, last) = (horizontal.first().copied(), horizontal.last().copied());
        match (first, last) {
            (Some(_), Some(_)) if horizontal.len() == 1 => planes = vec![(0.0, plane(0)), (360.0, plane(0))],
            (Some(0.0), Some(90.0)) => {
                planes.extend(reflect_planes(&planes, 180.0));
                planes.extend(reflect_planes(&planes, 360.0));
            }
            (Some(0.0), Some(180.0)) => planes.extend(reflect_planes(&planes, 360.0)),
            // Reflect at the plane through 90 and 270.
            (Some(90.0), Some(270.0)) => {
                let left: Vec<_> = planes.iter().filter(|(angle, _)| *angle <= 180.0).copied().collect();
                let right: Vec<_> = planes.iter().filter(|(angle, _)| *angle >= 180.0).copied().collect();
                planes.extend(reflect_planes(&left, 180.0));
                planes.extend(reflect_planes(&right, 540.0));
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
        let max_candelas = candelas.iter().copied().fold(0.0, f32::max);
        let candelas = planes.iter().flat_map(|(_, plane)| plane.iter().copied()).collect();
        Ok(Self { vertical, horizontal: planes.iter().map(|(angle, _)| *angle).collect(), candelas, max_candelas })
    }

    /// Maximum of the candelas.
    #[cfg(test)]
    pub(super) fn max_candelas(&self) -> f32 {
        self.max_candelas
    }

    /// Candelas at angles in degrees, by bilinear interpolation; 0 outside the range of vertical
    /// angles.
    fn candelas_at(&self, vertical: f32, horizontal: f32) -> f32 {
        let (Some(first), Some(last)) = (self.vertical.first(), self.vertical.last()) else { return 0.0 };
        // Allow for rounding of the angle at both ends of the range.
        if vertical < first - 1e-3 || vertical > last + 1e-3 {
            return 0.0;
        }
        let (row, down) = interval(&self.vertical, vertical);
        let (plane, round) = interval(&self.horizontal, horizontal.rem_euclid(360.0));
        let rows = self.vertical.len();
        let value =
            |plane: usize, row: usize| self.candelas.get(plane * rows + row.min(rows - 1)).copied().unwrap_or(0.0);
        let line = |plane: usize| value(plane, row) + (value(plane, row + 1) - value(plane, row)) * down;
        (line(plane) + (line(plane + 1) - line(plane)) * round).max(0.0)
    }
}

/// Reflects planes: the angle of a plane and that of its reflection add up to `sum`.
fn reflect_planes<'a>(planes: &[(f32, &'a [f32])], sum: f32) -> Vec<(f32, &'a [f32])> {
    planes.iter().map(|(angle, plane)| (sum - angle, *plane)).collect()
}

/// Index of the last of the increasing `numbers` that is not above `value`, and the fraction of the
/// interval to the next number, from 0 to 1.
fn interval(numbers: &[f32], value: f32) -> (usize, f32) {
    let index = numbers.partition_point(|number| *number <= value).clamp(1, numbers.len().max(2) - 1) - 1;
    match (numbers.get(index), numbers.get(index + 1)) {
        (Some(low), Some(high)) => (index, ((value - low) / (high - low)).clamp(0.0, 1.0)),
        _ => (index, 0.0),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Luminaire that emits downward and to one side.
    pub fn luminaire() -> Ies {
        let mut ies = Ies::from_file("luminaire.ies");
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 4 1 2 0 0 0\n1 1 20\n0 30 90 120\n0 90 180 270\n\
            100 80 20 5\n100 60 10 0\n100 40 5 0\n100 60 30 1\n";
        ies.load(text).unwrap();
        ies
    }

    fn profile(horizontal: &[f32], candelas: &[f32]) -> IesProfile {
        IesProfile::from_planes(vec![0.0, 90.0], horizontal, candelas).unwrap()
    }

    #[test]
    fn symmetric_planes_are_expanded() {
        let round = profile(&[0.0], &[8.0, 4.0]);
        assert!(
            [0.0, 77.0, 359.0, -10.0].iter().all(|h| round.candelas_at(45.0, *h) == 6.0)
                && round.candelas_at(90.5, 0.0) == 0.0
        );
        let quarter = profile(&[0.0, 45.0, 90.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        for (angle, value) in
            [(0.0, 1.0), (45.0, 2.0), (90.0, 3.0), (135.0, 2.0), (180.0, 1.0), (225.0, 2.0), (300.0, 7.0 / 3.0)]
        {
            assert!((quarter.candelas_at(90.0, angle) - value).abs() < 1e-5, "{angle}");
        }
        let half = profile(&[0.0, 180.0], &[0.0, 1.0, 0.0, 3.0]);
        assert!(
            (half.candelas_at(90.0, 90.0) - 2.0).abs() < 1e-5 && (half.candelas_at(90.0, 270.0) - 2.0).abs() < 1e-5
        );
        let side = profile(&[90.0, 180.0, 270.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        for (angle, value) in [(0.0, 2.0), (90.0, 1.0), (180.0, 2.0), (270.0, 3.0), (45.0, 1.5), (315.0, 2.5)] {
            assert!((side.candelas_at(90.0, angle) - value).abs() < 1e-5, "{angle} {}", side.candelas_at(90.0, angle));
        }
        let whole = profile(&[0.0, 120.0, 240.0], &[0.0, 1.0, 0.0, 2.0, 0.0, 3.0]);
        assert!(
            (whole.candelas_at(90.0, 300.0) - 2.0).abs() < 1e-5 && (whole.candelas_at(90.0, 360.0) - 1.0).abs() < 1e-5
        );
        assert!(IesProfile::from_planes(vec![0.0], &[0.0, 77.0], &[1.0, 1.0]).is_err());
        assert_eq!(IesProfile::from_planes(vec![0.0], &[0.0], &[5.0]).unwrap().candelas_at(0.0, 12.0), 5.0);
    }

    #[test]
    fn angles_lie_as_documented() {
        let mut ies = luminaire();
        let (sin, cos) = portable::sin_cos(30f32.to_radians());
        let at = |ies: &Ies, x: f32, z: f32| ies.factor(Vec3::new(x * sin, -cos, z * sin), Vec3::NEG_Y);
        for (x, z, value) in [(1.0, 0.0, 0.8), (0.0, -1.0, 0.6), (-1.0, 0.0, 0.4), (0.0, 1.0, 0.6)] {
            assert!((at(&ies, x, z) - value).abs() < 1e-5, "{x} {z} {}", at(&ies, x, z));
        }
        assert_eq!((ies.factor(Vec3::NEG_Y, Vec3::NEG_Y), ies.factor(Vec3::Y, Vec3::NEG_Y)), (1.0, 0.0));
        ies.rotation_degrees = 90.0;
        assert!((at(&ies, 0.0, -1.0) - 0.8).abs() < 1e-5);
        ies.absolute = true;
        assert!((at(&ies, 0.0, -1.0) - 80.0).abs() < 1e-3);
        // With the vertical angle 0 along +X, the luminaire's +X becomes +Y.
        let side = Ies { direction: Some(Vec3::X * 2.0), ..luminaire() };
        assert!((side.factor(Vec3::new(cos, sin, 0.0), Vec3::NEG_Y) - 0.8).abs() < 1e-5);
        assert!((side.factor(Vec3::new(cos, 0.0, -sin), Vec3::NEG_Y) - 0.6).abs() < 1e-5);
        let up = Ies { direction: Some(Vec3::Y), ..luminaire() };
        assert!((up.factor(Vec3::new(sin, cos, 0.0), Vec3::NEG_Y) - 0.8).abs() < 1e-5);
    }
}
