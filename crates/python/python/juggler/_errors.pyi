from collections.abc import Iterable
from typing import Literal

class Problem:
    """A mistake of a scene.

    `path` leads to the value (`objects[0].shape.sphere.radius`), `severity` is "error" or
    "warning", and `file`, `line` and `column` are `None` unless the scene was read from a file.
    `made_at` is the line of code that made the part, if `juggler.trace_nodes` was on.
    """

    path: str
    message: str
    help: str | None
    severity: Literal["error", "warning"]
    file: str | None
    line: int | None
    column: int | None
    made_at: str | None

class SceneError(ValueError):
    """The scene has mistakes, all of which are in `problems`."""

    problems: list[Problem]
    def __init__(self, message: str, problems: Iterable[Problem] = ()) -> None: ...

class SettingsError(ValueError):
    """A setting or an argument is wrong."""

class MergeError(ValueError):
    """Partial renders do not fit together, or do not make a whole image."""

class FileError(OSError):
    """A file cannot be read or written."""

class MemoryBudgetError(MemoryError):
    """The render needs more memory than `max_memory`."""

class Cancelled(Exception):
    """The render was cancelled."""

class InternalError(RuntimeError):
    """The renderer failed because of a mistake of its own."""

class SceneWarning(UserWarning):
    """A scene can be rendered, but the result may not be the intended one."""
