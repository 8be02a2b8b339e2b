# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of materials."""

from ._node import Node

__all__ = [
    "Phong",
    "Diffuse",
    "Conductor",
    "Dielectric",
    "Plastic",
    "Velvet",
    "Translucent",
    "Principled",
    "Emissive",
    "Unlit",
    "Checkerboard",
    "Mask",
    "Mix",
    "NormalMap",
    "BumpMap",
    "Boundary",
]


class Phong(Node):
    """Classic model of Phong and Whitted: ambient, diffuse and specular reflection, mirror
    reflection and refraction. The integrator `classic` follows it exactly, path tracers approximate
    it by a physically based BSDF.

    Args:
        emission (color, texture, the name of one or `InputProduct`; W/(scene unit² sr); default (0,
            0, 0)): Emitted radiance, 0 or more per channel.
        ambient (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Weight of
            ambient light, 0 or more per channel; a factor on `diffuse`.
        occlusion (number from 0 to 1; default 1): Share of the ambient light that nearby geometry
            may occlude. Takes effect if the integrator has an `occlusion_distance`.
        diffuse (color, texture, the name of one or `InputProduct`; default (0.8, 0.8, 0.8)): Color
            of ambient and diffuse reflection, 0 or more per channel.
        diffuse_weight (number from 0 to 1e+30; default 1): Weight of diffuse reflection.
        diffuse_normalization ("one" or "inverse_pi"; default "one"): Normalization of diffuse
            reflection.
        specular (number, texture, the name of one or `InputProduct`; default 0): Weight of the
            specular highlight, 0 or more.
        highlight_color (color, texture, the name of one or `InputProduct`; default (1, 1, 1)):
            Color of the specular highlight, 0 or more per channel.
        shininess (number from 0; default 20): Exponent of the specular highlight. Larger values
            make it smaller.
        highlight ("phong" or "phong_cosine"; default "phong"): Formula of the specular highlight.
        reflection (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Weight of
            mirror reflection, 0 or more per channel.
        glossy (`Spread`): Cone of reflected rays, for glossy reflection.
        transparency (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Weight
            of refraction, 0 or more per channel; also the transmittance for shadow rays.
        blurry (`Spread`): Cone of refracted rays, for blurry refraction.
        ior (number from 0.01 to 100; default 1): Index of refraction inside over outside. 1 leaves
            rays straight, glass has 1.5.
        fresnel (True or False; default False): Weights `reflection` and `transparency` by Fresnel's
            equations: at grazing angles, reflection dominates.
        both_sides (True or False; default False): Lights the surface from both sides, whichever
            side is seen. Use it for surfaces as thin as paper.

    Example:
        materials.Phong(diffuse="#c02020", shininess=40, reflection=0.1)
    """

    __slots__ = (
        "emission",
        "ambient",
        "occlusion",
        "diffuse",
        "diffuse_weight",
        "diffuse_normalization",
        "specular",
        "highlight_color",
        "shininess",
        "highlight",
        "reflection",
        "glossy",
        "transparency",
        "blurry",
        "ior",
        "fresnel",
        "both_sides",
    )
    _kind = "phong"


class Diffuse(Node):
    """Diffuse surface.

    Args:
        reflectance (color, texture, the name of one or `InputProduct`; default (0.8, 0.8, 0.8)):
            Reflectance, 0 to 1 per channel. Roughness lowers it slightly, except for white.
        roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness, 0
            (Lambert's law) to 1 (energy-preserving Oren-Nayar model). Larger values flatten the
            shading, as on dust and plaster.
        sides ("both", "front" or "black_behind"): Sides of the surface on which the material is
            present: `both`, `front` (absent from behind) or `black_behind`.

    Example:
        materials.Diffuse(reflectance="#b8ae9c")
    """

    __slots__ = ("reflectance", "roughness", "sides")
    _kind = "diffuse"


