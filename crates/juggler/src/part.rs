//! A picture on a film: exposed in parts, kept, gone on with, joined.

use crate::denoise::Guides;
use crate::{Error, Limit, Picture};
use juggler_camera::film::{Digest, Film, Layout, Summary, Tile};
use juggler_film::part::{Description, Layered, Share, Stop};
use juggler_imaging::layered::LayeredWriter;
use juggler_imaging::{Header, RowWriter};
use juggler_math::Rgb;
use juggler_render::{Control, Stopped};

/// What made a picture, besides what the picture knows of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Name of the scene.
    pub scene: String,
    /// The frame, which may lie between two.
    pub frame: f64,
    /// The command line that renders the whole picture; empty when no command does.
    pub command: String,
}

impl Picture {
    /// How it is cut into tiles.
    pub fn layout(&self) -> Layout {
        Layout::new(self.region())
    }

    /// A film for all of it.
    pub fn film(&self) -> Film {
        Film::new(self.layout(), 0..self.samples())
    }

    /// Exposes a film until it is finished, or until `control` says so. What is there already is gone on with.
    pub fn expose(&self, film: &Film, control: &Control) -> Result<(), Stopped> {
        juggler_render::expose(&self.job(), film, self.limit().stop(), control)
    }

    /// Whether every tile of a film has enough samples.
    pub fn is_finished(&self, film: &Film) -> bool {
        matches!(self.limit(), Limit::Time { .. }) || juggler_render::is_finished(film, self.limit().stop())
    }

    /// Hands the finished rows of a film to `rows`, from top to bottom.
    pub fn develop<E>(&self, film: &Film, mut rows: impl FnMut(&[Rgb]) -> Result<(), E>) -> Result<Summary, E> {
        let [width, height] = self.size();
        let mut digest = Digest::new(width, height);
        film.develop(|band: &[Rgb]| {
            digest.update(band);
            rows(band)
        })?;
        digest.clamp(film.clamped());
        Ok(digest.finish())
    }

    /// Whether contributions that are too bright are dimmed.
    pub fn is_clamped(&self) -> bool {
        self.job().integrator.clamp().is_some()
    }

    /// Writes a film as a picture.
    pub fn write_film(&self, film: &Film, mut writer: Box<dyn RowWriter>) -> Result<Summary, Error> {
        let summary = self.develop(film, |rows| Ok::<(), Error>(writer.write_rows(rows)?))?;
        writer.finish()?;
        Ok(summary)
    }

    /// Writes the layers of a film, after the pixels of the picture itself if `writer` is to hold them.
    pub fn write_layers(&self, film: &Film, mut writer: LayeredWriter, pixels: Option<&[Rgb]>) -> Result<(), Error> {
        let layout = film.layout();
        let mut rest = pixels;
        for (row, band) in (0..).zip(layout.bands()) {
            let tiles: Vec<Tile> = layout.in_band(row).filter_map(|number| film.tile_of(number)).collect();
            let rows = rest.as_mut().and_then(|rest| rest.split_off(..band.area() as usize));
            writer.write_rows(&self.layers().band(&band, &tiles, rows))?;
        }
        Ok(writer.finish()?)
    }

    /// What denoising a film needs: its halves, and what guides a filter.
    pub fn guides(&self, film: &Film) -> Guides {
        let mut guides = Guides::new(self.region());
        film.tiles().for_each(|(_, tile)| guides.add(self.layers(), &tile));
        guides
    }

    /// What ends it, as film parts say it.
    pub fn end(&self) -> Stop {
        match *self.limit() {
            Limit::Samples => Stop::Samples,
            Limit::Noise(level) => Stop::Noise { level: f64::from(level) },
            Limit::Time { seconds } => Stop::Time { seconds },
        }
    }

    /// What a film part of this picture says about itself; `header` is that of the picture's file.
    pub fn description(&self, origin: &Origin, header: &Header, share: Share) -> Description {
        let [width, height] = self.compiled().settings.size;
        Description {
            software: crate::picture::SOFTWARE.to_owned(),
            command: origin.command.clone(),
            scene: origin.scene.clone(),
            frame: origin.frame,
            size: [width, height],
            region: self.region(),
            samples: self.samples(),
            stop: self.end(),
            clamped: self.is_clamped(),
            layers: Layered { beside: self.beside().to_owned(), ..self.layers().to_part() },
            share,
            finished: false,
            fingerprint: self.fingerprint().parts().clone(),
            tone: serde_json::to_value(self.tone()).unwrap_or_default(),
            metadata: header.metadata.clone(),
            viewpoint: header.viewpoint,
        }
    }
}
