//! Passage of a path through surfaces at one place: nested dielectrics by priority (Schmidt and
//! Budge 2002), opacity, and surfaces that touch.
//!
//! Surfaces that a path passes straight through keep its ray, so that no surface at the same place
//! is lost. Of the others, an opaque surface ends the passage. A path meets a sheet that transmits
//! light, such as a pane, before the solids at its place. Interfaces of solids at one place act
//! as one interface, between the medium before all of them and the medium behind all of them. The
//! order in which surfaces are listed therefore does not matter.

use super::super::{CausticState, PathHistory, PathState, VertexOutput};
use super::{Dimension, Path};
use arrayvec::ArrayVec;
use juggler_material::medium::{Interior, InteriorId, Interiors};
use juggler_math::Ray;
use juggler_world::{Cluster, MAX_PASS_THROUGHS, Member, Vertex, World};

/// Maximum number of interfaces at one place.
const MAX_INTERFACES: usize = 8;

/// Boundary between media at a vertex.
#[derive(Clone, Copy, Debug)]
pub struct Interface {
    /// Interior of the solid that the vertex bounds; `None` on a surface that transmits no light.
    pub interior: Option<InteriorId>,
    /// Whether the surface is known to exist for the path, so that opacity no longer decides.
    pub is_present: bool,
    /// Whether the surface is a sheet with others at its place. Light passes the sheet first, so
    /// rays that it transmits start before the others.
    pub has_others_behind: bool,
    /// Medium on the other side and solids behind, if other interfaces are at the same place.
    net: Option<NetInterface>,
}

/// Several interfaces at one place.
#[derive(Clone, Copy, Debug)]
struct NetInterface {
    /// Interior of the medium that is outside of the solid that the vertex bounds.
    exterior: Option<InteriorId>,
    /// Solids that contain the path behind all interfaces.
    behind: Interiors,
}

/// Interfaces at one place, each with the interior of its solid and whether opacity removes it.
type Interfaces = ArrayVec<(Member, InteriorId, bool), MAX_INTERFACES>;

/// Result of following the interfaces at one place.
enum Passage {
    /// The path interacts with the surface.
    Surface(Member, Interface),
    /// The path passes straight through all interfaces, into these solids.
    Straight(Interiors),
}

impl Interface {
    /// Surface that transmits no light.
    pub const OPAQUE: Self = Self { interior: None, is_present: false, has_others_behind: false, net: None };

    /// Interface at a vertex that is known to be the only surface at its place; `None` if other
    /// surfaces or opacity may matter, or if a solid hides the interface.
    #[inline]
    pub fn alone(world: &World, ray: &Ray, path: &PathState, vertex: &Vertex) -> Option<Self> {
        let is_alone = !world.may_be_open(vertex) && world.is_alone(ray, vertex);
        let inwards = vertex.surface.normal.dot(ray.direction) < 0.0;
        if is_alone { lone_interface(world, path, vertex, inwards) } else { None }
    }

    /// Index of refraction of the medium outside of the solid that the path hit. Where the path has a
    /// wavelength, the index is relative to a solid of its index at 587.56 nm.
    #[inline(always)]
    pub fn exterior_ior(&self, world: &World, path: &PathState) -> f32 {
        let PathHistory { interiors: inside, wavelength, .. } = path.history;
        if inside.is_empty() && wavelength.is_none() && self.net.is_none() {
            return 1.0;
        }
        self.exterior_ior_inside(world, path)
    }

    /// [`Interface::exterior_ior`] inside of solids. Kept out of line, since most paths are outside.
    #[inline(never)]
    fn exterior_ior_inside(&self, world: &World, path: &PathState) -> f32 {
        let PathHistory { interiors: inside, wavelength, .. } = path.history;
        let interiors = world.interiors();
        let exterior: Option<&Interior> = match self.net {
            Some(net) => net.exterior.and_then(|id| world.interior_at(id)),
            None => self.interior.map_or(inside, |id| inside.exited(id)).top(interiors),
        };
        let exterior = exterior.map_or(1.0, |interior| interior.ior_at(wavelength));
        let solid = self.interior.and_then(|id| world.interior_at(id)).filter(|_| wavelength.is_some());
        solid.map_or(exterior, |solid| exterior * (solid.ior / solid.ior_at(wavelength)))
    }

