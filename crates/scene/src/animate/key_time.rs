//! Times of keys, in seconds or in frames.

/// Time in seconds from frame 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Seconds(pub f64);

/// Frame number; fractions lie between frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Frames(pub f64);

/// Unit of the times of keys: [`Seconds`] or [`Frames`].
pub trait KeyTime {
    /// Expression of the scene's time in this unit; `None` for the unit of
    /// [`Animate::keys`](super::Animate::keys), seconds.
    const NOW: Option<&'static str>;

    /// Number of units.
    fn number(self) -> f64;
}

impl KeyTime for Seconds {
    const NOW: Option<&'static str> = None;

    fn number(self) -> f64 {
        self.0
    }
}

impl KeyTime for Frames {
    const NOW: Option<&'static str> = Some("frame");

    fn number(self) -> f64 {
        self.0
    }
}
