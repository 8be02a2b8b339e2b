//! Zones of directions at an interface of two media, each with a measure A from 0 to 1 in which its
//! cosine-weighted directions are uniform: see [`interface`](super::interface).

/// A medium on one side of an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The medium of the smaller index of refraction.
    Thin,
    /// The medium of the larger index of refraction, where total internal reflection may occur.
    Dense,
}

impl Side {
    /// Side with the relative index of refraction `ior`, behind the interface over in front of it.
    #[inline]
    pub fn from_ior(ior: f32) -> Self {
        if ior < 1.0 { Self::Dense } else { Self::Thin }
    }

    /// The zones of directions on this side.
    #[inline]
    pub(super) fn zones(self) -> &'static [Zone] {
        match self {
            Self::Thin => &[Zone::Thin],
            Self::Dense => &[Zone::Total, Zone::Partial],
        }
    }
}

/// Directions that share entries of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Zone {
    /// All directions in the thinner medium.
    Thin,
    /// Directions in the denser medium that a smooth interface reflects totally.
    Total,
    /// Other directions in the denser medium.
    Partial,
}

impl Zone {
    #[cfg(test)]
    pub(super) const ALL: [Self; 3] = [Self::Thin, Self::Total, Self::Partial];

    /// A at position `x`, 0 to 1, along the entries.
    #[inline]
    pub(super) fn area(self, x: f32) -> f32 {
        match self {
            Self::Thin | Self::Partial => x * x * x * x,
            Self::Total if x > 0.999_9 => 1.0,
            Self::Total => {
                let ratio = (x / (1.0 - x)) * (x / (1.0 - x));
                ratio * ratio / (1.0 + ratio * ratio)
            }
        }
    }

    /// Position of A along the entries, 0 to 1; entries are denser towards grazing and critical
    /// angles.
    #[inline]
    pub(super) fn coordinate(self, area: f32) -> f32 {
        let area = area.clamp(0.0, 1.0);
        match self {
            Self::Thin | Self::Partial => area.sqrt().sqrt(),
            Self::Total => {
                let (near, far) = (area.sqrt().sqrt(), (1.0 - area).sqrt().sqrt());
                near / (near + far)
            }
        }
    }

    /// cos² θ at A; `critical` is the squared cosine of the critical angle.
    #[inline]
    pub(super) fn squared_cos(self, area: f32, critical: f32) -> f32 {
        match self {
            Self::Thin => area,
            Self::Total => critical * area,
            Self::Partial => critical + (1.0 - critical) * area,
        }
    }

    /// Fraction of the cosine-weighted hemisphere in the zone.
    #[inline]
    pub(super) fn fraction(self, critical: f32) -> f32 {
        match self {
            Self::Thin => 1.0,
            Self::Total => critical,
            Self::Partial => 1.0 - critical,
        }
    }
}
