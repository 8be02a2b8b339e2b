//! Parsers of flag values: sizes, ranges, amounts of memory. Error messages give an example of a
//! valid value.

pub mod stage;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use juggler::Denoiser;
use juggler::camera::film::{BLOCK_SAMPLES, Rect};
use juggler::imaging::animation::FRAME_RATES;
use juggler::imaging::{DisplayLook, Primaries, WhiteBalance};
use juggler::scene::compile::{MAX_PIXELS, MAX_SHUTTER};
use std::ops::Range;
use std::time::Duration;

/// Maximum width and height, in pixels.
const MAX_EDGE: u32 = 65_536;
/// Maximum number of samples per pixel.
const MAX_SAMPLES: u32 = 16_777_216;
/// Maximum number of frames of one command, as of an animation.
const MAX_FRAMES: u32 = 1_000_000;
/// Maximum duration of a render, in seconds (over 30 years).
const MAX_DURATION: f64 = 1e9;

/// Parser of the names of an enumeration.
pub fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let value = move |text: String| all.into_iter().find(|value| name(*value) == text).ok_or("no such name");
    PossibleValuesParser::new(all.map(name)).try_map(value)
}

/// `640x360`: width and height in pixels.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "a size is WIDTHxHEIGHT, such as 640x360".to_owned();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(wrong)?;
    let edge = |text: &str| match text.parse::<u32>() {
        Ok(edge @ 1..=MAX_EDGE) => Ok(edge),
        Ok(_) => Err(format!("width and height are 1 to {MAX_EDGE} pixels")),
        Err(_) if !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit()) => {
            Err(format!("width and height are 1 to {MAX_EDGE} pixels"))
        }
        Err(_) => Err(wrong()),
    };
    let [width, height] = [edge(width)?, edge(height)?];
    match u64::from(width) * u64::from(height) {
        pixels if pixels > MAX_PIXELS => Err(format!("these are {pixels} pixels; at most {MAX_PIXELS} are allowed")),
        _ => Ok([width, height]),
    }
}

/// `10,20,320,200`: left, top, width and height in pixels.
pub fn crop(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok([_, _, 0, _] | [_, _, _, 0]) => Err("width and height of a crop are at least 1".into()),
        Ok([x, y, width, height]) => Ok(Rect { x: *x, y: *y, width: *width, height: *height }),
        _ => Err("a crop is LEFT,TOP,WIDTH,HEIGHT in pixels, such as 100,50,320,200".into()),
    }
}

/// `0.01`: a probability between 0 and 1, exclusive.
pub fn probability(text: &str) -> Result<f64, String> {
    let probability = text.parse().ok().filter(|probability: &f64| *probability > 0.0 && *probability < 1.0);
    probability.ok_or_else(|| "a chance lies between 0 and 1, such as 0.01".to_owned())
}

/// `320,180`: column and row of a pixel.
pub fn pixel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "a pixel is X,Y from the top left, such as 320,180".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}

/// Half-open range of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// First frame.
    pub first: u32,
    /// Frame after the last one; `None` for the end of the animation.
    pub end: Option<u32>,
}

/// Display look by name.
pub fn look(text: &str) -> Result<DisplayLook, String> {
    let look = DisplayLook::ALL.into_iter().find(|look| look.name() == text);
    look.ok_or_else(|| DisplayLook::ALL.map(DisplayLook::name).join(" or "))
}

/// `3200` or `3200,5`: color temperature of the light that appears white, and tint.
pub fn white_balance(text: &str) -> Result<WhiteBalance, String> {
    let wrong = || "a light is KELVIN or KELVIN,TINT, 1667 to 25000 and -50 to 50, such as 3200 or 3200,5".to_owned();
    let (kelvin, tint) = text.split_once(',').unwrap_or((text, "0"));
    let number = |text: &str, least: f64, most: f64| {
        text.trim().parse().ok().filter(|number| (least..=most).contains(number)).ok_or_else(wrong)
    };
    Ok(WhiteBalance { kelvin: number(kelvin, 1667.0, 25_000.0)?, tint: number(tint, -50.0, 50.0)? })
}

/// Primaries by name.
pub fn primaries(text: &str) -> Result<Primaries, String> {
    let found = Primaries::ALL.into_iter().find(|primaries| primaries.name() == text);
    found.ok_or_else(|| Primaries::ALL.map(Primaries::name).join(", "))
}

/// `on` or `off`.
pub fn switch(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("on or off".into()),
    }
}

/// Denoiser by name.
pub fn denoiser(text: &str) -> Result<Denoiser, String> {
    Denoiser::by_name(text).map_err(|error| error.to_string())
}

/// Frames per second.
pub fn frame_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| FRAME_RATES.contains(rate));
    rate.ok_or_else(|| format!("a number from {} to {}", FRAME_RATES.start(), FRAME_RATES.end()))
}

