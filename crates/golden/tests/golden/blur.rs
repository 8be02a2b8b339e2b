//! A motion-blurred picture equals the mean of pictures at many times while the shutter is open,
//! for moving shapes, limbs, groups, meshes, light and camera.

use juggler::math::Rgb;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Picture, Settings};

/// A scene in which everything moves on curved paths.
const SCENE: &str = r##"{"version": 1, "animation": {"frames": 10, "frames_per_second": 10},
    "variables": {"t": "frame / 10", "turn": "360 * t"},
    "paths": {"way": {"points": [[-2, 0.6, 1], [0, 1.4, 2], [2, 0.6, 1], [0, 0.4, -1]], "closed": true}},
    "render": {"size": [48, 32], "samples": 64, "integrator": {"classic": {"max_depth": 2}}},
    "camera": {"perspective": {"eye": ["=2*sin(t)", 3, "=8-2*t"], "look_at": [0, 0.5, 0], "vertical_fov_degrees": "=35+20*t"}},
    "lights": [{"point": {"position": ["=4*cos(6*t)", 6, "=4*sin(6*t)"], "intensity": "=30+60*t"}},
        {"ambient": {"intensity": "=0.2+0.3*t"}}],
    "groups": {"pair": [{"shape": {"cuboid": {"min": [-0.3, -0.3, -0.3], "max": [0.3, 0.3, 0.3]}},
        "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": "=turn"}}, {"translate": [0.6, 0, 0]}]},
        {"shape": {"sphere": {"radius": 0.25}}, "transform": [{"translate": [-0.6, "=t", 0]}]}]},
    "materials": {"red": {"phong": {"diffuse": [0.8, 0.2, 0.1], "ambient": 1}},
        "board": {"checkerboard": {"size": 1, "even": {"phong": {"diffuse": 0.9, "ambient": 1}},
            "odd": {"phong": {"diffuse": 0.2, "ambient": 1}}}}},
    "objects": [{"shape": {"plane": {}}, "material": "board"},
        {"shape": {"sphere": {"radius": "=0.3+t"}}, "material": "red", "transform": [{"translate": {"along": {"path": "way", "at": "=t"}}}]},
        {"group": "pair", "material": "red", "transform": [{"rotate": {"axis": [0, 0, 1], "degrees": "=turn"}}, {"translate": [2, 1, 0]}]},
        {"limb": {"from": [-2, 0, 0], "to": ["=-2+t", "=1.5-t", 0], "lengths": [1, 1], "plane_normal": [0, 0, 1], "radii": [0.15, 0.2, 0.1]},
            "material": "red"},
        {"shape": {"mesh": {"positions": [[-1, 0, -2], [1, 0, -2], [0, 2, -2]], "triangles": [[0, 1, 2]],
            "morphs": [{"positions": [[-3, 0, -3], [0, 1, -2], [0, 3, -1]], "weight": "=t*t*2"}]}}, "material": "red"}]}"##;

fn picture(frame: f64, settings: &Settings) -> Picture {
    let scene = Scene::from_json(SCENE, "moving.json").unwrap().at_frame(frame).unwrap();
    Picture::new(&scene, settings).unwrap()
}

pub fn pixels(picture: &Picture) -> Vec<Rgb> {
    picture.render_image(&Control::default()).unwrap().pixels().to_vec()
}

fn difference(a: &[Rgb], b: &[Rgb]) -> (f32, f32) {
    let errors = || a.iter().zip(b).flat_map(|(a, b)| (*a - *b).to_array());
    let count = errors().count() as f32;
    let square = errors().map(|error| error * error).sum::<f32>() / count;
    (square.sqrt(), (errors().sum::<f32>() / count).abs())
}

#[test]
#[cfg_attr(debug_assertions, ignore = "statistics of whole pictures run in the optimized build only")]
fn a_blurred_picture_is_the_mean_of_its_instants() {
    const INSTANTS: u32 = 96;
    for [open, close] in [[0.0, 4.0], [-1.0, 0.5]] {
        let blurred =
            picture(4.0, &Settings { shutter: Some([open, close]), samples: Some(400), ..Settings::default() });
        assert!(blurred.world().moves() && blurred.job().camera.moves());
        let blurred = pixels(&blurred);
        let mut mean = vec![Rgb::BLACK; blurred.len()];
        for i in 0..INSTANTS {
            let fraction = (f64::from(i) + 0.5) / f64::from(INSTANTS);
            let few = Settings { samples: Some(8), seed: Some(u64::from(i)), ..Settings::default() };
            let still = picture(4.0 + open + (close - open) * fraction, &few);
            assert!(!still.world().moves());
            mean.iter_mut().zip(pixels(&still)).for_each(|(sum, pixel)| *sum += pixel / INSTANTS as f32);
        }
        let (square, bias) = difference(&blurred, &mean);
        assert!(square < 0.02 && bias < 1e-3, "{open} to {close}: {square} {bias}");
        let sharp = pixels(&picture(4.0, &Settings { samples: Some(64), ..Settings::default() }));
        assert!(difference(&sharp, &mean).0 > 3.0 * square, "the instant is another picture");
    }
}

#[test]
fn fingerprints_include_frame_and_shutter() {
    let of = |frame: f64, shutter: [f64; 2]| {
        let settings = Settings { shutter: Some(shutter), ..Settings::default() };
        picture(frame, &settings).fingerprint().hash()
    };
    let prints = [of(4.0, [0.0, 0.0]), of(4.0, [0.0, 0.5]), of(4.0, [0.0, 1.0]), of(5.0, [0.0, 0.5])];
    for (i, a) in prints.iter().enumerate() {
        assert!(prints[i + 1..].iter().all(|b| a != b), "{prints:?}");
    }
    assert_eq!(of(4.0, [0.0, 0.5]), prints[1]);
}
