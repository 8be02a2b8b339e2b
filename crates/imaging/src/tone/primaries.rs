//! RGB primaries as chromaticities (CIE 1931 x, y) of red, green, blue and white, and the matrices
//! derived from them (SMPTE RP 177:1993). Different white points are adapted by the Bradford
//! transform (Lam 1985; ICC.1:2022, annex E). In JSON: `"display_p3"`.

use super::Matrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Color primaries of an image file. Rendering uses sRGB primaries; colors outside the sRGB gamut
/// are kept as negative values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Primaries {
    /// sRGB and ITU-R BT.709, assumed if a file states nothing.
    #[default]
    Srgb,
    /// Display P3, the gamut of current phones, tablets and better monitors. PNG and EXR only.
    DisplayP3,
    /// ITU-R BT.2020, for ultra-high definition and HDR video. PNG and EXR only.
    Rec2020,
    /// ACEScg (AP1, S-2014-004), for compositing. EXR only.
    Acescg,
}

impl Primaries {
    /// All primaries.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DisplayP3, Self::Rec2020, Self::Acescg];

    /// Name in scene files and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DisplayP3 => "display_p3",
            Self::Rec2020 => "rec2020",
            Self::Acescg => "acescg",
        }
    }

    /// Whether these are sRGB's primaries, which files need not state.
    pub fn is_srgb(&self) -> bool {
        *self == Self::Srgb
    }

    /// Chromaticities of primaries and white point.
    pub fn chromaticities(self) -> Chromaticities {
        const D65: [f64; 2] = [0.3127, 0.3290];
        let (red, green, blue, white) = match self {
            Self::Srgb => ([0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65),
            Self::DisplayP3 => ([0.680, 0.320], [0.265, 0.690], [0.150, 0.060], D65),
            Self::Rec2020 => ([0.708, 0.292], [0.170, 0.797], [0.131, 0.046], D65),
            Self::Acescg => ([0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.32168, 0.33767]),
        };
        Chromaticities { red, green, blue, white }
    }

    /// Code point in a PNG's cICP chunk (ITU-T H.273, table 2), if there is one.
    pub(crate) fn code_point(self) -> Option<u8> {
        match self {
            Self::Srgb => Some(1),
            Self::Rec2020 => Some(9),
            Self::DisplayP3 => Some(12),
            Self::Acescg => None,
        }
    }

    /// Matrix from linear sRGB to these primaries; `None` for sRGB itself.
    pub(crate) fn matrix_from_srgb(self) -> Option<Matrix> {
        (!self.is_srgb()).then(|| Self::Srgb.chromaticities().to(&self.chromaticities()))
    }
}

/// Chromaticities (CIE 1931 x, y) of primaries and white point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    /// Red.
    pub red: [f64; 2],
    /// Green.
    pub green: [f64; 2],
    /// Blue.
    pub blue: [f64; 2],
    /// White point: the color of equal RGB values.
    pub white: [f64; 2],
}

impl Chromaticities {
    /// Chromaticities of a code point in a PNG's cICP chunk (ITU-T H.273, table 2); `None` if it is
    /// reserved or names no RGB primaries of displays.
    pub(crate) fn from_code_point(code_point: u8) -> Option<Self> {
        let named = Primaries::ALL.into_iter().find(|primaries| primaries.code_point() == Some(code_point));
        let srgb = Primaries::Srgb.chromaticities();
        match code_point {
            // ITU-R BT.601 with 625 and 525 lines, SMPTE 240M.
            5 => Some(Self { green: [0.29, 0.60], ..srgb }),
            6 | 7 => Some(Self { red: [0.630, 0.340], green: [0.310, 0.595], blue: [0.155, 0.070], ..srgb }),
            // SMPTE RP 431-2: the primaries of Display P3 with the white of cinemas.
            11 => Some(Self { white: [0.314, 0.351], ..Primaries::DisplayP3.chromaticities() }),
            // EBU Tech. 3213-E.
            22 => Some(Self { red: [0.630, 0.340], green: [0.295, 0.605], blue: [0.155, 0.077], ..srgb }),
            _ => named.map(Primaries::chromaticities),
        }
    }

    /// Matrix from linear RGB to CIE XYZ with white at luminance 1. Its middle row holds the
    /// luminances of the primaries.
    pub(crate) fn to_xyz(self) -> Matrix {
        let primaries = Matrix([self.red, self.green, self.blue].map(xyz)).transposed();
        let amounts = primaries.inverse().apply(xyz(self.white));
        primaries.times(&Matrix::diagonal(amounts))
    }

    /// Matrix from these primaries to others, with adaptation of the white point.
    pub(crate) fn to(self, other: &Self) -> Matrix {
        let straight = |middle: Matrix| other.to_xyz().inverse().times(&middle).times(&self.to_xyz());
        if self.white == other.white {
            return straight(Matrix::diagonal([1.0; 3]));
        }
        straight(adaptation(self.white, other.white))
    }

