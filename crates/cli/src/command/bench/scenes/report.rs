//! Results of all scenes, as a table and as JSON.

use super::bench_scene::CROP;
use super::measure::SceneReport;
use super::program::{Build, Program, Render};
use super::quantity::Quantity;
use crate::format::amount;
use serde_json::{Value, json};

/// Widths of the first column and of the other columns, in characters.
const LABEL: usize = 18;
const COLUMN: usize = 15;

/// All results.
pub struct Report {
    pub quantity: Quantity,
    /// Version of valgrind, if it counted.
    pub valgrind: Option<String>,
    pub programs: Vec<Program>,
    pub scenes: Vec<SceneReport>,
}

impl Report {
    /// What a program reports about itself.
    fn build(&self, program: usize) -> Build {
        let render = self.scenes.first().and_then(|scene| scene.results.get(program));
        render.map(|render| render.build.clone()).unwrap_or_default()
    }

    /// The first lines of the table: programs, quantity and columns.
    fn head(&self) -> String {
        let mut lines = Vec::new();
        for (number, program) in self.programs.iter().enumerate() {
            let Build { compiler, simd } = self.build(number);
            let known = [Some(format!("juggler {}", program.version)), compiler, simd];
            let known: Vec<String> = known.into_iter().flatten().collect();
            lines.push(format!("{}: {}", program.path, known.join(", ")));
        }
        let how = match &self.valgrind {
            Some(version) => format!("instructions by valgrind {version}"),
            None => "CPU seconds".to_owned(),
        };
        lines.push(format!("{CROP}x{CROP} pixels, 1 thread, {how}"));
        let columns = ["samples", "rays", self.quantity.name(), "per sample"];
        let beside: &[&str] = if self.programs.len() > 1 { &["beside", "ratio", "picture"] } else { &[] };
        lines.push(row("scene", columns.iter().chain(beside).map(|column| (*column).to_owned())));
        lines.join("\n")
    }

    fn line(&self, scene: &SceneReport) -> String {
        let mut results = scene.results.iter();
        let (cost, rays) = results.next().map_or((0.0, 0), |render| (render.cost, render.rays));
        let each = cost / scene.samples as f64;
        let mut cells = vec![scene.samples.to_string(), rays.to_string(), self.number(cost), self.number(each)];
        if let (Some(other), Some(ratio)) = (results.next(), scene.ratio) {
            let picture = if scene.is_same_picture() { "same" } else { "differs" };
            cells.extend([self.number(other.cost), format!("{ratio:.4}"), picture.to_owned()]);
        }
        row(scene.scene, cells)
    }

    fn number(&self, cost: f64) -> String {
        match self.quantity {
            Quantity::Instructions => amount(cost),
            Quantity::CpuTime if cost < 1e-3 => format!("{:.2}e-6", cost * 1e6),
            Quantity::CpuTime => format!("{cost:.3}"),
        }
    }

    /// Renders the table.
    pub fn to_words(&self) -> String {
        let lines: Vec<String> =
            [self.head()].into_iter().chain(self.scenes.iter().map(|scene| self.line(scene))).collect();
        lines.join("\n")
    }

    /// One JSON object.
    pub fn to_json(&self) -> String {
        let program = |(number, program): (usize, &Program)| {
            let Build { compiler, simd } = self.build(number);
            json!({"program": program.path, "version": program.version, "compiler": compiler, "simd": simd})
        };
        json!({
            "version": 1,
            "measure": self.quantity.name(),
            "architecture": std::env::consts::ARCH,
            "valgrind": self.valgrind,
            "programs": self.programs.iter().enumerate().map(program).collect::<Vec<_>>(),
            "scenes": self.scenes.iter().map(|scene| self.scene_json(scene)).collect::<Vec<_>>(),
        })
        .to_string()
    }

    fn scene_json(&self, scene: &SceneReport) -> Value {
        let result = |Render { cost, rays, hash, .. }: &Render| match self.quantity {
            Quantity::Instructions => json!({"instructions": *cost as i64, "rays": rays, "hash": hash}),
            Quantity::CpuTime => json!({"cpu_seconds": cost, "rays": rays, "hash": hash}),
        };
        json!({
            "scene": scene.scene,
            "samples": scene.samples,
            "results": scene.results.iter().map(result).collect::<Vec<_>>(),
            "ratio": scene.ratio,
        })
    }
}

fn row(label: &str, cells: impl IntoIterator<Item = String>) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>COLUMN$}")).collect();
    format!("{label:LABEL$}{cells}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(quantity: Quantity, costs: &[f64]) -> Report {
        let program = |_| Program { path: "juggler".into(), version: "0.1.0".into() };
        let render = |(number, cost): (usize, &f64)| {
            let known = Build { compiler: Some("rustc 1.95.0".into()), simd: Some("avx2".into()) };
            // An old version reports nothing about itself.
            let build = if number == 0 { known } else { Build::default() };
            Render { cost: *cost, rays: 5000, hash: format!("{cost}"), build }
        };
        let scene = SceneReport {
            scene: "cornell",
            samples: 2048,
            results: costs.iter().enumerate().map(render).collect(),
            ratio: (costs.len() > 1).then_some(0.5),
        };
        let valgrind = (quantity == Quantity::Instructions).then(|| "3.19.0".to_owned());
        Report { quantity, valgrind, programs: costs.iter().map(program).collect(), scenes: vec![scene] }
    }

    #[test]
    fn table_of_instructions_is_formatted() {
        let expected = "\
juggler: juggler 0.1.0, rustc 1.95.0, avx2
32x32 pixels, 1 thread, instructions by valgrind 3.19.0
scene                     samples           rays   instructions     per sample
cornell                      2048           5000   20.5 million  10.0 thousand";
        assert_eq!(report(Quantity::Instructions, &[2048e4]).to_words(), expected);
    }

    #[test]
    fn table_of_two_programs_has_their_ratio() {
        let text = report(Quantity::CpuTime, &[1.0, 2.0]).to_words();
        let last = text.lines().last().unwrap_or_default();
        let cells: Vec<&str> = last.split_whitespace().collect();
        assert_eq!(cells, ["cornell", "2048", "5000", "1.000", "488.28e-6", "2.000", "0.5000", "differs"], "{text}");
        assert!(text.starts_with("juggler: juggler 0.1.0, rustc 1.95.0, avx2\njuggler: juggler 0.1.0\n"), "{text}");
    }

    #[test]
    fn json_has_whole_numbers_of_instructions() {
        let json: Value = serde_json::from_str(&report(Quantity::Instructions, &[2048e4]).to_json()).unwrap();
        let result = &json["scenes"][0]["results"][0];
        assert_eq!((&result["instructions"], &result["rays"]), (&20_480_000.into(), &5000.into()));
        assert_eq!((&json["programs"][0]["simd"], &json["valgrind"]), (&"avx2".into(), &"3.19.0".into()));
        let json: Value = serde_json::from_str(&report(Quantity::CpuTime, &[1.5]).to_json()).unwrap();
        assert_eq!((&json["scenes"][0]["results"][0]["cpu_seconds"], &json["valgrind"]), (&1.5.into(), &Value::Null));
    }
}
