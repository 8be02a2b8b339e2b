//! Small documents and their parts.

mod animation;
mod lenient;
mod nodes;
mod thin;
mod views;

use crate::gltf::GltfFormat;
use crate::gltf::testing::Builder;
use juggler_scene::model::{ModelChoice, ModelFile, ModelFormat, ModelParts};
use juggler_scene::{Instances, Item, Object, TransformStep};
use juggler_shape::{AnyShape, Mesh};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A document of one triangle, whose positions are accessor 0.
fn triangle() -> Builder {
    let mut builder = Builder::default();
    builder.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    builder
}

fn open(builder: &Builder) -> Arc<dyn ModelFile> {
    let model = GltfFormat::default().open("a.glb", builder.glb(), &BTreeMap::new());
    model.unwrap_or_else(|error| panic!("{error}"))
}

fn parts_at(model: &Arc<dyn ModelFile>, seconds: f64) -> ModelParts {
    let choice = ModelChoice { seconds, ..ModelChoice::default() };
    model.parts(&choice, "").unwrap_or_else(|error| panic!("{error}"))
}

fn parts(builder: &Builder) -> ModelParts {
    parts_at(&open(builder), 0.0)
}

/// Rows of the only transform step of an object.
fn rows(object: &Object) -> Vec<f32> {
    match object.transform.as_slice() {
        [TransformStep::Matrix(rows)] => rows.clone(),
        other => panic!("{other:?}"),
    }
}

fn mesh(object: &Object) -> &Mesh {
    match &object.shape {
        Some(AnyShape::Mesh(mesh)) => mesh,
        other => panic!("{other:?}"),
    }
}
