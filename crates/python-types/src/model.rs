//! Classes of the package, as the schema describes them.

use crate::extensions::{Extension, extension};
use crate::names;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::fmt;

/// The definition of the value forms.
pub const VALUE_FORM: &str = "ValueForm";

/// Part of a schema that the generator does not understand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownSchema(String);

impl fmt::Display for UnknownSchema {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the schema has no Python form: {}", self.0)
    }
}

impl std::error::Error for UnknownSchema {}

/// All modules, with the schema.
#[derive(Debug)]
pub struct Model<'s> {
    root: &'s Value,
    /// Modules: the families, `animate` and `scene_types`.
    pub modules: Vec<Module<'s>>,
}

/// A module with its classes.
#[derive(Debug)]
pub struct Module<'s> {
    /// Name.
    pub name: String,
    /// Definition of the family, if the module has the kinds of one.
    pub family: Option<&'s str>,
    /// First sentence of the module's documentation.
    pub summary: String,
    /// Classes, in the order of the schema.
    pub classes: Vec<Class<'s>>,
}

/// A class: a kind of a family, or another object of the scene format.
#[derive(Debug)]
pub struct Class<'s> {
    /// Name.
    pub name: String,
    /// Key of the kind.
    pub kind: Option<&'s str>,
    /// Definition in the schema; `None` for the whole scene.
    pub definition: Option<&'s str>,
    /// Description.
    pub description: &'s str,
    /// Fields, in the order of the schema.
    pub fields: Vec<Field<'s>>,
    /// Members that have only one possible value.
    pub constants: Vec<(&'s str, &'s Value)>,
    /// Additions to what the schema has.
    pub extension: Option<&'static Extension>,
}

/// A field of a class.
#[derive(Debug)]
pub struct Field<'s> {
    /// Name in JSON.
    pub key: &'s str,
    /// Name in Python.
    pub name: String,
    /// Whether the schema requires the field.
    pub required: bool,
    /// Schema.
    pub schema: &'s Value,
}

impl<'s> Model<'s> {
    /// Reads a schema.
    pub fn new(root: &'s Value) -> Result<Self, UnknownSchema> {
        let mut model = Self { root, modules: Vec::new() };
        for (definition, schema) in model.definitions() {
            if let Some(name) = names::family_module(definition) {
                let summary = format!("Kinds of {name}.");
                let classes = model.kind_classes(&name, schema)?;
                model.modules.push(Module { name, family: Some(definition), summary, classes });
            }
        }
        let forms = model.definition(VALUE_FORM).ok_or_else(|| UnknownSchema("no value forms".into()))?;
        let classes = model.kind_classes("animate", forms)?;
        let summary = "Value forms, which replace a value that changes over time.".to_owned();
        model.modules.push(Module { name: "animate".into(), family: Some(VALUE_FORM), summary, classes });
        let classes = model.scene_classes("scene_types");
        let summary = "The scene and its parts that are no kinds of a family.".to_owned();
        model.modules.push(Module { name: "scene_types".into(), family: None, summary, classes });
        Ok(model)
    }

    /// The definitions of the schema.
    pub fn definitions(&self) -> impl Iterator<Item = (&'s str, &'s Value)> + use<'s> {
        let definitions = self.root.get("$defs").and_then(Value::as_object).into_iter().flatten();
        definitions.map(|(name, schema)| (name.as_str(), schema))
    }

    /// A definition of the schema.
    pub fn definition(&self, name: &str) -> Option<&'s Value> {
        self.root.get("$defs")?.get(name)
    }

    /// Class of a definition that is no kind.
    pub fn class_of(&self, definition: &str) -> Option<&Class<'s>> {
        let name = names::definition_class(definition);
        let scene_types = self.modules.iter().find(|module| module.name == "scene_types")?;
        scene_types.classes.iter().find(|class| class.name == name && class.definition.is_some())
    }

    fn kind_classes(&self, module: &str, family: &'s Value) -> Result<Vec<Class<'s>>, UnknownSchema> {
        let class = |kind: Kind<'s>| {
            let definition = reference(kind.content);
            let target = definition.and_then(|name| self.definition(name)).unwrap_or(kind.content);
            let texts = [target, kind.content, kind.variant].map(description);
            let object = object(target).ok_or_else(|| UnknownSchema(format!("kind `{}`", kind.name)))?;
            let description = texts.into_iter().find(|text| !text.is_empty()).unwrap_or_default();
            let class = Class::new(module, names::kind_class(kind.name), description, object);
            Ok(Class { kind: Some(kind.name), definition, ..class })
        };
        kinds(family).map(class).collect()
    }

    /// Classes of the scene and of the objects that are no kinds. Definitions of one generic type
    /// share the class of the first, whose color accepts what the numbers of the others accept.
    fn scene_classes(&self, module: &str) -> Vec<Class<'s>> {
        let scene = self.root.as_object().map(|root| Class::new(module, "Scene".into(), description(self.root), root));
        let mut classes: Vec<Class<'_>> = scene.into_iter().collect();
        let kinds = self.definitions().flat_map(|(_, schema)| kinds(schema));
        let contents: BTreeSet<&str> = kinds.filter_map(|kind| reference(kind.content)).collect();
        for (definition, schema) in self.definitions().filter(|(name, _)| !contents.contains(name)) {
            let name = names::definition_class(definition);
            if let Some(object) = object(schema).filter(|_| classes.iter().all(|class| class.name != name)) {
                let class = Class::new(module, name, description(schema), object);
                classes.push(Class { definition: Some(definition), ..class });
            }
        }
        classes
    }
}

