//! Counts the objects that a scene places and stores before any object is placed. Nested groups
//! multiply.

use super::emitter_count;
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::Path;
use crate::report::Finding;
use indexmap::IndexMap;

/// Maximum number of placed objects; objects of a group count once per placement.
pub const MAX_OBJECTS: u64 = juggler_world::MAX_OBJECTS;
/// Maximum number of stored objects.
pub const MAX_STORED: u64 = 4_000_000;
/// Maximum number of emissive shapes; shapes of a group count once per placement.
pub const MAX_EMITTERS: u64 = 4_000_000;
/// Maximum nesting depth of groups.
pub const MAX_NESTING: u32 = 64;
/// A group is stored once and instanced if all its placements together have more objects than this.
const SHARED_FROM: u64 = 1 << 17;
/// A group that stores fewer objects than this is never instanced, since transforming rays costs
/// more.
const SHARED_SIZE: u64 = 16;

/// Counts of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Number of objects per placement.
    objects: u64,
    /// Number of objects stored for the group.
    stored: u64,
    /// Nesting depth, this group included.
    nesting: u32,
    /// Number of nested levels, the group's own included, if the group is shared.
    depth: u32,
    /// Number of placements in the whole scene.
    placements: u64,
    /// Whether the group is stored once as a level of its own. Otherwise its objects are copied to
    /// each placement.
    pub is_shared: bool,
}

impl Count {
    /// Number of objects per placement.
    pub fn objects(&self) -> u64 {
        self.objects
    }
}

/// Counts of all groups of a scene. Each group follows the groups that it places.
pub type Counts<'s> = IndexMap<&'s str, Count>;

/// Counts all objects and decides which groups are shared. Returns errors for groups that contain
/// themselves and for too many objects.
pub fn count(scene: &Description) -> Result<Counts<'_>, Vec<Finding>> {
    let mut counter = Counter { scene, counts: Counts::new(), in_progress: Vec::new(), findings: Vec::new() };
    for name in scene.groups.keys() {
        counter.group(name, &Path::root().key("groups").key(name.as_str()));
    }
    let top = Path::root().key("objects");
    let placed = counter.objects(&scene.objects, &top);
    let Counter { mut counts, mut findings, .. } = counter;
    if findings.is_empty() {
        count_placements(scene, &mut counts);
        let stored = count_stored(scene, &mut counts);
        findings.extend(too_many(placed, stored).map(|finding| finding.at(top)));
        findings.extend(emitter_count::too_many(scene));
    }
    if findings.is_empty() { Ok(counts) } else { Err(findings) }
}

/// Number of objects that a scene with these groups stores.
pub fn stored(scene: &Description, counts: &Counts<'_>) -> u64 {
    let shared = counts.values().filter(|count| count.is_shared).map(|count| count.stored);
    shared.fold(count_list(&scene.objects, counts).0, u64::saturating_add)
}

/// Least number of stored objects that are instances of a shape from one list, which share most of
/// their memory.
pub fn instances(scene: &Description, counts: &Counts<'_>) -> u64 {
    let placed = scene.groups.iter().filter(|(name, _)| counts.get(name.as_str()).is_some_and(|c| c.placements > 0));
    placed.map(|(_, objects)| listed_instances(objects)).fold(listed_instances(&scene.objects), u64::saturating_add)
}

fn listed_instances(objects: &[Item<Object>]) -> u64 {
    let own = |object: &Object| if object.shape.is_some() { object.instance_count() } else { 0 };
    objects.iter().filter(|object| object.is_visible()).fold(0, |sum: u64, object| {
        let listed = if object.instances.is_some() { own(object) } else { 0 };
        sum.saturating_add(listed).saturating_add(listed_instances(object.inner()))
    })
}

fn too_many(placed: u64, stored: u64) -> Option<Finding> {
    if placed > MAX_OBJECTS {
        let message = format!("the scene places {placed} objects, the limit is {MAX_OBJECTS}");
        Some(
            Finding::error(message)
                .help("nested groups multiply the number of objects; store large meshes in mesh files"),
        )
    } else if stored > MAX_STORED {
        let message = format!("the scene needs {stored} objects in memory, the limit is {MAX_STORED}");
        let help = format!("put repeated objects into a group of at least {SHARED_SIZE} objects, which is stored once");
        Some(Finding::error(message).help(help))
    } else {
        None
    }
}

struct Counter<'s> {
    scene: &'s Description,
    counts: Counts<'s>,
    /// Groups in progress, each placed by the one before.
    in_progress: Vec<&'s str>,
    findings: Vec<Finding>,
}

impl<'s> Counter<'s> {
    fn objects(&mut self, objects: &'s [Item<Object>], path: &Path) -> u64 {
        objects.iter().enumerate().fold(0, |sum: u64, (i, object)| sum.saturating_add(self.object(object, path, i)))
    }

    fn object(&mut self, object: &'s Object, path: &Path, index: usize) -> u64 {
        if !object.is_visible() {
            return 0;
        }
        let mut count = shapes(object);
        if let Some(group) = &object.group {
            count = count.saturating_add(self.group(&group.0, &path.index(index).key("group")));
        }
        if let Some(objects) = &object.objects {
            count = count.saturating_add(self.objects(objects, &path.index(index).key("objects")));
        }
        count.saturating_mul(object.instance_count())
    }

