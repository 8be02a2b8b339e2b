//! Description of a partial render: the JSON object in the header of a `.jfilm` file.

use crate::shard::{Units, whole_tiles};
use juggler_camera::aov::LightGroup;
use juggler_camera::film::{BLOCK_SAMPLES, Rect, Tiling};
use juggler_imaging::{CropFrame, Viewpoint};
use juggler_math::message::{MAX_QUOTE, excerpt};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;

/// Maximum width and height of an image in pixels, and maximum number of pixels: the scene
/// format's.
const MAX_EDGE: u32 = 65_536;
const MAX_PIXELS: u64 = 1 << 31;
/// Maximum number of object entries in a partial render; a scene cannot have as many.
const MAX_ENTRIES: u32 = 1 << 22;
/// Maximum number of RGB AOV planes per sample.
pub const MAX_PLANES: u32 = 4096;

/// Rule that ends a render.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Stop {
    /// Every pixel has the requested number of samples.
    Samples,
    /// Every tile's root mean square relative error is at most `level`.
    Noise {
        /// Relative error.
        #[serde(with = "exact")]
        level: f64,
    },
    /// The time limit has passed.
    Time {
        /// Time limit in seconds.
        #[serde(with = "exact")]
        seconds: f64,
    },
}

/// Serializes floats as strings, which round-trip exactly; JSON numbers might not.
mod exact {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(number)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        let number: f64 = String::deserialize(deserializer)?.parse().map_err(D::Error::custom)?;
        if number.is_finite() { Ok(number) } else { Err(D::Error::custom("a number must be finite")) }
    }
}

/// Serializes matrices as strings of 16 numbers, which round-trip exactly.
mod viewpoint {
    use juggler_imaging::{Matrix4, Viewpoint};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Texts {
        world_to_camera: String,
        world_to_ndc: String,
    }

    fn text(matrix: &Matrix4) -> String {
        matrix.iter().flatten().map(f32::to_string).collect::<Vec<_>>().join(" ")
    }

    fn matrix(text: &str) -> Option<Matrix4> {
        let numbers: Vec<f32> = text.split(' ').map(str::parse).collect::<Result<_, _>>().ok()?;
        let rows = numbers.as_chunks().0.try_into().ok();
        rows.filter(|_| numbers.len() == 16 && numbers.iter().all(|number| number.is_finite()))
    }

    pub fn serialize<S: Serializer>(viewpoint: &Option<Viewpoint>, serializer: S) -> Result<S::Ok, S::Error> {
        let texts = viewpoint.as_ref().map(|Viewpoint { world_to_camera, world_to_ndc }| Texts {
            world_to_camera: text(world_to_camera),
            world_to_ndc: text(world_to_ndc),
        });
        texts.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Viewpoint>, D::Error> {
        let Some(Texts { world_to_camera, world_to_ndc }) = Option::deserialize(deserializer)? else { return Ok(None) };
        match (matrix(&world_to_camera), matrix(&world_to_ndc)) {
            (Some(world_to_camera), Some(world_to_ndc)) => Ok(Some(Viewpoint { world_to_camera, world_to_ndc })),
            _ => Err(D::Error::custom("a matrix must be 16 finite numbers")),
        }
    }
}

/// The portion of an image that a partial render covers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShardDescription {
    /// Index of this shard, 0 to `count` - 1.
    pub index: u32,
    /// Number of shards of the image; 1 if it is not split.
    pub count: u32,
    /// Sample range that is split into shards: all samples of the image, or a range chosen by the
    /// user.
    pub samples: Range<u32>,
    /// Pixels that are split into shards, in whole tiles; `None` for the whole region.
    pub crop: Option<Rect>,
    /// The only units of the shard, if a program chose them; empty for all units.
    #[serde(default, skip_serializing_if = "Units::is_empty")]
    pub units: Units,
}

impl ShardDescription {
    /// The whole image of `samples` samples per pixel.
    pub fn whole(samples: u32) -> Self {
        Self { index: 0, count: 1, samples: 0..samples, crop: None, units: Units::default() }
    }

    /// Chosen units of an image of `samples` samples per pixel.
    pub fn of_units(samples: u32, units: Units) -> Self {
        Self { units, ..Self::whole(samples) }
    }
}

