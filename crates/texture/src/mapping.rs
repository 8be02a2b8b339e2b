//! Placement of patterns: coordinate space, scale, rotation and offset.

use super::{InvalidTexture, Space, TextureLookup, check};
use juggler_math::{Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Placement of a pattern: with R the rotation, the point p of `space` shows the pattern at scale ·
/// R⁻¹ (p - offset).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mapping {
    /// Coordinate space of the pattern. Solid patterns (`noise`, `fbm`, `turbulence`, `marble`,
    /// `wood`, `voronoi`, `triplanar`) default to object space, all others to surface coordinates
    /// (u, v).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<Space>,
    /// Set of surface coordinates (u, v) of a mesh: 0 for `uvs`, 1 for `uvs1`. Surfaces without a
    /// second set use their first. Only for patterns over surface coordinates.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0, max = 1))]
    pub uv_set: u32,
    /// Units of the pattern per unit of `space`: 2 makes the pattern twice as fine. One number, or
    /// one for each axis of the pattern; not 0.
    pub scale: Scale,
    /// Rotation of the pattern about its origin, right-handed: first about x, then about y, then
    /// about z. Over (u, v), only the rotation about z is meaningful.
    #[schemars(extend("x-unit" = "degrees"))]
    pub rotate_degrees: [f32; 3],
    /// Position of the pattern's origin, in `space`.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "units of space"))]
    pub offset: Vec3,
    /// Affine map of surface coordinates to the pattern, in place of `scale`, `rotate_degrees` and
    /// `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v) shows the pattern at
    /// (a u + b v + c, d u + e v + f). Unlike the other settings, it can shear the pattern and
    /// rotate it after an uneven scale. `space` is then `uv`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrix: Option<[f32; 6]>,
}

/// One factor, or one for each axis, all different from 0. Negative factors mirror the pattern.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scale {
    /// Same factor along all axes.
    Even(f32),
    /// Factors along x, y and z.
    Each([f32; 3]),
}

/// Whether the first set of surface coordinates is meant.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(set: &u32) -> bool {
    *set == 0
}

impl Default for Scale {
    fn default() -> Self {
        Self::Even(1.0)
    }
}

impl Mapping {
    /// Mapping of a pattern in a coordinate space, otherwise with defaults.
    pub fn in_space(space: Space) -> Self {
        Self { space: Some(space), ..Self::default() }
    }

    /// Checks all values.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        if self.uv_set > 1 {
            let message = format!("`uv_set` must be 0 or 1, it is {}", self.uv_set);
            return Err(InvalidTexture::new("uv_set", message));
        }
        if self.uv_set == 1 && self.space.is_some_and(|space| space != Space::Uv) {
            let message = "`uv_set` chooses surface coordinates, so `space` must be `uv`";
            return Err(InvalidTexture::new("uv_set", message));
        }
        if let Some(matrix) = &self.matrix {
            return self.check_matrix(matrix);
        }
        let scale = self.factors().abs();
        if !(scale.min_element() >= 1e-18 && scale.max_element() <= 1e18) {
            return Err(InvalidTexture::new("scale", "`scale` must not be 0, and at most 1e18 in magnitude"));
        }
        check::vector("rotate_degrees", self.rotate_degrees.into())?;
        check::vector("offset", self.offset)
    }

    /// Checks a matrix, and that no setting is given that it replaces.
    fn check_matrix(&self, matrix: &[f32; 6]) -> Result<(), InvalidTexture> {
        let invalid = |message: &str| Err(InvalidTexture::new("matrix", message));
        let replaced = (self.scale, self.rotate_degrees, self.offset);
        if replaced != (Scale::default(), [0.0; 3], Vec3::ZERO) {
            return invalid("`matrix` replaces `scale`, `rotate_degrees` and `offset`; remove these or `matrix`");
        }
        if self.space.is_some_and(|space| space != Space::Uv) {
            return invalid("`matrix` maps surface coordinates, so `space` must be `uv`");
        }
        if !matrix.iter().all(|number| number.abs() <= 1e18) {
            return invalid("the numbers of `matrix` must be finite and at most 1e18 in magnitude");
        }
        Ok(())
    }

    fn factors(&self) -> Vec3 {
        match self.scale {
            Scale::Even(factor) => Vec3::splat(factor),
            Scale::Each(factors) => factors.into(),
        }
    }

    /// Coordinate space of the pattern; `default` if the scene does not set it. A matrix implies
    /// surface coordinates.
    pub(super) fn space_or(&self, default: Space) -> Space {
        if self.matrix.is_some() { Space::Uv } else { self.space.unwrap_or(default) }
    }

    /// Mapping for lookups; `default` is the coordinate space if the scene does not set it.
    pub(super) fn compile(&self, default: Space) -> CompiledMapping {
        if let Some(matrix) = self.matrix {
            return CompiledMapping::from_matrix(matrix, self.uv_set == 1);
        }
        let [x, y, z] = self.rotate_degrees.map(|degrees| portable::sin_cos_turns(degrees / 360.0));
        // Rotate about x, y and z.
        let turn = |v: Vec3| {
            let v = Vec3::new(v.x, v.y * x.1 - v.z * x.0, v.y * x.0 + v.z * x.1);
            let v = Vec3::new(v.x * y.1 + v.z * y.0, v.y, v.z * y.1 - v.x * y.0);
            Vec3::new(v.x * z.1 - v.y * z.0, v.x * z.0 + v.y * z.1, v.z)
        };
        let factors = self.factors();
        CompiledMapping {
            space: self.space_or(default),
            second_set: self.uv_set == 1,
            rows: [turn(Vec3::X) * factors.x, turn(Vec3::Y) * factors.y, turn(Vec3::Z) * factors.z],
            offset: self.offset,
            max_scale: factors.abs().max_element(),
        }
    }
}

