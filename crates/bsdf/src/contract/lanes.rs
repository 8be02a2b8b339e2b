//! Numbers that are computed for several directions side by side have the bits of single ones.

use crate::energy::{
    dielectric_reflection_albedo, dielectric_reflection_albedos, grazing_albedos, isotropic_mirror_loss,
    isotropic_mirror_losses, sheen_albedos,
};
use crate::fresnel::{dielectric_reflectance, dielectric_reflectances};
use crate::metals::Metal;
use crate::quadrature::{self, Azimuth, NODES};
use crate::{Conductor, Fresnel, Lambert, Lobe, Sheen, ThinFilm, TiltedConductor};
use juggler_math::testing::Random;
use juggler_math::{Rgb, Vec2, Vec3};

const LANES: usize = 8;

/// Cosines at the ends of the range and beyond, and no numbers.
const HOSTILE: [f32; 12] = [
    0.0,
    -0.0,
    1.0,
    1.000_000_1,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-30,
    2.0,
    -1.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
];

/// Roughnesses and indices of refraction, ordinary and hostile.
const ALPHAS: [f32; 10] = [0.0, 1e-45, 1e-3, 0.04, 0.249, 0.25, 0.7, 1.0, 4.0, f32::NAN];
const IORS: [f32; 11] = [1.5, 1.0, 0.7, 1.000_1, 4.0, 40.0, 0.0, -1.5, 1e-30, f32::INFINITY, f32::NAN];

/// Bits of a number; any NaN counts as the same.
fn bits(x: f32) -> u32 {
    if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() }
}

/// Groups of random and hostile cosines.
fn groups(random: &mut Random) -> Vec<[f32; LANES]> {
    let mut cosine = |i: usize, lane: usize| match (i + lane) % 3 {
        0 => HOSTILE[(5 * i + lane) % HOSTILE.len()],
        1 => random.f32(),
        _ => random.f32() * random.f32() * random.f32() * 1e-3,
    };
    (0..40).map(|i| std::array::from_fn(|lane| cosine(i, lane))).collect()
}

/// Asserts that a function of all lanes has the bits of another one of single lanes.
fn assert_lanes(name: &str, lanes: [f32; LANES], single: impl Fn(usize) -> f32) {
    for (lane, value) in lanes.into_iter().enumerate() {
        assert_eq!(bits(value), bits(single(lane)), "{name}, lane {lane}: {value}, not {}", single(lane));
    }
}

#[test]
fn tables_give_each_lane_the_bits_of_a_single_cosine() {
    let mut random = Random::new(301);
    for cos in groups(&mut random) {
        for alpha in ALPHAS.into_iter().chain([random.f32(), random.f32()]) {
            let lost = isotropic_mirror_losses(cos, alpha);
            assert_lanes("loss", lost, |i| isotropic_mirror_loss(cos[i], alpha));
            let name = format!("{cos:?} {alpha}");
            assert_lanes(&name, grazing_albedos(cos, alpha, lost), |i| grazing_albedos([cos[i]], alpha, [lost[i]])[0]);
            assert_lanes(&name, sheen_albedos(cos, alpha), |i| sheen_albedos([cos[i]], alpha)[0]);
            for ior in IORS.into_iter().chain([random.range(0.3, 3.0)]) {
                let single = |i: usize| dielectric_reflection_albedo(cos[i], alpha, ior, lost[i]);
                assert_lanes(&name, dielectric_reflection_albedos(cos, alpha, ior, lost), single);
            }
        }
    }
}

#[test]
fn reflectances_without_branches_have_the_bits_of_single_ones() {
    let mut random = Random::new(302);
    for cos in groups(&mut random) {
        for ior in IORS.into_iter().chain([random.range(0.3, 1.0), random.range(1.0, 3.0)]) {
            let name = format!("{cos:?} {ior}");
            assert_lanes(&name, dielectric_reflectances(cos, ior), |i| dielectric_reflectance(cos[i], ior));
        }
    }
}

