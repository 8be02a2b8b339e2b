//! AOVs (arbitrary output variables): values of a picture beside its radiance.
//!
//! Each AOV is a color per sample, which the film averages like radiance. The first hit is the
//! first surface on the camera ray that opacity does not cut out. Denoising features come from the
//! first surface behind mirrors and clear glass.

/// AOV of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FilmAov {
    /// Fraction of the pixel that hits a surface; second channel, number of samples that are not
    /// finite; third channel, number of clamped samples.
    Coverage,
    /// Weights of the samples by what their camera rays see, from which alpha follows: red, objects;
    /// green, the hidden background, also through glass; blue, shadow catchers.
    Alpha,
    /// Luminance of the shadow catchers that camera rays see, times the filter weight: red, with all
    /// objects; green, without those that take light from them.
    ShadowCatcher,
    /// Albedo of the first hit.
    Albedo,
    /// Unit shading normal of the first hit, in world space.
    Normal,
    /// Unit geometric normal of the first hit, in world space.
    GeometricNormal,
    /// Distance of the first hit along the ray, in scene units; second channel, coverage.
    Depth,
    /// Distance of the first hit along the view direction, in scene units; second channel, coverage.
    PlanarDepth,
    /// Position of the first hit, in world space.
    Position,
    /// Surface coordinates of the first hit; third channel, coverage.
    Uv,
    /// Motion vector from the rendered frame to an adjacent frame, in pixels, x to the right and y
    /// down; third channel, fraction of the pixel for which it is known.
    Motion(AdjacentFrame),
    /// Emission of the first hit and of the background.
    Emission,
    /// Direct lighting of the first hit.
    Direct,
    /// Indirect lighting: paths of more segments.
    Indirect,
    /// Light of one light group.
    Group(LightGroup),
    /// Denoising feature; the radiance itself is the picture.
    Feature(DenoisingFeature),
    /// Denoising feature of one half of the samples; the difference between the halves shows the
    /// noise.
    HalfFeature(DenoisingFeature),
}

/// Frame adjacent to the rendered frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AdjacentFrame {
    /// Previous frame.
    Previous,
    /// Next frame.
    Next,
}

/// Light group, by number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LightGroup(pub u16);

impl LightGroup {
    /// Group of all light without a named group.
    pub const REST: Self = Self(0);
    /// Maximum number of light groups of a scene, [`Self::REST`] included.
    pub const MAX_COUNT: usize = 1 << 16;
}

/// Denoising feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DenoisingFeature {
    /// Radiance.
    Color,
    /// Albedo of the first surface that is not specular, times the throughput of the specular path.
    Albedo,
    /// Unit shading normal of that surface.
    Normal,
    /// Distance along the ray to the first hit, in the first channel; coverage in the second.
    Depth,
}

impl DenoisingFeature {
    /// All features.
    pub const ALL: [Self; 4] = [Self::Color, Self::Albedo, Self::Normal, Self::Depth];
}

/// AOVs that a film stores beside radiance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilmAovs {
    /// AOVs, in the order in which samples and films store them.
    pub planes: Vec<FilmAov>,
    /// Whether the film stores coverage masks by object, material and shape.
    pub masks: bool,
}

/// No AOVs.
pub static NO_AOVS: FilmAovs = FilmAovs { planes: Vec::new(), masks: false };

impl FilmAovs {
    /// Whether there are neither AOVs nor masks.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty() && !self.masks
    }

    /// Whether AOVs compare two halves of the samples. Each half then has its own stream of random
    /// numbers: the two halves of one low-discrepancy sequence are anticorrelated, so their
    /// difference overestimates the error.
    pub fn has_halves(&self) -> bool {
        self.planes.iter().any(|aov| matches!(aov, FilmAov::HalfFeature(_)))
    }

    /// Index of an AOV in `planes`.
    pub fn index_of(&self, aov: FilmAov) -> Option<usize> {
        self.planes.iter().position(|other| *other == aov)
    }
}

/// Whether a sample belongs to the half that [`FilmAov::HalfFeature`] stores: exactly one of the
/// neighbors 2k and 2k + 1 does (Thue–Morse sequence).
pub fn is_in_second_half(sample: u32) -> bool {
    sample.count_ones() % 2 == 1
}
