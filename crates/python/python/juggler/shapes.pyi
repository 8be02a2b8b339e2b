# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of shapes."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

from . import scene_types
from . import typing as t
from ._array_nodes import PerFace
from ._array_nodes import ArrayMesh
from ._node import Node

__all__ = [
    "Sphere",
    "Plane",
    "Disk",
    "Rectangle",
    "Triangle",
    "Polygon",
    "Cuboid",
    "Cylinder",
    "Tube",
    "Mesh",
]

class Sphere(Node):
    """A sphere around the origin of object space.

    Surface coordinates: u is the longitude as a fraction of a turn (0 at +x, a quarter at -z), v
    the latitude from 0 at the south pole (-y) to 1 at the north pole (+y).

    Args:
        radius (number above 0; default 1): Radius in scene units, above 0.

    Example:
        shapes.Sphere(radius=1)
    """
    __match_args__ = ("radius",)
    radius: float | Any
    def __init__(
        self,
        *,
        radius: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        radius: t.Number | None = ...,
    ) -> Self: ...

class Plane(Node):
    """The infinite plane y = 0; its front faces +y.

    Surface coordinates: u is x, v is z, in scene units.

    Example:
        shapes.Plane()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class Disk(Node):
    """A disk in the plane y = 0 around the origin, with or without a hole; its front faces +y.

    Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z), v goes
    from 0 at the outer rim to 1 at the inner rim or the center.

    Args:
        radius (number above 0; default 1): Outer radius in scene units, above 0.
        inner_radius (number from 0; default 0): Radius of the hole in scene units, 0 to less than
            `radius`; 0 for no hole.

    Example:
        shapes.Disk(radius=2, inner_radius=0.5)
    """
    __match_args__ = ("radius", "inner_radius")
    radius: float | Any
    inner_radius: float | Any
    def __init__(
        self,
        *,
        radius: t.Number | None = None,
        inner_radius: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        radius: t.Number | None = ...,
        inner_radius: t.Number | None = ...,
    ) -> Self: ...

class Rectangle(Node):
    """A rectangle in the plane y = 0, centered on the origin; its front faces +y.

    Surface coordinates from 0 to 1: u grows with x, v with -z, so that an image is upright seen
    from above with -z up.

    Args:
        size (2 numbers above 0; default (1, 1)): Edge lengths along x and z in scene units, above
            0.

    Example:
        shapes.Rectangle(size=(2, 1))
    """
    __match_args__ = ("size",)
    size: list[float | Any] | Any
    def __init__(
        self,
        *,
        size: t.Vec2Like | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        size: t.Vec2Like | None = ...,
    ) -> Self: ...

class Triangle(Node):
    """A triangle. Its vertices run counter-clockwise seen from the front.

    Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the vertices.

    Args:
        vertices (3 groups of 3 numbers; required): The three corners in scene units, not collinear.
        normals (3 groups of 3 numbers): Shading normals at the corners, of any length above 0,
            interpolated over the triangle. Without them, the triangle is shaded flat.
        uvs (3 groups of 2 numbers): Surface coordinates of the corners, interpolated over the
            triangle.

    Example:
        shapes.Triangle([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    """
    __match_args__ = ("vertices", "normals", "uvs")
    vertices: list[list[float | Any] | Any] | Any
    normals: list[list[float | Any] | Any] | Any
    uvs: list[list[float | Any] | Any] | Any
    def __init__(
        self,
        vertices: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm,
        *,
        normals: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = None,
        uvs: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        vertices: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm = ...,
        normals: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        uvs: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = ...,
    ) -> Self: ...

class Polygon(Node):
    """A flat convex polygon. Its vertices run counter-clockwise seen from the front.

    Surface coordinates in scene units from the first vertex: u along the first edge, v at right
    angles to it.

    Args:
        vertices (list of groups of 3 numbers; required): At least three corners in order, in scene
            units: coplanar, convex, no corner twice.

    Example:
        shapes.Polygon([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    """
    __match_args__ = ("vertices",)
    vertices: list[list[float | Any] | Any] | Any
    def __init__(
        self,
        vertices: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm,
    ) -> None: ...
    def replace(
        self,
        *,
        vertices: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm = ...,
    ) -> Self: ...

class Cuboid(Node):
    """An axis-aligned box from one corner to the opposite one; by default the cube of edge 1 around
    the origin.

    Surface coordinates from 0 to 1 on each face. On the sides, v grows with y and u to the right,
    seen from outside. On top and bottom, u grows with x; v grows with -z on top and with z on the
    bottom.

    Args:
        min (3 numbers; default (-0.5, -0.5, -0.5)): Corner of the smallest coordinates, in scene
            units.
        max (3 numbers; default (0.5, 0.5, 0.5)): Corner of the largest coordinates, in scene units,
            each greater than that of `min`.

    Example:
        shapes.Cuboid(min=(-1, 0, -1), max=(1, 2, 1))
    """
    __match_args__ = ("min", "max")
    min: list[float | Any] | Any
    max: list[float | Any] | Any
    def __init__(
        self,
        *,
        min: t.Vec3Like | None = None,
        max: t.Vec3Like | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        min: t.Vec3Like | None = ...,
        max: t.Vec3Like | None = ...,
    ) -> Self: ...

class Cylinder(Node):
    """A circular cylinder around the y axis from `y_min` to `y_max`.

    Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z); v goes
    from 0 at `y_min` to 1 at `y_max` on the side, from 0 at the rim to 1 at the center on the caps.

    Args:
        radius (number above 0; default 1): Radius in scene units, above 0.
        y_min (number; default -1): Lower end on the y axis, in scene units.
        y_max (number; default 1): Upper end on the y axis, in scene units; greater than `y_min`.
        capped (True or False; default True): Whether disks close both ends and make the cylinder a
            solid; without them, the inside is visible.

    Example:
        shapes.Cylinder(radius=0.5, y_min=0, y_max=2)
    """
    __match_args__ = ("radius", "y_min", "y_max", "capped")
    radius: float | Any
    y_min: float | Any
    y_max: float | Any
    capped: bool | Any
    def __init__(
        self,
        *,
        radius: t.Number | None = None,
        y_min: t.Number | None = None,
        y_max: t.Number | None = None,
        capped: bool | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        radius: t.Number | None = ...,
        y_min: t.Number | None = ...,
        y_max: t.Number | None = ...,
        capped: bool | t.ValueForm | None = ...,
    ) -> Self: ...

class Tube(Node):
    """An infinite circular cylinder around the y axis.

    Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z), v is y
    in scene units.

    Args:
        radius (number above 0; default 1): Radius in scene units, above 0.

    Example:
        shapes.Tube(radius=0.5)
    """
    __match_args__ = ("radius",)
    radius: float | Any
    def __init__(
        self,
        *,
        radius: t.Number | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        radius: t.Number | None = ...,
    ) -> Self: ...

class Mesh(ArrayMesh):
    """A triangle mesh, from a file or from the arrays given here. The corners of a triangle run
    counter-clockwise seen from the front.

    Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the corners of
    each triangle.

    Args:
        file (string): Model file (PLY, OBJ, STL), relative to the scene file, instead of the arrays
            below. A PLY file may have all of these arrays: attributes of its elements `vertex` and
            `face` are columns `attribute.NAME`, or `attribute.NAME.0` to `attribute.NAME.3` of
            several numbers per value, of type `uchar`, `ushort` or `float`.
        positions (list of groups of 3 numbers): Corner positions in scene units.
        triangles (list of groups of 3 whole numbers from 0): Three indices into `positions` for
            each triangle, counted from 0.
        normals (list of groups of 3 numbers): Shading normals, interpolated over each triangle:
            none, or one per position, of any length. A zero normal counts as missing. Without
            normals, `crease_angle_degrees` decides the shading.
        uvs (list of groups of 2 numbers): Surface coordinates, interpolated over each triangle:
            none, or one per position.
        uvs1 (list of groups of 2 numbers): Second set of surface coordinates, for textures with
            `uv_set` 1: none, or one per position.
        tangents (list of groups of 4 numbers): Tangents x, y, z of any length, along which normal
            maps and anisotropic highlights lie, and the sign of the bitangent, 1 or -1: none, or
            one per position. Without tangents they follow the surface coordinates. A zero tangent
            counts as missing.
        attributes (dict from names to `MeshAttribute` objects): Named attributes of the vertices or
            triangles, such as `color`, for the texture `attribute`.
        crease_angle_degrees (number from 0 to 180): Largest angle between the normals of two
            neighboring triangles whose edge is shaded smoothly, in degrees, 0 to 180: 30 to 60 for
            machine parts, 180 for a wholly smooth surface. Without it, a mesh without `normals` is
            shaded flat. It has no effect on a mesh with `normals`.
        morphs (list of `Morph` objects): Morph targets (blend shapes), each added in proportion to
            its weight: position = base + Σ weight · (target - base).

    Example:
        shapes.Mesh("bunny.ply")
    """
    __match_args__ = (
        "file",
        "positions",
        "triangles",
        "normals",
        "uvs",
        "uvs1",
        "tangents",
        "attributes",
        "crease_angle_degrees",
        "morphs",
    )
    file: str | Any
    positions: list[list[float | Any] | Any] | Any
    triangles: list[list[int | Any] | Any] | Any
    normals: list[list[float | Any] | Any] | Any
    uvs: list[list[float | Any] | Any] | Any
    uvs1: list[list[float | Any] | Any] | Any
    tangents: list[list[float | Any] | Any] | Any
    attributes: dict[str, scene_types.MeshAttribute | Any] | Any
    crease_angle_degrees: float | Any
    morphs: list[scene_types.Morph | Any] | Any
    def __init__(
        self,
        file: str | t.ValueForm | None = None,
        *,
        positions: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = None,
        triangles: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = None,
        normals: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = None,
        uvs: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = None,
        uvs1: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = None,
        tangents: Sequence[t.Vec4Like] | t.ArrayLike | str | t.ValueForm | None = None,
        attributes: Mapping[str, t.MeshAttributeLike | t.ArrayLike | Sequence[Any] | PerFace] | t.ValueForm | None = None,
        crease_angle_degrees: t.Number | None = None,
        morphs: Sequence[t.MorphLike] | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        file: str | t.ValueForm | None = ...,
        positions: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        triangles: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        normals: Sequence[t.Vec3Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        uvs: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        uvs1: Sequence[t.Vec2Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        tangents: Sequence[t.Vec4Like] | t.ArrayLike | str | t.ValueForm | None = ...,
        attributes: Mapping[str, t.MeshAttributeLike | t.ArrayLike | Sequence[Any] | PerFace] | t.ValueForm | None = ...,
        crease_angle_degrees: t.Number | None = ...,
        morphs: Sequence[t.MorphLike] | t.ValueForm | None = ...,
    ) -> Self: ...
