//! Several frames in one file of moving pictures.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use juggler::imaging::AnimationFormat;
use std::path::Path;

/// Several frames in one file of moving pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Reel {
    /// The format.
    pub format: AnimationFormat,
    /// The file.
    pub file: String,
    /// Frames a second; without, the scene's.
    pub frames_per_second: Option<f64>,
    /// How often it is shown; 0: over and over.
    pub plays: u16,
}

impl Reel {
    /// What the output's name and the flags ask for; `None` for pictures.
    pub fn new(args: &RenderArgs, output: &str) -> Result<Option<Self>, Failure> {
        let wrong = |message: String| Err(Failure::Wrong(message));
        let named = args.format.as_ref().map(|name| format!("film.{name}"));
        let format = AnimationFormat::from_path(Path::new(named.as_deref().unwrap_or(output)));
        let Some(format) = format else {
            let flag = args.fps.map(|_| "--fps").or(args.plays.map(|_| "--plays"));
            let endings = AnimationFormat::ALL.map(|format| format!(".{}", format.ending())).join(" ");
            return flag.map_or(Ok(None), |flag| wrong(format!("{flag} is for moving pictures: {endings}")));
        };
        if output == STANDARD_OUTPUT {
            return wrong(format!("a film needs a file: {format} cannot go to standard output"));
        }
        let unfit = [
            ("--bits", args.bits.is_some()),
            ("--quality", args.quality.is_some()),
            ("--frame", args.frame.is_some()),
            ("--at", args.at.is_some()),
        ];
        if let Some((flag, _)) = unfit.into_iter().find(|(_, given)| *given) {
            return wrong(format!("{flag} is for pictures; `{output}` is a film of several frames"));
        }
        if args.shard.is_some() {
            return wrong(format!(
                "the frames of `{output}` cannot be shared out; machines share them as pictures: -o 'frame_####.png'"
            ));
        }
        let (file, frames_per_second) = (output.to_owned(), args.fps);
        Ok(Some(Self { format, file, frames_per_second, plays: args.plays.unwrap_or(0) }))
    }

    /// Where the finished frames are until the film is complete.
    pub fn folder(&self) -> String {
        format!("{}.frames", self.file)
    }

    /// How they are called.
    pub fn frames(&self) -> String {
        format!("{}/frame_####.png", self.folder())
    }
}
