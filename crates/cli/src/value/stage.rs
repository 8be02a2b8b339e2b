//! Parsers of the values that describe light, backdrop, floor, turntable and camera.

use juggler::math::color::color_names;
use juggler::math::{Rgb, Vec3};
use juggler::scene::suggest::{closest, did_you_mean};
use juggler::stage::{Backdrop, Floor, MAX_FRAMES, StageLight};
use std::path::Path;

/// Sides of a scene, each with the direction from the scene to the camera.
pub const SIDES: [(&str, Vec3); 7] = [
    ("front", Vec3::Z),
    ("back", Vec3::NEG_Z),
    ("left", Vec3::NEG_X),
    ("right", Vec3::X),
    ("top", Vec3::Y),
    ("bottom", Vec3::NEG_Y),
    ("iso", Vec3::ONE),
];

/// Kinds of floors by name.
pub const FLOORS: [(&str, Floor); 3] = [("solid", Floor::Solid), ("shadow", Floor::Shadow), ("none", Floor::None)];

/// Background without a color.
const TRANSPARENT: &str = "transparent";
/// Light around a model that is no picture.
const LIGHTS: [&str; 2] = ["studio", "sky"];

/// `1,0.5,-2`: three coordinates.
pub fn position(text: &str) -> Result<Vec3, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([x, y, z]) if [x, y, z].into_iter().all(|number| number.is_finite()) => Ok(Vec3::new(*x, *y, *z)),
        _ => Err("a point is X,Y,Z, such as 0,1.5,-4".into()),
    }
}

/// A side of the scene: the direction from the scene to the camera.
pub fn side(text: &str) -> Result<Vec3, String> {
    let found = SIDES.iter().find(|(name, _)| *name == text);
    found.map(|(_, side)| *side).ok_or_else(|| expected(text, &SIDES.map(|(name, _)| name)))
}

/// `studio`, `sky`, or the name of a file.
pub fn stage_light(text: &str) -> Result<StageLight, String> {
    match text {
        "" => Err("a light is studio, sky, or a picture such as room.hdr".into()),
        "studio" => Ok(StageLight::Studio),
        "sky" => Ok(StageLight::Sky),
        name if is_word(name) && !Path::new(name).exists() => {
            let near = question(closest(name, LIGHTS));
            Err(format!("it is neither studio nor sky, and there is no file of this name{near}"))
        }
        file => Ok(StageLight::File(file.to_owned())),
    }
}

/// Whether the name of a file has neither an extension nor a folder.
fn is_word(name: &str) -> bool {
    let path = Path::new(name);
    path.extension().is_none() && path.components().count() == 1
}

/// `transparent`, or a color as CSS writes it.
pub fn backdrop(text: &str) -> Result<Backdrop, String> {
    if text == TRANSPARENT {
        return Ok(Backdrop::Transparent);
    }
    let wrong = || {
        let hexadecimal = Some(format!("#{text}")).filter(|color| Rgb::from_css(color).is_some());
        let near = closest(text, color_names().chain([TRANSPARENT]));
        let near = question(hexadecimal.as_deref().or(near));
        format!("expected transparent, #rrggbb or a name of CSS such as white{near}")
    };
    Rgb::from_css(text).map(Backdrop::Color).ok_or_else(wrong)
}

/// Kind of a floor.
pub fn floor(text: &str) -> Result<Floor, String> {
    let found = FLOORS.iter().find(|(name, _)| *name == text);
    found.map(|(_, floor)| *floor).ok_or_else(|| expected(text, &FLOORS.map(|(name, _)| name)))
}

/// Message with all names, and the name that the text resembles or begins with.
fn expected(text: &str, names: &[&str]) -> String {
    let longer = || names.iter().copied().find(|name| text.starts_with(name));
    let near = closest(text, names.iter().copied()).or_else(longer);
    format!("expected {}{}", names.join(", "), question(near))
}

/// `; did you mean ...?` for a name that is near.
fn question(near: Option<&str>) -> String {
    near.map(|near| format!("; {}", did_you_mean(near))).unwrap_or_default()
}

/// `120`: number of frames of a turn.
pub fn turn(text: &str) -> Result<u32, String> {
    let frames = text.parse().ok().filter(|frames| (1..=MAX_FRAMES).contains(frames));
    frames.ok_or_else(|| format!("a turn has 1 to {} frames, such as 120", MAX_FRAMES))
}

/// `30`: vertical field of view in degrees.
pub fn field_of_view(text: &str) -> Result<f32, String> {
    let degrees = text.parse().ok().filter(|degrees: &f32| *degrees > 0.0 && *degrees <= 179.0);
    degrees.ok_or_else(|| "a field of view is above 0 and at most 179 degrees, such as 30".to_owned())
}

/// `0.9`: a fraction of a whole.
pub fn fraction(text: &str) -> Result<f32, String> {
    let fraction = text.parse().ok().filter(|fraction: &f32| *fraction > 0.0 && *fraction <= 1.0);
    fraction.ok_or_else(|| "a fraction is above 0 and at most 1, such as 0.9".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_stages_are_parsed() {
        assert_eq!(position("1, 0.5,-2"), Ok(Vec3::new(1.0, 0.5, -2.0)));
        assert_eq!((side("left"), side("iso")), (Ok(Vec3::NEG_X), Ok(Vec3::ONE)));
        assert_eq!(stage_light("a b.hdr"), Ok(StageLight::File("a b.hdr".into())));
        assert_eq!(
            (backdrop("White"), backdrop("transparent")),
            (Ok(Backdrop::Color(Rgb::WHITE)), Ok(Backdrop::Transparent))
        );
        assert_eq!(
            (floor("shadow"), turn("120"), field_of_view("179"), fraction("1")),
            (Ok(Floor::Shadow), Ok(120), Ok(179.0), Ok(1.0))
        );
    }

    #[test]
    fn wrong_values_state_the_valid_ones() {
        for (found, expected) in [
            (position("1,2").map(drop), "0,1.5,-4"),
            (position("1,2,inf").map(drop), "0,1.5,-4"),
            (side("up").map(drop), "front, back"),
            (stage_light("").map(drop), "room.hdr"),
            (backdrop("whit").map(drop), "did you mean `white`?"),
            (backdrop("#12").map(drop), "#rrggbb"),
            (backdrop("transparant").map(drop), "did you mean `transparent`?"),
            (backdrop("fff").map(drop), "did you mean `#fff`?"),
            (floor("on").map(drop), "expected solid, shadow, none"),
            (floor("shadows").map(drop), "did you mean `shadow`?"),
            (side("rigth").map(drop), "did you mean `right`?"),
            (side("isometric").map(drop), "did you mean `iso`?"),
            (stage_light("studdio").map(drop), "no file of this name; did you mean `studio`?"),
            (turn("0").map(drop), "such as 120"),
            (field_of_view("180").map(drop), "at most 179"),
            (fraction("0").map(drop), "such as 0.9"),
        ] {
            let message = found.unwrap_err();
            assert!(message.contains(expected), "{message}");
        }
    }
}
