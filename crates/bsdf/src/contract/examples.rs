//! Examples of all lobes.

use crate::metals::Metal;
use crate::{
    Bsdf, Conductor, ConeSampling, Dielectric, DiffuseTransmission, Fresnel, Lambert, OrenNayar, PhongParameters,
    Plastic, Sheen, ThinDielectric, ThinFilm,
};
use juggler_math::{Rgb, Vec2};

/// Width of lobes relative to the integration steps of the chi-squared test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Breadth {
    /// Narrower than the steps.
    Needle,
    /// Broad enough except at grazing angles.
    Narrow,
    /// Broad enough at any angle.
    Broad,
}

/// A BSDF with its expected properties.
pub(super) struct Example {
    pub name: String,
    pub bsdf: Bsdf,
    /// Whether the tests also view the BSDF from below.
    pub both_sides: bool,
    /// Allowed deviation of the albedo from 1 where no light is lost; 0 where light may be lost.
    pub white_within: f32,
    /// Width of its lobes.
    pub breadth: Breadth,
    /// Whether it scatters alike if light goes the other way. Brushed metal with multiple scattering
    /// does not: see `metals.rs`.
    pub is_reciprocal: bool,
}

impl Example {
    pub fn new(name: impl Into<String>, bsdf: impl Into<Bsdf>) -> Self {
        Self {
            name: name.into(),
            bsdf: bsdf.into(),
            both_sides: false,
            white_within: 0.0,
            breadth: Breadth::Broad,
            is_reciprocal: true,
        }
    }

    pub fn both_sides(self) -> Self {
        Self { both_sides: true, ..self }
    }

    pub fn white(self, within: f32) -> Self {
        Self { white_within: within, ..self }
    }

    /// Not reciprocal if its metal is `brushed`.
    pub fn one_way(self, brushed: bool) -> Self {
        Self { is_reciprocal: !brushed, ..self }
    }

    pub fn with_breadth(self, breadth: Breadth) -> Self {
        Self { breadth: self.breadth.min(breadth), ..self }
    }
}

/// Alpha along x and y: smooth, barely rough, polished, rough, roughest, and two brushed surfaces.
const ALPHAS: [(f32, f32); 7] =
    [(0.0, 0.0), (0.001, 0.001), (0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.6, 0.3), (0.5, 0.05)];

/// Examples of every lobe: smooth and rough, tinted and white, alone and in sums.
pub(super) fn examples() -> Vec<Example> {
    let mut all = vec![
        Example::new("nothing", Bsdf::new()),
        Example::new("lambert", Lambert { albedo: Rgb::new(0.7, 0.3, 0.1) }),
        Example::new("white lambert", Lambert { albedo: Rgb::WHITE }).white(1e-5),
    ];
    for (x, y) in ALPHAS {
        let breadth = match x.min(y) {
            least if least < 0.05 => Breadth::Needle,
            least if least < 0.2 => Breadth::Narrow,
            _ => Breadth::Broad,
        };
        let rough = |example: Example| example.with_breadth(breadth);
        all.extend(conductors(Vec2::new(x, y)).into_iter().map(rough));
        all.extend(dielectrics(Vec2::new(x, y)).into_iter().map(rough));
    }
    all.extend(sums());
    all.extend(diffuse());
    all.extend(plastics());
    all.extend(films());
    all.extend(classics());
    all.extend(super::principled::examples());
    let (reflectance, transmittance) = (Rgb::splat(0.6), Rgb::splat(0.4));
    let skin = DiffuseTransmission { reflectance, transmittance, ior: 1.4 };
    all.push(Example::new("white skin", skin).both_sides().white(1e-5));
    all
}

/// Allowed deviation of the albedo from 1, for a white conductor with compensation of multiple
/// scattering.
fn within(alpha: Vec2) -> f32 {
    if alpha.x == alpha.y { 0.015 } else { 0.03 }
}

fn conductors(alpha: Vec2) -> Vec<Example> {
    let gold = Metal::named("gold").unwrap().fresnel();
    let brushed = alpha.x != alpha.y;
    let tinted = Fresnel::tinted(Rgb::new(0.9, 0.6, 0.2), Rgb::new(0.7, 0.9, 1.0));
    vec![
        Example::new(format!("gold {alpha}"), Conductor::new(gold, alpha)),
        Example::new(format!("compensated gold {alpha}"), Conductor::compensated(gold, alpha)).one_way(brushed),
        Example::new(format!("tinted conductor {alpha}"), Conductor::compensated(tinted, alpha)).one_way(brushed),
        Example::new(format!("white conductor {alpha}"), Conductor::compensated(Fresnel::WHITE, alpha))
            .white(within(alpha))
            .one_way(brushed),
    ]
}

