//! Ray queries: nearest hit, occlusion, and transmittance of shadow rays.

use super::cluster::Cluster;
use super::instance::{Instance, LeafItem};
use super::large_mesh::RayCoherence;
use super::{Content, Geometry, Vertex, World, WorldHit};
use arrayvec::ArrayVec;
use juggler_bvh::{Leaf, PACKET};
use juggler_material::TexturedPoint;
use juggler_material::medium::{InteriorId, Interiors};
use juggler_math::{Ray, Rgb};
use std::cell::Cell;
use std::ops::Range;

/// How surfaces attenuate a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowMode {
    /// Transparent materials filter the ray, which continues straight on (classic ray tracing).
    Filtered,
    /// Only opacity below 1 and media attenuate the ray; every other surface blocks it.
    Physical,
}

/// Maximum number of transparent surfaces that a classic shadow ray crosses before it counts as
/// blocked.
const MAX_FILTERS: u32 = 64;

/// Maximum number of consecutive surfaces that a ray may cross because of their opacity, or because
/// a solid of higher priority hides them.
pub const MAX_PASS_THROUGHS: u16 = 1000;

/// Maximum number of surfaces at one place that filter a shadow ray.
const MAX_PLACE: usize = 16;

/// Up to this number of active rays of a packet traverse an instance one by one.
const MAX_SINGLE_RAYS: u32 = 2;

/// Leaf visitor that keeps the nearest hit of each ray.
struct Nearest<'a> {
    geometry: &'a Geometry,
    /// Index of the geometry's first shape.
    first: u32,
    hits: &'a mut [WorldHit],
}

impl Nearest<'_> {
    /// Intersects each ray with all items.
    #[inline]
    fn closest_each(&mut self, rays: &mut [Ray]) {
        for (ray, hit) in rays.iter_mut().zip(&mut *self.hits) {
            for item in &self.geometry.items {
                item.closest(&self.geometry.objects, ray, self.first, hit);
            }
        }
    }

    /// Tests each ray against all items.
    #[inline]
    fn any_each(&self, rays: &[Ray], occluded: &mut [bool]) {
        let Geometry { items, objects, .. } = self.geometry;
        for (ray, occluded) in rays.iter().zip(occluded) {
            *occluded = items.iter().any(|item| item.occludes(objects, ray));
        }
    }
}

impl Leaf for Nearest<'_> {
    #[inline]
    fn closest(&mut self, lane: usize, ray: &mut Ray, range: Range<u32>) {
        for item in &self.geometry.items[range.start as usize..range.end as usize] {
            item.closest(&self.geometry.objects, ray, self.first, &mut self.hits[lane]);
        }
    }

    #[inline(always)]
    fn any(&mut self, _lane: usize, ray: &Ray, range: Range<u32>) -> bool {
        // A loop is inlined where `Iterator::any` is not.
        for item in &self.geometry.items[range.start as usize..range.end as usize] {
            if item.occludes(&self.geometry.objects, ray) {
                return true;
            }
        }
        false
    }

    #[inline]
    fn closest_many(&mut self, first: usize, active: u32, rays: &mut [Ray], range: Range<u32>) -> bool {
        let geometry = self.geometry;
        for item in &geometry.items[range.start as usize..range.end as usize] {
            match *item {
                LeafItem::Geometry { object_index, shape_index } if active.count_ones() > MAX_SINGLE_RAYS => {
                    let hits = &mut self.hits[first..first + rays.len()];
                    intersect_packet(
                        &geometry.objects[object_index as usize],
                        self.first + shape_index,
                        active,
                        rays,
                        hits,
                    );
                }
                _ => {
                    for lane in lanes(active) {
                        item.closest(&geometry.objects, &mut rays[lane], self.first, &mut self.hits[first + lane]);
                    }
                }
            }
        }
        true
    }

    #[inline]
    fn any_many(&mut self, _first: usize, active: u32, rays: &[Ray], range: Range<u32>) -> u32 {
        let (geometry, mut found) = (self.geometry, 0);
        for item in &geometry.items[range.start as usize..range.end as usize] {
            let active = active & !found;
            match *item {
                LeafItem::Geometry { object_index, .. } if active.count_ones() > MAX_SINGLE_RAYS => {
                    found |= occludes_packet(&geometry.objects[object_index as usize], active, rays);
                }
                _ => {
                    for lane in lanes(active) {
                        found |= u32::from(item.occludes(&geometry.objects, &rays[lane])) << lane;
                    }
                }
            }
        }
        found
    }
}

