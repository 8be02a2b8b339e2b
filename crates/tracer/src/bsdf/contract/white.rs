//! White furnaces of the surface that glTF describes, over a grid of its weights: the energy of light that meets a ball and
//! leaves it, whatever happens inside, on average over all directions. With `JUGGLER_FURNACES=all` over the whole grid and with
//! more samples: `check.sh deep furnaces`.

use super::{energy_of, fun, warp};
use crate::bsdf::{Bsdf, Principled};
use juggler_math::testing::Random;
use juggler_math::{Rgb, Vec3};

/// Chance of a false alarm in all cases together.
const SIGNIFICANCE: f64 = 0.01;

/// The energy of one particle that meets a ball of radiance 1 from outside when it leaves again.
fn particle(bsdf: &Bsdf, random: &mut Random) -> f64 {
    let (mut wo, mut energy) = (warp::cosine_hemisphere(random.vec2()), 1.0);
    for _ in 0..10_000 {
        let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { return 0.0 };
        energy *= f64::from(energy_of(&sample).g);
        if sample.wi.z > 0.0 {
            return energy;
        }
        // A chord of a ball meets both ends at the same angle.
        wo = Vec3::new(-sample.wi.x, -sample.wi.y, sample.wi.z);
    }
    0.0
}

/// Mean and standard error.
fn ball(bsdf: &Bsdf, count: u32) -> (f64, f64) {
    let mut random = Random::new(88);
    let energies: Vec<f64> = (0..count).map(|_| particle(bsdf, &mut random)).collect();
    let mean = energies.iter().sum::<f64>() / f64::from(count);
    let squares = energies.iter().map(|energy| (energy - mean) * (energy - mean)).sum::<f64>();
    (mean, (squares / f64::from(count) / f64::from(count)).sqrt())
}

/// Weights that take no energy away, in all combinations.
fn grid() -> Vec<Principled> {
    let mut all = vec![Principled::default()];
    let mut each = |set: &dyn Fn(&Principled) -> Vec<Principled>| all = all.iter().flat_map(set).collect();
    each(&|base| [0.0, 0.5, 1.0].map(|metallic| Principled { metallic, ..*base }).into());
    each(&|base| [0.0, 0.4, 1.0].map(|transmission| Principled { transmission, ..*base }).into());
    each(&|base| [0.0, 0.3, 0.8].map(|roughness| Principled { roughness, ..*base }).into());
    each(&|base| [0.0, 1.0].map(|clearcoat| Principled { clearcoat, ..*base }).into());
    each(&|base| {
        [Rgb::BLACK, Rgb::WHITE].map(|sheen_color| Principled { sheen_color, sheen_roughness: 0.5, ..*base }).into()
    });
    each(&|base| [0.0, 0.5].map(|diffuse_transmission| Principled { diffuse_transmission, ..*base }).into());
    each(&|base| [false, true].map(|thin_walled| Principled { thin_walled, ..*base }).into());
    each(&|base| [0.0, 0.6].map(|anisotropy| Principled { anisotropy, ..*base }).into());
    each(&|base| [0.0, 0.5].map(|clearcoat_roughness| Principled { clearcoat_roughness, ..*base }).into());
    // What has no effect.
    all.retain(|numbers| {
        let is_glass = numbers.transmission * (1.0 - numbers.metallic) > 0.0;
        (numbers.metallic < 1.0 || numbers.transmission == 0.0 && numbers.diffuse_transmission == 0.0)
            && (is_glass || !numbers.thin_walled)
            && (numbers.transmission < 1.0 || numbers.diffuse_transmission == 0.0)
            && (numbers.roughness > 0.0 || numbers.anisotropy == 0.0)
            && (numbers.clearcoat > 0.0 || numbers.clearcoat_roughness == 0.0)
    });
    all
}

#[test]
fn principled_keeps_light_over_a_grid_of_its_weights() {
    let is_deep = std::env::var_os("JUGGLER_FURNACES").is_some();
    let (step, count) = if is_deep { (1, 40_000) } else { (7, 3000) };
    let cases: Vec<Principled> = grid().into_iter().step_by(step).collect();
    // Šidák's level, and Chernoff's bound on the tails of a normal distribution.
    let level = 1.0 - fun::pow_f64(1.0 - SIGNIFICANCE, 1.0 / cases.len() as f64);
    let deviations = (2.0 * fun::ln_f64(2.0 / level)).sqrt();
    let (mut least, mut most, mut wrong) = (f64::INFINITY, 0.0f64, vec![]);
    for numbers in &cases {
        let bsdf = Bsdf::with_lobes(|bsdf| numbers.add_lobes(numbers.ior, bsdf));
        let (mean, sigma) = ball(&bsdf, count);
        (least, most) = (least.min(mean), most.max(mean));
        let allowed = deviations * sigma;
        if mean < 0.99 - allowed || mean > 1.002 + allowed {
            wrong.push(format!("{mean:.4} ± {sigma:.4}: {numbers:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}, {least} to {most}: {wrong:#?}", wrong.len(), cases.len());
}
