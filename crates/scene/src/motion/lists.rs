//! Long lists of a text, which become items piece by piece, so that no more than a piece of them is ever a tree.

use super::{Reader, Wanted, attach_items, head};
use crate::description::Description;
use crate::document::{FileId, LongList, Node, Sources, finding};
use crate::item::Template;
use crate::path::Path;
use crate::report::Finding;
use crate::validate::Known;
use std::sync::Arc;

/// Most mistakes of a list that are collected.
const MAX_FINDINGS: usize = 200;

/// Adds the items of a long list to a scene at frame 0, all else of which has been read. All that is wrong with them is
/// returned; then the scene's list stays empty.
pub(crate) fn read_list(scene: &mut Description, list: &LongList, sources: &Sources) -> Vec<Finding> {
    let text = sources.get(FileId::MAIN).map(|source| source.text.as_str()).unwrap_or_default();
    let head = head(scene);
    let mut findings = Vec::new();
    for (first, piece) in list.pieces(text, FileId::MAIN) {
        match piece {
            Ok((nodes, refused)) => {
                findings.extend(refused.into_iter().map(|refused| finding(FileId::MAIN, refused)));
                read_piece(scene, &head, sources, list.key, first, nodes, &mut findings);
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

fn read_piece(
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
        Wanted { path: section.index(first + i), template, moves: false, place }
    };
    let wanted: Vec<Wanted> = nodes.into_iter().enumerate().map(wanted).collect();
    let mut reader = Reader::new(head, sources, 0.0, Known::Scene(scene));
    wanted.iter().for_each(|wanted| reader.add(wanted));
    let (parts, more) = reader.finish();
    findings.extend(more);
    // Items after a mistake stand at other numbers, and are not kept.
    let Some(parts) = parts else { return };
    let in_place: Vec<String> = parts.iter().filter_map(|(path, part)| part.name_in_place(path)).collect();
    parts.into_iter().for_each(|(path, part)| scene.put(&path, part));
    attach_items(scene, head, &wanted, &in_place);
}
