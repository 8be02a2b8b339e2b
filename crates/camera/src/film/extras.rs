//! What a film keeps of its samples beside their radiance: colours, layer by layer, and how much of each pixel shows which
//! thing. All of it is summed along the same tree as radiance, so that it too is the same however it was shared out.

use juggler_math::{MAX_LIGHT, Rgb};

/// Kinds of things of which is kept how much of each pixel shows them.
pub const MASKS: usize = 3;

/// What one sample shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Numbers of the things, a kind each; [`Mark::NOTHING`] where there is none.
    pub things: [u32; MASKS],
    /// What the sample counts in its pixel.
    pub weight: f32,
}

impl Mark {
    /// The number of no thing.
    pub const NOTHING: u32 = u32::MAX;
    /// A sample that shows nothing.
    pub const EMPTY: Self = Self { things: [Self::NOTHING; MASKS], weight: 0.0 };
}

/// Which things pixels show, and how much of each pixel: sums of the weights of samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mask {
    /// Where the entries of each pixel end.
    ends: Vec<u32>,
    /// Things by number, rising within a pixel.
    entries: Vec<(u32, f32)>,
}

/// Why numbers are no mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("its masks do not fit its pixels")]
pub struct InvalidMask;

impl Mask {
    /// From where each pixel's entries end and all entries in order.
    pub fn new(ends: Vec<u32>, entries: Vec<(u32, f32)>) -> Result<Self, InvalidMask> {
        let rising = ends.is_sorted() && ends.last().copied().unwrap_or(0) as usize == entries.len();
        let mask = Self { ends, entries };
        let sorted = |pixel| mask.pixel(pixel).windows(2).all(|pair| pair[0].0 < pair[1].0);
        if rising && (0..mask.len()).all(sorted) { Ok(mask) } else { Err(InvalidMask) }
    }

    /// How many pixels.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Where the entries of each pixel end.
    pub fn ends(&self) -> &[u32] {
        &self.ends
    }

    /// The entries of all pixels, in order.
    pub fn entries(&self) -> &[(u32, f32)] {
        &self.entries
    }

    /// The things that a pixel shows, by rising number, and the sums of their samples' weights.
    pub fn pixel(&self, pixel: usize) -> &[(u32, f32)] {
        let start = pixel.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0) as usize;
        let end = self.ends.get(pixel).copied().unwrap_or(0) as usize;
        self.entries.get(start..end).unwrap_or_default()
    }

    /// Puts another pixel behind the others.
    fn push(&mut self, entries: impl IntoIterator<Item = (u32, f32)>) {
        self.entries.extend(entries);
        self.ends.push(self.entries.len() as u32);
    }

    /// Counts one sample more in the only pixel.
    fn count(&mut self, thing: u32, weight: f32) {
        if self.ends.is_empty() {
            self.ends.push(0);
        }
        if thing == Mark::NOTHING {
            return;
        }
        match self.entries.binary_search_by_key(&thing, |(other, _)| *other) {
            Ok(at) => {
                if let Some((_, sum)) = self.entries.get_mut(at) {
                    *sum += weight;
                }
            }
            Err(at) => self.entries.insert(at, (thing, weight)),
        }
        self.ends = vec![self.entries.len() as u32];
    }

    /// With the samples of the same pixels that follow.
    fn joined(&self, next: &Self) -> Self {
        let mut sum = Self { ends: Vec::with_capacity(self.len()), entries: Vec::with_capacity(self.entries.len()) };
        for pixel in 0..self.len() {
            sum.push(merged(self.pixel(pixel), next.pixel(pixel)));
        }
        sum
    }
}

/// Two lists by rising number as one; what both have is added up.
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

/// Sums of what samples carry beside their radiance, of one pixel or of many.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extras {
    /// So many colours a pixel, pixel by pixel.
    pub planes: Vec<Rgb>,
    /// Which things are seen, a kind each; nothing where nobody asked.
    pub masks: Vec<Mask>,
}

impl Extras {
    /// Bytes a pixel of so many colours, and of masks if there are any.
    pub fn bytes_a_pixel(planes: usize, masks: bool) -> u64 {
        // Most pixels show one thing, few more than three.
        const THINGS: usize = 3;
        let mask = size_of::<u32>() + THINGS * size_of::<(u32, f32)>();
        (planes * size_of::<Rgb>() + if masks { MASKS * mask } else { 0 }) as u64
    }

