//! `juggler bench schedulers`: compares the schedulers on scenes whose cost is distributed unevenly
//! over the picture, and checks that all give the same picture.

use crate::console;
use crate::failure::Failure;
use crate::source;
use crate::value;
use clap::Args;
use juggler::camera::Perspective;
use juggler::light::Point;
use juggler::material::Phong;
use juggler::math::{NamedKind, Rgb, vec3};
use juggler::render::{Control, Scheduler};
use juggler::scene::{Object, Scene};
use juggler::shape::Sphere;
use juggler::{Error, Picture, Settings};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::time::Instant;

/// Schedulers in the order of the table, from the simplest.
const SCHEDULERS: [Scheduler; 3] = [Scheduler::StaticRows, Scheduler::RowQueue, Scheduler::WorkStealing];
/// Width of a column of the table, in characters.
const COLUMN: usize = 15;

/// Flags of `juggler bench schedulers`.
#[derive(Debug, Args)]
pub struct Schedulers {
    /// Scenes to render [default: a heap of mirrors in a corner, and the same at the bottom]
    scenes: Vec<String>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = value::size, default_value = "640x360")]
    size: [u32; 2],
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    samples: u32,
    /// Number of measurements; the median is reported
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// Number of threads to compare with one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Measurements of one scene with one number of threads.
struct Row {
    scene: String,
    threads: usize,
    /// Times in seconds, for each of [`SCHEDULERS`].
    seconds: [Vec<f64>; SCHEDULERS.len()],
}

impl Schedulers {
    /// Measures the schedulers in turns, so that disturbances of the machine affect all alike, and
    /// prints the medians.
    pub fn run(self) -> Result<(), Failure> {
        let settings = Settings { size: Some(self.size), samples: Some(self.samples), ..Settings::default() };
        let pictures = self.scenes()?.into_iter().map(|(name, scene)| Ok((name, Picture::new(&scene, &settings)?)));
        let pictures: Vec<(String, Picture)> = pictures.collect::<Result<_, Failure>>()?;
        let pools = self.pools()?;
        let mut rows: Vec<(Row, &ThreadPool, &Picture)> = Vec::new();
        for (name, picture) in &pictures {
            for pool in &pools {
                let seconds = std::array::from_fn(|_| Vec::new());
                let row = Row { scene: name.clone(), threads: pool.current_num_threads(), seconds };
                rows.push((row, pool, picture));
            }
        }
        for _ in 0..self.repeats {
            for (row, pool, picture) in &mut rows {
                row.measure(pool, picture)?;
            }
        }
        let table: Vec<String> = rows.iter().map(|(row, ..)| row.to_words()).collect();
        console::print_result(&format!("{}\n{}", head(), table.join("\n")))
    }

    fn scenes(&self) -> Result<Vec<(String, Scene)>, Failure> {
        if self.scenes.is_empty() {
            return Ok(vec![("corner".into(), mirrors(6.0, -3.0)), ("bottom".into(), mirrors(0.0, -5.0))]);
        }
        self.scenes.iter().map(|name| Ok((source::stem(name).to_owned(), source::load(name, None)?))).collect()
    }

    fn pools(&self) -> Result<Vec<ThreadPool>, Failure> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let most = self.threads.map_or(cores, usize::from);
        let counts = if most > 1 { vec![1, most] } else { vec![1] };
        let build = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
        let pools: Result<_, _> = counts.into_iter().map(build).collect();
        pools.map_err(|error| Failure::System(format!("cannot start threads: {error}")))
    }
}

impl Row {
    fn measure(&mut self, pool: &ThreadPool, picture: &Picture) -> Result<(), Failure> {
        let mut hashes = Vec::new();
        for (scheduler, seconds) in SCHEDULERS.into_iter().zip(&mut self.seconds) {
            let start = Instant::now();
            let film = pool.install(|| picture.render(scheduler, &Control::default(), |_| Ok::<(), Error>(())))?;
            seconds.push(start.elapsed().as_secs_f64());
            hashes.push(film.hash);
        }
        hashes.dedup();
        if hashes.len() > 1 {
            return Err(Failure::System("schedulers gave different pictures: this is a bug of Juggler".into()));
        }
        Ok(())
    }

    fn to_words(&self) -> String {
        let medians: Vec<f64> = self.seconds.iter().map(|seconds| median(seconds)).collect();
        let blocks = medians.first().copied().unwrap_or_default();
        let mut line = format!("{:COLUMN$}{:>COLUMN$}", self.scene, self.threads);
        for median in medians {
            line.push_str(&format!(
                "{:>COLUMN$}{:>8}",
                format!("{:.1} ms", median * 1e3),
                format!("{:.2}x", blocks / median)
            ));
        }
        line
    }
}

fn head() -> String {
    let column = |scheduler: Scheduler| format!("{:>COLUMN$}{:>8}", scheduler.name(), "speed");
    let names: String = SCHEDULERS.into_iter().map(column).collect();
    format!("{:COLUMN$}{:>COLUMN$}{names}", "scene", "threads")
}

/// Median of the values; 0 if there are none.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// A heap of mirror spheres around (x, y) under an empty sky, so that few pixels have nearly all of
/// the cost.
fn mirrors(x: f32, y: f32) -> Scene {
    let mirror = Phong { diffuse: Rgb::splat(0.1).into(), reflection: Rgb::splat(0.85).into(), ..Phong::default() };
    let eye = vec3(0.0, 0.0, 20.0);
    let scene = Scene::new()
        .camera("main", Perspective { eye, look_at: Some(vec3(0.0, 0.0, 0.0)), ..Perspective::default() })
        .background(Rgb::new(0.3, 0.5, 0.9))
        .light(Point { position: eye, intensity: Some(400.0), ..Point::default() });
    (0..125_u8).fold(scene, |scene, i| {
        let [right, up, back] = [i % 5, i / 5 % 5, i / 25].map(|step| f32::from(step) - 2.0);
        let ball = Object::new(Sphere { radius: 0.49 });
        scene.add(ball.at(x + right, y + up * 0.5, back).material(mirror.clone()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_and_empty_lists() {
        assert_eq!((median(&[3.0, 1.0, 2.0]), median(&[5.0]), median(&[])), (2.0, 5.0, 0.0));
    }

    #[test]
    fn head_and_rows_line_up() {
        let row = Row { scene: "a".into(), threads: 8, seconds: [vec![1.0], vec![0.5], vec![0.25]] };
        assert_eq!(row.to_words().len(), head().len());
        assert!(row.to_words().contains("2.00x") && row.to_words().contains("4.00x"));
    }
}
