//! Files that an OBJ names: libraries and textures. Names of other systems are understood, but only
//! files in the folder of the OBJ are read.

use crate::gltf::Warnings;
use juggler_scene::PictureReading;
use juggler_scene::model::{FileDigest, FileError, Files};

/// Maximum number of bytes of all files that an OBJ names.
const MAX_BYTES: u64 = 1 << 32;
/// Maximum number of files that an OBJ names.
const MAX_FILES: usize = 65_536;

/// Files that remember what was read.
pub struct Reader<'f> {
    files: &'f dyn Files,
    /// The files in the order of reading.
    pub read: Vec<FileDigest>,
    bytes_left: u64,
}

impl<'f> Reader<'f> {
    /// No files yet.
    pub fn new(files: &'f dyn Files) -> Self {
        Self { files, read: Vec::new(), bytes_left: MAX_BYTES }
    }

    /// Whether pictures that are missing or broken are shown gray.
    pub fn is_lenient(&self) -> bool {
        self.files.is_lenient()
    }

    /// What is read of pictures.
    pub fn pictures(&self) -> PictureReading {
        self.files.pictures()
    }

    /// Reads the file that `name`, as written in a file in `folder`, means. Returns its name and
    /// content; `None` if there is no such file. A warning at `place` tells when another name than
    /// the written one is used.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or the limit of bytes is exceeded.
    pub fn find(
        &mut self,
        folder: &str,
        name: &str,
        place: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<(String, Vec<u8>)>, FileError> {
        for (index, candidate) in candidates(folder, name).into_iter().enumerate() {
            let bytes = match self.files.read(&candidate, self.bytes_left) {
                Err(FileError::Missing) => continue,
                Err(error) => return Err(error),
                Ok(_) if self.read.len() >= MAX_FILES => {
                    return Err(FileError::Read(format!("the model names more than {MAX_FILES} files, the limit")));
                }
                Ok(bytes) => bytes,
            };
            let is_other = index > 0 || direct(folder, name).is_none();
            warnings.add(place, "names of files differ in path or case from the files found", u64::from(is_other));
            self.bytes_left = self.bytes_left.saturating_sub(bytes.len() as u64);
            self.read.push(FileDigest { name: candidate.clone(), digest: blake3::hash(&bytes).into() });
            return Ok(Some((candidate, bytes)));
        }
        Ok(None)
    }
}

/// Folder of a file, without a separator at its end.
pub fn folder_of(name: &str) -> &str {
    name.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// Names to try, the best one first: as written, then its last part beside, each in other cases
/// too.
fn candidates(folder: &str, name: &str) -> Vec<String> {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let mut found = Vec::new();
    for name in direct(folder, name).into_iter().chain(direct(folder, last)) {
        let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
        let other = |ending: String| if ending.is_empty() { stem.to_owned() } else { format!("{stem}.{ending}") };
        let others =
            [other(ending.to_ascii_lowercase()), other(ending.to_ascii_uppercase()), name.to_ascii_lowercase()];
        for candidate in std::iter::once(name.clone()).chain(others) {
            if !found.contains(&candidate) {
                found.push(candidate);
            }
        }
    }
    found
}

/// Name of a file relative to the folder of the OBJ; `None` for absolute names, names that leave
/// the folder, and names with control characters.
fn direct(folder: &str, name: &str) -> Option<String> {
    let name = name.trim().replace('\\', "/");
    let has_drive = name.as_bytes().get(1) == Some(&b':');
    if name.starts_with('/') || has_drive || name.contains("://") || name.chars().any(char::is_control) {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(name.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            part => parts.push(part),
        }
    }
    let is_file = !parts.is_empty() && !name.ends_with(['/', '.']);
    is_file.then(|| parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn names_of_other_systems_are_found_beside() {
        let files = ["wood.png", "tex/Stone 1.PNG", "sub/a.png"].map(|name| (name.to_owned(), vec![1, 2]));
        let files = BTreeMap::from(files);
        let mut reader = Reader::new(&files);
        let cases = [
            ("", "wood.png", "wood.png", 0),
            ("", "./wood.png ", "wood.png", 0),
            ("", "WOOD.PNG", "wood.png", 1),
            ("", "C:\\art\\wood.png", "wood.png", 1),
            ("", "/home/a/wood.png", "wood.png", 1),
            ("", "../wood.png", "wood.png", 1),
            ("", "tex\\Stone 1.png", "tex/Stone 1.PNG", 1),
            ("sub", "a.png", "sub/a.png", 0),
            ("sub", "../wood.png", "wood.png", 0),
        ];
        for (folder, name, expected, warned) in cases {
            let mut warnings = Warnings::default();
            let found = reader.find(folder, name, "a.mtl:1", &mut warnings).unwrap().unwrap();
            assert_eq!((found.0.as_str(), warnings.list().len()), (expected, warned), "{name}");
        }
        for name in ["", ".", "..", "/", "a\0", "none.png", "\\\\", "https://a/none.png", "../../x"] {
            assert_eq!(reader.find("", name, "a.mtl:1", &mut Warnings::default()).unwrap(), None, "{name}");
        }
        assert_eq!((folder_of("a/b/c.mtl"), folder_of("c.mtl")), ("a/b", ""));
    }
}
