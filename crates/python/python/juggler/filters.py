# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of filters."""

from ._node import Node

__all__ = [
    "Box",
    "Tent",
    "Gaussian",
    "Mitchell",
    "Juggler",
]


class Box(Node):
    """Box filter: uniform over the pixel. No blur beyond the pixel, but more aliasing than wider
    filters.

    Example:
        filters.Box()
    """

    __slots__ = ()
    _kind = "box"


class Tent(Node):
    """Tent filter: linear falloff from the center to the radius.

    Args:
        radius (number from 0.1 to 16; default 1): Radius in pixels, 0.1 to 16. Larger values blur
            more.

    Example:
        filters.Tent(radius=1)
    """

    __slots__ = ("radius",)
    _kind = "tent"


class Gaussian(Node):
    """Gaussian filter: soft, without ringing.

    Args:
        radius (number from 0.1 to 16; default 1.5): Radius of the filter in pixels, 0.1 to 16.
        sigma (number from 0.05 to 16; default 0.5): Standard deviation in pixels, 0.05 to 16.
            Larger values blur more.

    Example:
        filters.Gaussian(radius=1.5, sigma=0.5)
    """

    __slots__ = ("radius", "sigma")
    _kind = "gaussian"


class Mitchell(Node):
    """Cubic filter of Mitchell and Netravali: sharp, with small negative lobes and a radius of 2
    pixels.

    Args:
        b (number from 0 to 1; default 0.33333334): Parameter B, 0 to 1: larger values blur more.
            The authors recommend B + 2C = 1.
        c (number from 0 to 1; default 0.33333334): Parameter C, 0 to 1: larger values are sharper
            and ring more.

    Example:
        filters.Mitchell(b=0.3, c=0.35)
    """

    __slots__ = ("b", "c")
    _kind = "mitchell"


class Juggler(Node):
    """Two-pixel jitter of the Juggler's Java program, only for pictures that must match that
    program. Use it with the `stratified` sampler.

    Example:
        filters.Juggler()
    """

    __slots__ = ()
    _kind = "juggler"
