from collections.abc import Callable
from typing import Any, ClassVar, Self

def plain(value: object, collect: Callable[[Any], object] | None = None) -> Any: ...

def same(mine: object, yours: object) -> bool: ...
def shown(value: object) -> str: ...
def suggestion(name: str, names: Any) -> str: ...

class Unfit(TypeError): ...

class Node:
    """Part of a scene: a shape, a material, a camera, the whole scene."""

    __hash__: ClassVar[None]  # type: ignore[assignment]
    _fields: ClassVar[tuple[str, ...]]
    _kind: ClassVar[str | None]
    _positional: ClassVar[tuple[str, ...]]
    _required: ClassVar[tuple[str, ...]]
    _keys: ClassVar[dict[str, str]]
    _constants: ClassVar[dict[str, Any]]
    _unwritten: ClassVar[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __replace__(self, **changes: Any) -> Self: ...
    def to_dict(self) -> dict[str, Any]:
        """Returns the JSON form: dicts, lists, strings, numbers and booleans."""
    def to_json(self, collect: Callable[[Any], object] | None) -> dict[str, Any]:
        """Returns the JSON form; `collect` may replace arrays, as for `plain`."""
    def _members(self, collect: Callable[[Any], object] | None) -> dict[str, Any]: ...
