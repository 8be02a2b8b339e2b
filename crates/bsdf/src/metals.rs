//! Named metals: an index of refraction per channel, derived from measured tables of n and k.
//!
//! The reflectance at normal incidence is the spectral reflectance of the named table, integrated
//! with the CIE 1931 2-degree color matching functions under D65 to linear sRGB and clamped to
//! 0..1. η and k of each channel meet that reflectance and follow the integrated curve up to 80
//! degrees within 0.005 (Fresnel's equations for conductors; Born and Wolf, section 14.2). Gold's
//! red is clamped: its integral is 1.038, and its η and k reflect 0.996. `tests/metals/derive.py`
//! derives all numbers from the tables as the refractiveindex.info database publishes them.
//!
//! P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972) and 9, 5056 (1974); A. D. Rakić,
//! Appl. Opt. 34, 4755 (1995); A. D. Rakić, A. B. Djurišić, J. M. Elazar and M. L. Majewski, Appl.
//! Opt. 37, 5271 (1998); M. R. Querry, Optical constants, CRDC-CR-85034 (1985); W. S. M. Werner, K.
//! Glantschnig and C. Ambrosch-Draxl, J. Phys. Chem. Ref. Data 38, 1013 (2009).

use super::Fresnel;
use juggler_math::Rgb;

#[cfg(test)]
mod tests;

/// A metal's complex index of refraction η + ik, per channel of linear sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// Name in scene files, lower case.
    pub name: &'static str,
    /// Real part of the index of refraction.
    pub eta: Rgb,
    /// Imaginary part of the index of refraction: the extinction coefficient.
    pub k: Rgb,
}

impl Metal {
    /// Finds the metal of that name in [`METALS`].
    pub fn named(name: &str) -> Option<Self> {
        METALS.iter().find(|metal| metal.name == name).copied()
    }

    /// Fresnel reflectance of the metal in air.
    pub const fn fresnel(self) -> Fresnel {
        Fresnel::Complex { eta: self.eta, k: self.k }
    }
}

const fn metal(name: &'static str, eta: [f32; 3], k: [f32; 3]) -> Metal {
    Metal { name, eta: Rgb::new(eta[0], eta[1], eta[2]), k: Rgb::new(k[0], k[1], k[2]) }
}

/// All metals by name, each with the source of its table and the clamped reflectance at normal
/// incidence.
pub const METALS: [Metal; 13] = [
    // Rakić 1995: 0.9073, 0.9159, 0.9223.
    metal("aluminum", [1.513, 0.9867, 0.6076], [7.681, 6.554, 5.358]),
    // Querry 1985, 70 % copper and 30 % zinc: 0.9097, 0.7782, 0.4228.
    metal("brass", [0.4954, 0.5242, 1.128], [4.439, 2.671, 1.813]),
    // Johnson and Christy 1974: 0.5496, 0.5560, 0.5542.
    metal("chromium", [3.244, 3.118, 2.287], [3.286, 3.337, 3.117]),
    // Johnson and Christy 1974: 0.6830, 0.6552, 0.6160.
    metal("cobalt", [2.263, 2.037, 1.715], [4.232, 3.796, 3.24]),
    // Johnson and Christy 1972: 0.9317, 0.6226, 0.5223.
    metal("copper", [0.2394, 1.045, 1.298], [3.534, 2.626, 2.364]),
    // Johnson and Christy 1972: 1.0000, 0.7283, 0.3646.
    metal("gold", [0.01404, 0.4966, 1.478], [3.613, 2.252, 1.779]),
    // Johnson and Christy 1974: 0.5297, 0.5132, 0.4942.
    metal("iron", [2.922, 2.921, 2.547], [3.077, 2.937, 2.75]),
    // Johnson and Christy 1974: 0.6971, 0.6405, 0.5633.
    metal("nickel", [2.045, 1.905, 1.731], [4.211, 3.572, 2.898]),
    // Rakić et al. 1998, Brendel-Bormann model: 0.6789, 0.6395, 0.5836.
    metal("platinum", [2.37, 2.07, 1.829], [4.262, 3.68, 3.093]),
    // Johnson and Christy 1972: 0.9894, 0.9840, 0.9778.
    metal("silver", [0.05729, 0.05517, 0.04329], [4.519, 3.555, 2.592]),
    // Johnson and Christy 1974: 0.6186, 0.5794, 0.5425.
    metal("titanium", [2.758, 2.508, 2.242], [3.848, 3.397, 3.016]),
    // Rakić et al. 1998, Brendel-Bormann model: 0.5061, 0.4967, 0.4766.
    metal("tungsten", [3.67, 3.492, 3.298], [2.813, 2.752, 2.595]),
    // Werner et al. 2009: 0.8752, 0.8689, 0.8551.
    metal("zinc", [1.226, 0.9145, 0.6624], [5.859, 4.923, 3.939]),
];
