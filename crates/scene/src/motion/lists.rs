//! Reads long lists of a document in chunks, so that only one chunk exists as a JSON tree at a time.

use super::{ItemReader, ItemSource, attach_items, head};
use crate::description::Description;
use crate::document::{FileId, LongList, Node, Sources, finding};
use crate::item::Template;
use crate::path::Path;
use crate::report::Finding;
use crate::validate::NameScope;
use std::sync::Arc;

/// Maximum number of errors reported per list.
const MAX_FINDINGS: usize = 200;

/// Reads the items of a long list into a scene at frame 0, whose other sections are already read. Returns all
/// findings; after an error the scene's list is empty.
pub(crate) fn read_list(scene: &mut Description, list: &LongList, sources: &Sources) -> Vec<Finding> {
    let text = sources.get(FileId::MAIN).map(|source| source.text.as_str()).unwrap_or_default();
    let head = head(scene);
    let mut findings = Vec::new();
    for (first, chunk) in list.chunks(text, FileId::MAIN) {
        match chunk {
            Ok((nodes, refused)) => {
                findings.extend(refused.into_iter().map(|refused| finding(FileId::MAIN, refused)));
                read_chunk(scene, &head, sources, list.key, first, nodes, &mut findings);
            }
            Err(refused) => findings.push(finding(FileId::MAIN, refused)),
        }
        if findings.iter().filter(|finding| finding.is_error()).count() >= MAX_FINDINGS {
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
    sources: &Sources,
    key: &str,
    first: usize,
    nodes: Vec<Node>,
    findings: &mut Vec<Finding>,
) {
    let section = Path::root().key(key);
    let wanted = |(i, node): (usize, Node)| {
        let place = node.place;
        let template = Arc::new(Template { node, depends_on_time: true });
        ItemSource { path: section.index(first + i), template, moves: false, place }
    };
    let wanted: Vec<ItemSource> = nodes.into_iter().enumerate().map(wanted).collect();
    let mut reader = ItemReader::new(head, sources, 0.0, NameScope::Scene(scene));
    wanted.iter().for_each(|wanted| reader.add(wanted));
    let (parts, more) = reader.finish();
    findings.extend(more);
    // Items after a mistake stand at other numbers, and are not kept.
    let Some(parts) = parts else { return };
    let in_place: Vec<String> = parts.iter().filter_map(|(path, part)| part.name_in_place(path)).collect();
    parts.into_iter().for_each(|(path, part)| scene.put(&path, part));
    attach_items(scene, head, &wanted, &in_place);
}
