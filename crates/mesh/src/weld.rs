//! Welding: corners with equal keys become one vertex. The key is the index triple of an OBJ corner
//! or the position of an STL corner.
//!
//! Vertices are numbered in the order of their first corner. Each piece of a file is welded by
//! itself, by a [`Welder`] whose hash table fits into the cache; [`Welded`] then welds the keys of
//! all pieces in parallel, in shards by hash. The hash tables are only looked up, never iterated,
//! so their random seeds, which protect against crafted files, do not affect the result.

use crate::error::MeshErrorKind;
use crate::faces::Faces;
use crate::limits::{MeshLimits, too_many};
use foldhash::fast::RandomState;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use juggler_math::{BuildControl, Cancelled};
use rayon::prelude::*;
use std::hash::BuildHasher;

/// Key of a vertex: index triple or bits of the position.
pub(crate) type Key = [u32; 3];

/// Number of shards into which the keys of all pieces are divided for parallel welding.
const PARTITIONS: u32 = 8;

/// Maps equal keys to equal vertex indices.
#[derive(Default)]
pub(crate) struct Welder {
    indices: HashTable<u32>,
    keys: Vec<Key>,
    state: RandomState,
}

impl Welder {
    /// Returns the vertex index of this key and adds a vertex if the key is new. Fails beyond the
    /// limit of vertices.
    pub fn index(&mut self, key: Key, limits: &MeshLimits) -> Result<u32, MeshErrorKind> {
        let Self { indices, keys, state } = self;
        let known = |index: &u32| keys.get(*index as usize).copied();
        let entry = indices.entry(
            state.hash_one(key),
            |index| known(index) == Some(key),
            |i| state.hash_one(known(i).unwrap_or_default()),
        );
        match entry {
            Entry::Occupied(known) => Ok(*known.get()),
            Entry::Vacant(vacant) => {
                let index = limits.next_vertex(keys.len())?;
                vacant.insert(index);
                keys.push(key);
                Ok(index)
            }
        }
    }
}

/// Faces of a piece of a file, with welded corners.
#[derive(Default)]
pub(crate) struct WeldedPiece {
    /// Keys of the vertices.
    pub corners: Welder,
    /// The faces.
    pub faces: Faces,
}

/// The concatenated pieces of a file.
#[derive(Default)]
pub(crate) struct Welded {
    keys: Vec<Key>,
    faces: Faces,
    pieces: usize,
}

impl Welded {
    /// Creates an empty collection with room for this number of triangles.
    pub fn with_capacity(triangles: usize) -> Self {
        Self { faces: Faces::with_capacity(triangles), ..Self::default() }
    }

    /// Number of triangles so far.
    pub fn triangles(&self) -> usize {
        self.faces.len()
    }

    /// Appends the next piece of the file.
    pub fn append(&mut self, piece: WeldedPiece, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        let all = self.keys.len().saturating_add(piece.corners.keys.len());
        let (Ok(first), Ok(_)) = (u32::try_from(self.keys.len()), u32::try_from(all)) else {
            return Err(too_many("vertices", all as u64, limits.vertices.into()));
        };
        self.keys.extend(piece.corners.keys);
        self.pieces += 1;
        self.faces.append(&piece.faces, first, limits)
    }

    /// Welds the pieces. Returns the distinct keys in the order of their first corner, and the
    /// faces.
    pub fn finish(mut self, limits: &MeshLimits, control: &BuildControl) -> Result<(Vec<Key>, Faces), MeshErrorKind> {
        if self.pieces > 1 {
            let numbers = deduplicate(&mut self.keys, control)?;
            self.faces.renumber(|corner| numbers.get(corner as usize).copied().unwrap_or_default());
        }
        limits.check_vertices(self.keys.len() as u64)?;
        Ok((self.keys, self.faces))
    }
}

