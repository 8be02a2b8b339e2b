//! Which worker renders what. Nothing here can change a bit of the picture.

use juggler::camera::film::{Layout, Rect};

/// Rows of a coarse frame that go to one worker together.
const BAND: u32 = 8;

/// One worker's part of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Which of the workers, from 0.
    pub index: u32,
    /// How many there are, at least 1.
    pub of: u32,
}

impl Share {
    fn has(&self, number: u64) -> bool {
        number % u64::from(self.of.max(1)) == u64::from(self.index)
    }

    /// The numbers of its tiles. Neighbours go to different workers, in both directions: what takes long lies together.
    pub fn tiles(&self, layout: &Layout) -> impl Iterator<Item = u64> {
        let columns = u64::from(layout.columns().max(1));
        (0..layout.tiles()).filter(move |number| self.has(number % columns + number / columns))
    }

    /// Its rows of a coarse frame, in bands.
    pub fn bands(&self, width: u32, height: u32) -> impl Iterator<Item = Rect> {
        let bands = (0..height).step_by(BAND as usize).zip(0..).filter(|(_, number)| self.has(*number));
        bands.map(move |(y, _)| Rect { x: 0, y, width, height: BAND.min(height - y) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_dealt_once_and_evenly() {
        let layout = Layout::new(Rect { x: 0, y: 0, width: 640, height: 477 });
        for of in 1..8 {
            let shares: Vec<Share> = (0..of).map(|index| Share { index, of }).collect();
            let mut tiles: Vec<u64> = shares.iter().flat_map(|share| share.tiles(&layout)).collect();
            tiles.sort_unstable();
            assert_eq!(tiles, (0..layout.tiles()).collect::<Vec<_>>());
            let even = layout.tiles() / u64::from(of);
            assert!(shares.iter().all(|share| (share.tiles(&layout).count() as u64).abs_diff(even) <= u64::from(of)));
            let mut rows: Vec<u32> = shares
                .iter()
                .flat_map(|share| share.bands(9, 61))
                .flat_map(|band| band.y..band.y + band.height)
                .collect();
            rows.sort_unstable();
            assert_eq!(rows, (0..61).collect::<Vec<_>>());
        }
    }
}