fn dielectrics(alpha: Vec2) -> Vec<Example> {
    let (cyan, pink) = (Rgb::new(0.5, 0.9, 0.9), Rgb::new(0.9, 0.6, 0.8));
    let tinted = Dielectric::new(1.5, alpha).tinted(pink, cyan);
    let mut all = vec![Example::new(format!("tinted glass {alpha}"), tinted)];
    let all_iors = [0.5, 1.0 / 1.33, 1.0, 1.01, 1.5, 2.4, 4.0];
    // Test all indices of refraction with three of the roughnesses, two indices with the others.
    let iors = if alpha.x == alpha.y && (alpha.x == 0.0 || alpha.x > 0.2) { &all_iors[..] } else { &all_iors[3..5] };
    for ior in iors.iter().copied() {
        let narrow = |example: Example| if ior == 1.01 { example.with_breadth(Breadth::Needle) } else { example };
        let compensated = Dielectric::compensated(ior, alpha);
        all.push(narrow(Example::new(format!("dielectric {ior} {alpha}"), Dielectric::new(ior, alpha))));
        let compensated = Example::new(format!("compensated dielectric {ior} {alpha}"), compensated);
        all.push(narrow(compensated.white(0.002)));
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

fn diffuse() -> Vec<Example> {
    let mut all = vec![];
    for roughness in [0.0, 0.3, 1.0] {
        let orange = OrenNayar::new(Rgb::new(0.9, 0.5, 0.1), roughness);
        all.push(Example::new(format!("rough diffuse {roughness}"), orange));
        all.push(Example::new(format!("white diffuse {roughness}"), OrenNayar::new(Rgb::WHITE, roughness)).white(0.01));
    }
    let leaf =
        DiffuseTransmission { reflectance: Rgb::new(0.1, 0.4, 0.1), transmittance: Rgb::new(0.2, 0.6, 0.0), ior: 1.0 };
    let paper = DiffuseTransmission { reflectance: Rgb::splat(0.6), transmittance: Rgb::splat(0.4), ior: 1.0 };
    all.push(Example::new("leaf", leaf).both_sides());
    all.push(Example::new("white paper", paper).both_sides().white(1e-5));
    for alpha in [0.0, 0.1, 0.4, 1.0] {
        all.push(Example::new(format!("sheen {alpha}"), Sheen::new(Rgb::new(0.9, 0.5, 1.0), alpha)));
    }
    all
}

fn plastics() -> Vec<Example> {
    let red = Plastic { albedo: Rgb::new(0.8, 0.2, 0.1), ..Plastic::default() };
    let white = Plastic { albedo: Rgb::WHITE, ..Plastic::default() };
    let mut all = vec![Example::new("tinted coat", Plastic { reflection: Rgb::new(1.0, 0.5, 0.2), ..red })];
    for alpha in [0.0, 0.3, 1.0] {
        let alpha = Vec2::splat(alpha);
        all.push(Example::new(format!("plastic {alpha}"), Plastic { alpha, ..red }));
        all.push(Example::new(format!("nonlinear plastic {alpha}"), Plastic { alpha, nonlinear: true, ..red }));
        all.push(Example::new(format!("white plastic {alpha}"), Plastic { alpha, ..white }).white(0.01));
        let rough = Plastic { alpha, nonlinear: true, base_roughness: 0.7, ior: 2.0, ..white };
        all.push(Example::new(format!("white rough plastic {alpha}"), rough).white(0.02));
    }
    all
}

fn films() -> Vec<Example> {
    let thin_film = ThinFilm { f0: Rgb::splat(0.04), ior: 1.3, thickness_nm: 400.0 };
    let soap = Fresnel::ThinFilm { thin_film, amount: 1.0 };
    let steel = Fresnel::ThinFilm {
        thin_film: ThinFilm { f0: Rgb::new(0.56, 0.57, 0.58), ior: 2.0, ..thin_film },
        amount: 0.7,
    };
    let smooth = Example::new("soap", Conductor::new(soap, Vec2::ZERO));
    let rough = [0.2, 0.7]
        .map(|alpha| Example::new(format!("steel {alpha}"), Conductor::compensated(steel, Vec2::splat(alpha))));
    rough.into_iter().chain([smooth]).collect()
}

fn classics() -> Vec<Example> {
    let black = PhongParameters::BLACK;
    let shiny =
        PhongParameters { diffuse: Rgb::new(0.7, 0.1, 0.1), specular: Rgb::splat(0.3), shininess: 20.0, ..black };
    let overbright = PhongParameters { mirror: Rgb::splat(0.5), specular: Rgb::WHITE, shininess: 3.0, ..shiny };
    let glass = PhongParameters {
        mirror: Rgb::WHITE,
        transparency: Rgb::new(0.9, 1.0, 0.9),
        ior: 1.5,
        fresnel: true,
        specular: Rgb::splat(0.5),
        shininess: 100.0,
        ..black
    };
    let window = PhongParameters {
        fresnel: false,
        mirror: Rgb::splat(0.2),
        transparency: Rgb::splat(0.8),
        specular: Rgb::BLACK,
        ..glass
    };
    let glossy =
        PhongParameters { mirror: Rgb::splat(0.9), glossy: ConeSampling { half_angle_radians: 0.9, rays: 1 }, ..black };
    vec![
        Example::new("shiny", Bsdf::with_lobes(|bsdf| shiny.add_lobes(true, bsdf))),
        Example::new(
            "diffuse highlight",
            Bsdf::with_lobes(|bsdf| PhongParameters { shininess: 0.0, ..shiny }.add_lobes(true, bsdf)),
        ),
        Example::new("overbright", Bsdf::with_lobes(|bsdf| overbright.add_lobes(true, bsdf))),
        Example::new("classic glass", Bsdf::with_lobes(|bsdf| glass.add_lobes(true, bsdf))),
        Example::new("classic glass from within", Bsdf::with_lobes(|bsdf| glass.add_lobes(false, bsdf))),
        Example::new("classic window", Bsdf::with_lobes(|bsdf| window.add_lobes(true, bsdf))).both_sides().white(1e-4),
        Example::new("glossy", Bsdf::with_lobes(|bsdf| glossy.add_lobes(true, bsdf))),
        Example::new(
            "glossy glass",
            Bsdf::with_lobes(|bsdf| PhongParameters { glossy: glossy.glossy, ..glass }.add_lobes(false, bsdf)),
        ),
    ]
}
