//! Triangle strips of a PLY, as the Stanford scanning repository writes them: the element `tristrips`
//! with one list of vertex indices. Each index after the first two adds a triangle with the two
//! before it, of alternating winding; -1 starts a new strip, and triangles of repeated indices join
//! strips without being drawn.

use super::header::Element;
use super::values::{Values, list_length, out_of_range, skip};
use crate::error::MeshErrorKind;

/// State within a strip.
#[derive(Default)]
struct Strip {
    /// The two indices before the next one.
    previous: [Option<u32>; 2],
    /// Whether the next triangle has the reverse order of its indices.
    is_reversed: bool,
}

impl Strip {
    /// Adds an index; returns the triangle that it completes, unless that repeats an index.
    fn next(&mut self, corner: u32) -> Option<[u32; 3]> {
        let [first, second] = self.previous;
        self.previous = [second, Some(corner)];
        let (first, second) = (first?, second?);
        let is_reversed = self.is_reversed;
        self.is_reversed = !is_reversed;
        let triangle = if is_reversed { [second, first, corner] } else { [first, second, corner] };
        (first != second && second != corner && first != corner).then_some(triangle)
    }
}

/// Reads all rows and passes their triangles to `take`; the list of indices is in this column.
pub(super) fn read_strips(
    element: &Element,
    column: usize,
    values: &mut impl Values,
    vertices: u64,
    mut take: impl FnMut([u32; 3]) -> Result<(), MeshErrorKind>,
) -> Result<(), MeshErrorKind> {
    for _ in 0..element.count {
        values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            let Some(length) = property.length.filter(|_| index == column) else {
                skip(property, values)?;
                continue;
            };
            let count = list_length(values, length)?;
            let mut strip = Strip::default();
            values.integers(property.item, count, "a vertex index", |place, index| {
                match u32::try_from(index) {
                    _ if index == -1 => strip = Strip::default(),
                    Ok(corner) if u64::from(corner) < vertices => {
                        strip.next(corner).map_or(Ok(()), &mut take)?;
                    }
                    _ => return Err(out_of_range(place, index, vertices)),
                }
                Ok(())
            })?;
        }
        values.end_row()?;
    }
    Ok(())
}
