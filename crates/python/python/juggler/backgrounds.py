# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of backgrounds."""

from ._array_nodes import ArrayImage
from ._node import Node

__all__ = [
    "Solid",
    "Gradient",
    "Dome",
    "Environment",
    "Sky",
    "Studio",
]


class Solid(Node):
    """Background of uniform radiance.

    Args:
        color (color; W/(scene unit² sr); default (0, 0, 0)): Radiance in every direction, linear
            RGB.

    Example:
        backgrounds.Solid("#87ceeb")
    """

    __slots__ = ("color",)
    _kind = "solid"
    _positional = ("color",)


class Gradient(Node):
    """Sky with a color gradient by elevation, from the horizon to the zenith.

    Args:
        horizon (color; W/(scene unit² sr); default (0.75, 0.85, 1)): Color at the horizon.
        zenith (color; W/(scene unit² sr); default (0.25, 0.45, 1)): Color at the zenith.
        nadir (color; W/(scene unit² sr)): Color at the nadir. Without it the lower hemisphere
            mirrors the upper one.
        axis (3 numbers; default (0, 1, 0)): Direction of the zenith in world space, of any length.
        blend ("sine" or "sine_squared"; default "sine"): Interpolation between the colors.

    Example:
        backgrounds.Gradient(horizon="#d0e0ff", zenith="#3060c0")
    """

    __slots__ = ("horizon", "zenith", "nadir", "axis", "blend")
    _kind = "gradient"


class Dome(Node):
    """Inside of a huge sphere around the origin, colored by height. From near the origin it looks
    like a gradient by the sine of the elevation.

    Args:
        radius (number above 0; default 1000000): Radius of the sphere in scene units, above 0. For
            a distant sky it is much larger than the scene.
        bottom (color; W/(scene unit² sr); default (0.5, 0.5, 1)): Color at height 0 and below.
        top (color; W/(scene unit² sr); default (0.015, 0.015, 0.9)): Color at the top.

    Example:
        backgrounds.Dome(bottom="#ffffff", top="#4070c0")
    """

    __slots__ = ("radius", "bottom", "top")
    _kind = "dome"


class Environment(ArrayImage):
    """Environment map: an equirectangular image of infinitely distant surroundings.

    Args:
        file (string): Path of the image (OpenEXR, Radiance HDR, TIFF, PNG, JPEG or another format
            of textures), relative to the scene file. The image is equirectangular, twice as wide as
            high, with the first row up.
        scale (number from 0 to 1e+30; default 1): Factor on the radiance of the image.
        rotation_degrees (number from -10000 to 10000; default 0): Rotation about the vertical axis
            in degrees, from -10,000 to 10,000, counterclockwise as seen from above.
        up (3 numbers; default (0, 1, 0)): Direction of the image's top in world space, of any
            length.
        visible_as (color; W/(scene unit² sr)): Radiance that camera rays see instead, also through
            masks and through clear or rough glass without reflection inside. All other rays see the
            image. By default camera rays see it, too.
        array: Texels instead of `file`: an array of shape (height, width) or (height, width,
            channels), rows from the top, with 1 to 4 channels: gray; gray and alpha; red, green and
            blue; these and alpha. Numbers of the types uint8 and uint16 are encoded as in a PNG
            file, float16 and float32 are linear; float64 is rounded to float32.

    Example:
        backgrounds.Environment("studio.hdr", rotation_degrees=90)
    """

    __slots__ = ("file", "scale", "rotation_degrees", "up", "visible_as")
    _kind = "environment"
    _positional = ("file",)


class Sky(Node):
    """Physical sky with the sun, for clear days and twilight.

    Args:
        sun_elevation_degrees (number from -90 to 90; default 35): Elevation of the sun above the
            horizon in degrees; negative values give twilight.
        sun_azimuth_degrees (number from -10000 to 10000; default 135): Azimuth of the sun in
            degrees, from -10,000 to 10,000, clockwise as on a compass: 0 at -Z, 90 at +X.
        sun_direction (3 numbers): Direction towards the sun, of any length, in the sky's local
            space with +Y up; replaces both angles.
        turbidity (number from 1 to 10; default 2): Haziness of the air: 1 is air without haze, 2 a
            clear day, 10 thick haze.
        ground_albedo (color; default (0.3, 0.3, 0.3)): Diffuse reflectance of the ground, 0 to 1 in
            every channel. Light from the ground also brightens the sky.
        intensity (number from 0 to 1e+30; default 1): Factor on the radiance of sky, sun and
            ground.
        sun (True or False; default True): Whether the sun's disk and its direct light are included.
        up (3 numbers; default (0, 1, 0)): Direction of the sky's zenith in world space, of any
            length.

    Example:
        backgrounds.Sky(sun_elevation_degrees=30, turbidity=3)
    """

    __slots__ = (
        "sun_elevation_degrees",
        "sun_azimuth_degrees",
        "sun_direction",
        "turbidity",
        "ground_albedo",
        "intensity",
        "sun",
        "up",
    )
    _kind = "sky"


class Studio(Node):
    """Photo studio: a bright dome with four soft boxes, which lights an object well from all sides.
    Its front, where the camera usually stands, is +Z.

    Args:
        scale (number from 0 to 1e+28; default 1): Factor on the radiance. At 1, a white surface
            that faces up has the radiance 1.
        rotation_degrees (number from -10000 to 10000; default 0): Rotation about the vertical axis
            in degrees, from -10,000 to 10,000, counterclockwise as seen from above.
        up (3 numbers; default (0, 1, 0)): Direction of the studio's top in world space, of any
            length.
        visible_as (color; W/(scene unit² sr)): Radiance that camera rays see instead, also through
            masks and through clear or rough glass without reflection inside. All other rays see the
            studio itself. By default camera rays see it, too.

    Example:
        backgrounds.Studio(rotation_degrees=45)
    """

    __slots__ = ("scale", "rotation_degrees", "up", "visible_as")
    _kind = "studio"
