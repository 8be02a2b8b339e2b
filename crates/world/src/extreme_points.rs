//! Extreme points of objects, for cameras that see all objects: the points that reach farthest in
//! directions spread over the sphere. Their convex hull is that of the objects, but for rounded
//! slivers of at most 3 % of the size.

use super::{Content, Object};
use juggler_math::{Aabb, BuildControl, Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Mesh};

/// Largest coordinate of the directions, which are all vectors of whole numbers without a common
/// factor.
const LARGEST: i8 = 2;
/// Number of directions; the opposite of each is another one.
const DIRECTIONS: usize = 98;
/// Number of vertices that are looked at together.
const BLOCK: usize = 256;
/// Maximum number of objects that are looked at one by one; of later ones, corners of boxes count.
const MAX_OBJECTS: u32 = 1 << 21;

/// The points of the bounded parts of `objects` that reach farthest in 98 directions; none if nothing
/// is bounded. The order of objects and vertices does not matter. Of parts that move, the corners of
/// their bounding box over the shutter interval count. The points are incomplete if `control` is
/// cancelled.
pub fn extreme_points(objects: &[Object], control: &BuildControl) -> Vec<Vec3> {
    let mut search = Search::new(control);
    for object in objects {
        search.add(&object.content, &object.motion, &Transform::IDENTITY, DirectionSet::ALL);
    }
    let found = search.farthest.iter().filter(|(reach, _)| *reach > f32::NEG_INFINITY);
    found.map(|(_, point)| *point).collect()
}

/// A set of the directions: one bit for the index of each.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DirectionSet(u128);

impl DirectionSet {
    const ALL: Self = Self((1 << DIRECTIONS) - 1);

    /// The indices in the set, in increasing order.
    fn indices(self) -> impl Iterator<Item = usize> {
        let first = Some(self.0).filter(|bits| *bits != 0);
        let rest = |bits: &u128| Some(bits & (bits - 1)).filter(|bits| *bits != 0);
        std::iter::successors(first, rest).map(|bits| bits.trailing_zeros() as usize)
    }

    /// The directions of the set whose index has a property.
    fn filter(self, has: impl Fn(usize) -> bool) -> Self {
        Self(self.indices().filter(|index| has(*index)).fold(0, |bits, index| bits | 1 << index))
    }
}

/// The farthest points found so far.
struct Search<'c> {
    control: &'c BuildControl,
    directions: [Vec3; DIRECTIONS],
    /// For each direction, the largest dot product with it and the point that has it.
    farthest: [(f32, Vec3); DIRECTIONS],
    /// Number of objects that may still be looked at.
    left: u32,
}

impl<'c> Search<'c> {
    fn new(control: &'c BuildControl) -> Self {
        let range = || -LARGEST..=LARGEST;
        let all = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
        // Twice a vector of ones and zeros has the same direction.
        let primitive = all.filter(|v| v.iter().any(|c| c % 2 != 0));
        let mut directions = [Vec3::ZERO; DIRECTIONS];
        for (own, [x, y, z]) in directions.iter_mut().zip(primitive) {
            *own = Vec3::new(x.into(), y.into(), z.into());
        }
        Self { control, directions, farthest: [(f32::NEG_INFINITY, Vec3::ZERO); DIRECTIONS], left: MAX_OBJECTS }
    }

    /// Adds a content that `motion` places in a space, which `outer` places in the world. Only the
    /// directions of `within` are looked at: the content is part of a box that extends no other. In a
    /// flat field all objects reach equally far down, and few directions are left of each.
    fn add(&mut self, content: &Content, motion: &Motion, outer: &Transform, within: DirectionSet) {
        let own = content.bounds(motion);
        let is_counted = self.left > 0;
        // Objects that cannot extend the hull count, too: there may be thousands of millions.
        self.left = self.left.saturating_sub(1);
        if self.control.is_cancelled() || own.is_empty() {
            return;
        }
        let within = self.extended_by(&outer.aabb(&own), within);
        if within == DirectionSet(0) {
            return;
        }
        let still = motion.still().filter(|_| is_counted);
        match (content, still) {
            (Content::Geometry(geometry), Some(still)) => {
                let outer = still.then(outer);
                geometry.objects.iter().for_each(|inner| self.add(&inner.content, &inner.motion, &outer, within));
            }
            (Content::Shape(shape), Some(still)) => self.add_shape(shape, &still.then(outer), within),
            (_, None) => self.add_block(&own.corners().map(|corner| outer.point(corner)), within),
        }
    }

