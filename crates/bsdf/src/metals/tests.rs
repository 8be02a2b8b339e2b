//! Comparison of the named metals with the spectral integrals that `tests/metals/derive.py` prints.

use super::{METALS, Metal};
use juggler_math::testing::close;
use juggler_math::{Rgb, portable};

/// Angles of incidence of [`SPECTRAL`].
const DEGREES: [f32; 6] = [0.0, 40.0, 60.0, 70.0, 75.0, 80.0];

/// Reflectance of each metal at [`DEGREES`]: its tabulated spectrum, integrated to linear sRGB and
/// clamped to 0 to 1.
#[expect(clippy::approx_constant, reason = "a reflectance that happens to be near 2/π")]
const SPECTRAL: [(&str, [[f32; 3]; 6]); 13] = [
    (
        "aluminum",
        [
            [0.9073, 0.9159, 0.9223],
            [0.9047, 0.9135, 0.9202],
            [0.8903, 0.9010, 0.9098],
            [0.8694, 0.8840, 0.8973],
            [0.8525, 0.8716, 0.8903],
            [0.8338, 0.8616, 0.8894],
        ],
    ),
    (
        "brass",
        [
            [0.9097, 0.7782, 0.4228],
            [0.9069, 0.7764, 0.4285],
            [0.8948, 0.7749, 0.4633],
            [0.8853, 0.7868, 0.5216],
            [0.8849, 0.8058, 0.5769],
            [0.8964, 0.8427, 0.6630],
        ],
    ),
    (
        "chromium",
        [
            [0.5496, 0.5560, 0.5542],
            [0.5458, 0.5522, 0.5512],
            [0.5286, 0.5350, 0.5402],
            [0.5148, 0.5215, 0.5381],
            [0.5147, 0.5220, 0.5496],
            [0.5388, 0.5470, 0.5901],
        ],
    ),
    (
        "cobalt",
        [
            [0.6830, 0.6552, 0.6160],
            [0.6784, 0.6510, 0.6128],
            [0.6574, 0.6332, 0.6017],
            [0.6372, 0.6198, 0.6007],
            [0.6312, 0.6208, 0.6132],
            [0.6454, 0.6459, 0.6539],
        ],
    ),
    (
        "copper",
        [
            [0.9317, 0.6226, 0.5223],
            [0.9296, 0.6214, 0.5228],
            [0.9225, 0.6230, 0.5328],
            [0.9206, 0.6419, 0.5623],
            [0.9248, 0.6697, 0.5987],
            [0.9380, 0.7249, 0.6664],
        ],
    ),
    (
        "gold",
        [
            [1.0000, 0.7283, 0.3646],
            [1.0000, 0.7287, 0.3696],
            [1.0000, 0.7380, 0.4009],
            [1.0000, 0.7628, 0.4560],
            [0.9965, 0.7902, 0.5108],
            [0.9913, 0.8354, 0.6012],
        ],
    ),
    (
        "iron",
        [
            [0.5297, 0.5132, 0.4942],
            [0.5264, 0.5102, 0.4921],
            [0.5129, 0.4984, 0.4853],
            [0.5055, 0.4936, 0.4889],
            [0.5117, 0.5020, 0.5050],
            [0.5451, 0.5387, 0.5519],
        ],
    ),
    (
        "nickel",
        [
            [0.6971, 0.6405, 0.5633],
            [0.6926, 0.6366, 0.5610],
            [0.6721, 0.6211, 0.5557],
            [0.6532, 0.6121, 0.5636],
            [0.6484, 0.6175, 0.5838],
            [0.6645, 0.6487, 0.6347],
        ],
    ),
    (
        "platinum",
        [
            [0.6789, 0.6395, 0.5836],
            [0.6743, 0.6355, 0.5808],
            [0.6527, 0.6186, 0.5717],
            [0.6318, 0.6069, 0.5736],
            [0.6249, 0.6096, 0.5888],
            [0.6382, 0.6373, 0.6334],
        ],
    ),
    (
        "silver",
        [
            [0.9894, 0.9840, 0.9778],
            [0.9891, 0.9836, 0.9775],
            [0.9876, 0.9820, 0.9770],
            [0.9862, 0.9813, 0.9784],
            [0.9857, 0.9818, 0.9807],
            [0.9865, 0.9843, 0.9849],
        ],
    ),
    (
        "titanium",
        [
            [0.6186, 0.5794, 0.5425],
            [0.6142, 0.5757, 0.5398],
            [0.5941, 0.5603, 0.5305],
            [0.5760, 0.5509, 0.5311],
            [0.5723, 0.5555, 0.5450],
            [0.5910, 0.5866, 0.5888],
        ],
    ),
    (
        "tungsten",
        [
            [0.5061, 0.4967, 0.4766],
            [0.5027, 0.4935, 0.4740],
            [0.4873, 0.4800, 0.4636],
            [0.4757, 0.4713, 0.4600],
            [0.4773, 0.4758, 0.4691],
            [0.5035, 0.5064, 0.5065],
        ],
    ),
    (
        "zinc",
        [
            [0.8752, 0.8689, 0.8551],
            [0.8720, 0.8658, 0.8522],
            [0.8557, 0.8509, 0.8400],
            [0.8352, 0.8348, 0.8312],
            [0.8220, 0.8273, 0.8319],
            [0.8154, 0.8308, 0.8474],
        ],
    ),
];

