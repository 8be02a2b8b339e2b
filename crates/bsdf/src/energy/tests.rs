//! Compares the tables with integrals; `JUGGLER_BLESS=1` makes them anew:
//! `JUGGLER_BLESS=1 cargo test -p juggler-bsdf energy_tables_match_integration_of_lobes`.

use super::*;
use crate::ScatteringLobe;
use crate::Sheen;
use crate::fresnel;
use crate::ggx::Ggx;
use juggler_math::testing::close;
use juggler_math::{Vec2, Vec3};

/// Reflected and lost light at a rough interface of relative index `ior`, or at a perfect mirror
/// for `None`: a sum over visible normals, each of weight G2 / G1.
fn integrate(cos: f32, alpha: f32, ior: Option<f32>, count: u32) -> (f64, f64) {
    integrate_scaled(cos.max(1e-4), alpha, ior, count)
}

/// [`integrate`] down to smaller cosines.
fn integrate_scaled(cos: f32, alpha: f32, ior: Option<f32>, count: u32) -> (f64, f64) {
    let cos = cos.max(1e-6);
    let ggx = Ggx::isotropic(alpha.max(Ggx::SMOOTH));
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let so = ggx.stretched_length(wo);
    // G2 / G1 = zi (zo + so) / (so zi + si zo)
    let ratio = |wi: Vec3| {
        let (zi, si) = (wi.z.abs(), ggx.stretched_length(wi));
        f64::from(zi * (cos + so) / (so * zi + si * cos))
    };
    let (mut reflected, mut refracted) = (0.0, 0.0);
    for i in 0..count {
        let (m, _) = ggx.sample_visible_normal(wo, so, even(i));
        let reflectance =
            ior.map_or(
                1.0,
                |ior| if ior == 1.0 { 0.0 } else { f64::from(fresnel::dielectric_reflectance(wo.dot(m), ior)) },
            );
        let up = fresnel::reflect(wo, m);
        if up.z > 0.0 {
            reflected += reflectance * ratio(up);
        }
        if let Some(down) = ior.and_then(|ior| fresnel::refract(wo, m, 1.0 / ior)).filter(|w| w.z < 0.0) {
            refracted += (1.0 - reflectance) * ratio(down);
        }
    }
    let count = f64::from(count);
    (reflected / count, (1.0 - (reflected + refracted) / count).clamp(0.0, 1.0))
}

/// Directional albedo of a rough mirror whose microfacets have this reflectance at a cosine.
fn reflection_albedo(cos: f32, alpha: f32, reflectance: impl Fn(f32) -> f32, count: u32) -> f64 {
    let ggx = Ggx::isotropic(alpha.max(Ggx::SMOOTH));
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let one = |i| {
        let found = ggx.sample_reflection(wo, even(i));
        found.map_or(0.0, |(_, microfacet)| f64::from(reflectance(microfacet.cos) * microfacet.value / microfacet.pdf))
    };
    (0..count).map(one).sum::<f64>() / f64::from(count)
}

/// Low-discrepancy sequence in two dimensions, by powers of the plastic number (Roberts 2018).
fn even(i: u32) -> Vec2 {
    Vec2::new(
        (0.5 + f64::from(i) * 0.754_877_666_246_692_8).fract() as f32,
        (0.5 + f64::from(i) * 0.569_840_290_998_053_3).fract() as f32,
    )
}

/// Argument of entry `i` of `count`, which are uniform in its square root.
fn entry(i: usize, count: usize) -> f32 {
    let root = i as f32 / (count - 1) as f32;
    root * root
}

fn ior_of(side: usize, i: usize) -> f32 {
    let x = entry(i, IOR) * STEEPEST * STEEPEST;
    let dense = (1.0 + x) / (1.0 - x);
    if side == 0 { dense } else { 1.0 / dense }
}

/// Cosine-weighted mean of a mirror's row.
fn mirror_mean(alpha: f32, row: &[i16]) -> i16 {
    let steps = 20_000;
    let at = |i| {
        let cos = (i as f32 + 0.5) / steps as f32;
        let (below, t) = table_position(coordinate(cos, alpha), COS);
        let value = f64::from(row[below]) * f64::from(1.0 - t) + f64::from(row[below + 1]) * f64::from(t);
        2.0 * f64::from(cos) * value / f64::from(steps)
    };
    (0..steps).map(at).sum::<f64>().round() as i16
}

/// Cosine-weighted mean of a function of the cosine, in the tables' units.
fn mean(of: impl Fn(f32) -> f32) -> i16 {
    let steps = 4000;
    // Uniform in s = √cos: 2 cos dcos = 4 s³ ds.
    let at = |i| {
        let s = (f64::from(i) + 0.5) / f64::from(steps);
        4.0 * s * s * s * f64::from(of((s * s) as f32)) / f64::from(steps)
    };
    stored((0..steps).map(at).sum::<f64>())
}

