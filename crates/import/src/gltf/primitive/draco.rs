//! Hook for Draco compression (KHR_draco_mesh_compression): the compressed data of a primitive, and
//! the arrays that a decoder makes of it.

use crate::gltf::data::GltfData;
use crate::gltf::document::{Attributes, DracoExtension, Semantic};
use crate::gltf::error::Fault;
use std::collections::BTreeMap;

/// Compressed data of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DracoStream<'a> {
    /// The compressed data.
    pub data: &'a [u8],
    /// Identifiers of the attributes in the data.
    pub attributes: &'a Attributes,
}

impl<'a> DracoStream<'a> {
    pub(super) fn new(data: &'a GltfData, draco: &'a DracoExtension) -> Result<Self, Fault> {
        Ok(Self { data: data.view(draco.buffer_view)?, attributes: &draco.attributes })
    }
}

/// Decoded arrays of a primitive.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DracoArrays {
    /// Bytes of each attribute: as many elements as its accessor has, in the accessor's types,
    /// packed and little-endian.
    pub attributes: BTreeMap<Semantic, Vec<u8>>,
    /// Vertex indices of separate triangles.
    pub indices: Vec<u32>,
}
