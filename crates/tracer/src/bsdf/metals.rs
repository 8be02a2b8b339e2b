//! Metals as measured: complex indices of refraction at 650, 550 and 450 nm for red, green and blue, by linear
//! interpolation in the tables of refractiveindex.info (public domain).
//!
//! Three wavelengths stand for three bands, so colours are near those of a spectral renderer, not equal to them.

use super::Fresnel;
use juggler_math::Rgb;

/// A metal's index of refraction: real part η and extinction k, per channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// What it is called, in lower case.
    pub name: &'static str,
    /// Real part of the index of refraction.
    pub eta: Rgb,
    /// Imaginary part: extinction.
    pub k: Rgb,
}

impl Metal {
    /// The one of that name in [`METALS`].
    pub fn named(name: &str) -> Option<Self> {
        METALS.iter().find(|metal| metal.name == name).copied()
    }

    /// How it mirrors in air.
    pub const fn fresnel(self) -> Fresnel {
        Fresnel::Complex { eta: self.eta, k: self.k }
    }
}

const fn metal(name: &'static str, eta: [f32; 3], k: [f32; 3]) -> Metal {
    Metal { name, eta: Rgb::new(eta[0], eta[1], eta[2]), k: Rgb::new(k[0], k[1], k[2]) }
}

/// All metals, by name.
pub const METALS: [Metal; 13] = [
    // Rakić 1995.
    metal("aluminium", [1.558, 1.015, 0.633], [7.712, 6.627, 5.454]),
    // Querry 1985, CuZn.
    metal("brass", [0.444, 0.527, 1.094], [3.695, 2.765, 1.829]),
    // Johnson and Christy 1974.
    metal("chromium", [3.107, 3.181, 2.323], [3.331, 3.329, 3.135]),
    // Johnson and Christy 1974.
    metal("cobalt", [2.237, 2.052, 1.736], [4.236, 3.824, 3.274]),
    // Johnson and Christy 1972.
    metal("copper", [0.238, 1.007, 1.240], [3.626, 2.582, 2.393]),
    // Johnson and Christy 1972.
    metal("gold", [0.156, 0.424, 1.383], [3.602, 2.472, 1.915]),
    // Johnson and Christy 1974.
    metal("iron", [2.911, 2.950, 2.584], [3.089, 2.932, 2.767]),
    // Johnson and Christy 1974.
    metal("nickel", [1.990, 1.921, 1.729], [4.209, 3.616, 2.944]),
    // Rakić, Djurišić, Elazar and Majewski 1998, Brendel-Bormann model.
    metal("platinum", [2.376, 2.085, 1.845], [4.265, 3.715, 3.136]),
    // Johnson and Christy 1972.
    metal("silver", [0.052, 0.060, 0.040], [4.409, 3.597, 2.648]),
    // Johnson and Christy 1974.
    metal("titanium", [2.741, 2.542, 2.267], [3.814, 3.435, 3.038]),
    // Rakić, Djurišić, Elazar and Majewski 1998, Brendel-Bormann model.
    metal("tungsten", [3.652, 3.506, 3.313], [2.795, 2.758, 2.605]),
    // Werner, Glantschnig and Ambrosch-Draxl 2009.
    metal("zinc", [1.234, 0.929, 0.678], [5.873, 4.975, 4.012]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close;

    #[test]
    fn metals_mirror_what_handbooks_say() {
        // Reflectance head on: CRC Handbook of Chemistry and Physics, "Optical properties of selected elements",
        // in the middle of the visible range; gold and copper by channel.
        for (name, share, tolerance) in [
            ("aluminium", 0.915, 0.01),
            ("silver", 0.98, 0.02),
            ("chromium", 0.555, 0.02),
            ("iron", 0.51, 0.06),
            ("nickel", 0.64, 0.03),
            ("platinum", 0.64, 0.04),
            ("titanium", 0.58, 0.06),
            ("tungsten", 0.50, 0.02),
            ("cobalt", 0.66, 0.02),
            ("zinc", 0.87, 0.06),
        ] {
            let shown = Metal::named(name).unwrap().fresnel().at(1.0).g;
            assert!(close(shown, share, tolerance), "{name}: {shown}");
        }
        let gold = Metal::named("gold").unwrap().fresnel().at(1.0);
        assert!(close(gold.r, 0.957, 2e-3) && close(gold.g, 0.792, 2e-3) && close(gold.b, 0.408, 2e-3), "{gold:?}");
        let copper = Metal::named("copper").unwrap().fresnel().at(1.0);
        assert!(close(copper.r, 0.935, 2e-3) && close(copper.g, 0.624, 2e-3) && close(copper.b, 0.538, 2e-3));
        assert!(Metal::named("unobtainium").is_none());
    }
}