/// Indices of the set bits.
#[inline]
fn lanes(active: u32) -> impl Iterator<Item = usize> {
    (0..PACKET).filter(move |lane| active >> lane & 1 != 0)
}

/// Intersects the active rays of a packet with an instance, as one smaller packet.
#[inline(never)]
fn intersect_packet(instance: &Instance, shape_index: u32, active: u32, rays: &mut [Ray], hits: &mut [WorldHit]) {
    let Content::Geometry(geometry) = &instance.content else { return };
    let mut local: ArrayVec<Ray, PACKET> = lanes(active).map(|lane| instance.ray_to_object(&rays[lane])).collect();
    let mut best: ArrayVec<WorldHit, PACKET> = lanes(active).map(|lane| hits[lane]).collect();
    geometry.intersect_rays(&mut local, RayCoherence::Coherent, shape_index, &mut best);
    for (lane, (local, best)) in lanes(active).zip(local.iter().zip(best)) {
        (rays[lane].t_max, hits[lane]) = (local.t_max, best);
    }
}

/// Occlusion of the active rays of a packet by an instance, as a bit mask.
#[inline(never)]
fn occludes_packet(instance: &Instance, active: u32, rays: &[Ray]) -> u32 {
    let Content::Geometry(geometry) = &instance.content else { return 0 };
    let local: ArrayVec<Ray, PACKET> = lanes(active).map(|lane| instance.ray_to_object(&rays[lane])).collect();
    let mut occluded = [false; PACKET];
    geometry.occludes_rays(&local, RayCoherence::Coherent, &mut occluded[..local.len()]);
    lanes(active).zip(occluded).fold(0, |found, (lane, occluded)| found | u32::from(occluded) << lane)
}

impl Geometry {
    /// Replaces `hits` by nearer ones. `first` is the index of this geometry's first shape.
    #[inline]
    pub(super) fn intersect_rays(&self, rays: &mut [Ray], coherence: RayCoherence, first: u32, hits: &mut [WorldHit]) {
        for object_index in &self.unbounded {
            let (instance, shape_index) =
                (&self.objects[*object_index as usize], first + self.first_shape(*object_index));
            instance.closest_each(rays, shape_index, hits);
        }
        let mut nearest = Nearest { geometry: self, first, hits };
        match coherence {
            // A hierarchy costs each ray more than a hundred instructions, even if it is empty.
            _ if self.has_few_spheres => nearest.closest_each(rays),
            RayCoherence::Coherent => self.bvh.closest_packet(rays, &mut nearest),
            RayCoherence::Incoherent => self.bvh.closest_batch(rays, &mut nearest),
        }
        for large_mesh in &self.large_meshes {
            large_mesh.intersect_rays(&self.objects, rays, coherence, hits);
        }
        if let Some(merged_meshes) = &self.merged_meshes {
            merged_meshes.intersect_rays(rays, coherence, hits);
        }
    }

    /// Tests each ray for occlusion.
    #[inline]
    fn occludes_rays(&self, rays: &[Ray], coherence: RayCoherence, occluded: &mut [bool]) {
        let mut nearest = Nearest { geometry: self, first: 0, hits: &mut [] };
        match coherence {
            _ if self.has_few_spheres => nearest.any_each(rays, occluded),
            RayCoherence::Coherent => self.bvh.any_packet(rays, occluded, &mut nearest),
            RayCoherence::Incoherent => self.bvh.any_batch(rays, occluded, &mut nearest),
        }
        for object_index in &self.unbounded {
            let instance = &self.objects[*object_index as usize];
            for (ray, occluded) in rays.iter().zip(&mut *occluded) {
                *occluded = *occluded || instance.occludes(ray);
            }
        }
        for large_mesh in &self.large_meshes {
            large_mesh.occludes_rays(&self.objects, rays, coherence, occluded);
        }
        if let Some(merged_meshes) = &self.merged_meshes {
            merged_meshes.occludes_rays(rays, coherence, occluded);
        }
    }

