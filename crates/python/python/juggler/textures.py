# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of textures."""

from ._array_nodes import ArrayImage
from ._node import Node

__all__ = [
    "Image",
    "Attribute",
    "Constant",
    "Direction",
    "Checker",
    "Gradient",
    "Ramp",
    "Mix",
    "Noise",
    "Fbm",
    "Turbulence",
    "Marble",
    "Wood",
    "Voronoi",
    "Brick",
    "Dots",
    "Wave",
    "Triplanar",
    "Uv",
]


class Image(ArrayImage):
    """Image texture: PNG, JPEG, WebP, TIFF, TGA, BMP, GIF (the first frame), OpenEXR, Radiance HDR
    or PFM.

    Pictures are turned by the orientation that their Exif data states. An OpenEXR file shows its
    display window, black where it has no data; its picture is the channels R, G and B, a layer
    named `Combined`, `beauty`, `rgba`, `rgb` or `color`, the channel Y, the only color layer, or
    the only channel.

    Args:
        file (string): Path of the image file, relative to the scene file.
        color_space ("auto", "srgb" or "linear"; default "auto"): Encoding of the image's values.
            Set it to `linear` for data that is not color, such as roughness, heights and normals.
        channel ("rgb", "r", "g", "b", "a" or "luminance"; default "rgb"): Channels that the texture
            uses.
        invert (True or False; default False): Inverts values to 1 - value, before `factor`.
        factor (number from -1000000 to 1000000; default 1): Factor on the values, -1e6 to 1e6.
        wrap ("repeat", "mirror", "clamp" or "black"; default "repeat"): Continuation beyond the
            image's borders.
        wrap_v ("repeat", "mirror", "clamp" or "black"): Continuation beyond the upper and lower
            border, where it differs from `wrap`.
        filter ("nearest", "bilinear" or "trilinear"; default "trilinear"): Filter that interpolates
            and averages texels.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.
        array: Texels instead of `file`: an array of shape (height, width) or (height, width,
            channels), rows from the top, with 1 to 4 channels: gray; gray and alpha; red, green and
            blue; these and alpha. Numbers of the types uint8 and uint16 are encoded as in a PNG
            file, float16 and float32 are linear; float64 is rounded to float32.

    Example:
        textures.Image("wood.png", wrap="mirror", scale=2)
    """

    __slots__ = (
        "file",
        "color_space",
        "channel",
        "invert",
        "factor",
        "wrap",
        "wrap_v",
        "filter",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "image"
    _positional = ("file",)


class Attribute(Node):
    """Attribute of a mesh, in linear light, interpolated over its triangles, or else of the
    innermost [instances](#object-instances) that have one of this name. Surfaces without an
    attribute of this name are white.

    Args:
        name (string; default "color"): Name of the attribute among the `attributes` of the mesh or
            of its instances. `color`, the colors of vertices or faces in a model file, is clamped
            to 0 to 1.
        channel ("rgb", "r", "g", "b", "a" or "luminance"; default "rgb"): Channels that the texture
            uses. A single channel gives gray. Alpha is 1 where the attribute has fewer than four
            channels.

    Example:
        textures.Attribute("color")
    """

    __slots__ = ("name", "channel")
    _kind = "attribute"
    _positional = ("name",)


class Constant(Node):
    """Constant color, which several textures and materials can share by name.

    Args:
        color (color, texture, the name of one or `InputProduct`; default (0.5, 0.5, 0.5)): The
            color.

    Example:
        textures.Constant("#c02020")
    """

    __slots__ = ("color",)
    _kind = "constant"
    _positional = ("color",)


class Direction(Node):
    """Angle of a direction whose x and y a texture encodes as red and green, in full turns. Use it
    for `anisotropy_rotation`.

    Args:
        of (color, texture, the name of one or `InputProduct`; default (1, 0.5, 0)): Texture of
            directions: red 0 to 1 is x from -1 to 1, green is y. Set an image's `color_space` to
            `linear`. The angle of directions of length 0 is 0.
        turns (number from -1000 to 1000; default 0): Angle that is added, in full turns.

    Example:
        textures.Direction(of="flow", turns=0.25)
    """

    __slots__ = ("of", "turns")
    _kind = "direction"


class Checker(Node):
    """Checkerboard of two colors: squares over (u, v) or on a plane, cubes in space.

    Args:
        size (number above 0; units of space; default 1): Edge length of a cell, in units of
            `space`.
        even (color, texture, the name of one or `InputProduct`; default (0.8, 0.8, 0.8)): Color of
            the cell on the positive side of `offset`.
        odd (color, texture, the name of one or `InputProduct`; default (0.2, 0.2, 0.2)): Color of
            the adjacent cells.
        space ("uv", "local" or "world"; default "uv"): Coordinate space of the cells.
        axes ("xyz", "xz", "xy" or "yz"; default "xyz"): Axes along which the colors alternate. The
            pattern is constant along all others.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of a corner of the cells, in
            `space`.

    Example:
        textures.Checker(size=1.2, even="#b8ae9c", odd="#34404c")
    """

    __slots__ = ("size", "even", "odd", "space", "axes", "offset")
    _kind = "checker"


class Gradient(Node):
    """Color gradient along a line or around a point, interpolated in linear light.

    Args:
        stops (list of `Stop` objects): Stops in order of rising position. Two stops at one position
            form a sharp edge.
        space ("uv", "local" or "world"; default "uv"): Coordinate space of `start` and `end`.
        start (3 numbers; units of space; default (0, 0, 0)): Point of position 0; the center of a
            radial gradient.
        end (3 numbers; units of space; default (0, 1, 0)): Point of position 1, different from
            `start`.
        shape ("linear" or "radial"; default "linear"): Shape of the gradient: `linear`, along the
            line from `start` to `end`, or `radial`, around `start`.

    Example:
        textures.Gradient(stops=[Stop(0, "#000000"), Stop(1, "#ffffff")])
    """

    __slots__ = ("stops", "space", "start", "end", "shape")
    _kind = "gradient"


class Ramp(Node):
    """Color ramp: maps a number, such as the luminance of a texture, to a color by interpolation
    between stops.

    Args:
        input (number, texture, the name of one or `InputProduct`; default 0.5): Number to map; of a
            texture, the luminance.
        stops (list of `Stop` objects): Stops in order of rising position. Two stops at one position
            form a sharp edge.
        interpolation ("linear", "smooth" or "hold"; default "linear"): Interpolation between stops.

    Example:
        textures.Ramp(input="height", stops=[Stop(0, "#000000"), Stop(1, "#ffffff")])
    """

    __slots__ = ("input", "stops", "interpolation")
    _kind = "ramp"


class Mix(Node):
    """Blend of two textures or colors, in linear light.

    Args:
        a (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Base color a.
        b (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color b that is
            blended with the base color.
        amount (number, texture, the name of one or `InputProduct`; default 0.5): Weight of the
            blend, 0 to 1; of a texture, the luminance. 0 leaves `a` unchanged.
        mode ("mix", "add", "subtract", "multiply", "screen", "difference", "lighten" or "darken";
            default "mix"): Blend mode.

    Example:
        textures.Mix(a="moss", b="stone", amount=0.3)
    """

    __slots__ = ("a", "b", "amount", "mode")
    _kind = "mix"


class Noise(Node):
    """Gradient noise of one frequency, with features about one unit of the pattern wide.

    Args:
        low (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color where the
            noise is lowest.
        high (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color where the
            noise is highest.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Noise(low="#202020", high="#e0e0e0", scale=4)
    """

    __slots__ = (
        "low",
        "high",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "noise"


class Fbm(Node):
    """Fractional Brownian motion: a sum of octaves of noise. Use it for clouds, dirt and rough
    ground.

    Args:
        low (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color where the
            noise is lowest.
        high (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color where the
            noise is highest.
        octaves (whole number from 1 to 16; default 6): Number of octaves. Each one adds finer
            detail.
        lacunarity (number from 1 to 16; default 2): Frequency of each octave over that of the one
            before.
        gain (number from 0 to 1; default 0.5): Amplitude of each octave over that of the one
            before. Larger values make the pattern rougher.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Fbm(octaves=5, scale=2)
    """

    __slots__ = (
        "low",
        "high",
        "octaves",
        "lacunarity",
        "gain",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "fbm"


class Turbulence(Node):
    """Turbulence: octaves of absolute noise, with sharp creases between round bulges. Use it for
    flames and crumpled metal.

    Args:
        low (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color where the
            noise is lowest.
        high (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color where the
            noise is highest.
        octaves (whole number from 1 to 16; default 6): Number of octaves. Each one adds finer
            detail.
        lacunarity (number from 1 to 16; default 2): Frequency of each octave over that of the one
            before.
        gain (number from 0 to 1; default 0.5): Amplitude of each octave over that of the one
            before. Larger values make the pattern rougher.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Turbulence(octaves=5, scale=2)
    """

    __slots__ = (
        "low",
        "high",
        "octaves",
        "lacunarity",
        "gain",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "turbulence"


class Marble(Node):
    """Marble: parallel veins, one per unit of the pattern along x, distorted by turbulence.

    Args:
        stone (color, texture, the name of one or `InputProduct`; default (0.85, 0.85, 0.85)): Color
            between the veins.
        vein (color, texture, the name of one or `InputProduct`; default (0.2, 0.2, 0.25)): Color of
            the veins.
        distortion (number from 0 to 1000; default 2): Amplitude of the distortion, in distances
            between veins. 0 keeps veins straight.
        sharpness (number from 0.01 to 1000; default 4): Exponent of the vein profile. 1 makes veins
            as wide as the stone between them, larger values make them thinner.
        octaves (whole number from 1 to 16; default 6): Number of octaves. Each one adds finer
            detail.
        lacunarity (number from 1 to 16; default 2): Frequency of each octave over that of the one
            before.
        gain (number from 0 to 1; default 0.5): Amplitude of each octave over that of the one
            before. Larger values make the pattern rougher.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Marble(stone="#f0ece4", vein="#404048", scale=3)
    """

    __slots__ = (
        "stone",
        "vein",
        "distortion",
        "sharpness",
        "octaves",
        "lacunarity",
        "gain",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "marble"


class Wood(Node):
    """Wood: wavy growth rings around the pattern's y axis, one per unit, with fibers along it.

    Args:
        light (color, texture, the name of one or `InputProduct`; default (0.55, 0.3, 0.13)): Color
            of early wood.
        dark (color, texture, the name of one or `InputProduct`; default (0.2, 0.08, 0.03)): Color
            of late wood, at the end of each ring.
        distortion (number from 0 to 1000; default 0.6): Amplitude of the rings' distortion, in
            widths of a ring. 0 makes them circular.
        grain (number from 0 to 1; default 0.2): Strength of the fibers. 0 hides them.
        octaves (whole number from 1 to 16; default 6): Number of octaves. Each one adds finer
            detail.
        lacunarity (number from 1 to 16; default 2): Frequency of each octave over that of the one
            before.
        gain (number from 0 to 1; default 0.5): Amplitude of each octave over that of the one
            before. Larger values make the pattern rougher.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Wood(light="#c89858", dark="#6b4020")
    """

    __slots__ = (
        "light",
        "dark",
        "distortion",
        "grain",
        "octaves",
        "lacunarity",
        "gain",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "wood"


class Voronoi(Node):
    """Cellular noise around scattered feature points, one per unit cell of the pattern. Use it for
    stones, scales and cracked ground.

    Args:
        low (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color where the
            feature is 0.
        high (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color where the
            feature is 1 or more.
        feature ("f1", "f2", "f2_minus_f1" or "cell"; default "f1"): Feature that chooses the color.
        metric ("euclidean", "manhattan" or "chebyshev"; default "euclidean"): Metric of distances
            to the feature points.
        jitter (number from 0 to 1; default 1): Random offset of the feature points in their cells:
            0 forms a grid, 1 scatters them over whole cells.
        seed (whole number from 0; default 0): Seed of the feature points and cell colors.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Voronoi(feature="f2_minus_f1", scale=6)
    """

    __slots__ = (
        "low",
        "high",
        "feature",
        "metric",
        "jitter",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "voronoi"


class Brick(Node):
    """Brick wall in x and y of the pattern, with mortar joints.

    Args:
        brick (color, texture, the name of one or `InputProduct`; default (0.45, 0.13, 0.08)): Color
            of the bricks.
        mortar (color, texture, the name of one or `InputProduct`; default (0.6, 0.6, 0.6)): Color
            of the mortar joints.
        width (number from 1e-6 to 1000000; pattern units; default 0.25): Width of a brick with its
            joint, in units of the pattern.
        height (number from 1e-6 to 1000000; pattern units; default 0.125): Height of a row with its
            joint, in units of the pattern.
        mortar_width (number from 0 to 1000000; pattern units; default 0.015): Width of the mortar
            joints, in units of the pattern. At most `width` and `height`, which include it.
        shift (number from -1000000 to 1000000; default 0.5): Offset of each row against the row
            below, in brick widths, -1e6 to 1e6.
        variation (number from 0 to 1; default 0.2): Largest random darkening of bricks, as a share
            of their color. 0 makes all bricks equal.
        seed (whole number from 0; default 0): Seed of the random darkening.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Brick(brick="#a04030", mortar="#c8c0b8")
    """

    __slots__ = (
        "brick",
        "mortar",
        "width",
        "height",
        "mortar_width",
        "shift",
        "variation",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "brick"


class Dots(Node):
    """Dots, one per unit cell of the pattern: circles over (u, v), spheres in space.

    Args:
        dot (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color of the
            dots.
        ground (color, texture, the name of one or `InputProduct`; default (0.1, 0.1, 0.1)): Color
            between the dots.
        radius (number from 0 to 0.5; default 0.25): Radius of a dot, in cell widths.
        softness (number from 0 to 1; default 0): Share of the radius over which a dot fades out. 0
            makes its edge sharp.
        jitter (number from 0 to 1; default 0): Random offset of dots from the centers of their
            cells, as a share of the room in the cell: at 1, dots may touch its border.
        seed (whole number from 0; default 0): Seed of the random offsets.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Dots(dot="#ffffff", ground="#c02020", radius=0.3)
    """

    __slots__ = (
        "dot",
        "ground",
        "radius",
        "softness",
        "jitter",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "dots"


class Wave(Node):
    """Waves with a period of one unit of the pattern: bands or rings, optionally distorted by
    noise.

    Args:
        low (color, texture, the name of one or `InputProduct`; default (0, 0, 0)): Color of the
            troughs.
        high (color, texture, the name of one or `InputProduct`; default (1, 1, 1)): Color of the
            crests.
        shape ("bands" or "rings"; default "bands"): Direction of the waves.
        profile ("sine", "saw", "triangle" or "square"; default "sine"): Shape of one period.
        distortion (number from 0 to 1000; default 0): Amplitude of the distortion, in wavelengths.
            0 keeps waves regular.
        octaves (whole number from 1 to 16; default 6): Number of octaves. Each one adds finer
            detail.
        lacunarity (number from 1 to 16; default 2): Frequency of each octave over that of the one
            before.
        gain (number from 0 to 1; default 0.5): Amplitude of each octave over that of the one
            before. Larger values make the pattern rougher.
        seed (whole number from 0; default 0): Seed of the noise. Another seed gives another pattern
            of the same kind.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Wave(shape="rings", profile="sine", scale=4)
    """

    __slots__ = (
        "low",
        "high",
        "shape",
        "profile",
        "distortion",
        "octaves",
        "lacunarity",
        "gain",
        "seed",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "wave"


class Triplanar(Node):
    """Triplanar projection of a texture along x, y and z, blended by the normal. Use it for
    surfaces without suitable surface coordinates.

    Args:
        texture (color, texture, the name of one or `InputProduct`; default (0.5, 0.5, 0.5)):
            Texture that is projected. It receives the coordinates of each projection as (u, v).
        sharpness (number from 0.1 to 1000; default 4): Exponent of the blend weights. Larger values
            make the transition between projections sharper.
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Triplanar(texture="rock", sharpness=4)
    """

    __slots__ = (
        "texture",
        "sharpness",
        "space",
        "uv_set",
        "scale",
        "rotate_degrees",
        "offset",
        "matrix",
    )
    _kind = "triplanar"


class Uv(Node):
    """Coordinates as colors, to check mappings: the fractional parts of x, y and z are red, green
    and blue.

    Args:
        space ("uv", "local" or "world"): Coordinate space of the pattern. Solid patterns (`noise`,
            `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `triplanar`) default to object space,
            all others to surface coordinates (u, v).
        uv_set (whole number from 0 to 1): Set of surface coordinates (u, v) of a mesh: 0 for `uvs`,
            1 for `uvs1`. Surfaces without a second set use their first. Only for patterns over
            surface coordinates.
        scale (number or 3 numbers; default 1): Units of the pattern per unit of `space`: 2 makes
            the pattern twice as fine. One number, or one for each axis of the pattern; not 0.
        rotate_degrees (3 numbers; degrees; default (0, 0, 0)): Rotation of the pattern about its
            origin, right-handed: first about x, then about y, then about z. Over (u, v), only the
            rotation about z is meaningful.
        offset (3 numbers; units of space; default (0, 0, 0)): Position of the pattern's origin, in
            `space`.
        matrix (6 numbers): Affine map of surface coordinates to the pattern, in place of `scale`,
            `rotate_degrees` and `offset`: with the six numbers [a, b, c, d, e, f], the point (u, v)
            shows the pattern at (a u + b v + c, d u + e v + f). Unlike the other settings, it can
            shear the pattern and rotate it after an uneven scale. `space` is then `uv`.

    Example:
        textures.Uv()
    """

    __slots__ = ("space", "uv_set", "scale", "rotate_degrees", "offset", "matrix")
    _kind = "uv"
