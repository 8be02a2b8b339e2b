//! Small pictures of the built-in scenes, rendered one after another on a thread of its own that stands back for all
//! others, only while somebody looks at them, and kept.

use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use juggler::Settings;
use juggler::scene::{BuiltIn, Scene, built_in_scenes};
use juggler_session::screen::Toner;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Longest edge in pixels.
const EDGE: u32 = 288;
/// Samples of a pixel.
const SAMPLES: u32 = 8;

/// Those that are there, and the thread that makes more.
#[derive(Default)]
pub struct Thumbnails {
    pictures: HashMap<&'static str, TextureHandle>,
    work: Option<Work>,
}

struct Work {
    go_on: Arc<AtomicBool>,
    pictures: Receiver<(&'static str, ColorImage)>,
}

impl Drop for Work {
    fn drop(&mut self) {
        self.go_on.store(false, Relaxed);
    }
}

impl Thumbnails {
    /// Goes on making them; to be called whenever they are looked at.
    pub fn make(&mut self, context: &Context) {
        if self.work.is_none() && self.pictures.len() < built_in_scenes().len() {
            let missing = built_in_scenes().iter().filter(|scene| !self.pictures.contains_key(scene.name));
            self.work = start(missing.copied().collect(), context.clone());
        }
        let Some(work) = &self.work else { return };
        for (name, image) in work.pictures.try_iter() {
            let picture = context.load_texture(name, image, TextureOptions::LINEAR);
            self.pictures.insert(name, picture);
        }
    }

    /// Makes no more until they are looked at again.
    pub fn rest(&mut self) {
        self.work = None;
    }

    /// The one of a scene, if it is there.
    pub fn of(&self, name: &str) -> Option<&TextureHandle> {
        self.pictures.get(name)
    }
}

fn start(scenes: Vec<BuiltIn>, context: Context) -> Option<Work> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).start_handler(|_| stand_back()).build().ok()?;
    let go_on = Arc::new(AtomicBool::new(true));
    let (sender, pictures) = channel();
    let work = Work { go_on: go_on.clone(), pictures };
    let render = move || pool.install(|| render_all(&scenes, &go_on, &sender, &context));
    std::thread::Builder::new().name("thumbnails".into()).spawn(render).ok()?;
    Some(work)
}

fn render_all(scenes: &[BuiltIn], go_on: &AtomicBool, sender: &Sender<(&'static str, ColorImage)>, context: &Context) {
    for scene in scenes {
        if !go_on.load(Relaxed) {
            return;
        }
        if let Some(image) = render(scene)
            && sender.send((scene.name, image)).is_ok()
        {
            context.request_repaint();
        }
    }
}

fn render(scene: &BuiltIn) -> Option<ColorImage> {
    let scene = Scene::built_in(scene.name).ok()?;
    let [width, height] = scene.description.render.size;
    let scale = EDGE as f32 / width.max(height).max(1) as f32;
    let size = [width, height].map(|edge| ((edge as f32 * scale) as u32).max(1));
    let settings = Settings { size: Some(size), samples: Some(SAMPLES), ..Settings::default() };
    let image = juggler::render(&scene, &settings).ok()?;
    let toner = Toner::new(&scene.description.tone);
    let color = |pixel: &juggler::math::Rgb| {
        let [r, g, b, _] = toner.rgba(*pixel);
        Color32::from_rgb(r, g, b)
    };
    Some(ColorImage::new(size.map(|edge| edge as usize), image.pixels().iter().map(color).collect()))
}

/// The lowest priority, where a thread can have one of its own.
fn stand_back() {
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, 19);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_picture_has_the_scenes_shape() {
        let scene = built_in_scenes().iter().find(|scene| scene.name == "one-sphere").unwrap();
        let image = render(scene).unwrap();
        assert_eq!(image.size.iter().max(), Some(&(EDGE as usize)));
        assert_eq!(image.pixels.len(), image.size[0] * image.size[1]);
        assert!(image.pixels.iter().any(|pixel| pixel.r() > 100));
    }

    #[test]
    fn no_more_are_made_when_nobody_looks() {
        let context = Context::default();
        let mut thumbnails = Thumbnails::default();
        thumbnails.make(&context);
        let go_on = thumbnails.work.as_ref().unwrap().go_on.clone();
        thumbnails.rest();
        assert!(!go_on.load(Relaxed));
    }
}
