//! AOVs and coverage masks that a film stores beside radiance. They are summed along the same tree
//! as radiance, so the result does not depend on how the picture was divided.

use juggler_math::{MAX_LIGHT, Rgb};

/// Number of masks: by object, material and shape.
pub const MASKS: usize = 3;

/// Identifiers of the first hit of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitIds {
    /// One identifier per mask; [`HitIds::NO_ID`] if there is none.
    pub ids: [u32; MASKS],
    /// Filter weight of the sample.
    pub weight: f32,
}

impl HitIds {
    /// Identifier that means no hit.
    pub const NO_ID: u32 = u32::MAX;
    /// Sample without a hit.
    pub const EMPTY: Self = Self { ids: [Self::NO_ID; MASKS], weight: 0.0 };
}

/// Coverage mask: for each pixel the identifiers of its hits, with the sums of their sample
/// weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoverageMask {
    /// End of each pixel's entries.
    ends: Vec<u32>,
    /// Pairs of identifier and weight, sorted by identifier within a pixel.
    entries: Vec<(u32, f32)>,
}

/// Error in the data of a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("its masks do not match its pixels")]
pub struct InvalidMask;

impl CoverageMask {
    /// Creates a mask from the end of each pixel's entries and all entries in order. Returns an
    /// error if the ends decrease or do not match the entries, or if a pixel's entries are not
    /// sorted.
    pub fn new(ends: Vec<u32>, entries: Vec<(u32, f32)>) -> Result<Self, InvalidMask> {
        let ends_sorted = ends.is_sorted() && ends.last().copied().unwrap_or(0) as usize == entries.len();
        let mask = Self { ends, entries };
        let ids_sorted = |pixel| mask.pixel(pixel).windows(2).all(|pair| pair[0].0 < pair[1].0);
        if ends_sorted && (0..mask.len()).all(ids_sorted) { Ok(mask) } else { Err(InvalidMask) }
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether the mask has no pixels.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// End of each pixel's entries.
    pub fn ends(&self) -> &[u32] {
        &self.ends
    }

    /// Entries of all pixels, in order.
    pub fn entries(&self) -> &[(u32, f32)] {
        &self.entries
    }

    /// Entries of a pixel: identifiers in increasing order, with the sums of their sample weights.
    pub fn pixel(&self, pixel: usize) -> &[(u32, f32)] {
        let start = pixel.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0) as usize;
        let end = self.ends.get(pixel).copied().unwrap_or(0) as usize;
        self.entries.get(start..end).unwrap_or_default()
    }

    /// Appends a pixel.
    fn push(&mut self, entries: impl IntoIterator<Item = (u32, f32)>) {
        self.entries.extend(entries);
        self.ends.push(self.entries.len() as u32);
    }

    /// Adds a sample to the single pixel of this mask.
    fn add_sample(&mut self, id: u32, weight: f32) {
        if self.ends.is_empty() {
            self.ends.push(0);
        }
        if id == HitIds::NO_ID {
            return;
        }
        match self.entries.binary_search_by_key(&id, |(other, _)| *other) {
            Ok(at) => {
                if let Some((_, sum)) = self.entries.get_mut(at) {
                    *sum += weight;
                }
            }
            Err(at) => self.entries.insert(at, (id, weight)),
        }
        self.ends = vec![self.entries.len() as u32];
    }

    /// Adds the samples that follow for the same pixels.
    fn joined(&self, next: &Self) -> Self {
        let mut sum = Self { ends: Vec::with_capacity(self.len()), entries: Vec::with_capacity(self.entries.len()) };
        for pixel in 0..self.len() {
            sum.push(merged(self.pixel(pixel), next.pixel(pixel)));
        }
        sum
    }
}

/// Merges two lists sorted by identifier and adds the weights of equal identifiers.
fn merged(a: &[(u32, f32)], b: &[(u32, f32)]) -> Vec<(u32, f32)> {
    let (mut a, mut b) = (a.iter().copied().peekable(), b.iter().copied().peekable());
    let mut all = Vec::new();
    loop {
        let next = match (a.peek(), b.peek()) {
            (Some((i, x)), Some((j, y))) if i == j => {
                let both = (*i, x + y);
                a.next();
                b.next();
                Some(both)
            }
            (Some((i, _)), Some((j, _))) if i > j => b.next(),
            (Some(_), _) => a.next(),
            (None, _) => b.next(),
        };
        let Some(next) = next else { return all };
        all.push(next);
    }
}

/// Sums of AOVs and masks over samples, for one or more pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AovSums {
    /// AOV sums, pixel by pixel, the same number per pixel.
    pub planes: Vec<Rgb>,
    /// [`MASKS`] coverage masks; empty unless requested.
    pub masks: Vec<CoverageMask>,
}

impl AovSums {
    /// Approximate bytes per pixel for a number of AOVs, and for masks if there are any.
    pub fn bytes_per_pixel(planes: usize, masks: bool) -> u64 {
        // Most pixels have one identifier, few have more than three.
        const IDS: usize = 3;
        let mask = size_of::<u32>() + IDS * size_of::<(u32, f32)>();
        (planes * size_of::<Rgb>() + if masks { MASKS * mask } else { 0 }) as u64
    }

