//! What a part says about itself: the JSON text at its head.

use crate::share::whole_tiles;
use juggler_camera::film::{BLOCK, Layout, Rect};
use juggler_imaging::Viewpoint;
use juggler_math::message::{MAX_QUOTE, excerpt};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;

/// Largest width and height of a picture, and most pixels: those of scenes.
const MAX_EDGE: u32 = 65_536;
const MAX_PIXELS: u64 = 1 << 31;
/// Most entries of a scene's objects that a part may name: more than a scene can store.
const MAX_ENTRIES: u32 = 1 << 22;
/// Most groups of lights that a scene can name.
const MAX_LIGHT_GROUPS: usize = 65_535;
/// Most colors that a picture keeps of each sample beside radiance.
pub const MAX_PLANES: u32 = 4096;

/// When a picture is finished.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Stop {
    /// Every pixel has as many samples as the picture is to have.
    Samples,
    /// Every pixel's relative error is below this.
    Noise {
        /// Relative error.
        #[serde(with = "exact")]
        level: f64,
    },
    /// So much time was spent.
    Time {
        /// Seconds.
        #[serde(with = "exact")]
        seconds: f64,
    },
}

/// Numbers as texts, which come back to the bit; as JSON's numbers they might not.
mod exact {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(number)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        let number: f64 = String::deserialize(deserializer)?.parse().map_err(D::Error::custom)?;
        if number.is_finite() { Ok(number) } else { Err(D::Error::custom("no finite number")) }
    }
}

/// Matrices as texts of numbers, likewise.
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
            _ => Err(D::Error::custom("a matrix is no 16 finite numbers")),
        }
    }
}

/// Which part of the picture this was to become.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Which of `count` shares, from 0 on.
    pub index: u32,
    /// How many shares the picture is cut into: 1 when it is not.
    pub count: u32,
    /// The samples that are cut: all of the picture's, or a range that somebody chose.
    pub samples: Range<u32>,
    /// The pixels that are cut when they are not all of the region: whole tiles.
    pub crop: Option<Rect>,
}

impl Share {
    /// All of a picture of so many samples.
    pub fn whole(samples: u32) -> Self {
        Self { index: 0, count: 1, samples: 0..samples, crop: None }
    }
}

/// What a picture keeps beside radiance, and the names of what that tells apart.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layered {
    /// What was asked for, by name.
    pub wanted: Vec<String>,
    /// Colours that are kept of each sample.
    pub planes: u32,
    /// Whether it is kept how much of a pixel shows which thing.
    pub masks: bool,
    /// How many entries the scene's objects are.
    #[serde(default)]
    pub entries: u32,
    /// Numbers and names of those that have one.
    #[serde(default)]
    pub objects: Vec<(u32, String)>,
    /// Numbers and names of materials.
    #[serde(default)]
    pub materials: Vec<(u32, String)>,
    /// Names of groups of lights, in order.
    #[serde(default)]
    pub light_groups: Vec<String>,
    /// A hash of what the scene is at the frames beside, where any layer tells of that.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub beside: String,
}

impl Layered {
    /// Whether nothing is kept.
    pub fn is_empty(&self) -> bool {
        self.wanted.is_empty() && self.planes == 0 && !self.masks
    }

    /// What of it no picture can have.
    fn fault(&self) -> Option<&'static str> {
        if self.entries > MAX_ENTRIES {
            return Some("it names more objects (`entries`) than a scene can have");
        }
        if self.light_groups.len() > MAX_LIGHT_GROUPS {
            return Some("it names more groups of lights (`light_groups`) than a scene can have");
        }
        (self.planes > MAX_PLANES).then_some("it has more layers (`planes`) than a picture can keep")
    }
}

impl std::fmt::Display for Layered {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.wanted.join(","))
    }
}

