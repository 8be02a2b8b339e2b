//! Detection of fireflies, pixels dominated by a few very bright samples, and of the paths that
//! cause them.

use super::outliers::{LuminanceImage, Outlier, Outliers, error};
use super::{Detail, Prober, luminance};
use crate::Error;
use juggler_camera::film::FilmSummary;
use juggler_math::Rgb;
use juggler_render::Control;
use serde::Serialize;
use std::collections::BTreeMap;

/// Minimum number of probed outliers, enough to group them by kind of path.
const MIN_PROBED: usize = 100;

/// Fireflies of an image and their causes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fireflies {
    /// Width and height of the image, in pixels.
    pub size: [u32; 2],
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Number of samples per pixel.
    pub samples: u32,
    /// Number of outliers that noise explains.
    pub count: usize,
    /// Number of outliers whose samples agree, such as small emitters; `None` for fewer than 32
    /// samples.
    #[serde(rename = "sure")]
    pub certain: Option<usize>,
    /// Excess luminance of the noisy outliers over their neighborhoods, as a fraction of the
    /// image's.
    pub excess: f64,
    /// Strongest outliers.
    pub pixels: Vec<Firefly>,
    /// Number of probed outliers.
    #[serde(rename = "looked_into")]
    pub probed: usize,
    /// Kinds of paths that lit them, by decreasing excess.
    pub kinds: Vec<PathGroup>,
    /// Fraction of the light that clamping removed; `None` without clamping.
    pub clamped: Option<f64>,
}

/// Outlier pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Firefly {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Radiance, linear RGB.
    pub value: [f32; 3],
    /// Luminance of the pixel.
    pub luminance: f64,
    /// Median luminance of its neighborhood.
    pub median: f64,
    /// Excess over the median, in robust standard deviations.
    pub score: f64,
    /// Index of the brightest sample; `None` for integrators without paths.
    pub sample: Option<u32>,
    /// Fraction of the pixel's light in that sample.
    pub share: Option<f64>,
    /// Path of that sample.
    pub path: Option<String>,
}

/// Group of paths with the same scattering events.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathGroup {
    /// Scattering events: `diffuse > specular transmission > emission`.
    pub path: String,
    /// Number of outliers that such paths cause.
    pub pixels: usize,
    /// Excess of these outliers, as a fraction of that of all noisy outliers.
    pub share: f64,
}

impl Prober<'_> {
    /// Renders the image and finds its fireflies; `count` of them are listed.
    pub fn find_fireflies(&self, count: usize, control: &Control) -> Result<Fireflies, Error> {
        let picture = self.picture();
        let film = picture.film();
        picture.render_film(&film, control)?;
        let [width, height] = picture.size();
        let region = picture.region();
        let area = region.area() as usize;
        let (mut pixels, mut errors) = (vec![Rgb::BLACK; area], vec![None; area]);
        for (_, tile) in film.tiles() {
            let own: Vec<Option<f64>> =
                (0..tile.pixels().area() as usize).map(|place| error(&tile.statistics(place))).collect();
            tile.copy_to(&region, &mut pixels);
            tile.pixels().copy_into(&own, &region, &mut errors);
        }
        let summary = picture.develop(&film, |_| Ok::<(), Error>(()))?;
        let knows = errors.iter().any(Option::is_some);
        let values = pixels.iter().map(|pixel| f64::from(pixel.luminance())).collect();
        let image = LuminanceImage { width: width as usize, height: height as usize, values, errors };
        let found = image.outliers();
        let probed = self.probe_outliers(&image, &found, &pixels, count, control)?;
        Ok(Fireflies {
            certain: knows.then_some(found.certain),
            ..self.summarize(&image, &found, probed, count, &summary)
        })
    }

    /// Probes the strongest outliers. Returns each with the kind of its brightest path and its
    /// excess.
    fn probe_outliers(
        &self,
        image: &LuminanceImage,
        found: &Outliers,
        pixels: &[Rgb],
        count: usize,
        control: &Control,
    ) -> Result<Vec<(Firefly, Option<String>, f64)>, Error> {
        let detail = Detail { depth: 0, branches: 0, brightest: 1 };
        let region = self.picture().region();
        let mut probed = Vec::new();
        for Outlier { place, median, excess, score } in found.outliers.iter().take(count.max(MIN_PROBED)).copied() {
            let (x, y) = ((place % image.width.max(1)) as u32, (place / image.width.max(1)) as u32);
            let pixel = [region.x + x, region.y + y];
            let probe = self.probe_pixel(pixel, &detail, control)?;
            let brightest = probe.light.and_then(|light| light.brightest.into_iter().next());
            let value = pixels.get(place).copied().unwrap_or(Rgb::BLACK).to_array();
            let firefly = Firefly {
                pixel,
                value,
                luminance: luminance(value.map(f64::from)),
                median,
                score,
                sample: brightest.as_ref().map(|brightest| brightest.sample),
                share: brightest.as_ref().and_then(|brightest| brightest.share),
                path: brightest.as_ref().map(|brightest| brightest.path.clone()),
            };
            probed.push((firefly, brightest.map(|brightest| brightest.kind), excess));
        }
        Ok(probed)
    }

    fn summarize(
        &self,
        image: &LuminanceImage,
        found: &Outliers,
        probed: Vec<(Firefly, Option<String>, f64)>,
        count: usize,
        summary: &FilmSummary,
    ) -> Fireflies {
        let total: f64 = found.outliers.iter().map(|outlier| outlier.excess).sum();
        let light: f64 = image.values.iter().filter(|value| value.is_finite()).sum();
        let share = |part: f64, of: f64| if of > 0.0 { part / of } else { 0.0 };
        let mut kinds: BTreeMap<String, (usize, f64)> = BTreeMap::new();
        for (_, kind, excess) in &probed {
            let Some(kind) = kind else { continue };
            let sum = kinds.entry(kind.clone()).or_default();
            *sum = (sum.0 + 1, sum.1 + excess);
        }
        let kind = |(path, (pixels, excess))| PathGroup { path, pixels, share: share(excess, total) };
        let mut kinds: Vec<PathGroup> = kinds.into_iter().map(kind).collect();
        kinds.sort_by(|a, b| b.share.total_cmp(&a.share));
        let picture = self.picture();
        Fireflies {
            size: picture.size(),
            integrator: picture.integrator().name(),
            samples: picture.samples(),
            count: found.outliers.len(),
            certain: None,
            excess: share(total, light),
            probed: probed.len(),
            pixels: probed.into_iter().take(count).map(|(firefly, ..)| firefly).collect(),
            kinds,
            clamped: picture.is_clamped().then(|| summary.clamped_fraction()),
        }
    }
}
