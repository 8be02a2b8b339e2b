//! A triangle mesh over a bounding volume hierarchy of its own.
//!
//! ```
//! use juggler_shape::{AnyShape, Mesh, MeshData};
//! let shape: AnyShape = serde_json::from_str(
//!     r#"{"mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}}"#,
//! )?;
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Into::into).to_vec();
//! let data = MeshData { positions, triangles: vec![[0, 1, 2]], ..MeshData::default() };
//! assert_eq!(shape, Mesh::from(data).into());
//! let from_file: AnyShape = serde_json::from_str(r#"{"mesh": {"file": "models/cow.ply"}}"#)?;
//! assert_eq!(from_file, Mesh::from_file("models/cow.ply").into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::Derivatives;
use super::arithmetic::within_floats;
use super::facet::Facet;
use super::solid_angle::{area_pdf, area_sample, pick};
use super::{Hit, InvalidShape, Shape, SurfacePoint, SurfaceSample, check};
use crate::surface::Surface;
use crease::Creases;
use described::MeshDescription;
use juggler_bvh::SimdLevel;
use juggler_math::{Aabb, Ray, Vec2, Vec3, warp};
use prepared::Prepared;
use serde::Deserialize;
use std::sync::Arc;

mod crease;
mod data;
mod deforming;
mod described;
mod many;
mod morph;
mod prepared;

pub use data::MeshData;
pub use morph::Morph;

/// A surface of triangles: from a file, or given here. Its front is where the corners of a triangle run
/// counter-clockwise.
///
/// Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the corners of each triangle.
///
/// Clones share the arrays and, once prepared, the hierarchy.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(from = "MeshDescription")]
pub struct Mesh {
    /// A model file (PLY, OBJ, STL), relative to the scene file, instead of arrays.
    pub file: Option<String>,
    /// Corners and triangles. Once prepared, morphs are blended in, and normals added where creases ask for them.
    arrays: Arc<MeshData>,
    /// Greatest angle between the normals of two neighboring triangles whose edge is shaded smoothly, in degrees.
    pub crease_angle_degrees: Option<f32>,
    /// Other places that its corners go to, each as far as its weight says.
    pub morphs: Vec<Morph>,
    /// What [`Shape::prepare`] makes of the arrays.
    prepared: Option<Arc<Prepared>>,
}

impl From<MeshData> for Mesh {
    fn from(data: MeshData) -> Self {
        Arc::new(data).into()
    }
}

/// The arrays are shared, not copied.
impl From<Arc<MeshData>> for Mesh {
    fn from(arrays: Arc<MeshData>) -> Self {
        Self { arrays, ..Self::default() }
    }
}

impl Mesh {
    /// A mesh of triangles, which are index triples into `positions` (object space, scene units);
    /// the front is where the corners run counter-clockwise. [`Shape::prepare`] checks the arrays.
    ///
    /// ```
    /// use juggler_shape::Mesh;
    /// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = Mesh::from_triangles(positions.map(Into::into), [[0, 1, 2]]).with_uvs([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Into::into));
    /// assert_eq!((mesh.arrays().triangles.len(), mesh.arrays().uvs.len()), (1, 3));
    /// ```
    pub fn from_triangles(positions: impl Into<Vec<Vec3>>, triangles: impl Into<Vec<[u32; 3]>>) -> Self {
        MeshData { positions: positions.into(), triangles: triangles.into(), ..MeshData::default() }.into()
    }

    /// Sets the shading normals: one per position, object space, of any length.
    #[must_use]
    pub fn with_normals(mut self, normals: impl Into<Vec<Vec3>>) -> Self {
        self.change().normals = normals.into();
        self
    }

    /// Sets the surface coordinates: one per position.
    #[must_use]
    pub fn with_uvs(mut self, uvs: impl Into<Vec<Vec2>>) -> Self {
        self.change().uvs = uvs.into();
        self
    }

    /// A mesh whose arrays are in a file, to be given to [`Mesh::load`] before [`Shape::prepare`].
    pub fn from_file(file: impl Into<String>) -> Self {
        Self { file: Some(file.into()), ..Self::default() }
    }

    /// A mesh that is as these say at even times from opening to closing of the shutter; all with the same triangles.
    /// Its area, the places on it, and where `crease_angle_degrees` leaves creases, are those of the first.
    pub fn moving(mut keys: Vec<MeshData>, crease_angle_degrees: Option<f32>) -> Result<Self, InvalidShape> {
        let same = keys.windows(2).all(|pair| match pair {
            [a, b] => a.triangles == b.triangles && a.positions.len() == b.positions.len(),
            _ => true,
        });
        if !same {
            return Err(check::invalid("triangles", "a mesh that moves keeps its triangles"));
        }
        if let (Some(angle), Some(first)) = (crease_angle_degrees, keys.first().filter(|key| key.normals.is_empty())) {
            let creases = Creases::new(first, angle)?;
            keys = keys.into_iter().map(|key| creases.smoothed(key)).collect();
        }
        let prepared = Prepared::moving(keys)?;
        let (arrays, prepared) = (Arc::clone(prepared.arrays()), Some(Arc::new(prepared)));
        Ok(Self { arrays, prepared, crease_angle_degrees, ..Self::default() })
    }

    /// Takes what the file holds. An error when the description has arrays of its own beside the file.
    pub fn load(&mut self, data: MeshData) -> Result<(), InvalidShape> {
        if !self.arrays.positions.is_empty() || !self.arrays.triangles.is_empty() {
            return Err(check::invalid("file", "a mesh has either `file` or `positions` and `triangles`, not both"));
        }
        let (file, morphs) = (self.file.take(), std::mem::take(&mut self.morphs));
        *self = Self { file, morphs, crease_angle_degrees: self.crease_angle_degrees, ..data.into() };
        Ok(())
    }

