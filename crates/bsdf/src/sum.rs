//! The sum of some lobes, side by side or in layers.
//!
//! A layer T dims what was pushed after it, so that both together give no more light than there was. With T(μ) what it
//! leaves, one minus its albedo, a matt lobe is dimmed by T(μo) T(μi) / T̄ (the mean T̄ over all directions makes a white
//! one under it white), a mirror by the smaller of T(μo) and T(μi), which are the same. A glossy lobe is dimmed by
//! T(μo) T(μi) / √(A(μo) A(μi)), where A goes from T to T̄ by how much the lobe spreads light: the same as for a mirror and for
//! a matt lobe at either end. All are the same both ways, where glTF's dimming by T(μo) alone is not.
//!
//! What layers keep from leaving a surface that light also meets from below goes back there: see
//! [`below`]. Light that a turned shading normal would send below the geometric surface is spread
//! above it: see [`horizon`].

mod below;
mod horizon;

use super::{BsdfSample, Lobe, Scatter};
use arrayvec::ArrayVec;
use below::Role;
use horizon::Horizon;
use juggler_math::{Rgb, Vec2, Vec3};

/// Lobes in one [`Bsdf`].
pub const MAX_LOBES: usize = 9;

/// Deltas in one [`Bsdf`]: a lobe has two at most.
pub const MAX_DELTAS: usize = 2 * MAX_LOBES;

/// What happens to light at one point of a surface: the sum of some lobes.
#[derive(Clone, Debug, Default)]
pub struct Bsdf {
    lobes: ArrayVec<Weighted, MAX_LOBES>,
    /// The geometric surface, where a map has turned the shading normal away from its normal.
    horizon: Option<Horizon>,
}

/// A lobe and its share.
#[derive(Clone, Copy, Debug)]
struct Weighted {
    weight: f32,
    /// Of a lobe in layers that spreads light: 1 / T̄. Of a returning one: m̄.
    scale: f32,
    /// How much of what comes below it dims: 0 of what is no layer.
    cover: f32,
    /// Of a glossy lobe in layers: how much of it spreads light like a matt one, 0 to 1. Of a returning one: the even share of h.
    spread: f32,
    role: Role,
    lobe: Lobe,
}

impl Weighted {
    #[inline]
    fn new(lobe: impl Into<Lobe>, weight: f32) -> Self {
        Self { weight, scale: 1.0, cover: 0.0, spread: 0.0, role: Role::Upright, lobe: lobe.into() }
    }

    /// What it leaves to those below of light along `w`.
    #[inline]
    fn leaves(&self, w: Vec3) -> f32 {
        if self.cover == 0.0 || w.z <= 0.0 {
            return 1.0;
        }
        (1.0 - self.cover * self.lobe.albedo(w).max_channel()).max(0.0)
    }

    /// What layers over it leave, by what they leave along both directions.
    #[inline]
    fn dimmed(&self, wo: Vec3, wi: Vec3, left_o: f32, left_i: f32) -> f32 {
        if self.role != Role::Upright {
            return 1.0;
        }
        match (self.lobe.is_matt(), wo.z > 0.0 && wi.z > 0.0) {
            (false, true) if self.spread > 0.0 => {
                let around = |left: f32| left + self.spread * (1.0 / self.scale - left);
                left_o * left_i / (around(left_o) * around(left_i)).max(f32::MIN_POSITIVE).sqrt()
            }
            (false, _) => left_o.min(left_i),
            (true, true) => left_o * left_i * self.scale,
            (true, false) => left_o * left_i,
        }
    }
}

impl<L: Into<Lobe>> From<L> for Bsdf {
    #[inline]
    fn from(lobe: L) -> Self {
        let mut bsdf = Self::new();
        bsdf.push(lobe);
        bsdf
    }
}

impl Bsdf {
    /// Without lobes: absorbs all light.
    #[inline(always)]
    pub fn new() -> Self {
        Self { lobes: ArrayVec::new(), horizon: None }
    }