/// Reflectance at normal incidence by independent measurements: Olmon et al. 2012 (a single crystal
/// of gold) and Hagemann, Gudat and Kunz 1975. Tables of other samples (Babar and Weaver 2015,
/// McPeak et al. 2015) differ from Johnson and Christy by up to 0.06 for gold and 0.07 for copper.
const SECOND_TABLES: [(&str, [f32; 3]); 2] = [("gold", [1.0, 0.7586, 0.3277]), ("copper", [0.9531, 0.6392, 0.5365])];

fn reflectance(name: &str, degrees: f32) -> Rgb {
    Metal::named(name).unwrap().fresnel().reflectance(portable::cos(degrees.to_radians()))
}

/// Largest difference of any channel.
fn deviation(shown: Rgb, expected: [f32; 3]) -> f32 {
    shown.to_array().iter().zip(expected).map(|(shown, expected)| (shown - expected).abs()).fold(0.0, f32::max)
}

#[test]
fn reflectance_follows_the_spectral_integral_up_to_80_degrees() {
    for (name, curve) in SPECTRAL {
        for (degrees, expected) in DEGREES.into_iter().zip(curve) {
            let shown = reflectance(name, degrees);
            assert!(deviation(shown, expected) < 0.005, "{name} at {degrees} degrees: {shown:?}, not {expected:?}");
        }
    }
    assert!(SPECTRAL.iter().zip(METALS).all(|(spectral, metal)| spectral.0 == metal.name));
}

/// Only gold's red is clamped; every other channel equals its integral to the four digits of η and
/// k.
#[test]
fn reflectance_at_normal_incidence_is_the_spectral_integral() {
    for (name, [normal, ..]) in SPECTRAL {
        for (channel, (shown, expected)) in reflectance(name, 0.0).to_array().into_iter().zip(normal).enumerate() {
            let tolerance = if expected == 1.0 { 0.005 } else { 2e-4 };
            assert!(close(shown, expected, tolerance), "{name}, channel {channel}: {shown}, not {expected}");
            assert!(shown < 1.0, "{name} reflects all light of channel {channel}");
        }
    }
    let clamped = SPECTRAL.iter().filter(|(_, [normal, ..])| normal.contains(&1.0));
    assert!(clamped.map(|(name, _)| *name).eq(["gold"]));
}

#[test]
fn gold_and_copper_agree_with_a_second_table() {
    for (name, expected) in SECOND_TABLES {
        let shown = reflectance(name, 0.0);
        assert!(deviation(shown, expected) < 0.04, "{name}: {shown:?}, not {expected:?}");
    }
}

/// Reflectance at normal incidence in the middle of the visible range: CRC Handbook of Chemistry
/// and Physics, "Optical properties of selected elements".
#[test]
fn metals_reflect_what_handbooks_say() {
    for (name, expected, tolerance) in [
        ("aluminum", 0.915, 0.01),
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
        let shown = reflectance(name, 0.0).g;
        assert!(close(shown, expected, tolerance), "{name}: {shown}");
    }
    assert!(Metal::named("unobtainium").is_none());
}