/// Compiled form of a [`Mapping`].
#[derive(Clone, Copy, Debug)]
pub struct CompiledMapping {
    pub space: Space,
    /// Whether `uvs1` replaces the surface coordinates.
    second_set: bool,
    rows: [Vec3; 3],
    offset: Vec3,
    /// Largest factor on lengths from `space` to the pattern.
    max_scale: f32,
}

/// Point of a pattern with its footprint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatternPoint {
    /// Point in units of the pattern; finite.
    pub point: Vec3,
    /// Diameter of the footprint in units of the pattern; 0 for a point.
    pub width: f32,
}

impl PatternPoint {
    /// Point without a footprint.
    #[cfg(test)]
    pub fn unfiltered(point: Vec3) -> Self {
        Self { point, width: 0.0 }
    }
}

impl CompiledMapping {
    /// Affine map of surface coordinates (u, v), which are the points (u, v, 0).
    fn from_matrix([a, b, c, d, e, f]: [f32; 6], second_set: bool) -> Self {
        // The offset moves all points to z = 1, so that c and f translate, whether or not the map
        // is invertible.
        let (rows, offset) = ([Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::ZERO], Vec3::new(0.0, 0.0, -1.0));
        Self { space: Space::Uv, second_set, rows, offset, max_scale: largest_singular_value([a, b, d, e]) }
    }

    /// Point of the pattern for a lookup, without a footprint if the lookup is unfiltered.
    pub fn pattern_point(&self, at: &TextureLookup) -> PatternPoint {
        if at.unfiltered {
            PatternPoint { point: self.point(self.source(at).0), width: 0.0 }
        } else {
            self.filtered_point(at)
        }
    }

    /// Point of the pattern for a lookup, always with its footprint.
    pub fn filtered_point(&self, at: &TextureLookup) -> PatternPoint {
        let (point, footprint) = self.source(at);
        let point = self.point(point);
        // `max` turns NaN into 0.
        let width = (footprint * self.max_scale).max(0.0);
        PatternPoint { point, width: if width.is_finite() { width } else { 0.0 } }
    }

    /// Point and footprint of a lookup in `space`.
    #[inline]
    fn source(&self, at: &TextureLookup) -> (Vec3, f32) {
        if self.second_set && self.space == Space::Uv {
            let (uv, footprint) = at.second_uv();
            return (uv.extend(0.0), footprint);
        }
        (at.point(self.space), at.footprint_in(self.space))
    }

