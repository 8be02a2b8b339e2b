//! `juggler view`: an interactive window.

use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::{source, value};
use clap::Args;
use juggler_session::{Session, SessionOptions};
use juggler_viewer::ViewerError;

/// Scene that is shown until the user chooses one.
const FIRST: &str = "juggler";

/// Flags of `juggler view`.
#[derive(Debug, Args)]
pub struct View {
    /// Scene file, model (glTF) or mesh (PLY, OBJ, STL) to watch, or built-in scene [default:
    /// juggler, with a menu of scenes]
    scene: Option<String>,
    /// Width and height of the picture in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    size: Option<[u32; 2]>,
    /// Number of rendering threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(flatten)]
    model: ModelArgs,
}

impl View {
    /// Opens the window and returns when it is closed.
    pub fn run(self) -> Result<(), Failure> {
        let choose = self.scene.is_none();
        let name = self.scene.unwrap_or_else(|| FIRST.into());
        source::find(&name)?;
        let threads = self.threads.map_or(0, usize::from);
        let model = ModelArgs { size: self.size, ..self.model };
        let (size, values, lenient) = (self.size, source::model_values(&name, &model)?, model.lenient);
        let options = SessionOptions { size, values, lenient, threads, watch: true, ..SessionOptions::default() };
        let session = Session::open(&name, options);
        Ok(juggler_viewer::run(session, juggler_viewer::ViewerOptions { choose })?)
    }
}

impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Self {
        Self::System(error.to_string())
    }
}
