//! What JavaScript sees of the rest. Arrays go over as they are, everything else as JSON; errors are texts.

use crate::board;
use crate::painter;
use crate::patches;
use crate::share::Share;
use juggler_session::Pace as Speed;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
}

/// Runs when the module is loaded: what would be lost goes to the console.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| error(&panic.to_string())));
}

/// The built-in scenes in JSON: `[{"name": ..., "title": ...}, ...]`.
#[wasm_bindgen]
pub fn scenes() -> String {
    crate::scenes()
}

/// Rectangles of pixels on their way.
#[wasm_bindgen]
pub struct Patches(patches::Patches);

#[wasm_bindgen]
impl Patches {
    /// From the two arrays of a message.
    #[wasm_bindgen(constructor)]
    pub fn new(places: Vec<u32>, light: Vec<f32>) -> Self {
        Self(patches::Patches { places, light })
    }

    /// Of each: x, y, width, height, samples.
    pub fn places(&self) -> Vec<u32> {
        self.0.places.clone()
    }

    /// Linear light of all pixels.
    pub fn light(&self) -> Vec<f32> {
        self.0.light.clone()
    }
}

/// A worker's side.
#[wasm_bindgen]
pub struct Painter {
    painter: painter::Painter,
    files: Vec<(String, Vec<u8>)>,
    problem: Option<String>,
}

#[wasm_bindgen]
impl Painter {
    /// The worker `index` of so many.
    #[wasm_bindgen(constructor)]
    pub fn new(index: u32, of: u32) -> Self {
        Self { painter: painter::Painter::new(Share { index, of }), files: Vec::new(), problem: None }
    }

    /// A file for the scene that is opened next.
    #[wasm_bindgen(js_name = addFile)]
    pub fn add_file(&mut self, name: String, bytes: Vec<u8>) {
        self.files.push((name, bytes));
    }

    /// Opens one of the files, or a built-in scene when there are none.
    pub fn open(&mut self, name: &str) -> Result<(), String> {
        self.painter.open(name, std::mem::take(&mut self.files))
    }

    /// Makes changes, an array in JSON. Whether the samples so far are kept.
    pub fn edit(&mut self, edits: &str) -> Result<bool, String> {
        let (kept, problem) = self.painter.edit(edits)?;
        self.problem = problem;
        Ok(kept)
    }

    /// What was wrong with the last changes.
    pub fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    /// Its rows of a coarse frame.
    pub fn coarse(&self, width: u32, height: u32) -> Patches {
        Patches(self.painter.coarse([width, height]))
    }

    /// Renders for so long; the tiles that have become better.
    pub fn refine(&mut self, milliseconds: f64) -> Patches {
        Patches(self.painter.refine(milliseconds, &now))
    }

    /// Whether its tiles have all their samples.
    #[wasm_bindgen(js_name = isFinished)]
    pub fn is_finished(&self) -> bool {
        self.painter.is_finished()
    }

    /// How things stand, in JSON.
    pub fn status(&self) -> String {
        self.painter.status()
    }
}

/// The page's side.
#[wasm_bindgen]
pub struct Board(board::Board);

#[wasm_bindgen]
impl Board {
    /// For the picture of an outline.
    #[wasm_bindgen(constructor)]
    pub fn new(outline: &str) -> Result<Self, String> {
        board::Board::new(outline).map(Self)
    }

    /// The outline has changed, but not the samples so far.
    pub fn resume(&mut self, outline: &str) -> Result<(), String> {
        self.0.resume(outline)
    }

    /// Begins anew with a coarse frame of this size.
    pub fn begin(&mut self, width: u32, height: u32) {
        self.0.begin([width, height]);
    }

    /// Takes rows of the coarse frame.
    #[wasm_bindgen(js_name = putCoarse)]
    pub fn put_coarse(&mut self, patches: &Patches) {
        self.0.put_coarse(&patches.0);
    }

    /// Takes tiles.
    pub fn put(&mut self, patches: &Patches) {
        self.0.put(&patches.0);
    }

    /// Where the bytes of the picture for the screen lie in memory, until the next call of anything.
    pub fn rgba(&self) -> *const u8 {
        self.0.rgba().as_ptr()
    }

    /// The same of the coarse frame.
    #[wasm_bindgen(js_name = coarseRgba)]
    pub fn coarse_rgba(&self) -> *const u8 {
        self.0.coarse_rgba().as_ptr()
    }

    /// The tiles with samples: x, y, width, height of each.
    pub fn tiles(&self) -> Vec<u32> {
        self.0.tiles()
    }

    /// Samples of a pixel, the mean.
    pub fn samples(&self) -> f64 {
        self.0.samples()
    }

    /// Whether every tile has its samples.
    #[wasm_bindgen(js_name = isFinished)]
    pub fn is_finished(&self) -> bool {
        self.0.is_finished()
    }

    /// The hash of the finished film.
    pub fn hash(&self) -> Option<String> {
        self.0.hash()
    }

    /// The picture as a PNG file.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        self.0.png()
    }
}

/// How coarse a frame must be to be ready in time.
#[wasm_bindgen]
#[derive(Default)]
pub struct Pace(Speed);

#[wasm_bindgen]
impl Pace {
    /// Nothing is known yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// A frame of so many pixels took so many seconds.
    pub fn learn(&mut self, pixels: f64, seconds: f64) {
        self.0.learn(pixels, seconds);
    }

    /// The edge of the squares that stand for one pixel, for a picture that is to be ready in `budget` seconds.
    pub fn coarseness(&self, width: u32, height: u32, budget: f64) -> u32 {
        self.0.coarseness([width, height], budget)
    }
}
