//! How many objects a scene places and how many it must store, before any is placed: groups within groups multiply.

use super::emitting;
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::Path;
use crate::report::Finding;
use indexmap::IndexMap;

/// Most objects of a scene, those of groups counted as often as they are placed.
pub const MAX_OBJECTS: u64 = juggler_world::MAX_OBJECTS;
/// Most objects that a scene stores.
pub const MAX_STORED: u64 = 4_000_000;
/// Most shapes of a scene that emit light, those of groups counted as often as they are placed.
pub const MAX_EMITTERS: u64 = 4_000_000;
/// Most groups within each other.
pub const MAX_NESTING: u32 = 64;
/// A group is stored once and shared when all its placements together make more objects than this.
const SHARED_FROM: u64 = 1 << 17;
/// A group that stores fewer objects than this is never shared: going from one space to another costs more.
const SHARED_SIZE: u64 = 16;

/// What becomes of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Objects that one placement makes.
    objects: u64,
    /// Objects that are stored for it.
    stored: u64,
    /// Groups on the longest way down, this one counted.
    nesting: u32,
    /// Levels on the longest way down when it is shared.
    depth: u32,
    /// How often it is placed in the whole scene.
    placements: u64,
    /// Stored once as a level of its own; otherwise its objects are placed as if they stood where it is placed.
    pub is_shared: bool,
}

impl Count {
    /// Objects that one placement makes.
    pub fn objects(&self) -> u64 {
        self.objects
    }
}

/// All groups of a scene; each after those that it places.
pub type Counts<'s> = IndexMap<&'s str, Count>;

/// Decides which groups are shared. Refuses groups that contain themselves and scenes with too many objects.
pub fn count(scene: &Description) -> Result<Counts<'_>, Vec<Finding>> {
    let mut counter = Counter { scene, done: Counts::new(), open: Vec::new(), findings: Vec::new() };
    for name in scene.groups.keys() {
        counter.group(name, &Path::root().key("groups").key(name.as_str()));
    }
    let top = Path::root().key("objects");
    let placed = counter.objects(&scene.objects, &top);
    let Counter { done: mut counts, mut findings, .. } = counter;
    if findings.is_empty() {
        count_placements(scene, &mut counts);
        let stored = count_stored(scene, &mut counts);
        findings.extend(too_many(placed, stored).map(|finding| finding.at(top)));
        findings.extend(emitting::too_many(scene));
    }
    if findings.is_empty() { Ok(counts) } else { Err(findings) }
}

/// Objects that a scene of these groups stores.
pub fn stored(scene: &Description, counts: &Counts<'_>) -> u64 {
    let shared = counts.values().filter(|count| count.is_shared).map(|count| count.stored);
    shared.fold(store(&scene.objects, counts).0, u64::saturating_add)
}

fn too_many(placed: u64, stored: u64) -> Option<Finding> {
    if placed > MAX_OBJECTS {
        let message = format!("the scene places {placed} objects, the limit is {MAX_OBJECTS}");
        Some(Finding::error(message).help("groups within groups multiply; large meshes belong into mesh files"))
    } else if stored > MAX_STORED {
        let message = format!("the scene needs {stored} objects in memory, the limit is {MAX_STORED}");
        let help = format!("what repeats belongs into a group of at least {SHARED_SIZE} objects");
        Some(Finding::error(message).help(help))
    } else {
        None
    }
}

