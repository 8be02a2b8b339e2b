//! Compares the tables of [`InterfaceLoss`] with integrals of single scattering; `JUGGLER_BLESS=1`
//! makes them anew:
//! `JUGGLER_BLESS=1 cargo test -p juggler-bsdf interface_loss_tables`.
//!
//! An entry is an integral over visible normals for its direction. The entries of each zone are
//! then scaled so that the interpolated loss has the same integral over the zone as the loss
//! itself.

use super::interface::{InterfaceLoss, TableSize};
use super::sample_rng::SampleRng;
use super::zone::{Side, Zone};
use super::{STEEPEST, table_position};
use crate::fresnel;
use crate::ggx::Ggx;
use juggler_math::{Vec2, Vec3, portable};

/// Low-discrepancy sequence in four dimensions, by powers of a generalized golden ratio (Roberts
/// 2018).
fn even(i: u32) -> [f32; 4] {
    const STEPS: [f64; 4] =
        [0.856_674_883_854_502_9, 0.733_891_856_627_126_2, 0.628_706_721_040_111, 0.538_597_257_221_801];
    STEPS.map(|step| ((0.5 + f64::from(i + 1) * step).fract() as f32).min(1f32.next_down()))
}

/// Fraction of light along `wo` that a microfacet, selected by `u`, scatters once; `ior` is the
/// index behind over that in front, infinite for a perfect mirror.
fn scattered_once(ggx: Ggx, wo: Vec3, ior: f32, u: Vec2) -> f64 {
    let so = ggx.stretched_length(wo);
    let (m, _) = ggx.sample_visible_normal(wo, so, u);
    // G2 / G1
    let ratio = |wi: Vec3| {
        let (zi, si) = (wi.z.abs(), ggx.stretched_length(wi));
        f64::from(zi * (wo.z + so) / (so * zi + si * wo.z))
    };
    let reflectance = if ior.is_infinite() { 1.0 } else { f64::from(fresnel::dielectric_reflectance(wo.dot(m), ior)) };
    let up = fresnel::reflect(wo, m);
    let reflected = if up.z > 0.0 { reflectance * ratio(up) } else { 0.0 };
    let down = if reflectance < 1.0 { fresnel::refract(wo, m, 1.0 / ior).filter(|w| w.z < 0.0) } else { None };
    reflected + down.map_or(0.0, |down| (1.0 - reflectance) * ratio(down))
}

/// Direction of this squared cosine and of this azimuth from the x axis.
fn towards(squared_cos: f32, azimuth_turns: f32) -> Vec3 {
    let squared = squared_cos.clamp(1e-8, 1.0);
    let (sin, cos) = portable::sin_cos_turns(azimuth_turns);
    let along = (1.0 - squared).max(0.0).sqrt();
    Vec3::new(along * cos, along * sin, squared.sqrt())
}

/// One row of a table: its microfacets, with x the rougher axis, and its index of refraction.
#[derive(Clone, Copy, Debug)]
struct Surface {
    ggx: Ggx,
    dense: f32,
}

impl Surface {
    fn from_row(size: TableSize, row: usize) -> Self {
        let part = |i: usize, count: usize| i as f32 / (count - 1).max(1) as f32;
        let (i, a, r) = (row % size.ior, row / size.ior % size.alpha, row / size.ior / size.alpha);
        let root = TableSize::LEAST + (1.0 - TableSize::LEAST) * part(a, size.alpha);
        let alpha = portable::powi(root, 4).max(Ggx::SMOOTH);
        let alpha_ratio =
            if size.alpha_ratio == 1 { 1.0 } else { part(r, size.alpha_ratio) * part(r, size.alpha_ratio) };
        let x = part(i, size.ior) * STEEPEST;
        // Slightly above 1 for the first, whose zone of total reflection would vanish.
        let dense = if size.ior == 1 { f32::INFINITY } else { ((1.0 + x * x) / (1.0 - x * x)).max(1.000_5) };
        Self { ggx: Ggx::new(Vec2::new(alpha, (alpha * alpha_ratio).max(Ggx::SMOOTH))), dense }
    }