/// `0..30`, `10..`, `..`: half-open range of frames.
pub fn frames(text: &str) -> Result<FrameRange, String> {
    let wrong = || "a range of frames is FIRST..END without END, such as 0..30".to_owned();
    let (first, end) = text.split_once("..").ok_or_else(wrong)?;
    let number = |text: &str| match text {
        "" => Ok(None),
        text => text.parse::<u32>().map(Some).map_err(|_| wrong()),
    };
    let (first, end) = (number(first)?.unwrap_or(0), number(end)?);
    match end {
        Some(end) if end <= first => {
            Err(format!("{first}..{end} contains no frame: END is the frame after the last one"))
        }
        Some(end) if end - first > MAX_FRAMES => {
            Err(format!("{first}..{end} has {} frames; at most {MAX_FRAMES} are allowed", end - first))
        }
        _ => Ok(FrameRange { first, end }),
    }
}

/// `0..0.5`: opening and closing time of the shutter, in frames relative to the frame's time.
pub fn shutter(text: &str) -> Result<[f64; 2], String> {
    let wrong =
        || "a shutter is OPEN..CLOSE in frames relative to the frame's time, such as 0..0.5 or -0.25..0.25".to_owned();
    let (open, close) = text.split_once("..").ok_or_else(wrong)?;
    let time = |text: &str| text.parse().ok().filter(|time: &f64| time.abs() <= MAX_SHUTTER).ok_or_else(wrong);
    let [open, close] = [time(open)?, time(close)?];
    if open <= close { Ok([open, close]) } else { Err(format!("the shutter closes before it opens in {text}")) }
}

/// `512M`, `4G`, `1.5GiB`, `100000`: bytes; K, M, G, T are powers of 1024.
pub fn memory(text: &str) -> Result<u64, String> {
    let wrong = || "an amount of memory is a number with K, M, G or T, such as 512M or 4G".to_owned();
    let lower = text.to_ascii_lowercase();
    let unit = lower.trim_end_matches("ib").trim_end_matches('b');
    let (number, power) = match unit.strip_suffix(['k', 'm', 'g', 't']) {
        Some(number) => (number, 1 + "kmgt".find(&unit[number.len()..]).unwrap_or(0)),
        None => (unit, 0),
    };
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    let bytes = number * 1024_f64.powi(power as i32);
    if bytes >= 1.0 && bytes < u64::MAX as f64 { Ok(bytes as u64) } else { Err(wrong()) }
}

/// Index and number of shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Index, from 0; `None` to read it from the environment of a cluster's task.
    pub index: Option<u32>,
    /// Number of shards, at least 1.
    pub count: u32,
}

/// Maximum number of shards.
const MAX_SHARDS: u32 = 1_000_000;

/// `3/40` or `auto/40`.
pub fn shard(text: &str) -> Result<Shard, String> {
    let wrong = || "a shard is INDEX/COUNT, counted from 0, such as 3/40, or auto/40".to_owned();
    let (index, count) = text.split_once('/').ok_or_else(wrong)?;
    let count = count.parse().ok().filter(|count| (1..=MAX_SHARDS).contains(count)).ok_or_else(wrong)?;
    let index = match index {
        "auto" => None,
        index => Some(index.parse::<u32>().map_err(|_| wrong())?),
    };
    match index {
        Some(index) if index >= count => {
            Err(format!("there is no shard {index} of {count}: they are 0 to {}", count - 1))
        }
        _ => Ok(Shard { index, count }),
    }
}

/// `16..64`: half-open range of samples, at multiples of a block.
pub fn samples(text: &str) -> Result<Range<u32>, String> {
    let wrong =
        || format!("a range of samples is FIRST..END without END, in multiples of {BLOCK_SAMPLES}, such as 16..64");
    let (first, end) = text.split_once("..").ok_or_else(wrong)?;
    let (first, end) = (first.parse::<u32>().map_err(|_| wrong())?, end.parse::<u32>().map_err(|_| wrong())?);
    let whole =
        first.is_multiple_of(BLOCK_SAMPLES) && end.is_multiple_of(BLOCK_SAMPLES) && first < end && end <= MAX_SAMPLES;
    if whole { Ok(first..end) } else { Err(wrong()) }
}

/// A relative error between 0 and 1, exclusive, such as 0.02.
pub fn noise(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(level) if level > 0.0 && level < 1.0 => Ok(level),
        _ => Err("a noise level is a relative error between 0 and 1, such as 0.02".into()),
    }
}

/// Seconds between checkpoints, 0.001 to 10⁶.
pub fn interval(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.001..=1e6).contains(&seconds) => Ok(seconds),
        _ => Err("a pause is a number of seconds, at least 0.001, such as 60".into()),
    }
}

/// A finite, non-negative number of seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds >= 0.0 => Ok(seconds),
        _ => Err("a time is a number of seconds, at least 0, such as 1.5".into()),
    }
}

/// Duration of a render, 0 to [`MAX_DURATION`] seconds.
pub fn duration(text: &str) -> Result<Duration, String> {
    match seconds(text) {
        Ok(seconds) if seconds <= MAX_DURATION => Ok(Duration::from_secs_f64(seconds)),
        _ => Err(format!("a duration is a number of seconds from 0 to {MAX_DURATION:e}, such as 90")),
    }
}