    /// Whether there is nothing.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty() && self.masks.is_empty()
    }

    /// Whether both are of the same pixels and layers.
    pub(super) fn fits(&self, other: &Self) -> bool {
        let sizes = |extras: &Self| extras.masks.iter().map(Mask::len).collect::<Vec<_>>();
        self.planes.len() == other.planes.len() && sizes(self) == sizes(other)
    }

    /// Whether it is of so many pixels.
    pub(super) fn is_of(&self, pixels: usize) -> bool {
        self.planes.len().is_multiple_of(pixels.max(1)) && self.masks.iter().all(|mask| mask.len() == pixels)
    }

    /// Adds a sample to the sums of one pixel. A color with a channel that is NaN or infinite counts as black; channels
    /// are limited to [`MAX_LIGHT`], so that the sums of all samples that there can be stay finite.
    pub(super) fn add(&mut self, planes: &[Rgb], mark: Option<&Mark>) {
        self.planes.resize(planes.len(), Rgb::BLACK);
        for (sum, plane) in self.planes.iter_mut().zip(planes) {
            if plane.is_finite() {
                *sum += plane.map(|channel| channel.clamp(-MAX_LIGHT, MAX_LIGHT));
            }
        }
        if let Some(mark) = mark {
            self.masks.resize_with(MASKS, Mask::default);
            self.masks.iter_mut().zip(mark.things).for_each(|(mask, thing)| mask.count(thing, mark.weight));
        }
    }

    /// With the samples of the same pixels that follow.
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

    /// Puts another pixel behind the others.
    pub fn push(&mut self, pixel: Self) {
        self.planes.extend(pixel.planes);
        self.masks.resize_with(pixel.masks.len(), Mask::default);
        for (mask, pixel) in self.masks.iter_mut().zip(pixel.masks) {
            mask.push(pixel.entries);
        }
    }

    /// The sums of one pixel of `of`.
    pub fn pixel(&self, pixel: usize, of: usize) -> Self {
        let count = self.planes.len() / of.max(1);
        let planes = self.planes.get(pixel * count..(pixel + 1) * count).unwrap_or_default().to_vec();
        let mask = |mask: &Mask| {
            let mut one = Mask::default();
            one.push(mask.pixel(pixel).iter().copied());
            one
        };
        Self { planes, masks: self.masks.iter().map(mask).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(thing: u32, weight: f32) -> Mark {
        Mark { things: [thing, Mark::NOTHING, 7], weight }
    }

    #[test]
    fn samples_are_counted_by_thing() {
        let mut pixel = Extras::default();
        for (thing, weight) in [(5, 1.0), (2, 1.0), (5, 0.5), (9, -0.25), (2, 1.0)] {
            pixel.add(&[Rgb::splat(weight)], Some(&mark(thing, weight)));
        }
        assert_eq!(pixel.planes, [Rgb::splat(3.25)]);
        assert_eq!(pixel.masks[0].pixel(0), [(2, 2.0), (5, 1.5), (9, -0.25)]);
        assert_eq!((pixel.masks[1].len(), pixel.masks[1].entries()), (1, &[][..]));
        assert_eq!(pixel.masks[2].pixel(0), [(7, 3.25)]);
    }

    #[test]
    fn pixels_stand_behind_each_other_and_runs_are_joined_thing_by_thing() {
        let pixel = |things: &[u32]| {
            let mut pixel = Extras::default();
            things.iter().for_each(|thing| pixel.add(&[Rgb::WHITE, Rgb::BLACK], Some(&mark(*thing, 1.0))));
            pixel
        };
        let run = |pixels: [&[u32]; 2]| {
            let mut run = Extras::default();
            pixels.iter().for_each(|things| run.push(pixel(things)));
            run
        };
        let (a, b) = (run([&[1, 3], &[4]]), run([&[2, 3], &[4, 4]]));
        assert!(a.fits(&b) && a.is_of(2) && !a.is_of(3));
        let sum = a.joined(&b);
        assert_eq!(sum.planes, [Rgb::splat(4.0), Rgb::BLACK, Rgb::splat(3.0), Rgb::BLACK]);
        assert_eq!(sum.masks[0].pixel(0), [(1, 1.0), (2, 1.0), (3, 2.0)]);
        assert_eq!(sum.masks[0].pixel(1), [(4, 3.0)]);
        assert_eq!(sum.masks[0].pixel(2), []);
        assert_eq!(sum.pixel(1, 2), pixel(&[4, 4, 4]));
    }

    #[test]
    fn numbers_that_are_no_mask_are_refused() {
        assert!(Mask::new(vec![1, 3], vec![(4, 1.0), (2, 1.0), (3, 1.0)]).is_ok());
        for (ends, entries) in [
            (vec![1, 2], vec![(4, 1.0)]),
            (vec![2, 1], vec![(4, 1.0)]),
            (vec![2], vec![(4, 1.0), (4, 1.0)]),
            (vec![2], vec![(4, 1.0), (3, 1.0)]),
            (vec![], vec![(4, 1.0)]),
        ] {
            assert_eq!(Mask::new(ends, entries), Err(InvalidMask));
        }
    }
}
