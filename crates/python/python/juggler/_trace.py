"""Lines of the user's code that made the parts of a scene, for messages about its mistakes."""

import sys

from . import _node
from ._errors import SceneError

# Steps of a path: `name`, `["any name"]` or `[index]`.
STEP = r'\.?([^.\[\]"]+)|\["((?:[^"\\]|\\.)*)"\]|\[(\d+)\]'


def trace_nodes(on=True):
    """Lets the parts of scenes that are made from now on remember the line of code that made them.

    Mistakes of a scene of such parts name that line: `Problem.made_at`. Tracing takes time, so it is
    off at first; `trace_nodes(False)` ends it.
    """
    _node.Node._find_place = staticmethod(_place) if on else None


def _place():
    """File and line of the nearest code outside of the package."""
    frame = sys._getframe(1)
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "juggler":
        frame = frame.f_back
    return None if frame is None else f"{frame.f_code.co_filename}:{frame.f_lineno}"


class Explained:
    """Adds to the mistakes that are found meanwhile the lines that made the wrong parts of a scene."""

    __slots__ = ("_scene",)

    def __init__(self, scene):
        self._scene = scene

    def __enter__(self):
        return self

    def __exit__(self, kind, error, traceback):
        if isinstance(error, SceneError):
            explained = _explained(error, self._scene)
            if explained is not error:
                raise explained from None


def _explained(error, scene):
    """The error with these lines; the same error if no part remembers its line."""
    for problem in error.problems:
        problem.made_at = made_at(scene, problem.path)
    lines = error.args[0].split("\n")
    if len(lines) != len(error.problems) or not any(problem.made_at for problem in error.problems):
        return error
    made = (f"; made at {problem.made_at}" if problem.made_at else "" for problem in error.problems)
    return SceneError("\n".join(map("".join, zip(lines, made))), error.problems)


def made_at(scene, path):
    """Place of the innermost part at a path of a scene that remembers one; `None` if none does."""
    import re

    value, found = scene, None
    for name, quoted, index in re.findall(STEP, path):
        found = getattr(value, "_made_at", None) or found
        value = _member(value, name or quoted, index)
    return getattr(value, "_made_at", None) or found


def _member(value, name, index):
    """The value at a step of a path; `None` if there is none."""
    if index:
        is_inside = isinstance(value, (list, tuple)) and int(index) < len(value)
        return value[int(index)] if is_inside else None
    if isinstance(value, _node.Node):
        # A kind is a key of its family: `{"sphere": {...}}` is one part.
        return value if name == value._kind else value._value_of(name)
    return value.get(name) if isinstance(value, dict) else None


trace_nodes.__module__ = "juggler"
