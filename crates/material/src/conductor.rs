//! Metals, smooth or rough.
//!
//! ```json
//! {"conductor": {"metal": "gold", "roughness": 0.3}}
//! ```
//!
//! Other descriptions are measured indices, `eta` and `k`, and colors, `reflectance` (at normal
//! incidence) with `edge_tint` or `grazing`.

use super::error::in_range;
use super::input::{check_unit_color, unit_color};
use super::roughness::Roughness;
use super::{
    CompiledMaterial, IneffectiveSetting, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView,
    SurfaceSides,
};
use juggler_bsdf::metals::Metal;
use juggler_bsdf::{Bsdf, Conductor as ConductorLobe, Fresnel};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::{JsonSchema, Schema, json_schema};
use serde::{Deserialize, Serialize};

/// Metal, smooth or rough (GGX microfacets). `metal` takes precedence over `eta` and `k`, and these
/// over `reflectance`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Conductor {
    /// Name of a metal, such as `gold`, in place of `eta` and `k` or `reflectance`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metal: Option<MetalName>,
    /// Real part of the complex index of refraction per channel, 0.001 to 1000. Requires `k`;
    /// replaces `reflectance`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eta: Option<Rgb>,
    /// Extinction coefficient per channel, the imaginary part of the complex index of refraction,
    /// from 0 to 1000. Requires `eta`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<Rgb>,
    /// Reflectance at normal incidence, 0 to 1 per channel. Ignored with `metal` or `eta` and `k`.
    pub reflectance: Input<Rgb>,
    /// Factor on the reflectance of Schlick's curve at 82 degrees, 0 to 1 per channel; at 90
    /// degrees the reflectance stays white. White keeps Schlick's curve. Ignored with `grazing`.
    pub edge_tint: Input<Rgb>,
    /// Reflectance at grazing angles in Schlick's curve, 0 to 1 per channel, in place of white. The
    /// value of `reflectance` makes the reflectance independent of the angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grazing: Option<Rgb>,
    /// Roughness, 0 (mirror) to 1. The alpha of GGX is its square.
    pub roughness: Input<f32>,
    /// Anisotropy of the roughness, -1 to 1: positive values elongate highlights along the
    /// surface's u, negative values along v.
    pub anisotropy: Input<f32>,
    /// Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
    #[schemars(extend("x-unit" = "turns"))]
    pub anisotropy_rotation: Input<f32>,
    /// Adds the energy that single scattering between microfacets loses: rough white metal stays
    /// white. On isotropic metal it leaves in all directions (Kulla and Conty 2017), on anisotropic
    /// metal within the highlight (Turquin 2019). Set it to `false` to match renderers with single
    /// scattering only, where rough metal is darker.
    pub energy_compensation: bool,
    /// Sides of the surface on which the material is present: `both`, `front` (absent from behind) or
    /// `black_behind`.
    #[serde(skip_serializing_if = "SurfaceSides::is_default")]
    pub sides: SurfaceSides,
}

