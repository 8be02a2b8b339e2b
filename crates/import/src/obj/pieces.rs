//! Objects of an OBJ: one for each object, group and material, and normals by smoothing groups.

use crate::textures::VERTEX_COLORS;
use juggler_math::{DVec3, Vec3};
use juggler_mesh::ObjModel;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use juggler_shape::{Mesh, MeshData};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Maximum number of objects. In files with more, objects and groups are ignored.
pub const MAX_OBJECTS: usize = 65_536;
/// Mark of a vertex without a number.
const NONE: u32 = u32::MAX;

/// Faces of one object and material.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Name of the object and its group; `None` if the file names neither.
    pub name: Option<String>,
    /// Name of the material.
    pub material: Option<Arc<str>>,
    /// The faces.
    pub mesh: Mesh,
}

/// Object, group and material of faces.
type Key = [Option<Arc<str>>; 3];

/// Pieces of a model, in the order of their first faces. The flag tells whether objects and groups
/// are ignored because they are too many.
pub fn pieces(mut model: ObjModel) -> (Vec<Piece>, bool) {
    smooth(&mut model);
    let by_key = |keeps_names: bool| {
        let mut numbers = BTreeMap::<Key, usize>::new();
        let mut found: Vec<(Key, Vec<[u32; 3]>)> = Vec::new();
        for (key, triangles) in runs(&model) {
            let [object, group, material] = key;
            let key = if keeps_names { [object, group, material] } else { [None, None, material] };
            let number = *numbers.entry(key.clone()).or_insert_with(|| {
                found.push((key, Vec::new()));
                found.len() - 1
            });
            if let Some((_, list)) = found.get_mut(number) {
                list.extend(triangles);
            }
        }
        found
    };
    let found = by_key(true);
    let is_merged = found.len() > MAX_OBJECTS;
    let found = if is_merged { by_key(false) } else { found };
    let mut part = parts(&model.mesh);
    let pieces = found.into_iter().map(|([object, group, material], triangles)| Piece {
        name: name(object.as_deref(), group.as_deref()),
        material,
        mesh: part(&triangles).into(),
    });
    (pieces.collect(), is_merged)
}

/// Triangles with their object, group and material, by sections.
fn runs(model: &ObjModel) -> impl Iterator<Item = (Key, &[[u32; 3]])> {
    let count = model.mesh.triangles.len();
    let first = model.sections.first().map_or(count, |section| section.first);
    let ends = model.sections.iter().skip(1).map(|section| section.first).chain([count]);
    let sections = model.sections.iter().zip(ends).map(|(section, end)| {
        let key = [section.object.clone(), section.group.clone(), section.material.clone()];
        (key, section.first, end)
    });
    let all = std::iter::once((Key::default(), 0, first)).chain(sections);
    all.filter_map(|(key, first, end)| Some((key, model.mesh.triangles.get(first..end)?)))
        .filter(|(_, triangles)| !triangles.is_empty())
}

/// Name of an object and its group.
fn name(object: Option<&str>, group: Option<&str>) -> Option<String> {
    match (object, group) {
        (Some(object), Some(group)) if object != group => Some(format!("{object}/{group}")),
        (name, other) => name.or(other).map(str::to_owned),
    }
}

/// Function from some triangles of a mesh to a mesh of them and the vertices that they use, in the
/// order of their first use.
pub fn parts(whole: &MeshData) -> impl FnMut(&[[u32; 3]]) -> MeshData {
    let mut numbers = vec![NONE; whole.positions.len()];
    move |triangles| part(whole, triangles, &mut numbers)
}

/// Mesh of some triangles. All of `numbers` is [`NONE`] before and after.
fn part(whole: &MeshData, triangles: &[[u32; 3]], numbers: &mut [u32]) -> MeshData {
    let mut used: Vec<u32> = Vec::new();
    let mut number = |vertex: u32| match numbers.get_mut(vertex as usize) {
        Some(number) => {
            if *number == NONE {
                *number = used.len() as u32;
                used.push(vertex);
            }
            *number
        }
        None => 0,
    };
    let triangles = triangles.iter().map(|corners| corners.map(&mut number)).collect();
    for vertex in &used {
        if let Some(number) = numbers.get_mut(*vertex as usize) {
            *number = NONE;
        }
    }
    let attributes = colors(whole).map(|colors| {
        let values = used.iter().filter_map(|vertex| colors.get(*vertex as usize).copied());
        (VERTEX_COLORS.to_owned(), attribute(&values.collect::<Vec<_>>()))
    });
    MeshData {
        positions: pick(&whole.positions, &used),
        triangles,
        normals: pick(&whole.normals, &used),
        uvs: pick(&whole.uvs, &used),
        attributes: attributes.into_iter().collect(),
        ..MeshData::default()
    }
}

