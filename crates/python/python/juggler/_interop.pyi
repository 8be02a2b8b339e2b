from collections.abc import Sequence
from os import PathLike
from typing import Any

from . import typing as t
from .scene_types import Scene

def from_trimesh(mesh: Any, *, point_radius: float | None = None) -> Scene:
    """A `Scene` of a `trimesh.Trimesh`, `trimesh.PointCloud` or `trimesh.Scene`, with its colors,
    textures and transforms. The scene's camera is used if it has one of its own.
    """

def from_open3d(
    geometry: Any, *, point_radius: float | None = None, line_radius: float | None = None
) -> Scene:
    """A `Scene` of a geometry of Open3D or a list of them: triangle meshes with colors and textures,
    point clouds, and line sets.
    """

def from_meshio(
    mesh: Any,
    *,
    values: str | None = None,
    cmap: str | Sequence[str] | Any = "viridis",
    clim: Sequence[float] | None = None,
    nan: t.ColorLike = "#808080",
) -> Scene:
    """A `Scene` of the triangles and quadrilaterals of a `meshio.Mesh`, and of the boundary of its
    tetrahedra, hexahedra, wedges and pyramids. `values` is the name of an array of its `point_data`,
    which `cmap` colors as in `sci.surface`.
    """

def from_gltf(
    path: bytes | str | PathLike[str],
    *,
    variant: str | int | None = None,
    animation: str | int | None = None,
    scene: str | int | None = None,
    at: Any = None,
    lenient: bool = False,
    **fields: Any,
) -> Scene:
    """A `Scene` of a model file, with its cameras and lights: the sections of `Scene.load`, in which
    the model has this variant, animation clip, scene, time `at` and other `fields` of `Model`.
    `lenient` shows missing and broken pictures gray.
    """
