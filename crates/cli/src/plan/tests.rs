//! Tests of plans.

use super::*;
use juggler::camera::film::Rect;
use juggler::imaging::{DisplayLook, ImageFormat, SampleDepth};

fn plan(line: &str) -> Result<Plan, Failure> {
    Plan::new(RenderArgs::from_words(line.split(' ')).unwrap())
}

fn encoding(line: &str) -> Encoding {
    match plan(line).unwrap().output_kind {
        OutputKind::Picture(encoding) => encoding,
        OutputKind::PartialRender => panic!("{line}: a partial render"),
    }
}

fn refused(line: &str) -> String {
    match plan(line) {
        Err(Failure::Invalid(message)) => message,
        other => panic!("{line}: {other:?}"),
    }
}

#[test]
fn the_output_is_named_after_the_scene() {
    assert_eq!(plan("juggler").unwrap().output, "juggler.png");
    assert_eq!(plan("scenes/pawn.json").unwrap().output, "pawn.png");
    assert_eq!(encoding("a -o b.exr").format, ImageFormat::Exr);
    assert_eq!(encoding("a -o -").format, ImageFormat::Png);
    assert_eq!(encoding("a -o - --format jpg").format, ImageFormat::Jpeg);
    assert!(refused("a -o b.psd").contains(".png"));
    let message = refused("a -o b.tif");
    assert!(message.contains("Juggler reads TIFF pictures but does not write them; use .png"), "{message}");
    assert!(refused("a -o - --format tga").contains("tga"));
}

#[test]
fn bits_and_quality_fit_the_format() {
    assert!(encoding("a --bits 16").options.png_16_bit);
    let exr = |line| encoding(line).options.exr_depth;
    assert_eq!((exr("a -o b.exr --bits 16"), exr("a -o b.exr")), (SampleDepth::Half, SampleDepth::Float));
    assert_eq!(encoding("a -o b.jpg --quality 7").options.jpeg_quality, 7);
    assert!(refused("a -o b.jpg --bits 16").contains("8 bits"));
    assert!(refused("a --quality 7").contains("JPEG"));
    assert_eq!(encoding("a --look ham -o b.webp").options.look, DisplayLook::Ham);
    assert_eq!(plan("a --look ham-dithered -o b.gif").unwrap().options().look, DisplayLook::HamDithered);
    assert!(refused("a --look ham -o b.exr").contains("linear radiance"));
    assert!(refused("a --look ham -o b.jfilm").contains("--look"));
}

#[test]
fn movies_are_known_by_their_ending_and_have_all_frames() {
    let film = plan("a -o b.gif --plays 2").unwrap();
    let movie = film.movie.clone().unwrap();
    assert_eq!((movie.file.as_str(), movie.plays, movie.frames_per_second), ("b.gif", 2, None));
    let frame_outputs = film.frame_outputs(3, 24.0).unwrap();
    assert_eq!(frame_outputs.len(), 3);
    assert_eq!(frame_outputs[2].output, "b.gif.frames/frame_0002.png");
    assert_eq!(film.output_kind, OutputKind::Picture(encoding("a -o b.png")));
    assert!(plan("a -o b --format apng").unwrap().movie.is_some());
    assert!(plan("a -o b.png").unwrap().movie.is_none());
}

#[test]
fn webps_are_pictures_unless_frames_go_into_one() {
    let is_film = |line: &str| plan(line).unwrap().movie.is_some();
    assert!(is_film("a -o b.webp --frames 0..3") && is_film("a -o b.webp --fps 5") && is_film("a -o b.mp4"));
    assert!(!is_film("a -o b.webp") && !is_film("a -o b_##.webp --frames 0..3"));
}