/// Values of some vertices; empty if the mesh has none.
fn pick<T: Copy>(values: &[T], used: &[u32]) -> Vec<T> {
    used.iter().filter_map(|vertex| values.get(*vertex as usize).copied()).collect()
}

/// Colors of the vertices, if the mesh has them.
fn colors(mesh: &MeshData) -> Option<&[[f32; 3]]> {
    match mesh.attributes.get(VERTEX_COLORS).map(|attribute| (&attribute.data, attribute.channels)) {
        Some((AttributeData::F32(values), 3)) => Some(values.as_chunks::<3>().0),
        _ => None,
    }
}

fn attribute(colors: &[[f32; 3]]) -> MeshAttribute {
    let data = AttributeData::F32(colors.as_flattened().to_vec());
    MeshAttribute { domain: AttributeDomain::Vertex, channels: 3, data }
}

/// Gives vertices without normals the normals of their smoothing groups: means of the triangles'
/// normals weighted by area. Vertices that several groups share are split. Triangles without a
/// smoothing group stay flat.
fn smooth(model: &mut ObjModel) {
    let mut groups = BTreeMap::<u32, Vec<usize>>::new();
    let ends = model.sections.iter().skip(1).map(|section| section.first).chain([model.mesh.triangles.len()]);
    for (section, end) in model.sections.iter().zip(ends) {
        groups.entry(section.smoothing).or_default().extend(section.first..end);
    }
    let first = model.sections.first().map_or(0, |section| section.first);
    groups.entry(0).or_default().extend(0..first);
    if groups.keys().all(|group| *group == 0) {
        return;
    }
    let missing = Vec3::ZERO;
    model.mesh.normals.resize(model.mesh.positions.len(), missing);
    let count = model.positions.iter().max().map_or(0, |last| *last as usize + 1);
    let mut work = Smoothing {
        has_normal: model.mesh.normals.iter().map(|normal| *normal != missing).collect(),
        owners: vec![None; model.mesh.positions.len()],
        copies: vec![NONE; model.mesh.positions.len()],
        sums: vec![DVec3::ZERO; count],
        added: Vec::new(),
    };
    for (group, triangles) in &groups {
        work.group(model, *group, triangles);
    }
    let Smoothing { added, .. } = work;
    let mesh = &mut model.mesh;
    let split: Option<Vec<[f32; 3]>> = colors(mesh).map(|colors| [colors, &pick(colors, &added)].concat());
    if let Some(colors) = split {
        mesh.attributes.insert(VERTEX_COLORS.to_owned(), attribute(&colors));
    }
    mesh.uvs.extend(pick(&mesh.uvs, &added));
}

/// Working memory of [`smooth`].
struct Smoothing {
    /// Whether each vertex of the file has a normal.
    has_normal: Vec<bool>,
    /// Smoothing group that each vertex was given to.
    owners: Vec<Option<u32>>,
    /// Copy of each vertex in the current group.
    copies: Vec<u32>,
    /// Sums of normals by position, all zero between groups.
    sums: Vec<DVec3>,
    /// Vertices that were copied, in the order of their copies.
    added: Vec<u32>,
}

impl Smoothing {
    /// Sets the normals of a group's vertices.
    fn group(&mut self, model: &mut ObjModel, group: u32, triangles: &[usize]) {
        let mut own: Vec<(u32, u32)> = Vec::new();
        for triangle in triangles {
            let Some(corners) = model.mesh.triangles.get(*triangle).copied() else { continue };
            let points = corners.map(|corner| model.mesh.positions.get(corner as usize).copied().unwrap_or_default());
            let [a, b, c] = points.map(|point| point.as_dvec3());
            let normal = (b - a).cross(c - a);
            for corner in corners {
                let position = model.positions.get(corner as usize).copied().unwrap_or_default();
                if let Some(sum) = self.sums.get_mut(position as usize) {
                    *sum += normal;
                }
            }
            let renamed = corners.map(|corner| self.corner(model, group, corner, &mut own));
            if let Some(corners) = model.mesh.triangles.get_mut(*triangle) {
                *corners = renamed;
            }
        }
        for (original, vertex) in &own {
            let position = model.positions.get(*original as usize).copied().unwrap_or_default();
            let sum = self.sums.get(position as usize).copied().unwrap_or_default();
            let normal = model.mesh.normals.get_mut(*vertex as usize).filter(|_| group != 0);
            normal.into_iter().for_each(|normal| *normal = sum.normalize_or_zero().as_vec3());
            if let Some(copy) = self.copies.get_mut(*original as usize) {
                *copy = NONE;
            }
        }
        for triangle in triangles {
            let corners = model.mesh.triangles.get(*triangle).copied().unwrap_or_default();
            for corner in corners {
                let position = model.positions.get(corner as usize).copied().unwrap_or_default();
                self.sums.get_mut(position as usize).into_iter().for_each(|sum| *sum = DVec3::ZERO);
            }
        }
    }

