//! Ledger of an image that several workers render: its film, and what the film lacks.

use crate::{Error, Limit, Picture, RenderOrigin, RenderedImage};
use juggler_camera::film::Film;
use juggler_film::checkpoint::Checkpoint;
use juggler_film::ledger::{add, remove_incomplete};
use juggler_film::partial_render::{RenderDescription, ShardDescription};
use juggler_film::shard::{Work, WorkUnit};
use juggler_film::{Added, PartialRender};
use juggler_imaging::Options;
use juggler_render::{Control, is_tile_finished};
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

/// Film that partial renders of several workers fill, in any order. The image has the bits of
/// [`Picture::render_in_memory`].
///
/// ```
/// use juggler::film::PartialRender;
/// use juggler::prelude::*;
/// use juggler::{Ledger, RenderOrigin};
///
/// let scene = Scene::new().size(40, 20).samples(32).add(Object::new(Sphere::default()));
/// let picture = Picture::new(&scene, &Settings::default())?;
/// let (control, origin) = (Control::default(), RenderOrigin::default());
/// let ledger = Ledger::new(picture.clone(), &origin)?;
/// for units in ledger.missing(0..32, 1).chunks(2) {
///     let bytes = picture.render_units(units, &origin, &control)?; // on any machine
///     ledger.add(&PartialRender::from_bytes("part", bytes)?)?;
/// }
/// assert!(ledger.is_finished());
/// # Ok::<(), juggler::Error>(())
/// ```
pub struct Ledger {
    picture: Picture,
    film: Film,
    goal: RenderDescription,
}

impl Ledger {
    /// Creates the empty film of a picture. Fails for a time limit, which a part of an image cannot
    /// have.
    pub fn new(picture: Picture, origin: &RenderOrigin) -> Result<Self, Error> {
        picture.check_divisible()?;
        let header = picture.file_header(Options::default());
        let goal = picture.description(origin, &header, ShardDescription::whole(picture.samples()));
        Ok(Self { film: picture.film(), picture, goal })
    }

    /// The picture.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Opens the checkpoint at `path` and continues from it, if there is one. Returns it, and the damage
    /// of its newest file if an older one was used. Fails for a file of another image.
    pub fn resume(&self, path: &Path) -> Result<(Checkpoint, Option<String>), Error> {
        let (checkpoint, found) = Checkpoint::open(path)?;
        if let Some(partial_render) = &found.partial_render {
            juggler_film::resume(partial_render, &self.goal, &self.film)?;
            let stop = self.picture.limit().stop();
            remove_incomplete(&self.film, self.goal.stop, |index| is_tile_finished(&self.film, stop, index));
        }
        Ok((checkpoint, found.damage.map(|damage| damage.to_string())))
    }

    /// Saves the film as a checkpoint, from which the program continues, too.
    pub fn save(&self, checkpoint: &mut Checkpoint) -> Result<u64, Error> {
        let description = RenderDescription { finished: self.is_finished(), ..self.goal.clone() };
        Ok(checkpoint.save(&description, &self.film)?)
    }

    /// Units of work that the film lacks, of these samples, in Morton order; small ones come last. The
    /// samples of a tile are split where the picture has few tiles for so many workers.
    pub fn missing(&self, samples: Range<u32>, workers: u32) -> Vec<WorkUnit> {
        let samples = samples.start.min(self.goal.samples)..samples.end.min(self.goal.samples);
        Work { samples, ..Work::from_description(&self.goal) }.missing(&self.film, workers)
    }

    /// Adds a partial render. Samples that the film has already are dropped. Fails, and adds nothing,
    /// for a partial render of another image, a damaged one, and one that holds some of the samples of
    /// a run of which the film holds others.
    pub fn add(&self, partial_render: &PartialRender) -> Result<Added, Error> {
        Ok(add(partial_render, &self.goal, &self.film)?)
    }

    /// Returns whether the film lacks nothing.
    pub fn is_finished(&self) -> bool {
        self.picture.is_finished(&self.film)
    }

    /// Samples of all pixels that the film holds.
    pub fn samples(&self) -> u64 {
        self.film.samples()
    }

    /// Finished share of the work, from 0 to 1: of the samples, or of the tiles under a noise limit.
    pub fn share(&self) -> f64 {
        if *self.picture.limit() == Limit::Samples {
            return self.film.samples() as f64 / self.film.requested_samples().max(1) as f64;
        }
        self.film.tiles_held() as f64 / self.film.len().max(1) as f64
    }

    /// Develops the film, which took `render` to trace, denoised if the settings say so. `library` is
    /// the path of Open Image Denoise where the system does not find it. Fails if `control` cancels it.
    pub fn develop(&self, render: Duration, library: Option<&Path>, control: &Control) -> Result<RenderedImage, Error> {
        self.picture.develop_in_memory(&self.film, render, library, control)
    }

    /// The image so far, without denoising.
    pub fn snapshot(&self, render: Duration) -> RenderedImage {
        self.picture.snapshot(&self.film, render, &Control::default())
    }
}