    /// Solids that contain the path behind the surface, which it crosses inwards or outwards.
    pub fn interiors_behind(&self, path: &PathState, inwards: bool) -> Interiors {
        match self.net {
            Some(net) => net.behind,
            None => crossed(path.history.interiors, self.interior, inwards),
        }
    }
}

/// Solids that contain a path after it crosses the interface of one, inwards or outwards.
fn crossed(inside: Interiors, interior: Option<InteriorId>, inwards: bool) -> Interiors {
    interior.map_or(inside, |id| inside.crossed(id, inwards))
}

/// Radiance before surfaces that a path passes straight through over the radiance behind them: an
/// opening in glass and fog within glass do not refract, but radiance over n² stays the same.
fn radiance_ratio(world: &World, before: &PathState, behind: &PathState) -> f32 {
    let [a, b] = [before, behind].map(|path| world.ior_in(path.history.interiors, path.history.wavelength));
    (a / b) * (a / b)
}

/// State of a path that passes straight through a surface, into the solids `interiors`; `None` after
/// too many surfaces. Shadow rays through specular spheres pass only surfaces that are absent for
/// them, so only those keep the state of the path through a sphere.
pub fn passed(
    world: &World,
    ray: &Ray,
    path: &PathState,
    vertex: &Vertex,
    interiors: Option<Interiors>,
) -> Option<PathState> {
    if path.history.pass_throughs >= MAX_PASS_THROUGHS {
        return None;
    }
    let inwards = vertex.surface.normal.dot(ray.direction) < 0.0;
    let is_absent = world.is_absent(vertex, -ray.direction);
    let history = PathHistory {
        pass_throughs: path.history.pass_throughs + 1,
        interiors: interiors.unwrap_or_else(|| crossed(path.history.interiors, world.interior(vertex), inwards)),
        caustic: if is_absent { path.history.caustic } else { CausticState::NONE },
        ..path.history
    };
    Some(PathState { sampler: path.sampler.branch(0), history, ..*path })
}

impl Path {
    /// Follows the path through all surfaces at the place of `vertex`, to the first one that it
    /// interacts with or straight on.
    #[inline(never)]
    pub fn cross_surfaces(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        output: &mut VertexOutput,
    ) {
        let mut cluster = Cluster::new(world, ray, vertex);
        let mut member = Member { vertex: *vertex, t: ray.t_max };
        let mut path = PathState { beta: output.beta(), ..*path };
        let error = world.place_error(vertex, cluster.clone().map(|member| member.vertex));
        loop {
            let ray = ray.with_t_max(member.t);
            let mut here = output.at(&path);
            // Skip a surface that the ray leaves, beside the one that it starts from.
            let passage = if world.is_left(&ray, &member.vertex, error) {
                Passage::Straight(path.history.interiors)
            } else {
                let is_left = |vertex: &Vertex| world.is_left(&ray, vertex, error);
                self.interface(world, &ray, &path, member, &mut cluster, is_left)
            };
            let (vertex, interiors, history) = match passage {
                Passage::Straight(interiors) => (member.vertex, Some(interiors), path.history),
                Passage::Surface(Member { vertex, t }, interface) => {
                    let ray = ray.with_t_max(t);
                    match self.interact(world, &ray, &path, &vertex, &interface, &mut here) {
                        Some(history) => (vertex, None, history),
                        None => return,
                    }
                }
            };
            let state = PathState { beta: here.beta(), history, ..path };
            match passed(world, &ray, &state, &vertex, interiors) {
                Some(next) => path = PathState { beta: next.beta * radiance_ratio(world, &path, &next), ..next },
                None => return,
            }
            match cluster.next() {
                Some(next) => member = next,
                None => return output.continue_straight(cluster.ray_behind(), &path),
            }
        }
    }

