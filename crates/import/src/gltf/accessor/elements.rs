//! Elements of an accessor in the bytes of a file.

use crate::gltf::data::GltfData;
use crate::gltf::document::{Accessor, ComponentType, ElementType, Index};
use crate::gltf::error::Fault;

/// Elements of an accessor, not yet decoded.
pub(in crate::gltf) struct Elements<'a> {
    data: &'a GltfData,
    accessor: &'a Accessor,
    /// JSON pointer of the accessor.
    pointer: String,
    count: usize,
    /// From the first byte of the first element to the last byte of the last; `None` if all
    /// elements are zero.
    bytes: Option<&'a [u8]>,
    stride: usize,
    sparse: Option<SparseElements<'a>>,
}

/// Elements that replace others.
struct SparseElements<'a> {
    indices: Vec<u32>,
    values: &'a [u8],
}

impl<'a> Elements<'a> {
    /// Finds the elements of an accessor.
    pub fn new(data: &'a GltfData, index: Index) -> Result<Self, Fault> {
        let mut elements = Self::without_bytes(data, index)?;
        let accessor = elements.accessor;
        if let Some(view) = accessor.buffer_view {
            let stride = data.gltf.document.buffer_views.get(view.get()).and_then(|view| view.byte_stride);
            elements.stride = stride.map_or(elements.stride, Index::get);
            let bytes = elements.slice(view, accessor.byte_offset.get(), elements.count, elements.stride)?;
            elements.bytes = Some(bytes);
        }
        elements.sparse = elements.find_sparse()?;
        Ok(elements)
    }

    /// Elements of an accessor in packed bytes that replace those of the file.
    pub fn from_packed(data: &'a GltfData, index: Index, bytes: &'a [u8]) -> Result<Self, Fault> {
        let mut elements = Self::without_bytes(data, index)?;
        let needed = elements.byte_length(elements.count, elements.stride);
        if bytes.len() as u64 != needed {
            let text = format!("has {needed} bytes, its decoded data has {}", bytes.len());
            return Err(Fault::at(&elements.pointer, text));
        }
        elements.bytes = Some(bytes);
        Ok(elements)
    }

    fn without_bytes(data: &'a GltfData, index: Index) -> Result<Self, Fault> {
        let pointer = format!("/accessors/{index}");
        let accessor = data.gltf.document.accessors.get(index.get());
        let accessor = accessor.ok_or_else(|| Fault::at(&pointer, "there is no such accessor"))?;
        let count = usize::try_from(accessor.count.get()).map_err(|_| Fault::at(&pointer, "has too many elements"))?;
        Ok(Self { data, accessor, pointer, count, bytes: None, stride: accessor.packed_stride(), sparse: None })
    }

    /// Number of components of an element.
    pub fn components(&self) -> usize {
        self.accessor.element_type.components()
    }

    /// Type of an element.
    pub fn element_type(&self) -> ElementType {
        self.accessor.element_type
    }

    /// Bytes from the first element to the end of the last of `count`, at least one.
    fn byte_length(&self, count: usize, stride: usize) -> u64 {
        let before = (count as u64).saturating_sub(1).saturating_mul(stride as u64);
        before.saturating_add(self.accessor.element_bytes() as u64)
    }

