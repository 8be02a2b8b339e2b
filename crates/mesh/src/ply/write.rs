//! Meshes as PLY files.

use super::attributes::column_names;
use super::points::{COLOR, END_COLOR, MATRIX, POSITION, PointFile, ROTATION, SCALE, SCALES};
use juggler_shape::MeshData;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};

/// Maximum number of channels of an attribute.
const CHANNELS: usize = 4;

/// A mesh as a binary PLY file, which the reader reads to the same numbers. The attribute `color` of
/// vertices has the columns `red green blue` and perhaps `alpha`, as other programs read them, if
/// its numbers are floats; any other attribute has columns `attribute.NAME` of its own type.
pub fn ply_bytes(mesh: &MeshData) -> Vec<u8> {
    let vertex = AttributeWriter::new(mesh, AttributeDomain::Vertex);
    let face = AttributeWriter::new(mesh, AttributeDomain::Face);
    let mut file = header(mesh, &vertex, &face).into_bytes();
    let bytes = mesh.positions.len().saturating_mul(64 + vertex.bytes());
    file.reserve(bytes.saturating_add(mesh.triangles.len().saturating_mul(13 + face.bytes())));
    for (i, position) in mesh.positions.iter().enumerate() {
        let mut put = |numbers: &[f32]| file.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        put(&position.to_array());
        mesh.normals.get(i).into_iter().for_each(|normal| put(&normal.to_array()));
        mesh.uvs.get(i).into_iter().for_each(|uv| put(&uv.to_array()));
        mesh.uvs1.get(i).into_iter().for_each(|uv| put(&uv.to_array()));
        mesh.tangents.get(i).into_iter().for_each(|tangent| put(tangent));
        vertex.put(i, &mut file);
    }
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        file.push(3);
        file.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        face.put(i, &mut file);
    }
    file
}

/// Points as a binary PLY file, which [`parse_points`](super::parse_points) reads to the same numbers.
/// Positions are written in any case, for other programs: those of matrices, or else 0 if there are
/// none.
pub fn points_bytes(points: &PointFile) -> Vec<u8> {
    let PointFile { count, positions, rotations, uniform_scales, scales, matrices, colors, end_colors, .. } = points;
    let groups: [(&[&str], &[f32]); 6] = [
        (&ROTATION, rotations),
        (&SCALE, uniform_scales),
        (&SCALES, scales),
        (&MATRIX, matrices),
        (&COLOR, colors),
        (&END_COLOR, end_colors),
    ];
    let groups: Vec<_> = groups.into_iter().filter(|(_, numbers)| !numbers.is_empty()).collect();
    let attributes = AttributeWriter { attributes: points.attributes.iter().map(attribute_columns).collect() };
    let columns: String = POSITION
        .iter()
        .chain(groups.iter().flat_map(|(names, _)| *names))
        .map(|name| format!("property float {name}\n"))
        .collect();
    let head = "ply\nformat binary_little_endian 1.0\nelement vertex";
    let mut file = format!("{head} {count}\n{columns}{}end_header\n", attributes.header()).into_bytes();
    let width: usize = groups.iter().map(|(names, _)| names.len()).sum();
    file.reserve(count.saturating_mul(4 * (POSITION.len() + width) + attributes.bytes()));
    for point in 0..*count {
        let numbers = |numbers: &'_ [f32], channels: usize| -> [f32; 12] {
            let first = point.saturating_mul(channels);
            std::array::from_fn(|channel| numbers.get(first.saturating_add(channel)).copied().unwrap_or_default())
        };
        let [x, y, z, ..] = numbers(positions, 3);
        let [_, _, _, from_x, _, _, _, from_y, _, _, _, from_z] = numbers(matrices, MATRIX.len());
        let position = if matrices.is_empty() { [x, y, z] } else { [from_x, from_y, from_z] };
        file.extend(position.iter().flat_map(|number| number.to_le_bytes()));
        for (names, values) in &groups {
            let numbers = numbers(values, names.len());
            file.extend(numbers.iter().take(names.len()).flat_map(|number| number.to_le_bytes()));
        }
        attributes.put(point, &mut file);
    }
    file
}