class Conductor(Node):
    """Metal, smooth or rough (GGX microfacets). `metal` takes precedence over `eta` and `k`, and
    these over `reflectance`.

    Args:
        metal ("aluminum", "brass", "chromium", "cobalt", "copper", "gold", "iron", "nickel",
            "platinum", "silver", "titanium", "tungsten", "zinc" or "aluminium"): Name of a metal,
            such as `gold`, in place of `eta` and `k` or `reflectance`.
        eta (color): Real part of the complex index of refraction per channel, 0.001 to 1000.
            Requires `k`; replaces `reflectance`.
        k (color): Extinction coefficient per channel, the imaginary part of the complex index of
            refraction, from 0 to 1000. Requires `eta`.
        reflectance (color, texture, the name of one or `InputProduct`; default (0.9, 0.9, 0.9)):
            Reflectance at normal incidence, 0 to 1 per channel. Ignored with `metal` or `eta` and
            `k`.
        edge_tint (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Factor on
            the reflectance of Schlick's curve at 82 degrees, 0 to 1 per channel; at 90 degrees the
            reflectance stays white. White keeps Schlick's curve. Ignored with `grazing`.
        grazing (color): Reflectance at grazing angles in Schlick's curve, 0 to 1 per channel, in
            place of white. The value of `reflectance` makes the reflectance independent of the
            angle.
        roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness, 0
            (mirror) to 1. The alpha of GGX is its square.
        anisotropy (number, texture, the name of one or `InputProduct`; default 0): Anisotropy of
            the roughness, -1 to 1: positive values elongate highlights along the surface's u,
            negative values along v.
        anisotropy_rotation (number, texture, the name of one or `InputProduct`; default 0):
            Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
        energy_compensation (True or False; default True): Adds the energy that single scattering
            between microfacets loses: rough white metal stays white. On isotropic metal it leaves
            in all directions (Kulla and Conty 2017), on anisotropic metal within the highlight
            (Turquin 2019). Set it to `false` to match renderers with single scattering only, where
            rough metal is darker.
        sides ("both", "front" or "black_behind"): Sides of the surface on which the material is
            present: `both`, `front` (absent from behind) or `black_behind`.

    Example:
        materials.Conductor(metal="gold", roughness=0.2)
    """

    __slots__ = (
        "metal",
        "eta",
        "k",
        "reflectance",
        "edge_tint",
        "grazing",
        "roughness",
        "anisotropy",
        "anisotropy_rotation",
        "energy_compensation",
        "sides",
    )
    _kind = "conductor"


class Dielectric(Node):
    """Dielectric interface, smooth or rough (GGX microfacets), with a medium inside. Use it for
    glass, water and gems.

    Args:
        ior (number from 0.1 to 10; default 1.5): Index of refraction inside: 1.33 for water, 1.5
            for glass, 2.42 for diamond.
        dispersion (number from 0 to 20): Dispersion: 20 divided by the Abbe number of the glass, 0
            to 20; 0.34 for crown glass, 0.36 for diamond, 0.7 for flint glass. The default, 0,
            refracts all wavelengths alike. Only the integrator `path` shows dispersion. Paths do
            not sample lights through spheres of dispersive glass, so such spheres cast caustics of
            emissive objects and environments, but none of `point`, `spot` and `directional` lights.
        roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness, 0
            (clear) to 1 (frosted). The alpha of GGX is its square.
        anisotropy (number, texture, the name of one or `InputProduct`; default 0): Anisotropy of
            the roughness, -1 to 1: positive values elongate highlights along the surface's u,
            negative values along v.
        anisotropy_rotation (number, texture, the name of one or `InputProduct`; default 0):
            Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
        reflection_tint (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Tint
            of reflected light, 0 to 1 per channel. White is physical.
        transmission_tint (color, texture, the name of one or `InputProduct`; default (1, 1, 1)):
            Tint of transmitted light, 0 to 1 per channel. White is physical; use the `medium` for
            colored glass.
        thin (True or False; default False): Makes the surface a thin pane or bubble: light passes
            straight through, and there is no interior, so `medium` and `priority` have no effect.
        medium (`Medium`): Medium inside the solid.
        priority (whole number; default 0): Priority where solids overlap: the solid of the highest
            priority fills the overlap (Schmidt and Budge 2002), among equals the one whose material
            comes first. Let a drink reach slightly into its glass, and give the glass the higher
            priority.
        energy_compensation (True or False; default True): Adds the energy that single scattering
            between microfacets loses. Set it to `false` to match renderers with single scattering
            only, where rough glass is darker.

    Example:
        materials.Dielectric(ior=1.5)
    """

    __slots__ = (
        "ior",
        "dispersion",
        "roughness",
        "anisotropy",
        "anisotropy_rotation",
        "reflection_tint",
        "transmission_tint",
        "thin",
        "medium",
        "priority",
        "energy_compensation",
    )
    _kind = "dielectric"


