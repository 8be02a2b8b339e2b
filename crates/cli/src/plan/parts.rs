//! Partial renders: checkpoints, shards and cuts.

use crate::args::RenderArgs;
use crate::encoding::OutputKind;
use crate::failure::Failure;
use crate::plan::Movie;
use crate::value;
use juggler::camera::film::Rect;
use std::env;
use std::ops::Range;
use std::time::Duration;

/// Environment variables with the index of a cluster's task: Slurm, Kubernetes and HyperQueue.
const INDICES: [&str; 3] = ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "HQ_TASK_ID"];

/// Checkpoint file and interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Checkpoint file (.jfilm).
    pub file: String,
    /// Time between checkpoints.
    pub every: Duration,
    /// Whether the checkpoint is automatic. Such a checkpoint is removed when its picture is
    /// complete, and replaced if it does not match.
    pub is_automatic: bool,
}

/// Index and number of shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Index, from 0.
    pub index: u32,
    /// Number of shards; 1 if the work is not divided.
    pub count: u32,
}

/// Pixels and samples of a partial render, chosen by flags.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// Region in pixels; `None` for all.
    pub crop: Option<Rect>,
    /// Range of samples per pixel; `None` for all.
    pub samples: Option<Range<u32>>,
}

impl Checkpoint {
    /// Checkpoint given by flags; automatic for frames of a movie.
    pub fn new(args: &RenderArgs, movie: Option<&Movie>) -> Result<Option<Self>, Failure> {
        let every = Duration::from_secs_f64(args.checkpoint_every);
        match (&args.checkpoint, movie) {
            (Some(file), _) if file.is_empty() => Err(Failure::Invalid("--checkpoint needs the name of a file".into())),
            (Some(file), _) => Ok(Some(Self { file: file.clone(), every, is_automatic: false })),
            (None, Some(movie)) => Ok(Some(Self { file: movie.checkpoints(), every, is_automatic: true })),
            (None, None) => Ok(None),
        }
    }
}

impl Shard {
    /// The only shard of undivided work.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Shard given by a flag; `variable` reads the environment.
    pub fn new(typed: Option<value::Shard>, variable: impl Fn(&str) -> Option<String>) -> Result<Self, Failure> {
        let Some(value::Shard { index, count }) = typed else { return Ok(Self::WHOLE) };
        let index = match index {
            Some(index) => index,
            None => index_from_environment(count, variable)?,
        };
        Ok(Self { index, count })
    }
}

/// Index from the environment of a cluster's task, from 0.
fn index_from_environment(count: u32, variable: impl Fn(&str) -> Option<String>) -> Result<u32, Failure> {
    let wrong = |message: String| Err(Failure::Invalid(message));
    let Some((name, text)) = INDICES.iter().find_map(|name| Some((name, variable(name)?))) else {
        return wrong(format!("--shard auto/{count}: none of {} is set", INDICES.join(", ")));
    };
    match text.parse::<u32>() {
        Ok(index) if index < count => Ok(index),
        Ok(index) => wrong(format!(
            "--shard auto/{count}: {name} is {index}, but shards are 0 to {}: start the array at 0",
            count - 1
        )),
        Err(_) => wrong(format!("--shard auto/{count}: {name} is `{text}`, which is not a number")),
    }
}

/// Value of an environment variable.
pub fn variable(name: &str) -> Option<String> {
    env::var(name).ok()
}

impl Cut {
    /// Cut given by flags. The crop of a picture is no cut, but the picture's region.
    pub fn new(args: &RenderArgs, output_kind: OutputKind) -> Self {
        let crop = args.crop.filter(|_| output_kind == OutputKind::PartialRender);
        Self { crop, samples: args.sample_range.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auto(variables: &[(&str, &str)]) -> Result<Shard, String> {
        let variable = |name: &str| {
            let found = variables.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        match Shard::new(Some(value::Shard { index: None, count: 4 }), variable) {
            Ok(shard) => Ok(shard),
            Err(Failure::Invalid(message)) => Err(message),
            Err(other) => panic!("{other:?}"),
        }
    }

    #[test]
    fn cluster_variables_give_the_shard_index() {
        for name in INDICES {
            assert_eq!(auto(&[(name, "3")]), Ok(Shard { index: 3, count: 4 }));
        }
        assert!(auto(&[]).unwrap_err().contains("JOB_COMPLETION_INDEX"));
        assert!(auto(&[("HQ_TASK_ID", "4")]).unwrap_err().contains("0 to 3"));
        assert!(auto(&[("HQ_TASK_ID", "x")]).unwrap_err().contains("`x`"));
    }
}
