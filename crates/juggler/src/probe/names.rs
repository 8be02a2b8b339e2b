//! Names of objects, materials, lights and scattering events.

use crate::Picture;
use juggler_camera::aov::LightGroup;
use juggler_integrator::{AnyIntegrator, ScatterEvent, Scattering};
use juggler_render::{InspectedSample, LightContribution, PathVertex};
use juggler_scene::Names;
use juggler_scene::compile::ShapePlace;
use juggler_scene::description::Description;
use juggler_world::{LightSource, SeparateLights, Vertex, World};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Origin of a light contribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightOrigin {
    /// Light of the scene, by its index in the world.
    Light(u32),
    /// Emitting object, by its entry in the scene.
    Entry(u32),
    /// Background.
    Background,
    /// Constant ambient light.
    Ambient,
    /// Lights without a light group of their own.
    Others,
}

/// Object and material that a path hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct HitObject {
    /// Index of the entry in the scene's objects.
    pub entry: u32,
    /// Index of the material.
    pub material: u32,
}

/// Lookup of names.
pub struct Namer<'p> {
    scene: &'p Description,
    world: &'p World,
    names: Arc<Names>,
    separate_lights: &'p SeparateLights,
    /// Indices of the world's lights among the scene's lights; empty if the world has default
    /// lights.
    lights: Vec<usize>,
    /// Whether ambient light contributes, as it does under the integrator `classic`.
    counts_ambient: bool,
    /// Shape of each unnamed material, by material index.
    shapes: BTreeMap<u32, u32>,
    materials: BTreeMap<u32, String>,
}

impl<'p> Namer<'p> {
    pub fn new(scene: &'p Description, picture: &'p Picture, separate_lights: &'p SeparateLights) -> Self {
        // Ambient lights are not lights of the world.
        let world_lights = scene.lights.iter().enumerate().filter(|(_, light)| light.ambient().is_black());
        let lights: Vec<usize> = world_lights.map(|(place, _)| place).collect();
        let world = picture.world();
        let lights = if lights.len() == world.lights().len() { lights } else { Vec::new() };
        let names = Arc::clone(&picture.compiled().names);
        let is_classic = matches!(picture.integrator(), AnyIntegrator::Classic(_));
        let counts_ambient = is_classic && !world.ambient().is_black();
        Self {
            scene,
            world,
            names,
            separate_lights,
            lights,
            counts_ambient,
            shapes: BTreeMap::new(),
            materials: BTreeMap::new(),
        }
    }

    /// Returns the description of a shape, by its index.
    pub fn part(&self, shape: u32) -> Option<ShapePlace> {
        ShapePlace::find(self.scene, shape)
    }

    /// Returns the name of the object that a shape belongs to.
    pub fn object_of(&self, shape: u32) -> String {
        self.names.object(self.world.entry_of(shape))
    }

    /// Returns the name of a material; `shape` is one that has it.
    pub fn material(&mut self, material: u32, shape: u32) -> String {
        if let Some(name) = self.materials.get(&material) {
            return name.clone();
        }
        let is_named = self.names.materials.iter().any(|(id, _)| id.0 == material);
        let part = if is_named { None } else { self.part(shape) };
        let name = part.map_or_else(|| self.names.material(material), |part| part.material);
        self.materials.insert(material, name.clone());
        name
    }

    /// Returns the object that a path hit at a vertex.
    pub fn hit_object(&self, vertex: &PathVertex) -> Option<HitObject> {
        vertex.hit.as_ref().map(|hit| self.hit_object_of(hit))
    }

    /// Returns the object of a surface.
    pub fn hit_object_of(&self, hit: &Vertex) -> HitObject {
        HitObject { entry: self.world.entry_of(hit.shape), material: hit.material.0 }
    }

    /// Returns the object whose medium scattered a path: the last one that it entered.
    pub fn medium(&self, sample: &InspectedSample, place: usize) -> Option<HitObject> {
        let mut vertex = sample.vertices.get(place)?;
        while let (Some(parent), Some(event)) = (vertex.parent, vertex.event) {
            let before = sample.vertices.get(parent as usize)?;
            if event.transmitted && event.scattering != Scattering::Volume {
                return self.hit_object(before);
            }
            vertex = before;
        }
        self.hit_object(sample.vertices.get(place)?)
    }

    /// Registers a shape that has a material.
    pub fn register(&mut self, material: u32, shape: u32) {
        self.shapes.entry(material).or_insert(shape);
    }

    /// Returns the names of object and material.
    pub fn hit_object_names(&mut self, object: HitObject) -> (String, String) {
        let shape = self.shapes.get(&object.material).copied().unwrap_or(u32::MAX);
        (self.names.object(object.entry), self.material(object.material, shape))
    }

    /// Returns the origin of a contribution at a vertex.
    pub fn origin(&self, vertex: &PathVertex, contribution: &LightContribution) -> LightOrigin {
        match (self.separate_lights.source(contribution.group).0, &vertex.hit) {
            (LightSource::Light(number), _) => LightOrigin::Light(number),
            (LightSource::Entry(number), _) => LightOrigin::Entry(number),
            (LightSource::Background, _) => LightOrigin::Background,
            (LightSource::Other, _) if self.counts_ambient => LightOrigin::Ambient,
            (LightSource::Other, Some(hit)) if !contribution.is_light_sample => {
                LightOrigin::Entry(self.world.entry_of(hit.shape))
            }
            (LightSource::Other, _) => LightOrigin::Others,
        }
    }

    /// Returns the light group that the scene gives to a light.
    pub fn group(&self, group: LightGroup) -> LightGroup {
        self.separate_lights.source(group).1
    }

    pub fn group_name(&self, group: LightGroup) -> String {
        let name = self.names.light_groups.get(usize::from(group.0));
        name.map_or_else(|| format!("group {}", group.0), Clone::clone)
    }

    pub fn origin_name(&self, origin: LightOrigin) -> String {
        match origin {
            LightOrigin::Light(number) => {
                let light = self.world.lights().get(number as usize);
                let kind = light.map_or("light", |light| light.at(0.0).light.name());
                match self.lights.get(number as usize) {
                    Some(place) => format!("lights[{place}] ({kind})"),
                    None => format!("default light {number} ({kind})"),
                }
            }
            LightOrigin::Entry(number) => self.names.object(number),
            LightOrigin::Background => "background".into(),
            LightOrigin::Ambient => "ambient light".into(),
            LightOrigin::Others => "other lights".into(),
        }
    }

    /// Returns the kind of a light, without its name.
    pub fn origin_kind(&self, origin: LightOrigin) -> String {
        match origin {
            LightOrigin::Light(number) => {
                let light = self.world.lights().get(number as usize);
                light.map_or_else(|| "light".into(), |light| format!("{} light", light.at(0.0).light.name()))
            }
            LightOrigin::Entry(_) => "emission".into(),
            other => self.origin_name(other),
        }
    }
}

/// Returns the name of a scattering event.
pub fn event_name(event: ScatterEvent) -> &'static str {
    match (event.scattering, event.transmitted) {
        (Scattering::Diffuse, false) => "diffuse",
        (Scattering::Diffuse, true) => "diffuse transmission",
        (Scattering::Glossy, false) => "glossy reflection",
        (Scattering::Glossy, true) => "glossy transmission",
        (Scattering::Specular, false) => "specular reflection",
        (Scattering::Specular, true) => "specular transmission",
        (Scattering::Volume, _) => "volume",
        (Scattering::PassThrough, _) => "pass-through",
    }
}