struct Counter<'s> {
    scene: &'s Description,
    done: Counts<'s>,
    /// Groups that are being counted, each placed by the one before.
    open: Vec<&'s str>,
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
        count
    }

    /// Objects of a group, which `path` names; 0 for a group that is unknown, which others report.
    fn group(&mut self, name: &'s str, path: &Path) -> u64 {
        if let Some(count) = self.done.get(name) {
            return count.objects;
        }
        if let Some(at) = self.open.iter().position(|open| *open == name) {
            let chain: Vec<&str> = self.open.iter().skip(at).copied().chain([name]).collect();
            let message = match chain.as_slice() {
                [_, _] => format!("the group `{name}` contains itself"),
                _ => format!("groups contain each other in a circle: {}", chain.join(" → ")),
            };
            self.findings.push(Finding::error(message).at(path));
            return 0;
        }
        let Some(objects) = self.scene.groups.get(name) else { return 0 };
        if self.open.len() >= MAX_NESTING as usize {
            return self.too_deep(path);
        }
        self.open.push(name);
        let count = self.objects(objects, &Path::root().key("groups").key(name));
        self.open.pop();
        let mut below = 0;
        each_group(objects, &mut |inner| below = below.max(self.done.get(inner).map_or(0, |count| count.nesting)));
        self.done.insert(name, Count { objects: count, nesting: below + 1, ..Count::default() });
        if below == MAX_NESTING { self.too_deep(path) } else { count }
    }

    fn too_deep(&mut self, path: &Path) -> u64 {
        let message = format!("groups within groups are more than {MAX_NESTING} deep");
        self.findings.push(Finding::error(message).at(path));
        0
    }
}

/// Shapes that an object is by itself.
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

/// Calls `visit` with every group that the objects place.
fn each_group<'s>(objects: &'s [Item<Object>], visit: &mut impl FnMut(&'s str)) {
    for object in objects.iter().filter(|object| object.is_visible()) {
        if let Some(group) = &object.group {
            visit(&group.0);
        }
        each_group(object.inner(), visit);
    }
}

/// How often each group is placed: those that place it come first, which are the last of all.
fn count_placements(scene: &Description, counts: &mut Counts<'_>) {
    add_placements(&scene.objects, 1, counts);
    for i in (0..counts.len()).rev() {
        if let Some((name, Count { placements, .. })) = counts.get_index(i) {
            add_placements(objects_of(scene, name), *placements, counts);
        }
    }
}

fn add_placements(objects: &[Item<Object>], times: u64, counts: &mut Counts<'_>) {
    each_group(objects, &mut |name| {
        if let Some(count) = counts.get_mut(name) {
            count.placements = count.placements.saturating_add(times);
        }
    });
}

fn objects_of<'s>(scene: &'s Description, group: &str) -> &'s [Item<Object>] {
    scene.groups.get(group).map(|o| o.as_slice()).unwrap_or_default()
}

/// Decides for each group, those within it first, whether it is shared. Returns how many objects the scene stores.
fn count_stored(scene: &Description, counts: &mut Counts<'_>) -> u64 {
    for i in 0..counts.len() {
        let Some((name, _)) = counts.get_index(i) else { continue };
        let (held, depth) = store(objects_of(scene, name), counts);
        let Some((_, count)) = counts.get_index_mut(i) else { continue };
        let many = count.placements > 1 && count.objects.saturating_mul(count.placements) > SHARED_FROM;
        let is_shared = many && held >= SHARED_SIZE && depth < juggler_world::MAX_DEPTH;
        *count = Count { stored: held, depth, is_shared, ..*count };
    }
    stored(scene, counts)
}

/// Objects that are stored where `objects` stand, shared groups counted as one each, and the levels on the longest
/// way down.
fn store(objects: &[Item<Object>], counts: &Counts<'_>) -> (u64, u32) {
    objects.iter().filter(|object| object.is_visible()).fold((0_u64, 1), |(sum, depth), object| {
        let inner = object.inner();
        let (mut stored, mut below) = store(inner, counts);
        stored = stored.saturating_add(shapes(object));
        if let Some(count) = object.group.as_ref().and_then(|group| counts.get(group.0.as_str())) {
            stored = stored.saturating_add(if count.is_shared { 1 } else { count.stored });
            below = below.max(count.depth + u32::from(count.is_shared));
        }
        (sum.saturating_add(stored), depth.max(below))
    })
}
