//! Albedos of an interface: fractions of light that it reflects and transmits, for one direction or
//! on average over all.

use super::{Dielectric, InterfaceLoss, Multiple, Side, channel_sum, energy, fresnel};
use juggler_math::Vec3;

impl Dielectric {
    /// Reflectance and transmittance of light along `wo`, without their colors.
    pub(crate) fn reflectance_and_transmittance(&self, wo: Vec3) -> [f32; 2] {
        let (ior, cos) = (self.ior_from(wo), wo.z.abs());
        if self.is_smooth() {
            let reflectance = channel_sum(self.smooth_reflectance(cos, ior)) / 3.0;
            return [reflectance, 1.0 - reflectance];
        }
        let up = Vec3::new(wo.x, wo.y, cos);
        let reflected = self.single_reflection_albedo(cos, ior);
        let multiple = self.multiple(up, ior);
        let loss = || InterfaceLoss::new(self.ggx, ior).at(Side::from_ior(ior), up);
        let loss = multiple.map_or_else(loss, |multiple| multiple.loss_probability);
        let transmitted = (1.0 - reflected - loss).max(0.0);
        match multiple {
            Some(Multiple { transmitted_fraction: t, .. }) => [reflected + loss * (1.0 - t), transmitted + loss * t],
            None => [reflected, transmitted],
        }
    }

    /// Estimate of the fraction of light that single scattering reflects.
    fn single_reflection_albedo(&self, cos: f32, ior: f32) -> f32 {
        let alpha = self.ggx.mean_alpha();
        let lost = energy::isotropic_mirror_loss(cos, alpha);
        let albedo = energy::dielectric_reflection_albedo(cos, alpha, ior, lost);
        if self.specular.weight() == 1.0 {
            return albedo;
        }
        // Microfacets reflect totally where they do without the weight.
        let mean = |reflectance: &dyn Fn(f32) -> f32| energy::mean_microfacet_reflectance(cos, alpha, reflectance);
        let plain = mean(&|cos| fresnel::dielectric_reflectance(cos, ior));
        let total = mean(&|cos| if fresnel::dielectric_reflectance(cos, ior) < 1.0 { 0.0 } else { 1.0 });
        let total = (total / plain.max(f32::MIN_POSITIVE)).min(1.0) * albedo;
        total + (albedo - total) * self.specular.weight()
    }

    /// 1 / η²: projected solid angle below into which the whole upper hemisphere refracts, over π.
    #[inline]
    pub(crate) fn inverse_squared_ior(&self) -> f32 {
        1.0 / (self.ior * self.ior)
    }

    /// Transmittance of the polished interface for light from below at an angle of this cosine.
    #[inline]
    pub(crate) fn smooth_transmittance_below(&self, cos: f32) -> f32 {
        1.0 - fresnel::dielectric_reflectance(cos.min(1.0), 1.0 / self.ior)
    }

    /// Cosine-weighted mean of [`Dielectric::smooth_transmittance_below`] over all directions.
    pub(crate) fn mean_smooth_transmittance_below(&self) -> f32 {
        1.0 - fresnel::mean_dielectric_reflectance(1.0 / self.ior)
    }
}
