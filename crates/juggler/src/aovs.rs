//! Arbitrary output variables (AOVs): their choice, the film AOVs they need, and the channels
//! they write.

mod aliases;
mod cryptomatte;
mod values;

pub(crate) use values::Coverage;

use crate::{Denoiser, Error, check_name};
use juggler_camera::aov::{AdjacentFrame, DenoisingFeature, FilmAov, FilmAovs, LightGroup};
use juggler_film::partial_render::{AovDescription, MAX_PLANES};
use juggler_imaging::Header;
use juggler_imaging::layered::{LayerHeader, LayeredHeader};
use juggler_material::MaterialId;
use juggler_scene::Names;
use std::collections::HashSet;

/// Maximum gain of a light group.
pub const MAX_GAIN: f32 = 1e6;

/// Arbitrary output variable of the first visible surface, of light paths, or of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Aov {
    /// Coverage of the pixel by surfaces, 0 to 1.
    Alpha,
    /// Albedo of the visible surface.
    Albedo,
    /// Unit shading normal, in world space.
    Normal,
    /// Unit geometric normal, in world space.
    GeometricNormal,
    /// Distance along the camera ray, in scene units; infinite where no surface is visible.
    Depth,
    /// Distance along the camera's view direction, in scene units; infinite where no surface is
    /// visible.
    PlanarDepth,
    /// Position of the visible surface, in world space.
    Position,
    /// Texture coordinates of the visible surface.
    Uv,
    /// Motion vector to the next frame, in pixels, x to the right and y down.
    Motion,
    /// Motion vector to the previous frame, in the same units.
    MotionBack,
    /// Emission of the visible surface, or radiance of the background.
    Emission,
    /// Direct lighting of the visible surface.
    Direct,
    /// Indirect lighting: light paths with more bounces.
    Indirect,
    /// Radiance of each light group, one layer per group.
    LightGroups,
    /// Index of the scene's object that covers most of the pixel, from 1; 0 for none.
    ObjectId,
    /// Index of the material that covers most of the pixel, from 1; 0 for none.
    MaterialId,
    /// Index of the shape that covers most of the pixel, with instances counted separately, from 1;
    /// 0 for none.
    InstanceId,
    /// Cryptomatte of objects.
    CryptoObject,
    /// Cryptomatte of materials.
    CryptoMaterial,
    /// Number of samples of each pixel.
    Samples,
    /// Variance of the pixel's mean.
    Variance,
    /// Number of samples whose radiance was not finite.
    NotFinite,
    /// Number of samples that clamping has limited.
    Clamped,
}

impl Aov {
    /// All AOVs, in the order of their layers in a file.
    pub const ALL: [Self; 23] = [
        Self::Alpha,
        Self::Albedo,
        Self::Normal,
        Self::GeometricNormal,
        Self::Depth,
        Self::PlanarDepth,
        Self::Position,
        Self::Uv,
        Self::Motion,
        Self::MotionBack,
        Self::Emission,
        Self::Direct,
        Self::Indirect,
        Self::LightGroups,
        Self::ObjectId,
        Self::MaterialId,
        Self::InstanceId,
        Self::CryptoObject,
        Self::CryptoMaterial,
        Self::Samples,
        Self::Variance,
        Self::NotFinite,
        Self::Clamped,
    ];

    /// Returns the name that settings, the command line and files use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::GeometricNormal => "geometric_normal",
            Self::Depth => "depth",
            Self::PlanarDepth => "planar_depth",
            Self::Position => "position",
            Self::Uv => "uv",
            Self::Motion => "motion",
            Self::MotionBack => "motion_back",
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Indirect => "indirect",
            Self::LightGroups => "light_groups",
            Self::ObjectId => "object_id",
            Self::MaterialId => "material_id",
            Self::InstanceId => "instance_id",
            Self::CryptoObject => "crypto_object",
            Self::CryptoMaterial => "crypto_material",
            Self::Samples => "samples",
            Self::Variance => "variance",
            Self::NotFinite => "not_finite",
            Self::Clamped => "clamped",
        }
    }

    /// Returns the AOV of a name. The error suggests similar names.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.iter().map(|aov| aov.name());
        check_name("AOV", name, known).map_err(|error| error.for_setting("aovs"))?;
        // The check above ensures that the name exists.
        Ok(Self::ALL.into_iter().find(|aov| aov.name() == name).unwrap_or(Self::Alpha))
    }

    /// Returns the film AOVs that the AOV is computed from.
    fn needs(self, names: &Names) -> Vec<FilmAov> {
        match self {
            Self::Alpha | Self::NotFinite | Self::Clamped => vec![FilmAov::Coverage],
            Self::Albedo => vec![FilmAov::Albedo],
            Self::Normal => vec![FilmAov::Normal],
            Self::GeometricNormal => vec![FilmAov::GeometricNormal],
            Self::Depth => vec![FilmAov::Depth],
            Self::PlanarDepth => vec![FilmAov::PlanarDepth],
            Self::Position => vec![FilmAov::Position, FilmAov::Coverage],
            Self::Uv => vec![FilmAov::Uv],
            Self::Motion => vec![FilmAov::Motion(AdjacentFrame::Next)],
            Self::MotionBack => vec![FilmAov::Motion(AdjacentFrame::Previous)],
            Self::Emission => vec![FilmAov::Emission],
            Self::Direct => vec![FilmAov::Direct],
            Self::Indirect => vec![FilmAov::Indirect],
            Self::LightGroups => {
                let numbers = (0..names.light_groups.len()).filter_map(|number| u16::try_from(number).ok());
                numbers.map(|number| FilmAov::Group(LightGroup(number))).collect()
            }
            Self::ObjectId
            | Self::MaterialId
            | Self::InstanceId
            | Self::CryptoObject
            | Self::CryptoMaterial
            | Self::Samples
            | Self::Variance => Vec::new(),
        }
    }

    fn needs_masks(self) -> bool {
        matches!(self, Self::ObjectId | Self::MaterialId | Self::InstanceId | Self::CryptoObject | Self::CryptoMaterial)
    }
}

