# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of lights."""

from ._node import Node

__all__ = [
    "Ambient",
    "Area",
    "Directional",
    "Point",
    "Spot",
]


class Ambient(Node):
    """Ambient light: constant incident radiance at every surface, scaled by each material's ambient
    reflectance. Only the classic integrator uses it; with path tracing, use a background instead.

    Args:
        color (color; default (1, 1, 1)): Color of the light, linear RGB.
        intensity (number from 0 to 1e+30; W/(scene unit² sr); default 0.1): Factor on `color`.

    Example:
        lights.Ambient(intensity=0.1)
    """

    __slots__ = ("color", "intensity")
    _kind = "ambient"


class Area(Node):
    """A surface that emits light from its front. The camera sees it; its back is black.

    Args:
        shape (area shape; default {"rectangle": {"size": (1, 1)}}): Form and size of the surface.
        position (3 numbers; scene units; default (0, 0, 0)): Center of the surface, world space.
        direction (3 numbers): Direction that the front faces, of any length. Without it and without
            `look_at`, the front faces straight down. A sphere has no front.
        look_at (3 numbers; scene units): Point that the front faces, in world space; replaces
            `direction`.
        color (color; default (1, 1, 1)): Color of the light, linear RGB; a factor on `radiance` or
            `power`.
        radiance (number from 0 to 1e+30; W/(scene unit² sr)): Radiance of the front in watts per
            square scene unit and steradian, times `color`. It determines how bright the surface
            looks. The default is 1, unless `power` is given.
        power (number from 0 to 1e+30; W): Radiant flux of the whole surface in watts per channel,
            times `color`; replaces `radiance`. At the same power, a larger surface has a lower
            radiance.
        light_group (string): Light group; the light of each group is written to its own AOV.

    Example:
        lights.Area(shape=shapes.Rectangle(size=(2, 1)), position=(0, 4, 0), look_at=(0, 0, 0), radiance=10)
    """

    __slots__ = (
        "shape",
        "position",
        "direction",
        "look_at",
        "color",
        "radiance",
        "power",
        "light_group",
    )
    _kind = "area"


class Directional(Node):
    """Infinitely distant light with the same direction everywhere.

    Args:
        direction (3 numbers; default (0, -1, 0)): Direction in which the light travels, in world
            space, of any length.
        color (color; default (1, 1, 1)): Color of the light, linear RGB.
        intensity (number from 0 to 1e+30; W/scene unit²; default 1): Factor on `color`. The product
            is the irradiance on a surface that faces the light.
        angle_degrees (number from 0 to 180): Angular diameter of the light's disk, in degrees.
            Larger angles give softer shadows; the sun has 0.53. The default, 0, gives hard shadows.
        samples (whole number from 1 to 10000): Number of shadow rays per shading point, sampled
            over the disk. Only the classic integrator uses it. More samples give less noise in
            penumbras. Without an angle it has no effect.
        light_group (string): Light group; the light of each group is written to its own AOV.

    Example:
        lights.Directional(direction=(-1, -2, -1), intensity=2)
    """

    __slots__ = ("direction", "color", "intensity", "angle_degrees", "samples", "light_group")
    _kind = "directional"


class Point(Node):
    """Light that emits uniformly in all directions.

    Args:
        position (3 numbers; scene units; default (0, 0, 0)): Center of the light, in world space.
        color (color; default (1, 1, 1)): Color of the light, linear RGB.
        intensity (number from 0 to 1e+30; W/sr): Radiant intensity in watts per steradian, times
            `color`. It equals the irradiance of a facing surface at distance 1 with the default
            attenuation. The default is 1, unless `power` is given.
        power (number from 0 to 1e+30; W): Radiant flux in watts per channel, times `color`;
            replaces `intensity`. The intensity is power / 4π. A photometric file distributes the
            same flux over directions.
        attenuation (`Attenuation`): Falloff with distance.
        range (number from 9.999999999999999e-31; scene units): Distance d from the light's center
            at which its light ends: a factor of 1 − (d / `range`)⁴ on the falloff. By default there
            is no end. `intensity` and `power` hold for the light without it.
        extent (extent): Size of the light, for soft shadows. The default is a point, which casts
            hard shadows.
        samples (whole number from 1 to 10000; default 1): Number of shadow rays per shading point,
            sampled over the extent. Only the classic integrator uses it. More samples give less
            noise in penumbras. Without an extent it has no effect.
        ies (`Ies`): Photometric file with the measured distribution of intensity over directions.
        light_group (string): Light group; the light of each group is written to its own AOV.

    Example:
        lights.Point(position=(-4, 7, 5), intensity=75)
    """

    __slots__ = (
        "position",
        "color",
        "intensity",
        "power",
        "attenuation",
        "range",
        "extent",
        "samples",
        "ies",
        "light_group",
    )
    _kind = "point"


class Spot(Node):
    """Point light that emits into a cone.

    Args:
        position (3 numbers; scene units; default (0, 0, 0)): Center of the light, in world space.
        direction (3 numbers; default (0, -1, 0)): Axis of the cone, in world space, of any length.
        color (color; default (1, 1, 1)): Color of the light, linear RGB.
        intensity (number from 0 to 1e+30; W/sr): Radiant intensity on the axis in watts per
            steradian, times `color`. It equals the irradiance of a facing surface on the axis at
            distance 1 with the default attenuation. The default is 1, unless `power` is given.
        power (number from 0 to 1e+30; W): Radiant flux of the whole cone in watts per channel,
            times `color`; replaces `intensity`. At the same power, a narrower cone is brighter.
        attenuation (`Attenuation`): Falloff with distance.
        range (number from 9.999999999999999e-31; scene units): Distance d from the light's center
            at which its light ends: a factor of 1 − (d / `range`)⁴ on the falloff. By default there
            is no end. `intensity` and `power` hold for the light without it.
        beam_degrees (number from 0 to 180; default 25): Angle from the axis up to which the
            intensity is constant, in degrees. Between `beam_degrees` and `cutoff_degrees` the
            intensity falls as `falloff` says.
        cutoff_degrees (number from 0 to 180; default 30): Cut-off angle: the angle from the axis
            beyond which the light emits nothing, in degrees; `beam_degrees` or more.
        falloff ("linear", "squared_cosine" or "smooth_cosine"): Falloff between `beam_degrees` and
            `cutoff_degrees`. The default is linear in the angle.
        beam_exponent (number from 0; default 0): Exponent of the cosine of the angle from the axis.
            Larger values concentrate the light around the axis; 0 has no effect.
        extent (extent): Size of the light, for soft shadows. The default is a point, which casts
            hard shadows.
        samples (whole number from 1 to 10000; default 1): Number of shadow rays per shading point,
            sampled over the extent. Only the classic integrator uses it. More samples give less
            noise in penumbras. Without an extent it has no effect.
        ies (`Ies`): Photometric file with the measured distribution of intensity over directions.
        light_group (string): Light group; the light of each group is written to its own AOV.

    Example:
        lights.Spot(position=(0, 5, 0), direction=(0, -1, 0), cutoff_degrees=30, intensity=100)
    """

    __slots__ = (
        "position",
        "direction",
        "color",
        "intensity",
        "power",
        "attenuation",
        "range",
        "beam_degrees",
        "cutoff_degrees",
        "falloff",
        "beam_exponent",
        "extent",
        "samples",
        "ies",
        "light_group",
    )
    _kind = "spot"
