//! Square windows around pixels.

/// Other pixels of the square window around pixel `i`, row by row, as far as the picture of this
/// width and number of pixels reaches.
pub(crate) fn neighbors(width: usize, pixels: usize, i: usize, radius: usize) -> impl Iterator<Item = usize> {
    let (x, y, height) = (i % width, i / width, pixels / width);
    let rows = y.saturating_sub(radius)..height.min(y + radius + 1);
    let columns = x.saturating_sub(radius)..width.min(x + radius + 1);
    let all = rows.flat_map(move |row| columns.clone().map(move |column| row * width + column));
    all.filter(move |&at| at != i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_end_at_the_edges_of_the_picture() {
        let found = |i, radius| neighbors(4, 12, i, radius).collect::<Vec<_>>();
        assert_eq!(found(5, 1), [0, 1, 2, 4, 6, 8, 9, 10]);
        assert_eq!(found(0, 1), [1, 4, 5]);
        assert_eq!(found(11, 1), [6, 7, 10]);
        assert_eq!(found(5, 3), [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11]);
    }
}
