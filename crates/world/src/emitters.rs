//! All that gives off light, as the path tracer asks for it: one of many, by how much it may bring.

use super::areas::{Areas, NOWHERE};
use super::far::{Far, FarLights};
use super::glowing::Glowing;
use super::{Lamp, Vertex, World};
use juggler_bvh::SimdLevel;
use juggler_light::LightSample;
use juggler_light::background::AnyBackground;
use juggler_light::emitter::{AreaEmitter, LightBounds, LightTree, Pick};
use juggler_math::{Ray, Rgb, Vec2, Vec3, robust};

/// Everything that gives off light.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    /// Over `finite`, in order.
    tree: LightTree,
    finite: Vec<Emitter>,
    /// Those that have no place.
    pub(super) far: FarLights,
    /// The shapes that shine, by number.
    shapes: Vec<Shining>,
}

/// A shape that shines, and where it stands among the emitters.
#[derive(Clone, Debug)]
struct Shining {
    shape: Glowing,
    /// Its first emitter.
    first: u32,
    /// Of each of its parts which of its emitters it belongs to; nothing where there is only one.
    parts: Box<[u32]>,
}

/// Something with a place that gives off light.
#[derive(Clone, Debug)]
enum Emitter {
    /// A light of the scene, by number.
    Lamp(u32),
    /// A surface of the shape at that place.
    Area(AreaEmitter, u32),
    /// The shape at that place as a whole.
    Shape(u32),
}

/// Light from one place of an emitter that was picked.
#[derive(Clone, Copy, Debug)]
pub struct Lighting {
    /// Unit, towards it.
    pub wi: Vec3,
    /// How far it is; infinite for one without a place.
    pub distance: f32,
    /// Radiance that comes from there if nothing is in the way; of lights without a size, what arrives.
    pub radiance: Rgb,
    /// Density per steradian of having picked this place; the chance of having picked the light where it has no size.
    pub pdf: f32,
    /// Whether a ray may meet it by chance.
    pub can_be_met: bool,
    /// Where it comes from.
    pub origin: Origin,
    /// Unit normal of the surface that shines; zero where there is none.
    pub normal: Vec3,
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A light of the scene, by number.
    Lamp(u32),
    /// A shape that shines, by number.
    Shape(u32),
    /// What lies behind everything.
    Background,
}

/// A place that light comes to.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The place.
    pub point: Vec3,
    /// Bound on the distance between `point` and the true surface along the surface's normal; 0 in
    /// media.
    pub error: f32,
    /// Unit normal on the side that light comes to; zero where it may come from everywhere.
    pub normal: Vec3,
    /// When.
    pub time: f32,
}

impl Receiver {
    /// Whether the receiver lies in the plane of an emitter's surface, which has this unit normal
    /// `distance` away in the direction `wi`, up to rounding. Such a surface sends no light there,
    /// but rounding makes some.
    #[inline]
    pub(super) fn is_coplanar(&self, wi: Vec3, distance: f32, normal: Vec3) -> bool {
        // Bound on the receiver's height over the plane: its own error, the emitter's, and those of
        // `wi` and `normal`.
        let bound = 2.0 * self.error + robust::gamma(8) * distance;
        (wi.dot(normal) * distance).abs() <= bound
    }
}

impl Emitters {
    /// Lamps, shapes, and the background; `radius` is that of a ball around everything that has an end.
    pub fn new(lamps: &[Lamp], glowing: Vec<Glowing>, background: &AnyBackground, radius: f32) -> Self {
        let mut emitters = Self::default();
        let (mut bounds, mut far): (Vec<LightBounds>, Vec<(Far, f32)>) = (Vec::new(), Vec::new());
        // Those with a surface stand among the shapes.
        for (number, lamp) in (0..).zip(lamps).filter(|(_, lamp)| !lamp.is_surface) {
            match lamp.bounds(radius) {
                Some(of_lamp) => {
                    emitters.finite.push(Emitter::Lamp(number));
                    bounds.push(of_lamp);
                }
                None => far.push((Far::Lamp(number), lamp.power(1.0))),
            }
        }
        if !background.mean().is_black() {
            far.push((Far::Background, background.power(1.0)));
        }
        emitters.far = FarLights::new(far);
        emitters.add(glowing, &mut bounds);
        emitters.tree = LightTree::build(&bounds);
        emitters
    }