class Plastic(Node):
    """Diffuse base under a smooth or rough dielectric coating. Use it for plastic, varnished wood
    and glazed tiles.

    Args:
        reflectance (color, texture, the name of one or `InputProduct`; default (0.5, 0.5, 0.5)):
            Reflectance of the diffuse base, 0 to 1 per channel.
        diffuse_roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness
            of the diffuse base, 0 (Lambert's law) to 1 (energy-preserving Oren-Nayar model), as in
            the material `diffuse`.
        ior (number from 1 to 10; default 1.5): Index of refraction of the coating.
        roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness of the
            coating, 0 (mirror) to 1. The alpha of GGX is its square.
        anisotropy (number, texture, the name of one or `InputProduct`; default 0): Anisotropy of
            the roughness, -1 to 1: positive values elongate highlights along the surface's u,
            negative values along v.
        anisotropy_rotation (number, texture, the name of one or `InputProduct`; default 0):
            Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
        reflection_tint (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Tint
            of the coating's reflection, 0 to 1 per channel. White is physical.
        nonlinear (True or False; default False): Simulates multiple reflections between base and
            coating, which make colors darker and more saturated. `false` keeps the colors as they
            are written or painted.
        sides ("both", "front" or "black_behind"): Sides of the surface on which the material is
            present: `both`, `front` (absent from behind) or `black_behind`.

    Example:
        materials.Plastic(reflectance="#c02020", roughness=0.1)
    """

    __slots__ = (
        "reflectance",
        "diffuse_roughness",
        "ior",
        "roughness",
        "anisotropy",
        "anisotropy_rotation",
        "reflection_tint",
        "nonlinear",
        "sides",
    )
    _kind = "plastic"


class Velvet(Node):
    """Cloth: a sheen of upright fibers over a diffuse base. Use it for velvet and other fabrics.

    Args:
        sheen_color (color, texture, the name of one or `InputProduct`; default (0.8, 0.8, 0.8)):
            Color of the sheen, 0 to 1 per channel.
        sheen_roughness (number, texture, the name of one or `InputProduct`; default 0.5): Roughness
            of the sheen, 0 to 1. Small values confine the sheen to grazing angles, large values
            spread it over the surface.
        reflectance (color, texture, the name of one or `InputProduct`; default (0, 0, 0)):
            Reflectance of the diffuse base, 0 to 1 per channel. Black leaves the sheen alone.
        roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness of the
            diffuse base, 0 (Lambert's law) to 1 (energy-preserving Oren-Nayar model), as in the
            material `diffuse`.
        sides ("both", "front" or "black_behind"): Sides of the surface on which the material is
            present: `both`, `front` (absent from behind) or `black_behind`.

    Example:
        materials.Velvet(sheen_color="#ffffff", reflectance="#401020")
    """

    __slots__ = ("sheen_color", "sheen_roughness", "reflectance", "roughness", "sides")
    _kind = "velvet"


class Translucent(Node):
    """Thin sheet that reflects and transmits light diffusely, the same from both sides. Use it for
    paper, leaves and lampshades.

    Args:
        reflectance (color, texture, the name of one or `InputProduct`; default (0.4, 0.4, 0.4)):
            Diffuse reflectance, 0 to 1 per channel.
        transmittance (color, texture, the name of one or `InputProduct`; default (0.4, 0.4, 0.4)):
            Diffuse transmittance, 0 to 1 per channel. The sum with `reflectance` is at most 1 per
            channel; larger sums of texture values are scaled to 1.

    Example:
        materials.Translucent(reflectance=0.4, transmittance=0.4)
    """

    __slots__ = ("reflectance", "transmittance")
    _kind = "translucent"