/// A metal by name. Its index of refraction per channel is derived from a measured table. Each
/// name has the table's source and the reflectance at normal incidence: the table's spectral
/// reflectance in air, integrated to linear sRGB (CIE 1931, D65) and clamped to 0..1. Towards
/// grazing angles the reflectance follows the integrated spectral curve within 0.01 up to 80
/// degrees. Gold's red lies outside of sRGB, so it is clamped, and rendered as 0.996.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = with_aluminium)]
#[non_exhaustive]
pub enum MetalName {
    /// Rakić (1995): 0.907, 0.916, 0.922.
    #[serde(alias = "aluminium")]
    Aluminum,
    /// Querry (1985), 70 % copper and 30 % zinc: 0.910, 0.778, 0.423.
    Brass,
    /// Johnson and Christy (1974): 0.550, 0.556, 0.554.
    Chromium,
    /// Johnson and Christy (1974): 0.683, 0.655, 0.616.
    Cobalt,
    /// Johnson and Christy (1972): 0.932, 0.623, 0.522.
    Copper,
    /// Johnson and Christy (1972): 1.000, 0.728, 0.365.
    Gold,
    /// Johnson and Christy (1974): 0.530, 0.513, 0.494.
    Iron,
    /// Johnson and Christy (1974): 0.697, 0.640, 0.563.
    Nickel,
    /// Rakić, Djurišić, Elazar and Majewski (1998), Brendel-Bormann model: 0.679, 0.639, 0.584.
    Platinum,
    /// Johnson and Christy (1972): 0.989, 0.984, 0.978.
    Silver,
    /// Johnson and Christy (1974): 0.619, 0.579, 0.542.
    Titanium,
    /// Rakić, Djurišić, Elazar and Majewski (1998), Brendel-Bormann model: 0.506, 0.497, 0.477.
    Tungsten,
    /// Werner, Glantschnig and Ambrosch-Draxl (2009): 0.875, 0.869, 0.855.
    Zinc,
}

/// Adds the British spelling of aluminum, which serde accepts as an alias, to the schema.
fn with_aluminium(schema: &mut Schema) {
    if let Some(names) = schema.get_mut("oneOf").and_then(|names| names.as_array_mut()) {
        let description = "Another spelling of `aluminum`.";
        let name = json_schema!({"description": description, "type": "string", "const": "aluminium"});
        names.push(name.to_value());
    }
}

impl Default for Conductor {
    fn default() -> Self {
        Self {
            metal: None,
            eta: None,
            k: None,
            reflectance: Rgb::splat(0.9).into(),
            edge_tint: Rgb::WHITE.into(),
            grazing: None,
            roughness: 0.0.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            energy_compensation: true,
            sides: SurfaceSides::Both,
        }
    }
}

/// A [`Conductor`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledConductor {
    color: Color,
    /// Roughness of the surface.
    pub roughness: Roughness,
    compensated: bool,
    /// Lobe at all points, if no input is a texture.
    constant_lobe: Option<ConductorLobe>,
}

#[derive(Clone, Debug)]
enum Color {
    Measured(Fresnel),
    Tinted(Slot<Rgb>, Slot<Rgb>),
    Schlick(Slot<Rgb>, Rgb),
}

impl Material for Conductor {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_unit_color("reflectance", &self.reflectance)?;
        check_unit_color("edge_tint", &self.edge_tint)?;
        check_unit_color("grazing", &self.grazing.unwrap_or_default().into())?;
        let textures = resolver.textures();
        let roughness = [&self.roughness, &self.anisotropy, &self.anisotropy_rotation];
        let mut compiled = CompiledConductor {
            color: self.color(textures)?,
            roughness: Roughness::new(textures, roughness)?,
            compensated: self.energy_compensation,
            constant_lobe: None,
        };
        if !compiled.is_textured() {
            compiled.constant_lobe = Some(compiled.at(textures, &TextureLookup::default()));
        }
        Ok(self.sides.restrict(CompiledMaterial::scattering(compiled), resolver))
    }

    fn ineffective_settings(&self) -> Vec<IneffectiveSetting> {
        let default = Self::default();
        let indices = [("eta", self.eta.is_some()), ("k", self.k.is_some())];
        let edge_tint = ("edge_tint", self.edge_tint != default.edge_tint);
        let colors = [("reflectance", self.reflectance != default.reflectance), edge_tint];
        let colors = colors.into_iter().chain([("grazing", self.grazing.is_some())]);
        let (replaced_by, fields) = match (self.metal, self.eta.and(self.k), self.grazing) {
            (Some(_), ..) => ("metal", indices.into_iter().chain(colors).collect()),
            (None, Some(_), _) => ("eta", colors.collect()),
            (None, None, Some(_)) => ("grazing", vec![edge_tint]),
            (None, None, None) => ("", Vec::new()),
        };
        let given = fields.into_iter().filter(|(_, is_given)| *is_given);
        given.map(|(field, _)| IneffectiveSetting { field, replaced_by }).collect()
    }
}

