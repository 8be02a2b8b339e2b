//! Thumbnail textures of the built-in scenes, decoded when they first come into view.

use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use juggler::imaging::{Limits, RasterSamples, decode_raster};
use std::collections::HashMap;
use std::io::Cursor;

/// Textures by scene name; `None` for a thumbnail that cannot be decoded.
#[derive(Default)]
pub struct Thumbnails(HashMap<&'static str, Option<TextureHandle>>);

impl Thumbnails {
    /// Returns the thumbnail of a built-in scene.
    pub fn get(&mut self, name: &'static str, context: &Context) -> Option<&TextureHandle> {
        let load = || image(name).map(|image| context.load_texture(name, image, TextureOptions::LINEAR));
        self.0.entry(name).or_insert_with(load).as_ref()
    }
}

fn image(name: &str) -> Option<ColorImage> {
    let file = juggler_session::thumbnail(name)?;
    let raster = decode_raster(name, Cursor::new(file), &Limits::default()).ok()?;
    let RasterSamples::Bytes(levels) = raster.samples else { return None };
    let size = [raster.layout.width, raster.layout.height].map(|edge| edge as usize);
    let color = |pixel: &[u8]| match *pixel {
        [red, green, blue] => Color32::from_rgb(red, green, blue),
        [gray] => Color32::from_gray(gray),
        _ => Color32::BLACK,
    };
    let pixels: Vec<Color32> = levels.chunks(usize::from(raster.layout.channels).max(1)).map(color).collect();
    (pixels.len() == size[0] * size[1]).then(|| ColorImage::new(size, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler::scene::built_in_scenes;

    #[test]
    fn every_built_in_scene_has_a_picture_at_once() {
        for scene in built_in_scenes() {
            let image = image(scene.name).unwrap_or_else(|| panic!("{}", scene.name));
            assert_eq!(image.size.iter().max(), Some(&208));
            assert!(image.pixels.iter().any(|pixel| *pixel != Color32::BLACK), "{}", scene.name);
        }
        assert!(image("no-such-scene").is_none());
    }

    #[test]
    fn pictures_are_decoded_once() {
        let (context, mut thumbnails) = (Context::default(), Thumbnails::default());
        let first = thumbnails.get("juggler", &context).map(TextureHandle::id);
        assert!(first.is_some());
        assert_eq!(thumbnails.get("juggler", &context).map(TextureHandle::id), first);
    }
}
