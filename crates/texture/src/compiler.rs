//! Compiles texture descriptions into a [`TextureTable`].

use super::check;
use super::{
    AnyTexture, Image, Input, InputValue, InvalidTexture, MipMap, SharedTexture, Slot, Space, TextureId, TextureTable,
    compiled,
};
use juggler_math::Rgb;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Maximum depth of textures nested in each other.
pub const MAX_NESTING: u32 = 32;

/// Maximum number of texture evaluations that one lookup may cause. Textures that each name the
/// next one twice would otherwise take exponential time.
pub const MAX_LOOKUPS: u32 = 1024;

/// Error in a texture's description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A value is invalid.
    #[error(transparent)]
    Invalid(#[from] InvalidTexture),
    /// The scene has no texture of this name.
    #[error("no texture is called `{name}`")]
    Unknown {
        /// Field that contains the name.
        field: String,
        /// The name.
        name: String,
    },
    /// A texture contains itself.
    #[error("the texture `{name}` contains itself")]
    Cycle {
        /// Field that closes the cycle.
        field: String,
        /// The name.
        name: String,
    },
    /// An image cannot be read.
    #[error("{0}")]
    Image(String),
    /// Textures are nested deeper than [`MAX_NESTING`].
    #[error("textures are nested more than {MAX_NESTING} deep here")]
    TooDeep,
    /// One lookup causes more evaluations than [`MAX_LOOKUPS`].
    #[error("one lookup of this texture needs more than {MAX_LOOKUPS} lookups of other textures")]
    TooMany,
}

impl TextureError {
    /// Path of the field at fault, inside the texture.
    pub fn path(&self) -> &str {
        match self {
            Self::Invalid(InvalidTexture { field, .. }) | Self::Unknown { field, .. } | Self::Cycle { field, .. } => {
                field
            }
            Self::Image(_) => "file",
            Self::TooDeep | Self::TooMany => "",
        }
    }

    /// Whether the error is an unknown name.
    pub fn is_unknown_name(&self) -> bool {
        matches!(self, Self::Unknown { .. })
    }
}

/// Source of the images of image textures.
pub trait Images {
    /// Pixels of the image of the texture named `texture`, or a message about the failure.
    fn image(&self, texture: &str, image: &Image) -> Result<Arc<MipMap>, String>;
}

/// Source that has no images.
pub struct NoImages;

impl Images for NoImages {
    fn image(&self, _: &str, image: &Image) -> Result<Arc<MipMap>, String> {
        Err(format!("cannot read `{}`: no image files are available here", image.file))
    }
}

/// Cost of one lookup of a texture.
#[derive(Clone, Copy, Debug)]
struct LookupCost {
    lookups: u32,
    depth: u32,
    /// Whether the texture, or one inside it, varies over the surface coordinates.
    over_uv: bool,
}

impl LookupCost {
    const SINGLE: Self = Self { lookups: 1, depth: 1, over_uv: false };

    /// Cost of a texture that evaluates another one `times` times per lookup.
    fn with_uses(self, other: Self, times: u32) -> Self {
        let lookups = self.lookups.saturating_add(other.lookups.saturating_mul(times));
        let over_uv = self.over_uv || other.over_uv;
        Self { lookups, depth: self.depth.max(other.depth.saturating_add(1)), over_uv }
    }
}

enum State {
    Waiting(Box<AnyTexture>),
    InProgress,
    Done(TextureId),
}

/// Resolves the names in a texture's description while it is compiled.
pub struct TextureResolver<'a> {
    states: BTreeMap<String, State>,
    textures: Vec<(SharedTexture, LookupCost)>,
    errors: Vec<(String, TextureError)>,
    images: &'a dyn Images,
    /// Name of the texture that is being compiled.
    name: String,
    /// Number of nested compilations in progress.
    depth: u32,
    /// Cost of the texture that is being compiled, so far.
    cost: LookupCost,
}

/// Compiles textures; see [`TextureTable::compile`].
pub fn compile(
    named: impl IntoIterator<Item = (String, AnyTexture)>,
    images: &dyn Images,
) -> (TextureTable, Vec<(String, TextureError)>) {
    let states: BTreeMap<_, _> =
        named.into_iter().map(|(name, texture)| (name, State::Waiting(Box::new(texture)))).collect();
    let names: Vec<String> = states.keys().cloned().collect();
    let mut resolver = TextureResolver {
        states,
        textures: Vec::new(),
        errors: Vec::new(),
        images,
        name: String::new(),
        depth: 0,
        cost: LookupCost::SINGLE,
    };
    let mut table = TextureTable::default();
    for name in names {
        // A known name that is not in progress always resolves.
        if let Ok(id) = resolver.by_name(&name, &name) {
            table.names.insert(name, id);
        }
    }
    table.over_uv = resolver.textures.iter().map(|(_, cost)| cost.over_uv).collect();
    table.textures = resolver.textures.into_iter().map(|(texture, _)| texture).collect();
    resolver.errors.sort_by(|a, b| a.0.cmp(&b.0));
    (table, resolver.errors)
}

