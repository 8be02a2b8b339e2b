"""Juggler renders pictures of scenes by path tracing.

The classes of the scene format are in modules that load when they are first used: one for each
family of kinds (`shapes`, `materials`, ...), `animate` for values that change over time, and
`scene_types`, whose classes (`Scene`, `Object`, ...) are here, too.

A number may be an expression such as `"=2 * radius"`, and every value may be a value form of
`animate`. Lists, tuples and arrays are equivalent, and so are classes and the dictionaries of scene
files. A field that is `None` is absent: the documentation of its class tells the default.
"""

from ._exports import MODULES as _MODULES
from ._exports import SCENE_TYPES as _SCENE_TYPES

__all__ = [*_MODULES, *_SCENE_TYPES]


def __getattr__(name):
    from importlib import import_module

    if name in _MODULES:
        return import_module(f".{name}", __name__)
    if name in _SCENE_TYPES:
        value = globals()[name] = getattr(import_module(".scene_types", __name__), name)
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *__all__})
