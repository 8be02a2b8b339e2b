//! How many objects a scene places, before any is placed: groups within groups multiply.

use crate::description::{Description, Object};
use crate::path::Path;
use crate::report::Finding;
use std::collections::BTreeMap;

/// Most objects of a scene.
pub const MAX_OBJECTS: u64 = 4_000_000;

/// Refuses groups that contain themselves and scenes with too many objects.
pub fn check(scene: &Description) -> Result<(), Vec<Finding>> {
    let mut counter = Counter { scene, done: BTreeMap::new(), open: Vec::new(), findings: Vec::new() };
    for name in scene.groups.keys() {
        counter.group(name, &Path::root().key("groups").key(name.as_str()));
    }
    let total = counter.objects(&scene.objects, &Path::root().key("objects"));
    if total > MAX_OBJECTS && counter.findings.is_empty() {
        let message = format!("the scene places {total} objects, the limit is {MAX_OBJECTS}");
        let help = "groups within groups multiply; large meshes belong into mesh files";
        counter.findings.push(Finding::error(message).at(Path::root().key("objects")).help(help));
    }
    if counter.findings.is_empty() { Ok(()) } else { Err(counter.findings) }
}

struct Counter<'s> {
    scene: &'s Description,
    done: BTreeMap<&'s str, u64>,
    /// Groups that are being counted, each placed by the one before.
    open: Vec<&'s str>,
    findings: Vec<Finding>,
}

impl<'s> Counter<'s> {
    fn objects(&mut self, objects: &'s [Object], path: &Path) -> u64 {
        objects.iter().enumerate().fold(0, |sum: u64, (i, object)| sum.saturating_add(self.object(object, path, i)))
    }

    fn object(&mut self, object: &'s Object, path: &Path, index: usize) -> u64 {
        let mut count = u64::from(object.shape.is_some());
        if let Some(group) = &object.group {
            count = count.saturating_add(self.group(&group.0, &path.index(index).key("group")));
        }
        if let Some(objects) = &object.objects {
            count = count.saturating_add(self.objects(objects, &path.index(index).key("objects")));
        }
        if let Some(chain) = &object.chain {
            count = count.saturating_add(chain.count.into());
        }
        if let Some(limb) = &object.limb {
            count = count.saturating_add(limb.counts.iter().map(|n| u64::from(*n)).sum::<u64>() + 1);
        }
        count
    }

    /// Objects of a group, which `path` names; 0 for a group that is unknown, which others report.
    fn group(&mut self, name: &'s str, path: &Path) -> u64 {
        if let Some(count) = self.done.get(name) {
            return *count;
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
        self.open.push(name);
        let count = self.objects(objects, &Path::root().key("groups").key(name));
        self.open.pop();
        self.done.insert(name, count);
        count
    }
}
