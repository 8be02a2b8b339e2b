//! Backgrounds: what a ray sees that leaves the world.

use juggler_math::{Ray, Rgb};

mod solid;

/// What a ray sees that leaves the world.
pub trait Background: Send + Sync {
    /// Light from that way.
    fn radiance(&self, ray: &Ray) -> Rgb;
}

closed_set! {
    /// Every background. In JSON: `{"solid": {"color": [0, 0, 0]}}`.
    pub enum AnyBackground: Background { solid::Solid }
}