/// A mean FLIP value from 0 to 1.
pub fn flip(text: &str) -> Result<f64, String> {
    let flip = text.parse().ok().filter(|flip: &f64| (0.0..=1.0).contains(flip));
    flip.ok_or_else(|| "a FLIP value lies between 0 and 1, such as 0.02".to_owned())
}

/// A non-negative tolerance.
pub fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance >= 0.0 => Ok(tolerance),
        _ => Err("a tolerance is a number, at least 0, such as 0.001".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_parsed() {
        assert_eq!(size("640x360"), Ok([640, 360]));
        assert_eq!(size("1X65536"), Ok([1, 65_536]));
        for wrong in ["", "640", "640x", "x360", "640x360x2", "-1x5", "6.5x2", "640 x 360"] {
            assert!(size(wrong).is_err_and(|e| e.contains("such as 640x360")), "{wrong}");
        }
        assert!(size("65536x65536").is_err_and(|e| e.contains("4294967296 pixels; at most 2147483648")));
        assert_eq!(size("32768x65536"), Ok([32_768, 65_536]));
        for wrong in ["0x5", "5x0", "65537x1", "99999999999x1"] {
            assert!(size(wrong).is_err_and(|e| e.contains("1 to 65536")), "{wrong}");
        }
    }

    #[test]
    fn white_balance_primaries_and_switches_are_parsed() {
        assert_eq!(white_balance("3200"), Ok(WhiteBalance { kelvin: 3200.0, tint: 0.0 }));
        assert_eq!(white_balance("5500,-7.5"), Ok(WhiteBalance { kelvin: 5500.0, tint: -7.5 }));
        for wrong in ["", "warm", "1000", "3200,99", "3200,", "NaN", "3200,5,5"] {
            assert!(white_balance(wrong).is_err_and(|e| e.contains("such as 3200")), "{wrong}");
        }
        assert_eq!((primaries("rec2020"), switch("on"), switch("off")), (Ok(Primaries::Rec2020), Ok(true), Ok(false)));
        assert!(primaries("adobe").is_err_and(|e| e.contains("display_p3")) && switch("yes").is_err());
    }

    #[test]
    fn crops_are_parsed() {
        assert_eq!(crop("1,2,3,4"), Ok(Rect { x: 1, y: 2, width: 3, height: 4 }));
        for wrong in ["", "1,2,3", "1,2,3,4,5", "-1,2,3,4", "1,2,0,4", "1,2,3,0", "a,b,c,d"] {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ranges_leave_out_their_end() {
        assert_eq!(frames("0..30"), Ok(FrameRange { first: 0, end: Some(30) }));
        assert_eq!(frames("5.."), Ok(FrameRange { first: 5, end: None }));
        assert_eq!(frames(".."), Ok(FrameRange { first: 0, end: None }));
        for wrong in ["", "5", "5..5", "6..5", "a..b", "1...3", "-1..4"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
        assert_eq!(frames("5..1000005"), Ok(FrameRange { first: 5, end: Some(1_000_005) }));
        assert!(frames("0..4294967295").is_err_and(|message| message.contains("at most 1000000")));
    }

    #[test]
    fn shutters_are_parsed() {
        assert_eq!(shutter("0..0.5"), Ok([0.0, 0.5]));
        assert_eq!(shutter("-.25...25"), Ok([-0.25, 0.25]));
        assert_eq!(shutter("0..0"), Ok([0.0, 0.0]));
        for wrong in ["", "0", "0.5..0", "a..b", "0..nan", "0..inf", "0..1001"] {
            assert!(shutter(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn memory_sizes_are_parsed() {
        let known =
            [("1", 1), ("512M", 512 << 20), ("4g", 4 << 30), ("1.5GiB", 3 << 29), ("2KB", 2048), ("1T", 1 << 40)];
        for (text, bytes) in known {
            assert_eq!(memory(text), Ok(bytes), "{text}");
        }
        for wrong in ["", "G", "-1G", "0", "nan", "inf", "4X", "1e30T", "ib", "bb"] {
            assert!(memory(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn times_and_tolerances_are_parsed() {
        assert_eq!(seconds("1.5"), Ok(1.5));
        assert_eq!(
            (duration("1.5"), duration("1e9")),
            (Ok(Duration::from_millis(1500)), Ok(Duration::from_secs(1_000_000_000)))
        );
        for wrong in ["1e20", "1000000001", "-1", "nan", "inf", "soon"] {
            assert!(duration(wrong).is_err_and(|message| message.contains("such as 90")), "{wrong}");
        }
        assert_eq!(tolerance("0"), Ok(0.0));
        for wrong in ["", "-1", "nan", "x"] {
            assert!(seconds(wrong).is_err() && tolerance(wrong).is_err(), "{wrong}");
        }
    }
}
