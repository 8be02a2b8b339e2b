//! Pictures and light profiles of a file, which are read when it is opened. Exif data turns pictures,
//! as in viewers that run in a browser.

use super::Files;
use super::data::GltfData;
use super::document::{Document, IesProfile, Index};
use super::error::{Fault, GltfError};
use super::ktx2;
use juggler_imaging::{Limits as ImageLimits, decode_raster, raster_head};
use juggler_math::BuildControl;
use juggler_scene::Asset;
use juggler_scene::PictureReading;
use std::io::Cursor;
use std::sync::OnceLock;

/// First bytes of a KTX2 file.
pub const KTX2: &[u8] = b"\xabKTX 20\xbb";
/// Maximum number of texels of a picture.
pub const MAX_TEXELS: u64 = 1 << 28;

/// Maximum number of further pictures that a warning names.
const MAX_NAMED: usize = 3;

/// Contents of pictures and light profiles by index; `None` where nothing uses them.
#[derive(Debug, Default)]
pub struct Media {
    images: Vec<Option<Asset>>,
    /// Pictures in other formats that take the place of KTX2 pictures, each made at its first use.
    replacements: Vec<OnceLock<Result<Asset, Fault>>>,
    /// Whether pictures may be missing although textures use them.
    is_lenient: bool,
    profiles: Vec<Option<Asset>>,
}

impl Media {
    /// Bytes of the pictures and profiles.
    pub fn bytes(&self) -> u64 {
        let assets = self.images.iter().chain(&self.profiles).flatten();
        assets.filter_map(Asset::bytes).map(|bytes| bytes.len() as u64).fold(0, u64::saturating_add)
    }
}

/// How the pictures of a file are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Use {
    /// A texture or a light uses the picture.
    is_used: bool,
    /// Each texture that uses the picture has another one in its place.
    is_replaceable: bool,
}

impl GltfData {
    /// Reads the pictures that textures and lights use, and the light profiles.
    ///
    /// # Errors
    ///
    /// A file is missing or too large, or a data URI is not valid. A picture may be missing if all
    /// its textures have one in another format, or if the files are lenient. All faults are reported
    /// at once. If `control` is cancelled, pictures are missing.
    pub fn load_media(&mut self, files: &dyn Files, control: &BuildControl) -> Result<(), GltfError> {
        let (mut faults, mut lost, is_lenient) = (Vec::new(), Vec::new(), files.is_lenient());
        let mut keep = |result: Result<Asset, Fault>, is_replaceable: bool| match result {
            Ok(asset) => Some(asset),
            Err(fault) => {
                if !is_replaceable {
                    faults.push(fault);
                }
                None
            }
        };
        let document = &self.gltf.document;
        let uses = uses(document).into_iter().enumerate();
        let images = uses.map(|(index, Use { is_used, is_replaceable })| {
            control.check().ok()?;
            let index = Index::from(u32::try_from(index).ok()?);
            if !is_used || !is_lenient {
                return is_used.then(|| keep(self.picture(index, files), is_replaceable)).flatten();
            }
            self.checked_picture(index, files).map_err(|fault| lost.push(fault)).ok()
        });
        let images: Vec<Option<Asset>> = images.collect();
        let replacements = images.iter().map(|_| OnceLock::new()).collect();
        let profiles = document.extensions.lights_ies.iter().flat_map(|lights| &lights.lights).enumerate();
        let profiles = profiles.map(|(index, profile)| keep(self.profile(index, profile, files), false)).collect();
        if !faults.is_empty() {
            let omitted = faults.len().saturating_sub(self.gltf.limits.faults);
            faults.truncate(self.gltf.limits.faults.max(1));
            return Err(GltfError { file: self.gltf.name.clone(), faults, omitted });
        }
        self.media = Media { images, replacements, is_lenient, profiles };
        if let Some((first, others)) = lost.split_first() {
            let text = format!("the picture is shown gray{}", and_others(others));
            self.gltf.warnings.add(first, text, 1);
        }
        Ok(())
    }

    /// Reads a picture.
    fn picture(&self, index: Index, files: &dyn Files) -> Result<Asset, Fault> {
        let origin = format!("{}: {}", self.gltf.name, self.image_place(index));
        Ok(Asset::from_bytes(self.image(index, files)?.into_owned()).with_origin(origin))
    }

