//! Assets from arrays, and their parts again for `pickle`.
//!
//! Python gives each array as the bytes of numbers in little-endian order, so that the order of
//! bytes and the type of numbers are never guessed. The bytes are copied once while the interpreter
//! is attached; numbers and hash are made while other Python threads run.

use crate::errors::{internal, scene_error};
use juggler::math::{Vec2, Vec3};
use juggler::scene::{self, InstanceAttribute, Instances, ScaleFactors, TexelArray, TexelSamples};
use juggler::shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use juggler::shape::{Mesh, MeshData};
use juggler::texture::ColorSpace;
use pyo3::IntoPyObjectExt;
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};

/// Attribute: name, whether triangles have the values, channels, type, bytes.
type AttributeParts = (String, bool, u32, String, PyBuffer<u8>);

/// Attribute whose bytes are copied.
struct Attribute {
    name: String,
    domain: AttributeDomain,
    channels: u32,
    data: AttributeBytes,
}

/// Numbers of an attribute as bytes.
struct AttributeBytes {
    kind: String,
    bytes: Vec<u8>,
}

impl AttributeBytes {
    fn convert(self) -> AttributeData {
        match self.kind.as_str() {
            "u1" => AttributeData::U8(self.bytes),
            "u2" => AttributeData::U16(words(&self.bytes)),
            _ => AttributeData::F32(floats(&self.bytes)),
        }
    }
}

/// Number of digits of the digest in the name of arrays.
const NAME_DIGITS: usize = 16;

/// Whether the package gave this name to the arrays of a mesh.
pub fn is_name_of_arrays(name: &str) -> bool {
    let digits = name.strip_prefix("mesh-").and_then(|name| name.strip_suffix(".ply"));
    digits.is_some_and(|digits| digits.len() == NAME_DIGITS && digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
}

/// Arrays or bytes that a scene names in place of a file. It never changes.
#[pyclass(frozen, eq, hash, module = "juggler._native")]
#[derive(Clone, PartialEq)]
pub struct Asset {
    /// The asset.
    pub asset: scene::Asset,
}

impl Eq for Asset {}

impl Hash for Asset {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.asset.digest().hash(state);
    }
}

#[pymethods]
impl Asset {
    /// Makes an asset of the bytes of a file.
    #[staticmethod]
    fn file(py: Python<'_>, bytes: &Bound<'_, PyAny>) -> PyResult<Self> {
        let bytes = PyBuffer::<u8>::get(bytes)?.to_vec(py)?;
        Ok(py.detach(|| Self { asset: scene::Asset::from_bytes(bytes) }))
    }

    /// Makes a mesh. `arrays` has the fields of [`MeshData`] by name: `float32`, and `uint32` for the
    /// triangles.
    #[staticmethod]
    fn mesh(py: Python<'_>, arrays: BTreeMap<String, PyBuffer<u8>>, attributes: Vec<AttributeParts>) -> PyResult<Self> {
        let (mut arrays, attributes) = copied(py, arrays, attributes)?;
        py.detach(|| {
            // Each array of bytes is released before the next one is converted.
            let mut take = |name: &str| arrays.remove(name).unwrap_or_default();
            let mut mesh = MeshData {
                positions: numbers(&take("positions"), f32::from_le_bytes, Vec3::from_array),
                triangles: numbers(&take("triangles"), u32::from_le_bytes, |corners| corners),
                normals: numbers(&take("normals"), f32::from_le_bytes, Vec3::from_array),
                uvs: numbers(&take("uvs"), f32::from_le_bytes, Vec2::from_array),
                uvs1: numbers(&take("uvs1"), f32::from_le_bytes, Vec2::from_array),
                tangents: numbers(&take("tangents"), f32::from_le_bytes, |tangent| tangent),
                attributes: BTreeMap::new(),
            };
            for Attribute { name, domain, channels, data } in attributes {
                mesh.attributes.insert(name, MeshAttribute { domain, channels, data: data.convert() });
            }
            Ok(Self { asset: scene::Asset::from_mesh(mesh) })
        })
    }

