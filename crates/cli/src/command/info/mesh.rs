//! Contents of a mesh file, repairs and omissions on import, and load times.

use super::rows::{bounds_text, corners, row};
use crate::failure::Failure;
use crate::format::bytes;
use juggler::math::Aabb;
use juggler::mesh::{MeshFile, MeshLimits, load};
use juggler::shape::{Mesh, Shape};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// A mesh file, loaded and built for tracing.
pub struct Report<'n> {
    name: &'n str,
    file_bytes: u64,
    vertices: usize,
    triangles: usize,
    normals: bool,
    uvs: bool,
    bounds: Aabb,
    geometry_bytes: usize,
    bvh_bytes: usize,
    /// Time to read the file, in seconds.
    load: f64,
    /// Time to build the bounding volume hierarchy, in seconds.
    build: f64,
    warnings: Vec<String>,
}

impl<'n> Report<'n> {
    /// Loads the mesh file of this name.
    pub fn of(name: &'n str) -> Result<Self, Failure> {
        let path = Path::new(name);
        let start = Instant::now();
        let MeshFile { mesh, mut warnings, .. } = load(path, &MeshLimits::default())?;
        let load = start.elapsed().as_secs_f64();
        let (vertices, normals, uvs) = (mesh.positions.len(), !mesh.normals.is_empty(), !mesh.uvs.is_empty());
        let start = Instant::now();
        let mut mesh = Mesh::from(mesh);
        mesh.prepare().map_err(|invalid| Failure::Invalid(format!("`{name}` contains an invalid mesh: {invalid}")))?;
        let build = start.elapsed().as_secs_f64();
        warnings.extend(mesh.warnings());
        Ok(Self {
            name,
            file_bytes: std::fs::metadata(path).map_or(0, |metadata| metadata.len()),
            vertices,
            triangles: mesh.triangles(),
            normals,
            uvs,
            bounds: mesh.bounds(),
            geometry_bytes: mesh.heap_bytes(),
            bvh_bytes: mesh.bvh_bytes(),
            load,
            build,
            warnings,
        })
    }

    /// Report as text or as one JSON object.
    pub fn text(&self, json: bool) -> String {
        if json { self.to_json() } else { self.to_words() }
    }

    fn to_words(&self) -> String {
        let attributes = [("normals", self.normals), ("surface coordinates", self.uvs)];
        let attributes: Vec<&str> =
            attributes.into_iter().filter(|(_, is_there)| *is_there).map(|(what, _)| what).collect();
        let attributes = attributes.join(", ");
        let speed = self.file_bytes as f64 / 1e6 / self.load.max(1e-9);
        let mut lines = vec![
            self.name.to_owned(),
            row("triangles", &self.triangles.to_string()),
            row("vertices", &self.vertices.to_string()),
            row("with", if attributes.is_empty() { "positions only" } else { &attributes }),
            row("bounds", &bounds_text(&self.bounds)),
            row(
                "memory",
                &format!("{} shapes, {} tree", bytes(self.geometry_bytes as u64), bytes(self.bvh_bytes as u64)),
            ),
            row("file", &format!("{}, loaded in {:.3} s ({speed:.0} MB/s)", bytes(self.file_bytes), self.load)),
            row("tree", &format!("built in {:.3} s", self.build)),
        ];
        lines.extend(self.warnings.iter().map(|warning| row("note", warning)));
        lines.join("\n")
    }

    fn to_json(&self) -> String {
        json!({
            "version": 1,
            "mesh": self.name,
            "triangles": self.triangles,
            "vertices": self.vertices,
            "normals": self.normals,
            "uvs": self.uvs,
            "bounds": corners(&self.bounds),
            "memory": {"geometry_bytes": self.geometry_bytes, "bvh_bytes": self.bvh_bytes},
            "file_bytes": self.file_bytes,
            "seconds": {"load": self.load, "build": self.build},
            "warnings": self.warnings,
        })
        .to_string()
    }
}
