//! Files of backgrounds and lights, each read once, and prepared backgrounds.

use super::file_cache::{CachedFile, FileCache};
use super::images::{IMAGE_LIMITS, infinity_warning};
use super::meshes::{AssetCache, Files};
use super::picture_estimate::Estimate;
use crate::description::{BackgroundInput, Description};
use crate::item::Item;
use crate::path::Path;
use crate::report::Finding;
use crate::store::{MAX_FILE_BYTES, Store};
use juggler_light::background::{AnyBackground, Panorama};
use juggler_light::{AnyLight, IesProfile};
use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Maximum size of a photometric file, in bytes. Typical files have a few thousand.
const MAX_PROFILE_BYTES: u64 = 16 << 20;

/// Number of prepared skies in the cache: a check precedes compilation, and frames are compiled in
/// parallel.
const MAX_PREPARED_SKIES: usize = 4;

/// Purpose of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// Environment map.
    Panorama,
    /// Photometric profile (IES): intensity of a light by direction.
    Profile,
}

/// Cache of files and prepared backgrounds.
#[derive(Clone, Debug, Default)]
pub struct LightFiles {
    panoramas: FileCache<Panorama>,
    profiles: FileCache<IesProfile>,
    /// Descriptions of skies with their prepared form, the newest last.
    prepared_skies: Arc<Mutex<Vec<(AnyBackground, AnyBackground)>>>,
}

impl LightFiles {
    /// Cache without the files that have changed.
    pub fn without_changed_files(&self) -> Self {
        let (panoramas, profiles) = (self.panoramas.without_changed_files(), self.profiles.without_changed_files());
        Self { panoramas, profiles, prepared_skies: Arc::clone(&self.prepared_skies) }
    }

    /// Prepared form of a background in the cache.
    fn prepared(&self, background: &AnyBackground) -> Option<AnyBackground> {
        let prepared_skies = self.prepared_skies.lock().unwrap_or_else(PoisonError::into_inner);
        prepared_skies.iter().find(|(description, _)| description == background).map(|(_, prepared)| prepared.clone())
    }

    fn insert_prepared(&self, description: AnyBackground, prepared: AnyBackground) {
        let mut prepared_skies = self.prepared_skies.lock().unwrap_or_else(PoisonError::into_inner);
        if prepared_skies.len() >= MAX_PREPARED_SKIES {
            prepared_skies.remove(0);
        }
        prepared_skies.push((description, prepared));
    }
}

impl AssetCache {
    fn panorama(&self, path: &std::path::Path) -> Arc<CachedFile<Panorama>> {
        let shown = self.store().assets.origin(path);
        let panorama = |image| Panorama::new(image).map_err(|wrong| format!("`{shown}` {wrong}"));
        if let Some((image, digest)) = self.store().assets.image_at(path) {
            return self.light_files().panoramas.insert_asset(path, digest, || panorama(image.clone()));
        }
        if let Some((texels, digest)) = self.store().assets.texels_at(path) {
            let ([width, height], raster) = (texels.size(), texels.raster());
            let image = || juggler_math::Image::from_pixels(width, height, raster.to_pixels());
            let empty = || format!("`{shown}`: contains no image");
            let make = || panorama(image().ok_or_else(empty)?);
            return self.light_files().panoramas.insert_asset(path, digest, make);
        }
        self.light_files().panoramas.load(path, self.store(), MAX_FILE_BYTES, |bytes| {
            let image = juggler_imaging::decode(&shown, Cursor::new(bytes), &IMAGE_LIMITS);
            panorama(image.map_err(|error| error.to_string())?)
        })
    }

    fn profile(&self, path: &std::path::Path) -> Arc<CachedFile<IesProfile>> {
        let shown = self.store().assets.origin(path);
        self.light_files().profiles.load(path, self.store(), MAX_PROFILE_BYTES, |bytes| {
            // Decode lossily: old files contain names in local encodings, but the numbers are
            // ASCII.
            let wrong = |error| format!("cannot read `{shown}`: {error}");
            IesProfile::parse(&String::from_utf8_lossy(bytes)).map_err(wrong)
        })
    }

