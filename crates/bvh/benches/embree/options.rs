//! Command line: scenes, kinds of rays, kernels, and numbers as `name=value`.

use juggler_bvh::Quality;
use juggler_raybench::Kind;
use juggler_raybench::meshes::{BUILT_IN, MeshSpec};

/// Default scenes, small enough for every run.
const SCENES: [&str; 4] = ["blob", "classroom", "hall", "stadium"];

/// Call that traces the rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// One ray per call.
    Single,
    /// Many incoherent rays per call; only Juggler.
    Batch,
    /// Eight rays per call; in Juggler a tile of packets of eight.
    Packet,
    /// Eight rays per call with the coherent flag; only Embree.
    Coherent,
}

impl Call {
    pub const OURS: [Self; 3] = [Self::Single, Self::Batch, Self::Packet];
    pub const EMBREES: [Self; 3] = [Self::Single, Self::Packet, Self::Coherent];

    /// Whether this call of Juggler is compared with the given call of Embree: single with single,
    /// packets with coherent packets, batches with all.
    pub fn is_comparable_to(self, embrees: Self) -> bool {
        match self {
            Self::Single => embrees == Self::Single,
            Self::Batch => true,
            Self::Packet | Self::Coherent => embrees == Self::Coherent,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Batch => "batch",
            Self::Packet => "packet",
            Self::Coherent => "coherent",
        }
    }
}

/// Options of the benchmark.
pub struct Options {
    pub scenes: Vec<(String, MeshSpec)>,
    pub kinds: Vec<Kind>,
    /// Calls of Juggler; those of Embree follow from the comparisons.
    pub calls: Vec<Call>,
    pub quality: Quality,
    /// Number of camera rays; 0 measures builds only.
    pub rays: usize,
    pub repeats: usize,
    /// Numbers of threads that trace.
    pub threads: Vec<usize>,
    /// Numbers of threads that build; empty for no builds.
    pub build_threads: Vec<usize>,
}

pub const HELP: &str = "words after `--`: scenes (blob, classroom, hall, stadium, hairball, terrain, NAME:SIZE, all),
kinds (primary, shadow, ao, diffuse, diffuse2, random), our kernels (single, batch, packet),
rays=100000 (rays=0: none) repeats=5 threads=1,2 build=1,2 (build=0: none) quality=fast|balanced|best";

impl Options {
    /// Parses all words; those that begin with a dash are cargo's.
    pub fn read(words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut own = Self {
            scenes: Vec::new(),
            kinds: Vec::new(),
            calls: Vec::new(),
            quality: Quality::Balanced,
            rays: 100_000,
            repeats: 5,
            threads: vec![1, 2],
            build_threads: vec![1, 2],
        };
        for word in words.filter(|word| !word.starts_with('-')) {
            match word.split_once('=') {
                Some((name, value)) => own.set(name, value).ok_or_else(|| format!("`{word}`: {HELP}"))?,
                None => own.add(&word)?,
            }
        }
        own.complete()
    }

    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        let numbers = || value.split(',').map(|n| n.parse().ok()).collect::<Option<Vec<usize>>>();
        match name {
            "rays" => self.rays = value.parse().ok()?,
            "repeats" => self.repeats = value.parse().ok().filter(|n| *n > 0)?,
            "threads" => self.threads = numbers()?.into_iter().filter(|n| *n > 0).collect(),
            "build" => self.build_threads = numbers()?.into_iter().filter(|n| *n > 0).collect(),
            "quality" => {
                self.quality = Quality::ALL.into_iter().find(|q| format!("{q:?}").eq_ignore_ascii_case(value))?;
            }
            _ => return None,
        }
        Some(())
    }

    fn add(&mut self, word: &str) -> Result<(), String> {
        if let Some(kind) = Kind::ALL.into_iter().find(|kind| kind.name() == word) {
            self.kinds.push(kind);
        } else if let Some(call) = Call::OURS.into_iter().find(|call| call.name() == word) {
            self.calls.push(call);
        } else if word == "all" {
            BUILT_IN.iter().try_for_each(|kind| self.add(kind.name))?;
        } else {
            let spec = MeshSpec::parse(word).map_err(|error| format!("`{word}`: {error}\n{HELP}"))?;
            self.scenes.push((word.to_owned(), spec));
        }
        Ok(())
    }

    fn complete(mut self) -> Result<Self, String> {
        if self.scenes.is_empty() {
            SCENES.iter().try_for_each(|scene| self.add(scene))?;
        }
        if self.kinds.is_empty() {
            self.kinds = Kind::ALL.to_vec();
        }
        if self.calls.is_empty() {
            self.calls = Call::OURS.to_vec();
        }
        if self.threads.is_empty() {
            self.threads = vec![1];
        }
        Ok(self)
    }
}
