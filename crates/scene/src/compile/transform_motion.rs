//! Motion of an object from its transform steps at even times while the shutter is open.
//!
//! Between the times, each step is interpolated by its own numbers, so a rotation is one by an angle
//! in between, about its own center and by any number of turns.

use crate::description::{LookAt, Rotate, Rotation, ScaleFactors, TransformStep};
use juggler_math::motion::{STEP_RADIANS, interpolate_parts};
use juggler_math::{Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Sphere};

/// Maximum number of keys for each interval between two times.
const MAX_SUBSTEPS: usize = 128;
/// Scale factor in place of 0 while the shutter is open.
const SMALLEST_SCALE: f32 = 1e-6;

/// Motion through the steps `at` even times; `None` if one of them is degenerate, or if there are
/// none. A scale of 0 counts as a very small one.
pub fn motion(at: &[&[TransformStep]]) -> Option<Motion> {
    if at.iter().any(|steps| steps.iter().any(TransformStep::is_flat)) {
        let inflated: Vec<Vec<TransformStep>> = at.iter().map(|steps| steps.iter().map(inflated).collect()).collect();
        return motion(&inflated.iter().map(Vec::as_slice).collect::<Vec<_>>());
    }
    let substeps = substeps(at);
    let mut keys = Vec::with_capacity(substeps * at.len());
    for pair in at.windows(2) {
        let [from, to] = pair else { return None };
        keys.push(composed(from)?);
        for substep in 1..substeps {
            keys.push(between(from, to, substep as f64 / substeps as f64)?);
        }
    }
    keys.push(composed(at.last()?)?);
    Motion::from_keys(keys)
}

/// Motion of a sphere whose radius changes, as a scaling.
pub fn sphere_scaling(shape: &AnyShape, others: Vec<&AnyShape>) -> Motion {
    let Some(sphere) = shape.sphere() else { return Transform::IDENTITY.into() };
    let scaling = |other: &Sphere| Transform::scale(Vec3::splat(other.radius / sphere.radius));
    let keys = others.into_iter().map(|other| other.sphere().and_then(scaling));
    let keys: Option<Vec<Transform>> = keys.collect();
    keys.and_then(Motion::from_keys).unwrap_or(Transform::IDENTITY.into())
}

/// The step with [`SMALLEST_SCALE`] in place of factors of 0.
fn inflated(step: &TransformStep) -> TransformStep {
    let inflate = |factor: f32| if factor == 0.0 { SMALLEST_SCALE } else { factor };
    match step {
        TransformStep::Scale(axes) => {
            TransformStep::Scale(ScaleFactors::Each(Vec3::from_array(axes.factors().to_array().map(inflate))))
        }
        other => other.clone(),
    }
}

/// Composition of all steps; `None` if one of them is degenerate.
pub fn composed(steps: &[TransformStep]) -> Option<Transform> {
    let next = |whole: Transform, step: &TransformStep| Some(whole.then(&step.transform().ok()?));
    steps.iter().try_fold(Transform::IDENTITY, next)
}

/// Number of keys for each interval that the fastest rotation needs, a power of two; 1 if the kinds
/// of steps change with time.
fn substeps(at: &[&[TransformStep]]) -> usize {
    let turn = |pair: &[&[TransformStep]]| match pair {
        [from, to] if from.len() == to.len() => from.iter().zip(*to).map(|(from, to)| turn(from, to)).sum(),
        _ => None,
    };
    let turns: Option<Vec<f64>> = at.windows(2).map(turn).collect();
    let largest = turns.unwrap_or_default().into_iter().fold(0.0, f64::max);
    ((largest / STEP_RADIANS).ceil().clamp(1.0, MAX_SUBSTEPS as f64) as usize).next_power_of_two()
}

/// Angle in radians by which a step rotates more than another; `None` if their kinds differ. The
/// angle of steps without an angle is small enough to be found in their matrices.
fn turn(from: &TransformStep, to: &TransformStep) -> Option<f64> {
    match (from, to) {
        (TransformStep::Rotate(from), TransformStep::Rotate(to)) => match (from, to) {
            (Rotation::About(from), Rotation::About(to)) => {
                Some((f64::from(to.degrees) - f64::from(from.degrees)).abs().to_radians())
            }
            (Rotation::Angles(from), Rotation::Angles(to)) => {
                let turns = (to.as_dvec3() - from.as_dvec3()).abs();
                Some(turns.element_sum().to_radians())
            }
            _ => None,
        },
        _ => (std::mem::discriminant(from) == std::mem::discriminant(to)).then_some(0.0),
    }
}

/// Composition of the steps between two times; `None` if one of them is degenerate.
fn between(from: &[TransformStep], to: &[TransformStep], fraction: f64) -> Option<Transform> {
    let next = |whole: Transform, (from, to)| Some(whole.then(&step_between(from, to, fraction)?));
    from.iter().zip(to).try_fold(Transform::IDENTITY, next)
}

fn step_between(from: &TransformStep, to: &TransformStep, fraction: f64) -> Option<Transform> {
    let lerp = |from: Vec3, to: Vec3| from.as_dvec3().lerp(to.as_dvec3(), fraction).as_vec3();
    let step = match (from, to) {
        (TransformStep::Translate(from), TransformStep::Translate(to)) => TransformStep::Translate(lerp(*from, *to)),
        (TransformStep::Rotate(Rotation::About(from)), TransformStep::Rotate(Rotation::About(to))) => {
            let axis = if from.axis == to.axis { from.axis } else { lerp(from.axis.normalize(), to.axis.normalize()) };
            let degrees = f64::from(from.degrees) * (1.0 - fraction) + f64::from(to.degrees) * fraction;
            TransformStep::Rotate(Rotate::new(axis, degrees as f32).into())
        }
        (TransformStep::Rotate(Rotation::Angles(from)), TransformStep::Rotate(Rotation::Angles(to))) => {
            TransformStep::Rotate(Rotation::Angles(lerp(*from, *to)))
        }
        (TransformStep::Scale(from), TransformStep::Scale(to)) => {
            TransformStep::Scale(ScaleFactors::Each(lerp(from.factors(), to.factors())))
        }
        (TransformStep::LookAt(from), TransformStep::LookAt(to)) => TransformStep::LookAt(LookAt {
            from: lerp(from.from, to.from),
            to: lerp(from.to, to.to),
            up: lerp(from.up, to.up),
            forward: lerp(from.forward, to.forward),
        }),
        _ => return interpolate_parts(&from.transform().ok()?, &to.transform().ok()?, fraction),
    };
    step.transform().ok()
}