fn stored(value: f64) -> i16 {
    (value * 1e4).round() as i16
}

fn mirror_row(alpha: usize, count: u32) -> Vec<i16> {
    let alpha = entry(alpha, ALPHA).max(Ggx::SMOOTH);
    // Cosine at a coordinate's square x: cos (1 + alpha) = x (cos + alpha).
    let cos = |x: f32| x * alpha / (1.0 + alpha - x);
    let loss = |c| integrate_scaled(cos(entry(c, COS)), alpha, None, count).1;
    (0..COS).map(|c| stored(loss(c))).collect()
}

/// Corrections to the weight of the grazing color in Schlick's curve.
fn grazing_row(alpha: usize, count: u32) -> Vec<i16> {
    let alpha = entry(alpha, ALPHA);
    let reflectance = |cos: f32| (1.0 - cos).powi(5);
    let at = |cos: f32| {
        let plain = plain_grazing(cos, alpha, isotropic_mirror_loss(cos, alpha));
        reflection_albedo(cos.max(1e-4), alpha, reflectance, count) - f64::from(plain)
    };
    (0..COS).map(|c| stored(at(entry(c, COS)))).collect()
}

/// Directional albedo of sheen by a sum over directions.
fn sheen_row(alpha: usize, side: u32) -> Vec<i16> {
    let sheen = Sheen::new(juggler_math::Rgb::WHITE, entry(alpha, ALPHA));
    let at = |cos: f32| {
        let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos.max(1e-4));
        let one = |k: u32| {
            // Uniform in √cos, which favors the bright grazing angles.
            let (s, turn) = ((k % side) as f32 + 0.5, (k / side) as f32 + 0.5);
            let (s, turn) = (s / side as f32, turn / side as f32 * 0.5);
            let (z, (sin, turn)) = (s * s, juggler_math::portable::sin_cos_turns(turn));
            let radius = (1.0 - z * z).sqrt();
            f64::from(sheen.eval_pdf(wo, Vec3::new(radius * turn, radius * sin, z)).0.r * 2.0 * s)
        };
        (0..side * side).map(one).sum::<f64>() / f64::from(side * side) * std::f64::consts::TAU
    };
    (0..COS).map(|c| stored(at(entry(c, COS)))).collect()
}

/// Alpha of an interface's entry; the first is the smallest that is not smooth.
fn clear_alpha(i: usize) -> f32 {
    entry(i, ALPHA_CLEAR).max(Ggx::SMOOTH)
}

/// Corrections to the reflection of an interface.
fn clear_row(side: usize, ior: usize, alpha: usize, count: u32) -> Vec<i16> {
    let (ior, alpha) = (ior_of(side, ior), clear_alpha(alpha));
    let at = |c| {
        let cos = entry(c, COS);
        let (reflected, _) = integrate(cos, alpha, Some(ior), count);
        let lost = isotropic_mirror_loss(cos, alpha);
        stored(reflected - f64::from(plain_reflection([cos], alpha, ior, [lost])[0]))
    };
    (0..COS).map(at).collect()
}

/// Mean reflection with these corrections.
fn clear_mean(table: &[Vec<Vec<Vec<i16>>>], side: usize, i: usize, a: usize) -> i16 {
    let (ior, alpha) = (ior_of(side, i), clear_alpha(a));
    let row: [i16; COS] = table[side][i][a].as_slice().try_into().unwrap();
    let plain = |cos| plain_reflection([cos], alpha, ior, [isotropic_mirror_loss(cos, alpha)])[0];
    mean(|cos| plain(cos) + lerp_row(&row, table_position(cos.sqrt(), COS)))
}

/// Writes one file: its name and description, and each table's name, type and text.
fn write(name: &str, what: &str, uses: &str, tables: &[(&str, &str, String)]) {
    let mut text = format!("//! {what} Made by `tests.rs`, which says how: do not edit.\n\nuse super::{uses};\n");
    for (constant, kind, table) in tables {
        let which = if constant.ends_with("_MEAN") { "Its means." } else { what };
        let rows = table.replace("], [", "],\n    [");
        text += &format!("\n/// {which}\n#[rustfmt::skip]\npub(super) const {constant}: {kind} = {rows};\n");
    }
    let path = format!("{}/src/energy/{name}.rs", env!("CARGO_MANIFEST_DIR"));
    std::fs::write(path, text).unwrap();
}

