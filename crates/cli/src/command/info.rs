//! `juggler info`: what is in a scene or a mesh, and what a picture or a part of one says about itself.

mod mesh;
mod motion;
mod part;

use crate::console;
use crate::failure::Failure;
use crate::format::{bytes, counted};
use crate::reproduce;
use crate::source;
use clap::Args;
use juggler::film;
use juggler::imaging::layered::{LayerName, layer_names};
use juggler::imaging::{self, Facts, Format, regular};
use juggler::light::background::AnyBackground;
use juggler::math::{Aabb, message};
use juggler::scene::{Compiled, Illuminance, Scene, import};
use juggler::world::Geometry;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Flags of `juggler info`.
#[derive(Debug, Args)]
pub struct Info {
    /// A scene file, the name of a built-in scene, `-` for standard input, a mesh (PLY, OBJ, STL), a picture, or a part of
    /// one (.jfilm)
    scene: String,
    /// As one JSON object
    #[arg(long)]
    json: bool,
}

impl Info {
    /// Prints what a picture says, or builds the world or mesh and prints what is in it.
    pub fn run(self) -> Result<(), Failure> {
        let answer = self.answer()?;
        console::print(&if self.json { answer } else { message::printable_lines(&answer) })
    }

    fn answer(&self) -> Result<String, Failure> {
        let path = Path::new(&self.scene);
        if import::Content::of_file(path).is_mesh() {
            return Ok(mesh::Report::of(&self.scene)?.text(self.json));
        }
        let start = regular::first_bytes(path, 12).unwrap_or_default();
        let named = Format::from_path(path).ok().filter(|_| path.is_file());
        if let Some(format) = Format::from_first_bytes(&start).or(named) {
            return self.picture(format);
        }
        if film::is_part(&start) {
            return part::text(path, self.json);
        }
        let scene = source::load(&self.scene, None)?;
        let compiled = scene.compile()?;
        let text = if self.json { to_json } else { to_words };
        Ok(text(&self.scene, &scene, &compiled))
    }

    fn picture(&self, format: Format) -> Result<String, Failure> {
        let Facts { width, height, mut metadata, .. } = imaging::inspect(Path::new(&self.scene))?;
        let layers = layer_names(Path::new(&self.scene))?;
        for (_, text) in metadata.iter_mut().filter(|(key, _)| key == "Command") {
            *text = reproduce::told_by(&self.scene, text);
        }
        if self.json {
            let texts: Map<String, Value> = metadata.into_iter().map(|(key, text)| (key, text.into())).collect();
            let name = format.ending();
            let json = json!({
                "version": 1, "picture": self.scene, "format": name, "size": [width, height], "metadata": texts,
                "layers": layers.iter().map(|layer| json!({"name": layer.name, "channels": layer.channels})).collect::<Vec<_>>(),
            });
            return Ok(json.to_string());
        }
        let texts = metadata.iter().map(|(key, text)| row(key, text));
        let keys = std::iter::once("layers").chain(std::iter::repeat(""));
        let layers = keys.zip(&layers).map(|(key, layer)| row(key, &layer_in_words(layer)));
        let head = [self.scene.clone(), row("picture", &format!("{width}x{height}, {format}"))];
        let lines = head.into_iter().chain(layers).chain(texts);
        Ok(lines.collect::<Vec<_>>().join("\n"))
    }
}

/// A row of the answer: a key and its value.
fn row(key: &str, value: &str) -> String {
    format!("{key:12} {value}")
}

/// `albedo: R, G, B`; channels without the name of a layer stand alone.
fn layer_in_words(LayerName { name, channels }: &LayerName) -> String {
    let channels = channels.join(", ");
    if name.is_empty() { channels } else { format!("{name}: {channels}") }
}