/// AOVs of an image, and the names that its masks refer to.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AovDescription {
    /// Names of the requested AOVs.
    #[serde(rename = "wanted")]
    pub requested: Vec<String>,
    /// Number of RGB planes stored per pixel.
    pub planes: u32,
    /// Whether the coverage of each pixel by objects, materials and instances is stored.
    pub masks: bool,
    /// Number of entries in the scene's `objects`.
    #[serde(default)]
    pub entries: u32,
    /// Indices and names of the named objects.
    #[serde(default)]
    pub objects: Vec<(u32, String)>,
    /// Indices and names of materials.
    #[serde(default)]
    pub materials: Vec<(u32, String)>,
    /// Names of the light groups, in order.
    #[serde(default)]
    pub light_groups: Vec<String>,
    /// Hash of the scene at the previous and next frame, if an AOV such as `motion` depends on
    /// them; else empty.
    #[serde(rename = "beside", default, skip_serializing_if = "String::is_empty")]
    pub neighbor_frames: String,
}

impl AovDescription {
    /// Whether the image has no AOVs.
    pub fn is_empty(&self) -> bool {
        self.requested.is_empty() && self.planes == 0 && !self.masks
    }

    /// Why no image can have these AOVs, if so.
    fn problem(&self) -> Option<&'static str> {
        if self.entries > MAX_ENTRIES {
            return Some("it names more objects (`entries`) than a scene can have");
        }
        if self.light_groups.len() > LightGroup::MAX_COUNT {
            return Some("it names more light groups (`light_groups`) than a scene can have");
        }
        (self.planes > MAX_PLANES).then_some("it has more AOVs (`planes`) than a picture can hold")
    }
}

impl std::fmt::Display for AovDescription {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.requested.join(","))
    }
}

/// Description of a partial render and of the image that it belongs to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RenderDescription {
    /// Name and version of the program that wrote the file.
    pub software: String,
    /// Command line that renders the complete image.
    pub command: String,
    /// Name of the scene.
    pub scene: String,
    /// Frame number; fractional between frames.
    #[serde(with = "exact")]
    pub frame: f64,
    /// Width and height of the full camera frame in pixels.
    pub size: [u32; 2],
    /// Rectangle of the camera frame that the finished image shows: all of it or a crop.
    pub region: Rect,
    /// Samples per pixel of the finished image; the maximum if noise or time ends the render.
    pub samples: u32,
    /// Rule that ends the render.
    pub stop: Stop,
    /// Whether bright samples are clamped; tiles then store the radiance removed.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub clamped: bool,
    /// AOVs stored beside radiance.
    #[serde(rename = "layers", default, skip_serializing_if = "AovDescription::is_empty")]
    pub aovs: AovDescription,
    /// The portion of the image that this partial render was to cover.
    #[serde(rename = "share")]
    pub shard: ShardDescription,
    /// Whether that portion is complete: the stop rule holds for each of its tiles.
    pub finished: bool,
    /// Every setting that influences pixels, by name, as text or hash. Partial renders with
    /// different fingerprints cannot be merged.
    pub fingerprint: BTreeMap<String, String>,
    /// Tone settings for the image file.
    pub tone: Value,
    /// Metadata for the image file, as pairs of key and text.
    pub metadata: Vec<(String, String)>,
    /// Camera matrices for the image file, if known.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "viewpoint")]
    pub viewpoint: Option<Viewpoint>,
}

/// A setting that differs between two partial renders of the same image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// Name of the setting: `size`, for example, or a key of the fingerprint.
    pub name: String,
    /// Value in the first partial render; empty if absent.
    pub here: String,
    /// Value in the second partial render; empty if absent.
    pub there: String,
}

impl RenderDescription {
    /// Frame that the finished image is a crop of; `None` if it is the whole frame.
    pub fn crop_frame(&self) -> Option<CropFrame> {
        let Rect { x, y, width, height } = self.region;
        CropFrame::new(self.size, [x, y], [width, height])
    }

    /// Layout of the image's tiles; chunks are numbered by it.
    pub fn tiling(&self) -> Tiling {
        Tiling::new(self.region)
    }

