//! Setters for numbers of an object's transform that expressions animate. Most motion is of this
//! kind; at another time the setters store the numbers in a copy of the object, whose JSON is not
//! read again.

use super::merge_edits::sources_in;
use crate::animate::{Programs, Resolver};
use crate::description::{Object, Rotation, ScaleFactors, TransformStep};
use crate::document::Node;
use crate::item::Item;
use crate::path::{Path, Step};
use juggler_expression::Program;
use juggler_math::Vec3;
use std::sync::Arc;

/// Setters of the numbers that expressions animate in an object's transform.
#[derive(Debug)]
pub(crate) struct TransformSetters(Vec<NumberSetter>);

/// Setter of one number.
#[derive(Debug)]
struct NumberSetter {
    program: Arc<Program>,
    /// Index of the transform step.
    step: usize,
    /// Path of the number in the step, which begins with the step's name.
    path: Vec<Step>,
}

impl TransformSetters {
    /// Returns setters for an object's JSON, or `None` if the object has expressions or value forms
    /// elsewhere than in single numbers of its transform.
    pub fn from_object_json(object: &Node, programs: &Programs) -> Option<Self> {
        let mut sources = Vec::new();
        sources_in(object, &mut Path::root(), &mut sources);
        let setter = |(path, source): (Path, &Node)| {
            let (step, path) = match path.steps() {
                [Step::Key(key), Step::Index(i), rest @ ..] if key == "transform" => (*i, rest.to_vec()),
                [Step::Key(key), rest @ ..] if key == "transform" => (0, rest.to_vec()),
                _ => return None,
            };
            let program = programs.parse(source.as_str()?.strip_prefix('=')?).ok()?;
            Some(NumberSetter { program, step, path })
        };
        let setters: Option<Vec<NumberSetter>> = sources.into_iter().map(setter).collect();
        setters.filter(|setters| !setters.is_empty()).map(Self)
    }

    /// Returns the object at the resolver's time, or `None` if a number has no value or the object
    /// has no place for it.
    pub fn apply(&self, object: &Item<Object>, resolver: &mut Resolver<'_>) -> Option<Item<Object>> {
        let mut object = object.clone();
        let transform = &mut object.value_mut_unmarked().transform;
        for setter in &self.0 {
            let value = resolver.number(&setter.program)? as f32;
            *number_mut(transform.get_mut(setter.step)?, &setter.path)? = Some(value).filter(|v| v.is_finite())?;
        }
        Some(object)
    }
}

/// Number at a path in a transform step.
fn number_mut<'t>(step: &'t mut TransformStep, path: &[Step]) -> Option<&'t mut f32> {
    let (_, path) = path.split_first()?;
    match step {
        TransformStep::Translate(by) => component_mut(by, path),
        TransformStep::Rotate(Rotation::Angles(degrees)) => component_mut(degrees, path),
        TransformStep::Rotate(Rotation::About(rotate)) => match path {
            [Step::Key(key)] if key == "degrees" => Some(&mut rotate.degrees),
            [Step::Key(key), rest @ ..] if key == "axis" => component_mut(&mut rotate.axis, rest),
            _ => None,
        },
        TransformStep::Scale(ScaleFactors::All(factor)) => path.is_empty().then_some(factor),
        TransformStep::Scale(ScaleFactors::Each(factors)) => component_mut(factors, path),
        TransformStep::Orient(quaternion) => element_mut(quaternion, path),
        TransformStep::LookAt(look_at) => {
            let (Step::Key(key), rest) = path.split_first()? else { return None };
            let vector = match key.as_str() {
                "from" => &mut look_at.from,
                "to" => &mut look_at.to,
                "up" => &mut look_at.up,
                "forward" => &mut look_at.forward,
                _ => return None,
            };
            component_mut(vector, rest)
        }
        TransformStep::Matrix(numbers) => element_mut(numbers, path),
    }
}

fn component_mut<'v>(vector: &'v mut Vec3, path: &[Step]) -> Option<&'v mut f32> {
    element_mut(vector.as_mut(), path)
}

fn element_mut<'n>(numbers: &'n mut [f32], path: &[Step]) -> Option<&'n mut f32> {
    match path {
        [Step::Index(i)] => numbers.get_mut(*i),
        _ => None,
    }
}
