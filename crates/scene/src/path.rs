//! Paths to values in a scene: `objects[0].shape.sphere.radius`.

use std::fmt;

/// A step from a value to one of its children.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Member of an object, by key.
    Key(String),
    /// Element of an array, by index.
    Index(usize),
}

/// Path from the root of a scene to a value.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path(Vec<Step>);

impl Path {
    /// Path of the whole scene.
    pub fn root() -> Self {
        Self::default()
    }

    /// Appends a key.
    #[must_use]
    pub fn key(&self, key: impl Into<String>) -> Self {
        self.step(Step::Key(key.into()))
    }

    /// Appends an index.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.step(Step::Index(index))
    }

    /// Appends a path in text form such as `vertices[3].x`, as the renderer's own errors have it.
    #[must_use]
    pub fn join(&self, written: &str) -> Self {
        let mut path = self.clone();
        for part in written.split(['.', '[']).map(|part| part.trim_end_matches(']')).filter(|part| !part.is_empty()) {
            path.0.push(part.parse().map_or_else(|_| Step::Key(part.to_owned()), Step::Index));
        }
        path
    }

    /// The path as a JSON pointer (RFC 6901): `/materials/red/phong/diffuse`.
    pub fn pointer(&self) -> String {
        let step = |step: &Step| match step {
            Step::Key(key) => format!("/{}", key.replace('~', "~0").replace('/', "~1")),
            Step::Index(index) => format!("/{index}"),
        };
        self.0.iter().map(step).collect()
    }

    /// Parses a JSON pointer. Numeric steps are array indices, except for the second step in
    /// sections whose keys are names.
    pub fn from_pointer(pointer: &str) -> Self {
        let mut path = Self::root();
        for step in pointer.split('/').skip(1).map(|step| step.replace("~1", "/").replace("~0", "~")) {
            let is_name = matches!(path.0.as_slice(), [Step::Key(part)] if part != "objects" && part != "lights");
            path.0.push(match step.parse() {
                Ok(index) if !is_name => Step::Index(index),
                _ => Step::Key(step),
            });
        }
        path
    }

    /// Parses a path as messages print it, such as `objects[3].shape["my sphere"].radius`, or a
    /// JSON pointer. `None` for a text that is neither.
    pub fn parse(text: &str) -> Option<Self> {
        if text.starts_with('/') {
            return Some(Self::from_pointer(text));
        }
        let (mut path, mut rest) = (Self::root(), text);
        while !rest.is_empty() {
            let is_first = path.0.is_empty();
            let (step, after) = match rest.strip_prefix('[') {
                Some(bracketed) => bracketed_step(bracketed)?,
                None => plain_step(if is_first { rest } else { rest.strip_prefix('.')? })?,
            };
            path.0.push(step);
            rest = after;
        }
        Some(path)
    }

    /// Creates a path of these steps.
    pub(crate) fn from_steps<'p>(steps: impl IntoIterator<Item = &'p Step>) -> Self {
        Self(steps.into_iter().cloned().collect())
    }

    /// Steps in order.
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Appends a step; [`Path::pop`] removes it again.
    pub(crate) fn push(&mut self, step: Step) {
        self.0.push(step);
    }

    /// Removes the last step.
    pub(crate) fn pop(&mut self) {
        self.0.pop();
    }

    fn step(&self, step: Step) -> Self {
        let mut steps = Vec::with_capacity(self.0.len() + 1);
        steps.extend_from_slice(&self.0);
        steps.push(step);
        Self(steps)
    }
}

/// A key without brackets, and the text after it.
fn plain_step(text: &str) -> Option<(Step, &str)> {
    let (key, after) = text.split_at(text.find(['.', '[']).unwrap_or(text.len()));
    (!key.is_empty()).then(|| (Step::Key(key.to_owned()), after))
}

/// An index or a quoted key, without its opening bracket, and the text after the closing one.
fn bracketed_step(text: &str) -> Option<(Step, &str)> {
    if !text.starts_with('"') {
        let (index, after) = text.split_once(']')?;
        return Some((Step::Index(index.parse().ok()?), after));
    }
    let mut is_escaped = false;
    let end = text.char_indices().skip(1).find(|(_, character)| {
        let ends = *character == '"' && !is_escaped;
        is_escaped = *character == '\\' && !is_escaped;
        ends
    });
    let (quoted, after) = text.split_at(end?.0 + 1);
    Some((Step::Key(serde_json::from_str(quoted).ok()?), after.strip_prefix(']')?))
}