    /// The arrays, corners blended with `morphs`: for each of [`Mesh::morphs`] the places of all corners. An error
    /// names the field at fault.
    pub fn blended(&self, morphs: &[&[Vec3]]) -> Result<MeshData, InvalidShape> {
        let mut data = MeshData::clone(&self.arrays);
        let targets: Vec<(&[Vec3], f32)> =
            morphs.iter().zip(&self.morphs).map(|(positions, morph)| (*positions, morph.weight)).collect();
        morph::blend(&mut data, &targets)?;
        Ok(data)
    }

    /// The same mesh for another vector unit than the best of this machine.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let prepared = self.prepared.as_ref().map(|prepared| Arc::new(prepared.with_simd_level(level)));
        Self { prepared, ..self.clone() }
    }

    /// Whether its corners move while the shutter is open.
    pub fn moves(&self) -> bool {
        self.prepared.as_deref().is_some_and(|prepared| prepared.bvh().is_none())
    }

    /// One of its triangles as it is at a time, once prepared.
    pub(super) fn facet(&self, triangle: u32, time: f32) -> Option<Facet> {
        self.prepared.as_deref()?.facet(triangle as usize, time)
    }

    /// The arrays, once prepared.
    pub fn data(&self) -> Option<&MeshData> {
        self.prepared.as_deref().map(|prepared| &**prepared.arrays())
    }

    /// What is odd about the mesh and yet no error, in words: triangles that were ignored.
    pub fn warnings(&self) -> Vec<String> {
        match self.prepared.as_ref().map_or(0, |p| p.degenerate()) {
            0 => Vec::new(),
            1 => vec!["1 degenerate triangle ignored".to_owned()],
            count => vec![format!("{count} degenerate triangles ignored")],
        }
    }

    /// Corners and triangles: those that the mesh was given or, once prepared, those that are met by rays. Empty for a mesh
    /// in a file.
    pub fn arrays(&self) -> &Arc<MeshData> {
        &self.arrays
    }

    /// Lets go of corners, triangles and morphs, so that the rest can be looked at alone.
    pub fn clear_arrays(&mut self) {
        (self.arrays, self.prepared) = (Arc::default(), None);
        self.morphs.iter_mut().for_each(|morph| morph.positions.clear());
    }

    /// The arrays to be changed: what was prepared is out of date.
    fn change(&mut self) -> &mut MeshData {
        self.prepared = None;
        Arc::make_mut(&mut self.arrays)
    }
}

impl Shape for Mesh {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        if self.prepared.is_some() {
            return Ok(());
        }
        if self.arrays.triangles.is_empty() {
            return Err(match &self.file {
                Some(file) => check::invalid("file", format!("`file` \"{file}\" holds no triangles")),
                None => check::invalid("triangles", "a mesh must have `file`, or `positions` and `triangles`"),
            });
        }
        let mut arrays = Arc::clone(&self.arrays);
        if !self.morphs.is_empty() {
            let morphs: Vec<(&[Vec3], f32)> = self.morphs.iter().map(|m| (m.positions.as_slice(), m.weight)).collect();
            morph::blend(Arc::make_mut(&mut arrays), &morphs)?;
        }
        if let Some(angle) = self.crease_angle_degrees.filter(|_| arrays.normals.is_empty()) {
            let creases = Creases::new(&arrays, angle)?;
            arrays = Arc::new(creases.smoothed(Arc::unwrap_or_clone(arrays)));
        }
        self.prepared = Some(Arc::new(Prepared::new(Arc::clone(&arrays))?));
        self.arrays = arrays;
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.prepared.as_ref().map_or(Aabb::EMPTY, |p| p.bounds())
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.prepared.as_ref()?.closest(&within_floats(ray))?;
        Some(Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), part: hit.index })
    }

    fn occludes(&self, ray: &Ray) -> bool {
        self.prepared.as_ref().is_some_and(|p| p.any(&within_floats(ray)))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let facet = self.prepared.as_ref().and_then(|p| p.facet(hit.part as usize, ray.time));
        facet.map_or_else(|| Surface::new(ray.at(hit.t), 0.0, Vec3::Y, hit.uv), |facet| facet.surface(ray, hit.uv))
    }

    fn derivatives(&self, _local: Vec3, hit: &Hit, time: f32) -> Option<Derivatives> {
        self.prepared.as_ref()?.facet(hit.part as usize, time)?.derivatives()
    }

    fn area(&self) -> f32 {
        self.prepared.as_ref().map_or(0.0, |p| p.area())
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample> {
        let prepared = self.prepared.as_ref()?;
        let (index, rest) = pick(prepared.running_areas(), u.x)?;
        let at = warp::uniform_triangle(Vec2::new(rest, u.y)).truncate().as_dvec2();
        let (point, normal) = prepared.arrays().facet(index)?.point(at);
        area_sample(from, point, normal, prepared.area())
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_pdf(from, at, self.area())
    }

    fn triangles(&self) -> usize {
        self.arrays.triangles.len()
    }

    fn heap_bytes(&self) -> usize {
        self.prepared.as_ref().map_or(0, |p| p.heap_bytes())
    }

    fn bvh_bytes(&self) -> usize {
        self.prepared.as_ref().map_or(0, |p| p.bvh_bytes())
    }
}

#[cfg(any(test, feature = "testing"))]
mod examples;
#[cfg(test)]
mod tests;
