//! Bombs: small files and command lines that demand excessive resources or violate the program's
//! expectations. For each, the program must finish within ten seconds and its memory limit, with a
//! picture or with an error message that names the place.

mod counts;
mod headers;
mod nesting;
mod paths;
mod run;
mod sizes;
mod strings;
mod times;

pub use run::{BombResult, run};

/// Kind and content of a file.
#[derive(Clone, Debug)]
pub enum Content {
    /// Regular file with these bytes.
    Bytes(Vec<u8>),
    /// Named pipe without a writer.
    Pipe,
    /// Symbolic link to this path.
    Link(String),
    /// A folder.
    Folder,
    /// Regular file without read permission.
    Closed,
}

/// Small files, and the command lines that read them.
#[derive(Clone, Debug)]
pub struct Bomb {
    /// Class of the bomb.
    pub class: &'static str,
    /// Name of the bomb.
    pub name: String,
    /// Files by name.
    pub files: Vec<(String, Content)>,
    /// Command lines to run in the folder of the files, without the program's name.
    pub lines: Vec<String>,
    /// Text that the error message must contain if the program refuses the bomb.
    pub must_name: String,
}

impl Bomb {
    /// A scene to check and to render; an error message must contain `must_name`.
    fn from_scene(class: &'static str, name: impl Into<String>, text: impl Into<Vec<u8>>, must_name: &str) -> Self {
        let lines = vec![
            "check bomb.json".to_owned(),
            "render bomb.json --size 8x8 --samples 1 --threads 2 --max-memory 512M -o bomb.pfm".to_owned(),
        ];
        let files = vec![("bomb.json".to_owned(), Content::Bytes(text.into()))];
        Self { class, name: name.into(), files, lines, must_name: must_name.to_owned() }
    }

    /// Adds a file beside the scene.
    fn with_file(mut self, name: &str, content: Content) -> Self {
        self.files.push((name.to_owned(), content));
        self
    }

    /// A single command line; an error message must contain `must_name`.
    fn from_command_line(class: &'static str, line: impl Into<String>, must_name: &str) -> Self {
        let line = line.into();
        let scene = r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#;
        let files = vec![("good.json".to_owned(), Content::Bytes(scene.into()))];
        Self { class, name: line.clone(), files, lines: vec![line], must_name: must_name.to_owned() }
    }
}

/// JSON of a scene with these objects.
fn objects(objects: &str) -> String {
    format!(r#"{{"version": 1, "objects": [{objects}]}}"#)
}

/// All bombs, at least eight of each class.
pub fn all() -> Vec<Bomb> {
    [
        nesting::bombs(),
        counts::bombs(),
        sizes::bombs(),
        headers::bombs(),
        times::bombs(),
        strings::bombs(),
        paths::bombs(),
    ]
    .concat()
}