/// Curves of every kind, also with parameters that no material has.
fn curves() -> Vec<Fresnel> {
    let color = Rgb::new(0.9, 0.4, 0.1);
    let thin_film = ThinFilm { f0: color, ior: 1.3, thickness_nm: 400.0 };
    let mut curves = vec![
        Fresnel::WHITE,
        Fresnel::tinted(color, Rgb::WHITE),
        Fresnel::tinted(color, Rgb::new(0.2, 1.0, 0.7)),
        Fresnel::tinted(Rgb::BLACK, Rgb::BLACK),
        Fresnel::Schlick { f0: Rgb::splat(0.04), f90: Rgb::WHITE },
        Fresnel::Schlick { f0: color, f90: Rgb::splat(f32::NAN) },
        Fresnel::ThinFilm { thin_film, amount: 0.7 },
    ];
    let iors = IORS.into_iter().filter(|ior| *ior >= 0.0 || ior.is_nan());
    curves.extend(iors.map(|ior| Fresnel::Dielectric { ior, color }));
    curves.extend(Metal::named("gold").map(Metal::fresnel));
    curves
}

#[test]
fn albedos_of_microfacets_have_the_bits_of_single_ones() {
    let mut random = Random::new(303);
    for cos in groups(&mut random).into_iter().take(10) {
        for (curve, alpha) in curves().into_iter().flat_map(|curve| ALPHAS.map(|alpha| (curve, alpha))) {
            let lost = isotropic_mirror_losses(cos, alpha);
            let channels = curve.rough_albedos(cos, alpha, lost);
            for (channel, albedos) in channels.into_iter().enumerate() {
                let single = |i: usize| curve.rough_albedo(cos[i], alpha, lost[i]).to_array()[channel];
                assert_lanes(&format!("{curve:?} {alpha} {cos:?}"), albedos, single);
            }
        }
    }
}

/// Lobes that may be layers, and one that computes its albedos one by one.
fn lobes() -> Vec<Lobe> {
    let mut lobes: Vec<Lobe> = vec![Lambert { albedo: Rgb::new(0.2, 0.9, 0.4) }.into()];
    let alphas = ALPHAS.map(Vec2::splat).into_iter().chain([Vec2::new(0.5, 0.1), Vec2::new(0.3, 0.3f32.next_up())]);
    for (alpha, curve) in alphas.flat_map(|alpha| curves().into_iter().map(move |curve| (alpha, curve))) {
        let conductor = Conductor::compensated(curve, alpha);
        lobes.extend([Conductor::new(curve, alpha), conductor].map(Lobe::from));
        lobes.push(TiltedConductor::new(conductor, Vec3::new(0.3, -0.2, 0.9).normalize()).into());
    }
    let sheens = ALPHAS.into_iter().flat_map(|alpha| [Rgb::WHITE, Rgb::new(0.1, 0.3, 0.2)].map(|c| (c, alpha)));
    lobes.extend(sheens.map(|(color, alpha)| Lobe::from(Sheen::new(color, alpha))));
    lobes
}

#[test]
fn albedos_of_a_quadrature_have_the_bits_of_single_directions() {
    for (lobe, azimuth) in lobes().into_iter().flat_map(|lobe| AZIMUTHS.map(|azimuth| (lobe, azimuth))) {
        let directions = azimuth.directions().into_iter().zip(lobe.max_albedos(azimuth));
        for (w, albedo) in directions {
            assert_eq!(bits(albedo), bits(lobe.albedo(w).max_channel()), "{lobe:?} {azimuth:?} {w}");
        }
    }
}

const AZIMUTHS: [Azimuth; 3] = [Azimuth::NearX, Azimuth::Diagonal, Azimuth::NearY];

#[test]
fn a_quadrature_integrates_over_the_hemisphere() {
    for azimuth in AZIMUTHS {
        for (w, cos) in azimuth.directions().into_iter().zip(quadrature::cosines()) {
            assert!(w.is_normalized() && w.z.to_bits() == cos.to_bits() && w.x > 0.0 && w.y > 0.0);
        }
    }
    // ∫ 2 μ μⁿ dμ = 2 / (n + 2): exact up to n = 3, where the integrand in s has degree 9.
    for n in 0..4 {
        let power = |azimuth: Azimuth| azimuth.directions().map(|w| w.z.powi(n));
        let expected = 2.0 / (n as f32 + 2.0);
        assert!((quadrature::mean(false, power) - expected).abs() < 1e-6, "{n}");
        assert!((quadrature::mean(true, power) - expected).abs() < 1e-6, "{n}");
    }
    // x² and y² have the same mean over both azimuths.
    let sines = |azimuth: Azimuth| -> [f32; NODES] { azimuth.directions().map(|w| w.x * w.x) };
    assert!((quadrature::mean(true, sines) - 0.25).abs() < 1e-3, "{}", quadrature::mean(true, sines));
}