    /// Makes instances. `arrays` has the fields of [`Instances`] by name, all `float32`; scale factors are
    /// `uniform_scales` with one number for each instance, or `scales` with three.
    #[staticmethod]
    fn instances(
        py: Python<'_>,
        arrays: BTreeMap<String, PyBuffer<u8>>,
        attributes: Vec<AttributeParts>,
    ) -> PyResult<Self> {
        let (mut arrays, attributes) = copied(py, arrays, attributes)?;
        py.detach(|| {
            let mut take = |name: &str| arrays.remove(name).unwrap_or_default();
            let scales = match take("uniform_scales") {
                each if each.is_empty() => {
                    numbers(&take("scales"), f32::from_le_bytes, |axes: [f32; 3]| ScaleFactors::Each(axes.into()))
                }
                uniform => numbers(&uniform, f32::from_le_bytes, |[factor]| ScaleFactors::All(factor)),
            };
            let rows = |bytes: &[u8]| numbers(bytes, f32::from_le_bytes, |row: [f32; 4]| row);
            let instances = Instances {
                file: None,
                positions: numbers(&take("positions"), f32::from_le_bytes, Vec3::from_array).into(),
                rotations: rows(&take("rotations")).into(),
                scales: scales.into(),
                matrices: numbers(&take("matrices"), f32::from_le_bytes, |rows: [f32; 12]| rows).into(),
                colors: rows(&take("colors")).into(),
                end_colors: rows(&take("end_colors")).into(),
                attributes: attributes.into_iter().map(instance_attribute).collect(),
            };
            Ok(Self { asset: scene::Asset::from_instances(instances) })
        })
    }

    /// Makes texels. `kind` is the type of the samples: `u1`, `u2`, `f2` or `f4`.
    #[staticmethod]
    fn texels(py: Python<'_>, size: [u32; 2], channels: u8, kind: &str, bytes: &Bound<'_, PyAny>) -> PyResult<Self> {
        let bytes = PyBuffer::<u8>::get(bytes)?.to_vec(py)?;
        let made = py.detach(|| {
            let samples = match kind {
                "u1" => TexelSamples::U8(bytes),
                "u2" => TexelSamples::U16(words(&bytes)),
                "f2" => TexelSamples::F16(words(&bytes)),
                _ => TexelSamples::F32(floats(&bytes)),
            };
            TexelArray::new(size, channels, samples, ColorSpace::Auto).map(scene::Asset::from_texels)
        });
        made.map(|asset| Self { asset }).map_err(|error| scene_error(&error.to_string()))
    }

    /// BLAKE3 hash of the content, in hexadecimal.
    #[getter]
    fn digest(&self) -> String {
        self.asset.digest().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Name under which scenes refer to the asset, by its content: equal arrays are one file when
    /// scenes are saved, and different ones never replace each other.
    #[getter]
    fn name(&self) -> String {
        let (kind, ending) = match (self.asset.mesh(), self.asset.texels()) {
            _ if self.asset.instances().is_some() => ("instances", "ply"),
            (Some(_), _) => ("mesh", "ply"),
            (_, Some(texels)) => match texels.samples() {
                TexelSamples::U8(_) | TexelSamples::U16(_) => ("texels", "png"),
                TexelSamples::F16(_) | TexelSamples::F32(_) => ("texels", "exr"),
            },
            _ => ("file", "bin"),
        };
        format!("{kind}-{}.{ending}", self.digest().get(..NAME_DIGITS).unwrap_or_default())
    }

    /// Members of a mesh or of instances in the scene format, as JSON; `None` for other assets.
    fn members(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let json = match (self.asset.mesh(), self.asset.instances()) {
            (Some(mesh), _) => py.detach(|| serde_json::to_string(&Mesh::from(MeshData::clone(mesh)))),
            (_, Some(instances)) => py.detach(|| serde_json::to_string(instances)),
            _ => return Ok(None),
        };
        json.map(Some).map_err(|error| internal(&error.to_string()))
    }

    /// For `pickle`: the name of the method that makes the asset again, and its arguments. From
    /// protocol 5 on, arrays may travel outside of the stream.
    fn __reduce_ex__<'py>(&self, py: Python<'py>, protocol: i32) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let restore = py.import("juggler._assets")?.getattr("restore")?;
        let wrapper = if protocol >= 5 { Some(py.import("pickle")?.getattr("PickleBuffer")?) } else { None };
        let buffer = |bytes: &[u8]| {
            let bytes = PyBytes::new(py, bytes).into_any();
            wrapper.as_ref().map_or_else(|| Ok(bytes.clone()), |wrapper| wrapper.call1((&bytes,)))
        };
        Ok((restore, self.parts(py, buffer)?))
    }
}

