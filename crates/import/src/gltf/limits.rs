//! Maximum sizes of a glTF file and of what it describes.

/// Maximum sizes of a file and its contents. A file that exceeds one of them is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the file.
    pub file_bytes: u64,
    /// Bytes of each buffer and each other file that the document names.
    pub buffer_bytes: u64,
    /// Bytes of the JSON text.
    pub json_bytes: u64,
    /// Nesting of arrays and objects in the JSON text.
    pub json_nesting: usize,
    /// Number of arrays and objects in the JSON text.
    pub json_containers: usize,
    /// Number of nodes; also that of meshes.
    pub nodes: usize,
    /// Number of nodes on the path from a root to a node.
    pub node_depth: usize,
    /// Number of accessors; also that of buffer views.
    pub accessors: usize,
    /// Number of materials.
    pub materials: usize,
    /// Number of vertices of a primitive.
    pub vertices: u64,
    /// Number of triangles of a primitive.
    pub triangles: u64,
    /// Number of points and line segments of a file. Primitives that exceed it are left out with a
    /// warning.
    pub points_and_lines: u64,
    /// Number of instances of a node (EXT_mesh_gpu_instancing).
    pub instances: u64,
    /// Number of joints of a skin.
    pub joints: usize,
    /// Number of morph targets of a primitive.
    pub targets: usize,
    /// Number of channels of an animation.
    pub channels: usize,
    /// Number of keys of an animation sampler.
    pub keys: u64,
    /// Number of bytes of all decoded arrays. [`Limits::decoded_bytes_of`] is another limit.
    pub decoded_bytes: u64,
    /// Number of faults that an error lists.
    pub faults: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 4 << 30,
            buffer_bytes: 4 << 30,
            json_bytes: 256 << 20,
            json_nesting: 64,
            json_containers: 16_000_000,
            nodes: 4_000_000,
            node_depth: 10_000,
            accessors: 1_000_000,
            materials: 65_536,
            vertices: 1 << 28,
            triangles: 1 << 28,
            points_and_lines: 1_000_000,
            instances: 4_000_000,
            joints: 65_535,
            targets: 4_096,
            channels: 65_536,
            keys: 10_000_000,
            decoded_bytes: u64::MAX,
            faults: 200,
        }
    }
}

impl Limits {
    /// Maximum number of decoded bytes of a file of `bytes` bytes, its buffers included: 64 MiB and
    /// 1,000 times its bytes, at most [`Limits::decoded_bytes`].
    pub fn decoded_bytes_of(&self, bytes: u64) -> u64 {
        self.decoded_bytes.min(bytes.saturating_mul(1_000).saturating_add(64 << 20))
    }
}
