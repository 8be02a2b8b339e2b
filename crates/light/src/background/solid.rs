//! Background of uniform radiance.
//!
//! ```json
//! {"solid": {"color": [0, 0, 0]}}
//! ```

use super::{Background, InvalidBackground, check_color};
use juggler_math::{Ray, Rgb};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Background of uniform radiance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Solid {
    /// Radiance in every direction, linear RGB.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub color: Rgb,
}

impl Solid {
    /// Creates a background of uniform radiance.
    pub fn new(color: impl Into<Rgb>) -> Self {
        Self { color: color.into() }
    }
}

impl Background for Solid {
    fn check(&self) -> Result<(), InvalidBackground> {
        check_color("color", self.color)
    }

    fn radiance(&self, _ray: &Ray) -> Rgb {
        self.color
    }

    fn mean_radiance(&self) -> Rgb {
        self.color
    }
}

#[cfg(any(test, feature = "testing"))]
impl Solid {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { color: Rgb::new(0.1, 0.2, 3.0) }]
    }
}
