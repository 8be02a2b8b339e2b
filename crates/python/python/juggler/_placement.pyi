from collections.abc import Sequence
from typing import Self

from . import typing as t
from ._node import Node

class Placement(Node):
    """Base class of objects. Steps of a transform are applied in the order of the calls."""

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Bounding box of the object with its transform: the least and the greatest corner, each x, y
        and z. Objects of infinite extent have none.
        """
    def translate(self, x: t.Number, y: t.Number, z: t.Number) -> Self:
        """Moves the object by a vector, in scene units."""
    def rotate(self, axis: t.Vec3Like, degrees: t.Number) -> Self:
        """Rotates the object about an axis through the origin: three numbers, or "x", "y" or "z".

        Positive angles turn counterclockwise, seen from the tip of the axis.
        """
    def scale(self, factor: t.Number | t.Vec3Like) -> Self:
        """Scales the object about the origin: by one factor, or by one for each axis."""
    def orient(self, quaternion: t.Vec4Like) -> Self:
        """Rotates the object about the origin by a quaternion (x, y, z, w), as in glTF."""
    def matrix(self, matrix: t.VectorLike | Sequence[Sequence[t.Number]]) -> Self:
        """Transforms the object by an affine matrix that multiplies column vectors.

        It has 3 or 4 rows of 4 numbers, as nested lists or an array, or the 12 or 16 numbers in a
        row.
        """
