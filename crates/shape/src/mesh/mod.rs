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

use super::SurfaceDerivatives;
use super::arithmetic::clamp_to_f32_range;
use super::triangle_geometry::TriangleGeometry;
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint, check};
use crate::attribute::MeshAttribute;
use crate::surface::Surface;
use crease::SmoothingGroups;
use description::MeshDescription;
use juggler_bvh::SimdLevel;
use juggler_math::{Aabb, BuildControl, Ray, Vec2, Vec3};
use prepared::PreparedMesh;
use serde::Deserialize;
use std::sync::{Arc, OnceLock};

mod batch;
mod crease;
mod data;
mod description;
mod morph;
mod moving_mesh;
mod point;
mod prepared;
mod rare;
mod sampling;

pub use data::MeshData;
pub use morph::{MorphArrays, MorphTarget};
pub use point::{InstanceValues, MeshPoint};

/// A triangle mesh, from a file or from arrays. The corners of a triangle run counter-clockwise
/// seen from the front.
///
/// Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the corners of
/// each triangle.
///
/// Clones share the arrays and, once prepared, the hierarchy.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(from = "MeshDescription")]
pub struct Mesh {
    /// Model file (PLY, OBJ, STL), relative to the scene file, instead of arrays.
    pub file: Option<String>,
    /// Corners and triangles. [`Shape::prepare`] blends morphs into them and adds the normals that
    /// the crease angle implies.
    arrays: Arc<MeshData>,
    /// Largest angle between the normals of two neighboring triangles whose edge is shaded
    /// smoothly, in degrees, 0 to 180.
    pub crease_angle_degrees: Option<f32>,
    /// Morph targets, each added in proportion to its weight.
    pub morphs: Vec<MorphTarget>,
    /// Data that [`Shape::prepare`] derives from the arrays.
    prepared: Option<Arc<PreparedMesh>>,
    /// Result of preparing the arrays alone, shared by all clones, so that a scene that is compiled
    /// again does not build the hierarchy again.
    memo: Memo,
}

/// Prepared mesh, once a clone has prepared it.
#[derive(Clone, Debug, Default)]
struct Memo(Arc<OnceLock<Arc<PreparedMesh>>>);

/// The memo does not count. Clones, which share their arrays, are compared without reading these.
impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        let Self { file, arrays, crease_angle_degrees, morphs, prepared, memo: _ } = self;
        let same_prepared = match (prepared, &other.prepared) {
            (Some(a), Some(b)) => same(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        (file, crease_angle_degrees) == (&other.file, &other.crease_angle_degrees)
            && same(arrays, &other.arrays)
            && *morphs == other.morphs
            && same_prepared
    }
}

