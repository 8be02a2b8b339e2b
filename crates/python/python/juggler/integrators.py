# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of integrators."""

from ._node import Node

__all__ = [
    "Classic",
    "Path",
    "Direct",
    "AmbientOcclusion",
    "Albedo",
    "Normals",
    "Depth",
]


class Classic(Node):
    """Classic recursive ray tracing: Phong illumination from lights, mirrors and glass, without
    indirect diffuse light. Fast, with little noise.

    Args:
        max_depth (whole number from 0 to 1000; default 10): Maximum number of reflections and
            refractions along a ray, 0 to 1,000. 0 shows local illumination only; scenes with many
            mirrors or nested glass need more than the default of 10.
        min_weight (number from 0 to 1; default 0.00390625): Minimum weight of a reflected or
            refracted ray, in its brightest channel, 0 to 1. Rays below it are not traced. The
            default, 1/256, is invisible in 8-bit pictures; larger values are faster.
        occlusion_distance (number above 0): Maximum distance of ambient occlusion, in scene units,
            above 0: objects beyond it occlude nothing. Without it no material's ambient light is
            occluded.

    Example:
        integrators.Classic(max_depth=5)
    """

    __slots__ = ("max_depth", "min_weight", "occlusion_distance")
    _kind = "classic"


class Path(Node):
    """Path tracing: unbiased global illumination with soft shadows, interreflections, caustics and
    media.

    Args:
        max_depth (whole number from 1 to 10000; default 64): Maximum number of path segments
            between camera and light, 1 to 10,000. 1 shows only emitters, 2 adds direct lighting,
            larger values add indirect bounces. Scenes with much glass need many; the default is 64.
        max_diffuse (whole number from 0 to 10000): Maximum number of diffuse scattering events on a
            path, 0 to 10,000. Unlimited by default; 1 removes diffuse interreflection.
        max_glossy (whole number from 0 to 10000): Maximum number of glossy scattering events on a
            path, by rough metal or rough glass, 0 to 10,000. Unlimited by default; a low limit
            removes noise from repeated glossy reflection.
        max_specular (whole number from 0 to 10000): Maximum number of specular reflections and
            refractions on a path, 0 to 10,000. Unlimited by default.
        max_volume (whole number from 0 to 10000): Maximum number of scattering events in media, 0
            to 10,000. Unlimited by default; dense, bright media need many.
        roulette_depth (whole number from 1 to 10000; default 4): Segment from which Russian
            roulette may terminate paths of low throughput, 1 to 10,000. The result stays unbiased:
            smaller values save time and add noise. The default is 4; `null` disables it.
        light_samples (whole number from 1 to 64): Number of light samples at the first vertex that
            is not specular, where most of the noise arises; 1 to 64. By default 2 if the scene has
            several emitters, else 1. More samples reduce the noise of direct lighting.
        camera_rays (whole number from 1 to 8): Number of camera rays of each sample, 1 to 8. All of
            them add the light that they see directly, from emitters and the background, and the
            first continues as the path of the sample. More of them smooth the edges of visible
            emitters for little time. By default 1, 2, 4 or 8, by the noise of a small picture, and
            1 if the picture is transparent or smaller than 320 × 180 pixels.
        sampling ("mis", "light" or "bsdf"): Strategy for emitters that a ray can hit. `mis`
            combines light samples and BSDF samples and has the least noise; `light` and `bsdf` use
            one of them alone, for comparisons.
        clamp_direct (number from 1e-6 to 1e+30; W/(scene unit² sr)): Maximum contribution of
            emission and direct lighting, paths of one or two segments, to a sample: the limit of
            the brightest color channel, in units of radiance. Hue is preserved. Unlimited by
            default. Clamping darkens the picture; the render reports by how much.
        clamp_indirect (number from 1e-6 to 1e+30; W/(scene unit² sr)): Maximum contribution of
            indirect lighting, paths of three or more segments, as for `clamp_direct`. Use it
            against fireflies that more samples do not remove. Unlimited by default.

    Example:
        integrators.Path(max_depth=8, clamp_indirect=10)
    """

    __slots__ = (
        "max_depth",
        "max_diffuse",
        "max_glossy",
        "max_specular",
        "max_volume",
        "roulette_depth",
        "light_samples",
        "camera_rays",
        "sampling",
        "clamp_direct",
        "clamp_indirect",
    )
    _kind = "path"


class Direct(Node):
    """Direct lighting only: emission and one bounce from lights, with soft shadows. Faster than
    `path`, for previews of lighting.

    Example:
        integrators.Direct()
    """

    __slots__ = ()
    _kind = "direct"


class AmbientOcclusion(Node):
    """Ambient occlusion: the cosine-weighted fraction of the hemisphere that nothing within
    `distance` occludes.

    Args:
        distance (number above 0): Maximum distance of occluders, in scene units, above 0. The
            default is half of the diagonal of the scene's bounding box; smaller values confine
            darkening to corners.

    Example:
        integrators.AmbientOcclusion(distance=2)
    """

    __slots__ = ("distance",)
    _kind = "ambient_occlusion"


class Albedo(Node):
    """Albedo of the first surface, without lighting; black where rays hit no surface.

    Example:
        integrators.Albedo()
    """

    __slots__ = ()
    _kind = "albedo"


class Normals(Node):
    """Shading normals in world space, after normal and bump mapping, as colors, (n + 1) / 2; black
    where rays hit no surface.

    Example:
        integrators.Normals()
    """

    __slots__ = ()
    _kind = "normals"


class Depth(Node):
    """Distance from the camera to the first surface, along the ray, as a gray value; 0 where rays
    hit no surface.

    Args:
        far (number above 0): Distance that is shown as 1 (white), in scene units, above 0. Without
            it the value is the distance itself, for EXR and PFM files.

    Example:
        integrators.Depth(far=20)
    """

    __slots__ = ("far",)
    _kind = "depth"
