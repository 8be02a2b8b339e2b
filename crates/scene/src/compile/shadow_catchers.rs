//! Shadow catchers of a scene, and the objects of the world in which nothing takes light from them.

use super::Assembly;
use crate::description::{Description, Object};
use crate::path::{Path, PathRef};
use crate::report::Finding;
use juggler_world::Object as WorldObject;
use std::ops::Deref;

impl Assembly {
    /// Warns of shadow catchers without effect: in an opaque picture, and inside of other objects.
    pub(super) fn check_shadow_catchers(scene: &Description, findings: &mut Vec<Finding>) {
        let objects = PathRef::Root.key("objects");
        if let Some(i) =
            scene.objects.iter().position(|object| object.shadow_catcher).filter(|_| !scene.render.transparent)
        {
            let warning = Finding::warning("`shadow_catcher` has no effect: the picture is opaque");
            let path = Path::from(&objects.index(i).key("shadow_catcher"));
            findings
                .push(warning.at(path).help("write \"render\": {\"transparent\": true}, or render with --transparent"));
        }
        for (i, object) in scene.objects.iter().enumerate() {
            check_inner(object.inner(), &objects.index(i).key("objects"), findings);
        }
        for (name, objects) in &scene.groups {
            check_inner(objects, &PathRef::Root.key("groups").key(name), findings);
        }
    }

    /// The objects that catch shadows or emit light; `None` without shadow catchers.
    pub(super) fn shadow_catching_objects(&self) -> Option<Vec<WorldObject>> {
        let Self { objects, materials, labels, shadow_catchers, .. } = self;
        if !shadow_catchers.contains(&true) {
            return None;
        }
        let (mut first_shape, mut kept) = (0_u64, Vec::new());
        for object in objects {
            let entry = labels.entries.partition_point(|first| u64::from(*first) <= first_shape).saturating_sub(1);
            if shadow_catchers.get(entry).copied().unwrap_or_default() || object.may_emit(materials) {
                kept.push(object.clone());
            }
            first_shape = first_shape.saturating_add(object.shapes());
        }
        Some(kept)
    }
}

/// Warns of shadow catchers in a list inside of another object or in a group.
fn check_inner<T: Deref<Target = Object>>(objects: &[T], path: &PathRef<'_>, findings: &mut Vec<Finding>) {
    for (i, object) in objects.iter().enumerate() {
        if object.shadow_catcher {
            let warning = Finding::warning("`shadow_catcher` has an effect only in the scene's own `objects`");
            findings.push(warning.at(Path::from(&path.index(i).key("shadow_catcher"))));
        }
        check_inner(object.inner(), &path.index(i).key("objects"), findings);
    }
}
