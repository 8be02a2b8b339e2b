"""Scientific pictures: surfaces, spheres, arrows and tubes colored by values, with views of them."""

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

from . import textures
from . import typing as t
from ._array_nodes import PerFace
from .cameras import Orthographic, Perspective
from .scene_types import Object

__all__ = ["ColorMap", "arrows", "axes", "camera", "color_maps", "flat", "spheres", "surface", "tubes"]

Numbers: TypeAlias = t.ArrayLike | Sequence[Any]
"""Array of numbers, or lists of them."""
Colors: TypeAlias = str | Sequence[str] | Any
"""Name of a color map, a list of colors, or a color map of matplotlib."""
Limits: TypeAlias = tuple[float, float] | Sequence[float] | None
"""Values at both ends of a color map; by default the least and the greatest value."""
Bounds: TypeAlias = Object | Sequence[Object] | Sequence[Sequence[float]] | t.ArrayLike
"""Least and greatest corner of a box, an object, or a list of objects."""

color_maps: tuple[str, ...]
"""Names of the color maps; each has a reversed one, whose name ends in "_r"."""

class ColorMap(textures.Ramp):
    """Color ramp over the values of a mesh or of instances, from the value `clim[0]` to `clim[1]`.

    `cmap` is the name of a color map, or a list of its colors. With `normalized`, the input is 0 at
    `clim[0]` and 1 at `clim[1]`, instead of the values themselves.
    """

    cmap: Any
    clim: Any
    label: Any
    normalized: Any
    def __init__(
        self,
        *,
        cmap: str | Sequence[str],
        clim: Sequence[float],
        label: str | None = None,
        normalized: bool | None = None,
        input: t.NumberInput | None = None,
    ) -> None: ...
    def colors(self) -> list[str]:
        """The colors of the map, evenly spaced, as "#rrggbb"."""

def surface(
    vertices: Numbers,
    faces: Numbers,
    *,
    values: Numbers | PerFace | None = None,
    cmap: Colors = "viridis",
    clim: Limits = None,
    nan: t.ColorLike = "#808080",
    color: t.ColorLike = "#c8c8c8",
    normals: Numbers | None = None,
    smooth: bool = False,
    lit: bool = True,
    name: str | None = None,
) -> Object:
    """An `Object` of the triangles or quadrilaterals `faces` between `vertices`.

    `values` has a number for each vertex or for each face (`juggler.PerFace` says so where both are
    as many), which `cmap` colors from `clim[0]` to `clim[1]`, by default the least and the greatest
    value. Faces with a value that is not finite have the color `nan`. `smooth` shades edges smoothly
    without `normals`; `lit=False` shows the exact colors of the map, without light and shadow.
    """

def spheres(
    centers: Numbers,
    radii: float | Numbers = 1.0,
    *,
    values: Numbers | None = None,
    cmap: Colors = "viridis",
    clim: Limits = None,
    nan: t.ColorLike = "#808080",
    color: t.ColorLike = "#c8c8c8",
    lit: bool = True,
    name: str | None = None,
) -> Object:
    """An `Object` of spheres: `radii` is one number, or one for each of the centers. `values` has a
    number for each sphere, which `cmap` colors as in `surface`.
    """

def arrows(
    starts: Numbers,
    vectors: Numbers,
    *,
    scale: float = 1.0,
    values: Numbers | Literal["length"] | None = None,
    cmap: Colors = "viridis",
    clim: Limits = None,
    nan: t.ColorLike = "#808080",
    color: t.ColorLike = "#c8c8c8",
    lit: bool = True,
    name: str | None = None,
) -> Object:
    """An `Object` of arrows from `starts` along `vectors`, whose lengths are multiplied by `scale`.
    `values` has a number for each arrow, which `cmap` colors as in `surface`; "length" stands for
    the lengths of the vectors. Vectors of length 0 have no arrow.
    """

def tubes(
    lines: Numbers | Sequence[Numbers],
    radius: float | Numbers | Sequence[Numbers] = 1.0,
    *,
    values: Numbers | Sequence[Numbers] | None = None,
    cmap: Colors = "viridis",
    clim: Limits = None,
    nan: t.ColorLike = "#808080",
    color: t.ColorLike = "#c8c8c8",
    sides: int = 16,
    lit: bool = True,
    name: str | None = None,
) -> Object:
    """An `Object` of tubes along `lines`: an array of points of shape (n, 3), or a list of such
    arrays. `radius` and `values`, which `cmap` colors as in `surface`, are one number for each point:
    an array, or a list of arrays for a list of lines. `radius` may be one number.
    """

def camera(
    bounds: Bounds,
    view: Literal["isometric", "+x", "-x", "+y", "-y", "+z", "-z"] | Sequence[float] = "isometric",
    *,
    up: Literal["x", "y", "z"] = "y",
    parallel: bool = False,
    fov_degrees: float = 30,
    margin: float = 1.1,
) -> Perspective | Orthographic:
    """A camera that sees all of a box from the side of `view`: "isometric", "+x", "-x", ..., or the
    direction from the box to the camera.

    `bounds` is a pair of corners, an object or a list of objects, and `up` is the vertical axis. A
    view from above, such as `view="+z", up="z"`, has y at the picture's top, or -z if `up` is "y".
    With `parallel`, rays are parallel, so that lengths can be compared (`Image.plot(scale_bar=...)`).
    `margin` is the factor on the size of the view.
    """

def axes(
    bounds: Bounds,
    *,
    radius: float | None = None,
    colors: Sequence[t.ColorLike] = ("#c02020", "#20a020", "#2040d0"),
) -> Object:
    """An `Object` of three thin cylinders along the edges of a box at its least corner: x, y and z.

    `radius` is 1/200 of the box's diagonal by default.
    """

def flat() -> dict[str, Any]:
    """Settings of `juggler.render` for exact colors without light and shadow:
    `juggler.render(scene, **juggler.sci.flat())`. Objects with `lit=False` have exact colors without
    these settings, and are black with them.
    """
