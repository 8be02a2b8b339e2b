//! Material model of glTF 2.0: metallic-roughness (Burley 2012), with the extensions clearcoat,
//! transmission, volume (its interface), ior, specular, sheen, anisotropy, iridescence and
//! diffuse_transmission.
//!
//! From top to bottom: clearcoat, sheen, and a weighted sum of metal, glass and plastic. Light from
//! below meets the same sum: metal, glass, and plastic's base without its coat. Parameters have the
//! meaning that glTF gives them. Where its formulas are not reciprocal or lose light, these are
//! used instead:
//!
//! - layers attenuate lower layers as [`Bsdf`] does, not by the viewer's side alone, and light that
//!   they keep from leaving glass goes back into it;
//! - rough surfaces include multiple scattering, unless `single_scattering`;
//! - glass uses Fresnel's exact equations, and thin-walled glass includes reflections between its
//!   two interfaces;
//! - for glass, `specular` and `specular_color` scale the reflectance at every angle, and total
//!   reflection inside a solid keeps all light; see [`SpecularWeight`].

use super::fresnel::f0_from_ior;
use super::thin_film::ThinFilm;
use super::{
    Bsdf, Conductor, Dielectric, DiffuseTransmission, Fresnel, Lambert, Sheen, SpecularWeight, ThinDielectric,
    TiltedConductor,
};
use juggler_math::{Rgb, Vec2, Vec3};

/// Parameters of the model; all weights, roughnesses and color channels are from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// Reflectance of metal at normal incidence, albedo of plastic's base, and transmittance of
    /// glass.
    pub base_color: Rgb,
    /// Weight of metal.
    pub metallic: f32,
    /// Square root of [`Ggx`](super::ggx::Ggx)'s alpha.
    pub roughness: f32,
    /// Weight of plastic's specular reflection.
    pub specular: f32,
    /// Color of plastic's specular reflection at normal incidence.
    pub specular_color: Rgb,
    /// Index of refraction of plastic, and of thin-walled glass, in air. 0 gives plastic a
    /// reflectance of `specular_color` at normal incidence, and glass no refraction.
    pub ior: f32,
    /// Weight of glass in the nonmetallic part.
    pub transmission: f32,
    /// Whether glass is a thin sheet, which transmits in a straight line, instead of the interface
    /// of a solid.
    pub thin_walled: bool,
    /// Strength of anisotropy: 0 is isotropic, 1 raises alpha along x to 1.
    pub anisotropy: f32,
    /// Weight of the clearcoat.
    pub clearcoat: f32,
    /// Roughness of the clearcoat.
    pub clearcoat_roughness: f32,
    /// Index of refraction of the clearcoat; 1.5 in glTF.
    pub clearcoat_ior: f32,
    /// Unit normal of the clearcoat, in the shading frame.
    pub clearcoat_normal: Vec3,
    /// Color of the sheen; black for none.
    pub sheen_color: Rgb,
    /// Roughness of the sheen.
    pub sheen_roughness: f32,
    /// Fraction of the surface that a thin film covers.
    pub iridescence: f32,
    /// Index of refraction of the film.
    pub iridescence_ior: f32,
    /// Thickness of the film in nanometers.
    pub iridescence_thickness_nm: f32,
    /// Fraction of the base's diffuse light that is transmitted.
    pub diffuse_transmission: f32,
    /// Color of transmitted diffuse light.
    pub diffuse_transmission_color: Rgb,
    /// Whether light may come from below, through this point of the surface or another.
    pub is_open: bool,
    /// Whether some light is refracted into the solid, through this point of the surface or
    /// another.
    pub is_refracting: bool,
    /// Leaves out multiple scattering between microfacets, as most other renderers do.
    pub single_scattering: bool,
}

impl Default for Principled {
    fn default() -> Self {
        Self {
            base_color: Rgb::WHITE,
            metallic: 0.0,
            roughness: 0.5,
            specular: 1.0,
            specular_color: Rgb::WHITE,
            ior: 1.5,
            transmission: 0.0,
            thin_walled: false,
            anisotropy: 0.0,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            clearcoat_ior: 1.5,
            clearcoat_normal: Vec3::Z,
            sheen_color: Rgb::BLACK,
            sheen_roughness: 0.0,
            iridescence: 0.0,
            iridescence_ior: 1.3,
            iridescence_thickness_nm: 400.0,
            diffuse_transmission: 0.0,
            diffuse_transmission_color: Rgb::WHITE,
            is_open: false,
            is_refracting: false,
            single_scattering: false,
        }
    }
}