    /// The same for another vector unit.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.tree = self.tree.with_simd_level(level);
        self
    }

    /// Adds the emitters of shapes. The list of shapes is taken over before the lists of emitters grow, so that
    /// millions of emitting shapes are never held twice beside them.
    fn add(&mut self, glowing: Vec<Glowing>, bounds: &mut Vec<LightBounds>) {
        let shining = |shape| Shining { shape, first: 0, parts: Box::default() };
        self.shapes = glowing.into_iter().map(shining).collect();
        // Mostly in order already; numbers are unique.
        self.shapes.sort_unstable_by_key(|shining| shining.shape.number);
        self.finite.reserve(self.shapes.len());
        bounds.reserve(self.shapes.len());
        for (place, Shining { shape, first, parts }) in (0..).zip(&mut self.shapes) {
            *first = self.finite.len() as u32;
            let Some(areas) = shape.still().and_then(|transform| Areas::of(shape.shape(), transform)) else {
                bounds.push(shape.bounds());
                self.finite.push(Emitter::Shape(place));
                continue;
            };
            for surface in areas.surfaces {
                bounds.push(surface.light_bounds(shape.luminance(), shape.is_two_sided()));
                self.finite.push(Emitter::Area(surface, place));
            }
            *parts = areas.parts.into_boxed_slice();
        }
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        let surface =
            |emitter: &Emitter| if let Emitter::Area(surface, _) = emitter { surface.heap_bytes() } else { 0 };
        let surfaces: usize = self.finite.iter().map(surface).sum();
        let parts: usize = self.shapes.iter().map(|shape| size_of_val(&*shape.parts)).sum();
        let listed = size_of_val(self.finite.as_slice()) + size_of_val(self.shapes.as_slice());
        listed + parts + surfaces + self.tree.heap_bytes()
    }

    /// Numbers of the shapes that shine, rising.
    pub fn glowing(&self) -> impl Iterator<Item = u32> {
        self.shapes.iter().map(|shining| shining.shape.number)
    }

    /// The chance of all without a place: each counts as much as all that have one.
    fn far_chance(&self) -> f32 {
        let (far, near) = (self.far.len(), usize::from(!self.finite.is_empty()));
        if far == 0 { 0.0 } else { far as f32 / (far + near) as f32 }
    }

    fn near_chance(&self) -> f32 {
        1.0 - self.far_chance()
    }

    /// One of those that have a place.
    #[inline]
    fn pick(&self, to: &Receiver, u: f32) -> Option<Pick> {
        match self.finite.len() {
            1 => Some(Pick { index: 0, probability: 1.0, rest: u }),
            _ => self.tree.sample(to.point, to.normal, u),
        }
    }

    /// The chance of picking that one.
    #[inline]
    fn chance(&self, to: &Receiver, index: u32) -> f32 {
        match self.finite.len() {
            1 => 1.0,
            _ => self.tree.probability(to.point, to.normal, index),
        }
    }

    /// Density with which [`World::sample_light`] picks the place of a shape that a ray met.
    fn pdf(&self, from: &Receiver, vertex: &Vertex) -> Option<f32> {
        let at = self.shapes.binary_search_by_key(&vertex.object, |shining| shining.shape.number).ok()?;
        let shining = self.shapes.get(at)?;
        let part = shining.parts.get(vertex.part as usize).copied().unwrap_or(0);
        if part == NOWHERE {
            return None;
        }
        let index = shining.first + part;
        let way = vertex.surface.point - from.point;
        let distance = way.length();
        if from.is_coplanar(way / distance, distance, vertex.surface.normal) {
            return None;
        }
        let chance = self.chance(from, index) * self.near_chance();
        let pdf = || match self.finite.get(index as usize) {
            Some(Emitter::Area(area, _)) => area.pdf(from.point, vertex.surface.point),
            Some(Emitter::Shape(_)) => shining.shape.pdf(from, vertex),
            _ => 0.0,
        };
        (chance > 0.0).then(|| chance * pdf())
    }
}

