//! Closed forms of light transport.

use juggler_math::{DVec3, Vec3};
use std::f64::consts::PI;

/// Irradiance at the origin on a surface with unit normal `normal`, from a polygon of radiance 1
/// that lies above its horizon: half the sum over the edges of the angle that the edge subtends
/// times the cosine between the edge plane's normal and `normal` (Lambert 1760).
pub fn polygon(corners: &[Vec3], normal: Vec3) -> f64 {
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3().normalize()).collect();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let sum: f64 = edges
        .map(|(a, b)| a.dot(*b).clamp(-1.0, 1.0).acos() * a.cross(*b).normalize_or_zero().dot(normal.as_dvec3()))
        .sum();
    0.5 * sum.abs()
}

/// Irradiance at the origin on a horizontal floor, from a rectangle of radiance 1 around `center`.
pub fn rectangle(center: Vec3, edges: [Vec3; 2]) -> f64 {
    let [a, b] = edges.map(|edge| edge * 0.5);
    polygon(&[center - a - b, center + a - b, center + a + b, center - a + b], Vec3::Y)
}

/// The integral of `value` over 0..1 by Simpson's rule.
pub fn integral(value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let at = |i: u32| value(f64::from(i) / f64::from(STEPS));
    let weight = |i: u32| if i == 0 || i == STEPS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=STEPS).map(|i| weight(i) * at(i)).sum::<f64>() / f64::from(3 * STEPS)
}

/// Fresnel reflectance for unpolarized light at an interface of relative index of refraction `ior`.
pub fn fresnel(cos: f64, ior: f64) -> f64 {
    let inside = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
    let across = (cos - ior * inside) / (cos + ior * inside);
    let along = (ior * cos - inside) / (ior * cos + inside);
    0.5 * (across * across + along * along)
}

/// Reflectance and transmittance of a stack of layers, with multiple reflections between the layers
/// and without interference. `layers` holds the reflectance and transmittance of each layer, equal
/// from both sides.
pub fn stack(layers: &[[f64; 2]]) -> [f64; 2] {
    let [reflected, through, _] = layers.iter().fold([0.0, 1.0, 0.0], add);
    [reflected, through]
}

/// Adds a layer below a stack, given by its reflectance from above, transmittance, and reflectance
/// from below.
fn add([above, through, below]: [f64; 3], [reflected, passed]: &[f64; 2]) -> [f64; 3] {
    let again = 1.0 / (1.0 - below * reflected);
    [
        above + through * through * reflected * again,
        through * passed * again,
        reflected + passed * passed * below * again,
    ]
}

#[test]
fn formulas_agree_with_each_other() {
    // Form factor to a corner of a parallel rectangle (Howell, A Catalog of Radiation Heat Transfer
    // Configuration Factors, B-3).
    let (x, y) = (2.0f64 / 1.5, 0.7f64 / 1.5);
    let part = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    let published = (part(x, y) + part(y, x)) / (2.0 * PI);
    let ours = rectangle(Vec3::new(1.0, 1.5, 0.35), [Vec3::X * 2.0, Vec3::Z * 0.7]) / PI;
    assert!((ours - published).abs() < 1e-6, "{ours} {published}");
    let pane = fresnel(0.6, 1.5);
    let [reflected, through] = stack(&[[pane, 1.0 - pane], [pane, 1.0 - pane]]);
    assert!((reflected + through - 1.0).abs() < 1e-12 && (through - (1.0 - pane) / (1.0 + pane)).abs() < 1e-12);
    assert!((integral(|x| x * x) - 1.0 / 3.0).abs() < 1e-9);
}
