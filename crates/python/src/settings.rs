//! Keywords of a render.

use crate::errors::{convert, settings_error};
use juggler::camera::film::Rect;
use juggler::imaging::{Primaries, WhiteBalance};
use juggler::scene::model::NameOrIndex;
use juggler::{Aov, Denoiser, Limit, Settings, by_name, check_name};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};

/// Names of all keywords. The package handles `scene` and `progress` itself.
const NAMES: &[&str] = &[
    "size",
    "samples",
    "noise",
    "time",
    "integrator",
    "sampler",
    "max_depth",
    "camera",
    "frame",
    "at",
    "shutter",
    "seed",
    "crop",
    "tone",
    "exposure",
    "aovs",
    "denoise",
    "white_balance",
    "primaries",
    "dither",
    "transparent",
    "variant",
    "animation",
    "model_scene",
    "lenient",
    "threads",
    "max_memory",
    "progress",
];

/// Settings of a render.
#[derive(Clone, Debug, Default)]
pub struct RenderSettings {
    /// Settings that override the scene's.
    pub settings: Settings,
    /// Frame, which may lie between two.
    pub frame: f64,
    /// Time in seconds, instead of a frame.
    pub at: Option<f64>,
    /// Variant, animation clip and scene of a model file.
    pub model: [Option<NameOrIndex>; 3],
    /// Number of threads.
    pub threads: Option<usize>,
    /// Memory limit, in bytes.
    pub max_memory: Option<u64>,
}

/// Names of all keywords of a render.
#[pyfunction]
pub fn setting_names() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// Raises an exception for the first keyword that is wrong.
#[pyfunction]
pub fn check_settings(keywords: &Bound<'_, PyDict>) -> PyResult<()> {
    RenderSettings::new(keywords).map(drop)
}

impl RenderSettings {
    /// Reads keywords; `None` counts as absent.
    pub fn new(keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut read = Self::default();
        for (name, value) in keywords.iter() {
            let name: String = name.extract()?;
            check_name("setting", &name, NAMES.iter().copied()).map_err(|e| convert(e.for_setting(&name)))?;
            if !value.is_none() {
                read.set(&name, &value)?;
            }
        }
        read.settings.check_ranges().map_err(convert)?;
        Ok(read)
    }

    /// Name of the setting that selects what a model file shows, if there is one.
    pub fn model_setting(&self) -> Option<&'static str> {
        let names = ["variant", "animation", "model_scene"];
        names.into_iter().zip(&self.model).find(|(_, value)| value.is_some()).map(|(name, _)| name)
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        match name {
            "noise" | "time" => self.set_limit(name, value),
            "frame" | "at" => self.set_time(name, value),
            "variant" => self.set_model(0, name, value),
            "animation" => self.set_model(1, name, value),
            "model_scene" => self.set_model(2, name, value),
            "tone" | "exposure" | "white_balance" | "primaries" | "dither" => self.set_tone(name, value),
            _ => self.set_view(name, value),
        }
    }

    fn set_view(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let settings = &mut self.settings;
        match name {
            "threads" => self.threads = Some(read(name, value, "a number of threads")?),
            "max_memory" => self.max_memory = Some(read(name, value, "a number of bytes")?),
            "size" => settings.size = Some(read(name, value, "a pair of width and height, such as (640, 360)")?),
            "samples" => settings.samples = Some(read(name, value, "a number of samples, such as 64")?),
            "integrator" => settings.integrator = Some(by_name(name, &text(name, value)?).map_err(convert)?),
            "sampler" => settings.sampler = Some(by_name(name, &text(name, value)?).map_err(convert)?),
            "max_depth" => settings.max_depth = Some(read(name, value, "a number of bounces, such as 8")?),
            "camera" => settings.camera = Some(text(name, value)?),
            "shutter" => settings.shutter = Some(shutter(value)?),
            "seed" => settings.seed = Some(read(name, value, "a whole number")?),
            "crop" => {
                let [x, y, width, height] = read(name, value, "(left, top, width, height) in pixels")?;
                settings.crop = Some(Rect { x, y, width, height });
            }
            "transparent" => settings.transparent = Some(read(name, value, "True or False")?),
            "aovs" => settings.aovs = aovs(value)?,
            "denoise" => settings.denoiser = denoiser(value)?,
            // The package handles the others.
            _ => {}
        }
        Ok(())
    }

    fn set_tone(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let settings = &mut self.settings;
        match name {
            "tone" => {
                let curve = by_name("tone curve", &text(name, value)?);
                settings.curve = Some(curve.map_err(|error| convert(error.for_setting(name)))?);
            }
            "exposure" => settings.exposure_stops = Some(read(name, value, "a number of stops, such as -0.5")?),
            "dither" => settings.dither = Some(read(name, value, "True or False")?),
            "primaries" => {
                let name = text(name, value)?;
                let known = Primaries::ALL.into_iter();
                check_name("primaries", &name, known.clone().map(Primaries::name)).map_err(convert)?;
                settings.primaries = known.into_iter().find(|primaries| primaries.name() == name);
            }
            _ => settings.white_balance = Some(white_balance(value)?),
        }
        Ok(())
    }

    fn set_limit(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let number: f64 = read(name, value, "a positive number")?;
        if !(number > 0.0 && number.is_finite()) {
            return Err(settings_error(name, format!("`{name}` must be a positive number, not {number}")));
        }
        if self.settings.limit != Limit::Samples {
            return Err(settings_error(name, "`noise` and `time` exclude each other"));
        }
        self.settings.limit =
            if name == "noise" { Limit::Noise(number as f32) } else { Limit::Time { seconds: number } };
        Ok(())
    }

    fn set_time(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let number: f64 = read(name, value, "a number")?;
        if !number.is_finite() {
            return Err(settings_error(name, format!("`{name}` must be a finite number")));
        }
        match name {
            "at" => self.at = Some(number),
            _ => self.frame = number,
        }
        Ok(())
    }

    fn set_model(&mut self, at: usize, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let chosen = match value.extract::<u32>() {
            Ok(index) => NameOrIndex::Index(index),
            Err(_) => NameOrIndex::Name(text(name, value)?),
        };
        if let Some(place) = self.model.get_mut(at) {
            *place = Some(chosen);
        }
        Ok(())
    }
}

