//! Places where the order of objects decides what is seen, since nothing else does: surfaces of
//! unlike materials at one place, and overlapping solids of equal priority.

use super::emitters::Emitters;
use super::geometry::Geometry;
use super::{Cluster, Member, Object, Vertex, World};
use juggler_light::background::AnyBackground;
use juggler_material::MaterialTable;
use juggler_material::medium::InteriorId;
use juggler_math::{BuildControl, Cancelled, Ray, Rgb, Vec3};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Number of test rays along each edge of the bounding box.
const GRID: u32 = 24;
/// Maximum number of places along a test ray.
const MAX_PLACES: usize = 256;
/// Number of crowded places that end the search, which would take too long.
const MAX_CROWDED_PLACES: u32 = 8;
/// Smallest difference of color that counts.
const MIN_DIFFERENCE: f32 = 1e-3;

/// What the order of objects decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ambiguity {
    /// Which of two surfaces at one place is seen.
    Surfaces,
    /// Which of two overlapping solids fills the overlap.
    Solids,
}

/// Two scene entries, of which the first wins by its order alone.
pub type AmbiguousEntries = (Ambiguity, u32, u32);

/// Search for ambiguous entries.
#[derive(Default)]
struct Search {
    found: BTreeSet<AmbiguousEntries>,
    /// Number of places with many surfaces.
    crowded_places: u32,
}

