//! Where a pattern lies: which coordinates, how large, how turned, where its origin is.

use super::{InvalidTexture, Lookup, Space, check};
use juggler_math::{Vec3, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a pattern lies. A point p of `space` sees the pattern at scale · turn⁻¹ (p − offset).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mapping {
    /// Coordinates in which the pattern lies. Solid patterns (`noise`, `fbm`, `turbulence`, `marble`, `wood`, `voronoi`,
    /// `triplanar`) lie in object space by default, all others in surface coordinates (u, v).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<Space>,
    /// How many units of the pattern fit in one unit of `space`: 2 makes it twice as fine. One number, or one for each
    /// axis of the pattern.
    pub scale: Scale,
    /// Turns the pattern about its origin, right-handed: first about x, then about y, then about z. Over (u, v) only the
    /// last makes sense.
    pub rotate_degrees: [f32; 3],
    /// Where the pattern's origin lies, in `space`.
    #[schemars(with = "[f32; 3]")]
    pub offset: Vec3,
}

/// A factor, or one for each axis; none may be 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scale {
    /// The same along all axes.
    Even(f32),
    /// Along x, y and z.
    Each([f32; 3]),
}

impl Default for Scale {
    fn default() -> Self {
        Self::Even(1.0)
    }
}

impl Mapping {
    /// Of a pattern in that space, all else as it is.
    pub fn of(space: Space) -> Self {
        Self { space: Some(space), ..Self::default() }
    }

    /// Checks numbers.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        let scale = self.factors().abs();
        if !(scale.min_element() >= 1e-18 && scale.max_element() <= 1e18) {
            return Err(InvalidTexture::new("scale", "`scale` must not be 0 and its size at most 1e18"));
        }
        check::vector("rotate_degrees", self.rotate_degrees.into())?;
        check::vector("offset", self.offset)
    }

    fn factors(&self) -> Vec3 {
        match self.scale {
            Scale::Even(factor) => Vec3::splat(factor),
            Scale::Each(factors) => factors.into(),
        }
    }

    /// The coordinates in which the pattern lies; `default` where the scene does not say.
    pub(super) fn space_or(&self, default: Space) -> Space {
        self.space.unwrap_or(default)
    }

    /// The mapping as lookups use it, in the space `default` where the scene does not say.
    pub(super) fn compile(&self, default: Space) -> Map {
        let [x, y, z] = self.rotate_degrees.map(|degrees| fun::sin_cos_turns(degrees / 360.0));
        // Where the pattern's axes point.
        let turn = |v: Vec3| {
            let v = Vec3::new(v.x, v.y * x.1 - v.z * x.0, v.y * x.0 + v.z * x.1);
            let v = Vec3::new(v.x * y.1 + v.z * y.0, v.y, v.z * y.1 - v.x * y.0);
            Vec3::new(v.x * z.1 - v.y * z.0, v.x * z.0 + v.y * z.1, v.z)
        };
        let factors = self.factors();
        Map {
            space: self.space_or(default),
            rows: [turn(Vec3::X) * factors.x, turn(Vec3::Y) * factors.y, turn(Vec3::Z) * factors.z],
            offset: self.offset,
            growth: factors.abs().max_element(),
        }
    }
}

/// A [`Mapping`] as numbers.
#[derive(Clone, Copy, Debug)]
pub struct Map {
    pub space: Space,
    rows: [Vec3; 3],
    offset: Vec3,
    /// How much longer a line may become on its way to the pattern.
    growth: f32,
}

/// A place in a pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// In the pattern's units; finite.
    pub point: Vec3,
    /// Diameter of the footprint in the pattern's units; 0 for a point.
    pub width: f32,
}

impl Place {
    /// A point alone.
    #[cfg(test)]
    pub fn sharp(point: Vec3) -> Self {
        Self { point, width: 0.0 }
    }
}

