"""Scenes and values in the forms that users give them."""

import math
import os
import sys

from juggler import _native
from juggler._node import Node, Unfit, lists_of, plain, resembles_array


def native_scene(scene, lenient=False):
    """Returns the scene of a file, a built-in name, a dict, or an object with `to_dict`."""
    if isinstance(scene, _native.Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return _native.Scene.named(os.fspath(scene), lenient)
    if not hasattr(scene, "keys") and not hasattr(scene, "to_dict"):
        kind = type(scene).__name__
        raise TypeError(f"a scene is a file, the name of a built-in scene, a dict or a Scene, not {kind}")
    lenient = lenient or getattr(scene, "_lenient", False)
    from juggler._trace import Explained

    with Explained(scene):
        text, assets = to_json(scene)
        return _native.Scene.from_json(text, lenient, None, assets)


def to_json(value, path=""):
    """Returns the JSON of a value of a scene, and the assets that it names, with their names.

    `path` leads to the value in its scene, for messages.
    """
    import json

    from ._assets import Collector

    collect = Collector()
    try:
        try:
            text = json.dumps(value, default=lambda value: _plain(value, collect), allow_nan=False)
            # Lists may be the texels of an image.
            if '"array": ' in text:
                raise _ArraysOfDicts
        except (_ArraysOfDicts, TypeError):
            text = json.dumps(plain(value, collect), default=plain, allow_nan=False)
    except (ValueError, RecursionError, Unfit) as error:
        if str(error).startswith("Out of range float"):
            try:
                error = _not_finite(plain(value, collect), path) or error
            except RecursionError as deeper:
                error = deeper
        raise _mistake(error) from None
    warn(collect.warnings)
    return text, list(collect.assets.items())


def _mistake(error):
    """The `SceneError` of an error while the text of a scene is written."""
    from juggler._errors import SceneError

    if isinstance(error, (SceneError, Unfit)):
        return error if isinstance(error, SceneError) else SceneError(str(error))
    if isinstance(error, RecursionError) or str(error).startswith("Circular reference"):
        return SceneError("the scene contains itself, or its parts are nested too deeply")
    return SceneError(f"the scene cannot be written as JSON: {str(error).split(':')[0]}")


def _not_finite(value, path):
    """The error about the first number of a value in JSON form that is not finite; `None` without one."""
    if isinstance(value, float) and not math.isfinite(value):
        from juggler._errors import Problem, SceneError

        problem = Problem(path, f"expected a finite number, found {value}")
        return SceneError(str(problem), [problem])
    if isinstance(value, dict):
        members = ((_step(path, key), member) for key, member in value.items())
    elif isinstance(value, list):
        members = ((f"{path}[{index}]", member) for index, member in enumerate(value))
    else:
        return None
    return next(filter(None, (_not_finite(member, of) for of, member in members)), None)


def _step(path, key):
    """Path of a member, as messages of the renderer write it."""
    import json

    if key and key.isascii() and key.replace("_", "a").replace("-", "a").isalnum():
        return f"{path}.{key}" if path else key
    return f"{path}[{json.dumps(key, ensure_ascii=False)}]"


def to_dict(native):
    """Returns a scene in the scene format, in which arrays of meshes and instances are lists."""
    import json

    lists = {name: asset.members() for name, asset in native.assets()}

    def in_place_of_assets(members):
        name = members.get("file")
        if not isinstance(name, str) or name not in lists:
            return members
        if lists[name] is None:
            raise TypeError(f"the asset `{name}` has no form in text; `Scene.save` writes it as a file")
        others = {key: value for key, value in members.items() if key != "file"}
        return {**json.loads(lists[name]), **others}

    return json.loads(native.to_json(), object_hook=in_place_of_assets)


class _ArraysOfDicts(Exception):
    """Raised for an array in a dict, so that the dict is read as the part of a scene that it describes."""


def _plain(value, collect):
    """Returns a value that JSON has, for one that it does not have."""
    if isinstance(value, Node):
        return value.to_json(collect)
    if getattr(value, "ndim", 0) > 0 or hasattr(value, "to_json"):
        raise _ArraysOfDicts
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if hasattr(value, "keys"):
        return {key: value[key] for key in value.keys()}
    return lists_of(value) if resembles_array(value) else plain(value, collect)


def bytes_of(size):
    """Returns the bytes of a size, such as "4G" or 4_000_000_000; K, M, G, T are powers of 1024."""
    if size is None or isinstance(size, int):
        return size
    text = str(size).strip().lower().removesuffix("b").removesuffix("i")
    power = "kmgt".find(text[-1:]) + 1 if text else 0
    try:
        count = float(text[:-1] if power else text) * 1024**power
        if count >= 1:
            return int(count)
    except (ValueError, OverflowError):
        pass
    from juggler._errors import SettingsError

    message = f'`max_memory` must be a number of bytes or a size such as "4G", not {size!r}'
    raise SettingsError(message, "max_memory")


def warn(messages):
    """Warns of the problems of a scene, at the line of the user's code."""
    if not messages:
        return
    import warnings

    from juggler._errors import SceneWarning

    level, frame = 1, sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "juggler":
        level, frame = level + 1, frame.f_back
    for message in messages:
        warnings.warn(message.removeprefix("warning: "), SceneWarning, stacklevel=level)
