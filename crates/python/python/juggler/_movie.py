"""Movies, which the program renders in a process of its own."""

import json
import os
import subprocess
import sys
import time
from contextlib import contextmanager

from juggler import _native
from juggler._arguments import source
from juggler._errors import Cancelled, FileError, SettingsError
from juggler._files import file_name
from juggler._progress import checked, display
from juggler._scene import native_scene, to_json, warn

# Number after that of the last frame that a movie may have.
_END_OF_FRAMES = 2**32 - 1
# Endings of files.
_ENDINGS = (".mp4", ".webp", ".apng", ".gif")
# Seconds in which the program notices a signal, and in which it saves what it has.
_PATIENCE = 0.3
_SAVING_SECONDS = 30.0

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
        elif name in ("lenient", "transparent"):
            words += [f"--{name}"] if value else []
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


def frames_of(frames):
    """Returns the range of frames that a range, a list or an array of consecutive frames selects."""
    try:
        numbers = frames if isinstance(frames, range) else [_whole(frame) for frame in frames]
        chosen = range(numbers[0], numbers[0] + len(numbers))
        if numbers in (chosen, list(chosen)) and 0 <= chosen.start and chosen.stop <= _END_OF_FRAMES:
            return chosen
    except (TypeError, ValueError, LookupError, OverflowError):
        pass
    message = "`frames` of a movie are consecutive frames from 0 on, such as range(0, 30)"
    raise SettingsError(f"{message}, not {frames!r}", "frames")


def _whole(frame):
    number = int(frame)
    if number != frame:
        raise ValueError
    return number


def file_of(path):
    """Returns the name of the file of a movie, whose ending must be that of one."""
    name = file_name(path)
    if not name.lower().endswith(_ENDINGS):
        message = f"`{name}` is no movie: the ending must be one of {' '.join(_ENDINGS)}"
        raise SettingsError(message, "path")
    return name


class _Messages:
    """Messages of the program on its standard error: progress is shown, the others are kept."""

    def __init__(self, callback):
        self._callback = callback
        self._start = time.monotonic()
        # Samples of all frames.
        self._samples = 0
        self._others = []

    def read(self, stream):
        """Reads all messages until the program ends."""
        for line in stream:
            if line.startswith("{"):
                self._show(json.loads(line))
            else:
                self._others.append(line)

    def _show(self, event):
        number, count = event.get("frame", 1), event.get("frames", 1)
        if event["event"] == "start":
            width, height = event["size"]
            self._samples = count * width * height * (event["samples"] or 0)
            self.show((number - 1) / count, None)
        elif event["event"] == "progress":
            left = event.get("film_eta_seconds", event["eta_seconds"])
            self.show(event.get("film_fraction", event["fraction"]), left)

    def show(self, share, left):
        """Shows the share of all frames."""
        if self._callback:
            seconds = time.monotonic() - self._start
            self._callback("rendering", share, seconds, left, round(share * self._samples))

    def warnings(self):
        """Warnings of the program."""
        return [line.strip() for line in self._others if line.startswith("warning: ")]

    def error(self):
        """Text of the error with which the program ended."""
        text = "".join(line for line in self._others if not line.startswith("warning: ")).strip()
        return text.removeprefix("error: ").removesuffix("For more information, try '--help'.").rstrip()


def _run(words, text, messages):
    """Runs the program with a text as its input, and returns its exit status."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen(
        words,
        stdin=nothing if text is None else pipe,
        stdout=nothing,
        stderr=pipe,
        env=environment,
        encoding="utf-8",
    ) as process:
        try:
            if text is not None:
                try:
                    process.stdin.write(text)
                    process.stdin.close()
                except BrokenPipeError:
                    # The program has refused a flag.
                    pass
            messages.read(process.stderr)
            return process.wait()
        except BaseException:
            _interrupt(process)
            raise


def _interrupt(process):
    """Ends the program, which saves what it has."""
    import signal

    ends = (
        process.terminate if os.name == "nt" else lambda: process.send_signal(signal.SIGINT),
        process.kill,
    )
    # Ctrl-C on a terminal has reached the program, too, and a second signal would end it at once.
    for seconds, end in zip((_PATIENCE, _SAVING_SECONDS), ends):
        try:
            process.wait(seconds)
            return
        except subprocess.TimeoutExpired:
            end()


def render_movie(scene, path, frames, settings):
    """Renders a movie, see `juggler.render_movie`."""
    scene = source(scene)
    if getattr(scene, "_lenient", False):
        settings = {**settings, "lenient": True}
    plain = {name: value for name, value in settings.items() if name not in ("max_memory", "progress")}
    _native.check_settings(plain)
    progress, path = checked(settings.get("progress")), file_of(path)
    # The exceptions of a wrong scene are better than the program's messages.
    native = native_scene(scene, bool(settings.get("lenient")))
    # With all frames, a file `.webp` is a movie, too. The clip of a model decides how many there are.
    chosen = ".." if frames is None else "{0.start}..{0.stop}".format(frames_of(frames))
    words = [sys.executable, "-m", "juggler", "render", f"--output={path}", *_flags(settings)]
    words += [f"--frames={chosen}", "--progress=json"]
    with display(progress, live=False) as shown, _source(scene, native) as (word, text):
        messages = _Messages(shown.callback)
        status = _run([*words, word], text, messages)
        if status == 0:
            messages.show(1.0, 0.0)
    warn(messages.warnings())
    if status == 2:
        raise SettingsError(messages.error())
    if status in (130, 143, -2, -15):
        raise Cancelled(messages.error() or "the movie was interrupted; the same call goes on with it")
    if status:
        raise FileError(messages.error())
