//! Rendered images in memory, with their AOVs and all that a file of them contains.

mod denoised;
mod encode;

use crate::denoise::{DenoisedPicture, DenoiserInput};
use crate::image::of_pixels;
use crate::{AovSet, Error, Limit, Picture, RenderStats};
use juggler_camera::film::{Film, FilmDigest, FilmSummary, Rect, Tile};
use juggler_film::counts::SampleCountStats;
use juggler_film::{Merge, RenderDescription, Stop, counts};
use juggler_imaging::layered::{self, LayerHeader, LayeredWriter};
use juggler_imaging::{Header, ImageFormat, Options, Tone};
use juggler_math::{Image, PixelRows, Rgb};
use juggler_render::{Cancelled, Control, RayCounts};
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// Metadata key of the number of samples per pixel.
pub const SAMPLES: &str = "Samples";
/// Metadata key of the number of samples of each tile, under a time limit.
pub const SAMPLES_PER_TILE: &str = "Samples per tile";

/// Metadata key of the tone settings, unless all have their defaults.
pub const TONE: &str = "Tone";

/// Rendered image in memory. The image has the same hash and gives the same files as a render to a
/// file with the same settings.
#[derive(Clone, Debug)]
pub struct RenderedImage {
    /// Header of an image file; tone and options may be changed before it is saved.
    pub header: Header,
    /// Linear pixels, row by row from the top, denoised if the settings say so.
    pixels: Vec<Rgb>,
    /// Alpha of the pixels, by which they are multiplied; `None` if the image is opaque.
    alpha: Option<Vec<f32>>,
    /// AOVs with the names of objects, materials and light groups.
    aovs: AovSet,
    /// Channels of the AOVs, in the order of [`AovSet::headers`].
    channels: Vec<Vec<f32>>,
    /// Hash and mean of the pixels, numbers of samples and rays, and durations.
    stats: RenderStats,
}

impl RenderedImage {
    /// Creates an image from its parts, for example after another process has sent them; `None` if
    /// the numbers of pixels and channels do not fit the size. The method
    /// [`RenderedImage::layers`] returns `channels`.
    pub fn from_parts(
        header: Header,
        pixels: Vec<Rgb>,
        alpha: Option<Vec<f32>>,
        aovs: AovSet,
        channels: Vec<Vec<f32>>,
        stats: RenderStats,
    ) -> Option<Self> {
        let count = header.width as usize * header.height as usize;
        let has_alpha = alpha.as_ref().is_none_or(|alpha| alpha.len() == count);
        let is_whole = pixels.len() == count && has_alpha && channels.len() == aovs.channels();
        let image = Self { header, pixels, alpha, aovs, channels, stats };
        (is_whole && image.channels.iter().all(|channel| channel.len() == count)).then_some(image)
    }

    /// Linear pixels, row by row from the top: an array of shape (height, width). Those of a
    /// transparent image are multiplied by alpha.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// Alpha of the pixels, 0 to 1, in the same order; `None` if the image is opaque.
    pub fn alpha(&self) -> Option<&[f32]> {
        self.alpha.as_deref()
    }