#[test]
fn shards_get_frames_in_turn() {
    for output in ["f_##.png", "f.gif"] {
        let frames = |shard: &str| {
            let frame_outputs =
                plan(&format!("a --frames 3..8 -o {output} {shard}")).unwrap().frame_outputs(30, 24.0).unwrap();
            frame_outputs.iter().map(|frame_output| (frame_output.frame, frame_output.shard)).collect::<Vec<_>>()
        };
        assert_eq!(frames("--shard 0/2"), [3.0, 5.0, 7.0].map(|frame| (frame, Shard::WHOLE)));
        assert_eq!(frames("--shard 1/2"), [4.0, 6.0].map(|frame| (frame, Shard::WHOLE)));
        assert!(frames("--shard 5/9").is_empty());
    }
    let kept = plan("a -o b.gif").unwrap().frame_outputs(2, 24.0).unwrap();
    assert_eq!(kept[1].checkpoint.as_deref(), Some("b.gif.frames/frame_0001.jfilm"));
}

#[test]
fn partial_renders_are_known_by_their_ending_and_keep_a_film() {
    assert_eq!(plan("a -o b.jfilm").unwrap().output_kind, OutputKind::PartialRender);
    assert_eq!(plan("a -o b --format jfilm").unwrap().output_kind, OutputKind::PartialRender);
    for line in ["a -o b.jfilm", "a --checkpoint c.jfilm", "a --noise 0.1", "a --time 1", "a --samples-from b.png"] {
        let plan = plan(line).unwrap();
        assert!(plan.needs_film(&Scene::new(), &plan.frame_outputs(1, 1.0).unwrap()[0]), "{line}");
    }
    let plain = plan("a").unwrap();
    assert!(!plain.needs_film(&Scene::new(), &plain.frame_outputs(1, 1.0).unwrap()[0]));
    assert!(refused("a -o b.jfilm --bits 16").contains("--bits"));
    assert!(refused("a -o - --format jfilm").contains("standard output"));
    // The crop of a picture is its region; the crop of a partial render is a cut.
    let crops = |line: &str| plan(line).map(|plan| (plan.settings.crop, plan.cut.crop)).unwrap();
    let crop = Some(Rect { x: 0, y: 0, width: 16, height: 16 });
    assert_eq!((crops("a --crop 0,0,16,16"), crops("a --crop 0,0,16,16 -o b.jfilm")), ((crop, None), (None, crop)));
    let kept = plan("a --checkpoint c.jfilm --frames 0..2").unwrap().frame_outputs(2, 24.0).unwrap();
    assert_eq!(kept[1].checkpoint.as_deref(), Some("c_0001.jfilm"));
}

#[test]
fn times_and_frames_become_frame_outputs() {
    let frame_outputs = |line: &str| plan(line).unwrap().frame_outputs(30, 24.0).unwrap();
    let frames = |line: &str| frame_outputs(line).iter().map(|frame_output| frame_output.frame).collect::<Vec<_>>();
    assert_eq!(frames("a"), [0.0]);
    assert_eq!(frames("a --frame 7"), [7.0]);
    assert_eq!(frames("a --at 0.5"), [12.0]);
    assert_eq!(frames("a --frames 2..4"), [2.0, 3.0]);
    assert_eq!(frames("a --frames 28.."), [28.0, 29.0]);
    assert_eq!(frames("a --frames ..").len(), 30);
    assert!(matches!(plan("a --frames 30..").unwrap().frame_outputs(30, 24.0), Err(Failure::Invalid(_))));
    let last = frame_outputs("a --frames 0..12 -o f_##.png --stats s.json").pop().unwrap();
    assert_eq!((last.output.as_str(), last.stats.as_deref()), ("f_11.png", Some("s_0011.json")));
    assert_eq!(frame_outputs("a --frames 3..4 --stats -").first().unwrap().stats.as_deref(), Some("-"));
}

#[test]
fn standard_output_holds_one_output() {
    assert!(refused("a -o - --frames 0..2").contains("one picture"));
    assert!(refused("a -o - --stats -").contains("standard output"));
    assert!(plan("a -o -").unwrap().uses_standard_output() && plan("a --stats -").unwrap().uses_standard_output());
    assert!(!plan("a --stats s.json").unwrap().uses_standard_output());
}

#[test]
fn mutually_exclusive_flags_are_rejected() {
    for line in ["a --frame 1 --at 2", "a --frame 1 --frames 1..2", "a --frames 1..2 --at 1", "a -q --progress bar"] {
        assert!(RenderArgs::from_words(line.split(' ')).is_err(), "{line}");
    }
}