/// AOVs of one picture, with the film AOVs they need and the names of objects, materials and
/// light groups.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AovSet {
    aovs: Vec<Aov>,
    film_aovs: FilmAovs,
    names: Names,
    denoiser: Option<Denoiser>,
    transparent: bool,
    /// Number of channels of all AOVs.
    channels: usize,
}

impl AovSet {
    /// Selects the film AOVs for the AOVs and the denoiser of a scene with these names, and for the
    /// alpha of a `transparent` picture.
    pub fn new(aovs: &[Aov], denoiser: Option<Denoiser>, names: &Names, transparent: bool) -> Self {
        let aovs: Vec<Aov> = Aov::ALL.into_iter().filter(|aov| aovs.contains(aov)).collect();
        let mut planes: Vec<FilmAov> = Vec::new();
        let mut known = HashSet::new();
        let features = DenoisingFeature::ALL.into_iter().flat_map(|feature| {
            let whole = (feature != DenoisingFeature::Color).then_some(FilmAov::Feature(feature));
            let half = (denoiser == Some(Denoiser::Own)).then_some(FilmAov::HalfFeature(feature));
            whole.into_iter().chain(half)
        });
        let alpha = transparent.then_some([FilmAov::Alpha, FilmAov::ShadowCatcher]);
        let needed = aovs.iter().flat_map(|aov| aov.needs(names));
        for aov in alpha.into_iter().flatten().chain(needed).chain(features.filter(|_| denoiser.is_some())) {
            if known.insert(aov) {
                planes.push(aov);
            }
        }
        let masks = aovs.iter().any(|aov| aov.needs_masks());
        let names = if aovs.is_empty() { Names::default() } else { names.clone() };
        let mut set = Self { film_aovs: FilmAovs { planes, masks }, aovs, names, denoiser, transparent, channels: 0 };
        set.channels = set.aovs.iter().map(|aov| set.channels_of(*aov)).sum();
        set
    }