    /// The lobes that `add` pushes.
    #[inline]
    pub fn with_lobes(add: impl FnOnce(&mut Self)) -> Self {
        let mut bsdf = Self::new();
        add(&mut bsdf);
        bsdf
    }

    /// Adds a lobe. Who adds several side by side sees to it that they give no more light than there was. More than
    /// [`MAX_LOBES`] are left out.
    #[inline]
    pub fn push(&mut self, lobe: impl Into<Lobe>) {
        self.push_scaled(lobe, 1.0);
    }

    /// Adds `weight`, 0 to 1, of a lobe; none of it at 0.
    #[inline]
    pub fn push_scaled(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(Weighted::new(lobe, weight));
    }

    /// Adds `weight`, 0 to 1, of a lobe that lies over those to come and dims them.
    #[inline]
    pub fn push_layer(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(Weighted { cover: weight, ..Weighted::new(lobe, weight) });
    }

    /// Adds a lobe that dims those to come by `cover` times its albedo.
    #[inline]
    pub fn push_dimmed_layer(&mut self, lobe: impl Into<Lobe>, cover: f32) {
        self.push_any(Weighted { cover, ..Weighted::new(lobe, 1.0) });
    }

    /// Adds `weight` of a lobe that wholly dims those to come: they are part of the same share of the surface.
    #[inline]
    pub fn push_coat(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(Weighted { cover: 1.0, ..Weighted::new(lobe, weight) });
    }

    #[inline]
    fn push_any(&mut self, mut lobe: Weighted) {
        if lobe.weight > 0.0 {
            if lobe.role == Role::Upright && self.lobes.iter().any(|one| one.cover > 0.0) {
                lobe.spread = if lobe.cover > 0.0 { 0.0 } else { lobe.lobe.spread() };
                if lobe.lobe.is_matt() || lobe.spread > 0.0 {
                    lobe.scale = 1.0 / self.mean_left().max(1e-3);
                }
            }
            let full = self.lobes.try_push(lobe);
            debug_assert!(full.is_ok(), "more than {MAX_LOBES} lobes");
        }
    }

    /// Takes away what scatters in such ways; layers dim what is below them all the same.
    pub fn mute(&mut self, is_muted: impl Fn(Scatter) -> bool) {
        self.lobes.iter_mut().filter(|one| is_muted(one.lobe.scatter())).for_each(|one| one.weight = 0.0);
    }

    /// What all layers leave of even light.
    fn mean_left(&self) -> f32 {
        let is_stretched = self.lobes.iter().any(|one| one.cover > 0.0 && one.lobe.is_stretched());
        mean(is_stretched, |w| self.lobes.iter().fold(1.0, |left, one| left * one.leaves(w)))
    }

