//! Writers keep to the memory that they ask for, by the kernel's own count. One test, so that nothing else runs.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "helpers of tests, where a panic is a failure")]

use juggler_imaging::{Destination, Format, Header, writer};
use juggler_math::Rgb;
use juggler_math::testing::Random;

/// The most memory that this process ever had, in bytes.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap();
    line.split_ascii_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

#[test]
fn writers_keep_to_the_memory_they_ask_for() {
    let header = Header::new(900, 900);
    let mut random = Random::new(1);
    let rows: Vec<Rgb> = (0..900 * 50).map(|_| random.rgb()).collect();
    // Those that need little first: the peak never falls.
    for (format, seekable) in [
        (Format::Hdr, true),
        (Format::Png, true),
        (Format::Pfm, true),
        (Format::Exr, true),
        (Format::Jpeg, true),
        (Format::Webp, true),
        (Format::Exr, false),
        (Format::Pfm, false),
    ] {
        let before = peak();
        let destination = match seekable {
            true => Destination::seekable("file", tempfile::tempfile().unwrap()),
            false => Destination::stream("pipe", std::io::sink()),
        };
        let mut writer = writer(format, destination, &header).unwrap();
        (0..18).for_each(|_| writer.write_rows(&rows).unwrap());
        writer.finish().unwrap();
        let (taken, promised) = (peak() - before, format.memory_needed(&header, seekable));
        assert!(taken <= promised, "{format}: took {taken} bytes more, promised {promised}");
    }
}