    /// Matrix from a file's primaries to sRGB; `None` if they equal sRGB's up to rounding or are
    /// invalid.
    pub(crate) fn to_srgb(self) -> Option<Matrix> {
        /// Tolerance for files that round chromaticities; no other common primaries are this close
        /// to sRGB.
        const NEAR: f64 = 2e-3;
        let all = |c: Self| [c.red, c.green, c.blue, c.white];
        let srgb = Primaries::Srgb.chromaticities();
        let same = all(self).iter().flatten().zip(all(srgb).iter().flatten()).all(|(a, b)| (a - b).abs() < NEAR);
        let matrix = self.to(&srgb);
        (!same && matrix.is_finite()).then_some(matrix)
    }
}

/// CIE XYZ of a chromaticity at luminance 1.
pub(super) fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// Bradford adaptation from one white point to another, in CIE XYZ.
pub(super) fn adaptation(from: [f64; 2], to: [f64; 2]) -> Matrix {
    const CONES: Matrix = Matrix([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]);
    let [from, to] = [from, to].map(|white| CONES.apply(xyz(white)));
    let factors = [to[0] / from[0], to[1] / from[1], to[2] / from[2]];
    CONES.inverse().times(&Matrix::diagonal(factors)).times(&CONES)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(matrix: &Matrix, expected: [[f64; 3]; 3], error: f64) {
        for (a, b) in matrix.0.iter().flatten().zip(expected.iter().flatten()) {
            assert!((a - b).abs() < error, "{matrix:?} is not {expected:?}");
        }
    }

    #[test]
    fn primaries_match_published_matrices() {
        // IEC 61966-2-1.
        let srgb = Primaries::Srgb.chromaticities().to_xyz();
        close(&srgb, [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]], 6e-5);
        // ITU-R BT.2087-0, section 2.
        let rec2020 = Primaries::Rec2020.matrix_from_srgb().unwrap();
        close(&rec2020, [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]], 6e-5);
        // CSS Color Module Level 4, section 18: linear sRGB to linear Display P3, through XYZ.
        let p3 = Primaries::DisplayP3.matrix_from_srgb().unwrap();
        close(&p3, [[0.8225, 0.1775, 0.0], [0.0332, 0.9668, 0.0], [0.0171, 0.0724, 0.9105]], 6e-5);
        // The Academy's AP1 to XYZ (S-2014-004, table 2).
        let acescg = Primaries::Acescg.chromaticities().to_xyz();
        let ap1 = [
            [0.6624541811, 0.1340042065, 0.1561876870],
            [0.2722287168, 0.6740817658, 0.0536895174],
            [-0.0055746495, 0.0040607335, 1.0103391003],
        ];
        close(&acescg, ap1, 1e-9);
    }

    #[test]
    fn conversions_of_primaries_preserve_white_and_are_invertible() {
        for primaries in Primaries::ALL {
            let there = Primaries::Srgb.chromaticities().to(&primaries.chromaticities());
            assert!(there.apply([1.0; 3]).iter().all(|v| (v - 1.0).abs() < 1e-12), "{primaries:?}");
            let back = primaries.chromaticities().to(&Primaries::Srgb.chromaticities());
            close(&back.times(&there), Matrix::diagonal([1.0; 3]).0, 1e-12);
            assert_eq!(primaries.chromaticities().to_srgb().is_none(), primaries.is_srgb());
            assert_eq!(serde_json::to_value(primaries).unwrap(), primaries.name());
        }
    }

    #[test]
    fn invalid_chromaticities_are_ignored() {
        let nothing = Chromaticities { red: [0.0; 2], green: [0.0; 2], blue: [0.0; 2], white: [0.0; 2] };
        let line = Chromaticities { red: [0.1, 0.1], green: [0.2, 0.2], blue: [0.3, 0.3], white: [0.3, 0.3] };
        assert!(nothing.to_srgb().is_none() && line.to_srgb().is_none_or(|matrix| matrix.is_finite()));
    }

    #[test]
    fn bradford_adaptation_from_a_to_d65_matches_the_published_matrix() {
        // Lindbloom, Chromatic Adaptation, table for Bradford: A (1.09850, 1, 0.35585) to D65
        // (0.95047, 1, 1.08883).
        let of = |xyz: [f64; 3]| [xyz[0], xyz[1]].map(|v| v / xyz.iter().sum::<f64>());
        let found = adaptation(of([1.09850, 1.0, 0.35585]), of([0.95047, 1.0, 1.08883]));
        let expected = [
            [0.8446965, -0.1179225, 0.3948108],
            [-0.1366303, 1.1041226, 0.1291718],
            [0.0798489, -0.1348999, 3.1924009],
        ];
        close(&found, expected, 2e-6);
    }
}
