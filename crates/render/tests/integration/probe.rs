//! Tiny worlds written in JSON, and what a camera that sees one point of them measures.

use juggler_camera::film::{AnyFilter, Rect};
use juggler_camera::layer;
use juggler_camera::sampler::AnySampler;
use juggler_camera::{AnyCamera, Shot};
use juggler_integrator::{AnyIntegrator, Integrator};
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{AnyMaterial, MaterialCompiler, MaterialId};
use juggler_math::{Motion, Transform, UVec2, Vec3};
use juggler_render::{Control, Job, Work};
use juggler_shape::AnyShape;
use juggler_texture::{AnyTexture, TextureTable};
use juggler_world::{Object, World};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

pub fn read<T: DeserializeOwned>(json: &str) -> T {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{error} in {json}"))
}

/// A world that grows.
pub struct Scene {
    compiler: MaterialCompiler,
    pub objects: Vec<Object>,
    lights: Vec<AnyLight>,
    background: AnyBackground,
}

impl Scene {
    /// Nothing, and black all around.
    pub fn new() -> Self {
        Self::textured("{}")
    }

    /// Nothing but textures by name.
    pub fn textured(textures: &str) -> Self {
        let textures: BTreeMap<String, AnyTexture> = read(textures);
        let compiler = MaterialCompiler::new(TextureTable::new(textures), []);
        Self { compiler, objects: Vec::new(), lights: Vec::new(), background: read(r#"{"solid": {}}"#) }
    }

    /// With a floor at y = 0 that gives back half of the light, so that it shows the irradiance over 2π.
    pub fn floor() -> Self {
        Self::new().with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.5}}"#)
    }

    pub fn material(&mut self, material: &str) -> MaterialId {
        self.compiler.compile(&read::<AnyMaterial>(material)).unwrap()
    }

    /// One more shape, moved only.
    pub fn with(self, shape: &str, at: Vec3, material: &str) -> Self {
        self.placed(shape, Transform::translation(at), material)
    }

    /// One more shape.
    pub fn placed(mut self, shape: &str, motion: impl Into<Motion>, material: &str) -> Self {
        let material = self.material(material);
        self.objects.push(Object::new(prepared(shape), motion, material));
        self
    }

    pub fn lit(mut self, light: &str) -> Self {
        self.lights.push(read(light));
        self
    }

    /// In front of a background that is prepared already.
    pub fn before(mut self, background: AnyBackground) -> Self {
        self.background = background;
        self
    }

