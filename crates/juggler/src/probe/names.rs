//! What things are called: objects, materials, lights, and what paths did.

use crate::Picture;
use juggler_camera::layer::LightGroup;
use juggler_integrator::{AnyIntegrator, Event, Scattering};
use juggler_render::{Inspected, LightGain, PathVertex};
use juggler_scene::Names;
use juggler_scene::compile::Part;
use juggler_scene::description::Description;
use juggler_world::{LightSource, LightsApart, Vertex, World};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// A light of the scene, by its number in the world.
    Lamp(u32),
    /// An entry of the scene that shines.
    Entry(u32),
    /// What lies behind everything.
    Background,
    /// Light from everywhere.
    Ambient,
    /// Lights that are not told apart.
    Others,
}

/// A thing that a path met: an entry of the scene, and a material with a shape that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Thing {
    /// The entry of the scene's objects.
    pub entry: u32,
    /// The material.
    pub material: u32,
}

/// Knows what things are called.
pub struct Namer<'p> {
    scene: &'p Description,
    world: &'p World,
    names: Arc<Names>,
    apart: &'p LightsApart,
    /// Places of the world's lamps among the scene's lights; nothing where the world has lamps of its own.
    lamps: Vec<usize>,
    /// Whether light from everywhere is counted in: classic pictures have it.
    has_ambient: bool,
    /// A shape of each material that has no name.
    shapes: BTreeMap<u32, u32>,
    materials: BTreeMap<u32, String>,
}

impl<'p> Namer<'p> {
    pub fn new(scene: &'p Description, picture: &'p Picture, apart: &'p LightsApart) -> Self {
        // Those from everywhere are no lamps of the world.
        let shines = scene.lights.iter().enumerate().filter(|(_, light)| light.ambient().is_black());
        let lamps: Vec<usize> = shines.map(|(place, _)| place).collect();
        let world = picture.world();
        let lamps = if lamps.len() == world.lamps().len() { lamps } else { Vec::new() };
        let names = Arc::clone(&picture.compiled().names);
        let is_classic = matches!(picture.integrator(), AnyIntegrator::Classic(_));
        let has_ambient = is_classic && !world.ambient().is_black();
        Self { scene, world, names, apart, lamps, has_ambient, shapes: BTreeMap::new(), materials: BTreeMap::new() }
    }

    /// Where a shape is described, by its number.
    pub fn part(&self, shape: u32) -> Option<Part> {
        Part::of(self.scene, shape)
    }

    /// The entry that a shape is of.
    pub fn object_of(&self, shape: u32) -> String {
        self.names.object(self.world.entry_of(shape))
    }

    /// A material that some shape has.
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

    /// What a path met at a place.
    pub fn thing(&self, vertex: &PathVertex) -> Option<Thing> {
        vertex.met.as_ref().map(|met| self.thing_of(met))
    }

    /// The thing that a surface is of.
    pub fn thing_of(&self, met: &Vertex) -> Thing {
        Thing { entry: self.world.entry_of(met.object), material: met.material.0 }
    }

    /// The thing in whose medium a path was scattered: what it last went into.
    pub fn medium(&self, sample: &Inspected, place: usize) -> Option<Thing> {
        let mut vertex = sample.vertices.get(place)?;
        while let (Some(parent), Some(came)) = (vertex.parent, vertex.came) {
            let before = sample.vertices.get(parent as usize)?;
            if came.transmitted && came.scattering != Scattering::Volume {
                return self.thing(before);
            }
            vertex = before;
        }
        self.thing(sample.vertices.get(place)?)
    }

    /// Has a shape stand for its material's name.
    pub fn note(&mut self, material: u32, shape: u32) {
        self.shapes.entry(material).or_insert(shape);
    }

    /// `floor`, and its material where that says more.
    pub fn thing_name(&mut self, thing: Thing) -> (String, String) {
        let shape = self.shapes.get(&thing.material).copied().unwrap_or(u32::MAX);
        (self.names.object(thing.entry), self.material(thing.material, shape))
    }

    /// Where light that was added at a place comes from.
    pub fn origin(&self, vertex: &PathVertex, gain: &LightGain) -> Origin {
        match (self.apart.source(gain.group).0, &vertex.met) {
            (LightSource::Lamp(number), _) => Origin::Lamp(number),
            (LightSource::Entry(number), _) => Origin::Entry(number),
            (LightSource::Background, _) => Origin::Background,
            (LightSource::Rest, _) if self.has_ambient => Origin::Ambient,
            (LightSource::Rest, Some(met)) if !gain.asked => Origin::Entry(self.world.entry_of(met.object)),
            (LightSource::Rest, _) => Origin::Others,
        }
    }

    /// The group of lights that light is of.
    pub fn group(&self, group: LightGroup) -> LightGroup {
        self.apart.source(group).1
    }

    pub fn group_name(&self, group: LightGroup) -> String {
        let name = self.names.light_groups.get(usize::from(group.0));
        name.map_or_else(|| format!("group {}", group.0), Clone::clone)
    }

    pub fn origin_name(&self, origin: Origin) -> String {
        match origin {
            Origin::Lamp(number) => {
                let lamp = self.world.lamps().get(number as usize);
                let kind = lamp.map_or("light", |lamp| lamp.at(0.0).light.name());
                match self.lamps.get(number as usize) {
                    Some(place) => format!("lights[{place}] ({kind})"),
                    None => format!("default light {number} ({kind})"),
                }
            }
            Origin::Entry(number) => self.names.object(number),
            Origin::Background => "background".into(),
            Origin::Ambient => "ambient light".into(),
            Origin::Others => "other lights".into(),
        }
    }

    /// What kind of light it is, whichever.
    pub fn origin_kind(&self, origin: Origin) -> String {
        match origin {
            Origin::Lamp(number) => {
                let lamp = self.world.lamps().get(number as usize);
                lamp.map_or_else(|| "light".into(), |lamp| format!("{} light", lamp.at(0.0).light.name()))
            }
            Origin::Entry(_) => "what shines".into(),
            other => self.origin_name(other),
        }
    }
}

/// What a path did.
pub fn event_name(event: Event) -> &'static str {
    match (event.scattering, event.transmitted) {
        (Scattering::Diffuse, false) => "diffuse",
        (Scattering::Diffuse, true) => "diffuse transmission",
        (Scattering::Glossy, false) => "glossy reflection",
        (Scattering::Glossy, true) => "glossy transmission",
        (Scattering::Specular, false) => "specular reflection",
        (Scattering::Specular, true) => "specular transmission",
        (Scattering::Volume, _) => "volume",
        (Scattering::Passed, _) => "hole",
    }
}