impl Conductor {
    /// Creates a smooth metal of a reflectance at normal incidence.
    pub fn new(reflectance: impl Into<Input<Rgb>>) -> Self {
        Self { reflectance: reflectance.into(), ..Self::default() }
    }

    /// Creates a smooth surface of a metal with measured optical constants.
    pub fn from_metal(metal: MetalName) -> Self {
        Self { metal: Some(metal), ..Self::default() }
    }

    fn color(&self, textures: &TextureTable) -> Result<Color, MaterialError> {
        let channels = |color: Option<Rgb>| color.into_iter().flat_map(Rgb::to_array);
        channels(self.eta).try_for_each(|v| in_range("eta", v, 1e-3, 1e3))?;
        channels(self.k).try_for_each(|v| in_range("k", v, 0.0, 1e3))?;
        if let Some(metal) = self.metal {
            return Ok(Color::Measured(metal.fresnel()));
        }
        match (self.eta, self.k) {
            (Some(eta), Some(k)) => Ok(Color::Measured(Fresnel::Complex { eta, k })),
            (None, None) => {
                let f0 = textures.resolve("reflectance", &self.reflectance)?;
                Ok(match self.grazing {
                    Some(grazing) => Color::Schlick(f0, grazing),
                    None => Color::Tinted(f0, textures.resolve("edge_tint", &self.edge_tint)?),
                })
            }
            (eta, _) => {
                let field = if eta.is_some() { "k" } else { "eta" };
                Err(MaterialError::Invalid { field, message: "`eta` and `k` must be given together".into() })
            }
        }
    }
}

impl CompiledConductor {
    fn at(&self, textures: &TextureTable, at: &TextureLookup) -> ConductorLobe {
        let fresnel = match &self.color {
            Color::Measured(fresnel) => *fresnel,
            Color::Tinted(f0, edge) => Fresnel::tinted(unit_color(textures, f0, at), unit_color(textures, edge, at)),
            Color::Schlick(f0, f90) => Fresnel::Schlick { f0: unit_color(textures, f0, at), f90: *f90 },
        };
        let alpha = self.roughness.alpha(textures, at);
        if self.compensated { ConductorLobe::compensated(fresnel, alpha) } else { ConductorLobe::new(fresnel, alpha) }
    }
}

impl ScatteringMaterial for CompiledConductor {
    #[inline]
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        match self.constant_lobe {
            Some(constant_lobe) => bsdf.push(constant_lobe),
            None => bsdf.push(self.at(textures, &view.lookup())),
        }
    }

    fn is_textured(&self) -> bool {
        let colors = match &self.color {
            Color::Measured(_) => false,
            Color::Tinted(f0, edge) => f0.is_texture() || edge.is_texture(),
            Color::Schlick(f0, _) => f0.is_texture(),
        };
        colors || self.roughness.is_textured()
    }

    fn rotation_turns(&self, textures: &TextureTable, view: &ShadingView) -> Option<f32> {
        self.roughness.rotation_turns(textures, view)
    }

    fn is_anisotropic(&self) -> bool {
        self.roughness.is_anisotropic()
    }
}

