//! Procedural meshes: no files, the same triangles on every platform. One kind is one file and two
//! lines here.

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

/// A triangle mesh with a view of it.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Vertices in world space, scene units.
    pub positions: Vec<Vec3>,
    /// Three indices into `positions` per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Camera and light.
    pub view: View,
}

/// A pinhole camera and a point light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the camera.
    pub eye: Vec3,
    /// Point at the center of the image.
    pub look_at: Vec3,
    /// Up direction of the image.
    pub up: Vec3,
    /// Vertical field of view in degrees, above 0 and below 180.
    pub fov_degrees: f32,
    /// Position of the light.
    pub light: Vec3,
}

impl View {
    /// View of the whole box from the front, the right and above, for meshes without a camera.
    pub fn around(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self::around(&Aabb::from_points([Vec3::ZERO]));
        }
        let radius = bounds.extent().length() * 0.5;
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let center = bounds.center();
        let (fov_degrees, aside) = (40.0, vec3(0.45, 0.4, 0.8).normalize());
        // The bounding sphere fits the vertical field of view: 1 / sin 20°.
        let eye = center + aside * (radius * 2.95);
        Self { eye, look_at: center, up: Vec3::Y, fov_degrees, light: center + vec3(-0.6, 2.0, 1.0) * radius }
    }
}

/// A kind of procedural mesh. Its size sets the resolution, in a unit of its own.
#[derive(Clone, Copy, Debug)]
pub struct MeshKind {
    /// Name of the kind.
    pub name: &'static str,
    /// One line about its content and the property that it stresses.
    pub about: &'static str,
    /// Default of the size that [`make`](Self::make) takes.
    pub size: u32,
    /// Smallest and largest size.
    pub sizes: (u32, u32),
    /// Builds the mesh of a size.
    pub make: fn(u32) -> Mesh,
}

/// All kinds.
pub const BUILT_IN: [MeshKind; 6] =
    [blob::KIND, classroom::KIND, hall::KIND, stadium::KIND, hairball::KIND, terrain::KIND];

/// A procedural mesh of one size, built on demand.
#[derive(Clone, Copy, Debug)]
pub struct MeshSpec {
    /// The kind.
    pub kind: MeshKind,
    /// Resolution, in the unit of the kind.
    pub size: u32,
}

/// Reason why a name is not a recipe.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshSpecError {
    /// No kind has this name.
    Unknown,
    /// The kind exists, but the text after the colon is not one of its sizes.
    Size {
        /// Name of the kind.
        name: &'static str,
        /// Sizes of the kind.
        sizes: RangeInclusive<u32>,
    },
}

impl fmt::Display for MeshSpecError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("no built-in mesh has this name"),
            Self::Size { name, sizes } => {
                write!(f, "the size of `{name}` is a whole number from {} to {}", sizes.start(), sizes.end())
            }
        }
    }
}

impl std::error::Error for MeshSpecError {}

impl MeshSpec {
    /// Parses `NAME` or `NAME:SIZE`.
    pub fn parse(text: &str) -> Result<Self, MeshSpecError> {
        let (name, size) = text.split_once(':').map_or((text, None), |(name, size)| (name, Some(size)));
        let kind = BUILT_IN.into_iter().find(|kind| kind.name == name).ok_or(MeshSpecError::Unknown)?;
        let Some(size) = size else { return Ok(Self { kind, size: kind.size }) };
        let sizes = kind.sizes.0..=kind.sizes.1;
        match size.parse() {
            Ok(size) if sizes.contains(&size) => Ok(Self { kind, size }),
            _ => Err(MeshSpecError::Size { name: kind.name, sizes }),
        }
    }

    /// Builds the mesh.
    pub fn make(&self) -> Mesh {
        (self.kind.make)(self.size)
    }
}

#[cfg(test)]
mod tests;
