//! MP4 (ISO/IEC 14496-12 and -14) with AV1 (AOM, AV1 Bitstream & Decoding Process; AV1 Codec ISO Media File Format
//! Binding). The encoder is rav1e, on one thread, so that the bytes are the same wherever and whenever they are made; frames
//! leave it in the order in which they are shown.

mod boxes;
mod level;
mod planes;
mod track;

use super::pace::duration;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::Destination;
use crate::tone::Quantizer;
use juggler_math::Rgb;
use planes::Planes;
use rav1e::color::{
    ChromaSamplePosition, ColorDescription, ColorPrimaries, MatrixCoefficients, TransferCharacteristics,
};
use rav1e::config::{Config, EncoderConfig, SpeedSettings};
use rav1e::data::{FrameType, Rational};
use rav1e::prelude::{ChromaSampling, PixelRange, SceneDetectionSpeed, Tune};
use rav1e::{Context, EncoderStatus};
use track::{Facts, Track};

/// How thoroughly the encoder looks for what is small: 0 to 10, fastest last. Frames in the order in which they are shown, as
/// here, are 40 % larger at the same error than reordered ones at speed 8, for a third of the time and half of the memory
/// (docs/benchmarks.md).
const SPEED: u8 = 9;
/// Frames that the encoder looks ahead, each in memory.
const LOOKAHEAD: usize = 10;
/// Quantizers at qualities, finest first; between them it is a straight line.
const QUANTIZERS: [(u8, usize); 4] = [(100, 4), (80, 80), (50, 155), (1, 250)];
/// Seconds from one frame that needs no other to the next: what a player that jumps decodes for nothing.
const BETWEEN_KEYS: f64 = 2.0;

/// Streams frames into an MP4.
pub(super) struct Writer {
    context: Context<u8>,
    quantizer: Quantizer,
    planes: Planes,
    track: Track,
    place: String,
    /// The levels of a frame.
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        // A clock of some ten thousand ticks a second, as players are used to.
        let (mut ticks, mut per_second) = duration(header.frames_per_second, 1 << 20);
        while per_second < 10_000 {
            (ticks, per_second) = (ticks * 2, per_second * 2);
        }
        let between_keys = (header.frames_per_second * BETWEEN_KEYS).clamp(1.0, 240.0) as u32;
        let level = level::least(header.width, header.height, header.frames_per_second);
        let wrong = |error: rav1e::InvalidConfig| refused(&place, format!("cannot be encoded as AV1: {error}"));
        let encoder = EncoderConfig {
            time_base: Rational::new(ticks.into(), per_second.into()),
            level_idx: level,
            min_key_frame_interval: between_keys.into(),
            max_key_frame_interval: between_keys.into(),
            quantizer: quantizer_of(header.quality),
            ..encoder(header.width as usize, header.height as usize)
        };
        let context = Config::new().with_encoder_config(encoder).with_threads(1).new_context().map_err(wrong)?;
        let facts = Facts {
            size: [header.width, header.height],
            ticks,
            per_second,
            level: level.unwrap_or(level::ANY),
            frames: header.frames,
            between_keys,
        };
        let track = Track::begin(destination, facts)?;
        let quantizer = Quantizer::new(&header.tone, 255);
        let planes = Planes::new(header.width as usize, header.height as usize);
        Ok(Self { context, quantizer, planes, track, place, bytes: Vec::new() })
    }

    /// Writes the frames that the encoder has finished.
    fn drain(&mut self) -> Result<(), ImageError> {
        loop {
            match self.context.receive_packet() {
                Ok(packet) => self.track.append(&packet.data, packet.frame_type == FrameType::KEY)?,
                Err(EncoderStatus::Encoded) => {}
                Err(EncoderStatus::NeedMoreData | EncoderStatus::LimitReached) => return Ok(()),
                Err(status) => return Err(self.failed(status)),
            }
        }
    }

    fn failed(&self, status: EncoderStatus) -> ImageError {
        refused(&self.place, format!("cannot be encoded as AV1: {status}"))
    }
}

/// All that does not depend on the film but its size.
fn encoder(width: usize, height: usize) -> EncoderConfig {
    let mut speed_settings = SpeedSettings::from_preset(SPEED);
    speed_settings.rdo_lookahead_frames = LOOKAHEAD;
    // A key only where one is due: then their number is known before.
    speed_settings.scene_detection_mode = SceneDetectionSpeed::None;
    EncoderConfig {
        width,
        height,
        bit_depth: 8,
        // What every player knows, those built into telephones too.
        chroma_sampling: ChromaSampling::Cs420,
        chroma_sample_position: ChromaSamplePosition::Vertical,
        pixel_range: PixelRange::Limited,
        // Levels are those of sRGB, whose primaries are those of BT.709.
        color_description: Some(ColorDescription {
            color_primaries: ColorPrimaries::BT709,
            transfer_characteristics: TransferCharacteristics::SRGB,
            matrix_coefficients: MatrixCoefficients::BT709,
        }),
        low_latency: true,
        tune: Tune::Psnr,
        speed_settings,
        ..EncoderConfig::with_speed_preset(SPEED)
    }
}

/// The encoder's quantizer, 0 to 255, finest first.
fn quantizer_of(quality: u8) -> usize {
    for [(good, fine), (bad, coarse)] in QUANTIZERS.array_windows() {
        if quality >= *bad {
            let below = usize::from(good.saturating_sub(quality));
            return fine + (coarse - fine) * below / usize::from(good - bad);
        }
    }
    255
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        self.bytes.clear();
        self.quantizer.append_bytes(pixels, &mut self.bytes);
        let mut frame = self.context.new_frame();
        for (plane, (bytes, width)) in frame.planes.iter_mut().zip(self.planes.of(&self.bytes)) {
            plane.copy_from_raw_u8(bytes, width, 1);
        }
        self.context.send_frame(frame).map_err(|status| self.failed(status))?;
        self.drain()
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        self.context.flush();
        self.drain()?;
        self.track.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn better_is_finer() {
        assert_eq!([100, 80, 65, 50, 1].map(quantizer_of), [4, 80, 117, 155, 250]);
        assert!((1..100).all(|quality| quantizer_of(quality) >= quantizer_of(quality + 1)));
    }
}
