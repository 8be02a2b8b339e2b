"""Movies, which the program renders in a process of its own."""

import os
import subprocess
import sys
from contextlib import contextmanager

from juggler import _native
from juggler._errors import Cancelled, FileError, SettingsError
from juggler._scene import native_scene, to_json

# Flags of the program for the settings whose values need no conversion.
_FLAGS = {
    "samples": "--samples",
    "noise": "--noise",
    "integrator": "--integrator",
    "max_depth": "--max-depth",
    "camera": "--camera",
    "seed": "--seed",
    "tone": "--tone",
    "exposure": "--exposure",
    "primaries": "--primaries",
    "variant": "--variant",
    "animation": "--animation",
    "model_scene": "--model-scene",
    "threads": "--threads",
    "max_memory": "--max-memory",
}


def _flags(settings):
    """Returns the flags of the program for settings."""
    words = []
    for name, value in settings.items():
        if value is None or name == "progress":
            continue
        if name in _FLAGS:
            words.append(f"{_FLAGS[name]}={value}")
        elif name == "dither":
            words.append(f"--dither={'on' if value else 'off'}")
        elif name == "size":
            words.append(f"--size={value[0]}x{value[1]}")
        elif name == "shutter":
            words.append(f"--shutter={value[0]}..{value[1]}")
        elif name == "crop":
            words.append(f"--crop={','.join(map(str, value))}")
        elif name == "denoise":
            words += [f"--denoise={'own' if value is True else value}"] if value else []
        elif name == "white_balance":
            words.append(
                f"--white-balance={','.join(map(str, value)) if isinstance(value, (tuple, list)) else value}"
            )
        elif name == "lenient":
            words += ["--lenient"] if value else []
        else:
            raise SettingsError(f"a movie cannot have the setting `{name}`", name)
    return words


@contextmanager
def _source(scene, native):
    """The word that names the scene for the program, and its text if it is no file."""
    if isinstance(scene, (str, os.PathLike)):
        yield os.fspath(scene), None
    elif native.assets():
        # The program reads the arrays from files.
        from tempfile import TemporaryDirectory

        with TemporaryDirectory() as folder:
            file = os.path.join(folder, "scene.json")
            native.save(file)
            yield file, None
    else:
        yield "-", native.to_json() if native is scene else to_json(scene)[0]


def render_movie(scene, path, frames, settings):
    """Renders a movie, see `juggler.render_movie`."""
    if getattr(scene, "_lenient", False):
        settings = {**settings, "lenient": True}
    plain = {name: value for name, value in settings.items() if name != "max_memory"}
    _native.check_settings(plain)
    words = [sys.executable, "-m", "juggler", "render"]
    # The exceptions of a wrong scene are better than the program's messages.
    native = native_scene(scene, bool(settings.get("lenient")))
    words += [f"--output={os.fspath(path)}", *_flags(settings)]
    if frames is not None:
        frames = range(frames.start, frames.stop, frames.step)
        if frames.step != 1 or not frames:
            message = f"the frames of a movie are a range like range(0, 30), not {frames!r}"
            raise SettingsError(message, "frames")
        words.append(f"--frames={frames.start}..{frames.stop}")
    words.append("--quiet" if not settings.get("progress") else "--progress=bar")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    errors = None if settings.get("progress") else subprocess.PIPE
    with _source(scene, native) as (word, text):
        done = subprocess.run(
            [*words, word], input=text, text=True, stderr=errors, env=environment, check=False
        )
    message = (done.stderr or "").strip().removeprefix("error: ")
    if done.returncode == 2:
        raise SettingsError(message)
    if done.returncode in (130, 143, -2, -15):
        raise Cancelled(message or "the movie was interrupted; the same call goes on with it")
    if done.returncode:
        raise FileError(message)