/// Whether both are one value or equal values.
fn same<T: PartialEq>(a: &Arc<T>, b: &Arc<T>) -> bool {
    Arc::ptr_eq(a, b) || a == b
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
    /// Mesh of triangles, which are index triples into `positions` (object space, scene units);
    /// corners run counter-clockwise seen from the front. [`Shape::prepare`] validates the arrays.
    ///
    /// ```
    /// use juggler_shape::Mesh;
    /// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    /// let mesh = Mesh::from_triangles(positions.map(Into::into), [[0, 1, 2]])
    ///     .with_uvs(uvs.map(Into::into));
    /// assert_eq!((mesh.arrays().triangles.len(), mesh.arrays().uvs.len()), (1, 3));
    /// ```
    pub fn from_triangles(positions: impl Into<Vec<Vec3>>, triangles: impl Into<Vec<[u32; 3]>>) -> Self {
        MeshData { positions: positions.into(), triangles: triangles.into(), ..MeshData::default() }.into()
    }

    /// Sets the shading normals: one per position, object space, of any length.
    #[must_use]
    pub fn with_normals(mut self, normals: impl Into<Vec<Vec3>>) -> Self {
        self.arrays_mut().normals = normals.into();
        self
    }

    /// Sets the surface coordinates: one per position.
    #[must_use]
    pub fn with_uvs(mut self, uvs: impl Into<Vec<Vec2>>) -> Self {
        self.arrays_mut().uvs = uvs.into();
        self
    }

    /// Sets the second set of surface coordinates: one per position.
    #[must_use]
    pub fn with_uvs1(mut self, uvs1: impl Into<Vec<Vec2>>) -> Self {
        self.arrays_mut().uvs1 = uvs1.into();
        self
    }

    /// Sets the tangents: one per position, object space, with the sign of the bitangent.
    #[must_use]
    pub fn with_tangents(mut self, tangents: impl Into<Vec<[f32; 4]>>) -> Self {
        self.arrays_mut().tangents = tangents.into();
        self
    }

    /// Sets a named attribute.
    #[must_use]
    pub fn with_attribute(mut self, name: impl Into<String>, attribute: MeshAttribute) -> Self {
        self.arrays_mut().attributes.insert(name.into(), attribute);
        self
    }

    /// Mesh whose arrays are in a file; pass them to [`Mesh::load`] before [`Shape::prepare`].
    pub fn from_file(file: impl Into<String>) -> Self {
        Self { file: Some(file.into()), ..Self::default() }
    }

    /// Mesh that moves linearly between keyframes at uniform times from opening to closing of the
    /// shutter, all with the same triangles. Its area is the mean over that time; its creases are
    /// those of the first keyframe. The error names the field at fault.
    pub fn from_keyframes(keys: Vec<MeshData>, crease_angle_degrees: Option<f32>) -> Result<Self, InvalidShape> {
        Self::from_keyframes_with_control(keys, crease_angle_degrees, &BuildControl::default())
    }

    /// [`Mesh::from_keyframes`], which ends early if `control` is cancelled, with an error, and
    /// reports its progress to it.
    pub fn from_keyframes_with_control(
        mut keys: Vec<MeshData>,
        crease_angle_degrees: Option<f32>,
        control: &BuildControl,
    ) -> Result<Self, InvalidShape> {
        let same = keys.windows(2).all(|pair| match pair {
            [a, b] => a.triangles == b.triangles && a.positions.len() == b.positions.len(),
            _ => true,
        });
        if !same {
            return Err(check::invalid(
                "triangles",
                "all keyframes of a mesh must have the same triangles and number of positions",
            ));
        }
        if let (Some(angle), Some(first)) = (crease_angle_degrees, keys.first().filter(|key| key.normals.is_empty())) {
            let smoothing = SmoothingGroups::new(first, angle, control)?;
            keys = keys.into_iter().map(|key| smoothing.smoothed(key, control)).collect::<Result<_, _>>()?;
        }
        let prepared = PreparedMesh::from_keyframes(keys, control)?;
        let (arrays, prepared) = (Arc::clone(prepared.arrays()), Some(Arc::new(prepared)));
        Ok(Self { arrays, prepared, crease_angle_degrees, ..Self::default() })
    }

    /// Takes the arrays of the file. Returns an error if the description has arrays of its own
    /// beside the file.
    pub fn load(&mut self, data: MeshData) -> Result<(), InvalidShape> {
        if !self.arrays.positions.is_empty() || !self.arrays.triangles.is_empty() {
            return Err(check::invalid("file", "a mesh has either `file` or `positions` and `triangles`, not both"));
        }
        if *self.arrays != MeshData::default() {
            let message = "a mesh with `file` has the normals, surface coordinates, tangents and attributes of the \
                           file, so it cannot have `normals`, `uvs`, `uvs1`, `tangents` or `attributes`";
            return Err(check::invalid("file", message));
        }
        let (file, morphs) = (self.file.take(), std::mem::take(&mut self.morphs));
        *self = Self { file, morphs, crease_angle_degrees: self.crease_angle_degrees, ..data.into() };
        Ok(())
    }

    /// The arrays blended with `targets`, the arrays for each of [`Mesh::morphs`]. The error names the
    /// field at fault.
    pub fn blended(&self, targets: &[MorphArrays<'_>]) -> Result<MeshData, InvalidShape> {
        let mut data = MeshData::clone(&self.arrays);
        let targets: Vec<(MorphArrays<'_>, f32)> =
            targets.iter().zip(&self.morphs).map(|(target, morph)| (*target, morph.weight)).collect();
        morph::blend(&mut data, &targets)?;
        Ok(data)
    }

    /// The same mesh for another SIMD level than the best of this machine.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let prepared = self.prepared.as_ref().map(|prepared| Arc::new(prepared.with_simd_level(level)));
        Self { prepared, ..self.clone() }
    }

    /// Whether its corners move while the shutter is open.
    pub fn moves(&self) -> bool {
        self.prepared.as_deref().is_some_and(|prepared| prepared.bvh().is_none())
    }

    /// Triangle at a time; `None` before [`Shape::prepare`].
    pub(super) fn triangle_geometry(&self, triangle: u32, time: f32) -> Option<TriangleGeometry> {
        self.prepared.as_deref()?.triangle_geometry(triangle as usize, time)
    }

    /// The arrays; `None` before [`Shape::prepare`].
    pub fn data(&self) -> Option<&MeshData> {
        self.prepared.as_deref().map(|prepared| &**prepared.arrays())
    }

    /// Messages about flaws of the mesh that are no errors: triangles without area, which are
    /// ignored.
    pub fn warnings(&self) -> Vec<String> {
        match self.prepared.as_ref().map_or(0, |p| p.degenerate()) {
            0 => Vec::new(),
            1 => vec!["1 degenerate triangle ignored".to_owned()],
            count => vec![format!("{count} degenerate triangles ignored")],
        }
    }

    /// Corners and triangles: those given or, after [`Shape::prepare`], those that rays hit. Empty
    /// for a mesh in a file.
    pub fn arrays(&self) -> &Arc<MeshData> {
        &self.arrays
    }

    /// Drops corners, triangles and the arrays of morphs, so that the rest can be inspected alone.
    pub fn clear_arrays(&mut self) {
        (self.arrays, self.prepared, self.memo) = Default::default();
        for morph in &mut self.morphs {
            (morph.positions, morph.normals, morph.tangents) = Default::default();
        }
    }

    /// The arrays for modification; drops the prepared data, which is then out of date.
    fn arrays_mut(&mut self) -> &mut MeshData {
        (self.prepared, self.memo) = Default::default();
        Arc::make_mut(&mut self.arrays)
    }
}

impl Shape for Mesh {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        self.prepare_with_control(&BuildControl::default())
    }

    fn prepare_with_control(&mut self, control: &BuildControl) -> Result<(), InvalidShape> {
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
            let morphs: Vec<_> = self.morphs.iter().map(|morph| (morph.arrays(), morph.weight)).collect();
            morph::blend(Arc::make_mut(&mut arrays), &morphs)?;
        }
        if let Some(angle) = self.crease_angle_degrees.filter(|_| arrays.normals.is_empty()) {
            let smoothing = SmoothingGroups::new(&arrays, angle, control)?;
            arrays = Arc::new(smoothing.smoothed(Arc::unwrap_or_clone(arrays), control)?);
        }
        // Morphs and creases may change, so only the arrays' own preparation is kept.
        let is_own = Arc::ptr_eq(&arrays, &self.arrays);
        let prepared = match self.memo.0.get().filter(|_| is_own) {
            Some(prepared) => Arc::clone(prepared),
            None => Arc::new(PreparedMesh::new(Arc::clone(&arrays), control)?),
        };
        if is_own {
            // Another thread may have been first; both results are equal.
            _ = self.memo.0.set(Arc::clone(&prepared));
        }
        self.prepared = Some(prepared);
        self.arrays = arrays;
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.prepared.as_ref().map_or(Aabb::EMPTY, |p| p.bounds())
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.prepared.as_ref()?.closest(&clamp_to_f32_range(ray))?;
        Some(Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), primitive: hit.index })
    }

    fn occludes(&self, ray: &Ray) -> bool {
        self.prepared.as_ref().is_some_and(|p| p.any(&clamp_to_f32_range(ray)))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let triangle = self.prepared.as_ref().and_then(|p| p.triangle_geometry(hit.primitive as usize, ray.time));
        triangle
            .map_or_else(|| Surface::new(ray.at(hit.t), 0.0, Vec3::Y, hit.uv), |triangle| triangle.surface(ray, hit.uv))
    }

    fn derivatives(&self, _local: Vec3, hit: &Hit, time: f32) -> Option<SurfaceDerivatives> {
        self.prepared.as_ref()?.triangle_geometry(hit.primitive as usize, time)?.derivatives()
    }

    fn area(&self) -> f32 {
        self.prepared.as_ref().map_or(0.0, |p| p.area())
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        self.sample_at(from, u, 0.0)
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        self.pdf_at(from, at, 0.0)
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

    fn mesh(&self) -> Option<&Mesh> {
        Some(self)
    }

    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        Some(self)
    }
}

#[cfg(any(test, feature = "testing"))]
mod examples;
#[cfg(test)]
mod tests;
