//! Results for one mesh, as a table and as JSON.

use crate::failure::Failure;
use crate::format::counted;
use juggler_bvh::Quality;
use juggler_raybench::Kind;
use juggler_raybench::kernel::Kernel;
use juggler_raybench::measure::Timing;
use serde_json::{Value, json};

/// Widths of the first column and of the other columns, in characters.
const LABEL: usize = 32;
const COLUMN: usize = 10;

/// Name of a build quality.
pub fn quality(quality: Quality) -> &'static str {
    match quality {
        Quality::Fast => "fast",
        Quality::Balanced => "balanced",
        Quality::Best => "best",
    }
}

/// A built hierarchy.
pub struct Build {
    pub quality: Quality,
    /// Median wall-clock time, in seconds.
    pub seconds: f64,
    pub bytes: usize,
    pub sah_cost: f64,
}

/// Rate of one kernel for one kind of rays.
pub struct Rate {
    pub test: &'static str,
    pub kernel: Kernel,
    pub kind: Kind,
    pub threads: usize,
    pub timing: Timing,
}

impl Rate {
    /// Millions of rays per second: of CPU time for a single thread, of wall-clock time for
    /// several.
    fn mrays_per_second(&self) -> f64 {
        if self.threads == 1 { self.timing.cpu_rate() } else { self.timing.wall_rate() }
    }

    fn label(&self) -> String {
        format!("{} {}, {}", self.test, self.kernel.name(), counted(self.threads as u128, "thread"))
    }
}

/// All results for one mesh.
pub struct Report {
    mesh: String,
    triangles: usize,
    pub threads: usize,
    pub builds: Vec<Build>,
    rates: Vec<Rate>,
}

impl Report {
    pub fn new(mesh: &str, triangles: usize, threads: usize) -> Self {
        Self { mesh: mesh.to_owned(), triangles, threads, builds: Vec::new(), rates: Vec::new() }
    }

    /// Adds a rate.
    ///
    /// # Errors
    ///
    /// Fails if the checksum differs from that of another kernel for the same rays.
    pub fn add(&mut self, rate: Rate) -> Result<(), Failure> {
        let same = |other: &&Rate| other.kind == rate.kind && other.test == rate.test;
        match self.rates.iter().find(same) {
            Some(other) if !other.timing.summary.agrees(&rate.timing.summary) => Err(Failure::System(format!(
                "{} rays on `{}`: {} for {}, {} for {}: this is a bug of Juggler",
                rate.kind.name(),
                self.mesh,
                other.timing.summary,
                other.label(),
                rate.timing.summary,
                rate.label()
            ))),
            _ => {
                self.rates.push(rate);
                Ok(())
            }
        }
    }

    /// Renders the tables.
    pub fn to_words(&self) -> String {
        let mut lines = vec![format!("{}: {}", self.mesh, counted(self.triangles as u128, "triangle"))];
        let build = format!("build, {}", counted(self.threads as u128, "thread"));
        lines.push(row(&build, ["seconds", "bytes/tri", "SAH cost"].map(str::to_owned)));
        for build in &self.builds {
            let bytes = build.bytes as f64 / self.triangles as f64;
            let label = format!("{} tree", quality(build.quality));
            lines.push(row(&label, [format!("{:.3}", build.seconds), number(bytes), number(build.sah_cost)]));
        }
        let mut kinds: Vec<Kind> = self.rates.iter().map(|rate| rate.kind).collect();
        kinds.dedup();
        lines.push(row("Mrays/s", kinds.iter().map(|kind| kind.name().to_owned())));
        let mut labels: Vec<String> = Vec::new();
        for rate in &self.rates {
            if !labels.contains(&rate.label()) {
                labels.push(rate.label());
            }
        }
        for label in labels {
            let cells =
                self.rates.iter().filter(|rate| rate.label() == label).map(|rate| number(rate.mrays_per_second()));
            lines.push(row(&label, cells));
        }
        lines.join("\n")
    }

