//! Choice of a scene's integrator: the one that the scene names, or the one that supports
//! everything in the scene.

use crate::description::{BackgroundInput, Description, Object};
use crate::item::Item;
use crate::path::{Path, PathRef};
use juggler_integrator::{AnyIntegrator, Classic};
use juggler_light::background::AnyBackground;
use juggler_material::{AnyMaterial, MaterialRef};
use std::fmt;

/// An integrator and the reason for its choice.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorChoice {
    /// The integrator with its settings.
    pub integrator: AnyIntegrator,
    /// Reason for the choice.
    pub reason: IntegratorReason,
}

/// Reason for the choice of an integrator.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum IntegratorReason {
    /// `render.integrator` of the scene names it.
    Scene,
    /// Settings outside the scene name it: the command line, a viewer, a program.
    Settings,
    /// No integrator is named, and the scene contains this part, which `classic` does not support.
    RequiredBy(IntegratorRequirement),
    /// No integrator is named, and `classic` supports everything in the scene.
    Classic,
}

/// A part of a scene that requires an integrator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IntegratorRequirement {
    /// Path of the part in the scene.
    pub path: Path,
    /// Kind of the part as in the scene file, such as `emissive` or `sky`.
    pub kind: &'static str,
    /// Whether the part is a light source; otherwise it is a material or a medium.
    pub is_light: bool,
}

impl fmt::Display for IntegratorReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("set by `render.integrator`"),
            Self::Settings => f.write_str("set outside the scene"),
            Self::RequiredBy(IntegratorRequirement { path, kind, .. }) => {
                write!(f, "chosen because `classic` does not support `{kind}` at `{path}`")
            }
            Self::Classic => f.write_str("chosen because `classic` supports all lights and materials of the scene"),
        }
    }
}

impl IntegratorChoice {
    /// Chooses the integrator of a scene: the one that it names; else `path` if the scene contains
    /// anything that `classic` does not support (an `emissive` material, an `area` light, an
    /// `environment` or a `sky`, a medium, any material but `phong` and combinations of it); else
    /// `classic`. Unused materials count too.
    pub fn for_scene(scene: &Description) -> Self {
        if let Some(integrator) = &scene.render.integrator {
            return Self { integrator: integrator.clone(), reason: IntegratorReason::Scene };
        }
        match IntegratorRequirements::from_scene(scene).first() {
            Some(part) => {
                let integrator = juggler_integrator::Path::default().into();
                Self { integrator, reason: IntegratorReason::RequiredBy(part) }
            }
            None => Self { integrator: Classic::default().into(), reason: IntegratorReason::Classic },
        }
    }

    /// Whether the integrator traces paths, so that emissive surfaces, skies and other backgrounds
    /// light the scene.
    pub fn follows_paths(&self) -> bool {
        matches!(self.integrator, AnyIntegrator::Path(_) | AnyIntegrator::Direct(_))
    }

    /// Whether the integrator is the classic one.
    pub fn is_classic(&self) -> bool {
        matches!(self.integrator, AnyIntegrator::Classic(_))
    }
}

/// The parts of a scene that require an integrator, the first of each category.
#[derive(Clone, Debug, Default)]
pub(crate) struct IntegratorRequirements {
    /// Material that emits light.
    pub emitter: Option<IntegratorRequirement>,
    /// Area light.
    area: Option<IntegratorRequirement>,
    /// Background that is designed to light scenes.
    pub sky: Option<IntegratorRequirement>,
    /// Medium or physically based material.
    pub physical: Option<IntegratorRequirement>,
    /// Whether any surface has a material of the classic kind.
    pub has_phong: bool,
}

impl IntegratorRequirements {
    /// Collects the parts of a whole scene.
    pub fn from_scene(scene: &Description) -> Self {
        let mut found = Self::default();
        let background = scene.background.as_ref();
        if let Some(BackgroundInput::Kind(
            kind @ (AnyBackground::Environment(_) | AnyBackground::Sky(_) | AnyBackground::Studio(_)),
        )) = background.map(|item| &**item)
        {
            found.sky =
                Some(IntegratorRequirement { path: Path::root().key("background"), kind: kind.name(), is_light: true });
        }
        if let Some((i, light)) = scene.lights.iter().enumerate().find(|(_, light)| light.is_surface()) {
            let path = Path::root().key("lights").index(i);
            found.area = Some(IntegratorRequirement { path, kind: light.name(), is_light: true });
        }
        let materials = PathRef::Root.key("materials");
        scene.materials.iter().for_each(|(name, material)| found.material(material, &materials.key(name)));
        let groups = PathRef::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| found.objects(objects, &groups.key(name), true));
        found.objects(&scene.objects, &PathRef::Root.key("objects"), false);
        found
    }

    /// The main reason for `path`: light sources before materials.
    fn first(self) -> Option<IntegratorRequirement> {
        self.emitter.or(self.area).or(self.sky).or(self.physical)
    }

    /// `inherits` tells whether objects without a material may inherit one from the object that
    /// places them.
    fn objects(&mut self, objects: &[Item<Object>], path: &PathRef<'_>, inherits: bool) {
        for (i, object) in objects.iter().enumerate() {
            let path = path.index(i);
            match &object.material {
                Some(MaterialRef::Inline(material)) => self.material(material, &path.key("material")),
                Some(MaterialRef::Name(_)) => {}
                None => self.has_phong |= !inherits && object.objects.is_none() && object.group.is_none(),
            }
            let inner = object.inner();
            self.objects(inner, &path.key("objects"), inherits || object.material.is_some());
        }
    }

    fn inline(&mut self, material: &MaterialRef, path: &PathRef<'_>) {
        if let MaterialRef::Inline(material) = material {
            self.material(material, path);
        }
    }

    /// Visits an inline material. Named materials inside it are visited under their own names.
    fn material(&mut self, material: &AnyMaterial, path: &PathRef<'_>) {
        let part = |is_light| Some(IntegratorRequirement { path: path.into(), kind: material.name(), is_light });
        let parts = material.nested_materials();
        if material.is_classic() {
            self.has_phong = true;
        } else if material.is_area_light() {
            self.emitter = self.emitter.take().or_else(|| part(true));
        } else if parts.is_empty() {
            self.physical = self.physical.take().or_else(|| part(false));
        }
        parts.into_iter().for_each(|(_, part)| self.inline(part, path));
    }
}
