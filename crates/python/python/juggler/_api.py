"""Functions of the package that need no object."""

import os

from juggler import _native

__version__ = dict(_native.configuration())["version"]


def render(scene, **settings):
    """Renders a scene and returns the `Image`.

    `scene` is a file (scene, model or mesh), the name of a built-in scene (see `examples`), a dict
    of the scene format, or a `Scene`. The settings override those of the scene:

    size=(width, height), samples=, noise= (relative error at which the render ends), time=
    (seconds), seed=, integrator=, sampler=, max_depth=, camera= (name, or a camera), frame= or at=
    (seconds), shutter=(open, close), crop=(left, top, width, height), aovs=[names], denoise=
    (True, "own" or "oidn"), transparent= (hides the background, for files with alpha), tone= (curve),
    exposure= (stops), white_balance=, primaries=, dither=; for model files variant=, animation=, model_scene=, lenient=; threads=, max_memory= ("4G"), and
    progress= (a function that takes a `Progress`, True for a bar, False for nothing).
    """
    from juggler._renderer import Renderer

    return Renderer(scene, **settings).render()


def frames(scene, frames, **settings):
    """Renders frames of an animation one after the other, and yields each `Image`."""
    from juggler._arguments import numbers_of_frames
    from juggler._renderer import Renderer

    frames = numbers_of_frames(frames, settings)
    return _images(Renderer(scene, **settings), frames)


def _images(renderer, frames):
    for frame in frames:
        renderer.frame = frame
        yield renderer.render()


def render_movie(scene, path, frames=None, **settings):
    """Renders frames of an animation as a movie, whose format the ending of `path` selects: .mp4,
    .webp, .apng or .gif.

    `frames` is a range, or a list of consecutive frames; all frames by default. An interrupted movie
    goes on when the same call is repeated.
    """
    from juggler._movie import render_movie

    return render_movie(scene, path, frames, settings)


def models(scene):
    """Returns a description of each model of a scene or model file: format, variants, clips with
    their seconds, cameras, materials, warnings and more.
    """
    import json

    from juggler._scene import native_scene

    return json.loads(native_scene(scene).models())


def examples():
    """Returns the names of the built-in scenes."""
    return [name for name, _ in _native.examples()]


def show_config():
    """Prints versions and features, for reports of errors."""
    import sys

    lines = [("juggler", ""), *_native.configuration(), ("python", sys.version.split()[0])]
    numpy = sys.modules.get("numpy")
    lines.append(("numpy", numpy.__version__ if numpy else "not loaded"))
    lines.append(("package", os.path.dirname(__file__)))
    print("\n".join(f"{name:10}{value}".rstrip() for name, value in lines))


for _function in (render, frames, render_movie, models, examples, show_config):
    _function.__module__ = "juggler"
del _function