/// Reads a value. The error says what is expected.
fn read<'py, T: for<'a> FromPyObject<'a, 'py>>(name: &str, value: &Bound<'py, PyAny>, expected: &str) -> PyResult<T> {
    value.extract().map_err(|_| wrong(name, value, expected))
}

fn wrong(name: &str, value: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    let shown = value.repr().map_or_else(|_| "that".to_owned(), |repr| repr.to_string());
    settings_error(name, format!("`{name}` must be {expected}, not {shown}"))
}

fn text(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    read(name, value, "a name")
}

fn shutter(value: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let expected = "a pair of times in frames, the first not after the second, such as (0, 0.5)";
    let times: [f64; 2] = read("shutter", value, expected)?;
    if times[0] <= times[1] { Ok(times) } else { Err(wrong("shutter", value, expected)) }
}

/// AOVs by name: a list of names, or text with commas.
fn aovs(value: &Bound<'_, PyAny>) -> PyResult<Vec<Aov>> {
    let names = match value.cast::<PyString>() {
        Ok(text) => vec![text.to_string()],
        Err(_) => read::<Vec<String>>("aovs", value, "a list of names, such as [\"albedo\", \"normal\"]")?,
    };
    let mut found = Vec::new();
    for name in names {
        let listed = Aov::list(&name).map_err(convert)?;
        found.extend(listed);
    }
    Ok(found)
}

/// Denoiser by name; `True` selects the own one, which needs no other library.
fn denoiser(value: &Bound<'_, PyAny>) -> PyResult<Option<Denoiser>> {
    match value.cast::<PyBool>() {
        Ok(switch) => Ok(switch.is_true().then_some(Denoiser::Own)),
        Err(_) => {
            denoiser_by_name(&read::<String>("denoise", value, "True, False or the name of a denoiser")?).map(Some)
        }
    }
}

/// Denoiser of a name.
pub fn denoiser_by_name(name: &str) -> PyResult<Denoiser> {
    Denoiser::by_name(name).map_err(convert)
}

/// Color temperature in kelvin, alone or with a tint.
fn white_balance(value: &Bound<'_, PyAny>) -> PyResult<WhiteBalance> {
    let expected = "a temperature in kelvin, 1667 to 25000, or a pair of it and a tint, -50 to 50";
    let [kelvin, tint] = match value.extract::<f64>() {
        Ok(kelvin) => [kelvin, 0.0],
        Err(_) => read("white_balance", value, expected)?,
    };
    if (1667.0..=25_000.0).contains(&kelvin) && (-50.0..=50.0).contains(&tint) {
        return Ok(WhiteBalance { kelvin, tint });
    }
    Err(wrong("white_balance", value, expected))
}
