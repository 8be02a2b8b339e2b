//! Meshes that are made by rule: no files, the same triangles everywhere. One kind is one file and two lines here.

mod blob;
mod builder;
mod classroom;
mod hairball;
mod hall;
mod noise;
mod stadium;
mod terrain;

use juggler_math::{Aabb, Vec3, vec3};
use std::fmt;
use std::ops::RangeInclusive;

/// Triangles to trace, and where to look at them from.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Corners, world space, scene units.
    pub positions: Vec<Vec3>,
    /// Three numbers of `positions` each.
    pub triangles: Vec<[u32; 3]>,
    /// Camera and light.
    pub view: View,
}

/// A pinhole camera and a point light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the camera is.
    pub eye: Vec3,
    /// A point in the middle of the picture.
    pub look_at: Vec3,
    /// A direction that points upwards in the picture.
    pub up: Vec3,
    /// Angle between the picture's upper and lower edge, in degrees, above 0 and below 180.
    pub fov_degrees: f32,
    /// Where the light is.
    pub light: Vec3,
}

impl View {
    /// The whole box, from the front, the right and above; for meshes that bring no camera.
    pub fn around(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self::around(&Aabb::from_points([Vec3::ZERO]));
        }
        let radius = bounds.extent().length() * 0.5;
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let center = bounds.center();
        let (fov_degrees, aside) = (40.0, vec3(0.45, 0.4, 0.8).normalize());
        // The ball around the box just fits between the picture's upper and lower edge: 1 / sin 20°.
        let eye = center + aside * (radius * 2.95);
        Self { eye, look_at: center, up: Vec3::Y, fov_degrees, light: center + vec3(-0.6, 2.0, 1.0) * radius }
    }
}

/// A kind of mesh. Its size says how fine it is, in a unit of its own.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// What it is called.
    pub name: &'static str,
    /// What it is and what it stresses, in one line.
    pub about: &'static str,
    /// What [`make`](Self::make) is given when nobody says otherwise.
    pub size: u32,
    /// The smallest and the largest size that can be made.
    pub sizes: (u32, u32),
    /// Makes it.
    pub make: fn(u32) -> Mesh,
}

/// All kinds.
pub const BUILT_IN: [BuiltIn; 6] =
    [blob::KIND, classroom::KIND, hall::KIND, stadium::KIND, hairball::KIND, terrain::KIND];

/// A built-in mesh of one size, made when it is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The kind.
    pub kind: BuiltIn,
    /// How fine.
    pub size: u32,
}

/// Why a name is no recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RecipeError {
    /// No kind has this name.
    Unknown,
    /// The kind exists; what follows the colon is not one of its sizes.
    Size {
        /// Its name.
        name: &'static str,
        /// The sizes that it has.
        sizes: RangeInclusive<u32>,
    },
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("no built-in mesh has this name"),
            Self::Size { name, sizes } => {
                write!(f, "the size of `{name}` is a whole number from {} to {}", sizes.start(), sizes.end())
            }
        }
    }
}

impl std::error::Error for RecipeError {}

impl Recipe {
    /// Reads `NAME` or `NAME:SIZE`.
    pub fn named(text: &str) -> Result<Self, RecipeError> {
        let (name, size) = text.split_once(':').map_or((text, None), |(name, size)| (name, Some(size)));
        let kind = BUILT_IN.into_iter().find(|kind| kind.name == name).ok_or(RecipeError::Unknown)?;
        let Some(size) = size else { return Ok(Self { kind, size: kind.size }) };
        let sizes = kind.sizes.0..=kind.sizes.1;
        match size.parse() {
            Ok(size) if sizes.contains(&size) => Ok(Self { kind, size }),
            _ => Err(RecipeError::Size { name: kind.name, sizes }),
        }
    }

    /// The mesh.
    pub fn make(&self) -> Mesh {
        (self.kind.make)(self.size)
    }
}

#[cfg(test)]
mod tests;