    /// Point of `space` in pattern coordinates; the origin if the result is not finite.
    pub fn point(&self, p: Vec3) -> Vec3 {
        let p = p - self.offset;
        let point = Vec3::new(self.rows[0].dot(p), self.rows[1].dot(p), self.rows[2].dot(p));
        if point.is_finite() { point } else { Vec3::ZERO }
    }

    /// Unit vector of `space` in pattern coordinates, again of unit length.
    pub fn direction(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.rows.map(Vec3::normalize_or_zero);
        Vec3::new(x.dot(v), y.dot(v), z.dot(v))
    }
}

/// Largest singular value of the matrix [a b; d e]: the largest factor on lengths. The map is the
/// sum of a rotation and a reflection, each times a factor (Blinn, Consider the Lowly 2 x 2 Matrix,
/// 1996); the result is the sum of both factors.
fn largest_singular_value(matrix: [f32; 4]) -> f32 {
    let [a, b, d, e] = matrix.map(f64::from);
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    (0.5 * (length(a + e, d - b) + length(a - e, d + b))) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Vec2;
    use juggler_math::testing::{Random, close3};

    fn map(json: &str) -> CompiledMapping {
        let mapping: Mapping = serde_json::from_str(json).unwrap();
        mapping.check().unwrap();
        mapping.compile(Space::Uv)
    }

    #[test]
    fn mapping_applies_scale_rotation_and_offset() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(map("{}").point(p), p);
        assert_eq!(map(r#"{"scale": 2, "offset": [1, 0, 0]}"#).point(p), Vec3::new(0.0, 4.0, 6.0));
        assert_eq!(map(r#"{"scale": [1, 10, -1]}"#).point(p), Vec3::new(1.0, 20.0, -3.0));
        // A quarter turn about z points the pattern's x axis along y.
        let quarter = map(r#"{"rotate_degrees": [0, 0, 90], "scale": [5, 1, 1], "offset": [1, 1, 1]}"#);
        assert!(close3(quarter.point(Vec3::new(1.0, 2.0, 1.0)), Vec3::X * 5.0, 1e-6));
        // The rotations take y to z about x, z to x about y, then x to y about z.
        let three = map(r#"{"rotate_degrees": [90, 90, 90]}"#);
        assert!(close3(three.point(Vec3::Y), Vec3::Y, 1e-6), "{:?}", three.point(Vec3::Y));
        assert!(close3(three.point(Vec3::X), Vec3::Z, 1e-6) && close3(three.point(-Vec3::Z), Vec3::X, 1e-6));
    }

    #[test]
    fn filter_widths_grow_with_scale_and_stay_finite() {
        let at = TextureLookup {
            uv: Vec2::new(0.5, f32::NAN),
            local: Vec3::splat(1e38),
            world: Vec3::splat(2.0),
            footprint: 0.5,
            local_footprint: f32::NAN,
            uv_footprint: f32::INFINITY,
            ..TextureLookup::default()
        };
        let scaled = Mapping { scale: Scale::Each([1.0, -4.0, 2.0]), ..Mapping::default() };
        let pattern = |space| scaled.compile(space).pattern_point(&at);
        assert_eq!(pattern(Space::World), PatternPoint { point: Vec3::new(2.0, -8.0, 4.0), width: 2.0 });
        assert_eq!(pattern(Space::Uv), PatternPoint::default());
        assert_eq!(pattern(Space::Local), PatternPoint::default());
    }

    /// The transform of `KHR_texture_transform` (offset, rotation, scale; v points down) as the
    /// matrix of a pattern whose v points up.
    #[test]
    fn matrix_agrees_with_the_texture_transform_of_gltf() {
        let mut random = Random::new(2025);
        for case in 0..1000 {
            let mut draw = |limit: f32| f64::from(random.range(-limit, limit));
            let ([ox, oy], r, [mut sx, sy]) = ([draw(3.0), draw(3.0)], draw(7.0), [draw(5.0), draw(5.0)]);
            if case % 10 == 0 {
                sx = 0.0;
            }
            let (sin, cos) = r.sin_cos();
            let matrix = [sx * cos, -sy * sin, ox + sy * sin, sx * sin, sy * cos, 1.0 - oy - sy * cos];
            let mapping = Mapping { matrix: Some(matrix.map(|number| number as f32)), ..Mapping::default() };
            mapping.check().unwrap();
            let compiled = mapping.compile(Space::Local);
            let (u, v) = (draw(2.0), draw(2.0));
            let uv = Vec2::new(u as f32, v as f32);
            let found = compiled.pattern_point(&TextureLookup { uv, uv_footprint: 0.25, ..TextureLookup::default() });
            // T · R · S of the extension's README in coordinates whose v points down.
            let (u, down) = (sx * u, sy * (1.0 - v));
            let expected = [ox + cos * u + sin * down, 1.0 - (oy - sin * u + cos * down)];
            let off = [f64::from(found.point.x) - expected[0], f64::from(found.point.y) - expected[1]];
            assert!(
                off.iter().all(|off| off.abs() < 2e-5) && found.point.z == 0.0,
                "{mapping:?} {found:?} {expected:?}"
            );
            // A rotation keeps lengths, so the larger scale is the largest factor on them.
            let width = 0.25 * sx.abs().max(sy.abs());
            assert!((f64::from(found.width) - width).abs() < 1e-5, "{mapping:?}: {} {width}", found.width);
        }
    }

    #[test]
    fn footprints_under_a_matrix_are_as_wide_as_the_longest_image_of_a_unit_vector() {
        let mut random = Random::new(2026);
        for _ in 0..200 {
            let matrix: [f32; 6] = std::array::from_fn(|_| random.range(-4.0, 4.0));
            let compiled = Mapping { matrix: Some(matrix), ..Mapping::default() }.compile(Space::Uv);
            let origin = compiled.point(Vec3::ZERO);
            let lengths = (0..20_000).map(|step| {
                let (sin, cos) = portable::sin_cos_turns(step as f32 / 20_000.0);
                (compiled.point(Vec3::new(cos, sin, 0.0)) - origin).length()
            });
            let longest = lengths.fold(0.0, f32::max);
            assert!((longest - compiled.max_scale).abs() < 1e-5 * compiled.max_scale, "{matrix:?}: {longest}");
        }
    }

    #[test]
    fn matrix_may_be_singular_and_huge() {
        let flat = map(r#"{"matrix": [0, 0, 0.25, 2, 4, 0.5]}"#);
        assert_eq!(flat.point(Vec3::new(1.0, 2.0, 0.0)), Vec3::new(0.25, 10.5, 0.0));
        assert_eq!(map(r#"{"matrix": [0, 0, 0, 0, 0, 0]}"#).max_scale, 0.0);
        let huge = map(r#"{"matrix": [1e18, 1e18, 1e18, 1e18, 1e18, 1e18]}"#);
        let at = TextureLookup { uv: Vec2::splat(1e30), uv_footprint: 1e30, ..TextureLookup::default() };
        assert_eq!(huge.pattern_point(&at), PatternPoint::default());
        // Solid patterns with a matrix lie over surface coordinates, too.
        assert_eq!(Mapping { matrix: Some([1.0; 6]), ..Mapping::default() }.space_or(Space::Local), Space::Uv);
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [
            (r#"{"scale": 0}"#, "scale"),
            (r#"{"scale": [1, 0, 1]}"#, "scale"),
            (r#"{"rotate_degrees": [0, 1e39, 0]}"#, "rotate_degrees"),
            (r#"{"offset": [0, 1e39, 0]}"#, "offset"),
            (r#"{"matrix": [1, 0, 0, 0, 1, 0], "scale": 2}"#, "matrix"),
            (r#"{"matrix": [1, 0, 0, 0, 1, 0], "rotate_degrees": [0, 0, 90]}"#, "matrix"),
            (r#"{"matrix": [1, 0, 0, 0, 1, 0], "offset": [1, 0, 0]}"#, "matrix"),
            (r#"{"matrix": [1, 0, 0, 0, 1, 0], "space": "world"}"#, "matrix"),
            (r#"{"matrix": [1, 0, 0, 0, 1, 1e39]}"#, "matrix"),
        ] {
            assert_eq!(serde_json::from_str::<Mapping>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
