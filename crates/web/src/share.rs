//! Distribution of the work to workers; it does not affect the image.

use juggler::camera::film::{Rect, Tiling};

/// Number of consecutive rows of a coarse frame that one worker renders.
const BAND_ROWS: u32 = 8;

/// Share of one worker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkerShare {
    /// Index of the worker, from 0.
    pub index: u32,
    /// Number of workers, at least 1.
    pub count: u32,
}

impl WorkerShare {
    fn has(&self, number: u64) -> bool {
        number % u64::from(self.count.max(1)) == u64::from(self.index)
    }

    /// Returns the indices of the worker's tiles. Adjacent tiles go to different workers, since
    /// expensive tiles are clustered.
    pub fn tiles(&self, tiling: &Tiling) -> impl Iterator<Item = u64> {
        let columns = u64::from(tiling.columns().max(1));
        (0..tiling.tile_count()).filter(move |number| self.has(number % columns + number / columns))
    }

    /// Returns the worker's rows of a coarse frame, in bands.
    pub fn bands(&self, width: u32, height: u32) -> impl Iterator<Item = Rect> {
        let bands = (0..height).step_by(BAND_ROWS as usize).zip(0..).filter(|(_, number)| self.has(*number));
        bands.map(move |(y, _)| Rect { x: 0, y, width, height: BAND_ROWS.min(height - y) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_distributed_once_and_evenly() {
        let tiling = Tiling::new(Rect { x: 0, y: 0, width: 640, height: 477 });
        for count in 1..8 {
            let shares: Vec<WorkerShare> = (0..count).map(|index| WorkerShare { index, count }).collect();
            let mut tiles: Vec<u64> = shares.iter().flat_map(|share| share.tiles(&tiling)).collect();
            tiles.sort_unstable();
            assert_eq!(tiles, (0..tiling.tile_count()).collect::<Vec<_>>());
            let even = tiling.tile_count() / u64::from(count);
            assert!(
                shares.iter().all(|share| (share.tiles(&tiling).count() as u64).abs_diff(even) <= u64::from(count))
            );
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