    fn to_json(&self) -> Value {
        let build = |build: &Build| {
            json!({
                "quality": quality(build.quality),
                "seconds": build.seconds,
                "bytes_per_triangle": build.bytes as f64 / self.triangles as f64,
                "sah_cost": build.sah_cost,
            })
        };
        let rate = |rate: &Rate| {
            json!({
                "test": rate.test,
                "kernel": rate.kernel.name(),
                "kind": rate.kind.name(),
                "threads": rate.threads,
                "rays": rate.timing.rays,
                "hits": rate.timing.summary.hits,
                "mrays_per_second": finite(rate.timing.wall_rate()),
                "mrays_per_cpu_second": finite(rate.timing.cpu_rate()),
            })
        };
        json!({
            "mesh": self.mesh,
            "triangles": self.triangles,
            "builds": self.builds.iter().map(build).collect::<Vec<_>>(),
            "rates": self.rates.iter().map(rate).collect::<Vec<_>>(),
        })
    }
}

/// All reports as one JSON object.
pub fn to_json(reports: &[Report]) -> String {
    let threads = reports.first().map_or(1, |report| report.threads);
    let meshes: Vec<Value> = reports.iter().map(Report::to_json).collect();
    json!({"version": 1, "threads": threads, "meshes": meshes}).to_string()
}

fn row(label: &str, cells: impl IntoIterator<Item = String>) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>COLUMN$}")).collect();
    format!("{label:LABEL$}{cells}")
}

/// Formats a number; a dash if it is not finite.
fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.2}") } else { "-".into() }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_raybench::clock::Elapsed;
    use juggler_raybench::measure::HitSummary;

    fn rate(kind: Kind, kernel: Kernel, threads: usize, hits: u64) -> Rate {
        let repeats = vec![Elapsed { wall: 0.25, cpu: 0.5 }];
        let timing = Timing { rays: 1_000_000, repeats, summary: HitSummary { hits, distance: 0.0 } };
        Rate { test: "watertight", kernel, kind, threads, timing }
    }

    fn report() -> Report {
        let mut report = Report::new("blob", 100, 2);
        let build = Build { quality: Quality::Best, seconds: 0.1234, bytes: 5550, sah_cost: 20.0 };
        report.builds.push(build);
        for kind in [Kind::Primary, Kind::Ao] {
            for (threads, kernel) in [(1, Kernel::Single), (1, Kernel::Batch), (2, Kernel::Single), (2, Kernel::Batch)]
            {
                report.add(rate(kind, kernel, threads, 7)).unwrap();
            }
        }
        report
    }

    #[test]
    fn table_of_rates_is_formatted() {
        let expected = "\
blob: 100 triangles
build, 2 threads                   seconds bytes/tri  SAH cost
best tree                            0.123     55.50     20.00
Mrays/s                            primary        ao
watertight single, 1 thread           2.00      2.00
watertight batch, 1 thread            2.00      2.00
watertight single, 2 threads          4.00      4.00
watertight batch, 2 threads           4.00      4.00
";
        assert_eq!(report().to_words(), expected.trim_end());
    }

    #[test]
    fn json_has_both_clocks_and_null_where_nothing_was_traced() {
        let mut report = report();
        report.rates[0].timing.repeats.clear();
        let json: Value = serde_json::from_str(&to_json(&[report])).unwrap();
        let rates = &json["meshes"][0]["rates"];
        assert_eq!((&rates[1]["mrays_per_second"], &rates[1]["mrays_per_cpu_second"]), (&json!(4.0), &json!(2.0)));
        assert_eq!(rates[0]["mrays_per_second"], Value::Null);
        assert_eq!(json["meshes"][0]["builds"][0]["bytes_per_triangle"], 55.5);
    }

    #[test]
    fn kernels_that_disagree_are_reported() {
        let mut report = report();
        assert!(report.add(rate(Kind::Random, Kernel::Single, 1, 3)).is_ok());
        let error = report.add(rate(Kind::Random, Kernel::Packet, 1, 4)).unwrap_err();
        assert!(matches!(error, Failure::System(message) if message.contains("3 hits") && message.contains("packet")));
    }
}
