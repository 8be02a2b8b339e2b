"""Juggler, a physically based renderer whose images are the same bits on every machine.

    import juggler as jg
    jg.render("juggler", samples=64).save("juggler.png")

The parts of the package are loaded when they are first used.
"""

_MODULES = {
    "Cancelled": "_errors",
    "FileError": "_errors",
    "InternalError": "_errors",
    "MemoryBudgetError": "_errors",
    "MergeError": "_errors",
    "Problem": "_errors",
    "SceneError": "_errors",
    "SceneWarning": "_errors",
    "SettingsError": "_errors",
    "Comparison": "_comparison",
    "compare": "_comparison",
    "Camera": "_camera",
    "Image": "_image",
    "PartialRender": "_partial_render",
    "merge": "_partial_render",
    "Probe": "_probe",
    "Progress": "_progress",
    "Renderer": "_renderer",
    "examples": "_api",
    "frames": "_api",
    "models": "_api",
    "render": "_api",
    "render_movie": "_api",
    "show_config": "_api",
    "__version__": "_api",
}

__all__ = [name for name in _MODULES if not name.startswith("_")]


def __getattr__(name):
    module = _MODULES.get(name)
    if module is None:
        raise AttributeError(f"module 'juggler' has no attribute {name!r}")
    import importlib

    value = getattr(importlib.import_module(f"juggler.{module}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted(set(globals()) | set(_MODULES))