class Principled(Node):
    """Metallic-roughness model of glTF 2.0 with its extensions: a mixture of metal, glass and
    plastic under optional thin film, sheen and clearcoat. It suits most surfaces.

    Args:
        base_color (color, texture, the name of one or `InputProduct`; default (0.8, 0.8, 0.8)):
            Base color, 0 to 1 per channel: the reflectance of metal at normal incidence, the
            diffuse albedo of plastic, and the tint of light that glass transmits.
        metallic (number, texture, the name of one or `InputProduct`; default 0): Share of metal, 0
            to 1. The rest is plastic or glass.
        roughness (number, texture, the name of one or `InputProduct`; default 0.5): Roughness, 0
            (mirror) to 1. The alpha of GGX is its square.
        ior (number from 0 to 10; default 1.5): Index of refraction of plastic and glass, 1 to 10,
            or 0: then `specular_color` is the whole reflectance at normal incidence, and light
            enters glass without refraction, as with `KHR_materials_ior`.
        dispersion (number from 0 to 20): Dispersion of the light that glass refracts: 20 divided by
            the Abbe number, 0 to 20. The default, 0, refracts all wavelengths alike. Only the
            integrator `path` shows dispersion, and spheres of dispersive glass cast no caustics of
            `point`, `spot` and `directional` lights.
        specular (number, texture, the name of one or `InputProduct`; default 1): Weight of the
            specular reflection of plastic and glass, 0 to 1.
        specular_color (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color
            of the specular reflection of plastic and glass at normal incidence, 0 or more per
            channel. The reflectance itself is limited to 1.
        anisotropy (number, texture, the name of one or `InputProduct`; default 0): Anisotropy of
            the roughness, 0 to 1. Larger values elongate highlights along the surface's u.
        anisotropy_rotation (number, texture, the name of one or `InputProduct`; default 0):
            Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
        clearcoat (number, texture, the name of one or `InputProduct`; default 0): Coverage of the
            surface by the clearcoat, 0 (none) to 1 (complete).
        clearcoat_roughness (number, texture, the name of one or `InputProduct`; default 0):
            Roughness of the clearcoat, 0 (mirror) to 1.
        clearcoat_ior (number from 1 to 10; default 1.5): Index of refraction of the clearcoat.
        clearcoat_normal (color, texture, the name of one or `InputProduct`): Normals of the
            clearcoat, encoded as those of `normal_map`. They ignore normal and bump maps around
            this material: (0.5, 0.5, 1) makes the coat smooth over a mapped base. `null` gives the
            coat the normals of its base.
        clearcoat_normal_scale (number from 0 to 1000): Factor on the tangential components of
            `clearcoat_normal`, 0 to 1000. The default is 1.
        sheen_color (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color of
            the sheen of fibers, 0 to 1 per channel. Black disables the sheen.
        sheen_roughness (number, texture, the name of one or `InputProduct`; default 0): Roughness
            of the sheen, 0 to 1. Small values confine the sheen to grazing angles.
        iridescence (number, texture, the name of one or `InputProduct`; default 0): Coverage by a
            thin film that shows interference colors, 0 to 1.
        iridescence_ior (number from 1 to 10; default 1.3): Index of refraction of the thin film.
        iridescence_thickness (number, texture, the name of one or `InputProduct`; nm; default 400):
            Thickness of the thin film in nanometers, 0 to 1e6.
        transmission (number, texture, the name of one or `InputProduct`; default 0): Share of glass
            in the part that is not metal, 0 to 1. The rest is plastic.
        diffuse_transmission (number, texture, the name of one or `InputProduct`; default 0): Share
            of the diffuse light that is transmitted to the other side, 0 to 1.
        diffuse_transmission_color (color, texture, the name of one or `InputProduct`; default (1,
            1, 1)): Color of the diffusely transmitted light, 0 to 1 per channel.
        thin (True or False; default False): Makes the surface a thin sheet: light passes straight
            through, and there is no interior. glTF expresses this by a thickness of 0.
        medium (`Medium`): Medium inside the solid, if light can enter it. `color` and `distance`
            are the attenuation of glTF.
        priority (whole number; default 0): Priority where solids overlap: the solid of the highest
            priority fills the overlap (Schmidt and Budge 2002), among equals the one whose material
            comes first.
        emissive (color, texture, the name of one or `InputProduct`; W/(scene unit² sr); default (0,
            0, 0)): Emitted radiance on all `sides`, 0 to 1e30 per channel, also after
            multiplication by `emissive_strength`. Black emits nothing. A clearcoat reflects some of
            it back.
        emissive_strength (number from 0 to 1e+30; default 1): Factor on `emissive`.
        opacity (number, texture, the name of one or `InputProduct`; default 1): Opacity, 0 to 1:
            share of the light that interacts with the surface. The rest passes straight through.
        alpha_cutoff (number from 0 to 1): Threshold that makes opacity binary: smaller opacities
            count as 0, all others as 1. Corresponds to the alpha mode `MASK` of glTF.
        sides ("both", "front" or "black_behind"): Sides of the surface on which the material is
            present and emits: `both`, `front` (absent from behind) or `black_behind`. Has no effect
            with `transmission` or `diffuse_transmission`.
        energy_compensation (True or False; default True): Adds the energy that single scattering
            between microfacets loses (Kulla and Conty 2017; on anisotropic metal within the
            highlight, Turquin 2019). Set it to `false` to match renderers with single scattering
            only, where rough metal and glass are darker.

    Example:
        materials.Principled(base_color="#c02020", metallic=0, roughness=0.4)
    """

    __slots__ = (
        "base_color",
        "metallic",
        "roughness",
        "ior",
        "dispersion",
        "specular",
        "specular_color",
        "anisotropy",
        "anisotropy_rotation",
        "clearcoat",
        "clearcoat_roughness",
        "clearcoat_ior",
        "clearcoat_normal",
        "clearcoat_normal_scale",
        "sheen_color",
        "sheen_roughness",
        "iridescence",
        "iridescence_ior",
        "iridescence_thickness",
        "transmission",
        "diffuse_transmission",
        "diffuse_transmission_color",
        "thin",
        "medium",
        "priority",
        "emissive",
        "emissive_strength",
        "opacity",
        "alpha_cutoff",
        "sides",
        "energy_compensation",
    )
    _kind = "principled"


