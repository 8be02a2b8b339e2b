//! Collection of faults and warnings, and checks that all parts of a document share.

use crate::gltf::document::{Document, Index};
use crate::gltf::error::Fault;
use crate::gltf::limits::Limits;
use crate::gltf::location::Location;
use crate::gltf::warning::Warnings;
use std::fmt;
use std::ops::RangeInclusive;

/// All numbers that are finite in single precision.
pub(super) const FINITE: RangeInclusive<f64> = -(f32::MAX as f64)..=f32::MAX as f64;
/// All numbers of at least 0 that are finite in single precision.
pub(super) const NOT_NEGATIVE: RangeInclusive<f64> = 0.0..=f32::MAX as f64;
/// All numbers above 0 that are finite in single precision.
pub(super) const POSITIVE: RangeInclusive<f64> = f64::MIN_POSITIVE..=f32::MAX as f64;
/// Numbers from 0 to 1.
pub(super) const UNIT: RangeInclusive<f64> = 0.0..=1.0;

/// Checks the structure of a document and collects all faults.
pub(super) struct Checker<'d> {
    pub document: &'d Document,
    pub limits: &'d Limits,
    /// Length of the chunk BIN of a `.glb`.
    pub binary: Option<u64>,
    pub faults: Vec<Fault>,
    pub omitted: usize,
    pub warnings: Warnings,
}

impl<'d> Checker<'d> {
    pub fn new(document: &'d Document, binary: Option<u64>, limits: &'d Limits) -> Self {
        Self { document, limits, binary, faults: Vec::new(), omitted: 0, warnings: Warnings::default() }
    }

    /// Adds a fault. Its texts are formatted only if it is kept.
    pub fn fault(&mut self, at: &Location<'_>, text: fmt::Arguments<'_>) {
        if self.faults.len() < self.limits.faults.max(1) {
            self.faults.push(Fault::at(at, text));
        } else {
            self.omitted += 1;
        }
    }

    /// Adds a warning about one item.
    pub fn warn(&mut self, at: &Location<'_>, text: impl fmt::Display) {
        self.warnings.add(at, text, 1);
    }

    /// Checks an index into one of the document's arrays.
    pub fn index(&mut self, at: &Location<'_>, index: impl Into<Option<Index>>, count: usize, what: &str) {
        if let Some(index) = index.into()
            && index.get() >= count
        {
            self.fault(at, format_args!("{what} {index} does not exist, there are {count}"));
        }
    }

    /// Checks a number; numbers that are not finite fail.
    pub fn number(&mut self, at: &Location<'_>, value: f64, range: &RangeInclusive<f64>) {
        if range.contains(&value) {
            return;
        }
        let (low, high) = (*range.start(), *range.end());
        let allowed = match (low == f64::MIN_POSITIVE, high == f64::from(f32::MAX)) {
            (true, true) => "a finite number above 0".to_owned(),
            (true, false) => format!("above 0 and at most {high}"),
            (false, true) if low < 0.0 => "a finite number".to_owned(),
            (false, true) => format!("a finite number of at least {low}"),
            (false, false) => format!("from {low} to {high}"),
        };
        self.fault(at, format_args!("{value} is not {allowed}"));
    }

    /// Checks a number if there is one.
    pub fn optional(&mut self, at: &Location<'_>, value: Option<f64>, range: &RangeInclusive<f64>) {
        if let Some(value) = value {
            self.number(at, value, range);
        }
    }

    /// Checks all numbers of an array.
    pub fn numbers(&mut self, at: &Location<'_>, values: &[f64], range: &RangeInclusive<f64>) {
        for (position, value) in values.iter().enumerate() {
            self.number(&at.index(position), *value, range);
        }
    }

    /// Checks a count against a limit.
    pub fn count(&mut self, at: &Location<'_>, count: u64, limit: u64, what: &str) {
        if count > limit {
            self.fault(at, format_args!("{count} {what}, the limit is {limit}"));
        }
    }

    /// Checks that no index stands twice in a list.
    pub fn unique(&mut self, at: &Location<'_>, list: &[Index]) {
        let mut sorted: Vec<(Index, usize)> = list.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        let twice = sorted.windows(2).filter_map(|pair| match pair {
            [(first, _), (second, position)] if first == second => Some((*second, *position)),
            _ => None,
        });
        for (index, position) in twice {
            self.fault(&at.index(position), format_args!("{index} stands twice in the list"));
        }
    }
}
