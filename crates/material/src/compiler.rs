//! Compiles material descriptions into a [`MaterialTable`].

use super::phong::CompiledPhong;
use super::{AnyMaterial, CompiledMaterial, MaterialError, MaterialId, MaterialRef, MaterialResolver, MaterialTable};
use juggler_texture::TextureTable;
use std::collections::BTreeMap;

/// Maximum depth of materials nested in each other.
pub const MAX_NESTING: usize = 64;

/// Compiles a scene's materials: each named material once, inline materials where they occur.
///
/// Compile materials with [`MaterialResolver::material`] or [`MaterialCompiler::compile`], then
/// call [`MaterialCompiler::finish`].
#[derive(Debug)]
pub struct MaterialCompiler {
    table: MaterialTable,
    named: BTreeMap<String, State>,
    errors: Vec<(String, MaterialError)>,
    depth: usize,
}

#[derive(Debug)]
enum State {
    Waiting(Box<AnyMaterial>),
    InProgress,
    Done(MaterialId),
}

impl MaterialCompiler {
    /// Compiler for a scene's textures and named materials.
    pub fn new(textures: TextureTable, named: impl IntoIterator<Item = (String, AnyMaterial)>) -> Self {
        let named = named.into_iter().map(|(name, material)| (name, State::Waiting(Box::new(material)))).collect();
        Self { table: MaterialTable::new(textures), named, errors: Vec::new(), depth: 0 }
    }

    /// Names of all named materials in sorted order, for suggestions in messages.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.named.keys().map(String::as_str)
    }

    /// Named materials that are compiled so far, with their ids.
    pub fn compiled(&self) -> impl Iterator<Item = (&str, MaterialId)> {
        self.named.iter().filter_map(|(name, state)| match state {
            State::Done(id) => Some((name.as_str(), *id)),
            State::Waiting(_) | State::InProgress => None,
        })
    }

    /// Compiles one material. The path of an error starts with the material's kind.
    pub fn compile(&mut self, material: &AnyMaterial) -> Result<MaterialId, MaterialError> {
        self.depth += 1;
        let compiled = if self.depth > MAX_NESTING { Err(MaterialError::TooDeep) } else { material.compile(self) };
        self.depth -= 1;
        Ok(self.table.push(compiled.map_err(|error| error.within(material.name()))?))
    }

    /// Compiles the remaining named materials and returns the table.
    ///
    /// # Errors
    /// Names and errors of all named materials that are invalid.
    pub fn finish(mut self) -> Result<MaterialTable, Vec<(String, MaterialError)>> {
        let names: Vec<String> = self.named.keys().cloned().collect();
        for name in names {
            // Only an unknown name or a cycle would fail here, and neither is possible.
            let _ = self.by_name("", &name);
        }
        if self.errors.is_empty() {
            return Ok(self.table);
        }
        self.errors.sort_by(|a, b| a.0.cmp(&b.0));
        Err(self.errors)
    }

    /// Id of a named material, which is compiled on first use. An error inside it is reported once,
    /// for the material itself and not for its users.
    fn by_name(&mut self, field: &'static str, name: &str) -> Result<MaterialId, MaterialError> {
        let Some(state) = self.named.get_mut(name) else {
            return Err(MaterialError::UnknownMaterial { field, name: name.to_owned() });
        };
        let material = match std::mem::replace(state, State::InProgress) {
            State::Waiting(material) => material,
            State::InProgress => return Err(MaterialError::Cycle { field, name: name.to_owned() }),
            State::Done(id) => {
                *state = State::Done(id);
                return Ok(id);
            }
        };
        let id = self.compile(&material).unwrap_or_else(|error| {
            self.errors.push((name.to_owned(), error));
            self.table.push(CompiledMaterial::Phong(CompiledPhong::BLACK))
        });
        self.named.insert(name.to_owned(), State::Done(id));
        Ok(id)
    }
}

impl MaterialResolver for MaterialCompiler {
    fn textures(&self) -> &TextureTable {
        self.table.textures()
    }

    fn material(&mut self, field: &'static str, material: &MaterialRef) -> Result<MaterialId, MaterialError> {
        match material {
            MaterialRef::Name(name) => self.by_name(field, name),
            MaterialRef::Inline(material) => self.compile(material).map_err(|error| error.within(field)),
        }
    }

