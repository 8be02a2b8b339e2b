//! Tests of energy conservation, in white furnaces, and of reciprocity.

use super::*;

#[test]
fn scattered_energy_never_exceeds_incident_energy() {
    for Example { name, bsdf, both_sides, white_within, .. } in examples() {
        // Layers conserve energy only on average over all directions.
        let more = if name.contains("varnish") { 0.045 } else { ENERGY_TOLERANCE };
        for wo in views(both_sides) {
            let energy = furnace(&bsdf, wo, 64);
            assert!(energy.max_channel() <= 1.0 + more, "{name} {wo}: {energy:?}");
            if white_within > 0.0 {
                let least = energy.r.min(energy.g).min(energy.b);
                assert!(least >= 1.0 - white_within, "{name} {wo}: {energy:?}");
            }
        }
    }
}

#[test]
fn albedo_estimates_match_furnace_integrals() {
    for Example { name, bsdf, both_sides, .. } in examples() {
        for wo in views(both_sides) {
            let (energy, albedo) = (furnace(&bsdf, wo, 24), bsdf.albedo(wo));
            let rough_estimate = name.contains(" 1.01 ") || name.contains("0.5, 0.05");
            let near = if rough_estimate {
                0.2
            } else if wo.z.abs() < 0.2 {
                0.15
            } else {
                0.06
            };
            for (e, a) in energy.to_array().into_iter().zip(albedo.to_array()) {
                assert!((e - a).abs() < near, "{name} {wo}: {energy:?} {albedo:?}");
            }
        }
    }
}

#[test]
fn scattering_is_reciprocal() {
    let mut random = Random::new(91);
    for Example { name, bsdf, .. } in examples().into_iter().filter(|example| example.is_reciprocal) {
        let mut seen = 0;
        for _ in 0..if bsdf.is_specular() { 0 } else { 300 } {
            let (o, i) = (random.unit_vector(), random.unit_vector());
            let (there, back) = (bsdf.eval(o, i) / i.z.abs(), bsdf.eval(i, o) / o.z.abs());
            // Radiance divided by the squared index of refraction is reciprocal; a transmitted
            // sample reports the relative index.
            let scale = if o.z * i.z > 0.0 { 1.0 } else { relative_ior(&bsdf, o) };
            // If the relative index is near 1, the microfacet that refracts one direction into the
            // other is nearly edge-on, and rounding decides which side of it is visible.
            let least = if name.contains(" 1.01 ") { 5e-4 } else { 1e-5 };
            for (t, b) in (there * (scale * scale)).to_array().into_iter().zip(back.to_array()) {
                assert!(
                    (t - b).abs() <= 2e-3 * (t.abs() + b.abs()) + least,
                    "{name} {o} {i}: {there:?} {back:?} {scale}"
                );
                seen += i32::from(t > 0.0);
            }
        }
        assert!(seen > 0 || bsdf.is_specular(), "{name} is always black");
    }
}

/// Relative index of refraction: that on the side opposite to `wo`, divided by that on the side of
/// `wo`.
fn relative_ior(bsdf: &Bsdf, wo: Vec3) -> f32 {
    let mut random = Random::new(92);
    let mut find =
        |w: Vec3| (0..2000).find_map(|_| bsdf.sample(w, random.vec2(), random.f32()).filter(|s| s.is_transmitted(w)));
    // From the denser side, all light may be totally reflected.
    let ior = find(wo).map(|sample| sample.ior);
    let back = |sample: BsdfSample| 1.0 / sample.ior;
    ior.or_else(|| find(Vec3::new(0.0, 0.0, wo.z.signum())).map(|sample| sample.ior))
        .or_else(|| find(-wo).map(back))
        .unwrap_or(1.0)
}
