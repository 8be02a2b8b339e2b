//! Codec of triangle lists (mode `TRIANGLES`): one code byte per triangle, which refers to recent
//! edges and vertices.
//!
//! A stream has the header byte 0xe1, the codes, the operands that some codes need, and a table of
//! 16 bytes. Two queues keep the 16 most recent edges and vertices; `next` is the lowest index that
//! has not occurred yet in a mesh whose vertices are in the order of their first use.

use super::MeshoptError;
use super::reader::{Reader, unzigzag};

const HEADER: u8 = 0xe1;
/// Number of bytes of the table at the end of a stream.
const TABLE: usize = 16;

/// The 16 most recent items.
struct Recent<T> {
    items: [T; 16],
    pushed: u64,
}

impl<T: Copy> Recent<T> {
    /// Creates an empty queue. `unused` fills its memory and is never returned.
    fn new(unused: T) -> Self {
        Self { items: [unused; 16], pushed: 0 }
    }

    fn push(&mut self, item: T) {
        if let Some(slot) = self.items.get_mut((self.pushed & 15) as usize) {
            *slot = item;
        }
        self.pushed += 1;
    }

    /// The item that was pushed `age` items before the most recent one; `None` if there is none.
    fn item(&self, age: u8) -> Option<T> {
        let number = self.pushed.checked_sub(u64::from(age) + 1)?;
        self.items.get((number & 15) as usize).copied()
    }
}

/// Where the second or third vertex of a triangle comes from: a half of an operand byte.
#[derive(Clone, Copy)]
enum Source {
    /// The lowest index that has not occurred.
    Next,
    /// The recent vertex of this age.
    Recent(u8),
    /// A difference from the last explicit index.
    Explicit,
}

impl Source {
    fn new(nibble: u8) -> Self {
        match nibble {
            0 => Self::Next,
            15 => Self::Explicit,
            age => Self::Recent(age - 1),
        }
    }

    /// Whether the vertex enters the queue: a recent vertex is there already.
    fn is_pushed(self) -> bool {
        !matches!(self, Self::Recent(_))
    }
}

/// State of the decoder between two triangles.
struct Decoder<'a> {
    operands: Reader<'a>,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
    next: u32,
    last: u32,
    triangle: usize,
}

/// Decodes a stream to `count` triangles and passes each to `emit`.
///
/// # Errors
///
/// The header or the table is invalid, a code refers to an edge or vertex before the first one, or
/// the content has another length than the codes need.
pub(super) fn decode(count: usize, stream: &[u8], mut emit: impl FnMut([u32; 3])) -> Result<(), MeshoptError> {
    let mut operands = Reader::new(stream, &[HEADER], TABLE)?;
    let table = operands.tail();
    let is_valid = |(index, byte): (usize, &u8)| byte & 15 != 15 && byte >> 4 != 15 && (index < 14 || *byte == 0);
    if let Some(index) = table.iter().enumerate().position(|entry| !is_valid(entry)) {
        return Err(MeshoptError::Table { index });
    }
    let codes = operands.bytes(count)?;
    let (edges, vertices) = (Recent::new([0; 2]), Recent::new(0));
    let mut decoder = Decoder { operands, edges, vertices, next: 0, last: 0, triangle: 0 };
    for code in codes {
        emit(match *code {
            0xfe | 0xff => decoder.explicit_triangle(*code == 0xff)?,
            0xf0.. => {
                let pair = table.get(usize::from(code & 15)).copied().unwrap_or_default();
                decoder.new_triangle(Source::Next, pair)?
            }
            _ => decoder.adjacent_triangle(code >> 4, code & 15)?,
        });
        decoder.triangle += 1;
    }
    decoder.operands.finish()
}

impl Decoder<'_> {
    /// Triangle at the recent edge of age `edge`, with the third vertex of this code.
    fn adjacent_triangle(&mut self, edge: u8, third: u8) -> Result<[u32; 3], MeshoptError> {
        let [a, b] = self.edges.item(edge).ok_or(MeshoptError::NoRecentEdge { triangle: self.triangle })?;
        let c = match third {
            0 => self.vertex(Source::Next)?,
            13 => {
                self.last = self.last.wrapping_sub(1);
                self.last
            }
            14 => {
                self.last = self.last.wrapping_add(1);
                self.last
            }
            15 => self.vertex(Source::Explicit)?,
            age => self.vertex(Source::Recent(age))?,
        };
        if !(1..13).contains(&third) {
            self.vertices.push(c);
        }
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Ok([a, b, c])
    }

    /// Triangle whose sources of vertices are in the operands.
    fn explicit_triangle(&mut self, is_first_explicit: bool) -> Result<[u32; 3], MeshoptError> {
        let pair = self.operands.byte()?;
        if pair == 0 {
            self.next = 0;
        }
        self.new_triangle(if is_first_explicit { Source::Explicit } else { Source::Next }, pair)
    }

    /// Triangle without a recent edge. `pair` has the sources of the second and the third vertex.
    fn new_triangle(&mut self, first: Source, pair: u8) -> Result<[u32; 3], MeshoptError> {
        let (second, third) = (Source::new(pair >> 4), Source::new(pair & 15));
        let [a, b, c] = [self.vertex(first)?, self.vertex(second)?, self.vertex(third)?];
        self.vertices.push(a);
        if second.is_pushed() {
            self.vertices.push(b);
        }
        if third.is_pushed() {
            self.vertices.push(c);
        }
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        Ok([a, b, c])
    }

    /// Index of a vertex from this source.
    fn vertex(&mut self, source: Source) -> Result<u32, MeshoptError> {
        match source {
            Source::Next => {
                let index = self.next;
                self.next = index.wrapping_add(1);
                Ok(index)
            }
            Source::Recent(age) => {
                self.vertices.item(age).ok_or(MeshoptError::NoRecentVertex { triangle: self.triangle })
            }
            Source::Explicit => {
                self.last = self.last.wrapping_add(unzigzag(self.operands.varint()?));
                Ok(self.last)
            }
        }
    }
}
