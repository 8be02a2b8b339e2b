//! Rates of all tracers on one scene: prints the table and adds ratios to the targets.

use crate::options::{Call, Options};
use crate::targets::Targets;
use crate::tracers::Tracer;
use juggler_raybench::kernel::Scratch;
use juggler_raybench::measure::{Timing, Trace, measure_alternately};
use juggler_raybench::{Kind, RaySet};

/// Timings of one kind of rays, one per tracer.
struct Column {
    kind: Kind,
    timings: Vec<Timing>,
}

/// Measures, prints a table for each number of threads, and adds ratios to the targets.
pub fn measure(tracers: &[Tracer], sets: &[RaySet], options: &Options, targets: &mut Targets) {
    let mut before: Option<(usize, Vec<Column>)> = None;
    for &threads in &options.threads {
        let columns: Vec<Column> = sets.iter().map(|set| column(tracers, set, threads, options.repeats)).collect();
        print(tracers, &columns, threads);
        if threads == 1 {
            add(tracers, &columns, targets);
        }
        if let Some((fewer, earlier)) = &before {
            scaling(tracers, earlier, &columns, &format!("{fewer} to {threads} threads"), targets);
        } else {
            before = Some((threads, columns));
        }
    }
}

fn column(tracers: &[Tracer], set: &RaySet, threads: usize, repeats: usize) -> Column {
    let query = set.kind.query();
    let closures: Vec<_> = tracers
        .iter()
        .map(|tracer| move |rays: &[_], scratch: &mut Scratch| tracer.trace(query, rays, scratch))
        .collect();
    let traces: Vec<Trace> = closures.iter().map(|closure| closure as Trace).collect();
    let timings = measure_alternately(&set.rays, &traces, threads, repeats);
    for (row, tracer) in tracers.iter().enumerate() {
        let alike =
            |other: &usize| tracers[*other].is_ours() && tracer.is_ours() && tracers[*other].test == tracer.test;
        if let Some(other) = (0..row).find(alike).filter(|other| !timings[*other].summary.agrees(&timings[row].summary))
        {
            let [one, two] = [other, row].map(|row| format!("{}: {}", tracers[row].label(), timings[row].summary));
            println!("  WRONG, {}: {one}; {two}", set.kind.name());
        }
    }
    Column { kind: set.kind, timings }
}

/// Embree's timing that one of Juggler's tracers is compared with: the same kind of triangle test,
/// and single calls with single calls, packets with coherent packets, batches with the fastest.
fn counterpart<'c>(tracers: &[Tracer], column: &'c Column, ours: &Tracer) -> Option<&'c Timing> {
    let theirs = tracers.iter().zip(&column.timings);
    let like = theirs.filter(|(tracer, _)| !tracer.is_ours() && tracer.watertight == ours.watertight);
    let fits = like.filter(|(tracer, _)| ours.call.is_comparable_to(tracer.call));
    fits.map(|(_, timing)| timing).max_by(|a, b| a.cpu_rate().total_cmp(&b.cpu_rate()))
}

fn print(tracers: &[Tracer], columns: &[Column], threads: usize) {
    let clock = if threads == 1 { "CPU" } else { "wall" };
    let kinds: String = columns.iter().map(|column| format!("{:>16}", column.kind.name())).collect();
    println!("\n  {:<30}{kinds}", format!("Mrays/s ({clock}), {threads} threads"));
    for (row, tracer) in tracers.iter().enumerate() {
        let cell = |column: &Column| {
            let timing = &column.timings[row];
            let rate = if threads == 1 { timing.cpu_rate() } else { timing.wall_rate() };
            let ratio = counterpart(tracers, column, tracer).filter(|_| tracer.is_ours());
            let ratio = ratio.map_or_else(String::new, |other| format!("{:.2}x", timing.speedup_over(other)));
            format!("{rate:>9.2}{ratio:>7}")
        };
        println!("  {:<30}{}", tracer.label(), columns.iter().map(cell).collect::<String>());
    }
}

fn add(tracers: &[Tracer], columns: &[Column], targets: &mut Targets) {
    for (row, tracer) in tracers.iter().enumerate().filter(|(_, tracer)| tracer.is_ours()) {
        for column in columns {
            let Some(other) = counterpart(tracers, column, tracer) else { continue };
            let what = match (tracer.call, column.kind) {
                (Call::Single, _) => "single, all kinds".to_owned(),
                (Call::Packet, Kind::Primary | Kind::Shadow) => format!("packets, {}", column.kind.name()),
                (Call::Batch, Kind::Diffuse2 | Kind::Random) => "batch, diffuse2 and random".to_owned(),
                _ => continue,
            };
            targets.add(&format!("{} {what}", tracer.test), column.timings[row].speedup_over(other));
        }
    }
}

fn scaling(tracers: &[Tracer], fewer: &[Column], more: &[Column], counts: &str, targets: &mut Targets) {
    for (row, tracer) in tracers.iter().enumerate() {
        for (fewer, more) in fewer.iter().zip(more) {
            let gain = more.timings[row].wall_rate() / fewer.timings[row].wall_rate();
            targets.add(&format!("wall, {counts}, {}", tracer.label()), gain);
        }
    }
}
