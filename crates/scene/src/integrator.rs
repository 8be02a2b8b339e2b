//! Which integrator renders a scene: the one that the scene names, or the one that fits what the scene holds.

use crate::description::{Backdrop, Description, Object};
use crate::item::Item;
use crate::path::{Path, Trail};
use juggler_integrator::{AnyIntegrator, Classic};
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{AnyMaterial, MaterialRef};
use std::fmt;

/// An integrator, and why it is that one.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorChoice {
    /// The integrator with its settings.
    pub integrator: AnyIntegrator,
    /// Why it is this one.
    pub reason: IntegratorReason,
}

/// Why a scene is rendered with its integrator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum IntegratorReason {
    /// `render.integrator` of the scene names it.
    Scene,
    /// Settings beside the scene name it: the command line, a viewer, a program.
    Settings,
    /// Nobody names it, and the scene holds this, which `classic` cannot light by or shade.
    Holds(Part),
    /// Nobody names it, and all that the scene holds is of the classic kind.
    Classic,
}

/// A part of a scene that asks for an integrator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Where it stands in the scene.
    pub path: Path,
    /// Its kind, as in the scene file: `emissive`, `sky`.
    pub kind: &'static str,
    /// Whether it is a source of light; a material or a medium otherwise.
    pub is_light: bool,
}

impl fmt::Display for IntegratorReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("set by `render.integrator`"),
            Self::Settings => f.write_str("asked for beside the scene"),
            Self::Holds(Part { path, kind, is_light }) => {
                let does = if *is_light { "light a scene" } else { "shade a surface" };
                write!(f, "chosen because `classic` cannot {does} by `{kind}`, which `{path}` holds")
            }
            Self::Classic => f.write_str("chosen because all lights and materials are of the classic kind"),
        }
    }
}

impl IntegratorChoice {
    /// Of a scene: the integrator that it names; else `path` where the scene holds anything that `classic` cannot light by
    /// or shade (an `emissive` material, an `area` light, an `environment` or a `sky`, a medium, any material but `phong` and
    /// what is made of it); else `classic`. Materials count whether or not an object has them.
    pub fn of(scene: &Description) -> Self {
        if let Some(integrator) = &scene.render.integrator {
            return Self { integrator: integrator.clone(), reason: IntegratorReason::Scene };
        }
        match Holdings::of(scene).first() {
            Some(part) => {
                let integrator = juggler_integrator::Path::default().into();
                Self { integrator, reason: IntegratorReason::Holds(part) }
            }
            None => Self { integrator: Classic::default().into(), reason: IntegratorReason::Classic },
        }
    }

    /// Whether light is followed along paths, so that emitters, skies and other backgrounds light the scene.
    pub fn follows_paths(&self) -> bool {
        matches!(self.integrator, AnyIntegrator::Path(_) | AnyIntegrator::Direct(_))
    }

    /// Whether it is the classic integrator.
    pub fn is_classic(&self) -> bool {
        matches!(self.integrator, AnyIntegrator::Classic(_))
    }
}

/// What of a scene asks for an integrator; of each kind the first part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Holdings {
    /// A material that emits light.
    pub emitter: Option<Part>,
    /// An area light.
    area: Option<Part>,
    /// A background that is made to light scenes.
    pub sky: Option<Part>,
    /// A medium, or a material that is no classic one.
    pub physical: Option<Part>,
    /// Whether any surface is of the classic material.
    pub has_phong: bool,
}

impl Holdings {
    /// Of a whole scene.
    pub fn of(scene: &Description) -> Self {
        let mut found = Self::default();
        let background = scene.background.as_ref();
        if let Some(Backdrop::Kind(kind @ (AnyBackground::Environment(_) | AnyBackground::Sky(_)))) =
            background.map(|item| &**item)
        {
            found.sky = Some(Part { path: Path::root().key("background"), kind: kind.name(), is_light: true });
        }
        if let Some(i) = scene.lights.iter().position(|light| matches!(**light, AnyLight::Area(_))) {
            found.area = Some(Part { path: Path::root().key("lights").index(i), kind: "area", is_light: true });
        }
        let materials = Trail::Root.key("materials");
        scene.materials.iter().for_each(|(name, material)| found.material(material, &materials.key(name)));
        let groups = Trail::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| found.objects(objects, &groups.key(name), true));
        found.objects(&scene.objects, &Trail::Root.key("objects"), false);
        found
    }

    /// What asks for `path` most: sources of light before materials.
    fn first(self) -> Option<Part> {
        self.emitter.or(self.area).or(self.sky).or(self.physical)
    }

    /// `inherits` says whether objects without a material may take one from where they are placed.
    fn objects(&mut self, objects: &[Item<Object>], path: &Trail<'_>, inherits: bool) {
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

    fn inline(&mut self, material: &MaterialRef, path: &Trail<'_>) {
        if let MaterialRef::Inline(material) = material {
            self.material(material, path);
        }
    }

    /// Named materials within others are looked at under their own names.
    fn material(&mut self, material: &AnyMaterial, path: &Trail<'_>) {
        let part = |is_light| Some(Part { path: path.into(), kind: material.name(), is_light });
        let parts = material.parts();
        if material.is_classic() {
            self.has_phong = true;
        } else if material.is_emitter() {
            self.emitter = self.emitter.take().or_else(|| part(true));
        } else if parts.is_empty() {
            self.physical = self.physical.take().or_else(|| part(false));
        }
        parts.into_iter().for_each(|part| self.inline(part, path));
    }
}