    /// Tests one ray for occlusion.
    #[inline(never)]
    pub(super) fn occludes(&self, ray: &Ray) -> bool {
        let mut occluded = [false];
        self.occludes_rays(std::slice::from_ref(ray), RayCoherence::Incoherent, &mut occluded);
        occluded[0]
    }
}

impl World {
    /// Finds the nearest hits of coherent rays, in any number.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.intersect_rays(rays, RayCoherence::Coherent, 0, hits);
    }

    /// Finds the nearest hits of incoherent rays, in any number.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.intersect_rays(rays, RayCoherence::Incoherent, 0, hits);
    }

    /// Finds the nearest hit of one ray and shortens the ray to it.
    pub fn closest(&self, ray: &mut Ray) -> WorldHit {
        let mut hit = WorldHit::NONE;
        self.top.closest(ray, 0, &mut hit);
        hit
    }

    /// Computes the transmittance of coherent shadow rays, in any number.
    pub fn transmittance_packet(&self, rays: &[Ray], mode: ShadowMode, transmittance: &mut [Rgb]) {
        self.transmittance(rays, mode, transmittance, RayCoherence::Coherent);
    }

    /// Computes the transmittance of incoherent shadow rays, in any number.
    pub fn transmittance_batch(&self, rays: &[Ray], mode: ShadowMode, transmittance: &mut [Rgb]) {
        self.transmittance(rays, mode, transmittance, RayCoherence::Incoherent);
    }

    fn transmittance(&self, rays: &[Ray], mode: ShadowMode, transmittance: &mut [Rgb], coherence: RayCoherence) {
        if mode == ShadowMode::Filtered && self.has_transparency {
            for (ray, transmittance) in rays.iter().zip(transmittance) {
                *transmittance = self.classic_transmittance(*ray);
            }
            return;
        }
        let mut occluded = vec![false; rays.len()];
        self.top.occludes_rays(rays, coherence, &mut occluded);
        for ((occluded, transmittance), ray) in occluded.iter().zip(transmittance).zip(rays) {
            *transmittance = match (*occluded, self.has_absence) {
                (false, _) => Rgb::WHITE,
                (true, false) => Rgb::BLACK,
                (true, true) => self.visibility(*ray),
            };
        }
    }

    /// Visibility along a ray: 1 if all surfaces on it are absent for shadow rays, else 0.
    fn visibility(&self, ray: Ray) -> Rgb {
        let filter = |vertex: &Vertex| Rgb::splat(f32::from(self.is_absent(vertex, -ray.direction)));
        self.transmittance_through(ray, MAX_PASS_THROUGHS.into(), filter)
    }

    /// Whether opacity or media may attenuate shadow rays, so that [`World::transmittance_inside`]
    /// must evaluate them.
    pub fn attenuates_shadows(&self) -> bool {
        self.has_opacity || self.has_media
    }

    /// Computes the transmittance of shadow rays through opacity and media. `inside` yields the
    /// solids in which each ray starts.
    pub fn transmittance_inside(
        &self,
        rays: &[Ray],
        inside: impl Iterator<Item = Interiors>,
        transmittance: &mut [Rgb],
    ) {
        // Most surfaces of a model may be one-sided, while most shadow rays hit none of them: a test
        // of occlusion decides those rays.
        let mut occluded = vec![!self.has_absence || self.has_media; rays.len()];
        if self.has_absence && !self.has_media {
            self.top.occludes_rays(rays, RayCoherence::Incoherent, &mut occluded);
        }
        for (((ray, inside), transmittance), occluded) in rays.iter().zip(inside).zip(transmittance).zip(occluded) {
            *transmittance = if occluded { self.physical_transmittance(*ray, inside) } else { Rgb::WHITE };
        }
    }

    /// Product of the transparencies of all surfaces along the ray, nearest first.
    fn classic_transmittance(&self, ray: Ray) -> Rgb {
        let filter = |vertex: &Vertex| {
            let mesh = self.mesh_point(vertex);
            let at = TexturedPoint { surface: &vertex.surface, mesh: mesh.as_ref() };
            self.materials.shadow_transmittance(vertex.material, at, -ray.direction)
        };
        self.transmittance_through(ray, MAX_FILTERS - 1, filter)
    }

    /// Transmittance through opacity and media.
    fn physical_transmittance(&self, ray: Ray, inside: Interiors) -> Rgb {
        let inside = Cell::new(inside);
        let interiors = self.materials.interiors();
        let medium_transmittance = |distance: f32| match inside.get().top(interiors) {
            Some(interior) => interior.medium.transmittance(distance),
            None => Rgb::WHITE,
        };
        let transparency = |place: &[Vertex]| {
            let (transmittance, behind) = self.straight_transmittance(&ray, inside.get(), place);
            inside.set(behind);
            Rgb::splat(transmittance)
        };
        self.transmittance_along(ray, MAX_PASS_THROUGHS.into(), medium_transmittance, transparency)
    }

    /// Share of light that passes straight through the surfaces at one place, and the solids behind
    /// them. The interfaces of several solids act as one: they block no light if the medium before
    /// them is the medium behind them.
    fn straight_transmittance(&self, ray: &Ray, inside: Interiors, place: &[Vertex]) -> (f32, Interiors) {
        let table = self.materials.interiors();
        let of_surface = |vertex: &Vertex| {
            let mesh = self.mesh_point(vertex);
            let at = TexturedPoint { surface: &vertex.surface, mesh: mesh.as_ref() };
            self.materials.straight_transmittance(vertex.material, at, -ray.direction)
        };
        let (mut behind, mut transmittance) = (inside, 1.0);
        let mut interfaces: ArrayVec<(&Vertex, InteriorId, bool), MAX_PLACE> = ArrayVec::new();
        for vertex in place {
            let inwards = vertex.surface.normal.dot(ray.direction) < 0.0;
            match self.interior(vertex) {
                Some(id) => {
                    behind = behind.crossed(id, inwards);
                    _ = interfaces.try_push((vertex, id, inwards));
                }
                None => transmittance *= of_surface(vertex),
            }
        }
        let is_hidden = match interfaces.as_slice() {
            [(_, id, inwards)] => inside.hides_interface(*id, *inwards, table),
            _ => inside.top_id(table) == behind.top_id(table),
        };
        if transmittance > 0.0 && !is_hidden {
            transmittance *= interfaces.iter().map(|(vertex, ..)| of_surface(vertex)).product::<f32>();
            // Radiance over n² stays the same.
            let [before, after] = [inside, behind].map(|solids| self.ior_in(solids, None));
            transmittance *= (before / after) * (before / after);
        }
        (transmittance, behind)
    }

    /// Transmittance along a ray: the product of `filter` for each surface.
    fn transmittance_through(&self, ray: Ray, max_surfaces: u32, filter: impl Fn(&Vertex) -> Rgb) -> Rgb {
        let all = |place: &[Vertex]| place.iter().fold(Rgb::WHITE, |product, vertex| product * filter(vertex));
        self.transmittance_along(ray, max_surfaces, |_| Rgb::WHITE, all)
    }

    /// Transmittance along a ray: the product of `segment` for the length of each segment
    /// and of `filter` for the surfaces at each place. The ray is blocked after `max_places` places.
    fn transmittance_along(
        &self,
        ray: Ray,
        max_places: u32,
        segment: impl Fn(f32) -> Rgb,
        filter: impl Fn(&[Vertex]) -> Rgb,
    ) -> Rgb {
        let (mut rest, mut transmittance) = (ray, Rgb::WHITE);
        for _ in 0..=max_places {
            let start = rest.t_min;
            let hit = self.closest(&mut rest);
            transmittance *= segment(rest.t_max - start);
            if !hit.is_some() {
                return transmittance;
            }
            let first = self.vertex(&rest, &hit);
            if self.may_be_open(&first) && !self.may_pass_along(&rest, &first) {
                return Rgb::BLACK;
            }
            let mut cluster = Cluster::new(self, &rest, &first).up_to(ray.t_max);
            let mut place: ArrayVec<Vertex, MAX_PLACE> = ArrayVec::new();
            place.push(first);
            place.extend(cluster.by_ref().map(|member| member.vertex).take(MAX_PLACE - 1));
            // Skip a surface that the ray leaves, beside the one that it starts from.
            let error = self.place_error(&first, place.iter().copied());
            place.retain(|vertex| !self.is_left(&ray, vertex, error));
            transmittance *= filter(&place);
            if transmittance.is_black() {
                return transmittance;
            }
            rest = cluster.ray_behind().with_t_max(ray.t_max);
            if rest.t_min > rest.t_max {
                return transmittance;
            }
        }
        Rgb::BLACK
    }
}
