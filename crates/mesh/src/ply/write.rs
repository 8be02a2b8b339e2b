//! Meshes as PLY files.

use juggler_shape::MeshData;
use juggler_shape::attribute::{AttributeDomain, MeshAttribute};

/// Names of the columns of a color, of which a color has the first 3 or 4.
const COLOR: [&str; 4] = ["red", "green", "blue", "alpha"];

/// A mesh as a binary PLY file, which the reader reads to the same numbers. `None` if the mesh has
/// attributes other than colors of its vertices, which PLY files do not hold.
pub fn ply_bytes(mesh: &MeshData) -> Option<Vec<u8>> {
    let color = mesh.attributes.get("color").filter(|color| is_color(color));
    if mesh.attributes.len() > usize::from(color.is_some()) {
        return None;
    }
    let mut file = header(mesh, color).into_bytes();
    file.reserve_exact(mesh.positions.len() * 72 + mesh.triangles.len() * 13);
    let mut put = |numbers: &[f32]| file.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    for (i, position) in mesh.positions.iter().enumerate() {
        put(&position.to_array());
        mesh.normals.get(i).into_iter().for_each(|normal| put(&normal.to_array()));
        mesh.uvs.get(i).into_iter().for_each(|uv| put(&uv.to_array()));
        mesh.uvs1.get(i).into_iter().for_each(|uv| put(&uv.to_array()));
        mesh.tangents.get(i).into_iter().for_each(|tangent| put(tangent));
        if let Some(color) = color {
            color.numbers(i).for_each(|number| put(&[number]));
        }
    }
    for triangle in &mesh.triangles {
        file.push(3);
        file.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    Some(file)
}

/// Whether an attribute is a color with or without alpha of each vertex.
fn is_color(attribute: &MeshAttribute) -> bool {
    attribute.domain == AttributeDomain::Vertex && matches!(attribute.channels, 3 | 4)
}

fn header(mesh: &MeshData, color: Option<&MeshAttribute>) -> String {
    let columns = |exists: bool, names: &[&str]| {
        let names = names.iter().filter(|_| exists);
        names.map(|name| format!("property float {name}\n")).collect::<String>()
    };
    let channels = color.map_or(0, |color| color.channels as usize);
    let vertex = [
        columns(true, &["x", "y", "z"]),
        columns(!mesh.normals.is_empty(), &["nx", "ny", "nz"]),
        columns(!mesh.uvs.is_empty(), &["u", "v"]),
        columns(!mesh.uvs1.is_empty(), &["u1", "v1"]),
        columns(!mesh.tangents.is_empty(), &["tx", "ty", "tz", "tw"]),
        columns(true, COLOR.get(..channels).unwrap_or_default()),
    ];
    format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{}element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.positions.len(),
        vertex.concat(),
        mesh.triangles.len()
    )
}

#[cfg(test)]
#[path = "write_tests.rs"]
mod tests;
