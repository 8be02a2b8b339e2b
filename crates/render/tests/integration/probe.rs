//! Small worlds built from JSON, and estimates of the radiance at one point.

use juggler_camera::aov;
use juggler_camera::film::{AnyFilter, Rect};
use juggler_camera::sampler::AnySampler;
use juggler_camera::{AnyCamera, ShutterCamera};
use juggler_integrator::{AnyIntegrator, Integrator};
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{AnyMaterial, MaterialCompiler, MaterialId};
use juggler_math::{Motion, Transform, UVec2, Vec3};
use juggler_render::{CameraRays, Control, Job, Work};
use juggler_shape::AnyShape;
use juggler_texture::{AnyTexture, TextureTable};
use juggler_world::{Object, World};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

pub fn read<T: DeserializeOwned>(json: &str) -> T {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{error} in {json}"))
}

/// Builder of a world.
pub struct Scene {
    compiler: MaterialCompiler,
    pub objects: Vec<Object>,
    lights: Vec<AnyLight>,
    background: AnyBackground,
}

impl Scene {
    /// Empty scene with a black background.
    pub fn new() -> Self {
        Self::textured("{}")
    }

    /// Empty scene with named textures.
    pub fn textured(textures: &str) -> Self {
        let textures: BTreeMap<String, AnyTexture> = read(textures);
        let compiler = MaterialCompiler::new(TextureTable::new(textures), []);
        Self { compiler, objects: Vec::new(), lights: Vec::new(), background: read(r#"{"solid": {}}"#) }
    }

    /// Scene with a floor of albedo 0.5 at y = 0, whose radiance is its irradiance over 2π.
    pub fn floor() -> Self {
        Self::new().with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.5}}"#)
    }

    pub fn material(&mut self, material: &str) -> MaterialId {
        self.compiler.compile(&read::<AnyMaterial>(material)).unwrap()
    }

    /// Adds a translated shape.
    pub fn with(self, shape: &str, at: Vec3, material: &str) -> Self {
        self.placed(shape, Transform::translation(at), material)
    }

    /// Adds a shape with a motion.
    pub fn placed(mut self, shape: &str, motion: impl Into<Motion>, material: &str) -> Self {
        let material = self.material(material);
        self.objects.push(Object::new(prepared(shape), motion, material));
        self
    }

    pub fn lit(mut self, light: &str) -> Self {
        self.lights.push(read(light));
        self
    }

    /// Sets a background that is prepared already.
    pub fn before(mut self, background: AnyBackground) -> Self {
        self.background = background;
        self
    }