    fn add_shape(&mut self, shape: &AnyShape, to_world: &Transform, within: DirectionSet) {
        match (shape.mesh().filter(|mesh| !mesh.moves()), shape.sphere()) {
            (Some(mesh), _) => self.add_mesh(mesh, to_world, within),
            (None, Some(sphere)) => {
                for index in within.indices() {
                    // The tangent plane of the ellipsoid with this normal touches it here. Squares of
                    // large and small scales are beyond single precision.
                    let local = (to_world.matrix().transpose() * self.directions[index]).as_dvec3();
                    let normal = local.normalize_or_zero().as_vec3();
                    self.keep_farther(index, to_world.point(normal * sphere.radius));
                }
            }
            _ => self.add_block(&shape.bounds().corners().map(|corner| to_world.point(corner)), within),
        }
    }

    fn add_mesh(&mut self, mesh: &Mesh, to_world: &Transform, within: DirectionSet) {
        let mut block = Vec::with_capacity(BLOCK);
        for vertices in mesh.arrays().positions.chunks(BLOCK) {
            if self.control.is_cancelled() {
                return;
            }
            block.clear();
            block.extend(vertices.iter().map(|vertex| to_world.point(*vertex)));
            self.add_block(&block, within);
        }
    }

    /// Adds points. Few blocks hold a farthest point, so that the largest dot product comes first.
    fn add_block(&mut self, block: &[Vec3], within: DirectionSet) {
        for index in within.indices() {
            let direction = self.directions[index];
            let most = block.iter().fold(f32::NEG_INFINITY, |most, point| most.max(direction.dot(*point)));
            if most >= self.farthest[index].0 {
                block.iter().for_each(|point| self.keep_farther(index, *point));
            }
        }
    }

    /// Keeps the point that is farther in a direction; of equally far points, the one whose
    /// coordinates come first, so that the order of points does not matter.
    fn keep_farther(&mut self, index: usize, point: Vec3) {
        let farthest = &mut self.farthest[index];
        let reach = self.directions[index].dot(point);
        let is_before = || point.to_array() < farthest.1.to_array();
        if reach > farthest.0 || (reach == farthest.0 && is_before()) {
            *farthest = (reach, point);
        }
    }

