//! Rendering into a film: partial renders that can be stored, continued and merged.

use crate::denoise::DenoiserInput;
use crate::{Error, Limit, Picture};
use juggler_camera::film::{Film, FilmDigest, FilmSummary, Tile, Tiling};
use juggler_film::partial_render::{AovDescription, RenderDescription, ShardDescription, Stop};
use juggler_film::shard::{Units, Work, WorkUnit};
use juggler_film::{Chunk, PartialRender, PartialRenderWriter};
use juggler_imaging::layered::LayeredWriter;
use juggler_imaging::{Header, Options, RowWriter};
use juggler_math::{PixelRows, Rgb};
use juggler_render::{Cancelled, Control};
use std::ops::Range;

/// Origin of a partial render, beyond what the picture itself stores.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderOrigin {
    /// Name of the scene.
    pub scene: String,
    /// Frame, which may lie between two.
    pub frame: f64,
    /// Command line that renders the whole image; empty if there is none.
    pub command: String,
}

impl Picture {
    /// Returns the layout of tiles.
    pub fn tiling(&self) -> Tiling {
        Tiling::new(self.region())
    }

    /// Creates an empty film for all pixels and samples.
    pub fn film(&self) -> Film {
        Film::new(self.tiling(), 0..self.samples())
    }

    /// Renders into a film until it is finished or `control` stops it. Samples of the film are
    /// kept.
    pub fn render_film(&self, film: &Film, control: &Control) -> Result<(), Cancelled> {
        juggler_render::render_progressive(&self.job(), film, self.limit().stop(), control)
    }

    /// Returns whether every tile of a film has enough samples.
    pub fn is_finished(&self, film: &Film) -> bool {
        matches!(self.limit(), Limit::Time { .. }) || juggler_render::is_finished(film, self.limit().stop())
    }

    /// Passes the pixel rows of a film to `rows`, from top to bottom, with alpha if the picture is
    /// transparent, and returns their hash and mean.
    pub fn develop<E>(&self, film: &Film, mut rows: impl FnMut(PixelRows) -> Result<(), E>) -> Result<FilmSummary, E> {
        let [width, height] = self.size();
        let mut digest = FilmDigest::new(width, height);
        let (tiling, mut number) = (film.tiling(), 0);
        film.develop(|colors: &[Rgb]| {
            let alpha = self.alpha_of_band(film, tiling, number);
            number += 1;
            let band = PixelRows { colors, alpha: alpha.as_deref() };
            digest.update(band);
            rows(band)
        })?;
        digest.add_clamped(film.clamped());
        Ok(digest.finish())
    }

    /// Returns alpha of the pixels of a film's band of tiles; `None` if the picture is opaque.
    fn alpha_of_band(&self, film: &Film, tiling: Tiling, number: u64) -> Option<Vec<f32>> {
        let band = self.aovs().is_transparent().then(|| tiling.bands().nth(number as usize))??;
        let tiles = tiling.tiles_of_band(number).filter_map(|number| film.copy_of_tile(number));
        self.aovs().alpha(&band, &tiles.collect::<Vec<Tile>>())
    }

    /// Returns alpha of all pixels of a film, row by row; `None` if the picture is opaque.
    pub fn alpha(&self, film: &Film) -> Option<Vec<f32>> {
        let bands = 0..u64::from(film.tiling().rows());
        let alpha: Option<Vec<_>> = bands.map(|number| self.alpha_of_band(film, film.tiling(), number)).collect();
        alpha.map(|bands| bands.concat()).filter(|_| self.aovs().is_transparent())
    }

    /// Returns whether the integrator clamps contributions.
    pub fn is_clamped(&self) -> bool {
        self.job().integrator.clamp().is_some()
    }

    /// Writes a film as an image file.
    pub fn write_film(&self, film: &Film, mut writer: Box<dyn RowWriter>) -> Result<FilmSummary, Error> {
        let summary = self.develop(film, |rows| Ok::<(), Error>(writer.write_rows(rows)?))?;
        writer.finish()?;
        Ok(summary)
    }

    /// Writes the AOVs of a film, after `pixels` of the rendered image if given.
    pub fn write_layers(&self, film: &Film, mut writer: LayeredWriter, pixels: Option<PixelRows>) -> Result<(), Error> {
        let tiling = film.tiling();
        // All bands but the last have the same area.
        let area = tiling.bands().next().map_or(1, |band| band.area()) as usize;
        let mut rest = pixels.map(|pixels| pixels.chunks(area));
        for (row, band) in (0..).zip(tiling.bands()) {
            let tiles: Vec<Tile> = tiling.tiles_of_band(row).filter_map(|number| film.copy_of_tile(number)).collect();
            let rows = rest.as_mut().and_then(Iterator::next);
            writer.write_rows(&self.aovs().band_values(&band, &tiles, rows))?;
        }
        Ok(writer.finish()?)
    }

    /// Gathers the denoiser's input from a film.
    pub fn denoiser_input(&self, film: &Film) -> DenoiserInput {
        let mut input = DenoiserInput::new(self.region());
        film.tiles().for_each(|(_, tile)| input.add(self.aovs(), &tile));
        input
    }

