//! Shapes where they stand in the world, those of levels below among them.

use super::{Content, Level};
use juggler_material::MaterialId;
use juggler_math::{Motion, Transform};
use juggler_shape::AnyShape;
use std::collections::BTreeMap;
use std::ptr;
use std::sync::Arc;

/// A shape in the world's space.
#[derive(Clone, Debug)]
pub struct Standing {
    /// Its number, instances of levels counted as what they hold.
    pub number: u32,
    pub shape: Arc<AnyShape>,
    pub motion: Motion,
    pub material: MaterialId,
}

/// The shapes of a level, and of those below, that are `wanted`, by what they are made of: the first ones, `most` of them.
pub fn standing(top: &Level, most: usize, wanted: &dyn Fn(&AnyShape, MaterialId) -> bool) -> Vec<Standing> {
    let mut search = Search { wanted, most, found: Vec::new(), known: BTreeMap::new() };
    search.collect(top, &Place { motion: Transform::IDENTITY.into(), first: 0, inherited: None });
    search.found
}

/// Where a level stands, and what it is made of where nothing says.
struct Place {
    motion: Motion,
    first: u32,
    inherited: Option<MaterialId>,
}

struct Search<'a> {
    wanted: &'a dyn Fn(&AnyShape, MaterialId) -> bool,
    most: usize,
    found: Vec<Standing>,
    /// Whether anything in a level is wanted, which may stand in the world any number of times.
    known: BTreeMap<(*const Level, Option<MaterialId>), bool>,
}

impl Search<'_> {
    fn collect(&mut self, level: &Level, place: &Place) {
        for (number, placed) in (0..).zip(&level.objects) {
            if self.found.len() >= self.most {
                return;
            }
            let number = place.first + level.first(number);
            let material = placed.material.or(place.inherited);
            match &placed.content {
                Content::Shape(shape) => {
                    if let Some(material) = material.filter(|material| (self.wanted)(shape, *material)) {
                        let motion = placed.motion.then(&place.motion);
                        self.found.push(Standing { number, shape: Arc::clone(shape), motion, material });
                    }
                }
                Content::Level(below) if self.has_any(below, material) => {
                    let motion = placed.motion.then(&place.motion);
                    self.collect(below, &Place { motion, first: number, inherited: material });
                }
                Content::Level(_) => {}
            }
        }
    }

    /// Whether anything in a level is wanted.
    fn has_any(&mut self, level: &Level, inherited: Option<MaterialId>) -> bool {
        let key = (ptr::from_ref(level), inherited);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let has_any = level.objects.iter().any(|placed| {
            let material = placed.material.or(inherited);
            match &placed.content {
                Content::Shape(shape) => material.is_some_and(|material| (self.wanted)(shape, material)),
                Content::Level(below) => self.has_any(below, material),
            }
        });
        self.known.insert(key, has_any);
        has_any
    }
}
