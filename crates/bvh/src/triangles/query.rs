//! Dispatch of queries to kernels, for all hits or filtered ones.

use super::filter::{Filter, FilterFn};
use super::packet_visitor::PacketVisitor;
use super::ray_visitor::RayVisitor;
use super::{TriangleBvh, TriangleHit};
use crate::lanes::Lanes;
use crate::node::Child;
use crate::packet::{GROUP, Group, PACKET};
use crate::single::{any_below, closest_below};
use crate::slabs::Slabs;
use crate::stack::Stack;
#[cfg(target_arch = "x86_64")]
use fearless_simd::Simd;
use fearless_simd::dispatch;
use juggler_math::Ray;

/// A tree with a hit filter.
#[derive(Clone, Copy)]
pub(super) struct Query<'a, F> {
    pub tree: &'a TriangleBvh,
    pub filter: F,
}

impl<F: Filter> Query<'_, F> {
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.closest_of(0, ray)
    }

    pub fn any(&self, ray: &Ray) -> bool {
        self.any_of(0, ray)
    }

    /// Closest hit of the ray with index `number`.
    fn closest_of(&self, number: usize, ray: &Ray) -> Option<TriangleHit> {
        #[cfg(target_arch = "x86_64")]
        {
            let level = self.tree.bvh.level;
            if let Some(simd) = level.as_avx512() {
                return simd.vectorize(
                    #[inline(always)]
                    || self.closest_one(simd, number, ray),
                );
            }
            if let Some(simd) = level.as_avx2() {
                return simd.vectorize(
                    #[inline(always)]
                    || self.closest_one(simd, number, ray),
                );
            }
        }
        self.closest_of_lesser(number, ray)
    }

    /// [`Query::closest_of`] at lower SIMD levels. Not inlined, or every ray would pay for its
    /// stack frame.
    #[inline(never)]
    fn closest_of_lesser(&self, number: usize, ray: &Ray) -> Option<TriangleHit> {
        dispatch!(self.tree.bvh.level, simd => self.closest_one(simd, number, ray))
    }

    /// Whether the ray with index `number` hits anything.
    fn any_of(&self, number: usize, ray: &Ray) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            let level = self.tree.bvh.level;
            if let Some(simd) = level.as_avx512() {
                return simd.vectorize(
                    #[inline(always)]
                    || self.any_one(simd, number, ray),
                );
            }
            if let Some(simd) = level.as_avx2() {
                return simd.vectorize(
                    #[inline(always)]
                    || self.any_one(simd, number, ray),
                );
            }
        }
        self.any_of_lesser(number, ray)
    }

    /// [`Query::any_of`] at lower SIMD levels, not inlined either.
    #[inline(never)]
    fn any_of_lesser(&self, number: usize, ray: &Ray) -> bool {
        dispatch!(self.tree.bvh.level, simd => self.any_one(simd, number, ray))
    }

    #[inline(always)]
    fn closest_one<S: Lanes>(&self, simd: S, number: usize, ray: &Ray) -> Option<TriangleHit> {
        let slabs = Slabs::of_ray(simd, ray);
        let mut ray_visitor = RayVisitor::new(simd, *self, ray, &slabs);
        closest_below(
            simd,
            self.tree.memory(),
            Child::ROOT,
            Stack::new().view(),
            (number, &mut { *ray }),
            slabs,
            &mut ray_visitor,
        );
        ray_visitor.hit
    }

    #[inline(always)]
    fn any_one<S: Lanes>(&self, simd: S, number: usize, ray: &Ray) -> bool {
        let slabs = Slabs::of_ray(simd, ray);
        let mut ray_visitor = RayVisitor::new(simd, *self, ray, &slabs);
        any_below(simd, self.tree.memory(), Child::ROOT, Stack::new().view(), (number, ray), &slabs, &mut ray_visitor)
    }

    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let count = rays.len().min(hits.len());
        dispatch!(self.tree.bvh.level, simd => self.closest_groups(simd, &mut rays[..count], &mut hits[..count]));
    }

    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        let count = rays.len().min(occluded.len());
        dispatch!(self.tree.bvh.level, simd => self.any_groups(simd, &rays[..count], &mut occluded[..count]));
    }

    #[inline(always)]
    fn closest_groups<S: Lanes>(&self, simd: S, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let mut stack = Stack::new();
        let mut group = Group::new();
        let mut packet_visitor = PacketVisitor::new(simd, *self);
        for (number, (rays, hits)) in rays.chunks_mut(GROUP).zip(hits.chunks_mut(GROUP)).enumerate() {
            let first = number * GROUP;
            if group.fill(simd, rays) && group.is_narrow(&self.tree.bvh.bounds) && packet_visitor.fill(first, &group) {
                self.tree.bvh.closest_group(
                    simd,
                    self.tree.memory(),
                    &mut stack,
                    (0, rays),
                    &mut group,
                    &mut packet_visitor,
                );
                packet_visitor.write_hits(rays, hits);
            } else {
                self.closest_each(simd, &mut stack, first, rays, hits);
            }
        }
    }

    /// Groups of 32 rays that are not coherent are tried as packets of eight, and then singly.
    #[inline(always)]
    fn any_groups<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool]) {
        let mut stack = Stack::new();
        let mut group = Group::new();
        let mut packet_visitor = PacketVisitor::new(simd, *self);
        for (number, (rays, occluded)) in rays.chunks(GROUP).zip(occluded.chunks_mut(GROUP)).enumerate() {
            let first = number * GROUP;
            let whole = group.fill(simd, rays) && packet_visitor.fill(first, &group);
            let size = if whole { GROUP } else { PACKET };
            for (number, (rays, occluded)) in rays.chunks(size).zip(occluded.chunks_mut(size)).enumerate() {
                let first = first + number * size;
                let together = whole || group.fill(simd, rays) && packet_visitor.fill(first, &group);
                if !together {
                    self.any_each(simd, &mut stack, first, rays, occluded);
                    continue;
                }
                let found = self.tree.bvh.any_group(
                    simd,
                    self.tree.memory(),
                    &mut stack,
                    (0, rays),
                    &group,
                    &mut packet_visitor,
                );
                for (lane, occluded) in occluded.iter_mut().enumerate() {
                    *occluded = found >> lane & 1 != 0;
                }
            }
        }
    }

    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let count = rays.len().min(hits.len());
        let (rays, hits) = (&mut rays[..count], &mut hits[..count]);
        if self.tree.in_flight {
            dispatch!(self.tree.bvh.level, simd => self.closest_in_flight(simd, rays, hits));
        } else {
            dispatch!(self.tree.bvh.level, simd => self.closest_each(simd, &mut Stack::new(), 0, rays, hits));
        }
    }

    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        let count = rays.len().min(occluded.len());
        let (rays, occluded) = (&rays[..count], &mut occluded[..count]);
        if self.tree.in_flight {
            dispatch!(self.tree.bvh.level, simd => self.any_in_flight(simd, rays, occluded));
        } else {
            dispatch!(self.tree.bvh.level, simd => self.any_each(simd, &mut Stack::new(), 0, rays, occluded));
        }
    }

    /// Traces rays one by one; `first` is the index of the first ray.
    #[inline(always)]
    fn closest_each<S: Lanes>(
        &self,
        simd: S,
        stack: &mut Stack,
        first: usize,
        rays: &mut [Ray],
        hits: &mut [Option<TriangleHit>],
    ) {
        for (number, (ray, hit)) in rays.iter_mut().zip(hits).enumerate() {
            let slabs = Slabs::of_ray(simd, ray);
            let mut ray_visitor = RayVisitor::new(simd, *self, ray, &slabs);
            let ray = (first + number, ray);
            closest_below(simd, self.tree.memory(), Child::ROOT, stack.view(), ray, slabs, &mut ray_visitor);
            *hit = ray_visitor.hit;
        }
    }

    /// [`Query::closest_each`] for any hit.
    #[inline(always)]
    fn any_each<S: Lanes>(&self, simd: S, stack: &mut Stack, first: usize, rays: &[Ray], occluded: &mut [bool]) {
        for (number, (ray, occluded)) in rays.iter().zip(occluded).enumerate() {
            let slabs = Slabs::of_ray(simd, ray);
            let mut ray_visitor = RayVisitor::new(simd, *self, ray, &slabs);
            let ray = (first + number, ray);
            *occluded = any_below(simd, self.tree.memory(), Child::ROOT, stack.view(), ray, &slabs, &mut ray_visitor);
        }
    }
}

/// A tree with a hit filter, from [`TriangleBvh::filtered`]. Offers the queries of the tree.
#[derive(Clone, Copy)]
pub struct Filtered<'a, F> {
    pub(super) query: Query<'a, FilterFn<F>>,
}

impl<F: Fn(usize, &TriangleHit) -> bool + Copy> Filtered<'_, F> {
    /// [`TriangleBvh::closest`].
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.query.closest(ray)
    }

    /// [`TriangleBvh::any`].
    pub fn any(&self, ray: &Ray) -> bool {
        self.query.any(ray)
    }

    /// [`TriangleBvh::closest_packet`].
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.query.closest_packet(rays, hits);
    }

    /// [`TriangleBvh::any_packet`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.query.any_packet(rays, occluded);
    }

    /// [`TriangleBvh::closest_batch`].
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.query.closest_batch(rays, hits);
    }

    /// [`TriangleBvh::any_batch`].
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.query.any_batch(rays, occluded);
    }
}