    fn add_nested(&mut self, compiled: CompiledMaterial) -> MaterialId {
        self.table.push(compiled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Checkerboard, Phong};
    use juggler_math::{Rgb, Vec2, Vec3};
    use juggler_shape::surface::Surface;

    fn compiler(json: &str) -> MaterialCompiler {
        let named: BTreeMap<String, AnyMaterial> = serde_json::from_str(json).unwrap();
        MaterialCompiler::new(TextureTable::default(), named)
    }

    fn named(compiler: &mut MaterialCompiler, name: &str) -> Result<MaterialId, MaterialError> {
        compiler.material("material", &MaterialRef::Name(name.into()))
    }

    fn errors(json: &str) -> Vec<(String, String, String)> {
        let errors = compiler(json).finish().unwrap_err();
        errors.into_iter().map(|(name, error)| (name, error.path(), error.to_string())).collect()
    }

    #[test]
    fn named_materials_are_compiled_once_and_selected_by_point() {
        let mut compiler = compiler(
            r#"{"board": {"checkerboard": {"size": 2, "even": "red", "odd": {"phong": {"diffuse": [0, 1, 0]}}}},
                "red": {"phong": {"diffuse": [1, 0, 0]}}}"#,
        );
        let board = named(&mut compiler, "board").unwrap();
        let red = named(&mut compiler, "red").unwrap();
        assert_eq!(named(&mut compiler, "board"), Ok(board));
        assert!(red.0 < board.0);
        assert_eq!(compiler.names().collect::<Vec<_>>(), ["board", "red"]);
        let table = compiler.finish().unwrap();
        let diffuse = |id, x| table.phong(id, &Surface::new(Vec3::X * x, 0.0, Vec3::Y, Vec2::ZERO)).unwrap().diffuse;
        assert_eq!(diffuse(red, 0.0), Rgb::new(1.0, 0.0, 0.0));
        assert_eq!((diffuse(board, 1.0), diffuse(board, 3.0)), (Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0)));
    }

    #[test]
    fn every_wrong_material_is_reported_once_where_it_stands() {
        let found = errors(
            r#"{"a": {"checkerboard": {"even": "b", "odd": {"phong": {"ior": -1}}}},
                "b": {"phong": {"shininess": -2}},
                "c": {"checkerboard": {"even": "b", "odd": "nobody"}},
                "d": {"phong": {"diffuse": "marble"}}}"#,
        );
        let paths: Vec<_> = found.iter().map(|(name, path, _)| format!("{name}: {path}")).collect();
        let expected =
            ["a: checkerboard.odd.phong.ior", "b: phong.shininess", "c: checkerboard.odd", "d: phong.diffuse"];
        assert_eq!(paths, expected);
        assert!(found[2].2.contains("nobody") && found[3].2.contains("marble"), "{found:?}");
    }

    #[test]
    fn cyclic_materials_are_rejected() {
        let found = errors(
            r#"{"a": {"checkerboard": {"even": "b"}}, "b": {"checkerboard": {"odd": "c"}},
                "c": {"checkerboard": {"even": "a"}}, "self": {"checkerboard": {"even": "self"}}}"#,
        );
        let paths: Vec<_> = found.iter().map(|(name, path, _)| format!("{name}: {path}")).collect();
        assert_eq!(paths, ["c: checkerboard.even", "self: checkerboard.even"]);
        assert!(found[0].2.contains("contains itself"));
    }

    #[test]
    fn endless_chains_are_refused_not_followed() {
        let chain = (0..100_000).map(|i| {
            let even = MaterialRef::Name(format!("{}", i + 1));
            (format!("{i}"), Checkerboard { even, ..Checkerboard::default() }.into())
        });
        let mut compiler = MaterialCompiler::new(TextureTable::default(), chain);
        named(&mut compiler, "0").unwrap();
        let errors = compiler.finish().unwrap_err();
        assert!(errors.iter().any(|(_, error)| error.to_string().contains("64 deep")), "{:?}", errors.first());
    }

    #[test]
    fn errors_at_the_place_of_use_name_the_field() {
        let mut compiler = compiler("{}");
        let error = named(&mut compiler, "gold").unwrap_err();
        assert_eq!((error.path().as_str(), error.to_string().as_str()), ("material", "no material is called `gold`"));
        let wrong = Phong { ior: 0.0, ..Phong::default() };
        assert_eq!(compiler.material("material", &wrong.into()).unwrap_err().path(), "material.phong.ior");
    }
}