impl Map {
    /// Where a lookup meets the pattern.
    pub fn place(&self, at: &Lookup) -> Place {
        if at.sharp { Place { point: self.point(at.point(self.space)), width: 0.0 } } else { self.wide_place(at) }
    }

    /// The same for what is never sharp.
    pub fn wide_place(&self, at: &Lookup) -> Place {
        let point = self.point(at.point(self.space));
        // Not-a-number is no width either.
        let width = (at.footprint_in(self.space) * self.growth).max(0.0);
        Place { point, width: if width.is_finite() { width } else { 0.0 } }
    }

    /// A point of the space in the pattern's coordinates; the origin for one that has none.
    pub fn point(&self, p: Vec3) -> Vec3 {
        let p = p - self.offset;
        let point = Vec3::new(self.rows[0].dot(p), self.rows[1].dot(p), self.rows[2].dot(p));
        if point.is_finite() { point } else { Vec3::ZERO }
    }

    /// A unit vector of the space in the pattern's coordinates, unit again.
    pub fn direction(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.rows.map(Vec3::normalize_or_zero);
        Vec3::new(x.dot(v), y.dot(v), z.dot(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Vec2;
    use juggler_math::testing::close3;

    fn map(json: &str) -> Map {
        let mapping: Mapping = serde_json::from_str(json).unwrap();
        mapping.check().unwrap();
        mapping.compile(Space::Uv)
    }

    #[test]
    fn scale_turn_and_offset_place_the_pattern() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(map("{}").point(p), p);
        assert_eq!(map(r#"{"scale": 2, "offset": [1, 0, 0]}"#).point(p), Vec3::new(0.0, 4.0, 6.0));
        assert_eq!(map(r#"{"scale": [1, 10, -1]}"#).point(p), Vec3::new(1.0, 20.0, -3.0));
        // The pattern's x axis points along y after a quarter turn about z: what lies along y is at its x.
        let quarter = map(r#"{"rotate_degrees": [0, 0, 90], "scale": [5, 1, 1], "offset": [1, 1, 1]}"#);
        assert!(close3(quarter.point(Vec3::new(1.0, 2.0, 1.0)), Vec3::X * 5.0, 1e-6));
        // x to z about x, then z to x about y, then x to y about z.
        let three = map(r#"{"rotate_degrees": [90, 90, 90]}"#);
        assert!(close3(three.point(Vec3::Y), Vec3::Y, 1e-6), "{:?}", three.point(Vec3::Y));
        assert!(close3(three.point(Vec3::X), Vec3::Z, 1e-6) && close3(three.point(-Vec3::Z), Vec3::X, 1e-6));
    }

    #[test]
    fn widths_grow_with_the_scale_and_nothing_is_infinite() {
        let at = Lookup {
            uv: Vec2::new(0.5, f32::NAN),
            local: Vec3::splat(1e38),
            world: Vec3::splat(2.0),
            footprint: 0.5,
            local_footprint: f32::NAN,
            uv_footprint: f32::INFINITY,
            ..Lookup::default()
        };
        let scaled = Mapping { scale: Scale::Each([1.0, -4.0, 2.0]), ..Mapping::default() };
        let place = |space| scaled.compile(space).place(&at);
        assert_eq!(place(Space::World), Place { point: Vec3::new(2.0, -8.0, 4.0), width: 2.0 });
        assert_eq!(place(Space::Uv), Place::default());
        assert_eq!(place(Space::Local), Place::default());
    }

    #[test]
    fn says_what_is_wrong() {
        for (json, field) in [
            (r#"{"scale": 0}"#, "scale"),
            (r#"{"scale": [1, 0, 1]}"#, "scale"),
            (r#"{"rotate_degrees": [0, 1e39, 0]}"#, "rotate_degrees"),
            (r#"{"offset": [0, 1e39, 0]}"#, "offset"),
        ] {
            assert_eq!(serde_json::from_str::<Mapping>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