    /// Returns the number of channels of all AOVs in a file.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Checks that a film can store all AOVs.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let (planes, groups) = (self.film_aovs.planes.len(), self.light_groups().len());
        if planes <= MAX_PLANES as usize {
            return Ok(());
        }
        let message = format!(
            "the AOV `light_groups` has {groups} light groups, too many for a picture of at most {MAX_PLANES} planes"
        );
        Err(Error::setting("aovs", message))
    }

    /// Returns the denoiser whose features the film stores.
    pub fn denoiser(&self) -> Option<Denoiser> {
        self.denoiser
    }

    /// Returns whether the picture is transparent, so that the film stores alpha.
    pub fn is_transparent(&self) -> bool {
        self.transparent
    }

    /// Returns whether there are neither AOVs nor film AOVs.
    pub fn is_empty(&self) -> bool {
        self.film_aovs.is_empty() && self.aovs.is_empty()
    }

    /// Returns the AOVs that the film stores.
    pub fn film_aovs(&self) -> &FilmAovs {
        &self.film_aovs
    }

    /// Returns the selected AOVs, in the order of [`Aov::ALL`].
    pub fn selected(&self) -> &[Aov] {
        &self.aovs
    }

    /// Returns the names of objects, materials and light groups; empty without AOVs.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Returns the names of the light groups that are stored separately, by index; empty without
    /// [`Aov::LightGroups`].
    pub fn light_groups(&self) -> &[String] {
        if self.aovs.contains(&Aov::LightGroups) { &self.names.light_groups } else { &[] }
    }

    /// Returns the description of the AOVs for a partial render.
    pub fn to_description(&self) -> AovDescription {
        if self.is_empty() {
            return AovDescription::default();
        }
        let denoiser = self.denoiser.map(|denoiser| format!("{DENOISED}{}", denoiser.name()));
        let transparent = self.transparent.then(|| TRANSPARENT.to_owned());
        AovDescription {
            requested: self.aovs.iter().map(|aov| aov.name().to_owned()).chain(denoiser).chain(transparent).collect(),
            planes: self.film_aovs.planes.len() as u32,
            masks: self.film_aovs.masks,
            entries: self.names.entries,
            objects: self.names.objects.clone(),
            materials: self.names.materials.iter().map(|(id, name)| (id.0, name.clone())).collect(),
            light_groups: self.names.light_groups.clone(),
            neighbor_frames: String::new(),
        }
    }

    /// Reads the AOVs from the description of a partial render. Fails if this version does not
    /// know them.
    pub fn from_description(description: &AovDescription) -> Result<Self, Error> {
        let names = Names {
            entries: description.entries,
            objects: description.objects.clone(),
            materials: description.materials.iter().map(|(id, name)| (MaterialId(*id), name.clone())).collect(),
            light_groups: description.light_groups.clone(),
        };
        let denoiser = description.requested.iter().find_map(|name| name.strip_prefix(DENOISED)).map(Denoiser::by_name);
        let transparent = description.requested.iter().any(|name| name == TRANSPARENT);
        let is_aov = |name: &&String| !name.starts_with(DENOISED) && *name != TRANSPARENT;
        let names_of_aovs = description.requested.iter().filter(is_aov);
        let aovs: Vec<Aov> = names_of_aovs.map(|name| Aov::by_name(name)).collect::<Result<_, _>>()?;
        let set = Self::new(&aovs, denoiser.transpose()?, &names, transparent);
        if set.film_aovs.planes.len() as u32 != description.planes || set.film_aovs.masks != description.masks {
            return Err(Error::setting("aovs", "the AOVs of the partial render differ from its description"));
        }
        Ok(set)
    }

    /// Returns the header of an EXR file with the AOVs, and with the rendered image if
    /// `with_picture`.
    pub fn file_header(&self, header: &Header, with_picture: bool) -> LayeredHeader {
        let picture = with_picture.then(|| LayerHeader::beauty(header));
        LayeredHeader::new(header, picture.into_iter().chain(self.headers()).collect())
    }

    /// Returns the layer headers of all AOVs, in file order.
    pub fn headers(&self) -> Vec<LayerHeader> {
        self.aovs.iter().flat_map(|aov| self.headers_of(*aov)).collect()
    }

    /// Returns the number of channels of an AOV in a file.
    fn channels_of(&self, aov: Aov) -> usize {
        match aov {
            // Skip the manifest, which would list all names.
            Aov::CryptoObject | Aov::CryptoMaterial => cryptomatte::CHANNELS,
            other => self.headers_of(other).iter().map(|layer| layer.channels.len()).sum(),
        }
    }

    fn headers_of(&self, aov: Aov) -> Vec<LayerHeader> {
        let channels: &[&str] = match aov {
            Aov::Albedo | Aov::Emission | Aov::Direct | Aov::Indirect => return vec![LayerHeader::color(aov.name())],
            // Not a color layer: converting variances to other primaries needs the covariance of
            // the channels.
            Aov::Variance => &["R", "G", "B"],
            Aov::Normal | Aov::GeometricNormal | Aov::Position => &["X", "Y", "Z"],
            Aov::Alpha => &["A"],
            Aov::Depth | Aov::PlanarDepth => &["Z"],
            Aov::Uv => &["U", "V"],
            Aov::Motion | Aov::MotionBack => &["X", "Y"],
            Aov::ObjectId | Aov::MaterialId | Aov::InstanceId | Aov::Samples | Aov::NotFinite | Aov::Clamped => &["Y"],
            Aov::LightGroups => {
                let group = |name: &String| LayerHeader::color(&format!("light_group_{name}"));
                return self.names.light_groups.iter().map(group).collect();
            }
            Aov::CryptoObject => {
                let names: Vec<String> = (0..self.names.entries).map(|number| self.names.object(number)).collect();
                return cryptomatte::headers("CryptoObject", &names);
            }
            Aov::CryptoMaterial => {
                let names: Vec<String> = self.names.materials.iter().map(|(_, name)| name.clone()).collect();
                return cryptomatte::headers("CryptoMaterial", &names);
            }
        };
        vec![LayerHeader::new(aov.name(), channels)]
    }
}

/// Prefix of a denoiser's name in the description of a partial render.
const DENOISED: &str = "denoised:";
/// Mark of a transparent picture among the AOVs of a partial render.
const TRANSPARENT: &str = "transparent";
