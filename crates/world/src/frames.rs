//! Motion vectors: displacement on the film between the rendered frame and its neighbors.
//!
//! Positions are compared at the same time within each frame's shutter interval, as seen through
//! the center of the lens.

use crate::{Vertex, World};
use juggler_camera::aov::AdjacentFrame;
use juggler_camera::{ShutterCamera, WorldToFilm};
use juggler_math::{DVec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// World and camera of another frame.
#[derive(Clone)]
pub struct NeighborFrame {
    /// Geometry at that frame.
    pub world: Arc<World>,
    /// Camera at that frame.
    pub camera: ShutterCamera,
}

/// Camera of the rendered frame, and the scene at the previous and the next frame.
#[derive(Clone)]
pub struct NeighborFrames {
    current: ProjectedCamera,
    previous: Option<(Arc<World>, ProjectedCamera)>,
    next: Option<(Arc<World>, ProjectedCamera)>,
}

impl fmt::Debug for NeighborFrames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Worlds are too large to print.
        f.debug_struct("NeighborFrames").finish_non_exhaustive()
    }
}

/// A camera with its projection onto the film.
#[derive(Clone)]
struct ProjectedCamera {
    camera: ShutterCamera,
    /// Projection, if the camera does not move while the shutter is open.
    static_projection: Option<WorldToFilm>,
}

impl From<ShutterCamera> for ProjectedCamera {
    fn from(camera: ShutterCamera) -> Self {
        let static_projection = if camera.moves() { None } else { camera.world_to_film(0.0) };
        Self { camera, static_projection }
    }
}

impl ProjectedCamera {
    #[inline]
    fn at(&self, time: f32) -> Option<WorldToFilm> {
        self.static_projection.or_else(|| self.camera.world_to_film(time))
    }
}

impl NeighborFrames {
    /// Creates the motion-vector context of `camera`. A missing frame means that nothing moves.
    pub fn new(camera: ShutterCamera, previous: Option<NeighborFrame>, next: Option<NeighborFrame>) -> Self {
        let projected = |NeighborFrame { world, camera }: NeighborFrame| (world, ProjectedCamera::from(camera));
        Self { current: camera.into(), previous: previous.map(projected), next: next.map(projected) }
    }

    /// Returns the same worlds with `camera` at every frame.
    #[must_use]
    pub fn with_camera(&self, camera: &ShutterCamera) -> Self {
        let with_camera = |neighbor: &Option<(Arc<World>, ProjectedCamera)>| {
            neighbor.as_ref().map(|(world, _)| (Arc::clone(world), camera.clone().into()))
        };
        Self { current: camera.clone().into(), previous: with_camera(&self.previous), next: with_camera(&self.next) }
    }

    /// Number of neighboring worlds other than `world`.
    pub fn count_other_worlds(&self, world: &Arc<World>) -> usize {
        [&self.previous, &self.next].into_iter().flatten().filter(|(other, _)| !Arc::ptr_eq(other, world)).count()
    }

    fn neighbor(&self, which: AdjacentFrame) -> Option<&(Arc<World>, ProjectedCamera)> {
        match which {
            AdjacentFrame::Previous => self.previous.as_ref(),
            AdjacentFrame::Next => self.next.as_ref(),
        }
    }

    /// Motion vector of a vertex, in pixels, x to the right and y down; `None` if the point is not
    /// in front of both cameras.
    pub fn motion_vector(&self, which: AdjacentFrame, world: &World, vertex: &Vertex, time: f32) -> Option<DVec2> {
        let from = self.current.at(time)?.point(vertex.surface.point)?;
        let Some((there, projected)) = self.neighbor(which) else { return Some(DVec2::ZERO) };
        let to = projected.at(time)?.point(world.reproject(vertex, time, there))?;
        Some(to - from).filter(|motion_vector| motion_vector.is_finite())
    }

    /// Motion vector of the background in a direction, which only camera rotation causes. `None` if
    /// all rays of a camera are parallel.
    pub fn background_motion_vector(&self, which: AdjacentFrame, direction: Vec3, time: f32) -> Option<DVec2> {
        let from = self.current.at(time)?.direction(direction)?;
        let Some((_, projected)) = self.neighbor(which) else { return Some(DVec2::ZERO) };
        Some(projected.at(time)?.direction(direction)? - from).filter(|motion_vector| motion_vector.is_finite())
    }
}
