//! Equal keys become one vertex: corners of an OBJ with equal index triples, of an STL with equal positions.
//!
//! Vertices are numbered in the order of their first corner. The table is only asked, never walked
//! through, so its random seed (which no crafted file can foresee) does not show in the result.

use super::Limits;
use super::error::Fault;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Gives equal keys equal indices.
#[derive(Default)]
pub(super) struct Welder {
    indices: HashMap<[u32; 3], u32>,
    keys: Vec<[u32; 3]>,
}

impl Welder {
    /// The vertex of this key, a new one when the key is new.
    pub fn index(&mut self, key: [u32; 3], limits: &Limits) -> Result<u32, Fault> {
        match self.indices.entry(key) {
            Entry::Occupied(known) => Ok(*known.get()),
            Entry::Vacant(vacant) => {
                let index = limits.next_vertex(self.keys.len())?;
                self.keys.push(key);
                Ok(*vacant.insert(index))
            }
        }
    }

    /// The different keys, in the order of their indices.
    pub fn into_keys(self) -> Vec<[u32; 3]> {
        self.keys
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_order_of_first_appearance() {
        let mut welder = Welder::default();
        let limits = Limits { vertices: 3, ..Limits::default() };
        let keys = [[7, 0, 0], [1, 2, 3], [7, 0, 0], [3, 2, 1], [1, 2, 3]];
        let indices: Vec<u32> = keys.iter().map(|key| welder.index(*key, &limits).unwrap()).collect();
        assert_eq!(indices, [0, 1, 0, 2, 1]);
        assert!(matches!(welder.index([9, 9, 9], &limits), Err(Fault::TooMany { found: 4, limit: 3, .. })));
        assert_eq!(welder.into_keys(), [[7, 0, 0], [1, 2, 3], [3, 2, 1]]);
    }
}