    /// Sets a uniform background of this radiance.
    pub fn in_light(self, radiance: f32) -> Self {
        self.before(read(&format!(r#"{{"solid": {{"color": {radiance}}}}}"#)))
    }

    pub fn world(self) -> World {
        World::new(
            self.objects,
            self.compiler.finish().unwrap(),
            self.lights,
            self.background,
            &juggler_math::BuildControl::default(),
        )
        .unwrap()
    }
}

pub fn prepared(shape: &str) -> AnyShape {
    let mut shape: AnyShape = read(shape);
    shape.prepare().unwrap();
    shape
}

/// The path integrator with these options; `""` for the defaults.
pub fn path(options: &str) -> AnyIntegrator {
    read(&format!(r#"{{"path": {{{options}}}}}"#))
}

/// Edge of the picture, in pixels; each pixel is an independent estimate.
pub const EDGE: u32 = 16;

pub fn camera(json: &str) -> ShutterCamera {
    read::<AnyCamera>(json).projection(UVec2::splat(EDGE)).unwrap().into()
}

/// Orthographic camera at `eye` that sees only the point `at`.
pub fn looking(eye: Vec3, at: Vec3) -> ShutterCamera {
    let up = if (eye - at).cross(Vec3::Y).length() > 0.01 { Vec3::Y } else { Vec3::Z };
    camera(&format!(
        r#"{{"orthographic": {{"eye": {}, "look_at": {}, "up": {}, "height": 1e-4}}}}"#,
        json(eye),
        json(at),
        json(up)
    ))
}

/// View of the origin from the side.
pub fn at_origin() -> ShutterCamera {
    looking(Vec3::new(3.0, 2.0, 4.0), Vec3::ZERO)
}

pub fn json(v: Vec3) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

/// Mean and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub sigma: f64,
}

/// Whether to run all cases (`check.sh deep furnaces`) instead of a few.
pub fn is_deep() -> bool {
    std::env::var_os("JUGGLER_FURNACES").is_some()
}

/// Relative error of a mean by rounding to single precision along paths.
const ROUNDING: f64 = 1e-4;

impl Estimate {
    /// Mean of independent estimates.
    pub fn of(estimates: &[f64]) -> Self {
        let count = estimates.len() as f64;
        let mean = estimates.iter().sum::<f64>() / count;
        let squares = estimates.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        Self { mean, sigma: (squares / (count - 1.0) / count).sqrt() }
    }

    /// Asserts that the mean is within three standard errors of `expected`, and the standard error
    /// below half a percent.
    #[track_caller]
    pub fn is(self, expected: f64) {
        let Self { mean, sigma } = self;
        assert!(sigma < 0.005 * expected.abs(), "too noisy: {mean} ± {sigma}, expected {expected}");
        let allowed = 3.0 * sigma + ROUNDING * expected.abs();
        let off = (mean - expected) / expected;
        assert!((mean - expected).abs() <= allowed, "{mean} ± {sigma}, expected {expected}, off by {off:+.5}");
    }

    /// Asserts that two estimates agree within three standard errors of their difference.
    #[track_caller]
    pub fn equals(self, other: Self, what: &str) {
        self.equals_within(other, 3.0, what);
    }

    /// Asserts that two estimates agree within `deviations` standard errors of their difference;
    /// see [`family_wise_deviations`](juggler_math::testing::family_wise_deviations).
    #[track_caller]
    pub fn equals_within(self, other: Self, deviations: f64, what: &str) {
        let sigma = (self.sigma * self.sigma + other.sigma * other.sigma).sqrt();
        assert!(sigma < 0.02 * self.mean.abs(), "{what}: too noisy: {self:?}, {other:?}");
        let allowed = deviations * sigma + ROUNDING * self.mean.abs();
        assert!((self.mean - other.mean).abs() <= allowed, "{what}: {self:?}, {other:?}");
    }
}

/// Mean red, green and blue of all pixels, with `samples` each.
pub fn colors(world: &World, camera: &ShutterCamera, integrator: &dyn Integrator, samples: u32) -> [Estimate; 3] {
    let pixels = picture(world, camera, integrator, samples, 1);
    [0, 1, 2].map(|channel| {
        let values: Vec<f64> = pixels.iter().map(|pixel| f64::from(pixel.to_array()[channel])).collect();
        Estimate::of(&values)
    })
}

/// Mean red of all pixels, with `samples` each.
pub fn measure(world: &World, camera: &ShutterCamera, integrator: &dyn Integrator, samples: u32) -> Estimate {
    colors(world, camera, integrator, samples)[0]
}

/// Estimate by the path integrator with default options.
pub fn traced(scene: Scene, camera: &ShutterCamera, samples: u32) -> Estimate {
    measure(&scene.world(), camera, &*path(""), samples)
}

pub fn picture(
    world: &World,
    camera: &ShutterCamera,
    integrator: &dyn Integrator,
    samples: u32,
    seed: u64,
) -> Vec<juggler_math::Rgb> {
    pixels(world, camera, integrator, EDGE, (samples, seed))
}

/// Red of all pixels of a square picture.
pub fn square(world: &World, camera: &AnyCamera, integrator: &dyn Integrator, edge: u32, samples: u32) -> Vec<f64> {
    let camera: ShutterCamera = camera.projection(UVec2::splat(edge)).unwrap().into();
    pixels(world, &camera, integrator, edge, (samples, 1)).iter().map(|pixel| f64::from(pixel.r)).collect()
}

fn pixels(
    world: &World,
    camera: &ShutterCamera,
    integrator: &dyn Integrator,
    edge: u32,
    (samples, seed): (u32, u64),
) -> Vec<juggler_math::Rgb> {
    let (filter, pattern) =
        (read::<AnyFilter>(r#"{"box": {}}"#).sampler(samples), read::<AnySampler>(r#"{"sobol": {}}"#));
    let job = Job {
        world,
        camera,
        integrator,
        filter,
        pattern: pattern.point_set(samples),
        samples,
        seed,
        camera_rays: &CameraRays::default(),
        aovs: &aov::NO_AOVS,
        frames: None,
    };
    let pixels = Rect { x: 0, y: 0, width: edge, height: edge };
    job.render(&Work::first(pixels, samples), &Control::default()).unwrap().means()
}
