//! The tables against integrals; with `JUGGLER_BLESS=1` they are made anew:
//! `JUGGLER_BLESS=1 cargo test -p juggler-tracer tables_are_what_lobes_integrate_to && cargo fmt`.

use super::*;
use crate::bsdf::fresnel;
use crate::bsdf::ggx::Ggx;
use juggler_math::testing::close;
use juggler_math::{Vec2, Vec3};

/// Mirrored and lost light at rough borders of relative index `ior`, by summing over visible normals: the weight of each
/// is G2 / G1. A perfect mirror for `None`.
fn integrate(cos: f32, alpha: f32, ior: Option<f32>, count: u32) -> (f64, f64) {
    integrate_scaled(cos.max(1e-4), alpha, ior, count)
}

/// The same down to the smallest cosines.
fn integrate_scaled(cos: f32, alpha: f32, ior: Option<f32>, count: u32) -> (f64, f64) {
    let cos = cos.max(1e-6);
    let ggx = Ggx::isotropic(alpha.max(Ggx::SMOOTH));
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let so = ggx.stretch(wo);
    // G2 / G1 = zi (zo + so) / (so zi + si zo)
    let ratio = |wi: Vec3| {
        let (zi, si) = (wi.z.abs(), ggx.stretch(wi));
        f64::from(zi * (cos + so) / (so * zi + si * cos))
    };
    let (mut mirrored, mut refracted) = (0.0, 0.0);
    for i in 0..count {
        // The plastic number's sequence: even in both dimensions.
        let u = Vec2::new(
            (0.5 + f64::from(i) * 0.754_877_666_246_692_8).fract() as f32,
            (0.5 + f64::from(i) * 0.569_840_290_998_053_3).fract() as f32,
        );
        let (m, _) = ggx.sample(wo, so, u);
        let share =
            ior.map_or(1.0, |ior| if ior == 1.0 { 0.0 } else { f64::from(fresnel::dielectric(wo.dot(m), ior)) });
        let up = fresnel::reflect(wo, m);
        if up.z > 0.0 {
            mirrored += share * ratio(up);
        }
        if let Some(down) = ior.and_then(|ior| fresnel::refract(wo, m, 1.0 / ior)).filter(|w| w.z < 0.0) {
            refracted += (1.0 - share) * ratio(down);
        }
    }
    let count = f64::from(count);
    (mirrored / count, (1.0 - (mirrored + refracted) / count).clamp(0.0, 1.0))
}

/// The argument of entry `i` of `count` whose square root is even.
fn entry(i: usize, count: usize) -> f32 {
    let root = i as f32 / (count - 1) as f32;
    root * root
}

fn ior_of(side: usize, i: usize) -> f32 {
    let x = entry(i, IOR) * STEEPEST * STEEPEST;
    let dense = (1.0 + x) / (1.0 - x);
    if side == 0 { dense } else { 1.0 / dense }
}

/// The mean of a mirror's row.
fn mirror_mean(alpha: f32, row: &[i16]) -> i16 {
    let steps = 20_000;
    let at = |i| {
        let cos = (i as f32 + 0.5) / steps as f32;
        let (below, t) = place(coordinate(cos, alpha), COS);
        let value = f64::from(row[below]) * f64::from(1.0 - t) + f64::from(row[below + 1]) * f64::from(t);
        2.0 * f64::from(cos) * value / f64::from(steps)
    };
    (0..steps).map(at).sum::<f64>().round() as i16
}

/// The mean of one of the functions of a border.
fn mean(of: impl Fn(f32) -> f32) -> i16 {
    let steps = 4000;
    // Even in √cos: 2 cos dcos = 4 s³ ds.
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
    // The cosine of a coordinate's square x: cos (1 + alpha) = x (cos + alpha).
    let cos = |x: f32| x * alpha / (1.0 + alpha - x);
    let lost = |c| integrate_scaled(cos(entry(c, COS)), alpha, None, count).1;
    (0..COS).map(|c| stored(lost(c))).collect()
}

/// Corrections of a border's [mirrored, lost] light.
fn clear_row(side: usize, ior: usize, alpha: usize, count: u32) -> [Vec<i16>; 2] {
    let (ior, alpha) = (ior_of(side, ior), entry(alpha, ALPHA_CLEAR));
    let at = |c| {
        let cos = entry(c, COS);
        let (mirrored, lost) = integrate(cos, alpha, Some(ior), count);
        let plain = plain_mirrored(cos, alpha, ior);
        [stored(mirrored - f64::from(plain)), stored(lost - f64::from(plain_loss(cos, alpha, ior)))]
    };
    let both: Vec<_> = (0..COS).map(at).collect();
    [both.iter().map(|b| b[0]).collect(), both.iter().map(|b| b[1]).collect()]
}

/// The mean of mirrored (`k` 0) or lost light with these corrections.
fn clear_mean(table: &[Vec<Vec<Vec<i16>>>], side: usize, i: usize, a: usize, k: usize) -> i16 {
    let (ior, alpha) = (ior_of(side, i), entry(a, ALPHA_CLEAR));
    let row: [i16; COS] = table[side][i][a].as_slice().try_into().unwrap();
    mean(|cos| {
        let plain = if k == 0 { plain_mirrored(cos, alpha, ior) } else { plain_loss(cos, alpha, ior) };
        plain + along(&row, place(cos.sqrt(), COS))
    })
}

