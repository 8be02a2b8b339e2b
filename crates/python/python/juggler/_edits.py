"""Edits of scenes of a renderer, which keeps arrays as assets."""

import json
import re

from ._node import PARTS_WITH_ARRAYS, Node
from ._scene import to_json
from ._trace import STEP

# Members of a scene whose keys are names, not kinds.
_NAMED = ("cameras", "materials", "textures")


class _Members:
    """A part of a scene that stands at the path of its kind."""

    def __init__(self, node):
        self.node = node

    def to_json(self, collect):
        return self.node._members(collect)


def set_value(native, path, value):
    """Sets the value at a path of a renderer."""
    parents = _parents(path) if isinstance(path, str) else ()
    if parents:
        edited = _edited(native, parents, value)
        if edited is not None:
            path, value = edited
        elif isinstance(value, Node) and value._kind == parents[0][1]:
            if len(parents) < 2 or parents[1][1] not in _NAMED:
                value = _Members(value)
    native.set_value(path, *to_json(value, path))


def _parents(path):
    """The last steps of a path, the last first: the path before each, and its key."""
    if path.startswith("/"):
        parts = path.split("/")
        steps = [("/".join(parts[:end]), parts[end]) for end in range(1, len(parts))]
    else:
        found = re.finditer(STEP, path)
        steps = [(path[: step.start()], step[1] or step[2] or step[3]) for step in found]
    return steps[::-1]


def _edited(native, parents, value):
    """Path and new value of a part of which an array or an attribute is set; `None` for other edits.

    The arrays of such a part are one asset, so that the part is made again from its arrays.
    """
    depth = 2 if len(parents) > 2 and parents[1][1] == "attributes" else 1
    path = parents[depth - 1][0]
    if len(parents) <= depth or parents[depth][1] not in PARTS_WITH_ARRAYS:
        return None
    from importlib import import_module

    module, name = PARTS_WITH_ARRAYS[parents[depth][1]]
    part = getattr(import_module(f"juggler.{module}"), name)
    field = "attributes" if depth == 2 else parents[0][1]
    if field not in (*getattr(part, "_arrays", ("array",)), "attributes"):
        return None
    members = _members_of(native, path)
    if members is None or field not in part._fields or not all(key in part._fields for key in members):
        return None
    if field == "array":
        members.pop("file", None)
    if depth == 2:
        value = {**(members.get("attributes") or {}), parents[0][1]: value}
        value = {name: one for name, one in value.items() if one is not None}
    return path, _Members(part(**{**members, field: value}))


def _members_of(native, path):
    """Members of the part at a path, with the arrays of its asset; `None` if it has no asset."""
    try:
        members = json.loads(native.value(path))
    except KeyError:
        return None
    asset = dict(native.scene().assets()).get(members.get("file")) if isinstance(members, dict) else None
    if asset is None:
        return None
    lists = asset.members()
    if lists is None:
        return members
    from ._arrays import numpy

    del members["file"]
    fields = json.loads(lists)
    arrays = {
        name: numpy().array(value, "u4" if name == "triangles" else "f4")
        for name, value in fields.items()
        if name != "attributes"
    }
    return {**fields, **arrays, **members}