    /// Hash of a file's content; zeros for a file that cannot be read, which compilation reports.
    pub fn light_digest(&self, path: &std::path::Path, purpose: Purpose) -> [u8; 32] {
        match purpose {
            Purpose::Panorama => self.panorama(path).digest,
            Purpose::Profile => self.profile(path).digest,
        }
    }
}

fn background_path(background: &AnyBackground) -> Path {
    Path::root().key("background").key(background.name())
}

fn light_file_path(number: usize, light: &AnyLight) -> Path {
    Path::root().key("lights").index(number).key(light.name()).key("ies").key("file")
}

/// Files that a scene's background and lights name, each once.
pub fn files(scene: &Description, files: &Files<'_>) -> BTreeSet<(PathBuf, Purpose)> {
    let mut found = BTreeSet::new();
    if let Some(BackgroundInput::Kind(background @ AnyBackground::Environment(environment))) =
        scene.background.as_deref()
    {
        let path = background_path(background).key("file");
        found.insert((files.locate(&path, &environment.file), Purpose::Panorama));
    }
    for (i, light) in scene.lights.iter().enumerate() {
        if let Some(ies) = (**light).clone().ies() {
            found.insert((files.locate(&light_file_path(i, light), &ies.file), Purpose::Profile));
        }
    }
    found
}

/// Lights with the content of their files.
pub fn lights(lights: &[Item<AnyLight>], files: Files<'_>, findings: &mut Vec<Finding>) -> Vec<AnyLight> {
    lights.iter().enumerate().map(|(i, light)| load_light(i, light, files, findings)).collect()
}

/// Light `i` with the content of its file.
pub fn load_light(i: usize, light: &AnyLight, files: Files<'_>, findings: &mut Vec<Finding>) -> AnyLight {
    let mut light = light.clone();
    // Build the path only if necessary: a scene may have a million lights.
    if light.ies().is_some() && !files.control.is_cancelled() {
        let path = light_file_path(i, &light);
        if let Some(ies) = light.ies() {
            match &files.asset_cache.profile(&files.locate(&path, &ies.file)).content {
                Ok(profile) => ies.set_profile(Arc::clone(profile)),
                Err(message) => findings.push(Finding::error(message.clone()).at(&path)),
            }
        }
    }
    light
}

/// Prepared background of the scene; `None` if the scene has none or an invalid one.
pub fn background(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Option<AnyBackground> {
    files.control.check().ok()?;
    let mut background = AnyBackground::from(scene.background.clone()?.into_inner());
    let path = background_path(&background);
    if let AnyBackground::Environment(environment) = &mut background {
        let path = path.key("file");
        match &files.asset_cache.panorama(&files.locate(&path, &environment.file)).content {
            Ok(panorama) => {
                if let Some(message) = infinity_warning(&environment.file, panorama.infinite_pixels() as u64) {
                    findings.push(Finding::warning(message).at(&path));
                }
                environment.set_panorama(Arc::clone(panorama));
            }
            Err(message) => {
                findings.push(Finding::error(message.clone()).at(&path));
                return None;
            }
        }
    }
    files.control.check().ok()?;
    let is_expensive = matches!(background, AnyBackground::Sky(_));
    let light_files = files.asset_cache.light_files();
    if let Some(prepared) = is_expensive.then(|| light_files.prepared(&background)).flatten() {
        return Some(prepared);
    }
    let description = is_expensive.then(|| background.clone());
    if let Err(invalid) = background.prepare() {
        findings.push(Finding::error(invalid.message).at(path.join(invalid.field)));
        return None;
    }
    description.into_iter().for_each(|description| light_files.insert_prepared(description, background.clone()));
    Some(background)
}

/// Upper bound of the memory for an environment map, from the head of its file or asset; zero for a
/// file that cannot be read.
pub fn estimate(path: &std::path::Path, store: &Store) -> Estimate {
    let Some((head, length)) = store.picture_head(path, &IMAGE_LIMITS) else { return Estimate::default() };
    let pixels = u64::from(head.layout.width) * u64::from(head.layout.height);
    // At the peak, decoders hold 8 bytes per pixel; later, three floats per pixel await the table.
    let resident_bytes = Panorama::bytes(pixels as usize) as u64 + 8 * u64::from(head.layout.height) + 4096;
    Estimate { resident_bytes, peak_bytes: resident_bytes + 12 * pixels + length }
}
