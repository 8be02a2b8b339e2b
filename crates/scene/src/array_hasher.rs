//! Hash of arrays, without a copy of them.

use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};

/// Number of values that are converted to bytes at once.
const CHUNK: usize = 1 << 12;

/// Hasher of arrays, each after its length.
pub struct ArrayHasher(blake3::Hasher);

impl ArrayHasher {
    /// Creates a hasher that begins with these bytes.
    pub fn new(start: &[u8]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(start);
        Self(hasher)
    }

    /// Adds bytes whose number is always the same.
    pub fn numbers(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.update(bytes);
        self
    }

    fn length(&mut self, length: usize) {
        self.0.update(&(length as u64).to_le_bytes());
    }

    /// Adds bytes after their number.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.length(bytes.len());
        self.0.update(bytes);
    }

    /// Adds the bytes of values after the number of values.
    pub fn array<T: Copy, const N: usize, const BYTES: usize>(
        &mut self,
        values: &[T],
        bytes: impl Fn(T) -> [[u8; BYTES]; N],
    ) {
        self.length(values.len());
        let mut chunk = Vec::with_capacity(CHUNK.min(values.len()) * N * BYTES);
        for values in values.chunks(CHUNK) {
            chunk.clear();
            values.iter().for_each(|value| chunk.extend_from_slice(bytes(*value).as_flattened()));
            self.0.update(&chunk);
        }
    }

    /// Adds an attribute with its name.
    pub fn attribute(&mut self, name: &str, attribute: &MeshAttribute) {
        self.bytes(name.as_bytes());
        let domain = match attribute.domain {
            AttributeDomain::Vertex => 0,
            AttributeDomain::Face => 1,
        };
        self.numbers(&[domain]).numbers(&attribute.channels.to_le_bytes());
        match &attribute.data {
            AttributeData::U8(values) => self.numbers(&[1]).bytes(values),
            AttributeData::U16(values) => self.numbers(&[2]).array(values, |value| [value.to_le_bytes()]),
            AttributeData::F32(values) => self.numbers(&[4]).array(values, |value| [value.to_le_bytes()]),
        }
    }

    /// Hash of all that was added.
    pub fn finish(&self) -> [u8; 32] {
        self.0.finalize().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_arrays_have_one_hash() {
        let values: Vec<[f32; 2]> = (0..3 * CHUNK + 5).map(|i| [i as f32, -1.0]).collect();
        let mut hasher = ArrayHasher::new(b"start");
        hasher.array(&values, |value| value.map(f32::to_le_bytes));
        let mut whole = b"start".to_vec();
        whole.extend((values.len() as u64).to_le_bytes());
        whole.extend(values.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
        assert_eq!(hasher.finish(), *blake3::hash(&whole).as_bytes());
    }
}
