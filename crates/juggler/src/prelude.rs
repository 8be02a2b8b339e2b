//! Common items of most programs: `use juggler::prelude::*;`
//!
//! Textures and backgrounds keep their modules' names, as do integrators, samplers and filters:
//! `texture::Gradient`, `background::Gradient`, `integrator::Path`, `sampler::Sobol`,
//! `film::Gaussian`.
//!
//! Values are made by `new` from the fields that they need. The other fields have their defaults
//! until they are set. An [`Input`] converts from numbers, colors and names of textures:
//!
//! ```
//! use juggler::prelude::*;
//!
//! let lacquer = Principled {
//!     roughness: 0.6.into(),
//!     specular_color: [1.0, 0.9, 0.8].into(),
//!     // The field is an `Option<Input<Rgb>>`.
//!     clearcoat_normal: Some("ripples".into()),
//!     ..Principled::new("wood")
//! };
//! assert_eq!(lacquer.base_color, Input::Texture("wood".into()));
//! assert_eq!(lacquer.roughness, Input::Value(0.6));
//! ```

// Facade.
pub use crate::{Aov, AovSet, Denoiser, Error, ImageExt, Limit, Picture, Settings, View};

// Modules whose names would clash, or read better with their module.
pub use juggler_camera::{aov, film, sampler};
pub use juggler_integrator as integrator;
pub use juggler_light::background;
pub use juggler_texture as texture;

// Scenes, and values that change with time.
pub use juggler_scene::animate::{
    Along, Animate, Ease, Easing, Extrapolation, Frames, Interpolation, Joint, PathName, Posed, Seconds,
};
pub use juggler_scene::description::{Animation, LookAt, Rotate, Rotation, ScenePath};
pub use juggler_scene::{
    Animated, Asset, Chain, ControlSphere, InstanceArray, InstanceAttribute, InstanceFile, Instances, Limb, Model,
    NamedAttributes, Object, ScaleFactors, Scene, TransformStep, ValueSource,
};

// Shapes.
pub use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
pub use juggler_shape::{
    AnyShape, Cuboid, Cylinder, Disk, Mesh, MeshData, MorphTarget, Plane, Polygon, Rectangle, Sphere, Triangle, Tube,
};

// Materials, and the inputs of materials and textures.
pub use juggler_bsdf::Highlight;
pub use juggler_material::medium::Medium;
pub use juggler_material::{
    AnyMaterial, Boundary, BumpMap, Checkerboard, CheckerboardPlane, Conductor, Dielectric, Diffuse,
    DiffuseNormalization, Emissive, Mask, MaterialRef, MetalName, Mix, NormalMap, Phong, Plastic, Principled, Sides,
    Spread, SurfaceSides, Translucent, Unlit, Velvet,
};
pub use juggler_texture::{AnyTexture, Input};

// Lights and backgrounds.
pub use juggler_light::background::AnyBackground;
pub use juggler_light::{
    Ambient, AnyLight, Area, AreaShape, Attenuation, Directional, Extent, Ies, Point, Spot, SpotFalloff,
};

// Cameras, rendering and images.
pub use juggler_camera::film::{AnyFilter, Rect};
pub use juggler_camera::sampler::{AnySampler, SamplerKind};
pub use juggler_camera::{AnyCamera, LocalTranslation, Orthographic, Perspective, ThinLens, ViewPlane, VirtualScreen};
pub use juggler_imaging::{AnyCurve, ImageFormat, Primaries, Tone, ToneCurveKind, WhiteBalance};
pub use juggler_integrator::{AnyIntegrator, IntegratorKind};
pub use juggler_math::{Image, Rgb, Vec2, Vec3, vec2, vec3};
pub use juggler_render::{Control, Scheduler};
