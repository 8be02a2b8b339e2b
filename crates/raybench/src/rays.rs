//! Six kinds of rays, from camera rays to incoherent ones. They depend on the mesh and its view
//! only; any tracer that finds the closest triangle gives the same rays.

use crate::{Mesh, View};
use juggler_bvh::TriangleBvh;
use juggler_math::{Frame, Ray, Vec2, Vec3, hash, portable, robust, vec3, warp};

/// Resolution of the camera's image in pixels.
const WIDTH: u32 = 1920;
const HEIGHT: u32 = 1080;
/// Edge length of a tile in pixels.
const TILE: u32 = 8;
/// Number of tiles of the image.
const TILES: u32 = (WIDTH / TILE) * (HEIGHT / TILE);

/// A query of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueryKind {
    /// The closest hit.
    Closest,
    /// Whether there is any hit.
    Any,
}

/// A kind of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Camera rays, one jittered ray per pixel, tile by tile: rays `8k` to `8k + 7` are a packet of
    /// 4 × 2 pixels.
    Primary,
    /// Shadow rays from the hits of the primary rays to the light.
    Shadow,
    /// Ambient occlusion rays from the same hits, cosine-distributed, up to a fifth of the median
    /// distance of the primary hits.
    Ao,
    /// Unbounded cosine-distributed rays from the same hits.
    Diffuse,
    /// Unbounded cosine-distributed rays from the hits of the diffuse rays.
    Diffuse2,
    /// The rays of `Diffuse2` in random order.
    Random,
}

impl Kind {
    /// All kinds, coherent ones first.
    pub const ALL: [Self; 6] = [Self::Primary, Self::Shadow, Self::Ao, Self::Diffuse, Self::Diffuse2, Self::Random];

    /// Name of the kind.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Ao => "ao",
            Self::Diffuse => "diffuse",
            Self::Diffuse2 => "diffuse2",
            Self::Random => "random",
        }
    }

    /// Query that the rays are traced with.
    pub fn query(self) -> QueryKind {
        match self {
            Self::Shadow | Self::Ao => QueryKind::Any,
            Self::Primary | Self::Diffuse | Self::Diffuse2 | Self::Random => QueryKind::Closest,
        }
    }
}

/// Rays of one kind, with unit directions.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// Kind of the rays.
    pub kind: Kind,
    /// The rays.
    pub rays: Vec<Ray>,
}

/// Generates all kinds of rays on a mesh, in the order of [`Kind::ALL`]: about `count` camera rays
/// (whole tiles, spread over the image, at most all of them), and of the other kinds one ray per
/// hit of the rays that they start from.
pub fn make(mesh: &Mesh, bvh: &TriangleBvh, count: usize) -> [RaySet; 6] {
    let primary = primary(&mesh.view, count);
    let hits = hits(mesh, bvh, &primary);
    let shadow = hits.iter().map(|hit| hit.shadow_ray(mesh.view.light)).collect();
    let reach = 0.2 * median_distance(&hits);
    let ao = scatter(&hits, 1).into_iter().map(|ray| ray.with_t_max(reach)).collect();
    let diffuse = scatter(&hits, 2);
    let diffuse2 = scatter(&self::hits(mesh, bvh, &diffuse), 3);
    let random = shuffled(diffuse2.clone());
    let mut sets = [primary, shadow, ao, diffuse, diffuse2, random].into_iter();
    Kind::ALL.map(|kind| RaySet { kind, rays: sets.next().unwrap_or_default() })
}

/// A random number in [0, 1) for each ray and purpose.
fn unit(purpose: u32, ray: usize) -> f32 {
    hash::unit_f32(hash::combine(purpose, ray as u32))
}

fn unit2(purpose: u32, ray: usize) -> Vec2 {
    Vec2::new(unit(purpose * 2, ray), unit(purpose * 2 + 1, ray))
}

/// Selects tiles that are spread evenly over the image, whatever their number, in image order:
/// multiples of the golden ratio, rounded to a step that is coprime to [`TILES`].
fn tiles(count: usize) -> Vec<u32> {
    const STEP: u64 = 20_023;
    let requested = count.div_ceil((TILE * TILE) as usize).clamp(1, TILES as usize) as u64;
    let mut tiles: Vec<u32> = (0..requested).map(|i| (i * STEP % u64::from(TILES)) as u32).collect();
    tiles.sort_unstable();
    tiles
}