impl Principled {
    /// Adds the lobes to `bsdf`. `relative_ior` is the index of refraction below the surface (-z)
    /// over that above, for glass that is not thin-walled: the material's `ior` where air is above.
    pub fn add_lobes(&self, relative_ior: f32, bsdf: &mut Bsdf) {
        if self.clearcoat > 0.0 {
            let fresnel = Fresnel::Dielectric { ior: self.clearcoat_ior, color: Rgb::WHITE };
            let alpha = self.clearcoat_roughness * self.clearcoat_roughness;
            let coat = self.mirror(fresnel, Vec2::splat(alpha));
            if self.clearcoat_normal == Vec3::Z {
                bsdf.push_layer(coat, self.clearcoat);
            } else {
                bsdf.push_layer(TiltedConductor::new(coat, self.clearcoat_normal), self.clearcoat);
            }
        }
        if !self.sheen_color.is_black() {
            let sheen = Sheen::new(self.sheen_color, self.sheen_roughness * self.sheen_roughness);
            bsdf.push_partial_layer(sheen, self.covered());
        }
        let (metal, rest) = (self.metallic, 1.0 - self.metallic);
        let (glass, plastic) = (rest * self.transmission, rest * (1.0 - self.transmission));
        let is_open = self.is_open || glass > 0.0 || plastic * self.diffuse_transmission > 0.0;
        if metal > 0.0 {
            let fresnel = self.with_film(Fresnel::tinted(self.base_color, Rgb::WHITE), self.base_color);
            bsdf.push_scaled(self.mirror(fresnel, self.alpha()), metal);
            if is_open {
                bsdf.push_below(self.mirror(fresnel, self.alpha()), metal);
            }
        }
        if glass > 0.0 {
            self.push_glass(bsdf, relative_ior, glass);
        }
        if plastic > 0.0 {
            let is_refracting = (self.is_refracting || glass > 0.0) && !self.thin_walled;
            self.push_plastic(bsdf, plastic, is_open, if is_refracting { relative_ior } else { 1.0 });
        }
    }

    /// Fraction of the sheen's albedo that it takes from lower layers: sheen scatters light to
    /// angles at which the clearcoat transmits less, and the missing energy is left to lower
    /// layers. Fitted to a white furnace.
    fn covered(&self) -> f32 {
        let polished = 1.0 - self.clearcoat_roughness;
        1.0 - self.clearcoat * (0.015 + 0.045 * polished * polished)
    }

    /// Alpha along x and y, by KHR_materials_anisotropy.
    pub fn alpha(&self) -> Vec2 {
        let alpha = self.roughness * self.roughness;
        Vec2::new(alpha + (1.0 - alpha) * self.anisotropy * self.anisotropy, alpha)
    }

    /// Reflectance of plastic at normal incidence, by KHR_materials_specular.
    fn dielectric_f0(&self) -> Rgb {
        (self.specular_color * f0_from_ior(self.ior)).map(|f0| f0.min(1.0)) * self.specular
    }

    fn mirror(&self, fresnel: Fresnel, alpha: Vec2) -> Conductor {
        if self.single_scattering { Conductor::new(fresnel, alpha) } else { Conductor::compensated(fresnel, alpha) }
    }

    fn thin_film(&self, f0: Rgb) -> Option<(ThinFilm, f32)> {
        let thin_film = ThinFilm { f0, ior: self.iridescence_ior, thickness_nm: self.iridescence_thickness_nm };
        (self.iridescence > 0.0 && self.iridescence_thickness_nm > 0.0).then_some((thin_film, self.iridescence))
    }

    fn with_film(&self, fresnel: Fresnel, f0: Rgb) -> Fresnel {
        self.thin_film(f0).map_or(fresnel, |(thin_film, amount)| Fresnel::ThinFilm { thin_film, amount })
    }

    /// Index of refraction of glass: 1, which refracts nothing, where `ior` is 0.
    pub fn glass_ior(&self) -> f32 {
        if self.ior == 0.0 { 1.0 } else { self.ior }
    }

    fn push_glass(&self, bsdf: &mut Bsdf, relative_ior: f32, weight: f32) {
        let specular = SpecularWeight::new(self.specular, self.specular_color);
        let thin_film = self.thin_film(self.dielectric_f0());
        if self.thin_walled {
            let new = if self.single_scattering { ThinDielectric::new } else { ThinDielectric::compensated };
            let mut pane =
                new(self.glass_ior(), self.alpha()).tinted(Rgb::WHITE, self.base_color).with_specular(specular);
            pane.thin_film = thin_film;
            bsdf.push_scaled(pane, weight);
        } else {
            let new = if self.single_scattering { Dielectric::new } else { Dielectric::compensated };
            let mut interface =
                new(relative_ior, self.alpha()).tinted(Rgb::WHITE, self.base_color).with_specular(specular);
            interface.thin_film = thin_film;
            bsdf.push_scaled(interface, weight);
        }
        bsdf.push_return(self.base_color, weight);
    }