    /// Pixels with their alpha.
    pub fn pixel_rows(&self) -> PixelRows<'_> {
        PixelRows { colors: &self.pixels, alpha: self.alpha() }
    }

    /// Converts to the linear pixels alone.
    pub fn into_image(self) -> Image {
        of_pixels(self.size(), self.pixels)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.header.width, self.header.height]
    }

    /// AOVs with the names of objects, materials and light groups.
    pub fn aovs(&self) -> &AovSet {
        &self.aovs
    }

    /// Layers of the AOVs, each with its channels, which have a number for each pixel, row by row.
    pub fn layers(&self) -> impl Iterator<Item = (LayerHeader, &[Vec<f32>])> {
        let mut rest = self.channels.as_slice();
        self.aovs.headers().into_iter().map(move |layer| {
            let (channels, others) = rest.split_at(layer.channels.len().min(rest.len()));
            rest = others;
            (layer, channels)
        })
    }

    /// Hash and mean of the pixels, numbers of samples and rays, and durations.
    pub fn stats(&self) -> &RenderStats {
        &self.stats
    }

    /// Saves the image to a file, whose extension selects the format; an EXR file contains the AOVs.
    /// Fails as [`ImageExt::save`](crate::ImageExt::save) does.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let format = ImageFormat::from_path(path)?;
        if format == ImageFormat::Exr && !self.aovs.selected().is_empty() {
            let mut writer = LayeredWriter::create(path, &self.aovs.file_header(&self.header, true))?;
            let mut channels = layered::channels(self.pixel_rows());
            channels.extend_from_slice(&self.channels);
            writer.write_rows(&channels)?;
            return Ok(writer.finish()?);
        }
        let mut writer = juggler_imaging::create(path, format, &self.header)?;
        writer.write_rows(self.pixel_rows())?;
        Ok(writer.finish()?)
    }

    /// Joins partial renders to the image, as the program's `merge` does: denoised if the film stores
    /// what a denoiser needs. `library` is the path of Open Image Denoise where the system does not
    /// find it. Fails for AOVs and tone settings that this version does not know, partial renders
    /// that cannot be read, and a cancelled merge.
    pub fn from_partial_renders(merge: &Merge, library: Option<&Path>, control: &Control) -> Result<Self, Error> {
        let start = Instant::now();
        let (description, aovs) = (merge.description(), AovSet::from_description(&merge.description().aovs)?);
        let (mut header, samples) = merged_header(merge)?;
        header.transparent = aovs.is_transparent();
        let mut parts = Parts::new(&aovs, description.region);
        let mut summary = merge.tile_rows(|band, tiles, rows| {
            if control.is_cancelled() {
                return Err(Error::Cancelled(Cancelled));
            }
            parts.add(&aovs, band, tiles, rows);
            Ok(())
        })?;
        let Parts { pixels, alpha, channels, denoiser_input } = parts;
        let denoise = Instant::now();
        let denoised = denoise_pixels(&aovs, denoiser_input.as_ref(), library, control)?;
        let (render, denoise) = (denoise - start, denoised.as_ref().map_or(Duration::ZERO, |_| denoise.elapsed()));
        let (pixels, alpha) = denoised.map_or((pixels, alpha), |denoised| (denoised.pixels, denoised.alpha));
        if denoiser_input.is_some() || alpha.is_some() {
            let rows = PixelRows { colors: &pixels, alpha: alpha.as_deref() };
            let FilmSummary { hash, mean, .. } = digest(rows, description.region);
            summary = FilmSummary { hash, mean, ..summary };
        }
        let (rays, write) = (RayCounts::default(), Duration::ZERO);
        let stats = RenderStats { film: summary, samples, rays, render, denoise, write };
        Ok(Self { header, pixels, alpha, aovs, channels, stats })
    }
}

/// Contents of an image that are collected band by band.
struct Parts {
    pixels: Vec<Rgb>,
    alpha: Option<Vec<f32>>,
    channels: Vec<Vec<f32>>,
    denoiser_input: Option<DenoiserInput>,
}

impl Parts {
    fn new(aovs: &AovSet, region: Rect) -> Self {
        let denoiser_input = aovs.denoiser().map(|_| DenoiserInput::new(region));
        let alpha = aovs.is_transparent().then(Vec::new);
        Self { pixels: Vec::new(), alpha, channels: vec![Vec::new(); aovs.channels()], denoiser_input }
    }

