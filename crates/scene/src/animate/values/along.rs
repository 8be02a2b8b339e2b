//! Value form `along`: point on a path of the scene.
//!
//! ```json
//! {"along": {"path": "flight", "at": "=seconds / 8"}}
//! ```

use super::Kind;
use crate::animate::numbers;
use crate::animate::paths::{PathLookup, PathName};
use crate::animate::survey::FormSummary;
use crate::animate::tree_resolver::TreeResolver;
use crate::animate::value_source::Animatable;
use crate::document::Node;
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest::did_you_mean_or_list;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Point at a fraction of a path's arc length. A fraction that increases linearly gives motion of
/// constant speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Along {
    /// Name of a path in the scene's `paths`.
    pub path: PathName,
    /// Fraction of the path's arc length: 0 is the start, 1 the end. A closed path wraps around; an
    /// open path stays at its ends.
    pub at: Animatable<f64>,
}

impl Along {
    /// Creates the point at a fraction of the arc length of a path of the scene.
    pub fn new(path: impl Into<String>, at: impl Into<Animatable<f64>>) -> Self {
        Self { path: PathName(path.into()), at: at.into() }
    }
}

pub const KIND: Kind = Kind { name: "along", value };

fn value(resolver: &mut TreeResolver<'_>, content: &Node, at: &PathRef<'_>) -> Option<Node> {
    let Along { path: PathName(name), at: share } = resolver.read("Along", content, at)?;
    let share = share.value()?;
    resolver.record_form(at, |track| FormSummary { along: Some(name.clone()), ..track });
    let written = content.get("path").unwrap_or(content);
    let at = at.key("path");
    let finding = match resolver.curve(&name) {
        PathLookup::Found(curve) => return Some(numbers(curve.point_at(share).to_array(), content)),
        PathLookup::Invalid => return None,
        PathLookup::Cyclic => Finding::error(format!("the path `{name}` depends on itself")),
        PathLookup::Missing => {
            let help = did_you_mean_or_list(&name, resolver.paths.names())
                .unwrap_or_else(|| "the scene has no `paths`".into());
            Finding::error(format!("no path is called `{name}`")).help(help)
        }
    };
    resolver.report(finding.at(&at).on(written.place));
    None
}
