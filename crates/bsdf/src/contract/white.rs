//! White furnaces of the glTF material model over a grid of its parameters: mean energy of light
//! that hits a sphere from outside or from inside and leaves it, over all directions and any number
//! of internal reflections. `JUGGLER_FURNACES=all` (`check.sh deep furnaces`) takes more of the
//! grid and less noise.

use super::{energy_of, warp};
use crate::{Bsdf, Principled};
use juggler_math::testing::{Random, family_wise_deviations};
use juggler_math::{Rgb, Vec3};

/// Bounds of the mean energy of a surface that absorbs nothing.
const LEAST: f64 = 0.99;
const MOST: f64 = 1.002;

/// Energy of one particle that hits a sphere, from outside if `side` is 1 and from inside if it is
/// -1, when it leaves.
fn particle(bsdf: &Bsdf, side: f32, random: &mut Random) -> f64 {
    let (mut wo, mut energy) = (warp::cosine_hemisphere(random.vec2()), 1.0);
    wo.z *= side;
    for _ in 0..10_000 {
        let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { return 0.0 };
        energy *= f64::from(energy_of(&sample).g);
        if sample.wi.z > 0.0 {
            return energy;
        }
        // A chord of a sphere has the same angle of incidence at both ends.
        wo = Vec3::new(-sample.wi.x, -sample.wi.y, sample.wi.z);
    }
    0.0
}

/// Mean and standard error over as many particles as bring the latter down to `noise`, a million at
/// most.
fn mean_albedo(bsdf: &Bsdf, side: f32, noise: f64) -> (f64, f64) {
    let (mut random, mut count) = (Random::new(88), 0.0);
    let (mut sum, mut squares) = (0.0, 0.0);
    loop {
        for _ in 0..1000 {
            let energy = particle(bsdf, side, &mut random);
            (count, sum, squares) = (count + 1.0, sum + energy, squares + energy * energy);
        }
        let mean = sum / count;
        let sigma = ((squares / count - mean * mean).max(0.0) / count).sqrt();
        // Few particles underestimate their variance.
        if (sigma <= noise && count >= 3000.0) || count >= 1e6 {
            return (mean, sigma);
        }
    }
}

/// All combinations with the values of one parameter.
fn each(all: &[Principled], values: &[f32], set: impl Fn(&mut Principled, f32)) -> Vec<Principled> {
    let with = |base: &Principled, value: f32| {
        let mut numbers = *base;
        set(&mut numbers, value);
        numbers
    };
    all.iter().flat_map(|base| values.iter().map(|value| with(base, *value)).collect::<Vec<_>>()).collect()
}

/// Parameters that absorb no energy, in all combinations.
fn grid() -> Vec<Principled> {
    let mut all = vec![Principled { sheen_roughness: 0.5, ..Principled::default() }];
    all = each(&all, &[0.0, 0.5, 1.0], |base, metallic| base.metallic = metallic);
    all = each(&all, &[0.0, 0.4, 1.0], |base, transmission| base.transmission = transmission);
    all = each(&all, &[0.0, 0.15, 0.3, 0.55, 0.8, 1.0], |base, roughness| base.roughness = roughness);
    all = each(&all, &[0.0, 1.0], |base, clearcoat| base.clearcoat = clearcoat);
    all = each(&all, &[0.0, 1.0], |base, sheen| base.sheen_color = Rgb::splat(sheen));
    all = each(&all, &[0.0, 0.5], |base, through| base.diffuse_transmission = through);
    all = each(&all, &[0.0, 1.0], |base, thin| base.thin_walled = thin > 0.0);
    all = each(&all, &[0.0, 0.6], |base, anisotropy| base.anisotropy = anisotropy);
    all = each(&all, &[0.0, 0.5], |base, roughness| base.clearcoat_roughness = roughness);
    all = each(&all, &[1.5, 1.2, 2.0], |base, ior| base.ior = ior);
    all = each(&all, &[0.5, 0.2, 0.9], |base, roughness| base.sheen_roughness = roughness);
    all.retain(has_effect);
    all
}

/// Whether each parameter has an effect.
fn has_effect(numbers: &Principled) -> bool {
    let has_no_glass = numbers.transmission * (1.0 - numbers.metallic) == 0.0;
    !((numbers.metallic == 1.0 && (numbers.transmission > 0.0 || numbers.diffuse_transmission > 0.0))
        || (has_no_glass && numbers.thin_walled)
        || (numbers.transmission == 1.0 && numbers.diffuse_transmission > 0.0)
        || (numbers.roughness == 0.0 && numbers.anisotropy > 0.0)
        || (numbers.clearcoat == 0.0 && numbers.clearcoat_roughness > 0.0)
        || (numbers.sheen_color.is_black() && numbers.sheen_roughness != 0.5)
        || (numbers.metallic == 1.0 && numbers.ior != 1.5))
}

/// Surfaces and the sides from which light comes: above, and below where light can enter. Polished
/// glass traps some of the light in a sphere forever.
fn cases() -> Vec<(Principled, f32)> {
    // Steps coprime to the numbers of values.
    let step = if std::env::var_os("JUGGLER_FURNACES").is_some() { 23 } else { 251 };
    let from_both = |numbers: Principled| {
        let glass = numbers.transmission * (1.0 - numbers.metallic);
        let is_trap = numbers.transmission == 1.0 && numbers.roughness == 0.0 && !numbers.thin_walled;
        let is_open = glass.max(numbers.diffuse_transmission) > 0.0 && !is_trap;
        [Some((numbers, 1.0)), is_open.then_some((numbers, -1.0))]
    };
    grid().into_iter().step_by(step).flat_map(from_both).flatten().collect()
}

/// Failures among the cases, each with a standard error of `noise`; as many `deviations` are
/// allowed.
fn failures(cases: &[(Principled, f32)], noise: f64, deviations: f64) -> Vec<String> {
    let failure = |(numbers, side): &(Principled, f32)| {
        let bsdf = Bsdf::with_lobes(|bsdf| numbers.add_lobes(numbers.ior, bsdf));
        let (mean, sigma) = mean_albedo(&bsdf, *side, noise);
        let allowed = deviations * sigma;
        let is_wrong = mean < LEAST - allowed || mean > MOST + allowed || sigma > 3.0 * noise;
        is_wrong.then(|| format!("{mean:.4} ± {sigma:.4} from side {side}: {numbers:?}"))
    };
    cases.iter().filter_map(failure).collect()
}

#[test]
fn principled_conserves_energy_over_a_grid_of_its_weights() {
    let is_deep = std::env::var_os("JUGGLER_FURNACES").is_some();
    let (cases, noise) = (cases(), if is_deep { 0.001 } else { 0.004 });
    let deviations = family_wise_deviations(cases.len());
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let halves = cases.chunks(cases.len().div_ceil(2));
        let halves: Vec<_> = halves.map(|half| scope.spawn(move || failures(half, noise, deviations))).collect();
        halves.into_iter().flat_map(|half| half.join().unwrap()).collect()
    });
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), cases.len());
}