    /// Adds plastic, whose base light from below meets without the coat; `ior` is the index of
    /// refraction below over above of a refracting surface, else 1.
    fn push_plastic(&self, bsdf: &mut Bsdf, weight: f32, is_open: bool, ior: f32) {
        let f0 = self.dielectric_f0();
        if self.specular > 0.0 {
            let fresnel = self.with_film(Fresnel::Schlick { f0, f90: Rgb::splat(self.specular) }, f0);
            bsdf.push_coat(self.mirror(fresnel, self.alpha()), weight);
        }
        if self.diffuse_transmission > 0.0 {
            let reflectance = self.base_color * (1.0 - self.diffuse_transmission);
            let transmittance = self.diffuse_transmission_color * self.diffuse_transmission;
            bsdf.push_scaled(DiffuseTransmission { reflectance, transmittance, ior }, weight);
            bsdf.push_diffuse_return(transmittance * (1.0 / (ior * ior)).min(1.0), weight);
        } else {
            bsdf.push_scaled(Lambert { albedo: self.base_color }, weight);
            if is_open {
                bsdf.push_below(Lambert { albedo: self.base_color }, weight);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::portable;
    use juggler_math::testing::close;

    #[test]
    fn principled_plastic_matches_the_gltf_formula() {
        // KHR_materials_ior 1.5: f0 = 0.04. At normal incidence, the diffuse part is base (1 - F) /
        // π up to the coupling of the layers, and the highlight F D / 4.
        let red = Principled {
            base_color: Rgb::new(0.8, 0.1, 0.0),
            roughness: 0.6,
            single_scattering: true,
            ..Principled::default()
        };
        let value = Bsdf::with_lobes(|bsdf| red.add_lobes(1.5, bsdf)).eval(Vec3::Z, Vec3::Z);
        let alpha = 0.36f32;
        let highlight = 0.04 / (4.0 * std::f32::consts::PI * alpha * alpha);
        assert!(close(value.b, highlight, 1e-4), "{value:?}");
        let diffuse = (value.r - highlight) * std::f32::consts::PI / 0.8;
        assert!((0.94..1.06).contains(&diffuse), "{diffuse}");
    }

    #[test]
    fn metallic_reflects_base_color_and_extensions_set_their_lobes() {
        let gold =
            Principled { base_color: Rgb::new(1.0, 0.7, 0.3), metallic: 1.0, roughness: 0.0, ..Principled::default() };
        let gold_bsdf = Bsdf::with_lobes(|bsdf| gold.add_lobes(1.5, bsdf));
        let deltas = gold_bsdf.deltas(Vec3::Z);
        assert!(deltas.len() == 1 && close(deltas[0].weight.g, 0.7, 1e-6), "{deltas:?}");
        let brushed = Principled { roughness: 0.5, anisotropy: 0.6, ..gold };
        assert!(close(brushed.alpha().x, 0.25 + 0.75 * 0.36, 1e-6) && brushed.alpha().y == 0.25);
        // Specular 0 is diffuse; transmission 1 transmits all light that is not reflected, filtered
        // by the base color.
        let diffuse = Principled { specular: 0.0, base_color: Rgb::splat(0.5), ..Principled::default() };
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, 0.6));
        assert!(close(
            Bsdf::with_lobes(|bsdf| diffuse.add_lobes(1.5, bsdf)).eval(wo, wi).r,
            0.5 * 0.6 / std::f32::consts::PI,
            1e-6
        ));
        let water = Principled {
            transmission: 1.0,
            roughness: 0.0,
            base_color: Rgb::new(0.2, 0.8, 1.0),
            ..Principled::default()
        };
        let water_bsdf = Bsdf::with_lobes(|bsdf| water.add_lobes(1.333, bsdf));
        let deltas = water_bsdf.deltas(Vec3::Z);
        let through = deltas.iter().find(|d| d.is_transmitted(Vec3::Z)).unwrap();
        assert!(close(through.weight.g * portable::powi(1.333, 2), 0.8 * (1.0 - 0.020_37), 1e-4), "{deltas:?}");
        let coated = Principled { clearcoat: 1.0, ..diffuse };
        assert!(
            Bsdf::with_lobes(|bsdf| coated.add_lobes(1.5, bsdf)).has_specular()
                && !Bsdf::with_lobes(|bsdf| coated.add_lobes(1.5, bsdf)).is_specular()
        );
    }
}