    /// Whether there are neither AOVs nor masks.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty() && self.masks.is_empty()
    }

    /// Whether both have the same pixels, AOVs and masks.
    pub(super) fn fits(&self, other: &Self) -> bool {
        let sizes = |aov_sums: &Self| aov_sums.masks.iter().map(CoverageMask::len).collect::<Vec<_>>();
        self.planes.len() == other.planes.len() && sizes(self) == sizes(other)
    }

    /// Whether the sizes match a number of pixels.
    pub(super) fn fits_pixels(&self, pixels: usize) -> bool {
        self.planes.len().is_multiple_of(pixels.max(1)) && self.masks.iter().all(|mask| mask.len() == pixels)
    }

    /// Adds a sample to the sums of one pixel. A color with a NaN or infinite channel counts as
    /// black, and channels are limited to [`MAX_LIGHT`], so that the sums of any number of samples
    /// stay finite.
    pub(super) fn add(&mut self, planes: &[Rgb], hit_ids: Option<&HitIds>) {
        self.planes.resize(planes.len(), Rgb::BLACK);
        for (sum, plane) in self.planes.iter_mut().zip(planes) {
            if plane.is_finite() {
                *sum += plane.map(|channel| channel.clamp(-MAX_LIGHT, MAX_LIGHT));
            }
        }
        if let Some(hit_ids) = hit_ids {
            self.masks.resize_with(MASKS, CoverageMask::default);
            self.masks.iter_mut().zip(hit_ids.ids).for_each(|(mask, id)| mask.add_sample(id, hit_ids.weight));
        }
    }

    /// Adds the samples that follow for the same pixels.
    #[must_use]
    pub(super) fn joined(mut self, next: &Self) -> Self {
        for (sum, more) in self.planes.iter_mut().zip(&next.planes) {
            *sum += *more;
        }
        for (mask, more) in self.masks.iter_mut().zip(&next.masks) {
            *mask = mask.joined(more);
        }
        self
    }

    /// Appends a pixel.
    pub fn push(&mut self, pixel: Self) {
        self.planes.extend(pixel.planes);
        self.masks.resize_with(pixel.masks.len(), CoverageMask::default);
        for (mask, pixel) in self.masks.iter_mut().zip(pixel.masks) {
            mask.push(pixel.entries);
        }
    }

    /// Sums of one pixel, out of `pixel_count` pixels.
    pub fn pixel(&self, pixel: usize, pixel_count: usize) -> Self {
        let count = self.planes.len() / pixel_count.max(1);
        let planes = self.planes.get(pixel * count..(pixel + 1) * count).unwrap_or_default().to_vec();
        let mask = |mask: &CoverageMask| {
            let mut one = CoverageMask::default();
            one.push(mask.pixel(pixel).iter().copied());
            one
        };
        Self { planes, masks: self.masks.iter().map(mask).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit_ids(id: u32, weight: f32) -> HitIds {
        HitIds { ids: [id, HitIds::NO_ID, 7], weight }
    }

    #[test]
    fn samples_are_counted_by_id() {
        let mut pixel = AovSums::default();
        for (id, weight) in [(5, 1.0), (2, 1.0), (5, 0.5), (9, -0.25), (2, 1.0)] {
            pixel.add(&[Rgb::splat(weight)], Some(&hit_ids(id, weight)));
        }
        assert_eq!(pixel.planes, [Rgb::splat(3.25)]);
        assert_eq!(pixel.masks[0].pixel(0), [(2, 2.0), (5, 1.5), (9, -0.25)]);
        assert_eq!((pixel.masks[1].len(), pixel.masks[1].entries()), (1, &[][..]));
        assert_eq!(pixel.masks[2].pixel(0), [(7, 3.25)]);
    }

    #[test]
    fn mask_pixels_are_concatenated_and_runs_merged_by_id() {
        let pixel = |ids: &[u32]| {
            let mut pixel = AovSums::default();
            ids.iter().for_each(|id| pixel.add(&[Rgb::WHITE, Rgb::BLACK], Some(&hit_ids(*id, 1.0))));
            pixel
        };
        let run = |pixels: [&[u32]; 2]| {
            let mut run = AovSums::default();
            pixels.iter().for_each(|ids| run.push(pixel(ids)));
            run
        };
        let (a, b) = (run([&[1, 3], &[4]]), run([&[2, 3], &[4, 4]]));
        assert!(a.fits(&b) && a.fits_pixels(2) && !a.fits_pixels(3));
        let sum = a.joined(&b);
        assert_eq!(sum.planes, [Rgb::splat(4.0), Rgb::BLACK, Rgb::splat(3.0), Rgb::BLACK]);
        assert_eq!(sum.masks[0].pixel(0), [(1, 1.0), (2, 1.0), (3, 2.0)]);
        assert_eq!(sum.masks[0].pixel(1), [(4, 3.0)]);
        assert_eq!(sum.masks[0].pixel(2), []);
        assert_eq!(sum.pixel(1, 2), pixel(&[4, 4, 4]));
    }

    #[test]
    fn malformed_coverage_masks_are_rejected() {
        assert!(CoverageMask::new(vec![1, 3], vec![(4, 1.0), (2, 1.0), (3, 1.0)]).is_ok());
        for (ends, entries) in [
            (vec![1, 2], vec![(4, 1.0)]),
            (vec![2, 1], vec![(4, 1.0)]),
            (vec![2], vec![(4, 1.0), (4, 1.0)]),
            (vec![2], vec![(4, 1.0), (3, 1.0)]),
            (vec![], vec![(4, 1.0)]),
        ] {
            assert_eq!(CoverageMask::new(ends, entries), Err(InvalidMask));
        }
    }
}
