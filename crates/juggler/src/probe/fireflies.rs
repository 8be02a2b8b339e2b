//! Fireflies: pixels that stand out because few of their samples are very bright, and by which paths these came.

use super::outliers::{Field, Found, Outlier, error};
use super::{Detail, Prober, luminance};
use crate::Error;
use juggler_camera::film::Summary;
use juggler_math::Rgb;
use juggler_render::Control;
use serde::Serialize;
use std::collections::BTreeMap;

/// Pixels that are looked into, beside those that are told one by one: enough to tell which kinds of paths do it.
const LOOKED_INTO: usize = 100;

/// What stands out in a picture, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fireflies {
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// How light was followed.
    pub integrator: &'static str,
    /// Samples of each pixel.
    pub samples: u32,
    /// How many pixels stand out by chance.
    pub count: usize,
    /// How many stand out by what they show: their samples agree. Nothing where that is not known, of fewer than 32 samples.
    pub sure: Option<usize>,
    /// What those that stand out by chance have beyond what is around them, of all the picture's light (luminance).
    pub excess: f64,
    /// Those that stand out most.
    pub pixels: Vec<Firefly>,
    /// How many pixels were looked into.
    pub looked_into: usize,
    /// By which kinds of paths light came to these, those with most excess light first.
    pub kinds: Vec<Kind>,
    /// What clamping removed, of all light; nothing where nothing is clamped.
    pub clamped: Option<f64>,
}

/// A pixel that stands out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Firefly {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The pixel, linear RGB.
    pub value: [f32; 3],
    /// Its luminance.
    pub luminance: f64,
    /// Median luminance of what is around it.
    pub median: f64,
    /// By how many spreads of what is around it stands out.
    pub score: f64,
    /// Its brightest sample; nothing of integrators that follow no paths.
    pub sample: Option<u32>,
    /// What that has of all light of the pixel.
    pub share: Option<f64>,
    /// How it came.
    pub path: Option<String>,
}

/// Paths that met places of the same kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Kind {
    /// What they did: `diffuse > specular transmission > what shines`.
    pub path: String,
    /// How many pixels stand out by them.
    pub pixels: usize,
    /// What these have beyond what is around them, of all such light in the picture.
    pub share: f64,
}

impl Prober<'_> {
    /// Renders the picture, and tells what stands out in it: `count` pixels one by one.
    pub fn fireflies(&self, count: usize, control: &Control) -> Result<Fireflies, Error> {
        let picture = self.picture();
        let film = picture.film();
        picture.expose(&film, control)?;
        let [width, height] = picture.size();
        let region = picture.region();
        let area = region.area() as usize;
        let (mut pixels, mut errors) = (vec![Rgb::BLACK; area], vec![None; area]);
        for (_, tile) in film.tiles() {
            let own: Vec<Option<f64>> =
                (0..tile.pixels().area() as usize).map(|place| error(&tile.statistics(place))).collect();
            tile.copy_to(&region, &mut pixels);
            tile.pixels().copy(&own, &region, &mut errors);
        }
        let summary = picture.develop(&film, |_| Ok::<(), Error>(()))?;
        let knows = errors.iter().any(Option::is_some);
        let values = pixels.iter().map(|pixel| f64::from(pixel.luminance())).collect();
        let field = Field { width: width as usize, height: height as usize, values, errors };
        let found = field.outliers();
        let told = self.told(&field, &found, &pixels, count, control)?;
        Ok(Fireflies { sure: knows.then_some(found.sure), ..self.summed(&field, &found, told, count, &summary) })
    }

    /// Looks into the pixels that stand out most: each with the kind of its path, and what it has too much.
    fn told(
        &self,
        field: &Field,
        found: &Found,
        pixels: &[Rgb],
        count: usize,
        control: &Control,
    ) -> Result<Vec<(Firefly, Option<String>, f64)>, Error> {
        let detail = Detail { depth: 0, branches: 0, brightest: 1 };
        let region = self.picture().region();
        let mut told = Vec::new();
        for Outlier { place, median, excess, score } in found.outliers.iter().take(count.max(LOOKED_INTO)).copied() {
            let (x, y) = ((place % field.width.max(1)) as u32, (place / field.width.max(1)) as u32);
            let pixel = [region.x + x, region.y + y];
            let probe = self.pixel(pixel, &detail, control)?;
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
            told.push((firefly, brightest.map(|brightest| brightest.kind), excess));
        }
        Ok(told)
    }

    fn summed(
        &self,
        field: &Field,
        found: &Found,
        told: Vec<(Firefly, Option<String>, f64)>,
        count: usize,
        summary: &Summary,
    ) -> Fireflies {
        let total: f64 = found.outliers.iter().map(|outlier| outlier.excess).sum();
        let light: f64 = field.values.iter().filter(|value| value.is_finite()).sum();
        let share = |part: f64, of: f64| if of > 0.0 { part / of } else { 0.0 };
        let mut kinds: BTreeMap<String, (usize, f64)> = BTreeMap::new();
        for (_, kind, excess) in &told {
            let Some(kind) = kind else { continue };
            let sum = kinds.entry(kind.clone()).or_default();
            *sum = (sum.0 + 1, sum.1 + excess);
        }
        let kind = |(path, (pixels, excess))| Kind { path, pixels, share: share(excess, total) };
        let mut kinds: Vec<Kind> = kinds.into_iter().map(kind).collect();
        kinds.sort_by(|a, b| b.share.total_cmp(&a.share));
        let picture = self.picture();
        Fireflies {
            size: picture.size(),
            integrator: picture.integrator().name(),
            samples: picture.samples(),
            count: found.outliers.len(),
            sure: None,
            excess: share(total, light),
            looked_into: told.len(),
            pixels: told.into_iter().take(count).map(|(firefly, ..)| firefly).collect(),
            kinds,
            clamped: picture.is_clamped().then(|| summary.clamped_share()),
        }
    }
}
