"""Juggler renders pictures of scenes by path tracing, the same bits on every machine.

    import juggler as jg
    jg.render("juggler", samples=64).save("juggler.png")

The classes of the scene format are in modules that load when they are first used: one for each
family of kinds (`shapes`, `materials`, ...), `animate` for values that change over time, and
`scene_types`, whose classes (`Scene`, `Object`, ...) are here, too. `sci` makes scientific pictures.

A number may be an expression such as `"=2 * radius"`, and every value may be a value form of
`animate`. Lists, tuples and arrays are equivalent, and so are classes and the dictionaries of scene
files. A field that is `None` is absent: the documentation of its class tells the default.
"""

from ._exports import MODULES as _MODULES
from ._exports import SCENE_TYPES as _SCENE_TYPES

# Modules that are written by hand.
_OWN_MODULES = ("cluster", "sci")

# Modules of the names that are no modules themselves.
_NAMES = {
    "Cancelled": "_errors",
    "FileError": "_errors",
    "InternalError": "_errors",
    "MemoryBudgetError": "_errors",
    "MergeError": "_errors",
    "Problem": "_errors",
    "SceneError": "_errors",
    "SceneWarning": "_errors",
    "SettingsError": "_errors",
    "from_gltf": "_interop",
    "from_meshio": "_interop",
    "from_open3d": "_interop",
    "from_pyvista": "_pyvista",
    "from_trimesh": "_interop",
    "Comparison": "_comparison",
    "compare": "_comparison",
    "denoise": "_denoise",
    "Camera": "_camera",
    "Image": "_image",
    "PerFace": "_array_nodes",
    "PartialRender": "_partial_render",
    "merge": "_partial_render",
    "Probe": "_probe",
    "Progress": "_progress",
    "Renderer": "_renderer",
    "View": "_view",
    "view": "_view",
    "examples": "_api",
    "frames": "_api",
    "models": "_api",
    "render": "_api",
    "render_movie": "_api",
    "show_config": "_api",
    "trace_nodes": "_trace",
    "__version__": "_api",
    **dict.fromkeys(_SCENE_TYPES, "scene_types"),
}

__all__ = [*_MODULES, *_OWN_MODULES, *(name for name in _NAMES if not name.startswith("_"))]


def __getattr__(name):
    from importlib import import_module

    if name in _MODULES or name in _OWN_MODULES:
        return import_module(f".{name}", __name__)
    if name in _NAMES:
        value = globals()[name] = getattr(import_module(f".{_NAMES[name]}", __name__), name)
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *__all__})
