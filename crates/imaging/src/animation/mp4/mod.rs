//! MP4 (ISO/IEC 14496-12 and -14) with AV1 video (AOM, AV1 Bitstream & Decoding Process; AV1 Codec
//! ISO Media File Format Binding). The encoder is rav1e on one thread, so that the output is
//! deterministic; frames are not reordered.

mod boxes;
mod level;
mod planes;
mod track;

use super::frame_time::duration;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::Destination;
use crate::tone::Quantizer;
use juggler_math::PixelRows;
use planes::Planes;
use rav1e::color::{
    ChromaSamplePosition, ColorDescription, ColorPrimaries, MatrixCoefficients, TransferCharacteristics,
};
use rav1e::config::{Config, EncoderConfig, SpeedSettings};
use rav1e::data::{FrameType, Rational};
use rav1e::prelude::{ChromaSampling, PixelRange, SceneDetectionSpeed, Tune};
use rav1e::{Context, EncoderStatus};
use track::{Track, TrackInfo};

/// Encoder speed, 0 (best compression) to 10. Without frame reordering, files are 40 % larger at
/// the same error than with reordering at speed 8, for a third of the time and half of the memory
/// (docs/notes/movies.md).
const SPEED: u8 = 9;
/// Frames of lookahead, all kept in memory.
const LOOKAHEAD: usize = 10;
/// AV1 quantizer index by quality, finest first, linearly interpolated.
const QUANTIZERS: [(u8, usize); 4] = [(100, 4), (80, 80), (50, 155), (1, 250)];
/// Interval between key frames in seconds; after seeking a player decodes at most this much in
/// vain.
const KEY_FRAME_INTERVAL: f64 = 2.0;

/// Streams frames into an MP4.
pub(super) struct Writer {
    context: Context<u8>,
    quantizer: Quantizer,
    planes: Planes,
    track: Track,
    file: String,
    /// Quantized RGB of a frame.
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        // Choose a time scale of at least 10,000 ticks per second, which players are used to.
        let (mut ticks, mut per_second) = duration(header.frames_per_second, 1 << 20);
        while per_second < 10_000 {
            (ticks, per_second) = (ticks * 2, per_second * 2);
        }
        let key_frame_interval = (header.frames_per_second * KEY_FRAME_INTERVAL).clamp(1.0, 240.0) as u32;
        let level = level::lowest(header.width, header.height, header.frames_per_second);
        let wrong = |error: rav1e::InvalidConfig| refused(&file, format!("encoding as AV1 failed: {error}"));
        let encoder = EncoderConfig {
            time_base: Rational::new(ticks.into(), per_second.into()),
            level_idx: level,
            min_key_frame_interval: key_frame_interval.into(),
            max_key_frame_interval: key_frame_interval.into(),
            quantizer: quantizer_for_quality(header.quality),
            ..encoder(header.width as usize, header.height as usize)
        };
        let context = Config::new().with_encoder_config(encoder).with_threads(1).new_context().map_err(wrong)?;
        let info = TrackInfo {
            size: [header.width, header.height],
            ticks,
            per_second,
            level: level.unwrap_or(level::MAX_PARAMETERS),
            frames: header.frames,
            key_frame_interval,
        };
        let track = Track::begin(destination, info)?;
        let quantizer = Quantizer::new(&header.tone, 255);
        let planes = Planes::new(header.width as usize, header.height as usize);
        Ok(Self { context, quantizer, planes, track, file, bytes: Vec::new() })
    }

    /// Writes the frames that the encoder has completed.
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
        refused(&self.file, format!("encoding as AV1 failed: {status}"))
    }
}

/// Encoder settings that depend on the frame size alone.
fn encoder(width: usize, height: usize) -> EncoderConfig {
    let mut speed_settings = SpeedSettings::from_preset(SPEED);
    speed_settings.rdo_lookahead_frames = LOOKAHEAD;
    // Key frames at regular intervals only, so that their number is known in advance.
    speed_settings.scene_detection_mode = SceneDetectionSpeed::None;
    EncoderConfig {
        width,
        height,
        bit_depth: 8,
        // 4:2:0, which every player supports, including hardware decoders.
        chroma_sampling: ChromaSampling::Cs420,
        chroma_sample_position: ChromaSamplePosition::Vertical,
        pixel_range: PixelRange::Limited,
        // The tone curve encodes for sRGB, whose primaries are those of BT.709.
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

/// AV1 quantizer index of a quality, 0 (finest) to 255.
fn quantizer_for_quality(quality: u8) -> usize {
    for [(good, fine), (bad, coarse)] in QUANTIZERS.array_windows() {
        if quality >= *bad {
            let below = usize::from(good.saturating_sub(quality));
            return fine + (coarse - fine) * below / usize::from(good - bad);
        }
    }
    255
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        self.bytes.clear();
        self.quantizer.append_bytes(pixels, &mut self.bytes);
        let mut frame = self.context.new_frame();
        for (plane, (bytes, width)) in frame.planes.iter_mut().zip(self.planes.convert(&self.bytes)) {
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
    fn higher_quality_has_a_finer_quantizer() {
        assert_eq!([100, 80, 65, 50, 1].map(quantizer_for_quality), [4, 80, 117, 155, 250]);
        assert!((1..100).all(|quality| quantizer_for_quality(quality) >= quantizer_for_quality(quality + 1)));
    }
}