    /// In light of this radiance from everywhere.
    pub fn in_light(self, radiance: f32) -> Self {
        self.before(read(&format!(r#"{{"solid": {{"color": {radiance}}}}}"#)))
    }

    pub fn world(self) -> World {
        World::new(self.objects, self.compiler.finish().unwrap(), self.lights, self.background)
    }
}

pub fn prepared(shape: &str) -> AnyShape {
    let mut shape: AnyShape = read(shape);
    shape.prepare().unwrap();
    shape
}

/// The path tracer with these options: `""` for none.
pub fn path(options: &str) -> AnyIntegrator {
    read(&format!(r#"{{"path": {{{options}}}}}"#))
}

/// Edge of the picture: each of its pixels is an estimate of its own.
pub const EDGE: u32 = 16;

pub fn camera(json: &str) -> Shot {
    read::<AnyCamera>(json).project(UVec2::splat(EDGE)).unwrap().into()
}

/// From `eye` at the point `at`, and at next to nothing around it.
pub fn looking(eye: Vec3, at: Vec3) -> Shot {
    let up = if (eye - at).cross(Vec3::Y).length() > 0.01 { Vec3::Y } else { Vec3::Z };
    camera(&format!(
        r#"{{"orthographic": {{"eye": {}, "look_at": {}, "up": {}, "height": 1e-4}}}}"#,
        json(eye),
        json(at),
        json(up)
    ))
}

/// From the side at the origin.
pub fn at_origin() -> Shot {
    looking(Vec3::new(3.0, 2.0, 4.0), Vec3::ZERO)
}

pub fn json(v: Vec3) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

/// A mean and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    pub mean: f64,
    pub sigma: f64,
}

/// Whether all cases are asked for (`check.sh deep furnaces`); the check takes a few of them.
pub fn is_deep() -> bool {
    std::env::var_os("JUGGLER_FURNACES").is_some()
}

/// What rounding to single precision along a path may do to a mean.
const ROUNDING: f64 = 1e-4;

impl Measured {
    /// Of estimates that know nothing of each other.
    pub fn of(estimates: &[f64]) -> Self {
        let count = estimates.len() as f64;
        let mean = estimates.iter().sum::<f64>() / count;
        let squares = estimates.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        Self { mean, sigma: (squares / (count - 1.0) / count).sqrt() }
    }

    /// Within three standard errors, which must be below half a percent.
    #[track_caller]
    pub fn is(self, expected: f64) {
        let Self { mean, sigma } = self;
        assert!(sigma < 0.005 * expected.abs(), "too noisy: {mean} ± {sigma}, expected {expected}");
        let allowed = 3.0 * sigma + ROUNDING * expected.abs();
        let off = (mean - expected) / expected;
        assert!((mean - expected).abs() <= allowed, "{mean} ± {sigma}, expected {expected}, off by {off:+.5}");
    }

    /// Two estimates of the same: three standard errors of their difference (Welch's t at so many degrees of freedom).
    #[track_caller]
    pub fn equals(self, other: Self, what: &str) {
        self.equals_within(other, 3.0, what);
    }

    /// Two estimates of the same, which chance sets apart by less than so many standard errors: see [`family_wise_deviations`](juggler_math::testing::family_wise_deviations).
    #[track_caller]
    pub fn equals_within(self, other: Self, deviations: f64, what: &str) {
        let sigma = (self.sigma * self.sigma + other.sigma * other.sigma).sqrt();
        assert!(sigma < 0.02 * self.mean.abs(), "{what}: too noisy: {self:?}, {other:?}");
        let allowed = deviations * sigma + ROUNDING * self.mean.abs();
        assert!((self.mean - other.mean).abs() <= allowed, "{what}: {self:?}, {other:?}");
    }
}

/// Red, green, blue of the mean of all pixels, `samples` each.
pub fn colors(world: &World, camera: &Shot, integrator: &dyn Integrator, samples: u32) -> [Measured; 3] {
    let pixels = picture(world, camera, integrator, samples, 1);
    [0, 1, 2].map(|channel| {
        let values: Vec<f64> = pixels.iter().map(|pixel| f64::from(pixel.to_array()[channel])).collect();
        Measured::of(&values)
    })
}

/// The red of the mean of all pixels, `samples` each.
pub fn measure(world: &World, camera: &Shot, integrator: &dyn Integrator, samples: u32) -> Measured {
    colors(world, camera, integrator, samples)[0]
}

/// What the path tracer, with no options, measures.
pub fn traced(scene: Scene, camera: &Shot, samples: u32) -> Measured {
    measure(&scene.world(), camera, &*path(""), samples)
}

pub fn picture(
    world: &World,
    camera: &Shot,
    integrator: &dyn Integrator,
    samples: u32,
    seed: u64,
) -> Vec<juggler_math::Rgb> {
    pixels(world, camera, integrator, EDGE, (samples, seed))
}

/// Red of all pixels of a square picture.
pub fn square(world: &World, camera: &AnyCamera, integrator: &dyn Integrator, edge: u32, samples: u32) -> Vec<f64> {
    let camera: Shot = camera.project(UVec2::splat(edge)).unwrap().into();
    pixels(world, &camera, integrator, edge, (samples, 1)).iter().map(|pixel| f64::from(pixel.r)).collect()
}

fn pixels(
    world: &World,
    camera: &Shot,
    integrator: &dyn Integrator,
    edge: u32,
    (samples, seed): (u32, u64),
) -> Vec<juggler_math::Rgb> {
    let (filter, pattern) =
        (read::<AnyFilter>(r#"{"box": {}}"#).filter(samples), read::<AnySampler>(r#"{"sobol": {}}"#));
    let job = Job {
        world,
        camera,
        integrator,
        filter,
        pattern: pattern.pattern(samples),
        samples,
        seed,
        layers: &layer::NONE,
        frames: None,
    };
    let pixels = Rect { x: 0, y: 0, width: edge, height: edge };
    job.render(&Work::first(pixels, samples), &Control::default()).unwrap().means()
}
