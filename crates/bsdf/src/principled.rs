//! The surface that glTF 2.0 describes: metal or not, by roughness (Burley 2012), with its extensions clearcoat, transmission,
//! volume (its border), ior, specular, sheen, anisotropy, iridescence and diffuse_transmission.
//!
//! From top to bottom: clearcoat over sheen over a patchwork of metal, glass and plastic by their shares. Where light comes from
//! below, it meets the same patchwork: metal, glass, and plastic's body without its coat. Numbers mean
//! what glTF says they do. Where its formulas are not the same both ways or lose light, these are used instead:
//!
//! - layers dim what is below as [`Bsdf`] says, not by the viewer's side alone, and what they keep from leaving glass goes
//!   back into it;
//! - rough surfaces get back what is scattered more than once, unless `single_scattering`;
//! - glass uses Fresnel's exact equations, and thin-walled glass mirrors to and fro inside;
//! - of glass, `specular` and `specular_color` dim what is mirrored; what they take away does not go through instead.

use super::film::Film;
use super::fresnel::head_on;
use super::{Bsdf, Conductor, Dielectric, DiffuseTransmission, Fresnel, Lambert, Sheen, ThinDielectric};
use juggler_math::{Rgb, Vec2};

/// A surface by numbers; all shares and roughnesses from 0 to 1, as are channels of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// Colour of metal head on, of plastic's body, and of light that goes through glass.
    pub base_color: Rgb,
    /// Share of metal.
    pub metallic: f32,
    /// Square root of [`Ggx`](super::ggx::Ggx)'s alpha.
    pub roughness: f32,
    /// Weight of what plastic mirrors.
    pub specular: f32,
    /// Colour of what plastic mirrors head on.
    pub specular_color: Rgb,
    /// Index of refraction of plastic, and of thin-walled glass, in air.
    pub ior: f32,
    /// Share of glass in what is not metal.
    pub transmission: f32,
    /// Whether glass is a thin sheet, through which light goes straight on, and not the border of a body.
    pub thin_walled: bool,
    /// How much rougher it is along x than along y.
    pub anisotropy: f32,
    /// Share that is covered by clear varnish.
    pub clearcoat: f32,
    /// Roughness of the varnish.
    pub clearcoat_roughness: f32,
    /// Index of refraction of the varnish; glTF has 1.5.
    pub clearcoat_ior: f32,
    /// Colour of fibres on top.
    pub sheen_color: Rgb,
    /// Roughness of fibres.
    pub sheen_roughness: f32,
    /// Share that is covered by a thin film.
    pub iridescence: f32,
    /// Index of refraction of the film.
    pub iridescence_ior: f32,
    /// Thickness of the film in nanometres.
    pub iridescence_thickness_nm: f32,
    /// Share of the body's light that comes out on the other side.
    pub diffuse_transmission: f32,
    /// Colour of that light.
    pub diffuse_transmission_color: Rgb,
    /// Whether light may come from below, be it through this point or another one.
    pub is_open: bool,
    /// Whether some of it is refracted, be it through this point or another one.
    pub is_refracting: bool,
    /// Leaves out what is scattered more than once among microfacets, as most other renderers do.
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
    /// Adds the lobes to `bsdf`. `relative_ior` is the index of refraction below the surface (-z) over that above, for glass that is
    /// not thin-walled: the material's `ior` where air is above.
    pub fn add_lobes(&self, relative_ior: f32, bsdf: &mut Bsdf) {
        if self.clearcoat > 0.0 {
            let fresnel = Fresnel::Dielectric { ior: self.clearcoat_ior, color: Rgb::WHITE };
            let alpha = self.clearcoat_roughness * self.clearcoat_roughness;
            bsdf.push_layer(self.mirror(fresnel, Vec2::splat(alpha)), self.clearcoat);
        }
        if !self.sheen_color.is_black() {
            let sheen = Sheen::new(self.sheen_color, self.sheen_roughness * self.sheen_roughness);
            bsdf.push_dimmed_layer(sheen, self.covered());
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

    /// How much of its albedo sheen takes from what lies below: it spreads light to where the clearcoat over it lets less
    /// through, and what it so lacks is left to what is below. Fitted for a white furnace.
    fn covered(&self) -> f32 {
        let polished = 1.0 - self.clearcoat_roughness;
        1.0 - self.clearcoat * (0.015 + 0.045 * polished * polished)
    }

    /// Alpha along x and y, by KHR_materials_anisotropy.
    pub fn alpha(&self) -> Vec2 {
        let alpha = self.roughness * self.roughness;
        Vec2::new(alpha + (1.0 - alpha) * self.anisotropy * self.anisotropy, alpha)
    }

    /// Colour of what plastic mirrors head on, by KHR_materials_specular.
    fn head_on(&self) -> Rgb {
        (self.specular_color * head_on(self.ior)).map(|f0| f0.min(1.0)) * self.specular
    }

    fn mirror(&self, fresnel: Fresnel, alpha: Vec2) -> Conductor {
        if self.single_scattering { Conductor::new(fresnel, alpha) } else { Conductor::compensated(fresnel, alpha) }
    }

    fn film(&self, f0: Rgb) -> Option<(Film, f32)> {
        let film = Film { f0, ior: self.iridescence_ior, thickness_nm: self.iridescence_thickness_nm };
        (self.iridescence > 0.0 && self.iridescence_thickness_nm > 0.0).then_some((film, self.iridescence))
    }

    fn with_film(&self, fresnel: Fresnel, f0: Rgb) -> Fresnel {
        self.film(f0).map_or(fresnel, |(film, amount)| Fresnel::Film { film, amount })
    }

    fn push_glass(&self, bsdf: &mut Bsdf, relative_ior: f32, weight: f32) {
        let reflection = self.specular_color.map(|c| c.min(1.0)) * self.specular;
        let film = self.film(self.head_on());
        if self.thin_walled {
            let new = if self.single_scattering { ThinDielectric::new } else { ThinDielectric::compensated };
            let mut pane = new(self.ior, self.alpha()).tinted(reflection, self.base_color);
            pane.film = film;
            bsdf.push_scaled(pane, weight);
        } else {
            let new = if self.single_scattering { Dielectric::new } else { Dielectric::compensated };
            let mut border = new(relative_ior, self.alpha()).tinted(reflection, self.base_color);
            border.film = film;
            bsdf.push_scaled(border, weight);
        }
        bsdf.push_return(self.base_color, weight);
    }

    /// Plastic, whose body light from below meets without the coat; `ior` is that of what refracts light, below over above.
    fn push_plastic(&self, bsdf: &mut Bsdf, weight: f32, is_open: bool, ior: f32) {
        let f0 = self.head_on();
        if self.specular > 0.0 {
            let fresnel = self.with_film(Fresnel::Schlick { f0, f90: Rgb::splat(self.specular) }, f0);
            bsdf.push_coat(self.mirror(fresnel, self.alpha()), weight);
        }
        if self.diffuse_transmission > 0.0 {
            let reflectance = self.base_color * (1.0 - self.diffuse_transmission);
            let transmittance = self.diffuse_transmission_color * self.diffuse_transmission;
            bsdf.push_scaled(DiffuseTransmission { reflectance, transmittance, ior }, weight);
            bsdf.push_matt_return(transmittance * (1.0 / (ior * ior)).min(1.0), weight);
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
    use juggler_math::testing::close;
    use juggler_math::{Vec3, fun};

    #[test]
    fn plain_plastic_is_the_sum_that_gltf_says() {
        // KHR_materials_ior 1.5: f0 = 0.04. Head on, the matt part is base (1 - F) / π but for the layers' own coupling,
        // and the highlight F D / 4.
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
        let matt = (value.r - highlight) * std::f32::consts::PI / 0.8;
        assert!((0.94..1.06).contains(&matt), "{matt}");
    }

    #[test]
    fn metal_is_its_colour_and_extensions_reach_their_lobes() {
        let gold =
            Principled { base_color: Rgb::new(1.0, 0.7, 0.3), metallic: 1.0, roughness: 0.0, ..Principled::default() };
        let deltas = Bsdf::with_lobes(|bsdf| gold.add_lobes(1.5, bsdf)).deltas(Vec3::Z);
        assert!(deltas.len() == 1 && close(deltas[0].weight.g, 0.7, 1e-6), "{deltas:?}");
        let brushed = Principled { roughness: 0.5, anisotropy: 0.6, ..gold };
        assert!(close(brushed.alpha().x, 0.25 + 0.75 * 0.36, 1e-6) && brushed.alpha().y == 0.25);
        // Specular 0 is matt; transmission 1 lets through what it does not mirror, in its colour.
        let matt = Principled { specular: 0.0, base_color: Rgb::splat(0.5), ..Principled::default() };
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, 0.6));
        assert!(close(
            Bsdf::with_lobes(|bsdf| matt.add_lobes(1.5, bsdf)).eval(wo, wi).r,
            0.5 * 0.6 / std::f32::consts::PI,
            1e-6
        ));
        let water = Principled {
            transmission: 1.0,
            roughness: 0.0,
            base_color: Rgb::new(0.2, 0.8, 1.0),
            ..Principled::default()
        };
        let deltas = Bsdf::with_lobes(|bsdf| water.add_lobes(1.333, bsdf)).deltas(Vec3::Z);
        let through = deltas.iter().find(|d| d.is_transmitted(Vec3::Z)).unwrap();
        assert!(close(through.weight.g * fun::powi(1.333, 2), 0.8 * (1.0 - 0.020_37), 1e-4), "{deltas:?}");
        let coated = Principled { clearcoat: 1.0, ..matt };
        assert!(
            Bsdf::with_lobes(|bsdf| coated.add_lobes(1.5, bsdf)).has_specular()
                && !Bsdf::with_lobes(|bsdf| coated.add_lobes(1.5, bsdf)).is_specular()
        );
    }
}