/// Writes all tables. Run it twice where the mirror's table changes, since tables of interfaces are
/// corrections on top of it.
fn write_tables(count: u32) {
    let mirror: Vec<_> = (0..ALPHA).map(|alpha| mirror_row(alpha, count)).collect();
    let means: Vec<_> = mirror.iter().enumerate().map(|(i, row)| mirror_mean(entry(i, ALPHA), row)).collect();
    let tables = [
        ("MIRROR_LOSS", "Plane<ALPHA>", format!("{mirror:?}")),
        ("MIRROR_LOSS_MEAN", "[i16; ALPHA]", format!("{means:?}")),
    ];
    write("mirror_loss", "Loss of rough perfect mirrors.", "{ALPHA, Plane}", &tables);
    let grazing: Vec<_> = (0..ALPHA).map(|alpha| grazing_row(alpha, count)).collect();
    let tables = [("MIRROR_GRAZING", "Plane<ALPHA>", format!("{grazing:?}"))];
    write("mirror_grazing", "Weight of the grazing color on rough mirrors.", "{ALPHA, Plane}", &tables);
    let sheen: Vec<_> = (0..ALPHA).map(|alpha| sheen_row(alpha, 128)).collect();
    let tables = [("SHEEN", "Plane<ALPHA>", format!("{sheen:?}"))];
    write("sheen_albedo", "Directional albedo of sheen.", "{ALPHA, Plane}", &tables);
    let clear: Vec<Vec<Vec<_>>> = (0..2)
        .map(|side| (0..IOR).map(|i| (0..ALPHA_CLEAR).map(|a| clear_row(side, i, a, count)).collect()).collect())
        .collect();
    let means: Vec<Vec<Vec<i16>>> = (0..2)
        .map(|side| (0..IOR).map(|i| (0..ALPHA_CLEAR).map(|a| clear_mean(&clear, side, i, a)).collect()).collect())
        .collect();
    let tables = [("REFLECTION", "Sides", format!("{clear:?}")), ("REFLECTION_MEAN", "Means", format!("{means:?}"))];
    write("interface_reflection", "Reflection of rough interfaces.", "{Means, Sides}", &tables);
}

#[test]
fn energy_tables_match_integration_of_lobes() {
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        return write_tables(16_384);
    }
    let near = |a: &[i16], b: &[i16]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 60);
    for alpha in [0, 5, 10, 15] {
        let row = mirror_row(alpha, 2048);
        assert!(near(&row, &MIRROR_LOSS[alpha]), "{alpha}: {row:?}");
        assert!(near(&grazing_row(alpha, 2048), &MIRROR_GRAZING[alpha]), "{alpha}");
        assert!(near(&sheen_row(alpha, 64), &SHEEN[alpha]), "{alpha}");
        assert_eq!(mirror_mean(entry(alpha, ALPHA), &MIRROR_LOSS[alpha]), MIRROR_LOSS_MEAN[alpha]);
    }
    for (side, i, alpha) in [(0, 0, 8), (0, 4, 3), (0, 4, 11), (1, 3, 7), (1, 7, 11), (1, 5, 4)] {
        let reflected = clear_row(side, i, alpha, 2048);
        assert!(near(&reflected, &REFLECTION[side][i][alpha]), "{side} {i} {alpha}: {reflected:?}");
        let tabulated = mean_dielectric_reflection_albedo(entry(alpha, ALPHA_CLEAR), ior_of(side, i));
        let alpha_entry = entry(alpha, ALPHA_CLEAR);
        let lost = |cos| isotropic_mirror_loss(cos, alpha_entry);
        let mean = mean(|cos| dielectric_reflection_albedo(cos, alpha_entry, ior_of(side, i), lost(cos)));
        assert!(close(tabulated, f32::from(mean) * UNIT, 2e-3), "{side} {i} {alpha}: {tabulated} {mean}");
    }
}

#[test]
fn interpolated_energy_tables_match_integration() {
    for (cos, alpha) in [(0.9, 0.8), (0.5, 0.3), (0.3, 0.6), (0.07, 0.2), (0.02, 0.5)] {
        let (_, loss) = integrate(cos, alpha, None, 8192);
        assert!(close(isotropic_mirror_loss(cos, alpha), loss as f32, 6e-3), "{cos} {alpha}: {loss}");
        for ior in [1.05, 1.5, 2.4, 1.0 / 1.33, 0.5] {
            let (reflected, loss) = integrate(cos, alpha, Some(ior), 8192);
            let w = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let tabulated = InterfaceLoss::new(Ggx::isotropic(alpha), ior).at(Side::from_ior(ior), w);
            assert!(close(tabulated, loss as f32, 0.005), "{cos} {alpha} {ior}: {loss} {tabulated}");
            let lost = isotropic_mirror_loss(cos, alpha);
            let tabulated = dielectric_reflection_albedo(cos, alpha, ior, lost);
            assert!(close(tabulated, reflected as f32, 0.03), "{cos} {alpha} {ior}: {reflected} {tabulated}");
        }
    }
}
