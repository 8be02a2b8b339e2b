# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of curves."""

from typing import Any, Literal, Self

from . import typing as t
from ._node import Node

__all__ = [
    "Srgb",
    "Gamma",
    "Linear",
    "Reinhard",
    "Aces",
    "Agx",
    "PbrNeutral",
]

class Srgb(Node):
    """sRGB curve (IEC 61966-2-1), which displays expect. Values above 1 are clipped.

    Example:
        curves.Srgb()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class Gamma(Node):
    """Pure power curve, `value^(1/gamma)`.

    Args:
        gamma (number above 0; default 2.2): Exponent of the display, above 0. The default 2.2 is
            close to sRGB; larger values brighten mid-tones.

    Example:
        curves.Gamma(gamma=2.2)
    """
    __match_args__ = ("gamma",)
    gamma: float | Any
    def __init__(
        self,
        *,
        gamma: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        gamma: t.Number | None = ...,
    ) -> Self: ...

class Linear(Node):
    """No curve: linear values become levels directly, as in programs of the 1980s. On sRGB displays
    the image looks dark and high in contrast.

    Example:
        curves.Linear()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class Reinhard(Node):
    """Reinhard's curve on luminance: keeps shadows nearly linear and compresses highlights up to a
    white point. Hue and saturation are preserved as far as the display's gamut allows.

    Args:
        white (number above 0; default 4): Luminance that maps to white, after exposure; above 0.
            Larger values keep more detail in highlights, smaller ones more contrast.

    Example:
        curves.Reinhard(white=4)
    """
    __match_args__ = ("white",)
    white: float | Any
    def __init__(
        self,
        *,
        white: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        white: t.Number | None = ...,
    ) -> Self: ...

class Aces(Node):
    """Filmic tone curve of ACES 1.0, as fitted by Stephen Hill. High contrast; bright colors
    desaturate towards white. The curve keeps the exposure of ACES: middle gray 0.18 becomes 0.106,
    so raise `exposure_stops` if the image looks too dark.

    Example:
        curves.Aces()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class Agx(Node):
    """AgX: filmic tone curve over 16.5 stops, from 10 below to 6.5 above middle gray 0.18. Bright
    saturated colors fade smoothly to white. Suited to scenes of high contrast.

    Args:
        look ("base", "punchy" or "golden"; default "base"): Color grade after the curve; `base`
            applies no grade.

    Example:
        curves.Agx(look="punchy")
    """
    __match_args__ = ("look",)
    look: Literal["base", "punchy", "golden"] | Any
    def __init__(
        self,
        *,
        look: Literal["base", "punchy", "golden"] | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        look: Literal["base", "punchy", "golden"] | t.ValueForm | None = ...,
    ) -> Self: ...

class PbrNeutral(Node):
    """Khronos PBR Neutral: reproduces base colors faithfully, for product renderings and
    comparisons. Only values above 0.8 are compressed and desaturate towards white.

    Example:
        curves.PbrNeutral()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...