    /// The sum of f |cos θi|, without deltas.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    /// The density of [`Bsdf::sample`] at `wi`, per steradian, without deltas.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] in one go.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match &self.horizon {
            None => self.eval_pdf_of_lobes(wo, wi),
            Some(horizon) => self.eval_pdf_above(horizon, wo, wi),
        }
    }

    #[inline]
    fn eval_pdf_of_lobes(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match self.lobes.as_slice() {
            [] => (Rgb::BLACK, 0.0),
            [one] => {
                let (value, pdf) = self.eval_pdf_of_one(one, wo, wi);
                (value * one.weight, pdf)
            }
            _ => self.eval_pdf_of_many(&self.shares(wo), wo, wi, None),
        }
    }

    /// A direction where light may come from, by a point in the unit square; `None` if it is absorbed. The lobe (and
    /// what may happen within it) is chosen by `u.x`, which is stretched to the unit interval again; what a microfacet
    /// of rough glass does, by `choice` in [0, 1), which counts only where [`Bsdf::has_choice`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        match &self.horizon {
            None => self.sample_of_lobes(wo, u, choice),
            Some(horizon) => self.sample_above(horizon, wo, u, choice),
        }
    }

    #[inline]
    fn sample_of_lobes(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        match self.lobes.as_slice() {
            [] => None,
            [one] => {
                let sample = self.sample_of_one(one, wo, u, choice)?;
                Some(BsdfSample { weight: sample.weight * one.weight, ..sample })
            }
            _ => self.sample_one_of_many(wo, u, choice),
        }
    }

    fn sample_one_of_many(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        let shares = self.shares(wo);
        let mut rest = u.x;
        // Rounding may leave a rest at the end, which the last lobe with a share takes.
        let mut picked = None;
        for (index, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            picked = Some((index, *share, (rest / share).clamp(0.0, 1f32.next_down())));
            if rest < *share {
                break;
            }
            rest -= share;
        }
        let (index, share, x) = picked?;
        let one = self.lobes.get(index)?;
        let u = Vec2::new(x, u.y);
        let returning = self.returning(index).filter(|_| wo.z < 0.0);
        let sample = match returning {
            Some(returning) => self.sample_under_layers(index, returning, wo, u, choice)?,
            None => self.sample_of_one(one, wo, u, choice)?,
        };
        if sample.scatter == Scatter::Specular {
            let weight = sample.weight * (one.weight * self.dimming(index, wo, sample.wi) / share);
            return Some(BsdfSample { weight, pdf: sample.pdf * share, ..sample });
        }
        let own = (index, (sample.weight * sample.pdf, sample.pdf));
        let (value, pdf) = self.eval_pdf_of_many(&shares, wo, sample.wi, returning.is_none().then_some(own));
        (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, pdf, ..sample })
    }

    /// Whether [`Bsdf::sample`] asks for a third number.
    #[inline]
    pub fn has_choice(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.has_choice())
    }

    /// The sum over all lobes; one may be `known`.
    fn eval_pdf_of_many(
        &self,
        shares: &[f32; MAX_LOBES],
        wo: Vec3,
        wi: Vec3,
        known: Option<(usize, (Rgb, f32))>,
    ) -> (Rgb, f32) {
        let (mut value, mut density) = (Rgb::BLACK, 0.0);
        let (mut left_o, mut left_i) = (1.0, 1.0);
        for (index, (one, share)) in self.lobes.iter().zip(shares).enumerate() {
            let (part, pdf) = match known {
                Some((same, known)) if same == index => known,
                _ => self.eval_pdf_of_one(one, wo, wi),
            };
            let dimming = one.dimmed(wo, wi, left_o, left_i);
            value += part * (one.weight * dimming);
            density += match one.role.glass().and_then(|glass| shares.get(glass)) {
                Some(share) => pdf * share,
                // Some samples of the glass become samples of the lobe that returns light below.
                None if wo.z < 0.0 && wi.z > 0.0 && self.returning(index).is_some() => pdf * share * dimming,
                None => pdf * share,
            };
            if one.cover > 0.0 {
                (left_o, left_i) = (left_o * one.leaves(wo), left_i * one.leaves(wi));
            }
        }
        (value, density)
    }

    /// What the layers over a lobe leave of it.
    fn dimming(&self, index: usize, wo: Vec3, wi: Vec3) -> f32 {
        let over = self.lobes.iter().take(index);
        let (left_o, left_i) = over.fold((1.0, 1.0), |(o, i), one| (o * one.leaves(wo), i * one.leaves(wi)));
        self.lobes.get(index).map_or(0.0, |one| one.dimmed(wo, wi, left_o, left_i))
    }

    /// The probability of each lobe; all 0 where none gives light.
    fn shares(&self, wo: Vec3) -> [f32; MAX_LOBES] {
        let mut shares = [0.0; MAX_LOBES];
        let (mut sum, mut left) = (0.0, 1.0);
        for (share, one) in shares.iter_mut().zip(&self.lobes) {
            let albedo = self.albedo_of_one(one, wo);
            *share = super::lobe::sum(albedo) * one.weight * left;
            sum += *share;
            if one.cover > 0.0 && wo.z > 0.0 {
                left *= (1.0 - one.cover * albedo.max_channel()).max(0.0);
            }
        }
        if sum > 0.0 {
            shares.iter_mut().for_each(|share| *share /= sum);
        }
        shares
    }

    /// The share of the light along `wo`, were it sent in from there, that comes out again anywhere (without the scale
    /// of radiance that crosses a border): an estimate within a few percent, for denoisers and picking lobes.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        let mut left = 1.0;
        self.lobes.iter().fold(Rgb::BLACK, |sum, one| {
            let sum = sum + self.albedo_of_one(one, wo) * (one.weight * left);
            left *= one.leaves(wo);
            sum
        })
    }

    /// Whether there are only deltas, or nothing at all: lights need not be asked.
    #[inline]
    pub fn is_specular(&self) -> bool {
        self.lobes.iter().all(|one| one.lobe.is_specular())
    }

    /// Whether there is any lobe that is neither matt nor a delta.
    #[inline]
    pub fn is_glossy(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.scatter() == Scatter::Glossy)
    }

    /// How most of what is no delta is scattered.
    pub fn scatter(&self) -> Scatter {
        let spread = self.lobes.iter().filter(|one| !one.lobe.is_specular());
        let most = spread.max_by(|a, b| a.weight.total_cmp(&b.weight));
        most.map_or(Scatter::Specular, |one| one.lobe.scatter())
    }

    /// Whether there is any delta.
    #[inline]
    pub fn has_specular(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.is_specular())
    }

    /// Every delta with its full weight, not divided by a probability; `pdf` is 1.
    pub fn deltas(&self, wo: Vec3) -> ArrayVec<BsdfSample, MAX_DELTAS> {
        let mut deltas = ArrayVec::new();
        for (index, one) in self.lobes.iter().enumerate().filter(|(_, one)| one.lobe.is_specular()) {
            for delta in self.deltas_of_one(one, wo) {
                let weight = one.weight * self.dimming(index, wo, delta.wi);
                let delta = self.delta_above(BsdfSample { weight: delta.weight * weight, ..delta });
                let full = deltas.try_push(delta);
                debug_assert!(full.is_ok(), "more than {MAX_DELTAS} deltas");
            }
        }
        deltas
    }
}