/// An attribute of points with the names of its columns.
fn attribute_columns<'m>((name, attribute): (&String, &'m MeshAttribute)) -> (Vec<String>, &'m MeshAttribute) {
    (column_names(name, (attribute.channels as usize).min(CHANNELS)), attribute)
}

/// Writer of the attributes of vertices or faces.
struct AttributeWriter<'m> {
    /// Attributes with the names of their columns.
    attributes: Vec<(Vec<String>, &'m MeshAttribute)>,
}

impl<'m> AttributeWriter<'m> {
    fn new(mesh: &'m MeshData, domain: AttributeDomain) -> Self {
        let all = mesh.attributes.iter().filter(|(_, attribute)| attribute.domain == domain);
        let attributes = all.map(|(name, attribute)| {
            let channels = (attribute.channels as usize).min(CHANNELS);
            let names = match COLOR.get(..channels).filter(|_| name == "color" && is_color(attribute)) {
                Some(names) => names.iter().map(|name| (*name).to_owned()).collect(),
                None => column_names(name, channels),
            };
            (names, attribute)
        });
        Self { attributes: attributes.collect() }
    }

    /// Bytes of a row.
    fn bytes(&self) -> usize {
        self.attributes.iter().map(|(names, attribute)| names.len() * kind(&attribute.data).1).sum()
    }

    /// Declarations of the columns.
    fn header(&self) -> String {
        let columns = |(names, attribute): &(Vec<String>, &MeshAttribute)| {
            let kind = kind(&attribute.data).0;
            names.iter().map(|name| format!("property {kind} {name}\n")).collect::<String>()
        };
        self.attributes.iter().map(columns).collect()
    }

    /// Writes the values of a vertex or triangle; numbers that are missing are 0.
    fn put(&self, index: usize, file: &mut Vec<u8>) {
        for (names, attribute) in &self.attributes {
            let first = index.saturating_mul(attribute.channels as usize);
            for at in (0..names.len()).map(|channel| first.saturating_add(channel)) {
                match &attribute.data {
                    AttributeData::U8(values) => file.push(values.get(at).copied().unwrap_or_default()),
                    AttributeData::U16(values) => {
                        file.extend(values.get(at).copied().unwrap_or_default().to_le_bytes());
                    }
                    AttributeData::F32(values) => {
                        file.extend(values.get(at).copied().unwrap_or_default().to_le_bytes());
                    }
                }
            }
        }
    }
}

/// Name and size in bytes of the type of a column.
fn kind(data: &AttributeData) -> (&'static str, usize) {
    match data {
        AttributeData::U8(_) => ("uchar", 1),
        AttributeData::U16(_) => ("ushort", 2),
        AttributeData::F32(_) => ("float", 4),
    }
}

/// Whether an attribute is a color with or without alpha of each vertex, in floats.
fn is_color(attribute: &MeshAttribute) -> bool {
    let is_float = matches!(attribute.data, AttributeData::F32(_));
    attribute.domain == AttributeDomain::Vertex && matches!(attribute.channels, 3 | 4) && is_float
}

fn header(mesh: &MeshData, vertex: &AttributeWriter<'_>, face: &AttributeWriter<'_>) -> String {
    let columns = |exists: bool, names: &[&str]| {
        let names = names.iter().filter(|_| exists);
        names.map(|name| format!("property float {name}\n")).collect::<String>()
    };
    let arrays = [
        columns(true, &["x", "y", "z"]),
        columns(!mesh.normals.is_empty(), &["nx", "ny", "nz"]),
        columns(!mesh.uvs.is_empty(), &["u", "v"]),
        columns(!mesh.uvs1.is_empty(), &["u1", "v1"]),
        columns(!mesh.tangents.is_empty(), &["tx", "ty", "tz", "tw"]),
    ];
    format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{}{}element face {}\nproperty list uchar uint vertex_indices\n{}end_header\n",
        mesh.positions.len(),
        arrays.concat(),
        vertex.header(),
        mesh.triangles.len(),
        face.header()
    )
}

#[cfg(test)]
#[path = "write_tests.rs"]
mod tests;