fn primary(view: &View, count: usize) -> Vec<Ray> {
    let forward = (view.look_at - view.eye).normalize_or(-Vec3::Z);
    let right = forward.cross(view.up).normalize_or(Frame::around(forward).tangent);
    let up = right.cross(forward);
    let half = portable::tan(view.fov_degrees.to_radians() * 0.5);
    let ray = |[x, y]: [u32; 2]| {
        let jitter = unit2(10, (y * WIDTH + x) as usize);
        let across = (x as f32 + jitter.x) * 2.0 / HEIGHT as f32 - WIDTH as f32 / HEIGHT as f32;
        let above = 1.0 - (y as f32 + jitter.y) * 2.0 / HEIGHT as f32;
        Ray::new(view.eye, (forward + (right * across + up * above) * half).normalize())
    };
    tiles(count).into_iter().flat_map(|tile| (0..TILE * TILE).map(move |i| pixel(tile, i))).map(ray).collect()
}

/// Pixel `i` of a tile, in blocks of 4 × 2 pixels: two blocks side by side, four below each other.
fn pixel(tile: u32, i: u32) -> [u32; 2] {
    let across = WIDTH / TILE;
    let (block, within) = (i / 8, i % 8);
    [tile % across * TILE + block % 2 * 4 + within % 4, tile / across * TILE + block / 2 * 2 + within / 4]
}

/// A hit of a ray on the mesh.
struct Hit {
    /// Index of the ray.
    ray: usize,
    distance: f32,
    point: Vec3,
    /// Error bound of the point's coordinates, including that of a tracer's hit distance.
    error: f32,
    /// Unit geometric normal, toward the side that the ray came from.
    normal: Vec3,
}

fn hits(mesh: &Mesh, bvh: &TriangleBvh, rays: &[Ray]) -> Vec<Hit> {
    let hit = |(number, ray): (usize, &Ray)| {
        let hit = bvh.closest(ray)?;
        let [a, b, c] = mesh.triangles.get(hit.index as usize)?.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or(-ray.direction);
        let point = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        // The rounding errors here and in any triangle test scale with the largest coordinate and
        // the triangle's size.
        let largest = [a, b, c].map(|corner| corner.abs().max_element()).into_iter().fold(0.0, f32::max);
        let error = robust::gamma(16) * (largest + (b - a).length() + (c - a).length());
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        Some(Hit { ray: number, distance: hit.t, point, error, normal })
    };
    rays.iter().enumerate().filter_map(hit).collect()
}

impl Hit {
    fn spawn_ray(&self, direction: Vec3) -> Ray {
        Ray::new(robust::offset_origin(self.point, self.error, self.normal, direction), direction)
    }

    /// A shadow ray that ends just before `light`.
    fn shadow_ray(&self, light: Vec3) -> Ray {
        let ray = self.spawn_ray((light - self.point).normalize_or(self.normal));
        ray.with_t_max(light.distance(ray.origin) * 0.9999)
    }
}

/// Cosine-distributed rays from the hits, never quite parallel to the surface.
fn scatter(hits: &[Hit], purpose: u32) -> Vec<Ray> {
    let ray = |hit: &Hit| {
        let local = warp::cosine_hemisphere(unit2(purpose, hit.ray));
        let local = vec3(local.x, local.y, local.z.max(1e-3));
        hit.spawn_ray(Frame::around(hit.normal).to_world(local).normalize())
    };
    hits.iter().map(ray).collect()
}

/// Median of the distances; 1 without hits.
fn median_distance(hits: &[Hit]) -> f32 {
    let mut distances: Vec<f32> = hits.iter().map(|hit| hit.distance).collect();
    distances.sort_by(f32::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(1.0)
}

/// Uniform random permutation (Fisher and Yates; Knuth, TAOCP 2, 3.4.2, algorithm P).
fn shuffled(mut rays: Vec<Ray>) -> Vec<Ray> {
    for last in (1..rays.len()).rev() {
        let bits = hash::combine(99, last as u32);
        rays.swap(last, ((u64::from(bits) * (last as u64 + 1)) >> 32) as usize);
    }
    rays
}

#[cfg(test)]
mod tests;