    /// Number of objects of a group that is named at `path`; 0 for an unknown group, which
    /// validation reports.
    fn group(&mut self, name: &'s str, path: &Path) -> u64 {
        if let Some(count) = self.counts.get(name) {
            return count.objects;
        }
        if let Some(at) = self.in_progress.iter().position(|open| *open == name) {
            let chain: Vec<&str> = self.in_progress.iter().skip(at).copied().chain([name]).collect();
            let message = match chain.as_slice() {
                [_, _] => format!("the group `{name}` contains itself"),
                _ => format!("groups contain each other in a cycle: {}", chain.join(" → ")),
            };
            self.findings.push(Finding::error(message).at(path));
            return 0;
        }
        let Some(objects) = self.scene.groups.get(name) else { return 0 };
        if self.in_progress.len() >= MAX_NESTING as usize {
            return self.too_deep(path);
        }
        self.in_progress.push(name);
        let count = self.objects(objects, &Path::root().key("groups").key(name));
        self.in_progress.pop();
        let mut below = 0;
        each_group(objects, 1, &mut |inner, _| {
            below = below.max(self.counts.get(inner).map_or(0, |count| count.nesting));
        });
        self.counts.insert(name, Count { objects: count, nesting: below + 1, ..Count::default() });
        if below == MAX_NESTING { self.too_deep(path) } else { count }
    }

    fn too_deep(&mut self, path: &Path) -> u64 {
        let message = format!("groups are nested deeper than the limit of {MAX_NESTING}");
        self.findings.push(Finding::error(message).at(path));
        0
    }
}

/// Number of an object's own shapes, without groups and child objects, per instance.
pub fn shapes(object: &Object) -> u64 {
    let mut count = u64::from(object.shape.is_some());
    if let Some(chain) = &object.chain {
        count = count.saturating_add(chain.count.into());
    }
    if let Some(limb) = &object.limb {
        count = count.saturating_add(limb.counts.iter().map(|n| u64::from(*n)).sum::<u64>() + 1);
    }
    count
}

/// Calls `visit` with each group that the visible objects place, and the number of placements.
fn each_group<'s>(objects: &'s [Item<Object>], times: u64, visit: &mut impl FnMut(&'s str, u64)) {
    for object in objects.iter().filter(|object| object.is_visible()) {
        let times = times.saturating_mul(object.instance_count());
        if let Some(group) = &object.group {
            visit(&group.0, times);
        }
        each_group(object.inner(), times, visit);
    }
}

/// Counts the placements of each group, outer groups first, which are last in `counts`.
fn count_placements(scene: &Description, counts: &mut Counts<'_>) {
    add_placements(&scene.objects, 1, counts);
    for i in (0..counts.len()).rev() {
        if let Some((name, Count { placements, .. })) = counts.get_index(i) {
            add_placements(objects_of(scene, name), *placements, counts);
        }
    }
}

fn add_placements(objects: &[Item<Object>], times: u64, counts: &mut Counts<'_>) {
    each_group(objects, times, &mut |name, times| {
        if let Some(count) = counts.get_mut(name) {
            count.placements = count.placements.saturating_add(times);
        }
    });
}

fn objects_of<'s>(scene: &'s Description, group: &str) -> &'s [Item<Object>] {
    scene.groups.get(group).map(|o| o.as_slice()).unwrap_or_default()
}

/// Decides for each group whether it is shared, inner groups first. Returns the number of objects
/// that the scene stores.
fn count_stored(scene: &Description, counts: &mut Counts<'_>) -> u64 {
    for i in 0..counts.len() {
        let Some((name, _)) = counts.get_index(i) else { continue };
        let (held, depth) = count_list(objects_of(scene, name), counts);
        let Some((_, count)) = counts.get_index_mut(i) else { continue };
        let many = count.placements > 1 && count.objects.saturating_mul(count.placements) > SHARED_FROM;
        let is_shared = many && held >= SHARED_SIZE && depth < juggler_world::MAX_DEPTH;
        *count = Count { stored: held, depth, is_shared, ..*count };
    }
    stored(scene, counts)
}

/// Number of objects stored for a list, in which a shared group counts as one, and its number of
/// nested levels.
fn count_list(objects: &[Item<Object>], counts: &Counts<'_>) -> (u64, u32) {
    objects.iter().filter(|object| object.is_visible()).fold((0_u64, 1), |(sum, depth), object| {
        let inner = object.inner();
        let (mut stored, mut below) = count_list(inner, counts);
        stored = stored.saturating_add(shapes(object));
        if let Some(count) = object.group.as_ref().and_then(|group| counts.get(group.0.as_str())) {
            stored = stored.saturating_add(if count.is_shared { 1 } else { count.stored });
            below = below.max(count.depth + u32::from(count.is_shared));
        }
        let stored = stored.saturating_mul(object.instance_count());
        (sum.saturating_add(stored), depth.max(below))
    })
}