    fn ior(self, zone: Zone) -> f32 {
        if zone == Zone::Thin { self.dense } else { 1.0 / self.dense }
    }

    fn critical(self) -> f32 {
        1.0 - 1.0 / (self.dense * self.dense)
    }

    /// L at A of a zone.
    fn loss(self, zone: Zone, area: f32, azimuth_turns: f32, count: u32) -> f64 {
        let wo = towards(zone.squared_cos(area, self.critical()), azimuth_turns);
        let one = |i| {
            let [x, y, ..] = even(i);
            scattered_once(self.ggx, wo, self.ior(zone), Vec2::new(x, y))
        };
        1.0 - (0..count).map(one).sum::<f64>() / f64::from(count)
    }

    /// The mean of L over a zone.
    fn mean(self, zone: Zone, count: u32) -> f64 {
        let one = |i| {
            let [x, y, area, azimuth] = even(i);
            let wo = towards(zone.squared_cos(area, self.critical()), azimuth);
            scattered_once(self.ggx, wo, self.ior(zone), Vec2::new(x, y))
        };
        (1.0 - (0..count).map(one).sum::<f64>() / f64::from(count)).max(0.0)
    }
}

impl TableSize {
    /// Combinations of alpha ratio, alpha and index.
    const fn surfaces(self) -> usize {
        self.alpha_ratio * self.alpha * self.ior
    }

    /// Entries of one surface.
    const fn directions(self) -> usize {
        self.azimuth * self.zones * self.cos
    }
}

/// Weight of each azimuth's entry in a mean over azimuths.
fn azimuth_weights(count: usize) -> Vec<f64> {
    let mut weights = vec![0.0; count];
    if count == 1 {
        return vec![1.0];
    }
    let steps = 4096;
    for step in 0..steps {
        let (sin, cos) = portable::sin_cos_turns(0.25 * (step as f32 + 0.5) / steps as f32);
        let (p, s) = table_position(cos / (cos + sin), count);
        weights[p] += f64::from(1.0 - s) / f64::from(steps);
        weights[p + 1] += f64::from(s) / f64::from(steps);
    }
    weights
}

/// Weight of each entry in the mean over a zone.
fn cos_weights(zone: Zone, count: usize) -> Vec<f64> {
    let (mut weights, steps) = (vec![0.0; count], 64 * (count - 1));
    for step in 0..steps {
        let (start, end) = (step as f32 / steps as f32, (step + 1) as f32 / steps as f32);
        let measure = f64::from(zone.area(end) - zone.area(start));
        let (k, t) = table_position(0.5 * (start + end), count);
        weights[k] += measure * f64::from(1.0 - t);
        weights[k + 1] += measure * f64::from(t);
    }
    weights
}

/// Azimuth of an entry, from the rougher axis, in turns; entries are uniform in cos / (cos + sin).
fn azimuth_of(p: usize, count: usize) -> f32 {
    let part = if count == 1 { 1.0 } else { p as f32 / (count - 1) as f32 };
    portable::atan2(1.0 - part, part) / std::f32::consts::TAU
}

