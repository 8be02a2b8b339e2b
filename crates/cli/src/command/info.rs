//! `juggler info`: contents of a scene or mesh, and metadata of a picture or partial render.

mod mesh;
mod model;
mod motion;
mod movie;
mod partial_render;
mod rows;

use crate::console;
use crate::failure::Failure;
use crate::format::{bytes, counted};
use crate::model_args::ModelArgs;
use crate::reproduce;
use crate::source;
use clap::Args;
use juggler::film;
use juggler::imaging::layered::{LayerName, layer_names};
use juggler::imaging::{self, ExrWindows, ImageFormat, ImageInfo, PixelWindow, regular};
use juggler::light::background::AnyBackground;
use juggler::math::message;
use juggler::mesh::FileContent;
use juggler::scene::{Compiled, Illuminance, Scene, camera_json};
use juggler::world::GeometryStats;
use rows::{bounds_text, corners, row};
use serde_json::{Map, Value, json};
use std::path::Path;

/// Flags of `juggler info`.
#[derive(Debug, Args)]
pub struct Info {
    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene, `-` for standard input,
    /// picture, movie, or partial render (.jfilm)
    scene: String,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    model: ModelArgs,
}

impl Info {
    /// Prints the metadata of a picture, or builds the world or mesh and prints its contents.
    pub fn run(self) -> Result<(), Failure> {
        let answer = self.answer()?;
        console::print_result(&if self.json { answer } else { message::printable_lines(&answer) })
    }

    fn answer(&self) -> Result<String, Failure> {
        let path = Path::new(&self.scene);
        if FileContent::detect(path).is_mesh() && !juggler::loader().is_model(path) {
            return Ok(mesh::Report::of(&self.scene)?.text(self.json));
        }
        let start = regular::first_bytes(path, 12).unwrap_or_default();
        let named = ImageFormat::from_extension(path).filter(|_| path.is_file());
        if let Some(format) = ImageFormat::from_first_bytes(&start).or(named) {
            return self.picture(format);
        }
        if movie::is_mp4(path, &start) {
            return Ok(movie::mp4_text(&self.scene, self.json));
        }
        if film::is_partial_render(&start) {
            return partial_render::text(path, self.json);
        }
        let scene = source::load_outline(&self.scene, &self.model)?;
        let compiled = scene.compile()?;
        let text = if self.json { to_json } else { to_words };
        Ok(text(&self.scene, &scene, &compiled))
    }

    fn picture(&self, format: ImageFormat) -> Result<String, Failure> {
        let ImageInfo { width, height, mut metadata, windows, .. } = imaging::inspect(Path::new(&self.scene))?;
        let layers = layer_names(Path::new(&self.scene))?;
        let length = movie::length(Path::new(&self.scene), format)?;
        for (_, text) in metadata.iter_mut().filter(|(key, _)| key == "Command") {
            *text = reproduce::with_file_name(&self.scene, text);
        }
        if self.json {
            let texts: Map<String, Value> = metadata.into_iter().map(|(key, text)| (key, text.into())).collect();
            let name = format.extension();
            let mut json = json!({
                "version": 1, "picture": self.scene, "format": name, "size": [width, height], "metadata": texts,
                "layers": layers.iter().map(|layer| json!({"name": layer.name, "channels": layer.channels})).collect::<Vec<_>>(),
            });
            if let (Some(windows), Some(json)) = (windows, json.as_object_mut()) {
                json.insert("windows".into(), windows_json(&windows));
            }
            if let (Some(length), Some(json)) = (length, json.as_object_mut()) {
                json.insert("frames".into(), length.frames.into());
                json.insert("seconds".into(), length.seconds.into());
            }
            return Ok(json.to_string());
        }
        let texts = metadata.iter().map(|(key, text)| row(key, text));
        let keys = std::iter::once("layers").chain(std::iter::repeat(""));
        let layers = keys.zip(&layers).map(|(key, layer)| row(key, &layer_text(layer)));
        let head = [self.scene.clone(), row("picture", &format!("{width}x{height}, {format}"))];
        let windows = windows.map(|ExrWindows { data, display }| {
            [row("data window", &data.to_string()), row("display", &display.to_string())]
        });
        let lines = head
            .into_iter()
            .chain(length.map(movie::row))
            .chain(windows.into_iter().flatten())
            .chain(layers)
            .chain(texts);
        Ok(lines.collect::<Vec<_>>().join("\n"))
    }
}

/// Windows of an EXR file, each as left, top, width and height.
fn windows_json(ExrWindows { data, display }: &ExrWindows) -> Value {
    let window = |PixelWindow { x, y, width, height }: &PixelWindow| json!([x, y, width, height]);
    json!({"data": window(data), "display": window(display)})
}