    /// Reads a picture, and checks that it can be decoded.
    fn checked_picture(&self, index: Index, files: &dyn Files) -> Result<Asset, Fault> {
        let asset = self.picture(index, files)?;
        let checked = check_picture(&self.image_name(index), asset.bytes().unwrap_or_default(), files.pictures());
        checked.map(|()| asset).map_err(|error| Fault::at(self.image_place(index), error))
    }

    /// Reads a light profile.
    fn profile(&self, index: usize, profile: &IesProfile, files: &dyn Files) -> Result<Asset, Fault> {
        let at = format!("/extensions/EXT_lights_ies/lights/{index}");
        let bytes = self.data(&at, profile.uri.as_deref(), profile.buffer_view, files)?;
        Ok(Asset::from_bytes(bytes.into_owned()))
    }

    /// Content of a picture that [`GltfData::load_media`] has read.
    pub fn image_asset(&self, image: usize) -> Option<Asset> {
        self.media.images.get(image).cloned().flatten()
    }

    /// Picture in another format that takes the place of a picture, which `convert` makes once.
    ///
    /// # Errors
    ///
    /// The picture cannot be decoded.
    pub fn image_replacement(
        &self,
        image: usize,
        convert: impl FnOnce() -> Result<Asset, Fault>,
    ) -> Result<Asset, Fault> {
        match self.media.replacements.get(image) {
            Some(known) => known.get_or_init(convert).clone(),
            None => convert(),
        }
    }

    /// Whether a picture is missing or broken and lenient files allow it.
    pub fn is_lost(&self, image: usize) -> bool {
        self.media.is_lenient && self.media.images.get(image).is_some_and(Option::is_none)
    }

    /// Content of a light profile that [`GltfData::load_media`] has read.
    pub fn profile_asset(&self, profile: usize) -> Option<Asset> {
        self.media.profiles.get(profile).cloned().flatten()
    }
}

/// Names the places of the first few of several pictures: `, as are /images/1 and 2 more`.
fn and_others(others: &[Fault]) -> String {
    let shown = others.iter().take(MAX_NAMED).map(|fault| fault.place.to_string()).collect::<Vec<_>>().join(", ");
    match others.len() {
        0 => String::new(),
        1 => format!(", as is {shown}"),
        count if count <= MAX_NAMED => format!(", as are {shown}"),
        count => format!(", as are {shown} and {} more", count - MAX_NAMED),
    }
}

/// Checks that the picture `name`, or its head, can be decoded.
fn check_picture(name: &str, bytes: &[u8], reading: PictureReading) -> Result<(), String> {
    let limits = ImageLimits::default();
    let checked = match (bytes.starts_with(KTX2), reading) {
        (true, PictureReading::Whole) => return ktx2::decode(bytes, MAX_TEXELS).map(drop).map_err(|e| e.to_string()),
        (true, PictureReading::Heads) => return ktx2::read_head(bytes).map(drop).map_err(|e| e.to_string()),
        (false, PictureReading::Whole) => decode_raster(name, Cursor::new(bytes), &limits).map(drop),
        (false, PictureReading::Heads) => raster_head(name, Cursor::new(bytes), &limits).map(drop),
    };
    checked.map_err(|error| error.to_string())
}

/// Use of each picture.
fn uses(document: &Document) -> Vec<Use> {
    let mut uses = vec![Use { is_used: false, is_replaceable: true }; document.images.len()];
    let mut add = |image: Option<Index>, is_replaceable: bool| {
        if let Some(found) = image.and_then(|image| uses.get_mut(image.get())) {
            found.is_used = true;
            found.is_replaceable &= is_replaceable;
        }
    };
    for texture in &document.textures {
        let sources = [
            texture.extensions.basisu.and_then(|texture| texture.source),
            texture.extensions.webp.and_then(|texture| texture.source),
            texture.source,
        ];
        // The first source in this order is the one that is shown.
        let mut others = sources.iter().flatten().copied();
        let first = others.next();
        add(first, false);
        others.for_each(|other| add(Some(other), true));
    }
    let lights = document.extensions.lights_image_based.iter().flat_map(|lights| &lights.lights);
    let faces = lights.filter_map(|light| light.specular_images.first()).flatten();
    faces.for_each(|face| add(Some(*face), false));
    uses
}
