//! Layers beside the picture: what can be asked for, what that needs of the film, and what comes of it.

mod cryptomatte;
mod values;
mod words;

use crate::{Denoiser, Error, check_name};
use juggler_camera::layer::{Beside, Guide, Layer, Layers, LightGroup};
use juggler_film::part::{Layered, MAX_PLANES};
use juggler_imaging::Header;
use juggler_imaging::layered::{LayerHeader, LayeredHeader};
use juggler_material::MaterialId;
use juggler_scene::Names;
use std::collections::HashSet;

/// The largest factor on the light of a group.
pub const MOST_GAIN: f32 = 1e6;

/// Something that can be asked for beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// How much of a pixel shows anything.
    Alpha,
    /// The colour that what is seen has without light.
    Albedo,
    /// Its unit shading normal, world space.
    Normal,
    /// Unit normal of the true surface, world space.
    GeometricNormal,
    /// How far away it is, along the ray; infinite where nothing is.
    Depth,
    /// Where it is, world space.
    Position,
    /// Its surface coordinates.
    Uv,
    /// How far it goes on the film until the next frame, in pixels, x to the right and y down.
    Motion,
    /// The same to the frame before.
    MotionBack,
    /// Light that what is seen gives off, and the background.
    Emission,
    /// Light that lights send to what is seen.
    Direct,
    /// Light that comes by longer ways.
    Indirect,
    /// The light of each group of lights, a layer each.
    LightGroups,
    /// Which entry of the scene's objects covers most of the pixel, counted from 1; 0 for none.
    ObjectId,
    /// The same of materials.
    MaterialId,
    /// The same of shapes, instances counted one by one.
    InstanceId,
    /// Masks of objects as Cryptomatte has them.
    CryptoObject,
    /// The same of materials.
    CryptoMaterial,
    /// How many samples each pixel got.
    Samples,
    /// Variance of the pixel's mean.
    Variance,
    /// How many samples were no finite numbers.
    NotFinite,
    /// How many samples a limit on contributions has cut.
    Clamped,
}

impl Aov {
    /// All, in the order in which they stand in a file.
    pub const ALL: [Self; 22] = [
        Self::Alpha,
        Self::Albedo,
        Self::Normal,
        Self::GeometricNormal,
        Self::Depth,
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

    /// As it is asked for.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::GeometricNormal => "geometric_normal",
            Self::Depth => "depth",
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

    /// The one of that name; an error says which was probably meant.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        check_name("AOV", name, Self::ALL.iter().map(|aov| aov.name()))?;
        // It is one of them.
        Ok(Self::ALL.into_iter().find(|aov| aov.name() == name).unwrap_or(Self::Alpha))
    }

