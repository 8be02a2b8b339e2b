//! JSON pointers (RFC 6901) that are formatted only if a message needs them.

use std::fmt;

/// Location in a document: the steps from its root.
#[derive(Clone, Copy, Debug)]
pub struct Location<'l> {
    parent: Option<&'l Location<'l>>,
    step: Step<'l>,
}

#[derive(Clone, Copy, Debug)]
enum Step<'l> {
    Key(&'l str),
    Index(usize),
}

impl<'l> Location<'l> {
    /// Member of the root object.
    pub fn root(key: &'l str) -> Self {
        Self { parent: None, step: Step::Key(key) }
    }

    /// Member of the object at this location.
    pub fn key(&'l self, key: &'l str) -> Self {
        Self { parent: Some(self), step: Step::Key(key) }
    }

    /// Element of the array at this location.
    pub fn index(&'l self, index: usize) -> Self {
        Self { parent: Some(self), step: Step::Index(index) }
    }
}

impl fmt::Display for Location<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(parent) = self.parent {
            write!(formatter, "{parent}")?;
        }
        match self.step {
            Step::Key(key) => write!(formatter, "/{}", escaped(key)),
            Step::Index(index) => write!(formatter, "/{index}"),
        }
    }
}

/// A key as a token of a JSON pointer.
pub fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displays_a_json_pointer() {
        let (meshes, odd) = (Location::root("meshes"), "a/b~c");
        let mesh = meshes.index(3);
        assert_eq!(mesh.to_string(), "/meshes/3");
        assert_eq!(mesh.key(odd).to_string(), "/meshes/3/a~1b~0c");
    }
}
