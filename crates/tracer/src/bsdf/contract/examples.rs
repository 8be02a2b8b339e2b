//! The list of examples.

use crate::bsdf::metals::Metal;
use crate::bsdf::{Bsdf, Conductor, Dielectric, Fresnel, Lambert, ThinDielectric};
use juggler_math::{Rgb, Vec2};

/// One of the list.
pub(super) struct Example {
    pub name: String,
    pub bsdf: Bsdf,
    /// Whether it is seen from below too.
    pub both_sides: bool,
    /// Whether no light at all is lost: a number is by how much it may miss, 0 for those that may lose light.
    pub white_within: f32,
    /// Whether chi-squared cells are finer than its lobes.
    pub is_broad: bool,
}

impl Example {
    fn new(name: impl Into<String>, bsdf: impl Into<Bsdf>) -> Self {
        Self { name: name.into(), bsdf: bsdf.into(), both_sides: false, white_within: 0.0, is_broad: true }
    }

    fn both_sides(self) -> Self {
        Self { both_sides: true, ..self }
    }

    fn white(self, within: f32) -> Self {
        Self { white_within: within, ..self }
    }

    fn narrow(self) -> Self {
        Self { is_broad: false, ..self }
    }
}

/// Roughnesses, alpha along x and y: smooth, hardly not, polished, rough, extremely, brushed.
const ALPHAS: [(f32, f32); 7] =
    [(0.0, 0.0), (0.001, 0.001), (0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.6, 0.3), (0.5, 0.05)];

/// Every lobe in every kind of use.
pub(super) fn examples() -> Vec<Example> {
    let mut all = vec![
        Example::new("nothing", Bsdf::new()),
        Example::new("lambert", Lambert { albedo: Rgb::new(0.7, 0.3, 0.1) }),
        Example::new("white lambert", Lambert { albedo: Rgb::WHITE }).white(1e-5),
    ];
    for (x, y) in ALPHAS {
        let rough = |example: Example| if x.min(y) < 0.2 { example.narrow() } else { example };
        all.extend(conductors(Vec2::new(x, y)).into_iter().map(rough));
        all.extend(dielectrics(Vec2::new(x, y)).into_iter().map(rough));
    }
    all.extend(sums());
    all
}

/// How far a compensated lobe may miss white: brushed ones are compensated by one alpha for both axes.
fn within(alpha: Vec2) -> f32 {
    if alpha.x == alpha.y { 0.02 } else { 0.12 }
}

fn conductors(alpha: Vec2) -> Vec<Example> {
    let gold = Metal::named("gold").unwrap().fresnel();
    let tinted = Fresnel::tinted(Rgb::new(0.9, 0.6, 0.2), Rgb::new(0.7, 0.9, 1.0));
    vec![
        Example::new(format!("gold {alpha}"), Conductor::new(gold, alpha)),
        Example::new(format!("compensated gold {alpha}"), Conductor::compensated(gold, alpha)),
        Example::new(format!("tinted conductor {alpha}"), Conductor::compensated(tinted, alpha)),
        Example::new(format!("white conductor {alpha}"), Conductor::compensated(Fresnel::WHITE, alpha))
            .white(within(alpha)),
    ]
}

fn dielectrics(alpha: Vec2) -> Vec<Example> {
    let (cyan, pink) = (Rgb::new(0.5, 0.9, 0.9), Rgb::new(0.9, 0.6, 0.8));
    let tinted = Dielectric::new(1.5, alpha).tinted(pink, cyan);
    let mut all = vec![Example::new(format!("tinted glass {alpha}"), tinted)];
    for ior in [0.5, 1.0 / 1.33, 1.0, 1.01, 1.5, 2.4, 4.0] {
        let narrow = |example: Example| if ior == 1.01 { example.narrow() } else { example };
        let compensated = Dielectric::compensated(ior, alpha);
        all.push(narrow(Example::new(format!("dielectric {ior} {alpha}"), Dielectric::new(ior, alpha))));
        let compensated = Example::new(format!("compensated dielectric {ior} {alpha}"), compensated);
        // At 1.01 the critical angle grazes; there the tables are too coarse for white.
        all.push(narrow(compensated.white(within(alpha) * if ior == 1.01 { 0.0 } else { 1.0 })));
    }
    all.push(Example::new(format!("thin {alpha}"), ThinDielectric::new(1.5, alpha).tinted(pink, cyan)));
    let thin = ThinDielectric::compensated(1.5, alpha);
    all.push(Example::new(format!("compensated thin {alpha}"), thin).white(within(alpha)));
    all.into_iter().map(Example::both_sides).collect()
}

fn sums() -> Vec<Example> {
    let mut patchy = Bsdf::new();
    patchy.push_scaled(Lambert { albedo: Rgb::new(0.9, 0.5, 0.1) }, 0.5);
    patchy.push_scaled(Conductor::new(Fresnel::WHITE, Vec2::splat(0.4)), 0.3);
    patchy.push_scaled(Dielectric::new(1.5, Vec2::splat(0.5)), 0.2);
    let mut waxed = Bsdf::new();
    waxed.push_scaled(Lambert { albedo: Rgb::splat(0.8) }, 0.6);
    waxed.push_scaled(Conductor::new(Fresnel::WHITE, Vec2::ZERO), 0.1);
    waxed.push_scaled(ThinDielectric::new(1.3, Vec2::ZERO), 0.3);
    vec![Example::new("patchy", patchy).both_sides(), Example::new("waxed", waxed).both_sides()]
}