    /// What the film must keep for it.
    fn needs(self, names: &Names) -> Vec<Layer> {
        match self {
            Self::Alpha | Self::NotFinite | Self::Clamped => vec![Layer::Coverage],
            Self::Albedo => vec![Layer::Albedo],
            Self::Normal => vec![Layer::Normal],
            Self::GeometricNormal => vec![Layer::GeometricNormal],
            Self::Depth => vec![Layer::Depth],
            Self::Position => vec![Layer::Position, Layer::Coverage],
            Self::Uv => vec![Layer::Uv],
            Self::Motion => vec![Layer::Motion(Beside::Next)],
            Self::MotionBack => vec![Layer::Motion(Beside::Previous)],
            Self::Emission => vec![Layer::Emission],
            Self::Direct => vec![Layer::Direct],
            Self::Indirect => vec![Layer::Indirect],
            Self::LightGroups => {
                let numbers = (0..names.light_groups.len()).filter_map(|number| u16::try_from(number).ok());
                numbers.map(|number| Layer::Group(LightGroup(number))).collect()
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

/// The layers of one picture, with the names of what they tell apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerSet {
    wanted: Vec<Aov>,
    layers: Layers,
    names: Names,
    denoiser: Option<Denoiser>,
    /// How many channels all layers have.
    channels: usize,
}

impl LayerSet {
    /// Of a scene with these names, with what the `denoiser` asks for.
    pub fn new(wanted: &[Aov], denoiser: Option<Denoiser>, names: &Names) -> Self {
        let wanted: Vec<Aov> = Aov::ALL.into_iter().filter(|aov| wanted.contains(aov)).collect();
        let mut planes: Vec<Layer> = Vec::new();
        let mut known = HashSet::new();
        let guide = Guide::ALL.into_iter().flat_map(|guide| {
            let whole = (guide != Guide::Color).then_some(Layer::Guide(guide));
            let half = (denoiser == Some(Denoiser::Own)).then_some(Layer::Half(guide));
            whole.into_iter().chain(half)
        });
        let needed = wanted.iter().flat_map(|aov| aov.needs(names));
        for layer in needed.chain(guide.filter(|_| denoiser.is_some())) {
            if known.insert(layer) {
                planes.push(layer);
            }
        }
        let masks = wanted.iter().any(|aov| aov.needs_masks());
        let names = if wanted.is_empty() { Names::default() } else { names.clone() };
        let mut set = Self { layers: Layers { planes, masks }, wanted, names, denoiser, channels: 0 };
        set.channels = set.wanted.iter().map(|aov| set.channels_of(*aov)).sum();
        set
    }

    /// How many channels all layers have in a file.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Whether a film can keep all of it.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let (planes, groups) = (self.layers.planes.len(), self.light_groups().len());
        if planes <= MAX_PLANES as usize {
            return Ok(());
        }
        Err(Error::Settings(format!(
            "the layer `light_groups` is {groups} layers, a picture keeps {MAX_PLANES} at most"
        )))
    }

    /// What takes the noise out of the picture, whose film keeps what that is guided by.
    pub fn denoiser(&self) -> Option<Denoiser> {
        self.denoiser
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty() && self.wanted.is_empty()
    }

    /// What the film keeps.
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    /// What was asked for.
    pub fn wanted(&self) -> &[Aov] {
        &self.wanted
    }

    /// The names of groups of lights whose light is kept apart, by number; nothing where none is.
    pub fn light_groups(&self) -> &[String] {
        if self.wanted.contains(&Aov::LightGroups) { &self.names.light_groups } else { &[] }
    }

    /// As film parts say it.
    pub fn to_part(&self) -> Layered {
        if self.is_empty() {
            return Layered::default();
        }
        let denoiser = self.denoiser.map(|denoiser| format!("{DENOISED}{}", denoiser.name()));
        Layered {
            wanted: self.wanted.iter().map(|aov| aov.name().to_owned()).chain(denoiser).collect(),
            planes: self.layers.planes.len() as u32,
            masks: self.layers.masks,
            entries: self.names.entries,
            objects: self.names.objects.clone(),
            materials: self.names.materials.iter().map(|(id, name)| (id.0, name.clone())).collect(),
            light_groups: self.names.light_groups.clone(),
            beside: String::new(),
        }
    }

    /// As a film part says it; an error where that is none of this program's.
    pub fn of_part(part: &Layered) -> Result<Self, Error> {
        let names = Names {
            entries: part.entries,
            objects: part.objects.clone(),
            materials: part.materials.iter().map(|(id, name)| (MaterialId(*id), name.clone())).collect(),
            light_groups: part.light_groups.clone(),
        };
        let denoiser = part.wanted.iter().find_map(|name| name.strip_prefix(DENOISED)).map(Denoiser::by_name);
        let aovs = part.wanted.iter().filter(|name| !name.starts_with(DENOISED));
        let wanted: Vec<Aov> = aovs.map(|name| Aov::by_name(name)).collect::<Result<_, _>>()?;
        let set = Self::new(&wanted, denoiser.transpose()?, &names);
        if set.layers.planes.len() as u32 != part.planes || set.layers.masks != part.masks {
            return Err(Error::Settings("the film part has other layers than it says".into()));
        }
        Ok(set)
    }

    /// What a file of the layers says, beside what `header` says of the picture; with the picture itself if that is wanted.
    pub fn file_header(&self, header: &Header, with_picture: bool) -> LayeredHeader {
        let picture = with_picture.then(|| LayerHeader::beauty(header.options.exr_depth));
        LayeredHeader::new(header, picture.into_iter().chain(self.headers()).collect())
    }

    /// The layers of a file, in order, without the picture itself.
    pub fn headers(&self) -> Vec<LayerHeader> {
        self.wanted.iter().flat_map(|aov| self.headers_of(*aov)).collect()
    }

    /// How many channels the layers of a file have for it.
    fn channels_of(&self, aov: Aov) -> usize {
        match aov {
            // Without the names of everything that they tell apart.
            Aov::CryptoObject | Aov::CryptoMaterial => cryptomatte::CHANNELS,
            other => self.headers_of(other).iter().map(|layer| layer.channels.len()).sum(),
        }
    }

    fn headers_of(&self, aov: Aov) -> Vec<LayerHeader> {
        let channels: &[&str] = match aov {
            Aov::Albedo | Aov::Emission | Aov::Direct | Aov::Indirect => return vec![LayerHeader::color(aov.name())],
            // No colour: what primaries of others made of it would need how the channels go together.
            Aov::Variance => &["R", "G", "B"],
            Aov::Normal | Aov::GeometricNormal | Aov::Position => &["X", "Y", "Z"],
            Aov::Alpha => &["A"],
            Aov::Depth => &["Z"],
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

/// What film parts call it that noise is taken out, before the name of what does it.
const DENOISED: &str = "denoised:";