/// `albedo: R, G, B`; only the channels if the layer has no name.
fn layer_text(LayerName { name, channels }: &LayerName) -> String {
    let channels = channels.join(", ");
    if name.is_empty() { channels } else { format!("{name}: {channels}") }
}

fn to_words(name: &str, scene: &Scene, compiled: &Compiled) -> String {
    let geometry = compiled.world.geometry_stats();
    let settings = &compiled.settings;
    let (description, shown) = (&scene.description, scene.expanded_description());
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
    row("triangles", triangles_text(&geometry));
    if geometry.instances > 0 {
        row("instances", geometry.instances.to_string());
    }
    let brightest = compiled.illuminance.as_ref().map(|light| format!(", {light}")).unwrap_or_default();
    row("lights", format!("{}{brightest}", geometry.lights));
    row("emissive", emissive_text(geometry.emitting_shapes));
    row("background", background_text(scene, compiled.world.background()));
    row("infinite", infinite_lights_text(&compiled.world.infinite_lights()));
    row("materials", shown.materials.len().to_string());
    row("textures", textures_text(shown.textures.len(), picture_bytes(scene)));
    row("cameras", cameras.join(", "));
    row("camera", selected_camera(compiled).to_string());
    row("bounds", bounds_text(&compiled.world.bounds()));
    row("memory", memory_text(geometry.geometry_bytes, geometry.bvh_bytes));
    motion::rows(&description.animation, &scene.survey()).iter().for_each(|(key, value)| row(key, value.clone()));
    model::rows(scene).into_iter().for_each(|(key, value)| row(&key, value));
    lines.join("\n")
}

/// `1000000, 1000 of them stored`.
fn triangles_text(geometry: &GeometryStats) -> String {
    let GeometryStats { triangles, unique_triangles, .. } = *geometry;
    if triangles == unique_triangles {
        triangles.to_string()
    } else {
        format!("{triangles}, {unique_triangles} of them stored")
    }
}

/// The selected camera, as a scene file describes it.
fn selected_camera(compiled: &Compiled) -> Value {
    compiled.cameras.first().map_or(Value::Null, |(_, camera)| camera_json(camera))
}

fn memory_text(geometry: usize, bvh: usize) -> String {
    format!("{} shapes, {} tree", bytes(geometry as u64), bytes(bvh as u64))
}

/// `gradient, 0.2 0.3 0.5 on average`, with its description if it was made for a model or mesh.
fn background_text(scene: &Scene, background: &AnyBackground) -> String {
    let [r, g, b] = background.mean_radiance().to_array().map(|channel| (channel * 1e4).round() / 1e4);
    let description = scene.description.background.as_ref().filter(|_| scene.is_around_file());
    let description = description.map(|described| format!(": {}", json!(&**described)));
    format!("{}, {r} {g} {b} on average{}", background.name(), description.unwrap_or_default())
}

/// Infinite lights with their probabilities of being light-sampled: `directional 85 %, sky 15 %`.
fn infinite_lights_text(lights: &[(&str, f32)]) -> String {
    let lights: Vec<String> = lights.iter().map(|(name, chance)| format!("{name} {:.0} %", chance * 100.0)).collect();
    if lights.is_empty() { "none".into() } else { lights.join(", ") }
}

fn emissive_text(shapes: usize) -> String {
    match shapes {
        0 => "no shape emits light".into(),
        1 => "1 shape emits light".into(),
        several => format!("{several} shapes emit light"),
    }
}

/// `3, 12 MiB of pictures`.
fn textures_text(count: usize, pictures: u64) -> String {
    if pictures > 0 { format!("{count}, {} of pictures", bytes(pictures)) } else { count.to_string() }
}

/// Memory of the pictures of textures in bytes, by their heads.
fn picture_bytes(scene: &Scene) -> u64 {
    scene.needs().pictures.iter().map(|picture| picture.estimate.resident_bytes).fold(0, u64::saturating_add)
}

fn to_json(name: &str, scene: &Scene, compiled: &Compiled) -> String {
    let world = &compiled.world;
    let geometry = world.geometry_stats();
    let settings = &compiled.settings;
    let (description, shown) = (&scene.description, scene.expanded_description());
    let far = world.infinite_lights().into_iter().map(|(kind, chance)| json!({"kind": kind, "chance": chance}));
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
        "background": {"kind": world.background().name(), "mean": world.background().mean_radiance().to_array()},
        "far_lights": far,
        "materials": shown.materials.len(),
        "textures": shown.textures.len(),
        "camera": selected_camera(compiled),
        "cameras": compiled.cameras.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "bounds": corners(&compiled.world.bounds()),
        "memory": {
            "geometry_bytes": geometry.geometry_bytes,
            "bvh_bytes": geometry.bvh_bytes,
            "texture_bytes": picture_bytes(scene),
        },
        "animation": motion::json(&description.animation, &scene.survey()),
        "models": model::json(scene),
    })
    .to_string()
}
