//! Maximum depth of paths.

use crate::{Error, Picture};
use juggler_integrator::AnyIntegrator;
use std::ops::RangeInclusive;

impl Picture {
    /// Returns the maximum path depth with its range: specular bounces under the integrator
    /// `classic`, path segments under `path`. `None` for integrators without one.
    pub fn max_depth(&self) -> Option<(u32, RangeInclusive<u32>)> {
        max_depth(&mut self.integrator().clone()).map(|(depth, range)| (*depth, range))
    }
}

/// Returns the maximum depth of an integrator with the range of the scene format; `None` if the
/// integrator has none.
fn max_depth(integrator: &mut AnyIntegrator) -> Option<(&mut u32, RangeInclusive<u32>)> {
    match integrator {
        AnyIntegrator::Classic(classic) => Some((&mut classic.max_depth, 0..=1000)),
        AnyIntegrator::Path(path) => Some((&mut path.max_depth, 1..=10_000)),
        _ => None,
    }
}

/// Sets the maximum depth of an integrator that has one, within the range of the scene format.
pub(super) fn limit_depth(integrator: &mut AnyIntegrator, depth: u32) -> Result<(), Error> {
    let name = integrator.name();
    let Some((place, range)) = max_depth(integrator) else {
        return Err(Error::setting("max_depth", format!("the integrator `{name}` has no maximum depth")));
    };
    if !range.contains(&depth) {
        let (least, most) = (range.start(), range.end());
        let message = format!("a maximum depth of {depth} is out of range: {least} to {most}");
        return Err(Error::setting("max_depth", message));
    }
    *place = depth;
    Ok(())
}