/// Path on the stack of a recursive walk: each step refers to its parent. Memory is allocated only
/// when an error turns it into a [`Path`].
#[derive(Clone, Copy, Debug)]
pub enum PathRef<'t> {
    /// Root of the scene.
    Root,
    /// Member of an object, by key.
    Key(&'t PathRef<'t>, &'t str),
    /// Element of an array, by index.
    Index(&'t PathRef<'t>, usize),
}

impl<'t> PathRef<'t> {
    /// Appends a key.
    #[must_use]
    pub fn key(&'t self, key: &'t str) -> Self {
        Self::Key(self, key)
    }

    /// Appends an index.
    #[must_use]
    pub fn index(&'t self, index: usize) -> Self {
        Self::Index(self, index)
    }

    /// Appends a path in text form, as [`Path::join`] does.
    #[must_use]
    pub fn join(&self, written: &str) -> Path {
        Path::from(self).join(written)
    }

    /// Whether the path is the root of the scene.
    pub fn is_root(&self) -> bool {
        matches!(self, Self::Root)
    }

    /// Last key of the path.
    pub fn last_key(&self) -> Option<&'t str> {
        match self {
            Self::Root => None,
            Self::Key(_, key) => Some(key),
            Self::Index(parent, _) => parent.last_key(),
        }
    }
}

impl From<&PathRef<'_>> for Path {
    fn from(path: &PathRef<'_>) -> Self {
        fn steps(path: &PathRef<'_>, after: usize) -> Vec<Step> {
            let (parent, step) = match path {
                PathRef::Root => return Vec::with_capacity(after),
                PathRef::Key(parent, key) => (parent, Step::Key((*key).to_owned())),
                PathRef::Index(parent, index) => (parent, Step::Index(*index)),
            };
            let mut steps = steps(parent, after + 1);
            steps.push(step);
            steps
        }
        Self(steps(path, 0))
    }
}

impl From<&Self> for Path {
    fn from(path: &Self) -> Self {
        path.clone()
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Key(key) if is_plain(key) => write!(f, "{}{key}", if i == 0 { "" } else { "." })?,
                Step::Key(key) => write!(f, "[{key:?}]")?,
            }
        }
        Ok(())
    }
}

/// Whether a key needs no quotes in a written path.
fn is_plain(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_pointers_round_trip() {
        let path = Path::root().key("materials").key("7").key("phong").key("a/b~1").index(3).key("color");
        assert_eq!(path.pointer(), "/materials/7/phong/a~1b~01/3/color");
        assert_eq!(Path::from_pointer(&path.pointer()), path);
        let object = Path::root().key("objects").index(3).key("material");
        assert_eq!(Path::from_pointer(&object.pointer()), object);
        assert_eq!(Path::from_pointer(""), Path::root());
    }

    #[test]
    fn paths_display_with_dots_and_brackets() {
        let path = Path::root().key("objects").index(3).key("shape").key("my sphere").join("vertices[7].x");
        assert_eq!(path.to_string(), "objects[3].shape[\"my sphere\"].vertices[7].x");
        assert_eq!(Path::root().to_string(), "");
        assert_eq!(Path::parse(&path.to_string()).as_ref(), Some(&path));
        assert_eq!(Path::parse(&path.pointer()).unwrap().pointer(), path.pointer());
        let odd = Path::root().key("materials").key("a\"]b\\").key("7");
        assert_eq!(Path::parse(&odd.to_string()), Some(odd));
        for wrong in ["objects[", "objects[x]", "objects[3", ".a", "a..b", "a[\"b]", "a[3]b"] {
            assert_eq!(Path::parse(wrong), None, "{wrong}");
        }
        let objects = PathRef::Root.key("objects");
        let path = objects.index(3);
        assert_eq!(Path::from(&path.key("shape")).to_string(), "objects[3].shape");
        assert_eq!(path.index(4).last_key(), Some("objects"));
    }
}