    /// The directions of `within` in which a part of a box reaches as far as the points found so far.
    fn extended_by(&self, bounds: &Aabb, within: DirectionSet) -> DirectionSet {
        let (center, half) = (bounds.center(), bounds.extent() * 0.5);
        let reach = |direction: Vec3| direction.dot(center) + direction.abs().dot(half);
        // Rounding must not hide a point of the box.
        let slack = 1e-5 * (center.abs().max_element() + half.max_element());
        within.filter(|index| reach(self.directions[index]) + slack >= self.farthest[index].0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Geometry;
    use juggler_material::MaterialId;
    use juggler_math::Mat3;
    use juggler_shape::{Plane, Sphere};
    use std::sync::Arc;

    fn sphere(radius: f32, motion: impl Into<Motion>) -> Object {
        Object::new(Sphere::new(radius).into(), motion, MaterialId::NONE)
    }

    fn mesh(positions: Vec<Vec3>) -> Object {
        let triangles: Vec<[u32; 3]> = (0..positions.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
        let mut shape = AnyShape::from(Mesh::from_triangles(positions, triangles));
        shape.prepare().unwrap();
        Object::new(shape, Transform::IDENTITY, MaterialId::NONE)
    }

    fn found(objects: &[Object]) -> Vec<Vec3> {
        extreme_points(objects, &BuildControl::default())
    }

    fn reach(points: &[Vec3], direction: Vec3) -> f32 {
        points.iter().map(|point| point.dot(direction)).fold(f32::NEG_INFINITY, f32::max)
    }

    #[test]
    fn there_are_98_directions_and_none_twice() {
        let directions = Search::new(&BuildControl::default()).directions.map(Vec3::normalize);
        assert!(directions.iter().all(|direction| direction.is_finite()));
        let is_same = |a: &Vec3, b: &Vec3| a.dot(*b) > 0.9999;
        assert!(directions.iter().all(|a| directions.iter().filter(|b| is_same(a, b)).count() == 1));
    }

    #[test]
    fn an_ellipsoid_is_reached_in_all_directions() {
        let matrix = Mat3::from_cols(Vec3::new(2.0, 0.5, 0.0), Vec3::new(0.0, 1.0, 0.3), Vec3::new(0.1, 0.0, 0.7));
        let to_world = Transform::new(matrix, Vec3::new(3.0, -1.0, 5.0)).unwrap();
        let points = found(&[sphere(1.5, to_world)]);
        for direction in [Vec3::X, Vec3::new(0.3, -0.8, 0.5), Vec3::new(-0.7, 0.1, 0.2)].map(Vec3::normalize) {
            let exact = direction.dot(to_world.origin()) + 1.5 * (matrix.transpose() * direction).length();
            let found = reach(&points, direction);
            assert!(found <= exact + 1e-5 && found > exact - 0.1, "{direction}: {found} {exact}");
        }
    }

    #[test]
    fn huge_and_tiny_spheres_have_their_size() {
        for scale in [1e-30, 1e30_f32] {
            let to_world = Transform::scale(Vec3::splat(scale)).unwrap();
            let points = found(&[sphere(1.0, to_world)]);
            assert!((reach(&points, Vec3::X) / scale - 1.0).abs() < 1e-5, "{scale}");
        }
    }

    #[test]
    fn the_order_of_objects_and_vertices_does_not_matter() {
        let grid = (0..1000).map(|i| Vec3::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32));
        let grid: Vec<Vec3> = grid.collect();
        let reversed: Vec<Vec3> = grid.iter().rev().copied().collect();
        let extra = || sphere(1.0, Transform::translation(Vec3::new(9.0, 9.0, 9.0)));
        let one = found(&[mesh(grid), extra()]);
        assert_eq!(one, found(&[extra(), mesh(reversed)]));
        // Corners of the grid, and the sphere around the last corner.
        assert_eq!((reach(&one, -Vec3::ONE), reach(&one, Vec3::X)), (0.0, 10.0));
    }

    #[test]
    fn instances_are_placed_and_planes_are_left_out() {
        let geometry =
            Arc::new(Geometry::new(vec![sphere(1.0, Transform::IDENTITY)], &BuildControl::default()).unwrap());
        let motion = Transform::translation(Vec3::new(10.0, 0.0, 0.0)).into();
        let content = Content::Geometry(geometry);
        let instance = Object { content, motion, material: None, attributes: None };
        let plane = Object::new(Plane {}.into(), Transform::IDENTITY, MaterialId::NONE);
        assert!(found(std::slice::from_ref(&plane)).is_empty());
        let points = found(&[plane, instance]);
        assert_eq!((reach(&points, Vec3::X), reach(&points, -Vec3::X)), (11.0, -9.0));
    }

    /// In a flat field, only the directions straight up and down are left of objects in the middle.
    #[test]
    fn ties_leave_few_directions() {
        let control = BuildControl::default();
        let mut search = Search::new(&control);
        let at = |x: u16, z: u16| Transform::translation(Vec3::new(x.into(), 0.0, z.into()));
        for (x, z) in (0..100).map(|i| (i % 10, i / 10)) {
            let object = sphere(0.5, at(x, z));
            search.add(&object.content, &object.motion, &Transform::IDENTITY, DirectionSet::ALL);
        }
        let left = search.extended_by(&sphere(0.5, at(4, 6)).bounds(), DirectionSet::ALL);
        let left: Vec<Vec3> = left.indices().map(|index| search.directions[index]).collect();
        assert_eq!(left, [-Vec3::Y, Vec3::Y]);
    }

    /// A group of one object hands the directions that it may extend down to the object.
    #[test]
    fn only_directions_that_are_handed_down_are_looked_at() {
        let control = BuildControl::default();
        let shape = |object| vec![object, mesh(vec![Vec3::ZERO, Vec3::X, Vec3::ONE])];
        let geometry = Geometry::new(shape(sphere(2.0, Transform::IDENTITY)), &control).unwrap();
        let content = Content::Geometry(Arc::new(geometry));
        let mut search = Search::new(&control);
        let up = search.directions.iter().position(|direction| *direction == Vec3::Y).unwrap();
        let only = DirectionSet::ALL.filter(|index| index == up);
        search.add(&content, &Transform::IDENTITY.into(), &Transform::IDENTITY, only);
        for (index, (reach, _)) in search.farthest.iter().enumerate() {
            assert_eq!(*reach, if index == up { 2.0 } else { f32::NEG_INFINITY }, "{index}");
        }
    }

    #[test]
    fn of_moving_objects_the_corners_of_the_whole_box_count() {
        let keys = [0.0, 4.0].map(|x| Transform::translation(Vec3::new(x, 0.0, 0.0)));
        let points = found(&[sphere(1.0, Motion::from_keys(keys.to_vec()).unwrap())]);
        for (direction, expected) in [(Vec3::X, 5.0), (-Vec3::X, 1.0), (Vec3::ONE, 7.0)] {
            assert!((reach(&points, direction) - expected).abs() < 1e-4, "{direction}: {}", reach(&points, direction));
        }
    }
}
