//! A point on one of the scene's paths.
//!
//! ```json
//! {"along": {"path": "flight", "at": "=seconds / 8"}}
//! ```

use super::Kind;
use crate::animate::numbers;
use crate::animate::paths::{PathName, Search};
use crate::animate::survey::Track;
use crate::animate::walk::Walk;
use crate::document::Node;
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest::meant_or_all;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The point at a share of a path's length. Something whose share grows evenly goes along the path at an even speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Along {
    /// Which of the scene's `paths`.
    pub path: PathName,
    /// The share of its length: 0 is the beginning, 1 the end. A closed path begins anew after 1, an open one is held
    /// at its ends.
    pub at: f64,
}

pub const KIND: Kind = Kind { name: "along", value };

fn value(walk: &mut Walk<'_>, content: &Node, at: &Trail<'_>) -> Option<Node> {
    let Along { path: PathName(name), at: share } = walk.read("Along", content, at)?;
    walk.note(at, |track| Track { along: Some(name.clone()), ..track });
    let written = content.get("path").unwrap_or(content);
    let at = at.key("path");
    let finding = match walk.curve(&name) {
        Search::Found(curve) => return Some(numbers(curve.at(share).to_array(), content)),
        Search::Wrong => return None,
        Search::Open => Finding::error(format!("the path `{name}` leads along itself")),
        Search::Missing => {
            let help = meant_or_all(&name, walk.paths.names()).unwrap_or_else(|| "the scene has no `paths`".into());
            Finding::error(format!("no path is called `{name}`")).help(help)
        }
    };
    walk.report(finding.at(&at).on(written.place));
    None
}
