//! Reads long lists of a document in chunks, so that only one chunk exists as a JSON tree at a
//! time.

use super::{ItemSource, head, replace_items};
use crate::animate::SceneSources;
use crate::description::Description;
use crate::document::{FileId, LongList, Node, finding};
use crate::path::Path;
use crate::report::Finding;
use juggler_math::BuildControl;

/// Maximum number of errors reported per list.
const MAX_FINDINGS: usize = 200;

/// Reads the items of a long list into a scene at frame 0, whose other sections are already read.
/// Returns all findings; after an error the scene's list is empty. Ends early if `control` is
/// cancelled.
pub(crate) fn read_list(
    scene: &mut Description,
    list: &LongList,
    sources: SceneSources<'_>,
    control: &BuildControl,
) -> Vec<Finding> {
    let text = sources.texts.get(FileId::MAIN).map(|source| source.text.as_str()).unwrap_or_default();
    let head = head(scene);
    let mut findings = Vec::new();
    for (first, chunk) in list.chunks(text, FileId::MAIN) {
        match chunk {
            Ok((nodes, errors)) => {
                findings.extend(errors.into_iter().map(|error| finding(FileId::MAIN, error)));
                read_chunk(scene, &head, sources, list.key, first, nodes, &mut findings);
            }
            Err(error) => findings.push(finding(FileId::MAIN, error)),
        }
        if control.is_cancelled() || findings.iter().filter(|finding| finding.is_error()).count() >= MAX_FINDINGS {
            break;
        }
    }
    if findings.iter().any(Finding::is_error) {
        match list.key {
            "lights" => scene.lights.clear(),
            _ => scene.objects.clear(),
        }
    }
    findings
}

fn read_chunk(
    scene: &mut Description,
    head: &Node,
    sources: SceneSources<'_>,
    key: &str,
    first: usize,
    nodes: Vec<Node>,
    findings: &mut Vec<Finding>,
) {
    let section = Path::root().key(key);
    let items = nodes.into_iter().enumerate().map(|(i, node)| ItemSource::unread(section.index(first + i), node));
    let (_, more) = replace_items(scene, head, sources, 0.0, &items.collect::<Vec<_>>());
    findings.extend(more);
}
