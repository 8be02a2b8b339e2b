//! Layers: what a picture is made of beside its radiance, known to the field as arbitrary output variables.
//!
//! Each layer is a colour a sample, averaged by the film as radiance is. What is seen is what the camera's ray met first, holes
//! left out; what denoising is guided by is what it met behind mirrors and clear glass.

/// A layer of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layer {
    /// How much of the pixel shows anything; second, how many samples were no finite numbers; third, how many were clamped.
    Coverage,
    /// The colour that what is seen has without light.
    Albedo,
    /// Unit shading normal of what is seen, world space.
    Normal,
    /// Unit normal of the true surface, world space.
    GeometricNormal,
    /// How far away it is along the ray, in scene units; second, how much of the pixel shows anything.
    Depth,
    /// Where it is, world space.
    Position,
    /// Its surface coordinates; third, how much of the pixel shows anything.
    Uv,
    /// How far what is seen goes on the film to another frame, in pixels, x to the right and y down; third, of how much of the
    /// pixel that is known.
    Motion(Beside),
    /// Light that what is seen gives off, and the background.
    Emission,
    /// Light that lights send to what is seen.
    Direct,
    /// Light that comes by longer ways.
    Indirect,
    /// Light of one group of lights.
    Group(LightGroup),
    /// What denoising is guided by; radiance itself is the picture.
    Guide(Guide),
    /// The same of one half of the samples, so that noise shows as what both halves differ by.
    Half(Guide),
}

/// One of the frames beside the one that is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Beside {
    /// The one before.
    Previous,
    /// The one after.
    Next,
}

/// Lights that are kept apart from others, by number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LightGroup(pub u16);

impl LightGroup {
    /// All light that belongs to no group that somebody named.
    pub const REST: Self = Self(0);
}

/// What denoising is guided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guide {
    /// Radiance itself.
    Color,
    /// The colour without light, seen through mirrors and clear glass.
    Albedo,
    /// Unit shading normal there.
    Normal,
    /// First, how far away what the camera's ray met first is.
    Depth,
}

impl Guide {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Color, Self::Albedo, Self::Normal, Self::Depth];
}

/// What a film keeps beside radiance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// In their order.
    pub planes: Vec<Layer>,
    /// Whether it is kept how much of a pixel shows which object, material and shape.
    pub masks: bool,
}

/// No layers.
pub static NONE: Layers = Layers { planes: Vec::new(), masks: false };

impl Layers {
    /// Whether there is nothing to keep.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty() && !self.masks
    }

    /// Whether halves of the samples are compared: each then has a stream of numbers of its own. Halves of one sequence balance each
    /// other, so that they differ by more than the whole is wrong.
    pub fn has_halves(&self) -> bool {
        self.planes.iter().any(|layer| matches!(layer, Layer::Half(_)))
    }

    /// Which of the planes it is.
    pub fn place(&self, layer: Layer) -> Option<usize> {
        self.planes.iter().position(|other| *other == layer)
    }
}

/// Whether a sample is in the half that [`Layer::Half`] keeps: one of two neighbours, 2k and 2k + 1, always is (the sequence of
/// Thue and Morse).
pub fn is_half(sample: u32) -> bool {
    sample.count_ones() % 2 == 1
}
