//! What light comes from: files of backgrounds and lights, each read once, and backgrounds that are ready to be used.

use super::images::{Estimate, MAX_PICTURE, MAX_TEXELS};
use super::meshes::{Files, Library};
use super::shelf::{Shelf, Shelved};
use crate::description::{Backdrop, Description};
use crate::import::Limits;
use crate::item::Item;
use crate::kind::name_of;
use crate::path::Path;
use crate::report::Finding;
use juggler_imaging::raster::inspect_raster;
use juggler_light::background::{AnyBackground, Panorama};
use juggler_light::{AnyLight, Profile};
use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Most bytes of a photometric file; real ones have a few thousand.
const MAX_PROFILE_BYTES: u64 = 16 << 20;

/// Skies that are kept when they are ready: what is checked is compiled next, and frames are made side by side.
const KEPT: usize = 4;

/// What a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// A picture of everything around.
    Panorama,
    /// How strongly a lamp shines into each direction.
    Profile,
}

/// What was read and prepared so far.
#[derive(Clone, Debug, Default)]
pub struct Lighting {
    panoramas: Shelf<Panorama>,
    profiles: Shelf<Profile>,
    /// Descriptions with what they are when prepared, the newest last.
    skies: Arc<Mutex<Vec<(AnyBackground, AnyBackground)>>>,
}

impl Lighting {
    /// Without files that have changed.
    pub fn renewed(&self) -> Self {
        let (panoramas, profiles) = (self.panoramas.renewed(), self.profiles.renewed());
        Self { panoramas, profiles, skies: Arc::clone(&self.skies) }
    }

    /// A prepared one of before.
    fn ready(&self, background: &AnyBackground) -> Option<AnyBackground> {
        let skies = self.skies.lock().unwrap_or_else(PoisonError::into_inner);
        skies.iter().find(|(description, _)| description == background).map(|(_, ready)| ready.clone())
    }

    fn keep(&self, description: AnyBackground, ready: AnyBackground) {
        let mut skies = self.skies.lock().unwrap_or_else(PoisonError::into_inner);
        if skies.len() >= KEPT {
            skies.remove(0);
        }
        skies.push((description, ready));
    }
}

impl Library {
    fn panorama(&self, path: &std::path::Path) -> Arc<Shelved<Panorama>> {
        let shown = path.display();
        let panorama = |image| Panorama::new(image).map_err(|wrong| format!("`{shown}` {wrong}"));
        if let Some((image, digest)) = self.store().assets.image_at(path) {
            return self.lighting().panoramas.keep(path, digest, || panorama(image.clone()));
        }
        self.lighting().panoramas.load(path, self.store(), &Limits::default(), |bytes| {
            let image = juggler_imaging::decode(&shown.to_string(), Cursor::new(bytes), &MAX_PICTURE);
            panorama(image.map_err(|error| error.to_string())?)
        })
    }

    fn profile(&self, path: &std::path::Path) -> Arc<Shelved<Profile>> {
        let shown = path.display();
        let limits = Limits { file_bytes: MAX_PROFILE_BYTES, ..Limits::default() };
        self.lighting().profiles.load(path, self.store(), &limits, |bytes| {
            // Old files have names in the letters of their country: only what is between them counts.
            let wrong = |error| format!("cannot read `{shown}`: {error}");
            Profile::read(&String::from_utf8_lossy(bytes)).map_err(wrong)
        })
    }

    /// The hash of a file's content; zeros for a file that cannot be read, which compiling reports.
    pub fn light_digest(&self, path: &std::path::Path, purpose: Purpose) -> [u8; 32] {
        match purpose {
            Purpose::Panorama => self.panorama(path).digest,
            Purpose::Profile => self.profile(path).digest,
        }
    }
}

fn of_background(background: &AnyBackground) -> Path {
    Path::root().key("background").key(name_of(background))
}

fn of_light(number: usize, light: &AnyLight) -> Path {
    Path::root().key("lights").index(number).key(name_of(light)).key("ies").key("file")
}

/// The files that a scene's background and lights name, each once.
pub fn files(scene: &Description, files: &Files<'_>) -> BTreeSet<(PathBuf, Purpose)> {
    let mut found = BTreeSet::new();
    if let Some(Backdrop::Kind(background @ AnyBackground::Environment(environment))) = scene.background.as_deref() {
        let path = of_background(background).key("file");
        found.insert((files.locate(&path, &environment.file), Purpose::Panorama));
    }
    for (i, light) in scene.lights.iter().enumerate() {
        if let Some(ies) = (**light).clone().ies() {
            found.insert((files.locate(&of_light(i, light), &ies.file), Purpose::Profile));
        }
    }
    found
}

/// Lights with what their files hold.
pub fn lights(lights: &[Item<AnyLight>], files: Files<'_>, findings: &mut Vec<Finding>) -> Vec<AnyLight> {
    lights.iter().enumerate().map(|(i, light)| loaded(i, light, files, findings)).collect()
}

/// Light number `i` with what its file holds.
pub fn loaded(i: usize, light: &AnyLight, files: Files<'_>, findings: &mut Vec<Finding>) -> AnyLight {
    let mut light = light.clone();
    // The path is made only where it is needed: a scene may have a million lights.
    if light.ies().is_some() {
        let path = of_light(i, &light);
        if let Some(ies) = light.ies() {
            match &files.library.profile(&files.locate(&path, &ies.file)).content {
                Ok(profile) => ies.set_profile(Arc::clone(profile)),
                Err(message) => findings.push(Finding::error(message.clone()).at(&path)),
            }
        }
    }
    light
}

/// The scene's background, ready to be used; nothing when there is none, or one that cannot be.
pub fn background(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Option<AnyBackground> {
    let mut background = AnyBackground::from(scene.background.clone()?.into_inner());
    let path = of_background(&background);
    if let AnyBackground::Environment(environment) = &mut background {
        let path = path.key("file");
        match &files.library.panorama(&files.locate(&path, &environment.file)).content {
            Ok(panorama) => environment.set_panorama(Arc::clone(panorama)),
            Err(message) => {
                findings.push(Finding::error(message.clone()).at(&path));
                return None;
            }
        }
    }
    let dear = matches!(background, AnyBackground::Sky(_));
    let lighting = files.library.lighting();
    if let Some(ready) = dear.then(|| lighting.ready(&background)).flatten() {
        return Some(ready);
    }
    let description = dear.then(|| background.clone());
    if let Err(invalid) = background.prepare() {
        findings.push(Finding::error(invalid.message).at(path.join(invalid.field)));
        return None;
    }
    description.into_iter().for_each(|description| lighting.keep(description, background.clone()));
    Some(background)
}

/// What a picture of everything around takes at most, by its head. Nothing for a file that cannot be read.
pub fn estimate(path: &std::path::Path) -> Estimate {
    let Ok(layout) = inspect_raster(path) else { return Estimate::default() };
    let pixels = u64::from(layout.width) * u64::from(layout.height);
    if pixels > MAX_TEXELS {
        return Estimate::default();
    }
    // Beside what stays, decoders hold 8 bytes a pixel; then there are three numbers for each on their way to the table.
    let kept = Panorama::bytes(pixels as usize) as u64 + 8 * u64::from(layout.height) + 4096;
    let file = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    Estimate { kept, peak: kept + 12 * pixels + file }
}
