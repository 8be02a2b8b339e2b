//! Checks of images, samplers and textures.

use super::checker::{Checker, FINITE};
use crate::gltf::document::{Index, TextureInfo};
use crate::gltf::location::Location;
use crate::gltf::uri::Uri;

impl Checker<'_> {
    /// Checks images and textures.
    pub(super) fn images(&mut self) {
        let document = self.document;
        let list = Location::root("images");
        for (position, image) in document.images.iter().enumerate() {
            self.data(&list.index(position), image.uri.as_deref(), image.buffer_view);
        }
        let list = Location::root("textures");
        for (position, texture) in document.textures.iter().enumerate() {
            let at = list.index(position);
            self.index(&at.key("sampler"), texture.sampler, document.samplers.len(), "sampler");
            self.index(&at.key("source"), texture.source, document.images.len(), "image");
            let alternatives =
                [("KHR_texture_basisu", texture.extensions.basisu), ("EXT_texture_webp", texture.extensions.webp)];
            for (name, alternative) in alternatives {
                let extensions = at.key("extensions");
                let extension = extensions.key(name);
                let source = alternative.and_then(|alternative| alternative.source);
                self.index(&extension.key("source"), source, document.images.len(), "image");
            }
        }
    }

    /// Checks that an object has one source of data: a URI or a buffer view.
    pub(super) fn data(&mut self, at: &Location<'_>, uri: Option<&str>, view: Option<Index>) {
        self.index(&at.key("bufferView"), view, self.document.buffer_views.len(), "bufferView");
        match (uri, view) {
            (None, None) => self.fault(at, format_args!("has neither `uri` nor `bufferView`")),
            (Some(_), Some(_)) => self.fault(at, format_args!("has both `uri` and `bufferView`")),
            (Some(uri), None) => {
                if let Err(error) = Uri::parse(uri) {
                    self.fault(&at.key("uri"), format_args!("{error}"));
                }
            }
            (None, Some(_)) => {}
        }
    }

    /// Checks a reference to a texture.
    pub(super) fn texture(&mut self, at: &Location<'_>, info: Option<&TextureInfo>) {
        let Some(info) = info else { return };
        self.index(&at.key("index"), info.index, self.document.textures.len(), "texture");
        self.number(&at.key("scale"), info.scale, &FINITE);
        let Some(transform) = &info.extensions.transform else { return };
        let extensions = at.key("extensions");
        let extension = extensions.key("KHR_texture_transform");
        self.numbers(&extension.key("offset"), &transform.offset, &FINITE);
        self.numbers(&extension.key("scale"), &transform.scale, &FINITE);
        self.number(&extension.key("rotation"), transform.rotation, &FINITE);
    }
}