/// What a part says about itself and the picture that it belongs to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The program that wrote it, with its version.
    pub software: String,
    /// The command that renders the whole picture.
    pub command: String,
    /// Name of the scene.
    pub scene: String,
    /// The frame, which may lie between two.
    #[serde(with = "exact")]
    pub frame: f64,
    /// Width and height of what the camera sees.
    pub size: [u32; 2],
    /// What the finished picture shows of it: everything, or a crop.
    pub region: Rect,
    /// Samples per pixel: as many there will be, or at most as many when noise or time ends the picture.
    pub samples: u32,
    /// When the picture is finished.
    pub stop: Stop,
    /// Whether what is too bright is dimmed; then tiles say what that took away.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub clamped: bool,
    /// What is kept beside radiance.
    #[serde(default, skip_serializing_if = "Layered::is_empty")]
    pub layers: Layered,
    /// Which part of the picture this was to become.
    pub share: Share,
    /// Whether it became that: the picture's rule to stop holds for every tile of the share.
    pub finished: bool,
    /// Named parts of everything that decides a pixel, as texts or hashes.
    pub fingerprint: BTreeMap<String, String>,
    /// The tone curve and its numbers, for the picture's file.
    pub tone: Value,
    /// Texts for the picture's file.
    pub metadata: Vec<(String, String)>,
    /// From where it was taken, for the picture's file.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "viewpoint")]
    pub viewpoint: Option<Viewpoint>,
}

/// What two parts do not have in common though they should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// What it is: `size`, or a name in the fingerprint.
    pub name: String,
    /// What the one has; empty when nothing.
    pub here: String,
    /// What the other has; empty when nothing.
    pub there: String,
}

impl Description {
    /// How the picture is cut into tiles, which chunks are numbered by.
    pub fn layout(&self) -> Layout {
        Layout::new(self.region)
    }

    /// In what another part differs, so that both cannot belong to one picture. Shares, tone curve and texts may
    /// differ.
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
        compare("layers", self.layers.to_string(), other.layers.to_string());
        compare("frames beside", self.layers.beside.clone(), other.layers.beside.clone());
        let names =
            self.fingerprint.keys().chain(other.fingerprint.keys().filter(|k| !self.fingerprint.contains_key(*k)));
        for name in names {
            let value = |of: &Self| of.fingerprint.get(name).cloned().unwrap_or_default();
            compare(name, value(self), value(other));
        }
        found
    }

    /// What is wrong with it in itself; nothing is, in what the program writes.
    pub(super) fn fault(&self) -> Option<&'static str> {
        let Self { size: [width, height], region, share, stop, .. } = self;
        let inside = |start: u32, length: u32, end: u32| start.checked_add(length).is_some_and(|at| at <= end);
        if *width > MAX_EDGE || *height > MAX_EDGE || u64::from(*width) * u64::from(*height) > MAX_PIXELS {
            return Some("its picture is larger than any that can be rendered");
        }
        if let Some(fault) = self.layers.fault() {
            return Some(fault);
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
            return Some("one of its numbers is none");
        }
        if share.index >= share.count {
            return Some("its share is none of those that there are");
        }
        let Range { start, end } = share.samples;
        let between_blocks = start.is_multiple_of(BLOCK) && (end.is_multiple_of(BLOCK) || end == self.samples);
        if start > end || end > self.samples || !between_blocks {
            return Some("its samples are none of the picture's, or not cut between blocks of 16");
        }
        if share.crop.is_some_and(|crop| crop.intersection(region) != crop || whole_tiles(region, &crop) != crop) {
            return Some("its pixels are no whole tiles of its region");
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
            return write!(f, "{}: not the same", shown(&self.name));
        }
        write!(f, "{}: {} instead of {}", shown(&self.name), shown(&self.there), shown(&self.here))
    }
}

/// Whether a text is made of hashes, which tell people nothing.
fn is_hash(text: &str) -> bool {
    let hash = |word: &str| word.len() >= 32 && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    !text.is_empty() && text.split(' ').all(hash)
}

/// Text of a file as a message shows it.
fn shown(text: &str) -> String {
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