    /// Vertex of a corner in a group: the corner's own, or a copy if another group has that one.
    /// Adds to `own` the vertices that are new to the group.
    fn corner(&mut self, model: &mut ObjModel, group: u32, corner: u32, own: &mut Vec<(u32, u32)>) -> u32 {
        let at = corner as usize;
        if self.has_normal.get(at).copied().unwrap_or(true) {
            return corner;
        }
        let (Some(owner), Some(copy)) = (self.owners.get_mut(at), self.copies.get_mut(at)) else { return corner };
        match owner {
            None => {
                *owner = Some(group);
                own.push((corner, corner));
                corner
            }
            Some(owner) if *owner == group => corner,
            Some(_) if *copy != NONE => *copy,
            Some(_) => {
                let mesh = &mut model.mesh;
                *copy = mesh.positions.len() as u32;
                mesh.positions.extend(mesh.positions.get(at).copied());
                mesh.normals.push(Vec3::ZERO);
                model.positions.extend(model.positions.get(at).copied());
                self.added.push(corner);
                own.push((corner, *copy));
                *copy
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_mesh::{MeshLimits, parse_obj};
    use std::path::Path;

    fn read(text: &str) -> Vec<Piece> {
        pieces(parse_obj(Path::new("a.obj"), text.as_bytes(), &MeshLimits::default()).unwrap()).0
    }

    /// Two squares with a common edge, bent along it by a right angle.
    const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n";

    #[test]
    fn pieces_follow_objects_groups_and_materials() {
        let text = format!(
            "{CORNER}f 1 2 3\no a\nusemtl x\nf 1 2 3 4\nusemtl y\nf 2 5 6 3\ng b\nusemtl x\nf 1 2 3\no a\nf 1 3 4\n"
        );
        let found: Vec<_> = read(&text)
            .into_iter()
            .map(|piece| {
                (piece.name, piece.material, piece.mesh.arrays().positions.len(), piece.mesh.arrays().triangles.len())
            })
            .collect();
        let named = |name: &str, material: &str, vertices, triangles| {
            (Some(name.to_owned()), Some(material.into()), vertices, triangles)
        };
        let expected = [(None, None, 3, 1), named("a", "x", 4, 3), named("a", "y", 4, 2), named("a/b", "x", 3, 1)];
        assert_eq!(found, expected);
    }

    #[test]
    fn smoothing_groups_decide_normals() {
        let normals = |text: &str| read(&format!("{CORNER}{text}")).remove(0).mesh.arrays().normals.clone();
        assert!(normals("f 1 2 3 4\nf 2 5 6 3\n").is_empty());
        assert!(normals("s off\nf 1 2 3 4\nf 2 5 6 3\n").is_empty());
        let smooth = normals("s 1\nf 1 2 3 4\nf 2 5 6 3\n");
        assert_eq!(smooth.len(), 6);
        // The diagonals give vertex 1 of the first square and 2 and 3 of both different weights.
        assert_eq!((smooth[0], smooth[3]), (Vec3::Z, Vec3::Z));
        assert!(smooth[1].x > 0.1 && smooth[1].z > 0.1, "{smooth:?}");
        let split = normals("s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
        assert_eq!((split.len(), split.iter().filter(|normal| **normal == Vec3::X).count()), (8, 4));
        let partly = normals("s 1\nf 1 2 3 4\ns off\nf 2 5 6 3\n");
        assert_eq!((partly.len(), partly.iter().filter(|normal| **normal == Vec3::ZERO).count()), (8, 4));
    }

    #[test]
    fn given_normals_stay_and_colors_are_split() {
        let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvn 0 1 0\ns 1\nf 1//1 2 3\ns 2\nf 3 2 1\n";
        let piece = read(text).remove(0);
        let arrays = piece.mesh.arrays();
        assert_eq!(arrays.normals.iter().filter(|normal| **normal == Vec3::Y).count(), 1);
        assert_eq!(colors(arrays).unwrap().len(), arrays.positions.len());
        assert_eq!(arrays.positions.len(), 6);
    }
}
