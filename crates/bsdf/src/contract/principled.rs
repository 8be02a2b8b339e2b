//! Examples of the glTF material model, and its white furnaces.

use super::examples::Example;
use super::{ENERGY_TOLERANCE, furnace, views};
use crate::{Bsdf, Principled};
use juggler_math::Rgb;

fn lobes(numbers: &Principled, relative_ior: f32) -> Bsdf {
    Bsdf::with_lobes(|bsdf| numbers.add_lobes(relative_ior, bsdf))
}

pub(super) fn examples() -> Vec<Example> {
    let white = Principled::default();
    let red = Principled { base_color: Rgb::new(0.8, 0.2, 0.1), ..white };
    let opaque = [
        ("plastic", red),
        ("metal", Principled { metallic: 1.0, ..red }),
        ("half metal", Principled { metallic: 0.5, clearcoat: 0.5, clearcoat_roughness: 0.6, ..red }),
        ("varnish", Principled { clearcoat: 1.0, roughness: 0.8, ..red }),
        ("velvet", Principled { sheen_color: Rgb::new(0.9, 0.9, 1.0), sheen_roughness: 0.6, roughness: 0.9, ..red }),
        ("beetle", Principled { iridescence: 1.0, clearcoat: 0.7, metallic: 0.3, ..red }),
        ("brushed", Principled { anisotropy: 0.5, metallic: 0.8, specular_color: Rgb::new(0.5, 1.0, 0.2), ..red }),
        ("single", Principled { single_scattering: true, roughness: 1.0, metallic: 0.5, ..red }),
        ("everything on top", Principled { sheen_color: Rgb::WHITE, sheen_roughness: 0.3, clearcoat: 1.0, ..white }),
    ];
    let clear = [
        ("stained", Principled { transmission: 0.7, ..red }),
        ("bubble", Principled { transmission: 1.0, thin_walled: true, roughness: 0.0, iridescence: 1.0, ..white }),
        ("frosted bubble", Principled { transmission: 1.0, roughness: 0.6, iridescence: 0.8, ..white }),
        ("frosted pane", Principled { transmission: 0.8, roughness: 0.7, thin_walled: true, clearcoat: 0.5, ..white }),
        (
            "petal",
            Principled { diffuse_transmission: 0.6, diffuse_transmission_color: Rgb::new(0.9, 0.3, 0.5), ..white },
        ),
    ];
    let mut all: Vec<Example> = vec![];
    all.extend(opaque.map(|(name, numbers)| {
        Example::new(format!("principled {name}"), lobes(&numbers, 1.5)).one_way(numbers.anisotropy > 0.0)
    }));
    all.extend(
        clear.map(|(name, numbers)| Example::new(format!("principled {name}"), lobes(&numbers, 1.4)).both_sides()),
    );
    all.extend(whites());
    let glass = Principled { transmission: 1.0, ..white };
    all.push(Example::new("principled white glass", lobes(&glass, 1.5)).both_sides().white(0.02));
    let pane = Principled { thin_walled: true, ..glass };
    all.push(Example::new("principled white pane", lobes(&pane, 1.5)).both_sides().white(0.02));
    all
}

fn whites() -> Vec<Example> {
    let white = Principled::default();
    let whites = [
        ("diffuse", Principled { specular: 0.0, ..white }, 1e-4),
        ("plastic", white, 0.01),
        ("polished", Principled { roughness: 0.0, ..white }, 0.01),
        ("rough", Principled { roughness: 1.0, ..white }, 0.01),
        ("metal", Principled { metallic: 1.0, roughness: 0.8, ..white }, 0.01),
        ("half metal", Principled { metallic: 0.4, ..white }, 0.01),
        ("velvet", Principled { sheen_color: Rgb::WHITE, sheen_roughness: 0.7, specular: 0.0, ..white }, 0.02),
        // Scattering under a clearcoat loses some light.
        ("varnish", Principled { clearcoat: 1.0, ..white }, 0.03),
        ("varnished metal", Principled { clearcoat: 1.0, metallic: 1.0, ..white }, 0.12),
    ];
    let named = |(name, numbers, within): (&str, Principled, f32)| {
        Example::new(format!("principled white {name}"), lobes(&numbers, 1.5)).white(within)
    };
    whites.map(named).into()
}

/// Energy that a direction may gain under layers, which conserve energy on average over directions
/// only; see `sum.rs` and `white.rs`.
const LAYERED: f32 = 0.045;

/// White surfaces, and the least albedo of each at any roughness: glossy lobes under a layer lose
/// some light, mirrors under a diffuse layer more (see `sum.rs`), and so do anisotropic ones.
fn white_ones() -> Vec<(&'static str, Principled, f32)> {
    let white = Principled::default();
    let metal = Principled { metallic: 1.0, ..white };
    let varnished = |base: Principled, clearcoat_roughness| Principled { clearcoat: 1.0, clearcoat_roughness, ..base };
    let velvet = |base: Principled| Principled { sheen_color: Rgb::WHITE, sheen_roughness: 0.5, ..base };
    vec![
        ("diffuse", Principled { specular: 0.0, ..white }, 0.9999),
        ("plastic", white, 0.995),
        ("metal", metal, 0.995),
        ("half metal", Principled { metallic: 0.5, ..white }, 0.99),
        ("glass", Principled { transmission: 1.0, ..white }, 0.99),
        ("pane", Principled { transmission: 1.0, thin_walled: true, ..white }, 0.99),
        ("half glass", Principled { transmission: 0.5, ..white }, 0.99),
        ("petal", Principled { diffuse_transmission: 0.5, ..white }, 0.99),
        ("varnished glass", varnished(Principled { transmission: 1.0, ..white }, 0.0), 0.97),
        ("varnished half glass", varnished(Principled { transmission: 0.5, metallic: 0.3, ..white }, 0.0), 0.97),
        ("varnished plastic", varnished(white, 0.0), 0.985),
        ("roughly varnished plastic", varnished(white, 0.6), 0.99),
        ("varnished metal", varnished(metal, 0.0), 0.95),
        ("velvet", velvet(white), 0.99),
        ("velvet metal", velvet(metal), 0.885),
        ("brushed metal", Principled { anisotropy: 0.7, ..metal }, 0.97),
    ]
}

#[test]
fn white_principled_materials_pass_the_furnace_at_any_roughness() {
    for (name, base, least) in white_ones() {
        for roughness in [0.0, 0.1, 0.3, 0.5, 0.7, 0.85, 1.0] {
            let numbers = Principled { roughness, ..base };
            let bsdf = lobes(&numbers, 1.5);
            for wo in views(numbers.transmission + numbers.diffuse_transmission > 0.0) {
                let energy = furnace(&bsdf, wo, 64);
                let more =
                    if numbers.clearcoat > 0.0 || !numbers.sheen_color.is_black() { LAYERED } else { ENERGY_TOLERANCE };
                let near = energy.to_array().iter().all(|share| (least..=1.0 + more).contains(share));
                assert!(near, "{name}, {roughness}, {wo}: {energy:?}");
            }
        }
    }
}
