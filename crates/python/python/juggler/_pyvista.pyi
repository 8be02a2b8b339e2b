from collections.abc import Sequence
from typing import Any

from . import typing as t
from .scene_types import Scene

def from_pyvista(
    source: Any,
    *,
    values: str | None = None,
    cmap: str | Sequence[str] | Any = "viridis",
    clim: Sequence[float] | None = None,
    nan: t.ColorLike = "#808080",
    point_radius: float | None = None,
) -> Scene:
    """A `Scene` of a mesh, a block of meshes or a plotter of pyvista.

    Of a plotter come the meshes with their scalars, color maps and transforms, the background, the
    camera and the lights; a warning names what is not shown. Of a mesh, `values` is the name of the
    array that `cmap` colors as in `sci.surface`, by default that of its active scalars.
    """