    /// Determines the surface of all those at the place of `member` that the path interacts with.
    /// `is_left` holds for a surface at the place that the ray leaves.
    #[inline]
    fn interface(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        member: Member,
        cluster: &mut Cluster,
        is_left: impl Fn(&Vertex) -> bool,
    ) -> Passage {
        if world.interior(&member.vertex).is_none() {
            return without_solid(world, path, member, cluster);
        }
        let mut sampler = path.sampler;
        let mut is_open = |vertex: &Vertex| {
            let choice = || {
                let choice = sampler.skipped(Dimension::Choice as u32).next_2d();
                sampler = sampler.branch(0);
                choice
            };
            world.is_open(vertex, -ray.direction, path.history.events.is_only_specular(), choice)
        };
        // Collect all interfaces up to an opaque surface.
        let (mut interfaces, mut behind) = (Interfaces::new(), path.history.interiors);
        let mut next = Some(member);
        while let Some(other) = next {
            let (interior, is_open) = (world.interior(&other.vertex), is_open(&other.vertex));
            if let Some(id) = interior {
                behind = behind.crossed(id, other.is_entered(ray));
                _ = interfaces.try_push((other, id, is_open));
            } else if !is_open && !is_left(&other.vertex) {
                let others = interfaces.into_iter().map(|(member, ..)| member).chain(cluster);
                let has_others_behind = world.is_sheet(&other.vertex);
                let interface = Interface { is_present: true, has_others_behind, ..Interface::OPAQUE };
                return Passage::Surface(grown(other, others), interface);
            }
            next = cluster.next();
        }
        match interfaces.as_slice() {
            [(member, _, false)] => {
                let (vertex, inwards) = (&member.vertex, member.is_entered(ray));
                let straight = || crossed(path.history.interiors, world.interior(vertex), inwards);
                let interface = lone_interface(world, path, vertex, inwards);
                interface
                    .map_or_else(|| Passage::Straight(straight()), |interface| Passage::Surface(*member, interface))
            }
            _ => net_interface(world, ray, path, &interfaces, behind),
        }
    }
}

/// Passage to a surface that bounds no solid.
fn without_solid(world: &World, path: &PathState, member: Member, cluster: &Cluster) -> Passage {
    // Rays that leave an opaque surface inside a medium start before the interfaces at its place.
    let is_sheet = world.is_sheet(&member.vertex);
    let touching = (is_sheet || !path.history.interiors.is_empty()).then(|| cluster.clone());
    let mut others = touching.into_iter().flatten().peekable();
    let has_others_behind = is_sheet && others.peek().is_some();
    Passage::Surface(grown(member, others), Interface { has_others_behind, ..Interface::OPAQUE })
}

/// Interface without others at its place; `None` if a solid of higher priority hides it.
#[inline]
fn lone_interface(world: &World, path: &PathState, vertex: &Vertex, inwards: bool) -> Option<Interface> {
    let interior = world.interior(vertex);
    let is_hidden = |id| path.history.interiors.hides_interface(id, inwards, world.interiors());
    (!interior.is_some_and(is_hidden)).then_some(Interface { interior, is_present: true, ..Interface::OPAQUE })
}

/// Interface between the medium before several interfaces and the medium behind them: that of the
/// solid that the path enters, or of the one that it leaves. Opacity may remove the surface, but
/// not the medium behind it.
fn net_interface(world: &World, ray: &Ray, path: &PathState, interfaces: &Interfaces, behind: Interiors) -> Passage {
    let table = world.interiors();
    let (from, to) = (path.history.interiors.top_id(table), behind.top_id(table));
    if from == to {
        return Passage::Straight(behind);
    }
    let find = |id: Option<InteriorId>, inwards: bool| {
        let is_found = |other: &Member, of: InteriorId| other.is_entered(ray) == inwards && Some(of) == id;
        let found = interfaces.iter().find(|(other, of, is_open)| !is_open && is_found(other, *of));
        found.map(|(other, ..)| other)
    };
    let (chosen, interior, exterior) = match (find(to, true), find(from, false)) {
        (Some(entered), _) => (entered, to, from),
        (None, Some(left)) => (left, from, to),
        (None, None) => return Passage::Straight(behind),
    };
    let net = Some(NetInterface { exterior, behind });
    Passage::Surface(
        grown(*chosen, interfaces.iter().map(|(member, ..)| *member)),
        Interface { interior, is_present: true, net, ..Interface::OPAQUE },
    )
}

/// The surface with an error that reaches beyond all others at its place, so that rays that leave it
/// start before or behind all of them.
fn grown(member: Member, others: impl Iterator<Item = Member>) -> Member {
    let mut grown = member;
    others.for_each(|other| grown.vertex.surface.grow_error(&member.vertex.surface, &other.vertex.surface));
    grown
}
