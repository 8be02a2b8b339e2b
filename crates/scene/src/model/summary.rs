//! Description of a model file for people.

/// What a model file contains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelSummary {
    /// Format with version, such as "glTF 2.0".
    pub format: String,
    /// Program that wrote the file.
    pub generator: Option<String>,
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Names of the material variants.
    pub variants: Vec<String>,
    /// Animation clips.
    pub clips: Vec<ModelClip>,
    /// Clip of the choice, as an index into `clips`.
    pub clip: Option<usize>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Names of the cameras, with width by height of their pictures if the file sets it.
    pub cameras: Vec<(String, Option<f32>)>,
    /// Names of the lights.
    pub lights: Vec<String>,
    /// Typical illuminance by the lights of the chosen scene, see [`illuminance`]; 0 without lights.
    ///
    /// [`illuminance`]: super::illuminance
    pub illuminance: f32,
    /// Whether the chosen scene has an image-based light.
    pub has_environment: bool,
    /// Nodes of the file.
    pub nodes: usize,
    /// Triangles of the file's distinct meshes.
    pub distinct_triangles: u64,
    /// Triangles of the chosen scene.
    pub drawn_triangles: u64,
    /// Pictures with the numbers of their pixels (width, height), if their heads can be read.
    pub textures: Vec<(String, Option<[u32; 2]>)>,
    /// Extensions of the file with their support.
    pub extensions: Vec<ModelExtension>,
    /// Warnings, as in [`ModelParts`](super::ModelParts).
    pub warnings: Vec<String>,
}

/// Animation clip of a model file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelClip {
    /// Name, as `animation` selects it.
    pub name: String,
    /// Duration in seconds.
    pub seconds: f64,
}

/// Extension of a format that a model file uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelExtension {
    /// Name, such as "KHR_materials_clearcoat".
    pub name: String,
    /// Support by Juggler.
    pub support: ExtensionSupport,
}

/// Support of an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExtensionSupport {
    /// All of the extension has its effect.
    Whole,
    /// The effect is approximated.
    Approximated,
    /// The extension is ignored.
    Ignored,
}