impl Asset {
    /// Name of the method that makes the asset, and its arguments.
    fn parts<'py>(
        &self,
        py: Python<'py>,
        buffer: impl Fn(&[u8]) -> PyResult<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        if let Some(mesh) = self.asset.mesh() {
            let arrays = mesh_arrays(py, mesh, &buffer)?;
            let attributes = mesh.attributes.iter().map(|(name, one)| attribute_parts(py, name, one, &buffer));
            let attributes = attributes.collect::<PyResult<Vec<_>>>()?;
            return ("mesh", arrays, attributes).into_pyobject(py);
        }
        if let Some(instances) = self.asset.instances() {
            let arrays = instance_arrays(py, instances, &buffer)?;
            let attributes = instances.attributes.iter().map(|(name, one)| attribute_parts(py, name, one, &buffer));
            return ("instances", arrays, attributes.collect::<PyResult<Vec<_>>>()?).into_pyobject(py);
        }
        if let Some(texels) = self.asset.texels() {
            let (kind, bytes) = match texels.samples() {
                TexelSamples::U8(levels) => ("u1", buffer(levels)?),
                TexelSamples::U16(levels) => ("u2", buffer(&bytes_of(levels, |level| level.to_le_bytes()))?),
                TexelSamples::F16(halves) => ("f2", buffer(&bytes_of(halves, |half| half.to_le_bytes()))?),
                TexelSamples::F32(floats) => ("f4", buffer(&float_bytes(floats))?),
            };
            return ("texels", texels.size(), texels.channels(), kind, bytes).into_pyobject(py);
        }
        let bytes = self.asset.bytes().ok_or_else(|| internal("an asset of pixels has no parts"))?;
        ("file", buffer(bytes)?).into_pyobject(py)
    }
}

/// Attribute of instances, which have no faces.
fn instance_attribute(Attribute { name, channels, data, .. }: Attribute) -> (String, InstanceAttribute) {
    (name, InstanceAttribute::new(channels, data.convert()))
}

/// Arrays by name, and attributes, copied from Python.
type Copied = (BTreeMap<String, Vec<u8>>, Vec<Attribute>);

fn copied(py: Python<'_>, arrays: BTreeMap<String, PyBuffer<u8>>, attributes: Vec<AttributeParts>) -> PyResult<Copied> {
    let arrays = arrays.into_iter().map(|(name, buffer)| Ok((name, buffer.to_vec(py)?)));
    let attributes = attributes.into_iter().map(|(name, is_face, channels, kind, buffer)| {
        let domain = if is_face { AttributeDomain::Face } else { AttributeDomain::Vertex };
        Ok(Attribute { name, domain, channels, data: AttributeBytes { kind, bytes: buffer.to_vec(py)? } })
    });
    Ok((arrays.collect::<PyResult<_>>()?, attributes.collect::<PyResult<_>>()?))
}

