//! `juggler view`: a window to walk around in a scene.

use crate::failure::Failure;
use crate::{source, value};
use clap::Args;
use juggler_session::{Options, Session};
use juggler_viewer::ViewerError;

/// The scene that is shown while one is chosen.
const FIRST: &str = "juggler";

/// Flags of `juggler view`.
#[derive(Debug, Args)]
pub struct View {
    /// A scene file or a mesh (PLY, OBJ, STL), which is watched, or the name of a built-in scene [default: the juggler, and a choice of others]
    scene: Option<String>,
    /// Width and height of the picture in pixels [default: those of the scene]
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    size: Option<[u32; 2]>,
    /// Threads that render [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl View {
    /// Opens the window, and returns when it is closed.
    pub fn run(self) -> Result<(), Failure> {
        let choose = self.scene.is_none();
        let name = self.scene.unwrap_or_else(|| FIRST.into());
        source::find(&name)?;
        let threads = self.threads.map_or(0, usize::from);
        let session = Session::open(&name, Options { size: self.size, threads, watch: true, ..Options::default() });
        Ok(juggler_viewer::run(session, juggler_viewer::Options { choose })?)
    }
}

impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Self {
        Self::System(error.to_string())
    }
}