/// Removes repeated keys and returns the vertex index of each former key.
fn deduplicate(keys: &mut Vec<Key>, control: &BuildControl) -> Result<Vec<u32>, Cancelled> {
    let find = |partition| control.check().map(|()| find_repeated(keys, partition));
    let again: Vec<Vec<(u32, u32)>> = (0..PARTITIONS).into_par_iter().map(find).collect::<Result<_, Cancelled>>()?;
    // Initialize each entry with the position of the first equal key, then replace it by its vertex
    // index.
    let mut numbers: Vec<u32> = (0..keys.len() as u32).collect();
    for (place, first) in again.into_iter().flatten() {
        numbers[place as usize] = first;
    }
    let mut count = 0;
    for place in 0..keys.len() {
        let first = numbers[place] as usize;
        if first < place {
            numbers[place] = numbers[first];
            continue;
        }
        keys[count] = keys[place];
        numbers[place] = count as u32;
        count += 1;
    }
    keys.truncate(count);
    Ok(numbers)
}

/// Finds the repeated keys of a shard: pairs of the key's position and the position of the first
/// equal key.
fn find_repeated(keys: &[Key], partition: u32) -> Vec<(u32, u32)> {
    let state = RandomState::default();
    let mut firsts = HashTable::with_capacity(keys.len() / PARTITIONS as usize);
    let mut again = Vec::new();
    for (place, key) in (0..).zip(keys).filter(|(_, key)| partition_of(key) == partition) {
        let equal = |first: &u32| keys.get(*first as usize) == Some(key);
        match firsts
            .entry(state.hash_one(key), equal, |i| state.hash_one(keys.get(*i as usize).copied().unwrap_or_default()))
        {
            Entry::Occupied(first) => again.push((place, *first.get())),
            Entry::Vacant(vacant) => drop(vacant.insert(place)),
        }
    }
    again
}

/// Shard of a key (Knuth's multiplicative hashing).
fn partition_of(key: &Key) -> u32 {
    key.iter().fold(0_u32, |mixed, word| (mixed ^ word).wrapping_mul(0x9e37_79b1)) >> 16 & (PARTITIONS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn welded_vertices_are_numbered_in_order_of_first_appearance() {
        let mut welder = Welder::default();
        let limits = MeshLimits { vertices: 3, ..MeshLimits::default() };
        let keys = [[7, 0, 0], [1, 2, 3], [7, 0, 0], [3, 2, 1], [1, 2, 3]];
        let indices: Vec<u32> = keys.iter().map(|key| welder.index(*key, &limits).unwrap()).collect();
        assert_eq!(indices, [0, 1, 0, 2, 1]);
        assert!(matches!(welder.index([9, 9, 9], &limits), Err(MeshErrorKind::TooMany { found: 4, limit: 3, .. })));
        assert_eq!(welder.keys, [[7, 0, 0], [1, 2, 3], [3, 2, 1]]);
    }

    /// Welds triangles of few distinct corners in pieces of several sizes and compares with one
    /// piece.
    #[test]
    fn chunk_size_does_not_change_welding() {
        let limits = MeshLimits::default();
        let corner = |i: u32| [0, juggler_math::hash::mix(i) % 500, 0];
        let weld = |size: usize| {
            let triangles: Vec<u32> = (0..2000).collect();
            let mut welded = Welded::default();
            for piece in triangles.chunks(size) {
                let mut local = WeldedPiece::default();
                for i in piece {
                    let corners = [0, 1, 2].map(|c| local.corners.index(corner(i * 3 + c), &limits).unwrap());
                    local.faces.push_triangle(corners, &limits).unwrap();
                }
                welded.append(local, &limits).unwrap();
            }
            let (keys, faces) = welded.finish(&limits, &BuildControl::default()).unwrap();
            (keys, faces.triangulate(&[], &mut Vec::new()))
        };
        let whole = weld(2000);
        assert_eq!(whole.0.len(), 500);
        for size in [1, 2, 7, 333, 1999] {
            assert!(weld(size) == whole, "{size}");
        }
        let corners = whole.1.as_flattened().iter().zip(0..);
        assert!(corners.into_iter().all(|(index, i)| whole.0[*index as usize] == corner(i)));
    }
}
