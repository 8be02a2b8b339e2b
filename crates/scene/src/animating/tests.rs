use super::*;
use crate::TransformStep;
use crate::animate::{Extrapolation, Frames, Interpolation, Seconds};
use crate::description::ScaleFactors;
use juggler_camera::Perspective;
use juggler_light::Point;
use juggler_light::background::Solid;
use juggler_material::Phong;
use juggler_math::{Rgb, Vec3, vec3};
use juggler_shape::Sphere;
use juggler_texture::{Checker, Input};

/// Scene of 20 frames at 10 frames per second.
fn scene() -> Scene {
    Scene::new().frames(20, 10.0)
}

fn sphere() -> Animated<Object> {
    Animated::new(Object::new(Sphere::default()))
}

/// Scene of a sphere whose center comes from a source.
fn moved(scene: Scene, source: impl Into<ValueSource>) -> Result<Scene, SceneError> {
    scene.add_animated(sphere().moved(source))
}

/// Center of the sphere at a frame.
fn center(scene: &Scene, frame: f64) -> Vec3 {
    match scene.at_frame(frame).unwrap().description.objects[0].transform[..] {
        [TransformStep::Translate(by)] => by,
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn every_kind_of_source_moves_a_value() {
    let keys = Animate {
        repeat: Extrapolation::PingPong,
        ..Animate::from_keys([(Seconds(0.0), vec3(0.0, 0.0, 0.0)), (Seconds(1.0), vec3(0.0, 4.0, 0.0))])
    };
    let up = moved(scene(), keys).unwrap();
    assert_eq!([5.0, 10.0, 15.0].map(|frame| center(&up, frame).y), [2.0, 4.0, 2.0]);
    let path = ScenePath { points: vec![[0.0; 3], [8.0, 0.0, 0.0]], closed: false };
    let along = Along::new("line", ValueSource::expression("seconds/4"));
    let flight = moved(scene().path("line", path).unwrap(), along).unwrap();
    assert!((center(&flight, 10.0).x - 2.0).abs() < 1e-6 && (center(&flight, 20.0).x - 4.0).abs() < 1e-6);
    let up = Animate::from_keys([(Seconds(0.0), [0.0, 4.0, 0.0]), (Seconds(1.0), [0.0, 6.0, 0.0])]);
    let joint = Joint::new([0.0; 3], up, [3.0, 3.0], [0.0, 0.0, 1.0]);
    let elbow = moved(scene(), joint).unwrap();
    assert!((center(&elbow, 0.0) - vec3(5_f32.sqrt(), 2.0, 0.0)).length() < 1e-6, "{}", center(&elbow, 0.0));
    assert!((center(&elbow, 10.0) - vec3(0.0, 3.0, 0.0)).length() < 1e-6, "{}", center(&elbow, 10.0));
    let half = scene().variable("half", ValueSource::expression("frame / 2")).unwrap();
    let list = Animate::from_keys([(Seconds(0.0), [0.0, 0.0, 0.0]), (Seconds(2.0), [0.0, 0.0, 8.0])]);
    let list = Animate { at: Some(ValueSource::expression("half / 10").into()), ..list };
    assert_eq!(center(&moved(half, list).unwrap(), 10.0).z, 2.0);
}

#[test]
fn keys_count_seconds_or_frames_by_type() {
    let seconds =
        moved(scene(), Animate::from_keys([(Seconds(0.0), [0.0; 3]), (Seconds(2.0), [8.0, 0.0, 0.0])])).unwrap();
    let frames =
        moved(scene(), Animate::from_keys([(Frames(0.0), [0.0; 3]), (Frames(20.0), [8.0, 0.0, 0.0])])).unwrap();
    for frame in [0.0, 5.0, 7.5, 20.0] {
        assert_eq!(center(&seconds, frame), center(&frames, frame));
        assert_eq!(center(&seconds, frame).x, 0.4 * frame as f32);
    }
    // At another rate, only keys in frames stay at their frames.
    let slow = |scene: &Scene| scene.clone().frames(20, 5.0);
    assert_eq!(center(&slow(&frames), 10.0).x, 4.0);
    assert_eq!(center(&slow(&seconds), 10.0).x, 8.0);
}

/// Expression that is 1 at frame 10.
fn tenth() -> ValueSource {
    ValueSource::expression("frame / 10")
}

/// Three numbers that are 1, 0.5 and 0 at frame 10.
fn color() -> ValueSource {
    Animate::from_keys([(Frames(0.0), [0.0; 3]), (Frames(10.0), [1.0, 0.5, 0.0])]).into()
}

/// Scene with a source in every section, some within kinds, inputs and options.
fn animated_scene() -> Result<Scene, SceneError> {
    let growing = Animated::new(Sphere::default())
        .field(|sphere| &mut sphere.radius, ValueSource::expression("1 + frame"))
        .map(Object::new)
        .moved(ValueSource::expressions(["frame", "0", "0"]))
        .scaled(ValueSource::expression("2 + frame"))
        .map(|object| object.at(0.0, 1.0, 0.0))
        .rotated(Vec3::Y, tenth())
        .field(|object| &mut object.visible, ValueSource::expression("frame < 15"));
    let paint = Animated::new(Phong::default())
        .field(|phong| &mut phong.diffuse, color())
        .field(|phong| &mut phong.shininess, ValueSource::expression("10 + frame"));
    let sky = Animated::new(Solid { color: Rgb::WHITE }).field(|sky| &mut sky.color, color());
    scene()
        .add_animated(growing)?
        .animated_material("paint", paint)?
        .animated_light(Animated::new(Point::default()).field(|point| &mut point.position, color()))?
        .animated_camera("main", Animated::new(Perspective::default()).field(|camera| &mut camera.look_at, color()))?
        .animated_texture("tiles", Animated::new(Checker::default()).field(|checker| &mut checker.even, color()))?
        .animated_background(sky)?
        .animated_tone(Animated::new(Tone::default()).field(|tone| &mut tone.exposure_stops, tenth()))
}

#[test]
fn a_source_is_given_to_a_field() {
    let scene = animated_scene().unwrap();
    let json = scene.at_frame(10.0).unwrap().still().to_value();
    let half = json!([1, 0.5, 0]);
    for (pointer, value) in [
        ("/objects/0/shape/sphere/radius", json!(11)),
        ("/objects/0/transform/0/translate", json!([10, 0, 0])),
        ("/objects/0/transform/1/scale", json!(12)),
        ("/objects/0/transform/2/translate", json!([0, 1, 0])),
        ("/objects/0/transform/3/rotate/degrees", json!(1)),
        ("/materials/paint/phong/diffuse", half.clone()),
        ("/materials/paint/phong/shininess", json!(20)),
        ("/lights/0/point/position", half.clone()),
        ("/cameras/main/perspective/look_at", half.clone()),
        ("/textures/tiles/checker/even", half.clone()),
        ("/tone/exposure_stops", json!(1)),
    ] {
        let found = json.pointer(pointer).unwrap_or_else(|| panic!("{pointer} in {json:#}"));
        assert_eq!(round(found), round(&value), "{pointer}");
    }
    let background = &scene.at_frame(10.0).unwrap().description.background;
    assert_eq!(
        background.as_deref(),
        Some(&BackgroundInput::from(AnyBackground::from(Solid { color: Rgb::new(1.0, 0.5, 0.0) })))
    );
    assert!(scene.at_frame(14.0).unwrap().description.objects[0].is_visible());
    assert!(!scene.at_frame(15.0).unwrap().description.objects[0].is_visible());
}

/// The numbers of a value, as `f32`.
fn round(value: &serde_json::Value) -> Vec<f32> {
    match value {
        serde_json::Value::Array(elements) => elements.iter().flat_map(round).collect(),
        other => other.as_f64().map(|number| number as f32).into_iter().collect(),
    }
}

/// A source replaces what the field had, also where the scene format omits or names it.
#[test]
fn the_content_of_an_animated_field_does_not_matter() {
    for diffuse in [Input::Value(Rgb::BLACK), Input::Value(Rgb::WHITE), Input::Texture("none".into())] {
        let paint = Animated::new(Phong { diffuse, ..Phong::default() });
        let scene = scene()
            .animated_material("paint", paint.field(|phong| &mut phong.diffuse, ValueSource::expression("frame")));
        // Animating a name that no texture has is a mistake until the field has a source.
        if let Ok(scene) = scene {
            assert!(scene.at_frame(0.5).unwrap().to_json().contains("=frame"));
        }
    }
    for exposure in [0.0, 1.0, f32::INFINITY] {
        let tone = Animated::new(Tone { exposure_stops: exposure, ..Tone::default() });
        let scene = scene()
            .animated_tone(tone.field(|tone| &mut tone.exposure_stops, ValueSource::expression("frame")))
            .unwrap();
        assert_eq!(scene.at_frame(3.0).unwrap().description.tone.exposure_stops, 3.0);
    }
}

#[test]
fn fields_of_child_objects_are_animated() {
    let pair = Object::several([Object::new(Sphere::default()), Object::new(Sphere::default()).at(1.0, 0.0, 0.0)]);
    let pair = Animated::new(pair).field(
        |object| match object.objects.as_mut().unwrap()[1].transform.first_mut() {
            Some(TransformStep::Translate(by)) => by,
            other => panic!("{other:?}"),
        },
        color(),
    );
    let scene = scene().add_animated(pair.moved(color())).unwrap().at_frame(10.0).unwrap();
    let object = &scene.description.objects[0];
    let by = [TransformStep::Translate(vec3(1.0, 0.5, 0.0))];
    assert_eq!((&object.transform[..], &object.inner()[1].transform[..]), (&by[..], &by[..]));
}

/// The number of frames and the rate may come after what moves.
#[test]
fn frames_evaluate_what_moves_again() {
    let keys = || Animate::from_keys([(Seconds(0.0), [0.0; 3]), (Seconds(1.0), [8.0, 0.0, 0.0])]);
    let late = moved(Scene::new(), keys()).unwrap().at_frame(5.0).unwrap().frames(20, 10.0);
    let early = moved(scene(), keys()).unwrap().at_frame(5.0).unwrap();
    assert!(late == early && center(&late, 5.0).x == 4.0);
    let invalid = moved(scene(), keys()).unwrap().frames(20, 0.0);
    assert!(invalid.compile().is_err());
}

/// A scene that a program animates is the scene that its JSON describes.
#[test]
fn built_motion_is_written_and_read() {
    let keys = Animate::from_keys([(Seconds(0.0), [0.0; 3]), (Seconds(1.0), [2.0, 0.0, 0.0])]);
    let scene = moved(scene(), Animate { interpolation: Interpolation::Smooth, ..keys }).unwrap();
    let read = Scene::from_json(scene.to_json(), "scene.json").unwrap();
    assert!(read == scene && read.at_frame(7.0).unwrap() == scene.at_frame(7.0).unwrap());
}

#[test]
fn wrong_sources_are_refused() {
    let refused = |scene: Result<Scene, SceneError>, words: &str| {
        let message = scene.unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    };
    let backward = Animate::from_keys([(Seconds(1.0), [0.0; 3]), (Seconds(0.0), [0.0; 3])]);
    refused(moved(scene(), backward), "in order of time");
    refused(moved(scene(), Animate::from_keys([(Seconds(0.0), [f64::NAN; 3])])), "number");
    refused(moved(scene(), ValueSource::expression("nothing")), "nothing");
    refused(moved(scene(), ValueSource::expression("frame")), "transform");
    refused(moved(scene(), Along::new("none", 0.0)), "no path is called `none`");
    // A factor is a number or three numbers; the step itself cannot be written otherwise.
    assert!(matches!(
        scene().add_animated(sphere().scaled(ValueSource::expression("2"))).unwrap().description.objects[0].transform[..],
        [TransformStep::Scale(ScaleFactors::All(2.0))]
    ));
    let nowhere = Animated::new(Tone::default()).field(|_| Box::leak(Box::new(1.0)), tenth());
    refused(scene().animated_tone(nowhere), "not part of the scene format");
    let twice = Animated::new(1.0_f32).field(|radius| radius, tenth());
    let twice = twice.map(|radius| Object::new(Sphere { radius }).at(0.0, radius, 0.0));
    refused(scene().add_animated(twice), "several values");
}