/// The entries of a surface, and the means of its zones, in the table's units.
fn row(size: TableSize, surface: Surface, points: u32, mean_points: u32) -> (Vec<u16>, Vec<u16>) {
    let mut loss = vec![0.0; size.directions()];
    let mut means = vec![];
    let by_azimuth = azimuth_weights(size.azimuth);
    for zone in Zone::ALL.into_iter().take(size.zones) {
        let by_cos = cos_weights(zone, size.cos);
        let entry = |p: usize, k: usize| (p * size.zones + zone as usize) * size.cos + k;
        let mut sum = 0.0;
        for p in 0..size.azimuth {
            for k in 0..size.cos {
                let area = zone.area(k as f32 / (size.cos - 1) as f32);
                let value = surface.loss(zone, area, azimuth_of(p, size.azimuth), points).max(0.0);
                loss[entry(p, k)] = value;
                sum += value * by_azimuth[p] * by_cos[k];
            }
        }
        let mean = surface.mean(zone, mean_points);
        let scale = if sum > 1e-6 { (mean / sum).clamp(0.5, 2.0) } else { 1.0 };
        let stored = |value: f64| (value * scale * 65_536.0).round().clamp(0.0, 65_535.0) as u16;
        means.push(stored(sum));
        for p in 0..size.azimuth {
            (0..size.cos).for_each(|k| loss[entry(p, k)] = f64::from(stored(loss[entry(p, k)])));
        }
    }
    (loss.into_iter().map(|value| value as u16).collect(), means)
}

fn write(name: &str, what: &str, size: TableSize) {
    let (mut loss, mut means) = (String::new(), String::new());
    for surface in 0..size.surfaces() {
        let (entries, zones) = row(size, Surface::from_row(size, surface), 4096, 131_072);
        let text = |row: Vec<u16>| row.iter().map(u16::to_string).collect::<Vec<_>>().join(", ");
        loss += &format!("    {},\n", text(entries));
        means += &format!("    {},\n", text(zones));
    }
    let (entries, zones) = (size.surfaces() * size.directions(), size.surfaces() * size.zones);
    // Write the means of many surfaces on one line.
    let means = means.replace(",\n    ", ", ");
    let text = format!(
        "//! {what} Made by `interface_tests.rs`, which says how: do not edit.\n\n\
         /// By surface, azimuth, zone and cosine, in units of 1/65536.\n#[rustfmt::skip]\n\
         pub(super) static LOSS: [u16; {entries}] = [\n{loss}];\n\n\
         /// Means by surface and zone.\n#[rustfmt::skip]\npub(super) static MEANS: [u16; {zones}] = [\n{means}];\n"
    );
    std::fs::write(format!("{}/src/energy/{name}.rs", env!("CARGO_MANIFEST_DIR")), text).unwrap();
}

#[test]
fn interface_loss_tables_match_integration_of_lobes() {
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        write("interface_isotropic", "Loss of rough interfaces.", TableSize::ISOTROPIC);
        write("interface_anisotropic", "Loss of anisotropic interfaces.", TableSize::ANISOTROPIC);
        write("mirror_anisotropic", "Loss of anisotropic mirrors.", TableSize::MIRROR);
        return;
    }
    for (size, row_number, entries, means) in [
        (TableSize::ISOTROPIC, 127, &super::interface_isotropic::LOSS[..], &super::interface_isotropic::MEANS[..]),
        (TableSize::ISOTROPIC, 184, &super::interface_isotropic::LOSS[..], &super::interface_isotropic::MEANS[..]),
        (
            TableSize::ANISOTROPIC,
            101,
            &super::interface_anisotropic::LOSS[..],
            &super::interface_anisotropic::MEANS[..],
        ),
        (TableSize::MIRROR, 31, &super::mirror_anisotropic::LOSS[..], &super::mirror_anisotropic::MEANS[..]),
    ] {
        let (row, zones) = row(size, Surface::from_row(size, row_number), 2048, 32_768);
        let near = |a: &[u16], b: &[u16], most| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= most);
        let count = size.directions();
        assert!(near(&row, &entries[row_number * count..][..count], 400), "{size:?} {row_number}");
        assert!(near(&zones, &means[row_number * size.zones..][..size.zones], 40), "{size:?} {row_number}: {zones:?}");
    }
}

/// Interfaces between entries: alpha along both axes, and the index of refraction.
const BETWEEN: [(f32, f32, f32); 8] = [
    (0.0225, 0.0225, 2.4),
    (0.09, 0.09, 2.4),
    (0.3, 0.3, 1.1),
    (0.45, 0.45, 1.5),
    (0.8, 0.8, 1.33),
    (0.5, 0.05, 1.5),
    (0.3, 0.6, 2.4),
    (0.15, 0.1, 1.2),
];