    /// Bytes of elements in a buffer view.
    fn slice(&self, view: Index, offset: u64, count: usize, stride: usize) -> Result<&'a [u8], Fault> {
        self.bytes_of_view(view, offset, self.byte_length(count, stride))
    }

    fn bytes_of_view(&self, view: Index, offset: u64, length: u64) -> Result<&'a [u8], Fault> {
        let bytes = self.data.view(view)?;
        let start = usize::try_from(offset).ok();
        let end = offset.checked_add(length).and_then(|end| usize::try_from(end).ok());
        let available = bytes.len();
        let text = || format!("needs {length} bytes from byte {offset}, bufferView {view} has {available}");
        start.zip(end).and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| Fault::at(&self.pointer, text()))
    }

    /// Finds the sparse elements; their indices must rise and exist.
    fn find_sparse(&self) -> Result<Option<SparseElements<'a>>, Fault> {
        let Some(sparse) = &self.accessor.sparse else { return Ok(None) };
        let fault = |text: String| Fault::at(format!("{}/sparse/indices", self.pointer), text);
        let count = usize::try_from(sparse.count.get()).map_err(|_| fault("too many elements".to_owned()))?;
        let values = self.slice(
            sparse.values.buffer_view,
            sparse.values.byte_offset.get(),
            count,
            self.accessor.packed_stride(),
        )?;
        let size = sparse.indices.component_type.bytes();
        let length = (count as u64).saturating_mul(size as u64);
        let bytes = self.bytes_of_view(sparse.indices.buffer_view, sparse.indices.byte_offset.get(), length)?;
        self.data.reserve(&self.pointer, (count as u64).saturating_mul(4))?;
        let indices: Vec<u32> = bytes.chunks_exact(size).map(unsigned).collect();
        if let Some((position, index)) = indices.iter().enumerate().find(|(_, index)| **index as usize >= self.count) {
            return Err(fault(format!("index {index} at element {position}, there are {} elements", self.count)));
        }
        let falling = indices.windows(2).position(|pair| matches!(pair, [a, b] if a >= b));
        match falling.map(|position| position + 1) {
            Some(position) => Err(fault(format!("the index at element {position} is not greater than that before it"))),
            None => Ok(Some(SparseElements { indices, values })),
        }
    }

    /// Decodes the elements to numbers of single precision. Fails if the accessor has not `N`
    /// components.
    pub fn floats<T: Clone, const N: usize>(&self, make: impl Fn([f32; N]) -> T) -> Result<Vec<T>, Fault> {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        match (self.accessor.component_type, self.accessor.normalized) {
            (F32, _) => self.finite(make),
            (U32, _) => self.decode(|bytes| u32::from_le_bytes(bytes) as f32, make),
            (U8, false) => self.decode(|[byte]| f32::from(byte), make),
            (I8, false) => self.decode(|[byte]| f32::from(byte.cast_signed()), make),
            (U16, false) => self.decode(|bytes| f32::from(u16::from_le_bytes(bytes)), make),
            (I16, false) => self.decode(|bytes| f32::from(i16::from_le_bytes(bytes)), make),
            (U8, true) => self.decode(|[byte]| f32::from(byte) / 255.0, make),
            (I8, true) => self.decode(|[byte]| (f32::from(byte.cast_signed()) / 127.0).max(-1.0), make),
            (U16, true) => self.decode(|bytes| f32::from(u16::from_le_bytes(bytes)) / 65535.0, make),
            (I16, true) => self.decode(|bytes| (f32::from(i16::from_le_bytes(bytes)) / 32767.0).max(-1.0), make),
        }
    }

    /// Decodes the elements to indices.
    pub fn indices(&self) -> Result<Vec<u32>, Fault> {
        let make = |[index]: [u32; 1]| index;
        match self.accessor.component_type {
            ComponentType::U8 => self.decode(|[byte]| u32::from(byte), make),
            ComponentType::U16 => self.decode(|bytes| u32::from(u16::from_le_bytes(bytes)), make),
            ComponentType::U32 => self.decode(u32::from_le_bytes, make),
            other => Err(Fault::at(&self.pointer, format!("indices cannot be {}", other.name()))),
        }
    }

    /// Decodes the elements to indices of joints.
    pub fn joints(&self) -> Result<Vec<[u16; 4]>, Fault> {
        match self.accessor.component_type {
            ComponentType::U8 => self.decode(|[byte]| u16::from(byte), |joints| joints),
            ComponentType::U16 => self.decode(u16::from_le_bytes, |joints| joints),
            other => Err(Fault::at(&self.pointer, format!("joints cannot be {}", other.name()))),
        }
    }

    /// Decodes floating point numbers, which must be finite.
    fn finite<T: Clone, const N: usize>(&self, make: impl Fn([f32; N]) -> T) -> Result<Vec<T>, Fault> {
        let is_finite = std::cell::Cell::new(true);
        let decoded = self.decode(f32::from_le_bytes, |element: [f32; N]| {
            let finite = element.iter().fold(true, |all, number| all & number.is_finite());
            is_finite.set(is_finite.get() & finite);
            make(element)
        })?;
        if is_finite.get() {
            return Ok(decoded);
        }
        let numbers: Vec<[f32; N]> = self.decode(f32::from_le_bytes, |element| element)?;
        let numbers = numbers.as_flattened();
        let position = numbers.iter().position(|number| !number.is_finite());
        let Some((position, number)) = position.and_then(|position| Some((position, numbers.get(position)?))) else {
            return Ok(decoded);
        };
        let (element, component) = (position / N, position % N);
        Err(Fault::at(&self.pointer, format!("component {component} of element {element} is {number}")))
    }

    /// Decodes elements of `N` components of `B` bytes.
    fn decode<C: Copy + Default, T: Clone, const N: usize, const B: usize>(
        &self,
        convert: impl Fn([u8; B]) -> C,
        make: impl Fn([C; N]) -> T,
    ) -> Result<Vec<T>, Fault> {
        if self.components() != N {
            let name = self.element_type().name();
            return Err(Fault::at(&self.pointer, format!("is {name}, expected {N} components")));
        }
        self.data.reserve(&self.pointer, (self.count as u64).saturating_mul(size_of::<T>() as u64))?;
        let mut decoded = match self.bytes {
            Some(bytes) => self.decode_bytes(bytes, self.stride, &convert, &make),
            None => vec![make([C::default(); N]); self.count],
        };
        if let Some(sparse) = &self.sparse {
            let values = self.decode_bytes(sparse.values, self.accessor.packed_stride(), &convert, &make);
            for (index, value) in sparse.indices.iter().zip(values) {
                if let Some(element) = decoded.get_mut(*index as usize) {
                    *element = value;
                }
            }
        }
        Ok(decoded)
    }

    fn decode_bytes<C: Copy + Default, T, const N: usize, const B: usize>(
        &self,
        bytes: &[u8],
        stride: usize,
        convert: &impl Fn([u8; B]) -> C,
        make: &impl Fn([C; N]) -> T,
    ) -> Vec<T> {
        let (columns, rows) = self.element_type().shape();
        let column_stride = self.accessor.column_stride();
        if columns > 1 && column_stride != rows * B {
            let padded = |element: &[u8]| make(matrix(element, column_stride, rows * B, convert));
            return bytes.chunks(stride.max(1)).map(padded).collect();
        }
        // A length that the compiler knows makes packed elements fast.
        if stride == N * B {
            return bytes.chunks_exact(N * B).map(|element| make(vector(element, convert))).collect();
        }
        let elements = bytes.chunks(stride.max(1));
        elements.map(|element| make(vector(element.get(..N * B).unwrap_or(element), convert))).collect()
    }
}

/// Decodes the components of an element.
fn vector<C: Copy + Default, const N: usize, const B: usize>(
    element: &[u8],
    convert: &impl Fn([u8; B]) -> C,
) -> [C; N] {
    let mut decoded = [C::default(); N];
    decoded.iter_mut().zip(element.as_chunks::<B>().0).for_each(|(number, bytes)| *number = convert(*bytes));
    decoded
}

/// Decodes the components of a matrix whose columns are padded.
fn matrix<C: Copy + Default, const N: usize, const B: usize>(
    element: &[u8],
    column_stride: usize,
    column_bytes: usize,
    convert: &impl Fn([u8; B]) -> C,
) -> [C; N] {
    let mut decoded = [C::default(); N];
    let columns = element.chunks(column_stride.max(1)).map(|column| column.get(..column_bytes).unwrap_or(column));
    let components = columns.flat_map(|column| column.as_chunks::<B>().0);
    decoded.iter_mut().zip(components).for_each(|(number, bytes)| *number = convert(*bytes));
    decoded
}

/// An unsigned integer of up to four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |number, byte| (number << 8) | u32::from(*byte))
}