impl World {
    /// Whether more than one thing gives off light.
    #[inline]
    pub fn has_many_emitters(&self) -> bool {
        self.emitters.finite.len() + self.emitters.far.len() > 1
    }

    /// Light that may come to a place from one of all that give light, chosen by `u`.
    #[inline]
    pub fn sample_light(&self, to: &Receiver, u: Vec2) -> Option<Lighting> {
        let emitters = &self.emitters;
        let far = emitters.far_chance();
        if u.x < far {
            let (picked, chance, rest) = emitters.far.pick((u.x / far).min(1f32.next_down()))?;
            let (chance, rest) = (chance * far, Vec2::new(rest, u.y));
            return match picked {
                Far::Lamp(number) => self.lamp_light(number, to, rest, chance),
                Far::Background => self.background_light(to, rest, chance),
            };
        }
        let near = emitters.near_chance();
        let pick = emitters.pick(to, ((u.x - far) / near).min(1f32.next_down()))?;
        let (chance, rest) = (pick.probability * near, Vec2::new(pick.rest, u.y));
        match emitters.finite.get(pick.index as usize)? {
            Emitter::Lamp(number) => self.lamp_light(*number, to, rest, chance),
            Emitter::Area(area, shape) => {
                let sample = area.sample(to.point, rest)?;
                if to.is_coplanar(sample.wi, sample.distance, sample.normal) {
                    return None;
                }
                let shape = &emitters.shapes.get(*shape as usize)?.shape;
                let radiance = shape.radiance(&self.materials, to, sample.wi, sample.normal)?;
                let origin = Origin::Shape(shape.number);
                Some(met(origin, sample.wi, sample.distance, radiance, sample.pdf * chance, sample.normal))
            }
            Emitter::Shape(shape) => {
                emitters.shapes.get(*shape as usize)?.shape.sample(&self.materials, to, rest, chance)
            }
        }
    }

    fn lamp_light(&self, number: u32, to: &Receiver, u: Vec2, chance: f32) -> Option<Lighting> {
        let sample = self.lamps.get(number as usize)?.at(to.time).light.sample(to.point, u)?;
        Some(Lighting {
            wi: sample.wi,
            distance: sample.distance,
            radiance: sample.radiance,
            pdf: sample.pdf * chance,
            can_be_met: false,
            origin: Origin::Lamp(number),
            normal: Vec3::ZERO,
        })
    }

    /// What a light of the scene that shines from a single place brings to a point.
    pub fn point_light(&self, number: u32, to: &Receiver) -> Option<LightSample> {
        let light = &self.lamps.get(number as usize)?.at(to.time).light;
        light.is_point().then(|| light.sample(to.point, Vec2::ZERO))?
    }

    fn background_light(&self, to: &Receiver, u: Vec2, chance: f32) -> Option<Lighting> {
        let sample = self.background.sample(u)?;
        // What shines on the wrong side of a surface is not looked up: pictures of the sky are large.
        if sample.wi.dot(to.normal) < 0.0 {
            return None;
        }
        let radiance = self.background.radiance(&Ray { time: to.time, ..Ray::new(to.point, sample.wi) });
        (!radiance.is_black())
            .then(|| met(Origin::Background, sample.wi, f32::INFINITY, radiance, sample.pdf * chance, Vec3::ZERO))
    }

    /// Density per steradian with which [`World::sample_light`] picks a direction in which a ray left the world.
    #[inline]
    pub fn background_pdf(&self, direction: Vec3) -> f32 {
        let chance = self.emitters.far.chance(Far::Background);
        if chance > 0.0 { self.background.pdf(direction) * (chance * self.emitters.far_chance()) } else { 0.0 }
    }

    /// Density per steradian with which [`World::sample_light`] picks, for the place `from`, the
    /// point `vertex`, where a ray met an emitter.
    #[inline]
    pub fn light_pdf(&self, from: &Receiver, vertex: &Vertex) -> f32 {
        self.emitters.pdf(from, vertex).unwrap_or(0.0)
    }
}

/// Light from a surface, which rays meet by chance too.
pub(super) fn met(origin: Origin, wi: Vec3, distance: f32, radiance: Rgb, pdf: f32, normal: Vec3) -> Lighting {
    Lighting { wi, distance, radiance, pdf, can_be_met: true, origin, normal }
}
