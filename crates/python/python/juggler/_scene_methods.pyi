from os import PathLike
from typing import Any, Self

from ._node import Node

class SceneMethods(Node):
    """Base class of `Scene`."""

    @classmethod
    def load(cls, path: bytes | str | PathLike[str], lenient: bool = False) -> Self:
        """Loads a scene file, a model or a mesh, or the built-in scene of this name.

        The sections of the scene are lists and dictionaries, in which names of files are relative to
        the current folder. `lenient` shows missing pictures of models gray, in renders of the scene, too.
        """
    def check(self) -> list[str]:
        """Returns the warnings of the scene as texts. Raises a `SceneError` with all its mistakes."""
    def save(self, path: bytes | str | PathLike[str]) -> None:
        """Saves the scene with its animation as a scene file, and its assets beside it."""
    def models(self) -> list[dict[str, Any]]:
        """Returns a description of each model of the scene, as `juggler.models` does."""
