//! Names of modules, classes and fields.

/// Keywords of Python that a field of the scene format may have as its name.
const KEYWORDS: [&str; 35] = [
    "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del",
    "elif", "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda", "nonlocal",
    "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

/// Classes whose name is not that of their definition or kind.
const RENAMED: [(&str, &str); 2] = [("Render", "RenderSettings"), ("animate", "Keys")];

/// Name in CamelCase: `thin_lens` becomes `ThinLens`.
pub fn camel(name: &str) -> String {
    name.split('_').map(capital).collect()
}

/// Name of the class of a kind.
pub fn kind_class(kind: &str) -> String {
    renamed(kind).map_or_else(|| camel(kind), str::to_owned)
}

/// Name of the class of a definition that is no kind. Definitions of one generic type share a
/// class: `InputProduct_Color` and `InputProduct_float` become `InputProduct`.
pub fn definition_class(definition: &str) -> String {
    let name = definition.split('_').next().unwrap_or(definition);
    renamed(name).unwrap_or(name).to_owned()
}

/// Singular of a family's definition, in CamelCase: `AnyShape` becomes `Shape`.
pub fn family(definition: &str) -> Option<&str> {
    definition.strip_prefix("Any").filter(|noun| noun.starts_with(char::is_uppercase))
}

/// Module of a family: `AnyShape` becomes `shapes`.
pub fn family_module(definition: &str) -> Option<String> {
    Some(format!("{}s", family(definition)?.to_lowercase()))
}

/// Name of the field of a key; `None` if the key is no identifier, such as `$schema`.
pub fn field(key: &str) -> Option<String> {
    let is_identifier = key.starts_with(|c: char| c.is_ascii_alphabetic())
        && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let keyword = if KEYWORDS.contains(&key) { "_" } else { "" };
    is_identifier.then(|| format!("{key}{keyword}"))
}

fn renamed(name: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(from, _)| *from == name).map(|(_, to)| *to)
}

fn capital(word: &str) -> String {
    let mut characters = word.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}
