# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of lights."""

from typing import Any, Literal, Self

from . import scene_types
from . import typing as t
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
    __match_args__ = ("color", "intensity")
    color: Any
    intensity: float | Any
    def __init__(
        self,
        *,
        color: t.ColorLike | None = None,
        intensity: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        color: t.ColorLike | None = ...,
        intensity: t.Number | None = ...,
    ) -> Self: ...

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
    __match_args__ = (
        "shape",
        "position",
        "direction",
        "look_at",
        "color",
        "radiance",
        "power",
        "light_group",
    )
    shape: Any
    position: list[float | Any] | Any
    direction: list[float | Any] | Any
    look_at: list[float | Any] | Any
    color: Any
    radiance: float | Any
    power: float | Any
    light_group: str | Any
    def __init__(
        self,
        *,
        shape: t.AreaShapeLike | None = None,
        position: t.Vec3Like | None = None,
        direction: t.Vec3Like | None = None,
        look_at: t.Vec3Like | None = None,
        color: t.ColorLike | None = None,
        radiance: t.Number | None = None,
        power: t.Number | None = None,
        light_group: str | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        shape: t.AreaShapeLike | None = ...,
        position: t.Vec3Like | None = ...,
        direction: t.Vec3Like | None = ...,
        look_at: t.Vec3Like | None = ...,
        color: t.ColorLike | None = ...,
        radiance: t.Number | None = ...,
        power: t.Number | None = ...,
        light_group: str | t.ValueForm | None = ...,
    ) -> Self: ...

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
    __match_args__ = ("direction", "color", "intensity", "angle_degrees", "samples", "light_group")
    direction: list[float | Any] | Any
    color: Any
    intensity: float | Any
    angle_degrees: float | Any
    samples: int | Any
    light_group: str | Any
    def __init__(
        self,
        *,
        direction: t.Vec3Like | None = None,
        color: t.ColorLike | None = None,
        intensity: t.Number | None = None,
        angle_degrees: t.Number | None = None,
        samples: t.Integer | None = None,
        light_group: str | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        direction: t.Vec3Like | None = ...,
        color: t.ColorLike | None = ...,
        intensity: t.Number | None = ...,
        angle_degrees: t.Number | None = ...,
        samples: t.Integer | None = ...,
        light_group: str | t.ValueForm | None = ...,
    ) -> Self: ...

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
    __match_args__ = (
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
    position: list[float | Any] | Any
    color: Any
    intensity: float | Any
    power: float | Any
    attenuation: scene_types.Attenuation | Any
    range: float | Any
    extent: Any
    samples: int | Any
    ies: scene_types.Ies | Any
    light_group: str | Any
    def __init__(
        self,
        *,
        position: t.Vec3Like | None = None,
        color: t.ColorLike | None = None,
        intensity: t.Number | None = None,
        power: t.Number | None = None,
        attenuation: t.AttenuationLike | None = None,
        range: t.Number | None = None,
        extent: t.ExtentLike | None = None,
        samples: t.Integer | None = None,
        ies: t.IesLike | None = None,
        light_group: str | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        position: t.Vec3Like | None = ...,
        color: t.ColorLike | None = ...,
        intensity: t.Number | None = ...,
        power: t.Number | None = ...,
        attenuation: t.AttenuationLike | None = ...,
        range: t.Number | None = ...,
        extent: t.ExtentLike | None = ...,
        samples: t.Integer | None = ...,
        ies: t.IesLike | None = ...,
        light_group: str | t.ValueForm | None = ...,
    ) -> Self: ...

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
    __match_args__ = (
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
    position: list[float | Any] | Any
    direction: list[float | Any] | Any
    color: Any
    intensity: float | Any
    power: float | Any
    attenuation: scene_types.Attenuation | Any
    range: float | Any
    beam_degrees: float | Any
    cutoff_degrees: float | Any
    falloff: Literal["linear", "squared_cosine", "smooth_cosine"] | Any
    beam_exponent: float | Any
    extent: Any
    samples: int | Any
    ies: scene_types.Ies | Any
    light_group: str | Any
    def __init__(
        self,
        *,
        position: t.Vec3Like | None = None,
        direction: t.Vec3Like | None = None,
        color: t.ColorLike | None = None,
        intensity: t.Number | None = None,
        power: t.Number | None = None,
        attenuation: t.AttenuationLike | None = None,
        range: t.Number | None = None,
        beam_degrees: t.Number | None = None,
        cutoff_degrees: t.Number | None = None,
        falloff: Literal["linear", "squared_cosine", "smooth_cosine"] | t.ValueForm | None = None,
        beam_exponent: t.Number | None = None,
        extent: t.ExtentLike | None = None,
        samples: t.Integer | None = None,
        ies: t.IesLike | None = None,
        light_group: str | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        position: t.Vec3Like | None = ...,
        direction: t.Vec3Like | None = ...,
        color: t.ColorLike | None = ...,
        intensity: t.Number | None = ...,
        power: t.Number | None = ...,
        attenuation: t.AttenuationLike | None = ...,
        range: t.Number | None = ...,
        beam_degrees: t.Number | None = ...,
        cutoff_degrees: t.Number | None = ...,
        falloff: Literal["linear", "squared_cosine", "smooth_cosine"] | t.ValueForm | None = ...,
        beam_exponent: t.Number | None = ...,
        extent: t.ExtentLike | None = ...,
        samples: t.Integer | None = ...,
        ies: t.IesLike | None = ...,
        light_group: str | t.ValueForm | None = ...,
    ) -> Self: ...