#[test]
fn interpolated_mean_losses_match_integration() {
    for (x, y, ior) in BETWEEN {
        let ggx = Ggx::new(Vec2::new(x, y));
        let (loss, surface) = (InterfaceLoss::new(ggx, ior), Surface { ggx, dense: ior });
        for side in [Side::Thin, Side::Dense] {
            let of = |zone: &Zone| surface.mean(*zone, 131_072) * f64::from(zone.fraction(surface.critical()));
            let (mean, expected) = (f64::from(loss.mean(side)), side.zones().iter().map(of).sum::<f64>());
            let near = if x == y { 3e-4 } else { 1.5e-3 };
            assert!((mean - expected).abs() < near, "{x} {y} {ior} {side:?}: {mean} {expected}");
        }
    }
}

#[test]
fn anisotropic_mirror_loss_table_matches_integration() {
    for (x, y) in [(0.5, 0.05), (0.3, 0.6), (0.9, 0.09), (0.2, 0.15)] {
        let ggx = Ggx::new(Vec2::new(x, y));
        let (loss, surface) = (InterfaceLoss::for_mirror(ggx), Surface { ggx, dense: f32::INFINITY });
        let (mean, expected) = (f64::from(loss.mean(Side::Thin)), surface.mean(Zone::Thin, 131_072));
        assert!((mean - expected).abs() < 1e-3, "{x} {y}: {mean} {expected}");
        for (area, azimuth) in [(0.9, 0.1), (0.5, 0.3), (0.3, 0.0), (0.1, 0.25), (0.02, 0.2)] {
            let (at, expected) = (
                f64::from(loss.at(Side::Thin, towards(area, azimuth))),
                surface.loss(Zone::Thin, area, azimuth, 16_384),
            );
            assert!((at - expected).abs() < 0.01, "{x} {y} {area} {azimuth}: {at} {expected}");
        }
    }
}

#[test]
fn tabulated_means_equal_means_of_the_interpolated_loss() {
    for (x, y, ior) in BETWEEN {
        let loss = InterfaceLoss::new(Ggx::new(Vec2::new(x, y)), ior);
        for side in [Side::Thin, Side::Dense] {
            let count = 100_000;
            let at = |i| {
                let [azimuth, squared, ..] = even(i);
                f64::from(loss.at(side, towards(squared, azimuth)))
            };
            let (mean, expected) = (f64::from(loss.mean(side)), (0..count).map(at).sum::<f64>() / f64::from(count));
            assert!((mean - expected).abs() < 1e-4 + 0.01 * expected, "{x} {y} {ior} {side:?}: {mean} {expected}");
        }
    }
}

#[test]
fn directions_are_drawn_in_proportion_to_the_loss() {
    for (number, (x, y, ior)) in (0u32..).zip(BETWEEN) {
        let loss = InterfaceLoss::new(Ggx::new(Vec2::new(x, y)), ior);
        let side = if number % 2 == 0 { Side::Dense } else { Side::Thin };
        // Rotate the normal away from z, around which the test's cells are longest.
        let sample = |u: Vec2| {
            let w = loss.sample(side, &mut SampleRng::new(u, 0.25));
            Some(Vec3::new(w.z, w.x, w.y))
        };
        let pdf = |w: Vec3| {
            let w = Vec3::new(w.y, w.z, w.x);
            if w.z > 0.0 { loss.at(side, w) * w.z * std::f32::consts::FRAC_1_PI / loss.mean(side) } else { 0.0 }
        };
        let checked = juggler_math::testing::chi_squared_directions(sample, pdf, 200_000, 1e-3 / 8.0);
        assert!(checked.is_ok(), "{x} {y} {ior} {side:?}: {checked:?}");
    }
}