    /// Returns the stop condition in the form that partial renders store.
    pub fn stop(&self) -> Stop {
        match *self.limit() {
            Limit::Samples => Stop::Samples,
            Limit::Noise(level) => Stop::Noise { level: f64::from(level) },
            Limit::Time { seconds } => Stop::Time { seconds },
        }
    }

    /// Renders one of `count` shards and returns the bytes of its partial render. Fails for an
    /// index beyond the last shard, and if `control` cancels the render.
    pub fn render_shard(
        &self,
        [index, count]: [u32; 2],
        origin: &RenderOrigin,
        control: &Control,
    ) -> Result<Vec<u8>, Error> {
        if index >= count {
            return Err(Error::setting("shard", format!("there is no shard {index} of {count}: the first one is 0")));
        }
        let work = Work { tiling: self.tiling(), crop: None, samples: 0..self.samples(), stop: self.stop() };
        let shard = ShardDescription { index, count, ..ShardDescription::whole(self.samples()) };
        self.render_part(&work.shard(index, count), shard, origin, control)
    }

    /// Renders units of work and returns the bytes of their partial render. Fails for a time limit,
    /// which a part of an image cannot have, for units that the image does not have, and if `control`
    /// cancels the render.
    pub fn render_units(&self, units: &[WorkUnit], origin: &RenderOrigin, control: &Control) -> Result<Vec<u8>, Error> {
        self.check_divisible()?;
        let (tiles, most) = (self.tiling().tile_count(), self.samples());
        let is_known = |unit: &WorkUnit| unit.tile < tiles && !unit.samples.is_empty() && unit.samples.end <= most;
        if let Some(WorkUnit { tile, samples: Range { start, end } }) = units.iter().find(|unit| !is_known(unit)) {
            return Err(Error::setting(
                "units",
                format!(
                    "the image has {tiles} tiles of {most} samples, not the samples {start} to {end} of tile {tile}"
                ),
            ));
        }
        if units.is_empty() {
            return Err(Error::setting("units", "there are no units of work to render"));
        }
        self.render_part(units, ShardDescription::of_units(self.samples(), Units::new(units)), origin, control)
    }

    /// Fails for a time limit, since each part of an image would take that time.
    pub(crate) fn check_divisible(&self) -> Result<(), Error> {
        match self.limit() {
            Limit::Time { .. } => {
                Err(Error::setting("time", "a time limit acts on one machine only; limit `samples` or `noise`"))
            }
            _ => Ok(()),
        }
    }

    /// Renders units of work, which `shard` describes, and returns the bytes of their partial render.
    fn render_part(
        &self,
        units: &[WorkUnit],
        shard: ShardDescription,
        origin: &RenderOrigin,
        control: &Control,
    ) -> Result<Vec<u8>, Error> {
        let film = Film::from_tiles(self.tiling(), units.iter().map(|unit| (unit.tile, unit.samples.clone())));
        self.render_to_limit(&film, control)?;
        let header = self.file_header(Options::default());
        let description =
            RenderDescription { finished: self.is_finished(&film), ..self.description(origin, &header, shard) };
        let name = match &description.shard {
            ShardDescription { units, .. } if !units.is_empty() => "units of work".to_owned(),
            ShardDescription { index, count, .. } => format!("shard {index} of {count}"),
        };
        let mut writer = PartialRenderWriter::in_memory(&name, &description)?;
        for (number, tile) in film.tiles() {
            writer.add(number, &Chunk::encode(&tile, description.clamped))?;
        }
        Ok(writer.into_bytes()?)
    }

    /// Creates the film of the picture with the samples of a partial render. Fails for a partial
    /// render of another image, and for one with samples that this picture does not have.
    pub fn resume_film(&self, partial_render: &PartialRender, origin: &RenderOrigin) -> Result<Film, Error> {
        let (film, header) = (self.film(), self.file_header(Options::default()));
        let goal = self.description(origin, &header, ShardDescription::whole(self.samples()));
        juggler_film::resume(partial_render, &goal, &film)?;
        Ok(film)
    }

    /// Returns the description of a partial render of this picture; `header` is that of the image
    /// file.
    pub fn description(&self, origin: &RenderOrigin, header: &Header, shard: ShardDescription) -> RenderDescription {
        let [width, height] = self.compiled().settings.size;
        RenderDescription {
            software: crate::picture::SOFTWARE.to_owned(),
            command: origin.command.clone(),
            scene: origin.scene.clone(),
            frame: origin.frame,
            size: [width, height],
            region: self.region(),
            samples: self.samples(),
            stop: self.stop(),
            clamped: self.is_clamped(),
            aovs: AovDescription {
                neighbor_frames: self.neighbor_fingerprint().to_owned(),
                ..self.aovs().to_description()
            },
            shard,
            finished: false,
            fingerprint: self.fingerprint().parts().clone(),
            tone: serde_json::to_value(self.tone()).unwrap_or_default(),
            metadata: header.metadata.clone(),
            viewpoint: header.viewpoint,
        }
    }
}