impl World {
    /// Builds the hierarchy over the objects as [`World::new`] does, without light sampling: shapes
    /// that emit light are hit by rays and are no emitters. For programs that only trace rays.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn without_emitters(
        objects: Vec<Object>,
        materials: MaterialTable,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let top = Geometry::top_level(objects, control)?;
        let background = AnyBackground::from(Rgb::BLACK);
        let no_lights = (Vec::new(), Rgb::BLACK);
        Ok(Self::from_emitters(Arc::new(top), materials, no_lights, background, Emitters::default()))
    }

    /// Finds scene entries whose order decides what is seen. Test rays parallel to the axes, on a grid
    /// over the bounding box, follow solids up to the first opaque surface. Small contacts, and those
    /// inside closed rooms, may be missed, as may all after several places with many surfaces each.
    pub fn ambiguities(&self) -> BTreeSet<AmbiguousEntries> {
        let (bounds, mut search) = (self.bounds(), Search::default());
        if !bounds.is_finite() {
            return search.found;
        }
        for axis in 0..3 {
            let [across, along] = [(axis + 1) % 3, (axis + 2) % 3];
            for cell in 0..GRID * GRID {
                // Keep off the planes of symmetry on which scenes are built.
                let at = |i: u32, offset: f32| (i as f32 + offset) / GRID as f32;
                let reach = bounds.extent() + 1.0;
                for (start, direction) in [(bounds.min - reach, 1.0), (bounds.max + reach, -1.0)] {
                    let mut origin = start;
                    origin[across] = bounds.min[across] + bounds.extent()[across] * at(cell % GRID, 0.4367);
                    origin[along] = bounds.min[along] + bounds.extent()[along] * at(cell / GRID, 0.5719);
                    let ray = Ray { time: 0.5, ..Ray::new(origin, Vec3::AXES[axis] * direction) };
                    self.follow(&ray, &mut search);
                    if search.crowded_places >= MAX_CROWDED_PLACES {
                        return search.found;
                    }
                }
            }
        }
        search.found
    }

    /// Follows a ray straight on, to the first opaque surface.
    fn follow(&self, ray: &Ray, search: &mut Search) {
        let (mut rest, mut open) = (*ray, Vec::<(InteriorId, Vertex)>::new());
        for _ in 0..MAX_PLACES {
            let hit = self.closest(&mut rest);
            if !hit.is_some() {
                return;
            }
            let first = Member { vertex: self.vertex(&rest, &hit), t: rest.t_max };
            let mut cluster = Cluster::new(self, &rest, &first.vertex);
            let members: Vec<Member> = std::iter::once(first).chain(&mut cluster).collect();
            search.crowded_places += u32::from(cluster.is_crowded());
            if search.crowded_places >= MAX_CROWDED_PLACES {
                return;
            }
            self.compare_surfaces(&members, ray, &mut search.found);
            self.cross_solids(&members, ray, &mut open, &mut search.found);
            if members.iter().any(|member| !self.may_pass(&member.vertex)) {
                return;
            }
            rest = cluster.ray_behind();
        }
    }

    /// Compares the surfaces at one place that bound no transparent solid and are not absent. Where
    /// opaque solids stand on each other, their surfaces face each other and nobody sees them, so
    /// only surfaces that face the same side count.
    fn compare_surfaces(&self, members: &[Member], ray: &Ray, found: &mut BTreeSet<AmbiguousEntries>) {
        let wo = -ray.direction;
        let is_seen = |member: &&Member| {
            self.interior(&member.vertex).is_none()
                && !self.is_absent(&member.vertex, wo)
                && !self.is_cut_out(&member.vertex, wo, || 0.5)
        };
        let seen: Vec<&Member> = members.iter().filter(is_seen).collect();
        let has_two_sides = |member: &Member| self.may_be_open(&member.vertex) || self.is_sheet(&member.vertex);
        for (number, first) in seen.iter().enumerate() {
            for other in seen.iter().skip(number + 1) {
                let has_same_side =
                    other.is_entered(ray) == first.is_entered(ray) || has_two_sides(first) || has_two_sides(other);
                if has_same_side && self.look_unlike(&first.vertex, &other.vertex, wo) {
                    self.report(Ambiguity::Surfaces, &first.vertex, &other.vertex, found);
                }
            }
        }
    }

    fn look_unlike(&self, a: &Vertex, b: &Vertex, wo: Vec3) -> bool {
        let [a, b] = [a, b].map(|vertex| self.shade(vertex, wo, 1.0, 0.5));
        let difference = (a.albedo(wo) - b.albedo(wo)).map(f32::abs) + (a.emission - b.emission).map(f32::abs);
        difference.max_channel() > MIN_DIFFERENCE
    }

    /// Crosses the interfaces at one place, first those that the ray leaves, and compares the solids
    /// that it enters with those that it is in.
    fn cross_solids(
        &self,
        members: &[Member],
        ray: &Ray,
        open: &mut Vec<(InteriorId, Vertex)>,
        found: &mut BTreeSet<AmbiguousEntries>,
    ) {
        let crossed = |inwards: bool| {
            let is_crossed = move |member: &&Member| member.is_entered(ray) == inwards;
            members.iter().filter(is_crossed).filter_map(|member| Some((self.interior(&member.vertex)?, member.vertex)))
        };
        for (id, _) in crossed(false) {
            if let Some(at) = open.iter().rposition(|(one, _)| *one == id) {
                open.remove(at);
            }
        }
        for (id, vertex) in crossed(true) {
            for (other, around) in open.iter().filter(|(other, _)| self.fill_unlike(*other, id)) {
                let (first, second) = if *other < id { (around, &vertex) } else { (&vertex, around) };
                self.report(Ambiguity::Solids, first, second, found);
            }
            open.push((id, vertex));
        }
    }

    fn fill_unlike(&self, a: InteriorId, b: InteriorId) -> bool {
        let interiors = self.interior_at(a).zip(self.interior_at(b));
        interiors.is_some_and(|(a, b)| a != b && a.priority == b.priority)
    }

    fn report(&self, kind: Ambiguity, first: &Vertex, second: &Vertex, found: &mut BTreeSet<AmbiguousEntries>) {
        let [first, second] = [first, second].map(|vertex| self.entry_of(vertex.shape));
        if first != second {
            found.insert((kind, first, second));
        }
    }
}