impl<'s> Class<'s> {
    fn new(module: &str, name: String, description: &'s str, object: &'s Map<String, Value>) -> Self {
        let constants = properties(object).filter_map(|(key, schema)| Some((key.as_str(), schema.get("const")?)));
        let (constants, extension) = (constants.collect(), extension(module, &name));
        Self { name, kind: None, definition: None, description, fields: fields(object), constants, extension }
    }

    /// Fields that are also positional arguments: those of the extension, or the required fields if
    /// there are at most two.
    pub fn positional(&self) -> Vec<&str> {
        if let Some(extension) = self.extension {
            return extension.positional.to_vec();
        }
        let required: Vec<&str> = self.required().collect();
        if required.len() <= 2 { required } else { Vec::new() }
    }

    /// All fields, the positional ones first, as `Node` orders them.
    pub fn match_args(&self) -> Vec<&str> {
        let mut names = self.positional();
        let extra = self.extra().iter().map(|(name, _, _)| *name);
        let others = extra.chain(self.fields.iter().map(|field| field.name.as_str()));
        let others: Vec<&str> = others.filter(|name| !names.contains(name)).collect();
        names.extend(others);
        names
    }

    /// Fields that only the base class has: name, annotation and description.
    pub fn extra(&self) -> &'static [(&'static str, &'static str, &'static str)] {
        self.extension.map_or(&[], |extension| extension.extra)
    }

    /// Annotation of a field that accepts more than the schema has.
    pub fn accepts(&self, field: &str) -> Option<&'static str> {
        let accepts = self.extension.map_or(&[][..], |extension| extension.accepts);
        accepts.iter().find(|(name, _)| *name == field).map(|(_, annotation)| *annotation)
    }

    /// Fields without which there is no object.
    pub fn required(&self) -> impl Iterator<Item = &str> {
        let optional = self.extension.map_or(&[][..], |extension| extension.optional);
        let required = self.fields.iter().filter(|field| field.required).map(|field| field.name.as_str());
        required.filter(move |name| !optional.contains(name))
    }
}

/// A kind of a family, which is a variant of an externally tagged enum.
#[derive(Clone, Copy, Debug)]
pub struct Kind<'s> {
    /// Key.
    pub name: &'s str,
    /// Schema of the object with the key.
    pub variant: &'s Value,
    /// Schema of the key's value.
    pub content: &'s Value,
}

/// The kinds of a family.
pub fn kinds(family: &Value) -> impl Iterator<Item = Kind<'_>> {
    choices(family).flat_map(variants).filter_map(|variant| {
        let (name, content) = variant.get("properties")?.as_object()?.iter().next()?;
        Some(Kind { name, variant, content })
    })
}

/// The fixed words that a schema allows.
pub fn words(schema: &Value) -> Vec<&str> {
    let variants = choices(schema).flat_map(variants);
    let words = variants.flat_map(|variant| {
        let several = variant.get("enum").and_then(Value::as_array).into_iter().flatten();
        several.chain(variant.get("const")).filter_map(Value::as_str)
    });
    words.collect()
}

/// The object that a schema describes, if it is one whose keys are fixed.
pub fn object(schema: &Value) -> Option<&Map<String, Value>> {
    let objects = choices(schema).filter_map(Value::as_object);
    let closed = |object: &&Map<String, Value>| object.get("additionalProperties").is_some_and(|other| other == false);
    objects.filter(closed).find(|object| object.get("type").is_some_and(|name| name == "object"))
}

/// Name of the definition that a schema refers to.
pub fn reference(schema: &Value) -> Option<&str> {
    schema.get("$ref").and_then(Value::as_str)?.strip_prefix("#/$defs/")
}

/// Description of a schema; empty if it has none.
pub fn description(schema: &Value) -> &str {
    schema.get("description").and_then(Value::as_str).unwrap_or_default()
}

/// The branches of a choice, or the schema itself.
pub fn choices(schema: &Value) -> impl Iterator<Item = &Value> {
    let branches = schema.get("anyOf").and_then(Value::as_array);
    let own = branches.is_none().then_some(schema);
    branches.into_iter().flatten().chain(own)
}

/// The variants of an enum. Those that only list required keys belong to an object.
fn variants(schema: &Value) -> impl Iterator<Item = &Value> {
    let variants = schema.get("oneOf").and_then(Value::as_array).into_iter().flatten();
    variants.filter(|variant| variant.get("type").is_some())
}

fn properties(object: &Map<String, Value>) -> impl Iterator<Item = (&String, &Value)> {
    object.get("properties").and_then(Value::as_object).into_iter().flatten()
}

/// Fields of an object, without those that have only one possible value.
pub fn fields(object: &Map<String, Value>) -> Vec<Field<'_>> {
    let required: Vec<&Value> = object.get("required").and_then(Value::as_array).into_iter().flatten().collect();
    let free = properties(object).filter(|(_, schema)| schema.get("const").is_none());
    let fields = free.filter_map(|(key, schema)| {
        let required = required.iter().any(|name| *name == key);
        Some(Field { key, name: names::field(key)?, required, schema })
    });
    fields.collect()
}
