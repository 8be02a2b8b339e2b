//! What a scene is at the frames beside the one that is rendered: how far what is seen goes on the film from one to the other.
//!
//! What is seen at some time while the shutter is open is compared with where it is at the same time of the other frame's shutter,
//! both as through the middle of the lens.

use crate::{Vertex, World};
use juggler_camera::layer::Beside;
use juggler_camera::{Finder, Shot};
use juggler_math::{DVec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// The scene at another frame.
#[derive(Clone)]
pub struct Frame {
    /// What can be seen.
    pub world: Arc<World>,
    /// From where.
    pub camera: Shot,
}

/// The camera at the frame that is rendered, and the scene at those beside it.
#[derive(Clone)]
pub struct Frames {
    here: Found,
    previous: Option<(Arc<World>, Found)>,
    next: Option<(Arc<World>, Found)>,
}

impl fmt::Debug for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Worlds are large.
        f.debug_struct("Frames").finish_non_exhaustive()
    }
}

/// Where points are seen.
#[derive(Clone)]
struct Found {
    camera: Shot,
    /// What is the same at all times.
    still: Option<Finder>,
}

impl From<Shot> for Found {
    fn from(camera: Shot) -> Self {
        let still = if camera.moves() { None } else { camera.finder(0.0) };
        Self { camera, still }
    }
}

impl Found {
    #[inline]
    fn at(&self, time: f32) -> Option<Finder> {
        self.still.or_else(|| self.camera.finder(time))
    }
}

impl Frames {
    /// Seen by `camera`; a frame that is nothing is as the one that is rendered.
    pub fn new(camera: Shot, previous: Option<Frame>, next: Option<Frame>) -> Self {
        let found = |Frame { world, camera }: Frame| (world, Found::from(camera));
        Self { here: camera.into(), previous: previous.map(found), next: next.map(found) }
    }

    /// The same seen by a camera that is the same at all frames.
    #[must_use]
    pub fn seen_from(&self, camera: &Shot) -> Self {
        let seen = |beside: &Option<(Arc<World>, Found)>| {
            beside.as_ref().map(|(world, _)| (Arc::clone(world), camera.clone().into()))
        };
        Self { here: camera.clone().into(), previous: seen(&self.previous), next: seen(&self.next) }
    }

    /// How many worlds it holds that are not `world`.
    pub fn worlds_beside(&self, world: &Arc<World>) -> usize {
        [&self.previous, &self.next].into_iter().flatten().filter(|(other, _)| !Arc::ptr_eq(other, world)).count()
    }

    fn beside(&self, which: Beside) -> Option<&(Arc<World>, Found)> {
        match which {
            Beside::Previous => self.previous.as_ref(),
            Beside::Next => self.next.as_ref(),
        }
    }

    /// How far the point of a vertex goes on the film, in pixels, x to the right and y down; nothing where it is not before both
    /// cameras.
    pub fn way(&self, which: Beside, world: &World, vertex: &Vertex, time: f32) -> Option<DVec2> {
        let from = self.here.at(time)?.point(vertex.surface.point)?;
        let Some((there, found)) = self.beside(which) else { return Some(DVec2::ZERO) };
        let to = found.at(time)?.point(world.carried(vertex, time, there))?;
        Some(to - from).filter(|way| way.is_finite())
    }

    /// The same of what lies without end in a direction: it goes only where the camera turns. Nothing where all rays are parallel.
    pub fn way_of_direction(&self, which: Beside, direction: Vec3, time: f32) -> Option<DVec2> {
        let from = self.here.at(time)?.direction(direction)?;
        let Some((_, found)) = self.beside(which) else { return Some(DVec2::ZERO) };
        Some(found.at(time)?.direction(direction)? - from).filter(|way| way.is_finite())
    }
}
