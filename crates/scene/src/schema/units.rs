//! Units of the scene format: the values of the schema's keyword `x-unit`.
//!
//! A number (or array of numbers, or color) with a unit states it as data beside its range, so that
//! programs can read it:
//!
//! ```text
//! /// Radius in scene units, above 0.
//! #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
//! pub radius: f32,
//! ```
//!
//! A field without the keyword is a pure number (a ratio, a count, an exponent, a direction), or
//! its unit depends on other fields, as for the points of a path and the coefficients of an
//! attenuation. The list is closed: a new unit is a new row, and tests compare the fields with it.

use serde_json::Value;

/// Keyword of the schema that states the unit of a field. Validation ignores it.
pub const KEYWORD: &str = "x-unit";

/// A unit of the scene format.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Value of the keyword `x-unit`.
    pub name: &'static str,
    /// What the unit measures, for the reference.
    pub meaning: &'static str,
    /// Phrases by which the descriptions of fields state the unit.
    pub phrases: &'static [&'static str],
}

/// All units.
pub const UNITS: [Unit; 21] = [
    Unit {
        name: "scene units",
        meaning: "Length, in the coordinate space that the field belongs to.",
        phrases: &["scene units", "units of object space"],
    },
    Unit {
        name: "1/scene unit",
        meaning: "Coefficient of a medium, per length of path.",
        phrases: &["per scene unit"],
    },
    Unit {
        name: "units of space",
        meaning: "Length in the coordinate space of a texture, which its `space` selects.",
        phrases: &["in units of `space`", ", in `space`"],
    },
    Unit {
        name: "pattern units",
        meaning: "Length in the pattern of a texture, after its `scale`.",
        phrases: &["in units of the pattern"],
    },
    Unit { name: "degrees", meaning: "Angle.", phrases: &["in degrees"] },
    Unit { name: "turns", meaning: "Angle, as a multiple of 360 degrees.", phrases: &["in full turns"] },
    Unit {
        name: "seconds",
        meaning: "Time. An expression of `frame` in its place gives frames.",
        phrases: &["in seconds"],
    },
    Unit { name: "frames", meaning: "Time, or the length of a movie.", phrases: &["in frames", "Number of frames"] },
    Unit { name: "frames/second", meaning: "Frame rate.", phrases: &["Frame rate"] },
    Unit { name: "mm", meaning: "Length on the sensor of a camera, in millimeters.", phrases: &["in millimeters"] },
    Unit { name: "m", meaning: "Length of a scene unit, in meters.", phrases: &["in meters"] },
    Unit { name: "pixels", meaning: "Length in the picture.", phrases: &["in pixels"] },
    Unit {
        name: "samples",
        meaning: "Number of samples per pixel or per shading point.",
        phrases: &["Samples per pixel", "Number of light samples", "Number of shadow rays"],
    },
    Unit { name: "stops", meaning: "Exposure: one more stop is twice as bright.", phrases: &["photographic stops"] },
    Unit { name: "K", meaning: "Color temperature in kelvin.", phrases: &["in kelvin"] },
    Unit {
        name: "0.001 Duv",
        meaning: "Distance from the Planckian or daylight locus (ANSI C78.377).",
        phrases: &["in thousandths of Duv"],
    },
    Unit { name: "nm", meaning: "Length in nanometers.", phrases: &["in nanometers"] },
    Unit { name: "W", meaning: "Radiant flux per channel, in watts.", phrases: &["in watts per channel"] },
    Unit {
        name: "W/sr",
        meaning: "Radiant intensity per channel, in watts per steradian.",
        phrases: &["in watts per steradian"],
    },
    Unit { name: "W/scene unit²", meaning: "Irradiance per channel, in watts per square scene unit.", phrases: &[] },
    Unit {
        name: "W/(scene unit² sr)",
        meaning: "Radiance per channel, in watts per square scene unit and steradian.",
        phrases: &["watts per square scene unit and steradian"],
    },
];

impl Unit {
    /// Unit that a schema states; `None` if it states none, or none of [`UNITS`].
    pub fn of(schema: &Value) -> Option<&'static Self> {
        let name = schema.get(KEYWORD)?.as_str()?;
        UNITS.iter().find(|unit| unit.name == name)
    }

    /// Whether a description, without line breaks, states the unit in words.
    pub fn is_stated_in(&self, description: &str) -> bool {
        self.phrases.iter().any(|phrase| description.contains(phrase))
    }
}
