//! Triangle meshes, brute force, and checks of every kernel at every SIMD level.
use super::Random;
use juggler_bvh::{Quality, SimdLevel, TriangleBvh, TriangleHit, intersect_triangle, simd_levels};
use juggler_math::{Ray, Vec3, portable, vec3};

/// Number of rays of a test case: `small`, or the value of `JUGGLER_RAYS`.
pub fn rays_to_try(small: usize) -> usize {
    let requested = std::env::var("JUGGLER_RAYS").ok().and_then(|count| count.replace('_', "").parse().ok());
    requested.unwrap_or(small)
}

/// A triangle mesh: three vertex indices per triangle.
#[derive(Clone)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Constructs a mesh whose triangles share no vertices.
    pub fn from_triangles(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let positions: Vec<Vec3> = corners.into_iter().flatten().collect();
        let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Self { positions, triangles }
    }

    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    pub fn moved(&self, scale: Vec3, offset: Vec3) -> Self {
        let positions = self.positions.iter().map(|p| *p * scale + offset).collect();
        Self { positions, triangles: self.triangles.clone() }
    }

    /// Brute force: tests every triangle; among hits at equal distance the smallest index wins.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let hits = (0..self.triangles.len()).filter_map(|index| {
            let [a, b, c] = self.corners(index);
            let (t, u, v) = intersect_triangle(ray, a, b, c)?;
            Some(TriangleHit { t, u, v, index: index as u32 })
        });
        // Zeros of both signs are equal distances, so `total_cmp` would be wrong.
        hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
    }
}

/// A globe of `rows` × `columns` quads of two triangles each, with triangle fans at the poles. Each
/// vertex is displaced radially by up to half of `rough`. Closed: adjacent triangles share their
/// vertices.
pub fn globe(random: &mut Random, rows: u32, columns: u32, rough: f32) -> Mesh {
    let mut positions = vec![Vec3::Y, -Vec3::Y];
    for row in 1..rows {
        for column in 0..columns {
            let (sin, cos) = portable::sin_cos(std::f32::consts::PI * row as f32 / rows as f32);
            let (sin_around, cos_around) = portable::sin_cos(std::f32::consts::TAU * column as f32 / columns as f32);
            positions.push(vec3(sin * cos_around, cos, sin * sin_around) * (1.0 + rough * (random.unit() - 0.5)));
        }
    }
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)];
            triangles.extend([[a, b, c], [b, d, c]].into_iter().filter(|[a, b, c]| a != b && b != c && a != c));
        }
    }
    Mesh { positions, triangles }
}

/// Small triangles everywhere, crossed by long thin ones in random directions, which spatial splits
/// divide.
pub fn crossed(random: &mut Random, count: usize, long: usize) -> Mesh {
    Mesh::from_triangles((0..count).map(|i| {
        let (center, along) = (random.point(), random.point() * if i < long { 1.0 } else { 0.02 });
        [center - along, center + along, center + along + random.point() * 0.02]
    }))
}

/// Whether the best quality refers to triangles of the mesh from several leaves.
pub fn is_divided(mesh: &Mesh) -> bool {
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, Quality::Best).unwrap();
    tree.stats().references > tree.stats().items
}

/// A tree for every kernel at one SIMD level.
pub struct Kernels {
    name: String,
    tree: TriangleBvh,
    /// The same tree with rays in flight.
    in_flight: TriangleBvh,
}

type Bits = Option<[u32; 4]>;

fn bits(hit: Option<TriangleHit>) -> Bits {
    hit.map(|hit| [hit.index, hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits()])
}

impl Kernels {
    pub fn new(name: &str, tree: &TriangleBvh, level: SimdLevel) -> Self {
        let tree = tree.clone().with_simd_level(level).with_rays_in_flight(false);
        Self { name: format!("{name}, {level:?}"), in_flight: tree.clone().with_rays_in_flight(true), tree }
    }

    /// Trees for every quality and SIMD level.
    pub fn all(name: &str, mesh: &Mesh) -> Vec<Self> {
        let mut all = Vec::new();
        for quality in Quality::ALL {
            let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, quality).unwrap();
            let name = format!("{name}, {quality:?}");
            all.extend(simd_levels().into_iter().map(|level| Self::new(&name, &tree, level)));
        }
        all
    }

    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.tree.closest(ray)
    }

    /// Checks that every kernel finds the expected hits, bit for bit, and any hit wherever there is
    /// a closest one.
    pub fn check(&self, rays: &[Ray], expected: &[Option<TriangleHit>]) {
        let single: Vec<_> = rays.iter().map(|ray| self.tree.closest(ray)).collect();
        self.check_hits("single", rays, &single, expected);
        let any: Vec<_> = rays.iter().map(|ray| self.tree.any(ray)).collect();
        self.check_any("single", rays, &any, expected);
        type Closest = fn(&TriangleBvh, &mut [Ray], &mut [Option<TriangleHit>]);
        type Any = fn(&TriangleBvh, &[Ray], &mut [bool]);
        let kernels: [(&str, &TriangleBvh, Closest, Any); 3] = [
            ("batch", &self.tree, TriangleBvh::closest_batch, TriangleBvh::any_batch),
            ("in flight", &self.in_flight, TriangleBvh::closest_batch, TriangleBvh::any_batch),
            ("packet", &self.tree, TriangleBvh::closest_packet, TriangleBvh::any_packet),
        ];
        for (kernel, tree, closest, any) in kernels {
            // Prefill the arrays with wrong results, which must be overwritten.
            let (mut ends, mut hits) = (rays.to_vec(), vec![Some(WRONG); rays.len()]);
            closest(tree, &mut ends, &mut hits);
            self.check_hits(kernel, rays, &hits, expected);
            for (end, (ray, hit)) in ends.iter().zip(rays.iter().zip(&hits)) {
                let t_max = hit.map_or(ray.t_max, |hit| hit.t);
                assert_eq!(*end, ray.with_t_max(t_max), "{}, {kernel}: where a ray ends", self.name);
            }
            let mut occluded: Vec<bool> = expected.iter().map(Option::is_none).collect();
            any(tree, rays, &mut occluded);
            self.check_any(kernel, rays, &occluded, expected);
        }
    }

    fn check_hits(&self, kernel: &str, rays: &[Ray], found: &[Option<TriangleHit>], expected: &[Option<TriangleHit>]) {
        for (lane, (found, expected)) in found.iter().zip(expected).enumerate() {
            let same = bits(*found) == bits(*expected);
            let (name, count, ray) = (&self.name, rays.len(), &rays[lane]);
            assert!(same, "{name}, {kernel}, {lane} of {count}: {found:?} instead of {expected:?}: {ray:?}");
        }
    }

    fn check_any(&self, kernel: &str, rays: &[Ray], found: &[bool], expected: &[Option<TriangleHit>]) {
        for (lane, (found, expected)) in found.iter().zip(expected).enumerate() {
            let same = *found == expected.is_some();
            let (name, count, ray) = (&self.name, rays.len(), &rays[lane]);
            assert!(same, "{name}, any, {kernel}, {lane} of {count}: {found} instead of {expected:?}: {ray:?}");
        }
    }
}

const WRONG: TriangleHit = TriangleHit { t: -1.0, u: -1.0, v: -1.0, index: u32::MAX };
