//! Vertex attributes and their displacements.

use super::Assembler;
use crate::gltf::accessor::Elements;
use crate::gltf::document::{Accessor, Attributes, ComponentType, Semantic};
use crate::gltf::error::Fault;
use crate::gltf::pose::{MorphDeltas, Vertices};
use juggler_math::{Aabb, Vec2, Vec3};

/// Number of sets of texture coordinates that are read.
const MAX_SETS: u32 = 16;
/// Relative deviation of a bound from the actual one that needs no warning.
const BOUND_TOLERANCE: f32 = 1e-5;

impl Assembler<'_> {
    /// Vertices; `None` without positions.
    pub(super) fn vertices(&mut self) -> Result<Option<Vertices>, Fault> {
        let Some(positions) = self.attribute(&Semantic::Position)? else { return Ok(None) };
        let positions = positions.floats(Vec3::from_array)?;
        self.check_bounds(&positions);
        let normals = self.vec3(&Semantic::Normal)?;
        let tangents = match self.attribute(&Semantic::Tangent)? {
            Some(_) if normals.is_empty() => {
                self.warn("tangents have no effect without normals", 1);
                Vec::new()
            }
            Some(tangents) => tangents.floats(|tangent: [f32; 4]| tangent)?,
            None => Vec::new(),
        };
        let mut vertices = Vertices { positions, normals, tangents, ..Vertices::default() };
        for (semantic, _) in self.primitive.attributes.iter() {
            match semantic {
                Semantic::TexCoord(set) if *set < MAX_SETS => {
                    let Some(texcoords) = self.attribute(semantic)? else { continue };
                    let texcoords = texcoords.floats(|[u, v]: [f32; 2]| Vec2::new(u, 1.0 - v))?;
                    put(&mut vertices.texcoords, *set, texcoords);
                }
                Semantic::Color(0) => {
                    let Some(colors) = self.attribute(semantic)? else { continue };
                    vertices.colors = colors_with_alpha(&colors, 1.0, |channel| channel.clamp(0.0, 1.0))?;
                }
                Semantic::TexCoord(_) | Semantic::Color(_) => {
                    self.warn(format!("the attribute `{semantic}` has no effect"), 1);
                }
                _ => {}
            }
        }
        Ok(Some(vertices))
    }

    /// Vectors of an attribute; none if the primitive lacks it.
    fn vec3(&self, semantic: &Semantic) -> Result<Vec<Vec3>, Fault> {
        self.attribute(semantic)?.map_or(Ok(Vec::new()), |elements| elements.floats(Vec3::from_array))
    }

    /// Warns if the bounds of the positions are not those that the file states.
    fn check_bounds(&mut self, positions: &[Vec3]) {
        let index = self.primitive.attributes.find(&Semantic::Position);
        let accessor = index.and_then(|index| self.data.gltf.document.accessors.get(index.get()));
        let Some((low, high)) = accessor.and_then(stated_bounds) else { return };
        let bounds = Aabb::from_points(positions.iter().copied());
        let size = bounds.min.abs().max(bounds.max.abs()).max_element();
        let deviation = (bounds.min - low).abs().max((bounds.max - high).abs()).max_element();
        if deviation > BOUND_TOLERANCE * size {
            self.warn("`min` and `max` of the positions are wrong; they have no effect", 1);
        }
    }

    /// Displacements of all morph targets. Those of attributes that the vertices lack are left out.
    pub(super) fn targets(&mut self, vertices: &Vertices) -> Result<Vec<MorphDeltas>, Fault> {
        self.primitive.targets.iter().map(|target| self.deltas(target, vertices)).collect()
    }

    fn deltas(&self, target: &Attributes, vertices: &Vertices) -> Result<MorphDeltas, Fault> {
        let mut deltas = MorphDeltas::default();
        for (semantic, index) in target.iter() {
            let elements = || Elements::new(self.data, index);
            match semantic {
                Semantic::Position => deltas.positions = elements()?.floats(Vec3::from_array)?,
                Semantic::Normal if !vertices.normals.is_empty() => {
                    deltas.normals = elements()?.floats(Vec3::from_array)?;
                }
                Semantic::Tangent if !vertices.tangents.is_empty() => {
                    deltas.tangents = elements()?.floats(Vec3::from_array)?;
                }
                Semantic::TexCoord(set) if vertices.texcoords.get(*set as usize).is_some_and(|set| !set.is_empty()) => {
                    // The displacement of 1 - v is that of v with the other sign.
                    let texcoords = elements()?.floats(|[u, v]: [f32; 2]| Vec2::new(u, -v))?;
                    put(&mut deltas.texcoords, *set, texcoords);
                }
                Semantic::Color(0) if !vertices.colors.is_empty() => {
                    deltas.colors = colors_with_alpha(&elements()?, 0.0, |channel| channel)?;
                }
                _ => {}
            }
        }
        Ok(deltas)
    }
}

/// Bounds that the file states for positions of single precision.
fn stated_bounds(accessor: &Accessor) -> Option<(Vec3, Vec3)> {
    let vector = |values: &[f64]| match values {
        [x, y, z] => Some(Vec3::new(*x as f32, *y as f32, *z as f32)),
        _ => None,
    };
    if accessor.component_type != ComponentType::F32 {
        return None;
    }
    vector(&accessor.min).zip(vector(&accessor.max))
}

/// Colors of an attribute of three or four components.
fn colors_with_alpha(elements: &Elements<'_>, alpha: f32, change: impl Fn(f32) -> f32) -> Result<Vec<[f32; 4]>, Fault> {
    match elements.components() {
        3 => elements.floats(|[r, g, b]: [f32; 3]| [change(r), change(g), change(b), alpha]),
        _ => elements.floats(|color: [f32; 4]| color.map(&change)),
    }
}

/// Puts a set at its position; the sets before it are empty if the file lacks them.
fn put(sets: &mut Vec<Vec<Vec2>>, set: u32, texcoords: Vec<Vec2>) {
    let position = set as usize;
    if sets.len() <= position {
        sets.resize(position + 1, Vec::new());
    }
    if let Some(place) = sets.get_mut(position) {
        *place = texcoords;
    }
}