class Emissive(Node):
    """Emissive surface: the same radiance in all directions, optionally over another material that
    scatters light.

    Args:
        radiance (color, texture, the name of one or `InputProduct`; W/(scene unit² sr); default (1,
            1, 1)): Emitted radiance, 0 to 1e30 per channel, also after multiplication by `scale`.
        scale (number from 0 to 1e+30; default 1): Factor on the radiance.
        sides ("front" or "both"; default "front"): Sides of the surface that emit light.
        material (material or the name of one): Material that scatters light. Without it, the
            surface is black.

    Example:
        materials.Emissive(radiance=(10, 9, 8))
    """

    __slots__ = ("radiance", "scale", "sides", "material")
    _kind = "emissive"


class Unlit(Node):
    """Color without lighting, as `KHR_materials_unlit`: camera rays see it, directly, in mirrors
    and through glass. For all other rays the surface is absent: it casts no shadow, and its color
    does not light other surfaces. Use it for labels and backdrops; use `emissive` for area lights.

    Args:
        color (color, texture, the name of one or `InputProduct`; W/(scene unit² sr); default (1, 1,
            1)): Radiance of the surface, the same in all directions and on both sides, 0 to 1e30
            per channel.
        opacity (number, texture, the name of one or `InputProduct`; default 1): Opacity, 0 (absent)
            to 1 (present).

    Example:
        materials.Unlit(color="#c02020")
    """

    __slots__ = ("color", "opacity")
    _kind = "unlit"


