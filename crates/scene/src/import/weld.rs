//! Equal keys become one vertex: corners of an OBJ with equal index triples, of an STL with equal positions.
//!
//! Vertices are numbered in the order of their first corner. The table is only asked, never walked
//! through, so its random seed (which no crafted file can foresee) does not show in the result.

use super::Limits;
use super::error::Fault;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Vertices remembered outside the table: neighbours in a file are mostly neighbours on the surface.
const RECENT: usize = 1 << 14;

/// Gives equal keys equal indices.
pub(super) struct Welder {
    indices: HashMap<[u32; 3], u32>,
    keys: Vec<[u32; 3]>,
    /// An index that may be that of a key with this slot.
    recent: Vec<u32>,
}

impl Default for Welder {
    fn default() -> Self {
        Self { indices: HashMap::new(), keys: Vec::new(), recent: vec![0; RECENT] }
    }
}

impl Welder {
    /// The vertex of this key, a new one when the key is new.
    pub fn index(&mut self, key: [u32; 3], limits: &Limits) -> Result<u32, Fault> {
        let slot = slot(key);
        if let Some(index) = self.recent.get(slot)
            && self.keys.get(*index as usize) == Some(&key)
        {
            return Ok(*index);
        }
        let index = match self.indices.entry(key) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(vacant) => {
                let index = limits.next_vertex(self.keys.len())?;
                self.keys.push(key);
                *vacant.insert(index)
            }
        };
        if let Some(recent) = self.recent.get_mut(slot) {
            *recent = index;
        }
        Ok(index)
    }

    /// The different keys, in the order of their indices.
    pub fn into_keys(self) -> Vec<[u32; 3]> {
        self.keys
    }
}

/// Where among the recent vertices a key is remembered (Knuth's multiplicative hashing).
fn slot(key: [u32; 3]) -> usize {
    let mixed = key.iter().fold(0_u32, |mixed, word| (mixed ^ word).wrapping_mul(0x9e37_79b1));
    (mixed >> 18) as usize % RECENT
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

    #[test]
    fn far_more_keys_than_are_remembered() {
        let mut welder = Welder::default();
        let limits = Limits::default();
        for round in 0..2 {
            for key in 0..50_000_u32 {
                let index = welder.index([key, 0, key % 7], &limits).unwrap();
                assert_eq!(index, key, "round {round}");
            }
        }
        assert_eq!(welder.into_keys().len(), 50_000);
    }
}