impl TextureResolver<'_> {
    /// Resolves the color of `field`.
    pub fn color(&mut self, field: &str, input: &Input<Rgb>) -> Result<Slot<Rgb>, TextureError> {
        check::color(field, input)?;
        self.slot(field, input, 1)
    }

    /// Resolves the number of `field`.
    pub fn number(&mut self, field: &str, input: &Input<f32>) -> Result<Slot<f32>, TextureError> {
        self.slot(field, input, 1)
    }

    /// Resolves an input that each lookup evaluates `times` times.
    pub fn slot<T: InputValue>(&mut self, field: &str, input: &Input<T>, times: u32) -> Result<Slot<T>, TextureError> {
        match input {
            Input::Value(value) => Ok(Slot::Value(*value)),
            Input::Texture(name) => Ok(Slot::Texture(self.nested(field, name, times)?)),
            Input::Product(product) => {
                if let Some(message) = product.error(field) {
                    return Err(InvalidTexture::new(field, message).into());
                }
                let texture = product.texture_name().map(|name| self.nested(field, name, times)).transpose()?;
                Ok(Slot::product(product, texture))
            }
        }
    }

    /// Resolves an input that each lookup evaluates `times` times, with coordinates that replace the
    /// surface's.
    pub fn projected_slot<T: InputValue>(
        &mut self,
        field: &str,
        input: &Input<T>,
        times: u32,
    ) -> Result<Slot<T>, TextureError> {
        let over_uv = self.cost.over_uv;
        let slot = self.slot(field, input, times);
        self.cost.over_uv = over_uv;
        slot
    }

    /// Id of a texture that each lookup evaluates `times` times.
    fn nested(&mut self, field: &str, name: &str, times: u32) -> Result<TextureId, TextureError> {
        let id = self.by_name(field, name)?;
        let other = self.textures.get(id.0 as usize).map_or(LookupCost::SINGLE, |(_, cost)| *cost);
        self.cost = self.cost.with_uses(other, times);
        Ok(id)
    }

    /// Pixels of an image texture.
    pub fn image(&mut self, image: &Image) -> Result<Arc<MipMap>, TextureError> {
        self.images.image(&self.name, image).map_err(TextureError::Image)
    }

    /// Id of a named texture, which is compiled on first use. An error inside it is reported once,
    /// for the texture itself and not for its users.
    fn by_name(&mut self, field: &str, name: &str) -> Result<TextureId, TextureError> {
        let Some(state) = self.states.get_mut(name) else {
            return Err(TextureError::Unknown { field: field.to_owned(), name: name.to_owned() });
        };
        let texture = match std::mem::replace(state, State::InProgress) {
            State::Waiting(texture) => texture,
            State::InProgress => return Err(TextureError::Cycle { field: field.to_owned(), name: name.to_owned() }),
            State::Done(id) => {
                *state = State::Done(id);
                return Ok(id);
            }
        };
        let outer = std::mem::replace(&mut self.name, name.to_owned());
        let compiled = self.compile(&texture);
        self.name = outer;
        let compiled = compiled.unwrap_or_else(|error| {
            self.errors.push((name.to_owned(), error));
            (compiled::black(), LookupCost::SINGLE)
        });
        let id = TextureId(u32::try_from(self.textures.len()).unwrap_or(u32::MAX));
        self.textures.push(compiled);
        self.states.insert(name.to_owned(), State::Done(id));
        Ok(id)
    }

    fn compile(&mut self, texture: &AnyTexture) -> Result<(SharedTexture, LookupCost), TextureError> {
        if self.depth >= MAX_NESTING {
            return Err(TextureError::TooDeep);
        }
        texture.check()?;
        let outer = std::mem::replace(&mut self.cost, LookupCost::SINGLE);
        self.depth += 1;
        let compiled = texture.compile(self);
        self.depth -= 1;
        let cost = std::mem::replace(&mut self.cost, outer);
        match compiled? {
            _ if cost.depth > MAX_NESTING => Err(TextureError::TooDeep),
            _ if cost.lookups > MAX_LOOKUPS => Err(TextureError::TooMany),
            compiled => {
                Ok((compiled, LookupCost { over_uv: cost.over_uv || texture.space() == Some(Space::Uv), ..cost }))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mix, TextureLookup};

    fn compile_json(json: &str) -> (TextureTable, Vec<String>) {
        let named: BTreeMap<String, AnyTexture> = serde_json::from_str(json).unwrap();
        let (table, errors) = compile(named, &NoImages);
        (table, errors.iter().map(|(name, error)| format!("{name}: {}: {error}", error.path())).collect())
    }

    #[test]
    fn textures_use_textures_whatever_their_order() {
        let (table, errors) = compile_json(
            r#"{"a": {"checker": {"even": "b", "odd": [1, 0, 0]}}, "b": {"mix": {"a": 0, "b": "c", "amount": 0.5}},
                "c": {"constant": {"color": [0, 0.5, 1]}}}"#,
        );
        assert!(errors.is_empty(), "{errors:?}");
        let slot = table.resolve("diffuse", &Input::<Rgb>::Texture("a".into())).unwrap();
        assert_eq!(table.color(&slot, &TextureLookup::default()), Rgb::new(0.0, 0.25, 0.5));
        let at = TextureLookup { uv: juggler_math::Vec2::new(1.5, 0.5), ..TextureLookup::default() };
        assert_eq!(table.color(&slot, &at), Rgb::new(1.0, 0.0, 0.0));
    }

    #[test]
    fn textures_over_surface_coordinates_are_known() {
        let (table, errors) = compile_json(
            r#"{"a": {"checker": {}}, "b": {"checker": {"space": "local", "even": "c"}}, "c": {"mix": {"a": "a"}},
                "d": {"triplanar": {"texture": "a"}}, "e": {"noise": {}}, "f": {"noise": {"space": "uv"}},
                "g": {"brick": {"space": "world"}}, "h": {"mix": {"a": "d", "b": "g"}}}"#,
        );
        assert!(errors.is_empty(), "{errors:?}");
        let over_uv: Vec<&str> = table.names().filter(|name| table.is_over_uv(name)).collect();
        assert_eq!(over_uv, ["a", "b", "c", "f"]);
    }

    #[test]
    fn every_wrong_texture_is_reported_once_at_its_place() {
        let (table, errors) = compile_json(
            r#"{"a": {"checker": {"even": "b"}}, "b": {"checker": {"size": -1}}, "c": {"mix": {"a": "b", "b": "nobody"}},
                "d": {"ramp": {"input": "d"}}, "e": {"mix": {"a": "f"}}, "f": {"mix": {"b": "e"}}}"#,
        );
        let expected = [
            "b: size: `size` must be above 0, it is -1",
            "c: b: no texture is called `nobody`",
            "d: input: the texture `d` contains itself",
            "f: b: the texture `e` contains itself",
        ];
        assert_eq!(errors, expected);
        assert_eq!(table.names().count(), 6);
    }

    fn chain(names: impl Iterator<Item = (String, String)>) -> Vec<(String, TextureError)> {
        let mix = |next: String| Mix { a: Input::Texture(next), ..Mix::default() };
        compile(names.map(|(name, next)| (name, mix(next).into())), &NoImages).1
    }

    #[test]
    fn cycles_are_rejected_in_either_order() {
        let name = |i: u32| format!("{i:06}");
        let down = chain((0..20_000).map(|i| (name(i), name(i + 1))));
        let up = chain((1..20_000).map(|i| (name(i), name(i - 1))));
        for errors in [down, up] {
            assert!(errors.iter().any(|(_, error)| *error == TextureError::TooDeep), "{:?}", errors.first());
        }
        assert_eq!(chain((0..31).map(|i| (name(i), name(i + 1)))).len(), 1, "the last names nobody");
    }

    #[test]
    fn number_of_nested_lookups_is_limited() {
        let mix = |i: u32| {
            let next = Input::Texture(format!("{}", i + 1));
            Mix { a: next.clone(), b: next, ..Mix::default() }
        };
        let named = (0..20).map(|i| (format!("{i}"), mix(i).into()));
        let last = ("20".to_owned(), Mix::default().into());
        let errors = compile(named.chain([last]), &NoImages).1;
        assert!(matches!(errors.as_slice(), [(_, TextureError::TooMany), ..]), "{errors:?}");
    }
}
