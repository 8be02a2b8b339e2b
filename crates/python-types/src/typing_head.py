"""Types of the scene format for type checkers: dictionaries, and what fields accept.

Import this module under `TYPE_CHECKING`: nothing needs it at run time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol, Required, SupportsFloat, SupportsIndex
from typing import TypeAlias, TypedDict

if TYPE_CHECKING:
    from . import MODULES


class ArrayLike(Protocol):
    """Array of any library, such as NumPy, that converts itself to lists."""

    def tolist(self) -> Any: ...


Number: TypeAlias = "float | SupportsFloat | str | ValueForm"
"""Number, expression such as "=2 * radius", or value form."""
Integer: TypeAlias = "int | SupportsIndex | str | ValueForm"
"""Whole number, expression or value form."""
VectorLike: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Array of numbers, expression or value form."""
Vec2Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Two numbers, expression or value form."""
Vec3Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Three numbers, expression or value form."""
Vec4Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Four numbers, expression or value form."""
ColorLike: TypeAlias = "str | Number | Sequence[Number] | ArrayLike"
"""Color: "#rrggbb", a gray as one number, or three numbers in linear light."""
