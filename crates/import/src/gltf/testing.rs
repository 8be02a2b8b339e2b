//! Small files for tests.

use super::{Gltf, GltfData, GltfError, Limits};
use std::collections::BTreeMap;

/// Members of a document: buffer views and accessors of a binary buffer, and others.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    binary: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    rest: Vec<String>,
}

impl Builder {
    /// Adds a buffer view of `bytes`; `rest` are further members, such as `"byteStride": 8`. Returns
    /// its index.
    pub fn view(&mut self, bytes: &[u8], rest: &str) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let (offset, length) = (self.binary.len(), bytes.len());
        self.binary.extend(bytes);
        self.views.push(object(&[&format!(r#""buffer": 0, "byteOffset": {offset}, "byteLength": {length}"#), rest]));
        self.views.len() - 1
    }

    /// Adds an accessor of the members. Returns its index.
    pub fn accessor(&mut self, members: &str) -> usize {
        self.accessors.push(object(&[members]));
        self.accessors.len() - 1
    }

    /// Adds packed elements with their accessor: type of components, type and number of elements.
    pub fn array(&mut self, component: u32, element: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes, "");
        self.accessor(&format!(
            r#""bufferView": {view}, "componentType": {component}, "type": "{element}", "count": {count}"#
        ))
    }

    /// Adds floating point numbers with their accessor.
    pub fn floats(&mut self, element: &str, width: usize, numbers: &[f32]) -> usize {
        self.array(5126, element, numbers.len() / width, &f32_bytes(numbers))
    }

    /// Adds a member of the document, such as `"meshes": []`.
    pub fn member(&mut self, member: impl Into<String>) {
        self.rest.push(member.into());
    }

    /// Document of all members.
    pub fn json(&self) -> String {
        let mut members = vec![r#""asset": {"version": "2.0"}"#.to_owned()];
        if !self.binary.is_empty() {
            members.push(format!(r#""buffers": [{{"byteLength": {}}}]"#, self.binary.len()));
        }
        for (name, list) in [("bufferViews", &self.views), ("accessors", &self.accessors)] {
            if !list.is_empty() {
                members.push(format!(r#""{name}": [{}]"#, list.join(", ")));
            }
        }
        let all: Vec<&str> = members.iter().chain(&self.rest).map(String::as_str).collect();
        object(&all)
    }

    /// The file.
    pub fn glb(&self) -> Vec<u8> {
        glb(&self.json(), &self.binary)
    }

    /// Opens the file.
    pub fn open(&self) -> Result<Gltf, GltfError> {
        Gltf::open("a.glb", self.glb(), &Limits::default())
    }

    /// Opens the file and loads its buffers.
    pub fn load(&self) -> GltfData {
        self.open().and_then(|gltf| gltf.load(&BTreeMap::new())).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Bytes of numbers.
pub fn f32_bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A binary file of a document and a buffer.
pub fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let chunk = |kind: &[u8; 4], data: Vec<u8>| [&(data.len() as u32).to_le_bytes()[..], kind, &data].concat();
    let mut body = chunk(b"JSON", padded(json.as_bytes(), b' '));
    if !binary.is_empty() {
        body.extend(chunk(b"BIN\0", padded(binary, 0)));
    }
    [b"glTF", &2_u32.to_le_bytes()[..], &(body.len() as u32 + 12).to_le_bytes(), &body].concat()
}

/// JSON object of members; empty ones are left out.
fn object(members: &[&str]) -> String {
    let members: Vec<&str> = members.iter().copied().filter(|member| !member.is_empty()).collect();
    format!("{{{}}}", members.join(", "))
}
