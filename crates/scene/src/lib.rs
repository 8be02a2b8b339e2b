//! From files of scenes to worlds that can be rendered:
//!
//! 1. [`document`]: texts into one tree that knows where everything was written, includes merged;
//! 2. [`animate`] resolves every `"=expression"` for one frame;
//! 3. [`validate`] holds the tree against the [`schema`], which the types of the [`description`] give;
//! 4. the tree becomes a description;
//! 5. [`compile`] places groups, looks up names, prepares shapes and makes a world.
//!
//! Whatever is wrong becomes a [`report`] with file, line, column, path and what was probably meant.

pub mod animate;
mod around;
mod asset;
mod bookmark;
mod building;
pub mod compile;
pub mod description;
pub mod document;
mod edit;
mod error;
mod fingerprint;
pub mod import;
mod integrator;
mod item;
pub mod kind;
mod motion;
pub mod named;
pub mod path;
mod presets;
mod relocate;
pub mod report;
mod scene;
pub mod schema;
mod shared;
mod store;
pub mod validate;

pub use asset::Asset;
pub use bookmark::{camera_json, with_camera};
pub use compile::{Compiled, Illuminance, Names};
pub use description::{Chain, ControlSphere, Description, Limb, Object, TransformStep};
pub use error::SceneError;
pub use fingerprint::Fingerprint;
pub use integrator::{IntegratorChoice, IntegratorReason};
pub use item::Item;
pub use juggler_math::suggest;
pub use motion::{ListTracks, ObjectTrack, Tracks};
pub use presets::{BuiltIn, built_in_scenes};
pub use report::{Problem, Problems, Severity};
pub use scene::Scene;
pub use schema::{reference, schema_json};
pub use shared::Shared;
pub use store::{Bundle, Store};
pub use validate::names_page;