/// Attribute as the argument that makes it again.
fn attribute_parts<'py>(
    py: Python<'py>,
    name: &str,
    attribute: &MeshAttribute,
    buffer: &impl Fn(&[u8]) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (kind, bytes) = match &attribute.data {
        AttributeData::U8(values) => ("u1", buffer(values)?),
        AttributeData::U16(values) => ("u2", buffer(&bytes_of(values, |value| value.to_le_bytes()))?),
        AttributeData::F32(values) => ("f4", buffer(&float_bytes(values))?),
    };
    let is_face = attribute.domain == AttributeDomain::Face;
    (name, is_face, attribute.channels, kind, bytes).into_bound_py_any(py)
}

/// The arrays of instances by name, as bytes; empty ones are left out.
fn instance_arrays<'py>(
    py: Python<'py>,
    instances: &Instances,
    buffer: &impl Fn(&[u8]) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let all = |scale: &ScaleFactors| if let ScaleFactors::All(factor) = scale { Some(*factor) } else { None };
    let uniform: Option<Vec<f32>> = instances.scales.iter().map(all).collect();
    let each = |scale: &ScaleFactors| match scale {
        ScaleFactors::All(factor) => [*factor; 3],
        ScaleFactors::Each(axes) => axes.to_array(),
    };
    let (name, scales) = match uniform {
        Some(uniform) => ("uniform_scales", uniform),
        None => ("scales", instances.scales.iter().flat_map(each).collect()),
    };
    let arrays = PyDict::new(py);
    for (name, bytes) in [
        ("positions", point_bytes(&instances.positions)),
        ("rotations", float_bytes(instances.rotations.as_flattened())),
        (name, float_bytes(&scales)),
        ("matrices", float_bytes(instances.matrices.as_flattened())),
        ("colors", float_bytes(instances.colors.as_flattened())),
        ("end_colors", float_bytes(instances.end_colors.as_flattened())),
    ] {
        if !bytes.is_empty() {
            arrays.set_item(name, buffer(&bytes)?)?;
        }
    }
    Ok(arrays)
}

/// The arrays of a mesh by name, as bytes; empty ones are left out.
fn mesh_arrays<'py>(
    py: Python<'py>,
    mesh: &MeshData,
    buffer: &impl Fn(&[u8]) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let of_uvs = |uvs: &[Vec2]| bytes_of(uvs.iter().flat_map(|uv| uv.to_array()), |x| x.to_le_bytes());
    let arrays = PyDict::new(py);
    for (name, bytes) in [
        ("positions", point_bytes(&mesh.positions)),
        ("triangles", bytes_of(mesh.triangles.as_flattened(), |index| index.to_le_bytes())),
        ("normals", point_bytes(&mesh.normals)),
        ("uvs", of_uvs(&mesh.uvs)),
        ("uvs1", of_uvs(&mesh.uvs1)),
        ("tangents", float_bytes(mesh.tangents.as_flattened())),
    ] {
        if !bytes.is_empty() {
            arrays.set_item(name, buffer(&bytes)?)?;
        }
    }
    Ok(arrays)
}

fn point_bytes(points: &[Vec3]) -> Vec<u8> {
    bytes_of(points.iter().flat_map(|point| point.to_array()), |number| number.to_le_bytes())
}

fn float_bytes(numbers: &[f32]) -> Vec<u8> {
    bytes_of(numbers, |number| number.to_le_bytes())
}

/// Groups of `N` numbers of four bytes. Bytes beyond the last whole group are left out.
fn numbers<T: Copy + Default, V, const N: usize>(
    bytes: &[u8],
    number: impl Fn([u8; 4]) -> T,
    value: impl Fn([T; N]) -> V,
) -> Vec<V> {
    let (numbers, _) = bytes.as_chunks::<4>();
    let (groups, _) = numbers.as_chunks::<N>();
    groups.iter().map(|group| value(group.map(&number))).collect()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number)).collect()
}

fn words(bytes: &[u8]) -> Vec<u16> {
    bytes.as_chunks::<2>().0.iter().map(|number| u16::from_le_bytes(*number)).collect()
}

/// Little-endian bytes of numbers.
fn bytes_of<T, const N: usize>(numbers: impl IntoIterator<Item = T>, bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    numbers.into_iter().flat_map(bytes).collect()
}
