//! Checks of cameras and lights.

use super::checker::{Checker, FINITE, NOT_NEGATIVE, POSITIVE, UNIT};
use crate::gltf::document::{CameraType, LightType, Orthographic, Perspective, PunctualLight};
use crate::gltf::location::Location;
use std::f64::consts::{FRAC_PI_2, PI};

impl Checker<'_> {
    /// Checks the projections of cameras.
    pub(super) fn cameras(&mut self) {
        let list = Location::root("cameras");
        for (position, camera) in self.document.cameras.iter().enumerate() {
            let at = list.index(position);
            match (camera.camera_type, &camera.perspective, &camera.orthographic) {
                (CameraType::Perspective, Some(perspective), _) => {
                    self.perspective(&at.key("perspective"), perspective);
                }
                (CameraType::Orthographic, _, Some(orthographic)) => {
                    self.orthographic(&at.key("orthographic"), orthographic);
                }
                (CameraType::Perspective, None, _) => self.fault(&at, format_args!("has no `perspective`")),
                (CameraType::Orthographic, _, None) => self.fault(&at, format_args!("has no `orthographic`")),
            }
        }
    }

    fn perspective(&mut self, at: &Location<'_>, camera: &Perspective) {
        self.number(&at.key("yfov"), camera.yfov, &POSITIVE);
        if camera.yfov >= PI {
            let yfov = camera.yfov;
            self.fault(&at.key("yfov"), format_args!("{yfov} is not less than pi; the angle is in radians"));
        }
        self.optional(&at.key("aspectRatio"), camera.aspect_ratio, &POSITIVE);
        self.number(&at.key("znear"), camera.znear, &POSITIVE);
        self.optional(&at.key("zfar"), camera.zfar, &POSITIVE);
        self.clipping(at, camera.znear, camera.zfar);
    }

    fn orthographic(&mut self, at: &Location<'_>, camera: &Orthographic) {
        for (key, value) in [("xmag", camera.xmag), ("ymag", camera.ymag)] {
            self.number(&at.key(key), value, &FINITE);
            if value == 0.0 {
                self.fault(&at.key(key), format_args!("0 is no size of an image"));
            }
        }
        self.number(&at.key("znear"), camera.znear, &NOT_NEGATIVE);
        self.number(&at.key("zfar"), camera.zfar, &POSITIVE);
        self.clipping(at, camera.znear, Some(camera.zfar));
    }

    /// Warns if the clipping planes, which have no effect, leave nothing.
    fn clipping(&mut self, at: &Location<'_>, near: f64, far: Option<f64>) {
        if far.is_some_and(|far| far <= near) {
            self.warn(at, "`zfar` is not greater than `znear`; neither has an effect");
        }
    }

    /// Checks the lights of all extensions.
    pub(super) fn lights(&mut self) {
        let extensions = &self.document.extensions;
        let root = Location::root("extensions");
        if let Some(punctual) = &extensions.lights_punctual {
            let at = root.key("KHR_lights_punctual");
            let list = at.key("lights");
            for (position, light) in punctual.lights.iter().enumerate() {
                self.punctual(&list.index(position), light);
            }
        }
        if let Some(image_based) = &extensions.lights_image_based {
            let at = root.key("EXT_lights_image_based");
            let list = at.key("lights");
            for (position, light) in image_based.lights.iter().enumerate() {
                let at = list.index(position);
                self.quaternion(&at.key("rotation"), light.rotation);
                self.number(&at.key("intensity"), light.intensity, &NOT_NEGATIVE);
                let levels = at.key("specularImages");
                if light.specular_images.is_empty() {
                    self.fault(&levels, format_args!("there are no images"));
                }
                for (level, faces) in light.specular_images.iter().enumerate() {
                    let at = levels.index(level);
                    for (face, image) in faces.iter().enumerate() {
                        self.index(&at.index(face), *image, self.document.images.len(), "image");
                    }
                }
            }
        }
        if let Some(profiles) = &extensions.lights_ies {
            let at = root.key("EXT_lights_ies");
            let list = at.key("lights");
            for (position, profile) in profiles.lights.iter().enumerate() {
                self.data(&list.index(position), profile.uri.as_deref(), profile.buffer_view);
            }
        }
    }

    fn punctual(&mut self, at: &Location<'_>, light: &PunctualLight) {
        if light.light_type == LightType::Unknown {
            self.warn(
                &at.key("type"),
                "the kind of the light is not known, expected `directional`, `point` or `spot`; it is left out",
            );
        }
        self.numbers(&at.key("color"), &light.color, &UNIT);
        self.number(&at.key("intensity"), light.intensity, &NOT_NEGATIVE);
        self.optional(&at.key("range"), light.range, &POSITIVE);
        if light.light_type != LightType::Spot {
            return;
        }
        let at = at.key("spot");
        let cone = light.spot.unwrap_or_default();
        // A right angle in single precision exceeds that in double precision.
        self.number(&at.key("outerConeAngle"), cone.outer_cone_angle, &(f64::MIN_POSITIVE..=FRAC_PI_2 + 1e-6));
        self.number(&at.key("innerConeAngle"), cone.inner_cone_angle, &(0.0..=FRAC_PI_2));
        if cone.inner_cone_angle > cone.outer_cone_angle {
            let (inner, outer) = (cone.inner_cone_angle, cone.outer_cone_angle);
            self.fault(&at.key("innerConeAngle"), format_args!("{inner} is greater than `outerConeAngle`, {outer}"));
        }
    }
}