    fn add(&mut self, aovs: &AovSet, band: &Rect, tiles: &[Tile], rows: &[Rgb]) {
        self.pixels.extend_from_slice(rows);
        self.alpha.iter_mut().for_each(|alpha| alpha.extend(aovs.alpha(band, tiles).into_iter().flatten()));
        let values = aovs.band_values(band, tiles, None);
        self.channels.iter_mut().zip(values).for_each(|(channel, values)| channel.extend(values));
        if let Some(input) = &mut self.denoiser_input {
            tiles.iter().for_each(|tile| input.add(aovs, tile));
        }
    }
}

/// Denoised picture; `None` without a denoiser.
fn denoise_pixels(
    aovs: &AovSet,
    input: Option<&DenoiserInput>,
    library: Option<&Path>,
    control: &Control,
) -> Result<Option<DenoisedPicture>, Error> {
    let Some((denoiser, input)) = aovs.denoiser().zip(input) else { return Ok(None) };
    input.denoise(denoiser, library, control)?.ok_or(Error::Cancelled(Cancelled)).map(Some)
}

/// Header of the image that partial renders make, and its numbers of samples.
fn merged_header(merge: &Merge) -> Result<(Header, SampleCountStats), Error> {
    let description = merge.description();
    let RenderDescription { region, tone, metadata, viewpoint, .. } = description;
    let cannot_read = |error| format!("cannot read the tone settings of the partial renders: {error}");
    let tone = serde_json::from_value(tone.clone()).map_err(|error| Error::setting("tone", cannot_read(error)))?;
    let (mut metadata, mut samples) = (metadata.clone(), SampleCountStats::uniform(description.samples));
    if description.stop != Stop::Samples {
        samples = SampleCountStats::from_counts(&description.tiling(), &merge.counts()?);
        metadata.push((SAMPLES.to_owned(), samples.to_string()));
    }
    let (viewpoint, crop) = (*viewpoint, description.crop_frame());
    Ok((Header { tone, metadata, viewpoint, crop, ..Header::new(region.width, region.height) }, samples))
}

/// Hash and mean of the pixels of a region.
fn digest(pixels: PixelRows, region: Rect) -> FilmSummary {
    let mut digest = FilmDigest::new(region.width, region.height);
    digest.update(pixels);
    digest.finish()
}

impl Picture {
    /// Returns whether the image needs a film in memory: for AOVs, denoising, and a limit of noise
    /// or time.
    pub fn needs_film(&self) -> bool {
        !self.aovs().is_empty() || *self.limit() != Limit::Samples
    }

    /// Renders into memory, with AOVs and denoiser as the settings say. Fails if `control` cancels the
    /// render, or if Open Image Denoise, whose path `library` may be, cannot be loaded.
    pub fn render_in_memory(&self, library: Option<&Path>, control: &Control) -> Result<RenderedImage, Error> {
        if self.needs_film() {
            let (film, start) = (self.film(), Instant::now());
            self.render_to_limit(&film, control)?;
            return self.develop_in_memory(&film, start.elapsed(), library, control);
        }
        let (start, mut pixels) = (Instant::now(), Vec::with_capacity(self.region().area() as usize));
        let film = self.render(Default::default(), control, |rows| {
            pixels.extend_from_slice(rows);
            Ok::<(), Cancelled>(())
        })?;
        let (samples, render) = (SampleCountStats::uniform(self.samples()), start.elapsed());
        let (denoise, write) = (Duration::ZERO, Duration::ZERO);
        let stats = RenderStats { film, samples, rays: control.rays(), render, denoise, write };
        let (header, aovs) = (self.file_header(Options::default()), self.aovs().clone());
        Ok(RenderedImage { header, pixels, alpha: None, aovs, channels: Vec::new(), stats })
    }

