//! JavaScript interface of the module. Arrays are passed as typed arrays, everything else as JSON;
//! errors are strings.

use crate::compositor;
use crate::pixel_rects;
use crate::renderer;
use crate::share::WorkerShare;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
}

/// Reports panics to the console; runs when the module is loaded.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| error(&panic.to_string())));
}

/// Returns the built-in scenes in JSON: `[{"name": ..., "title": ...}, ...]`.
#[wasm_bindgen]
pub fn scenes() -> String {
    crate::scenes()
}

/// Rectangles of pixels in transfer.
#[wasm_bindgen]
pub struct PixelRects(pixel_rects::PixelRects);

#[wasm_bindgen]
impl PixelRects {
    /// Creates the rectangles from the two arrays of a message.
    #[wasm_bindgen(constructor)]
    pub fn new(bounds: Vec<u32>, radiance: Vec<f32>) -> Self {
        Self(pixel_rects::PixelRects { bounds, radiance })
    }

    /// Returns x, y, width, height and number of samples of each rectangle.
    pub fn bounds(&self) -> Vec<u32> {
        self.0.bounds.clone()
    }

    /// Returns the linear RGB radiance of all pixels.
    pub fn radiance(&self) -> Vec<f32> {
        self.0.radiance.clone()
    }
}

/// Renderer of a worker.
#[wasm_bindgen]
pub struct WorkerRenderer {
    renderer: renderer::WorkerRenderer,
    files: Vec<(String, Vec<u8>)>,
    problem: Option<String>,
}

#[wasm_bindgen]
impl WorkerRenderer {
    /// Creates the worker `index` of `count` workers.
    #[wasm_bindgen(constructor)]
    pub fn new(index: u32, count: u32) -> Self {
        Self { renderer: renderer::WorkerRenderer::new(WorkerShare { index, count }), files: Vec::new(), problem: None }
    }

    /// Adds a file for the scene that is opened next.
    #[wasm_bindgen(js_name = addFile)]
    pub fn add_file(&mut self, name: String, bytes: Vec<u8>) {
        self.files.push((name, bytes));
    }

    /// Opens one of the added files, or a built-in scene if there are none.
    pub fn open(&mut self, name: &str) -> Result<(), String> {
        self.renderer.open(name, std::mem::take(&mut self.files))
    }

    /// Applies edits, an array in JSON. Returns whether the samples so far are kept.
    pub fn edit(&mut self, edits: &str) -> Result<bool, String> {
        let (kept, problem) = self.renderer.edit(edits)?;
        self.problem = problem;
        Ok(kept)
    }

    /// Returns the error of the last edits.
    pub fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    /// Renders the worker's rows of a coarse frame.
    pub fn coarse(&self, width: u32, height: u32) -> PixelRects {
        PixelRects(self.renderer.coarse([width, height]))
    }

    /// Renders for some milliseconds, and returns the updated tiles.
    pub fn refine(&mut self, milliseconds: f64) -> PixelRects {
        PixelRects(self.renderer.refine(milliseconds, &now))
    }

    /// Returns whether the worker's tiles have all their samples.
    #[wasm_bindgen(js_name = isFinished)]
    pub fn is_finished(&self) -> bool {
        self.renderer.is_finished()
    }

    /// Returns the status in JSON.
    pub fn status(&self) -> String {
        self.renderer.status()
    }
}

/// Compositor of the page.
#[wasm_bindgen]
pub struct Compositor(compositor::Compositor);

#[wasm_bindgen]
impl Compositor {
    /// Creates a compositor for an image, described by an `RenderInfo` in JSON.
    #[wasm_bindgen(constructor)]
    pub fn new(info: &str) -> Result<Self, String> {
        compositor::Compositor::new(info).map(Self)
    }

    /// Adopts another description that keeps the samples so far.
    pub fn resume(&mut self, info: &str) -> Result<(), String> {
        self.0.resume(info)
    }

    /// Starts over with a coarse frame of this size.
    pub fn restart(&mut self, width: u32, height: u32) {
        self.0.restart([width, height]);
    }

    /// Copies rows of the coarse frame.
    #[wasm_bindgen(js_name = addCoarseRows)]
    pub fn add_coarse_rows(&mut self, rects: &PixelRects) {
        self.0.add_coarse_rows(&rects.0);
    }

    /// Copies tiles.
    #[wasm_bindgen(js_name = addTiles)]
    pub fn add_tiles(&mut self, rects: &PixelRects) {
        self.0.add_tiles(&rects.0);
    }

    /// Returns the address of the image's RGBA pixels in memory, valid until the next call into the
    /// module.
    pub fn rgba(&self) -> *const u8 {
        self.0.rgba().as_ptr()
    }

    /// Returns the address of the coarse frame's RGBA pixels in memory.
    #[wasm_bindgen(js_name = coarseRgba)]
    pub fn coarse_rgba(&self) -> *const u8 {
        self.0.coarse_rgba().as_ptr()
    }

    /// Returns x, y, width and height of each tile that has samples.
    pub fn tiles(&self) -> Vec<u32> {
        self.0.tiles()
    }

    /// Returns the mean number of samples per pixel.
    pub fn samples(&self) -> f64 {
        self.0.samples()
    }

    /// Returns whether every tile has all its samples.
    #[wasm_bindgen(js_name = isFinished)]
    pub fn is_finished(&self) -> bool {
        self.0.is_finished()
    }

    /// Returns the hash of the finished image.
    pub fn hash(&self) -> Option<String> {
        self.0.hash()
    }

    /// Encodes the image as a PNG file.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        self.0.png()
    }
}

/// Adaptive resolution of coarse frames.
#[wasm_bindgen]
#[derive(Default)]
pub struct RenderRate(juggler_session::RenderRate);

#[wasm_bindgen]
impl RenderRate {
    /// Creates an estimate without measurements.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Updates the estimate: `pixels` were rendered in `seconds`.
    pub fn measure(&mut self, pixels: f64, seconds: f64) {
        self.0.measure(pixels, seconds);
    }

    /// Returns the pixel block edge length with which an image is expected to render within
    /// `budget` seconds.
    pub fn coarseness(&self, width: u32, height: u32, budget: f64) -> u32 {
        self.0.coarseness([width, height], budget)
    }
}