class Checkerboard(Node):
    """Checkerboard of two materials in a coordinate plane of object space. Use the texture
    `checker` for two colors of one material.

    Args:
        size (number above 0; scene units; default 1): Edge length of a cell, in units of object
            space.
        plane ("xz", "xy" or "yz"; default "xz"): Coordinate plane of the cells. The pattern is
            constant along the third axis.
        even (material or the name of one): Material of the cell on the positive side of the origin.
        odd (material or the name of one): Material of the adjacent cells.

    Example:
        materials.Checkerboard(size=1, even="white", odd="black")
    """

    __slots__ = ("size", "plane", "even", "odd")
    _kind = "checkerboard"


class Mask(Node):
    """Opacity of another material: light passes straight through where the opacity is 0, and with
    probability 1 - opacity elsewhere. Use it to cut leaves out of a rectangle.

    Args:
        opacity (number, texture, the name of one or `InputProduct`; default 1): Opacity, 0 (absent)
            to 1 (present).
        cutoff (number from 0 to 1): Threshold that makes opacity binary: smaller opacities count as
            0, all others as 1. Set the `filter` of an image to `bilinear`, since the means of
            distant texels would shrink or fill leaves.
        material (material or the name of one): Material that has this opacity.

    Example:
        materials.Mask(opacity="leaf", material="green")
    """

    __slots__ = ("opacity", "cutoff", "material")
    _kind = "mask"


class Mix(Node):
    """Mixture of two materials: each sample chooses one of them at random.

    Args:
        amount (number, texture, the name of one or `InputProduct`; default 0.5): Weight of `b`, 0
            to 1; the weight of `a` is 1 - `amount`.
        a (material or the name of one): Material that an `amount` of 0 shows alone.
        b (material or the name of one): Material that an `amount` of 1 shows alone.

    Example:
        materials.Mix(amount=0.3, a="paint", b="rust")
    """

    __slots__ = ("amount", "a", "b")
    _kind = "mix"


class NormalMap(Node):
    """Normal map over another material: shading normals come from a texture, in tangent space.

    Args:
        texture (color, texture, the name of one or `InputProduct`; default (0.5, 0.5, 1)): Normals,
            encoded from 0 to 1 per channel; (0.5, 0.5, 1) leaves the normal unchanged. Set an
            image's `color_space` to `linear`.
        strength (number, texture, the name of one or `InputProduct`; default 1): Factor on the
            tangential components of the normals, 0 to 1000. 0 disables the map.
        material (material or the name of one): Material that the mapped normals shade.

    Example:
        materials.NormalMap(texture="normals", material="stone")
    """

    __slots__ = ("texture", "strength", "material")
    _kind = "normal_map"


class BumpMap(Node):
    """Bump map over another material: shading normals follow a texture of heights. The geometry and
    its silhouette stay unchanged.

    Args:
        height (number, texture, the name of one or `InputProduct`; default 0): Height above the
            surface, in units of `distance`; of a texture, the luminance. Set an image's
            `color_space` to `linear`. A constant has no effect.
        distance (number from -1000000 to 1000000; default 1): Displacement at a height of 1, in
            scene units, -1e6 to 1e6. Negative values turn bumps into dents.
        material (material or the name of one): Material that the bumped normals shade.

    Example:
        materials.BumpMap(height="scratches", distance=0.01, material="steel")
    """

    __slots__ = ("height", "distance", "material")
    _kind = "bump_map"


class Boundary(Node):
    """Interface without a BSDF: light enters the medium inside the solid without reflection or
    refraction. Use it for fog, smoke and clouds.

    Args:
        medium (`Medium`): Medium inside the solid.
        priority (whole number; default 0): Priority where solids overlap: the solid of the highest
            priority fills the overlap (Schmidt and Budge 2002), among equals the one whose material
            comes first.

    Example:
        materials.Boundary(medium=Medium(scattering=0.3, absorption=0.01))
    """

    __slots__ = ("medium", "priority")
    _kind = "boundary"
