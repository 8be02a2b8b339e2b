//! Places inside a scene: `objects[0].shape.sphere.radius`.

use std::fmt;

/// One step from a value to a value inside it.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Into an object, by key.
    Key(String),
    /// Into an array, by position.
    Index(usize),
}

/// The way from the top of a scene to one of its values.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path(Vec<Step>);

impl Path {
    /// The top of the scene.
    pub fn root() -> Self {
        Self::default()
    }

    /// One step further, into an object.
    #[must_use]
    pub fn key(&self, key: impl Into<String>) -> Self {
        self.step(Step::Key(key.into()))
    }

    /// One step further, into an array.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.step(Step::Index(index))
    }

    /// Further by a written path such as `vertices[3].x`, which the tracer's own errors name.
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

    /// The path that a JSON pointer writes. Numbers are places in arrays, but for names of cameras, textures, materials and
    /// groups.
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

    /// The way that these steps go.
    pub(crate) fn from_steps<'p>(steps: impl IntoIterator<Item = &'p Step>) -> Self {
        Self(steps.into_iter().cloned().collect())
    }

    /// The steps in order.
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Goes one step down, for a walk that comes back up with [`Path::pop`].
    pub(crate) fn push(&mut self, step: Step) {
        self.0.push(step);
    }

    /// Back up one step.
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

/// A path on the stack of a recursive walk: each step knows the one before. Costs nothing until something is
/// wrong and it becomes a [`Path`].
#[derive(Clone, Copy, Debug)]
pub enum Trail<'t> {
    /// The top of the scene.
    Root,
    /// Into an object, by key.
    Key(&'t Trail<'t>, &'t str),
    /// Into an array, by position.
    Index(&'t Trail<'t>, usize),
}

impl<'t> Trail<'t> {
    /// One step further, into an object.
    #[must_use]
    pub fn key(&'t self, key: &'t str) -> Self {
        Self::Key(self, key)
    }

    /// One step further, into an array.
    #[must_use]
    pub fn index(&'t self, index: usize) -> Self {
        Self::Index(self, index)
    }

    /// Further by a written path, as [`Path::join`].
    #[must_use]
    pub fn join(&self, written: &str) -> Path {
        Path::from(self).join(written)
    }

    /// Whether it is the top of the scene.
    pub fn is_root(&self) -> bool {
        matches!(self, Self::Root)
    }

    /// The last key on the way.
    pub fn last_key(&self) -> Option<&'t str> {
        match self {
            Self::Root => None,
            Self::Key(_, key) => Some(key),
            Self::Index(parent, _) => parent.last_key(),
        }
    }
}

impl From<&Trail<'_>> for Path {
    fn from(trail: &Trail<'_>) -> Self {
        fn steps(trail: &Trail<'_>, after: usize) -> Vec<Step> {
            let (parent, step) = match trail {
                Trail::Root => return Vec::with_capacity(after),
                Trail::Key(parent, key) => (parent, Step::Key((*key).to_owned())),
                Trail::Index(parent, index) => (parent, Step::Index(*index)),
            };
            let mut steps = steps(parent, after + 1);
            steps.push(step);
            steps
        }
        Self(steps(trail, 0))
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

/// Whether a key can stand in a written path without quotes.
fn is_plain(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_lead_back() {
        let path = Path::root().key("materials").key("7").key("phong").key("a/b~1").index(3).key("color");
        assert_eq!(path.pointer(), "/materials/7/phong/a~1b~01/3/color");
        assert_eq!(Path::from_pointer(&path.pointer()), path);
        let object = Path::root().key("objects").index(3).key("material");
        assert_eq!(Path::from_pointer(&object.pointer()), object);
        assert_eq!(Path::from_pointer(""), Path::root());
    }

    #[test]
    fn is_written_as_people_write_it() {
        let path = Path::root().key("objects").index(3).key("shape").key("my sphere").join("vertices[7].x");
        assert_eq!(path.to_string(), "objects[3].shape[\"my sphere\"].vertices[7].x");
        assert_eq!(Path::root().to_string(), "");
        let objects = Trail::Root.key("objects");
        let trail = objects.index(3);
        assert_eq!(Path::from(&trail.key("shape")).to_string(), "objects[3].shape");
        assert_eq!(trail.index(4).last_key(), Some("objects"));
    }
}