    /// Settings that differ from those of `other` and so prevent merging. Shard, tone and metadata
    /// may differ.
    pub fn mismatches(&self, other: &Self) -> Vec<Mismatch> {
        let mut found = Vec::new();
        let mut compare = |name: &str, here: String, there: String| {
            if here != there {
                found.push(Mismatch { name: name.to_owned(), here, there });
            }
        };
        compare("frame", self.frame.to_string(), other.frame.to_string());
        compare("size", size(self.size), size(other.size));
        compare("region", rect(&self.region), rect(&other.region));
        compare("samples", self.samples.to_string(), other.samples.to_string());
        compare("clamped", self.clamped.to_string(), other.clamped.to_string());
        compare("stop", self.stop.to_string(), other.stop.to_string());
        compare("AOVs", self.aovs.to_string(), other.aovs.to_string());
        compare("neighbor frames", self.aovs.neighbor_frames.clone(), other.aovs.neighbor_frames.clone());
        let names =
            self.fingerprint.keys().chain(other.fingerprint.keys().filter(|k| !self.fingerprint.contains_key(*k)));
        for name in names {
            let value = |of: &Self| of.fingerprint.get(name).cloned().unwrap_or_default();
            compare(name, value(self), value(other));
        }
        found
    }

    /// Why the description is invalid in itself; `None` for every description that this program
    /// writes.
    pub(super) fn problem(&self) -> Option<&'static str> {
        let Self { size: [width, height], region, shard, stop, .. } = self;
        let inside = |start: u32, length: u32, end: u32| start.checked_add(length).is_some_and(|at| at <= end);
        if *width > MAX_EDGE || *height > MAX_EDGE || u64::from(*width) * u64::from(*height) > MAX_PIXELS {
            return Some("its picture is larger than any that can be rendered");
        }
        if let Some(problem) = self.aovs.problem() {
            return Some(problem);
        }
        if !inside(region.x, region.width, *width) || !inside(region.y, region.height, *height) {
            return Some("its region is not inside its picture");
        }
        let number = match *stop {
            Stop::Samples => 0.0,
            Stop::Noise { level } => level,
            Stop::Time { seconds } => seconds,
        };
        if !self.frame.is_finite() || !number.is_finite() {
            return Some("its frame and stop rule must be finite numbers");
        }
        if shard.index >= shard.count {
            return Some("its shard index must be below its number of shards");
        }
        let Range { start, end } = shard.samples;
        let between_blocks =
            start.is_multiple_of(BLOCK_SAMPLES) && (end.is_multiple_of(BLOCK_SAMPLES) || end == self.samples);
        if start > end || end > self.samples || !between_blocks {
            return Some("its samples exceed the picture's, or do not align with blocks of 16");
        }
        if shard.crop.is_some_and(|crop| crop.intersection(region) != crop || whole_tiles(region, &crop) != crop) {
            return Some("its pixels are not whole tiles of its region");
        }
        if !shard.units.fit(self.tiling().tile_count(), &shard.samples) {
            return Some("its units are not tiles and samples of its shard");
        }
        None
    }
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Samples => f.write_str("samples"),
            Self::Noise { level } => write!(f, "noise {level}"),
            Self::Time { seconds } => write!(f, "time {seconds} s"),
        }
    }
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if is_hash(&self.here) && is_hash(&self.there) {
            return write!(f, "{}: not the same", for_message(&self.name));
        }
        write!(f, "{}: {} instead of {}", for_message(&self.name), for_message(&self.there), for_message(&self.here))
    }
}

/// Whether a text consists of hashes only, which say nothing to a reader.
fn is_hash(text: &str) -> bool {
    let hash = |word: &str| word.len() >= 32 && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    !text.is_empty() && text.split(' ').all(hash)
}

/// A value for a message: shortened, and without control characters.
fn for_message(text: &str) -> String {
    if text.is_empty() {
        return "nothing".to_owned();
    }
    if is_hash(text) {
        return "something else".to_owned();
    }
    excerpt(text, MAX_QUOTE)
}

fn size([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}

fn rect(Rect { x, y, width, height }: &Rect) -> String {
    format!("{x},{y},{width},{height}")
}