/// The mean over directions above, each weighted by its cosine, of a function of the cosine: ∫ 2 μ f(μ) dμ = ∫ 4 s³ f(s²) ds
/// by Gauss and Legendre's five places. A function that also depends on the azimuth, as stretched surfaces do, is taken at
/// 22.5 and 67.5 degrees, others at 45.
fn mean(is_stretched: bool, of: impl Fn(Vec3) -> f32) -> f32 {
    const PLACES: [(f32, f32); 5] = [
        (0.046_910_077, 0.118_463_44),
        (0.230_765_34, 0.239_314_34),
        (0.5, 0.284_444_45),
        (0.769_234_66, 0.239_314_34),
        (0.953_089_9, 0.118_463_44),
    ];
    // Squares of the cosine of 45 and of 22.5 degrees.
    let (near, scale) = if is_stretched { (0.853_553_4, 0.5) } else { (0.5, 1.0) };
    PLACES.iter().fold(0.0, |sum, (s, weight)| {
        let cos = s * s;
        let sin2 = 1.0 - cos * cos;
        let (x, y) = ((sin2 * near).max(0.0).sqrt(), (sin2 * (1.0 - near)).max(0.0).sqrt());
        let mut value = of(Vec3::new(x, y, cos));
        if is_stretched {
            value += of(Vec3::new(y, x, cos));
        }
        sum + weight * 4.0 * s * cos * value * scale
    })
}
