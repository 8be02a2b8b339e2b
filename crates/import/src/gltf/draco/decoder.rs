//! Calls `draco-core` within limits, and converts its values to the types of accessors.

use super::{ComponentType, DracoAttribute, DracoError, DracoLimits, DracoMesh};
use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute, PointIndex};

/// Decodes a stream, with the values of these attributes, within limits.
///
/// Integers keep their values if the accessor has another integer type. Integers become floating
/// point numbers of the same value, or of the range that normalized integers have if the stream
/// says so.
///
/// # Errors
///
/// The stream is no Draco mesh, is damaged, or exceeds a limit; or an attribute is absent, has
/// another number of components, or has values that the accessor's type cannot hold.
pub fn decode(stream: &[u8], attributes: &[DracoAttribute<'_>], limits: &DracoLimits) -> Result<DracoMesh, DracoError> {
    // The header has the magic number, the version and the kind of geometry (1: a mesh).
    if !matches!(stream, [b'D', b'R', b'A', b'C', b'O', 2, _, 1, ..]) {
        return Err(DracoError::NotAMesh);
    }
    let mesh = decode_mesh(stream, limits)?;
    let vertices = mesh.num_points();
    let index_bytes = (mesh.num_faces() as u64).saturating_mul(12);
    let vertex_bytes: u64 = attributes.iter().map(|attribute| size(attribute) as u64).sum();
    let bytes = vertex_bytes.saturating_mul(vertices as u64).saturating_add(index_bytes);
    if bytes > limits.bytes {
        return Err(DracoError::TooLarge { limit: limits.bytes });
    }
    let indices = indices(&mesh)?;
    let values = attributes.iter().map(|attribute| values(&mesh, attribute));
    Ok(DracoMesh { indices, vertices, attributes: values.collect::<Result<_, _>>()? })
}

/// Runs the decoder within the limits.
fn decode_mesh(stream: &[u8], limits: &DracoLimits) -> Result<Mesh, DracoError> {
    let DracoLimits { triangles, bytes } = *limits;
    let affordable = bytes / 12;
    let decode_limits = DecodeLimits::default()
        .with_max_faces(triangles.min(affordable))
        .with_max_points(bytes)
        .with_max_decoded_bytes(bytes);
    let mut mesh = Mesh::new();
    let mut buffer = DecoderBuffer::new(stream).with_limits(decode_limits);
    let Err(error) = MeshDecoder::new().decode(&mut buffer, &mut mesh) else { return Ok(mesh) };
    Err(if error.kind() != ErrorKind::LimitExceeded {
        DracoError::Decoder { message: error.to_string() }
    } else if error.message().contains("faces") && triangles < affordable {
        DracoError::Triangles { limit: triangles }
    } else {
        DracoError::TooLarge { limit: bytes }
    })
}

/// Indices of all triangles, checked.
fn indices(mesh: &Mesh) -> Result<Vec<u32>, DracoError> {
    let vertices = mesh.num_points();
    if mesh.num_faces() == 0 {
        return Err(DracoError::NoTriangles);
    }
    let is_invalid = |index: &PointIndex| index.0 as usize >= vertices;
    for (triangle, corners) in mesh.faces().iter().enumerate() {
        if let Some(PointIndex(index)) = corners.iter().copied().find(is_invalid) {
            return Err(DracoError::Index { triangle, index, vertices });
        }
    }
    Ok(mesh.faces().iter().flatten().map(|index| index.0).collect())
}

/// Number of bytes of an attribute per vertex.
fn size(attribute: &DracoAttribute<'_>) -> usize {
    attribute.component.bytes() * attribute.components.min(16)
}

/// Values of an attribute at all vertices.
fn values(mesh: &Mesh, request: &DracoAttribute<'_>) -> Result<Vec<u8>, DracoError> {
    let DracoAttribute { name, unique_id, component, components } = *request;
    let stored = mesh.attribute_by_unique_id(unique_id);
    let stored = stored.ok_or_else(|| DracoError::NoAttribute { name: name.to_owned(), unique_id })?;
    let found = usize::from(stored.num_components());
    if found != components {
        return Err(DracoError::Components { name: name.to_owned(), found, expected: components });
    }
    let mismatch = || DracoError::ComponentType {
        name: name.to_owned(),
        found: format!("{:?}", stored.data_type()),
        expected: component,
    };
    let width = stored.data_type().byte_length();
    let mut bytes = Vec::with_capacity(size(request).saturating_mul(mesh.num_points()));
    for vertex in 0..mesh.num_points() {
        let value = value(stored, vertex, width.saturating_mul(components));
        let value = value.ok_or_else(|| DracoError::NoValue { name: name.to_owned(), vertex })?;
        if is_same(stored.data_type(), component) {
            bytes.extend_from_slice(value);
            continue;
        }
        for scalar in value.chunks_exact(width.max(1)) {
            let number = Number::read(stored.data_type(), scalar).ok_or_else(mismatch)?;
            number.write(component, stored, &mut bytes).ok_or_else(mismatch)?;
        }
    }
    Ok(bytes)
}

/// Bytes of an attribute at one vertex.
fn value(stored: &PointAttribute, vertex: usize, size: usize) -> Option<&[u8]> {
    let index = stored.mapped_index(PointIndex(u32::try_from(vertex).ok()?)).0 as usize;
    let stride = usize::try_from(stored.byte_stride()).ok()?;
    let start = index.checked_mul(stride)?;
    stored.buffer().data().get(start..start.checked_add(size)?)
}

/// Whether values of the stream are values of the accessor, without conversion.
fn is_same(stored: DataType, component: ComponentType) -> bool {
    matches!(
        (stored, component),
        (DataType::Int8, ComponentType::I8)
            | (DataType::Uint8, ComponentType::U8)
            | (DataType::Int16, ComponentType::I16)
            | (DataType::Uint16, ComponentType::U16)
            | (DataType::Uint32, ComponentType::U32)
            | (DataType::Float32, ComponentType::F32)
    )
}

/// A component of a value in the stream.
#[derive(Clone, Copy)]
enum Number {
    Integer(i64),
    Float(f32),
}

impl Number {
    /// Reads a little-endian number; `None` for types that glTF cannot have.
    fn read(data_type: DataType, bytes: &[u8]) -> Option<Self> {
        let number = match data_type {
            DataType::Int8 => Self::Integer(i64::from(i8::from_le_bytes(*bytes.first_chunk()?))),
            DataType::Uint8 | DataType::Bool => Self::Integer(i64::from(*bytes.first()?)),
            DataType::Int16 => Self::Integer(i64::from(i16::from_le_bytes(*bytes.first_chunk()?))),
            DataType::Uint16 => Self::Integer(i64::from(u16::from_le_bytes(*bytes.first_chunk()?))),
            DataType::Int32 => Self::Integer(i64::from(i32::from_le_bytes(*bytes.first_chunk()?))),
            DataType::Uint32 => Self::Integer(i64::from(u32::from_le_bytes(*bytes.first_chunk()?))),
            DataType::Float32 => Self::Float(f32::from_le_bytes(*bytes.first_chunk()?)),
            _ => return None,
        };
        Some(number)
    }

    /// Appends the number in the accessor's type; `None` if the type cannot hold it.
    fn write(self, component: ComponentType, stored: &PointAttribute, bytes: &mut Vec<u8>) -> Option<()> {
        match (self, component) {
            (Self::Float(value), ComponentType::F32) => bytes.extend(value.to_le_bytes()),
            (Self::Float(_), _) => return None,
            (Self::Integer(value), ComponentType::F32) => {
                bytes.extend((value as f32 / scale(stored)?).to_le_bytes());
            }
            (Self::Integer(value), ComponentType::I8) => bytes.extend(i8::try_from(value).ok()?.to_le_bytes()),
            (Self::Integer(value), ComponentType::U8) => bytes.extend(u8::try_from(value).ok()?.to_le_bytes()),
            (Self::Integer(value), ComponentType::I16) => bytes.extend(i16::try_from(value).ok()?.to_le_bytes()),
            (Self::Integer(value), ComponentType::U16) => bytes.extend(u16::try_from(value).ok()?.to_le_bytes()),
            (Self::Integer(value), ComponentType::U32) => bytes.extend(u32::try_from(value).ok()?.to_le_bytes()),
        }
        Some(())
    }
}

/// The integer that stands for 1.
fn scale(stored: &PointAttribute) -> Option<f32> {
    match (stored.normalized(), stored.data_type()) {
        (false, _) => Some(1.0),
        (true, DataType::Int8) => Some(127.0),
        (true, DataType::Uint8) => Some(255.0),
        (true, DataType::Int16) => Some(32767.0),
        (true, DataType::Uint16) => Some(65535.0),
        (true, _) => None,
    }
}
