//! Measures the denoiser: relative mean squared error before and after, for this filter and Open
//! Image Denoise, with run times.
//!
//! ```sh
//! cargo run --release -p juggler-denoise --example evaluate -- \
//!     FOLDER [keep] [bare] [best-of=3] [strength=1] [SCENE...]
//! ```
//!
//! FOLDER contains a folder for each scene, with files made as docs/denoising.md describes:
//! `ref.pfm`, and for each number of samples N `path_N_1.pfm` and `path_N_2.pfm`, the halves of N/2
//! samples with different seeds, with `albedo_`, `normals_` and `depth_` alike. `keep` writes the
//! results beside them, `bare` uses no features, `best-of` takes the shortest of several times, and
//! `strength` is that of the settings. Open Image Denoise runs if `JUGGLER_OIDN` is the path of its
//! library.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "it prints what it found")]

use juggler_denoise::{Features, Noisy, Settings, SimdLevel, denoise_at};
use juggler_math::{Image, Rgb, Vec3};
use juggler_oidn::Oidn;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// Numbers of samples to look for.
const SAMPLES: [u32; 4] = [4, 16, 64, 256];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Options of the command line.
struct Options {
    keep: bool,
    repeats: u32,
    strength: f32,
    bare: bool,
}

fn run() -> Result<(), Failure> {
    let mut words = std::env::args().skip(1);
    let folder = PathBuf::from(words.next().ok_or("which folder?")?);
    let mut options = Options { keep: false, repeats: 1, strength: 1.0, bare: false };
    let mut scenes = Vec::new();
    for word in words {
        match word.split_once('=') {
            Some(("best-of", number)) => options.repeats = number.parse()?,
            Some(("strength", number)) => options.strength = number.parse()?,
            _ if word == "keep" => options.keep = true,
            _ if word == "bare" => options.bare = true,
            _ => scenes.push(word),
        }
    }
    if scenes.is_empty() {
        for entry in std::fs::read_dir(&folder)? {
            scenes.push(entry?.file_name().to_string_lossy().into_owned());
        }
        scenes.sort();
    }
    let library = match std::env::var_os("JUGGLER_OIDN") {
        Some(path) => Some(Oidn::open(Some(Path::new(&path)))?),
        None => None,
    };
    println!("| scene | samples | input | own | OIDN | of the input | moved | own, s | OIDN, s |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut gains = Vec::new();
    for scene in &scenes {
        for samples in SAMPLES {
            gains.extend(row(&folder.join(scene), scene, samples, &options, library.as_ref())?);
        }
    }
    let mean = gains.iter().map(|gain| gain.ln()).sum::<f64>() / gains.len().max(1) as f64;
    println!("\ngeometric mean of own / input: {:.4}", mean.exp());
    Ok(())
}

/// Halves of a picture and of its features.
struct Loaded {
    width: usize,
    height: usize,
    color: [Vec<Rgb>; 2],
    albedo: [Vec<Rgb>; 2],
    normal: [Vec<Vec3>; 2],
    depth: [Vec<f32>; 2],
}

fn halves(folder: &Path, kind: &str, samples: u32) -> Result<[Image; 2], Failure> {
    let one = |seed: u32| read(&folder.join(format!("{kind}_{samples}_{seed}.pfm")));
    Ok([one(1)?, one(2)?])
}

fn load(folder: &Path, samples: u32) -> Result<Loaded, Failure> {
    let color = halves(folder, "path", samples)?;
    // Files store normals as (n + 1) / 2, and black where there is no surface.
    let direction = |c: &Rgb| if c.is_black() { Vec3::ZERO } else { Vec3::new(c.r, c.g, c.b) * 2.0 - 1.0 };
    Ok(Loaded {
        width: color[0].width() as usize,
        height: color[0].height() as usize,
        color: color.map(|image| image.pixels().to_vec()),
        albedo: halves(folder, "albedo", samples)?.map(|image| image.pixels().to_vec()),
        normal: halves(folder, "normals", samples)?.map(|image| image.pixels().iter().map(direction).collect()),
        depth: halves(folder, "depth", samples)?.map(|image| image.pixels().iter().map(|c| c.r).collect()),
    })
}

/// Prints the results for one picture. Returns the ratio of the errors after and before; `None` if
/// the picture does not exist.
fn row(
    folder: &Path,
    scene: &str,
    samples: u32,
    options: &Options,
    library: Option<&Oidn>,
) -> Result<Option<f64>, Failure> {
    if !folder.join(format!("depth_{samples}_2.pfm")).exists() {
        return Ok(None);
    }
    let loaded = load(folder, samples)?;
    let reference = read(&folder.join("ref.pfm")).ok().map(|image| image.pixels().to_vec());
    let error = |pixels: &[Rgb]| reference.as_ref().map_or(f64::NAN, |reference| relative_error(pixels, reference));
    let input: Vec<Rgb> = mean(&loaded.color);
    let (own, moved_energy, seconds) = own(&loaded, options)?;
    let foreign = library.map(|library| foreign(&loaded, &input, options, library)).transpose()?;
    let (foreign_error, foreign_seconds) = foreign.as_ref().map_or((f64::NAN, f64::NAN), |(p, s)| (error(p), *s));
    let (before, after) = (error(&input), error(&own));
    println!(
        "| {scene} | {samples} | {before:.5} | {after:.5} | {foreign_error:.5} | {:.3} | {:.2} % | {seconds:.2} | {foreign_seconds:.2} |",
        after / before,
        moved_energy * 100.0
    );
    if samples == 256 && reference.is_some() {
        println!("| {scene} | 128 | {:.5} | | | | | | |", error(&loaded.color[0]));
    }
    if options.keep {
        let foreign = foreign.map(|(pixels, _)| pixels);
        for (name, pixels) in [("input", Some(&input)), ("own", Some(&own)), ("oidn", foreign.as_ref())] {
            let Some(pixels) = pixels else { continue };
            write(&folder.join(format!("{name}_{samples}.pfm")), loaded.width, pixels)?;
        }
    }
    Ok(Some(after / before))
}

fn own(loaded: &Loaded, options: &Options) -> Result<(Vec<Rgb>, f64, f64), Failure> {
    let features = Features {
        albedo: Some([&loaded.albedo[0], &loaded.albedo[1]]),
        normal: Some([&loaded.normal[0], &loaded.normal[1]]),
        depth: Some([&loaded.depth[0], &loaded.depth[1]]),
    };
    let features = if options.bare { Features::default() } else { features };
    let color = [&loaded.color[0][..], &loaded.color[1][..]];
    let noisy = Noisy::new(loaded.width, loaded.height, color, features)?;
    let settings = Settings { strength: options.strength, ..Settings::default() };
    let mut best = f64::INFINITY;
    let mut result = None;
    for _ in 0..options.repeats.max(1) {
        let start = Instant::now();
        result = denoise_at(SimdLevel::new(), &noisy, &settings, &|| false);
        best = best.min(start.elapsed().as_secs_f64());
    }
    let denoised = result.ok_or("cancelled")?;
    Ok((denoised.pixels, denoised.moved_energy, best))
}

fn foreign(loaded: &Loaded, input: &[Rgb], options: &Options, library: &Oidn) -> Result<(Vec<Rgb>, f64), Failure> {
    let albedo = mean(&loaded.albedo);
    let normal: Vec<Vec3> = loaded.normal[0].iter().zip(&loaded.normal[1]).map(|(a, b)| (*a + *b) * 0.5).collect();
    let (mut best, mut pixels) = (f64::INFINITY, Vec::new());
    for _ in 0..options.repeats.max(1) {
        let start = Instant::now();
        let (albedo, normal) = if options.bare { (None, None) } else { (Some(&albedo[..]), Some(&normal[..])) };
        pixels = library.denoise(loaded.width, loaded.height, input, albedo, normal)?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok((pixels, best))
}

fn mean(halves: &[Vec<Rgb>; 2]) -> Vec<Rgb> {
    halves[0].iter().zip(&halves[1]).map(|(a, b)| (*a + *b) * 0.5).collect()
}

/// Relative mean squared error: the mean over pixels and channels of (x - r)² / (r² + 0.01).
fn relative_error(pixels: &[Rgb], reference: &[Rgb]) -> f64 {
    let channel = |(x, r): (f32, f32)| {
        let (x, r) = (f64::from(x), f64::from(r));
        (x - r) * (x - r) / (r * r + 0.01)
    };
    let pixel = |(x, r): (&Rgb, &Rgb)| x.to_array().into_iter().zip(r.to_array()).map(channel).sum::<f64>();
    pixels.iter().zip(reference).map(pixel).sum::<f64>() / (3 * pixels.len()) as f64
}

/// Reads a color PFM file in little-endian order, whose last row comes first.
fn read(path: &Path) -> Result<Image, Failure> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut lines = bytes.splitn(4, |byte| *byte == b'\n');
    let mut line = || std::str::from_utf8(lines.next().unwrap_or_default());
    let (kind, size, scale) = (line()?, line()?, line()?);
    let (width, height) = size.split_once(' ').ok_or("no size")?;
    let (width, height): (u32, u32) = (width.parse()?, height.trim().parse()?);
    if kind != "PF" || !scale.starts_with('-') || width == 0 {
        return Err(format!("{}: not a color PFM file", path.display()).into());
    }
    let numbers =
        lines.next().unwrap_or_default().chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let numbers: Vec<f32> = numbers.collect();
    let rows = numbers.chunks_exact(3 * width as usize).rev();
    let pixels = rows.flat_map(|row| row.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2]))).collect();
    Ok(Image::from_pixels(width, height, pixels).ok_or("too few pixels")?)
}

fn write(path: &Path, width: usize, pixels: &[Rgb]) -> Result<(), Failure> {
    let mut bytes = format!("PF\n{width} {}\n-1.0\n", pixels.len() / width).into_bytes();
    for row in pixels.chunks_exact(width).rev() {
        bytes.extend(row.iter().flat_map(|c| c.to_array()).flat_map(f32::to_le_bytes));
    }
    Ok(std::fs::write(path, bytes)?)
}
