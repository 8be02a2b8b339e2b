//! Writers stay within their declared memory, measured by the kernel. A single test, so that
//! nothing else runs in the process.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "helpers of tests, where a panic is a failure")]

use juggler_imaging::{Destination, Header, ImageFormat, writer};
use juggler_math::Rgb;
use juggler_math::testing::Random;

/// Peak resident memory of this process in bytes.
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
    // In ascending order of memory, since the peak never falls.
    for (format, seekable) in [
        (ImageFormat::Hdr, true),
        (ImageFormat::Png, true),
        (ImageFormat::Pfm, true),
        (ImageFormat::Exr, true),
        (ImageFormat::Jpeg, true),
        (ImageFormat::Webp, true),
        (ImageFormat::Exr, false),
        (ImageFormat::Pfm, false),
    ] {
        let before = peak();
        let destination = match seekable {
            true => Destination::seekable("file", tempfile::tempfile().unwrap()),
            false => Destination::stream("pipe", std::io::sink()),
        };
        let mut writer = writer(format, destination, &header).unwrap();
        (0..18).for_each(|_| writer.write_rows((&rows).into()).unwrap());
        writer.finish().unwrap();
        let (used, declared) = (peak() - before, format.memory_needed(&header, seekable));
        assert!(used <= declared, "{format}: took {used} bytes more, declared {declared}");
    }
}
