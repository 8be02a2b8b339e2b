from typing import Any

from . import typing as t
from ._node import Node

class PerFace:
    """Values of an attribute of a mesh, one for each triangle instead of each vertex."""

    values: Any
    def __init__(self, values: t.ArrayLike | t.VectorLike) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...

class ArrayMesh(Node):
    """Base class of meshes."""

class ArrayImage(Node):
    """Base class of textures and backgrounds that show an image."""

class ArrayInstances(Node):
    """Base class of instances."""
