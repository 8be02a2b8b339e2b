//! Paths from shadow catchers: traced in the world and in the world without objects that take light
//! from them, with the same random numbers, so that both radiances are equal where no light is lost.

use super::{Cancelled, Control, Engine, PathBuffers, Queue};
use juggler_integrator::PathState;
use juggler_math::{Ray, Rgb};
use juggler_world::{World, WorldHit};

/// Whether a camera ray, also behind glass, hit a shadow catcher.
#[inline]
pub fn hits_shadow_catcher(world: &World, path: &PathState, hit: &WorldHit) -> bool {
    path.history.sees_backdrop && world.is_on_shadow_catcher(hit)
}

/// Keeps a camera ray that hit a shadow catcher, and records that.
pub fn catch(caught: &mut Queue, buffers: &mut PathBuffers, ray: &Ray, path: &PathState) {
    // Additional camera rays see no light there.
    if path.history.is_split {
        return;
    }
    // Restore the maximum distance, so that the ray is intersected anew.
    caught.push(Ray { t_max: f32::INFINITY, ..*ray }, *path);
    if let Some(record) = &mut buffers.record {
        record.record_shadow_catcher(path.slot as usize, path.beta);
    }
}

impl<'j> Engine<'j> {
    /// Traces the rays that hit shadow catchers, and records the light that these have and would
    /// have alone. Their radiance does not reach the picture.
    pub(super) fn trace_shadow_catchers(&mut self, control: &Control) -> Result<(), Cancelled> {
        let Some(mut caught) = self.caught.take_if(|caught| !caught.is_empty()) else { return Ok(()) };
        sort_by_slot(&mut caught);
        let world = self.world;
        let picture = std::mem::take(&mut self.buffers.radiance);
        let (record, clamping) = (self.buffers.record.take(), self.buffers.clamping.clone());
        let lit = self.radiance_of(&caught, world, picture.len(), control);
        let unoccluded = self.radiance_of(&caught, world.unoccluded().unwrap_or(world), picture.len(), control);
        caught.clear();
        (self.world, self.caught) = (world, Some(caught));
        (self.buffers.radiance, self.buffers.record, self.buffers.clamping) = (picture, record, clamping);
        for (slot, (lit, unoccluded)) in lit?.into_iter().zip(unoccluded?).enumerate() {
            if let Some(record) = &mut self.buffers.record {
                record.record_caught_light(slot, lit, unoccluded);
            }
        }
        Ok(())
    }

    /// Radiance along rays in a world, summed for each of `slots` samples.
    fn radiance_of(
        &mut self,
        rays: &Queue,
        world: &'j World,
        slots: usize,
        control: &Control,
    ) -> Result<Vec<Rgb>, Cancelled> {
        self.world = world;
        self.buffers.reset(slots, world.lights().len());
        self.buffers.next.rays.extend_from_slice(&rays.rays);
        self.buffers.next.paths.extend_from_slice(&rays.paths);
        self.stack_next();
        self.trace(control)?;
        Ok(std::mem::take(&mut self.buffers.radiance))
    }
}

/// Sorts rays by their samples, and keeps the order of each sample's rays.
fn sort_by_slot(queue: &mut Queue) {
    if queue.paths.is_sorted_by_key(|path| path.slot) {
        return;
    }
    let mut rays: Vec<(Ray, PathState)> = queue.rays.drain(..).zip(queue.paths.drain(..)).collect();
    rays.sort_by_key(|(_, path)| path.slot);
    (queue.rays, queue.paths) = rays.into_iter().unzip();
}
