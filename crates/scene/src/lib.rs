//! Scene files and their compilation to worlds for rendering, in these steps:
//!
//! 1. [`document`] parses the texts, merges includes, and keeps the position of every value;
//! 2. [`animate`] evaluates every `"=expression"` for one frame;
//! 3. [`validate`] checks the tree against the [`schema`], which is generated from the types of the
//!    [`description`];
//! 4. the tree is deserialized to a description;
//! 5. [`compile`] places groups, resolves names, prepares shapes and builds a world.
//!
//! Errors are collected in a [`report`] with file, line, column, path and suggested fix.

pub mod animate;
mod animated;
mod animating;
mod array_hasher;
mod asset;
mod building;
mod camera_text;
mod change;
pub mod compile;
mod compiling;
pub mod description;
pub mod document;
mod edit;
mod equality;
mod error;
mod field_value;
mod fingerprint;
mod instance_digest;
mod integrator;
mod item;
mod loader;
mod mesh_digest;
mod mesh_scene;
pub mod model;
mod motion;
pub mod named;
mod package;
pub mod path;
mod picture_reading;
mod presets;
mod relocate;
pub mod report;
mod save;
mod scene;
pub mod schema;
mod shared;
mod store;
mod texel_array;
mod unpack;
mod update;
pub mod validate;
mod value_at;

pub use animate::ValueSource;
pub use animated::Animated;
pub use asset::Asset;
pub use camera_text::{camera_json, with_camera};
pub use change::{Change, Changed};
pub use compile::{Compiled, Illuminance, Names};
pub use description::{
    Chain, ControlSphere, Description, InstanceArray, InstanceAttribute, InstanceFile, Instances, Limb, Model,
    NamedAttributes, Object, ScaleFactors, TransformStep,
};
pub use error::SceneError;
pub use field_value::FieldValue;
pub use fingerprint::Fingerprint;
pub use integrator::{IntegratorChoice, IntegratorReason};
pub use item::Item;
pub use juggler_math::suggest;
pub use loader::Loader;
pub use motion::{ListTracks, ObjectTrack, Tracks};
pub use package::ScenePackage;
pub use picture_reading::PictureReading;
pub use presets::{BuiltIn, built_in_scenes};
pub use report::{Problem, Problems, Severity};
pub use scene::Scene;
pub use schema::{reference, schema_json};
pub use shared::Shared;
pub use store::{Bundle, Store};
pub use texel_array::{InvalidTexels, TexelArray, TexelSamples};
pub use validate::names_page;
pub use value_at::UnknownPath;
