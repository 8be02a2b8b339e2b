//! Memory to open an OBJ and to translate it to parts of a scene, from a count of its statements
//! and from its libraries. Pictures count as they are encoded; those that are decoded to recognize
//! normal maps count by their heads.

use super::files::{Reader, folder_of};
use super::mtl::{MtlMaterial, parse_mtl};
use super::pieces::MAX_OBJECTS;
use crate::gltf::Warnings;
use juggler_imaging::{Limits, raster_head};
use juggler_scene::model::{Files, ModelNeeds};
use std::collections::BTreeSet;
use std::io::Cursor;

/// Bytes of an object, with its names and its mesh without arrays.
const OBJECT: u64 = 1200;

/// Memory that an OBJ needs; `files` has the files that it names.
pub fn needs(bytes: &[u8], files: &dyn Files) -> ModelNeeds {
    let counts = Counts::new(bytes);
    let pictures = Pictures::new(&counts, files);
    let reading = counts.arrays().max((bytes.len() as u64).saturating_add(pictures.decoding));
    let objects = counts.sections.min(MAX_OBJECTS as u64).saturating_mul(OBJECT);
    let parts = [reading, objects, pictures.encoded].into_iter();
    ModelNeeds { bytes: parts.fold(0, u64::saturating_add), solids: 0 }
}

/// Statements of an OBJ.
#[derive(Debug, Default)]
struct Counts<'o> {
    /// Bytes of the file.
    bytes: u64,
    positions: u64,
    normals: u64,
    coordinates: u64,
    corners: u64,
    triangles: u64,
    /// Statements that begin an object, a group or a material.
    sections: u64,
    /// Rests of the statements `mtllib`.
    libraries: Vec<&'o str>,
    /// Names of materials that are used.
    materials: BTreeSet<&'o str>,
}

impl<'o> Counts<'o> {
    fn new(bytes: &'o [u8]) -> Self {
        let mut counts = Self { bytes: bytes.len() as u64, ..Self::default() };
        for line in bytes.split(|byte| *byte == b'\n') {
            let line = line.trim_ascii();
            let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
            let (word, rest) = line.split_at(end);
            counts.add(word, rest.trim_ascii());
        }
        counts
    }

    fn add(&mut self, word: &[u8], rest: &'o [u8]) {
        let text = || str::from_utf8(rest).ok();
        match word {
            b"v" => self.positions += 1,
            b"vn" => self.normals += 1,
            b"vt" => self.coordinates += 1,
            b"f" => {
                let words = rest.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
                let corners = words.count() as u64;
                self.corners += corners;
                self.triangles += corners.saturating_sub(2);
            }
            b"o" | b"g" => self.sections += 1,
            b"usemtl" => {
                self.sections += 1;
                self.materials.extend(text());
            }
            b"mtllib" => self.libraries.extend(text()),
            _ => {}
        }
    }

    /// Bytes of the arrays at the peak: the file with its tables and the mesh of all faces, or that
    /// mesh with the meshes of the objects.
    fn arrays(&self) -> u64 {
        let vertex = 12 + if self.normals > 0 { 12 } else { 0 } + if self.coordinates > 0 { 8 } else { 0 };
        // Corners of equal positions may differ in normals.
        let distinct = self.positions.max(self.normals).max(self.coordinates);
        let vertices = distinct.saturating_add(distinct / 4).min(self.corners);
        let mesh = vertices.saturating_mul(vertex).saturating_add(self.triangles.saturating_mul(12));
        let tables = (self.positions + self.normals).saturating_mul(12).saturating_add(self.coordinates * 8);
        let reading = self.bytes.saturating_add(tables).saturating_add(self.corners.saturating_mul(12));
        let cutting = mesh.saturating_add(vertices.saturating_mul(8)).saturating_add(self.triangles * 12);
        mesh.saturating_add(reading.max(cutting))
    }
}