/// One file: its name, what it holds, the kinds of a table and of its means, both as text.
fn write(name: &str, what: &str, kinds: [&str; 2], tables: [String; 2]) {
    let constant = match name {
        "mirror_lost" => "MIRROR_LOST",
        "border_lost" => "LOST",
        _ => "MIRRORED",
    };
    let [table, means] = tables;
    let uses = if name == "mirror_lost" { "{ALPHA, Plane}" } else { "{Means, Sides}" };
    let text = format!(
        "//! {what} Made by `tests.rs`, which says how: do not edit.\n\nuse super::{uses};\n\n\
         /// {what}\npub(super) const {constant}: {} = {table};\n\n\
         /// Its means.\npub(super) const {constant}_MEAN: {} = {means};\n",
        kinds[0], kinds[1]
    );
    let path = format!("{}/src/bsdf/energy/{name}.rs", env!("CARGO_MANIFEST_DIR"));
    std::fs::write(path, text).unwrap();
}

/// To be run twice where the mirror's table changes: those of borders correct it.
fn write_tables(count: u32) {
    let mirror: Vec<_> = (0..ALPHA).map(|alpha| mirror_row(alpha, count)).collect();
    let means: Vec<_> = mirror.iter().enumerate().map(|(i, row)| mirror_mean(entry(i, ALPHA), row)).collect();
    let kinds = ["Plane<ALPHA>", "[i16; ALPHA]"];
    write("mirror_lost", "What a rough mirror loses.", kinds, [format!("{mirror:?}"), format!("{means:?}")]);
    let clear: Vec<Vec<Vec<_>>> = (0..2)
        .map(|side| (0..IOR).map(|i| (0..ALPHA_CLEAR).map(|a| clear_row(side, i, a, count)).collect()).collect())
        .collect();
    for (k, name, what) in
        [(0, "border_mirrored", "What a rough border mirrors."), (1, "border_lost", "What a rough border loses.")]
    {
        let table: Vec<Vec<Vec<Vec<i16>>>> =
            clear.iter().map(|s| s.iter().map(|i| i.iter().map(|a| a[k].clone()).collect()).collect()).collect();
        let means: Vec<Vec<Vec<i16>>> = (0..2)
            .map(|side| {
                (0..IOR).map(|i| (0..ALPHA_CLEAR).map(|a| clear_mean(&table, side, i, a, k)).collect()).collect()
            })
            .collect();
        let kinds = ["Sides", "Means"];
        write(name, what, kinds, [format!("{table:?}"), format!("{means:?}")]);
    }
}

#[test]
fn tables_are_what_lobes_integrate_to() {
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        return write_tables(16_384);
    }
    let near = |a: &[i16], b: &[i16]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 60);
    for alpha in [0, 5, 10, 15] {
        let row = mirror_row(alpha, 2048);
        assert!(near(&row, &MIRROR_LOST[alpha]), "{alpha}: {row:?}");
        assert_eq!(mirror_mean(entry(alpha, ALPHA), &MIRROR_LOST[alpha]), MIRROR_LOST_MEAN[alpha]);
    }
    for (side, i, alpha) in [(0, 0, 8), (0, 4, 3), (0, 4, 11), (1, 3, 7), (1, 7, 11), (1, 5, 4)] {
        let [mirrored, lost] = clear_row(side, i, alpha, 2048);
        assert!(near(&mirrored, &MIRRORED[side][i][alpha]), "{side} {i} {alpha}: {mirrored:?}");
        assert!(near(&lost, &LOST[side][i][alpha]), "{side} {i} {alpha}: {lost:?}");
        let average = dielectric_average(entry(alpha, ALPHA_CLEAR), ior_of(side, i));
        let lost = mean(|cos| dielectric_loss(cos, entry(alpha, ALPHA_CLEAR), ior_of(side, i)));
        assert!(close(average.lost, f32::from(lost) * UNIT, 2e-3), "{side} {i} {alpha}: {average:?} {lost}");
    }
}

#[test]
fn between_entries_tables_are_close_too() {
    for (cos, alpha) in [(0.9, 0.8), (0.5, 0.3), (0.3, 0.6), (0.07, 0.2), (0.02, 0.5)] {
        let (_, lost) = integrate(cos, alpha, None, 8192);
        assert!(close(mirror_loss(cos, alpha), lost as f32, 6e-3), "{cos} {alpha}: {lost}");
        for ior in [1.05, 1.5, 2.4, 1.0 / 1.33, 0.5] {
            let (mirrored, lost) = integrate(cos, alpha, Some(ior), 8192);
            assert!(
                close(dielectric_loss(cos, alpha, ior), lost as f32, 0.02),
                "{cos} {alpha} {ior}: {lost} {}",
                dielectric_loss(cos, alpha, ior)
            );
            let shown = dielectric_mirrored(cos, alpha, ior);
            assert!(close(shown, mirrored as f32, 0.03), "{cos} {alpha} {ior}: {mirrored} {shown}");
        }
    }
}
