//! Bombs: small files and command lines that ask for much, or are what no program expects. Each is given to the program, which
//! must answer within ten seconds, in the memory that it was allowed, with a picture or a message that names the place.

mod claims;
mod counts;
mod nesting;
mod places;
mod run;
mod sizes;
mod strings;
mod times;

pub use run::{Verdict, run};

/// What a file of a bomb is.
#[derive(Clone, Debug)]
pub enum Content {
    /// A file of these bytes.
    Bytes(Vec<u8>),
    /// A named pipe that nobody writes to.
    Pipe,
    /// A link to that path.
    Link(String),
    /// A folder.
    Folder,
    /// A file that may not be read.
    Closed,
}

/// Small files, and the command lines that read them.
#[derive(Clone, Debug)]
pub struct Bomb {
    /// The class that it belongs to.
    pub class: &'static str,
    /// What it is.
    pub name: String,
    /// Files by name.
    pub files: Vec<(String, Content)>,
    /// What is run in their folder, without the program's name.
    pub lines: Vec<String>,
    /// What a message must contain where the bomb is refused.
    pub place: String,
}

impl Bomb {
    /// A scene that is checked and rendered; a refusal contains `place`.
    fn scene(class: &'static str, name: impl Into<String>, text: impl Into<Vec<u8>>, place: &str) -> Self {
        let lines = vec![
            "check bomb.json".to_owned(),
            "render bomb.json --size 8x8 --samples 1 --threads 2 --max-memory 512M -o bomb.pfm".to_owned(),
        ];
        let files = vec![("bomb.json".to_owned(), Content::Bytes(text.into()))];
        Self { class, name: name.into(), files, lines, place: place.to_owned() }
    }

    /// The same with another file beside the scene.
    fn with(mut self, name: &str, content: Content) -> Self {
        self.files.push((name.to_owned(), content));
        self
    }

    /// A command line; a refusal contains `place`.
    fn line(class: &'static str, line: impl Into<String>, place: &str) -> Self {
        let line = line.into();
        let scene = r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#;
        let files = vec![("good.json".to_owned(), Content::Bytes(scene.into()))];
        Self { class, name: line.clone(), files, lines: vec![line], place: place.to_owned() }
    }
}

/// A scene of these objects.
fn objects(objects: &str) -> String {
    format!(r#"{{"version": 1, "objects": [{objects}]}}"#)
}

/// All bombs, at least eight of each class.
pub fn all() -> Vec<Bomb> {
    [
        nesting::bombs(),
        counts::bombs(),
        sizes::bombs(),
        claims::bombs(),
        times::bombs(),
        strings::bombs(),
        places::bombs(),
    ]
    .concat()
}
