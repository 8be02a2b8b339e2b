//! Parts of pictures: where work is kept, what is shared with other machines.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::plan::{Product, Reel};
use crate::value;
use juggler::camera::film::Rect;
use std::env;
use std::ops::Range;
use std::time::Duration;

/// Variables in which clusters say which of many tasks this is: Slurm, Kubernetes, HyperQueue.
const INDICES: [&str; 3] = ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "HQ_TASK_ID"];

/// Where work is kept, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The film part's file.
    pub file: String,
    /// From one to the next.
    pub every: Duration,
    /// Whether nobody asked for it: then it goes when its picture is there, and what does not fit is no mistake.
    pub is_own: bool,
}

/// Which of how many shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0 on.
    pub index: u32,
    /// 1 when nothing is shared.
    pub count: u32,
}

/// What of a picture a part holds when somebody cut it by hand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// Some pixels.
    pub crop: Option<Rect>,
    /// Some samples of each.
    pub samples: Option<Range<u32>>,
}

impl Checkpoint {
    /// What was asked for; the frames of a film are kept in any case.
    pub fn new(args: &RenderArgs, reel: Option<&Reel>) -> Result<Option<Self>, Failure> {
        let every = Duration::from_secs_f64(args.checkpoint_every);
        match (&args.checkpoint, reel) {
            (Some(file), _) if file.is_empty() => Err(Failure::Wrong("the checkpoint has no name".into())),
            (Some(file), _) => Ok(Some(Self { file: file.clone(), every, is_own: false })),
            (None, Some(reel)) => Ok(Some(Self { file: reel.checkpoints(), every, is_own: true })),
            (None, None) => Ok(None),
        }
    }
}

impl Shard {
    /// The picture is nobody else's.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// What was asked for; `variable` reads the environment.
    pub fn new(typed: Option<value::Shard>, variable: impl Fn(&str) -> Option<String>) -> Result<Self, Failure> {
        let Some(value::Shard { index, count }) = typed else { return Ok(Self::WHOLE) };
        let index = match index {
            Some(index) => index,
            None => of_cluster(count, variable)?,
        };
        Ok(Self { index, count })
    }
}

/// The index that a cluster gave, counted from 0.
fn of_cluster(count: u32, variable: impl Fn(&str) -> Option<String>) -> Result<u32, Failure> {
    let wrong = |message: String| Err(Failure::Wrong(message));
    let Some((name, text)) = INDICES.iter().find_map(|name| Some((name, variable(name)?))) else {
        return wrong(format!("--shard auto/{count}: none of {} is set", INDICES.join(", ")));
    };
    match text.parse::<u32>() {
        Ok(index) if index < count => Ok(index),
        Ok(index) => wrong(format!(
            "--shard auto/{count}: {name} is {index}, but shards are 0 to {}: let the array begin with 0",
            count - 1
        )),
        Err(_) => wrong(format!("--shard auto/{count}: {name} is `{text}`, no number")),
    }
}

/// The environment's variable.
pub fn variable(name: &str) -> Option<String> {
    env::var(name).ok()
}

impl Cut {
    /// What was asked for. A picture's crop is the picture; a part's is a piece of it.
    pub fn new(args: &RenderArgs, product: Product) -> Self {
        let crop = args.crop.filter(|_| product == Product::Part);
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
            Err(Failure::Wrong(message)) => Err(message),
            Err(other) => panic!("{other:?}"),
        }
    }

    #[test]
    fn clusters_say_which_shard_it_is() {
        for name in INDICES {
            assert_eq!(auto(&[(name, "3")]), Ok(Shard { index: 3, count: 4 }));
        }
        assert!(auto(&[]).unwrap_err().contains("JOB_COMPLETION_INDEX"));
        assert!(auto(&[("HQ_TASK_ID", "4")]).unwrap_err().contains("0 to 3"));
        assert!(auto(&[("HQ_TASK_ID", "x")]).unwrap_err().contains("`x`"));
    }
}
