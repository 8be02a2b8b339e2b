//! Flags for what surrounds a model or mesh and for the camera that sees it.

use crate::failure::Failure;
use crate::value;
use crate::value::stage::{FLOORS, SIDES};
use clap::Args;
use juggler::math::{Rgb, Vec3, color};
use juggler::stage::{Backdrop, Floor, StageLight};
use juggler::{Error, Stage};

/// Flags for light, backdrop, floor, turntable and camera.
#[derive(Clone, Debug, Default, PartialEq, Args)]
pub struct StageArgs {
    /// Light around a model: studio, sky, or a picture
    ///
    /// A picture is a panorama such as room.hdr.
    /// It replaces the light that Juggler adds by itself; lights of a model's file stay.
    #[arg(long, value_name = "LIGHT", value_parser = value::stage::stage_light, hide_short_help = true)]
    pub environment: Option<StageLight>,

    /// Color where nothing is, such as white, or transparent
    ///
    /// The color is that of the file, whatever the tone curve. It lights nothing.
    #[arg(long, value_name = "COLOR", value_parser = value::stage::backdrop)]
    pub background: Option<Backdrop>,

    /// Floor of a model: solid, shadow or none
    ///
    /// Of the floor `shadow`, only the shadows on it show. `none` takes away the floor of a mesh.
    #[arg(long, value_name = "KIND", num_args = 0..=1, default_missing_value = "solid", value_parser = value::stage::floor)]
    pub floor: Option<Floor>,

    /// Turn a model once in this number of frames
    ///
    /// It turns about the vertical axis through its middle.
    /// With a movie or numbered pictures as output, all frames are rendered:
    /// `--turntable 120 -o car.mp4`, `-o 'car_####.png'`.
    #[arg(long, value_name = "FRAMES", value_parser = value::stage::turn, hide_short_help = true)]
    pub turntable: Option<u32>,

    /// View from front, back, left, right, top, bottom or iso
    ///
    /// The camera frames all objects; iso is from the front right above. The front of a scene faces
    /// the positive z axis.
    #[arg(long, value_name = "SIDE", value_parser = value::stage::side, conflicts_with = "eye")]
    pub view: Option<Vec3>,

    /// Position of the camera
    #[arg(long, value_name = "X,Y,Z", value_parser = value::stage::position, allow_hyphen_values = true, hide_short_help = true)]
    pub eye: Option<Vec3>,

    /// Point that the camera looks at [default: the middle of all objects]
    #[arg(long, value_name = "X,Y,Z", value_parser = value::stage::position, allow_hyphen_values = true, hide_short_help = true)]
    pub look_at: Option<Vec3>,

    /// Vertical field of view of the camera [default: 30]
    #[arg(long, value_name = "DEGREES", value_parser = value::stage::field_of_view, hide_short_help = true)]
    pub fov: Option<f32>,

    /// Fraction of the picture that all objects fill [default: 0.8]
    #[arg(long, value_name = "FRACTION", value_parser = value::stage::fraction, conflicts_with = "eye", hide_short_help = true)]
    pub fit: Option<f32>,
}

impl StageArgs {
    /// Whether any flag is given.
    pub fn is_given(&self) -> bool {
        *self != Self::default()
    }

    /// Fails if the background is both transparent and a color.
    ///
    /// # Errors
    ///
    /// `transparent` is set, and `--background` gives a color.
    pub fn check_transparent(&self, transparent: bool) -> Result<(), Failure> {
        match self.background {
            Some(Backdrop::Color(color)) if transparent => Err(Failure::Invalid(format!(
                "--transparent shows nothing where nothing is, and --background {} shows a color there: give one of \
                 them",
                hex(color)
            ))),
            _ => Ok(()),
        }
    }

    /// Fails if the floor shows only shadows and the picture is opaque.
    ///
    /// # Errors
    ///
    /// The flag `--floor shadow` would have no effect.
    pub fn check_floor(&self, is_transparent: bool) -> Result<(), Failure> {
        if self.floor == Some(Floor::Shadow) && !is_transparent {
            return Err(Failure::Invalid(
                "--floor shadow shows only shadows, for which the picture must not show the background of the scene: \
                 add --background white, another color, or --transparent"
                    .into(),
            ));
        }
        Ok(())
    }

    /// The flags that are given, with their values.
    pub fn words(&self) -> Vec<(&'static str, String)> {
        let position = |at: Vec3| at.to_array().map(|number| number.to_string()).join(",");
        let environment = self.environment.as_ref().map(|light| match light {
            StageLight::Studio => "studio".to_owned(),
            StageLight::Sky => "sky".to_owned(),
            StageLight::File(file) => file.clone(),
        });
        let background = self.background.map(|backdrop| match backdrop {
            Backdrop::Transparent => "transparent".to_owned(),
            Backdrop::Color(color) => hex(color),
        });
        let floor = FLOORS.iter().find(|(_, floor)| Some(*floor) == self.floor);
        let side = SIDES.iter().find(|(_, side)| Some(*side) == self.view);
        let all = [
            ("--environment", environment),
            ("--background", background),
            ("--floor", floor.map(|(name, _)| (*name).to_owned())),
            ("--turntable", self.turntable.map(|frames| frames.to_string())),
            ("--view", side.map(|(name, _)| (*name).to_owned())),
            ("--eye", self.eye.map(position)),
            ("--look-at", self.look_at.map(position)),
            ("--fov", self.fov.map(|degrees| degrees.to_string())),
            ("--fit", self.fit.map(|part| part.to_string())),
        ];
        all.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
    }

    /// The choices, for pictures of a size; `None` is the size of the scene. With `keeps_camera`, a
    /// turntable keeps the cameras of the scene.
    pub fn stage(&self, size: Option<[u32; 2]>, keeps_camera: bool) -> Stage {
        Stage {
            environment: self.environment.clone(),
            backdrop: self.background,
            floor: self.floor,
            turntable: self.turntable,
            eye: self.eye,
            look_at: self.look_at,
            towards_camera: self.view,
            vertical_fov_degrees: self.fov,
            fill: self.fit,
            size,
            keeps_camera,
        }
    }
}

/// A color of sRGB levels as `#rrggbb`.
fn hex(color: Rgb) -> String {
    let [r, g, b] = color.to_array().map(|channel| (color::srgb_encode(channel) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Error of a stage with the name of the flag in place of the name of the setting.
pub fn failure(error: Error) -> Failure {
    match error {
        Error::Settings { setting, message, .. } => {
            let flag = match setting.as_str() {
                "vertical_fov_degrees" => "fov".to_owned(),
                "fill" => "fit".to_owned(),
                "towards_camera" => "view".to_owned(),
                other => other.replace('_', "-"),
            };
            Failure::Invalid(message.replace(&format!("`{setting}`"), &format!("--{flag}")))
        }
        other => other.into(),
    }
}