/// Memory of the pictures that the materials of an OBJ name.
#[derive(Debug, Default)]
struct Pictures {
    /// Bytes of the files.
    encoded: u64,
    /// Bytes to decode one of them while the OBJ is opened.
    decoding: u64,
}

impl Pictures {
    fn new(counts: &Counts<'_>, files: &dyn Files) -> Self {
        let (mut pictures, mut known) = (Self::default(), BTreeSet::new());
        let mut reader = Reader::new(files);
        for statement in &counts.libraries {
            let words = std::iter::once(*statement).chain(statement.split_whitespace());
            let found = words.filter_map(|name| read("", name.trim_matches('"'), &mut reader)).collect::<Vec<_>>();
            for (library, bytes) in found {
                let materials = parse_mtl(&library, &bytes, &mut Warnings::default()).unwrap_or_default();
                let used = materials.iter().filter(|material| counts.materials.contains(material.name.as_str()));
                for material in used {
                    pictures.add(material, folder_of(&library), &mut reader, &mut known);
                }
            }
        }
        pictures
    }

    fn add(
        &mut self,
        material: &MtlMaterial,
        folder: &str,
        reader: &mut Reader<'_>,
        known: &mut BTreeSet<(String, bool)>,
    ) {
        for (word, map) in &material.maps {
            let is_decoded = *word == "bump" || reader.is_lenient();
            let is_new = known.insert((format!("{folder}/{}", map.file), is_decoded));
            let Some((name, bytes)) = is_new.then(|| read(folder, &map.file, reader)).flatten() else { continue };
            self.encoded = self.encoded.saturating_add(bytes.len() as u64);
            // Decoders copy some files.
            let length = bytes.len() as u64;
            let head = raster_head(&name, Cursor::new(&bytes), &Limits::default()).ok().filter(|_| is_decoded);
            let decoding = head.map(|head| head.samples_bytes().saturating_add(head.decoder_bytes));
            self.decoding = self.decoding.max(decoding.map_or(0, |bytes| bytes.saturating_add(length)));
        }
    }
}

fn read(folder: &str, name: &str, reader: &mut Reader<'_>) -> Option<(String, Vec<u8>)> {
    reader.find(folder, name, "", &mut Warnings::default()).ok().flatten()
}

#[cfg(test)]
mod tests {
    use super::super::ObjFormat;
    use juggler_scene::model::ModelFormat;
    use std::collections::BTreeMap;

    #[test]
    fn groups_vertices_and_pictures_count() {
        let mut files = BTreeMap::new();
        let needs = |text: &str, files: &BTreeMap<String, Vec<u8>>| ObjFormat.needs(text.as_bytes().to_vec(), files);
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\n";
        let groups = |count: usize| needs(&format!("g a\n{triangle}").repeat(count), &files).bytes;
        let group = (groups(2000) - groups(1000)) / 1000;
        assert!((1300..1500).contains(&group), "{group}");
        let text = format!("mtllib a.mtl\nusemtl a\n{triangle}");
        files.insert("a.mtl".to_owned(), b"newmtl a\nmap_Kd a.pfm\nbump b.pfm\nnewmtl b\nmap_Kd c.pfm\n".to_vec());
        let picture =
            |side: usize| [format!("PF\n{side} {side}\n-1.0\n").as_bytes(), &vec![0; side * side * 12]].concat();
        let with = |name: &str, side: usize, files: &mut BTreeMap<String, Vec<u8>>| {
            files.insert(name.to_owned(), picture(side));
            needs(&text, files).bytes
        };
        let without = needs(&text, &files).bytes;
        let color = with("a.pfm", 1000, &mut files);
        assert!((12_000_000..12_002_000).contains(&(color - without)), "{color} - {without}");
        // The picture for relief is decoded when the file is opened; that of another material is
        // not read.
        let relief = with("b.pfm", 1000, &mut files);
        assert!((60_000_000..70_000_000).contains(&(relief - color)), "{relief} - {color}");
        assert_eq!(with("c.pfm", 1000, &mut files), relief);
    }
}