impl MetalName {
    fn name(self) -> &'static str {
        match self {
            Self::Aluminum => "aluminum",
            Self::Brass => "brass",
            Self::Chromium => "chromium",
            Self::Cobalt => "cobalt",
            Self::Copper => "copper",
            Self::Gold => "gold",
            Self::Iron => "iron",
            Self::Nickel => "nickel",
            Self::Platinum => "platinum",
            Self::Silver => "silver",
            Self::Titanium => "titanium",
            Self::Tungsten => "tungsten",
            Self::Zinc => "zinc",
        }
    }

    /// Fresnel reflectance of the metal in air.
    fn fresnel(self) -> Fresnel {
        Metal::named(self.name()).map_or(Fresnel::WHITE, Metal::fresnel)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Conductor {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let gold = Self { metal: Some(MetalName::Gold), roughness: 0.4.into(), ..Self::default() };
        let indices = Self {
            eta: Some(Rgb::splat(0.2)),
            k: Some(Rgb::splat(3.0)),
            energy_compensation: false,
            roughness: 0.3.into(),
            ..Self::default()
        };
        let brushed = Self { anisotropy: 0.8.into(), roughness: Input::Texture("tiles".into()), ..Self::default() };
        let front = Self { sides: SurfaceSides::Front, ..gold.clone() };
        vec![Self::default(), gold, indices, brushed, front]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MaterialCompiler;
    use juggler_bsdf::metals::METALS;

    fn parse(name: &str) -> Result<MetalName, serde_json::Error> {
        serde_json::from_value(name.into())
    }

    #[test]
    fn every_metal_has_a_name_in_scenes() {
        for metal in METALS {
            let name = parse(metal.name).unwrap();
            assert_eq!(name.fresnel(), metal.fresnel());
            assert_eq!(serde_json::to_value(name).unwrap(), metal.name);
        }
        assert!(parse("unobtainium").is_err() && parse("Gold").is_err());
    }

    fn compile(conductor: &Conductor) -> Result<(), (String, String)> {
        let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
        let compiled = compiler.compile(&conductor.clone().into());
        compiled.map(drop).map_err(|error| (error.path(), error.to_string()))
    }

    #[test]
    fn indices_beside_a_metal_are_checked_and_named_as_ineffective() {
        let of = |json: &str| serde_json::from_str::<Conductor>(json).unwrap();
        let wrong = [
            (r#"{"metal": "gold", "eta": [5000, 1, 1]}"#, "conductor.eta"),
            (r#"{"metal": "gold", "k": [1, -1, 1]}"#, "conductor.k"),
            (r#"{"eta": [1, 1, 1], "k": [1, 1, 5000]}"#, "conductor.k"),
            (r#"{"eta": [1, 1, 1]}"#, "conductor.k"),
        ];
        for (json, path) in wrong {
            assert_eq!(compile(&of(json)).unwrap_err().0, path, "{json}");
        }
        let known: [(&str, &str, &[&str]); 6] = [
            (r#"{"metal": "gold", "roughness": 0.2}"#, "", &[]),
            (r#"{"metal": "gold", "eta": [1, 1, 1]}"#, "metal", &["eta"]),
            (
                r#"{"metal": "gold", "eta": [1, 1, 1], "k": [1, 1, 1], "grazing": [1, 1, 1]}"#,
                "metal",
                &["eta", "k", "grazing"],
            ),
            (r#"{"eta": [1, 1, 1], "k": [1, 1, 1], "reflectance": [0.5, 0.5, 0.5]}"#, "eta", &["reflectance"]),
            (r#"{"grazing": [1, 1, 1], "edge_tint": [0.5, 0.5, 0.5]}"#, "grazing", &["edge_tint"]),
            (r#"{"reflectance": [0.5, 0.5, 0.5], "edge_tint": [0.5, 0.5, 0.5]}"#, "", &[]),
        ];
        for (json, replaced_by, fields) in known {
            assert_eq!(compile(&of(json)), Ok(()), "{json}");
            let expected: Vec<_> = fields.iter().map(|&field| IneffectiveSetting { field, replaced_by }).collect();
            assert_eq!(of(json).ineffective_settings(), expected, "{json}");
        }
    }

    #[test]
    fn aluminum_may_be_spelled_aluminium() {
        let both = ["aluminum", "aluminium"].map(|name| parse(name).unwrap());
        assert_eq!(both, [MetalName::Aluminum; 2]);
        assert_eq!(serde_json::to_value(both[1]).unwrap(), "aluminum");
    }
}