    /// Renders into a film as [`Picture::render_film`] does, and ends the render at its time limit.
    pub fn render_to_limit(&self, film: &Film, control: &Control) -> Result<(), Cancelled> {
        let Limit::Time { seconds } = *self.limit() else { return self.render_film(film, control) };
        let limit = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        std::thread::scope(|scope| {
            let (running, ended) = mpsc::channel::<()>();
            scope.spawn(move || {
                if ended.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                    control.finish();
                }
            });
            let result = self.render_film(film, control);
            drop(running);
            result
        })
    }

    /// Develops a film, which took `render` to trace, to the image in memory. Fails as
    /// [`Picture::render_in_memory`] does.
    pub fn develop_in_memory(
        &self,
        film: &Film,
        render: Duration,
        library: Option<&Path>,
        control: &Control,
    ) -> Result<RenderedImage, Error> {
        let start = Instant::now();
        let parts = self.collect(film);
        let (render, start) = (render + start.elapsed(), Instant::now());
        let denoised = denoise_pixels(self.aovs(), parts.denoiser_input.as_ref(), library, control)?;
        let denoise = denoised.as_ref().map_or(Duration::ZERO, |_| start.elapsed());
        let parts = match denoised {
            Some(DenoisedPicture { pixels, alpha, .. }) => Parts { pixels, alpha, ..parts },
            None => parts,
        };
        Ok(self.image_of_film(film, parts, [render, denoise], control))
    }

    /// The image that a film holds so far, without denoising; other threads may add samples
    /// meanwhile. `render` is the time that its samples took.
    pub fn snapshot(&self, film: &Film, render: Duration, control: &Control) -> RenderedImage {
        self.image_of_film(film, self.collect(film), [render, Duration::ZERO], control)
    }

    /// Collects pixels, channels and the denoiser's input from a film.
    fn collect(&self, film: &Film) -> Parts {
        let (aovs, tiling) = (self.aovs(), film.tiling());
        let mut parts = Parts::new(aovs, self.region());
        for (row, band) in (0..).zip(tiling.bands()) {
            let tiles: Vec<Tile> = tiling.tiles_of_band(row).filter_map(|number| film.copy_of_tile(number)).collect();
            let mut rows = vec![Rgb::BLACK; band.area() as usize];
            tiles.iter().for_each(|tile| tile.copy_to(&band, &mut rows));
            parts.add(aovs, &band, &tiles, &rows);
        }
        parts
    }

    /// The image of a film, whose pixels may be denoised, after these times of rendering and
    /// denoising.
    fn image_of_film(
        &self,
        film: &Film,
        parts: Parts,
        [render, denoise]: [Duration; 2],
        control: &Control,
    ) -> RenderedImage {
        let Parts { pixels, alpha, channels, .. } = parts;
        let mut digest = FilmDigest::new(self.region().width, self.region().height);
        digest.update(PixelRows { colors: &pixels, alpha: alpha.as_deref() });
        digest.add_clamped(film.clamped());
        let (samples, rays) = (SampleCountStats::from_film(film), control.rays());
        let stats = RenderStats { film: digest.finish(), samples, rays, render, denoise, write: Duration::ZERO };
        let mut header = self.file_header(Options::default());
        self.add_sample_counts(film, &mut header);
        RenderedImage { header, pixels, alpha, aovs: self.aovs().clone(), channels, stats }
    }

    /// Header of the image file with the tone settings among the metadata, unless all have their
    /// defaults, since they are no part of the fingerprint.
    pub fn file_header(&self, options: Options) -> Header {
        let mut header = self.header(options);
        if header.tone != Tone::default() {
            let tone = serde_json::to_string(&header.tone).unwrap_or_default();
            header.metadata.push((TONE.to_owned(), tone));
        }
        header
    }

    /// Adds the numbers of samples that a limit of noise or time has decided to the metadata.
    pub fn add_sample_counts(&self, film: &Film, header: &mut Header) {
        if *self.limit() != Limit::Samples {
            header.metadata.push((SAMPLES.to_owned(), SampleCountStats::from_film(film).to_string()));
        }
        if matches!(self.limit(), Limit::Time { .. }) {
            header.metadata.push((SAMPLES_PER_TILE.to_owned(), counts::to_text(&film.counts())));
        }
    }
}