fn to_words(name: &str, scene: &Scene, compiled: &Compiled) -> String {
    let geometry = compiled.world.geometry();
    let settings = &compiled.settings;
    let description = &scene.description;
    let title = if description.title.is_empty() { name } else { &description.title };
    let cameras: Vec<&str> = compiled.cameras.iter().map(|(name, _)| name.as_str()).collect();
    let [width, height] = settings.size;
    let mut lines = vec![title.to_owned()];
    if !description.description.is_empty() {
        lines.push(description.description.clone());
    }
    let mut row = |key: &str, value: String| lines.push(row(key, &value));
    row("picture", format!("{width}x{height}, {}", counted(settings.samples.into(), "sample")));
    row("integrator", format!("{}, {}", compiled.integrator.integrator.name(), compiled.integrator.reason));
    row("shapes", geometry.shapes.to_string());
    row("triangles", triangles_in_words(&geometry));
    if geometry.instances > 0 {
        row("instances", geometry.instances.to_string());
    }
    let brightest = compiled.illuminance.as_ref().map(|light| format!(", {light}")).unwrap_or_default();
    row("lights", format!("{}{brightest}", geometry.lights));
    row("emitting", counted(geometry.emitting_shapes as u128, "shape"));
    row("background", background_in_words(compiled.world.backdrop()));
    row("far lights", far_in_words(&compiled.world.far_lights()));
    row("materials", description.materials.len().to_string());
    row("textures", textures_in_words(description.textures.len(), geometry.texture_bytes));
    row("cameras", cameras.join(", "));
    row("bounds", bounds_in_words(&compiled.world.bounds()));
    row("memory", memory_in_words(geometry.geometry_bytes, geometry.bvh_bytes));
    motion::rows(&description.animation, &scene.survey()).iter().for_each(|(key, value)| row(key, value.clone()));
    lines.join("\n")
}

/// `1000000, 1000 of them stored`.
fn triangles_in_words(geometry: &Geometry) -> String {
    let Geometry { triangles, unique_triangles, .. } = *geometry;
    if triangles == unique_triangles {
        triangles.to_string()
    } else {
        format!("{triangles}, {unique_triangles} of them stored")
    }
}

fn memory_in_words(geometry: usize, bvh: usize) -> String {
    format!("{} shapes, {} tree", bytes(geometry as u64), bytes(bvh as u64))
}

/// `gradient, 0.2 0.3 0.5 on average`.
fn background_in_words(background: &AnyBackground) -> String {
    let [r, g, b] = background.mean().to_array().map(|channel| (channel * 1e4).round() / 1e4);
    format!("{}, {r} {g} {b} on average", background.name())
}

/// What has no place and yet gives light to paths, and how often which of it is asked: `directional 85 %, sky 15 %`.
fn far_in_words(lights: &[(&str, f32)]) -> String {
    let told: Vec<String> = lights.iter().map(|(name, chance)| format!("{name} {:.0} %", chance * 100.0)).collect();
    if told.is_empty() { "none".into() } else { told.join(", ") }
}

/// `3, 12 MiB of pictures`.
fn textures_in_words(count: usize, pictures: usize) -> String {
    if pictures > 0 { format!("{count}, {} of pictures", bytes(pictures as u64)) } else { count.to_string() }
}

fn bounds_in_words(bounds: &Aabb) -> String {
    match corners(bounds) {
        Some([min, max]) => format!("[{}, {}, {}] to [{}, {}, {}]", min[0], min[1], min[2], max[0], max[1], max[2]),
        None => "nothing bounded".into(),
    }
}

fn corners(bounds: &Aabb) -> Option<[[f32; 3]; 2]> {
    bounds.is_finite().then(|| [bounds.min.to_array(), bounds.max.to_array()])
}

fn to_json(name: &str, scene: &Scene, compiled: &Compiled) -> String {
    let world = &compiled.world;
    let geometry = world.geometry();
    let settings = &compiled.settings;
    let description = &scene.description;
    let far = world.far_lights().into_iter().map(|(kind, chance)| json!({"kind": kind, "chance": chance}));
    let far: Vec<Value> = far.collect();
    json!({
        "version": 1,
        "scene": name,
        "title": description.title,
        "description": description.description,
        "size": settings.size,
        "samples": settings.samples,
        "integrator": compiled.integrator.integrator.name(),
        "integrator_reason": compiled.integrator.reason.to_string(),
        "geometry": {
            "shapes": geometry.shapes,
            "triangles": geometry.triangles,
            "unique_triangles": geometry.unique_triangles,
            "instances": geometry.instances,
            "lights": geometry.lights,
            "emitting_shapes": geometry.emitting_shapes,
        },
        "illuminance": compiled.illuminance.as_ref().map(|Illuminance { light, value }| json!({"light": light, "middle": value})),
        "background": {"kind": world.backdrop().name(), "mean": world.backdrop().mean().to_array()},
        "far_lights": far,
        "materials": description.materials.len(),
        "textures": description.textures.len(),
        "cameras": compiled.cameras.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "bounds": corners(&compiled.world.bounds()),
        "memory": {
            "geometry_bytes": geometry.geometry_bytes,
            "bvh_bytes": geometry.bvh_bytes,
            "texture_bytes": geometry.texture_bytes,
        },
        "animation": motion::json(&description.animation, &scene.survey()),
    })
    .to_string()
}
