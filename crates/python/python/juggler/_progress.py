"""Progress of renders."""

import sys
import time

# Seconds after which a bar appears.
_DELAY = 1.0
# Characters of a bar.
_WIDTH = 40


class Progress:
    """Progress of a render: `stage` ("reading", "preparing", "building" or "rendering"), `share` of
    this stage (0 to 1), `seconds` so far, `seconds_left` (`None` if unknown), and `samples` of all
    pixels so far.

    Meshes and pictures are prepared; then the world is built. The share may decrease while a stage
    finds more work. The last progress of a complete render has the share 1.
    """

    _fields = ("stage", "share", "seconds", "seconds_left", "samples")
    __slots__ = _fields

    def __init__(self, stage, share, seconds, seconds_left, samples):
        self.stage = stage
        self.share = share
        self.seconds = seconds
        self.seconds_left = seconds_left
        self.samples = samples

    def __repr__(self):
        return f"Progress({', '.join(f'{name}={getattr(self, name)!r}' for name in self._fields)})"


def duration(seconds):
    """Writes seconds as 4s, 9m56s or 2h03m04s."""
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours}h{minutes:02}m{seconds:02}s"
    return f"{minutes}m{seconds:02}s" if minutes else f"{seconds}s"


class Display:
    """Shows the progress of one render, as a context. This one shows nothing."""

    callback = None
    is_live = False

    def __enter__(self):
        return self

    def finish(self, image=None):
        """Notes that the render is done, and its image if there is one."""

    def __exit__(self, *error):
        return None


class Callback(Display):
    """Calls a function with each progress."""

    def __init__(self, function):
        self._function = function
        self._start = time.monotonic()
        self._samples = 0

    def callback(self, *values):
        """Calls the function with the values of a `Progress`."""
        progress = Progress(*values)
        self._samples = progress.samples
        self._function(progress)

    def finish(self, image=None):
        """Calls the function with the share 1, which the renderer does not report."""
        samples = self._samples
        if image is not None:
            width, height = image.size
            samples = round(image.stats["samples"] * width * height)
        self.callback("rendering", 1.0, time.monotonic() - self._start, 0.0, samples)


class Bar(Display):
    """Bar on a terminal."""

    def __init__(self, stream):
        self._stream = stream
        self._is_shown = False
        self.callback = self._show

    def _show(self, *values):
        progress = Progress(*values)
        if progress.seconds < _DELAY:
            return
        done = round(_WIDTH * progress.share)
        left = "" if progress.seconds_left is None else f" {duration(progress.seconds_left)} left"
        text = f"{100 * progress.share:3.0f} %{left}" if progress.stage == "rendering" else progress.stage
        self._stream.write(f"\r{'━' * done}{'┄' * (_WIDTH - done)} {text}\x1b[K")
        self._stream.flush()
        self._is_shown = True

    def __exit__(self, *error):
        if self._is_shown:
            self._stream.write("\r\x1b[K")
            self._stream.flush()


def checked(progress):
    """Returns the argument `progress` of a render if `display` knows it."""
    if progress is None or isinstance(progress, bool) or callable(progress):
        return progress
    raise TypeError(f"`progress` must be a function, True, False or None, not {progress!r}")


def display(progress, live=True):
    """Returns the display that `progress` selects: a function, True, False, or `None` for a bar on
    a terminal and a growing image in a notebook.
    """
    if callable(checked(progress)):
        return Callback(progress)
    if progress is None or progress is True:
        shell = notebook_shell()
        if shell is not None and live:
            from juggler._notebook import LiveImage

            return LiveImage()
        if sys.stderr is not None and (progress or sys.stderr.isatty()):
            return Bar(sys.stderr)
    return Display()


def notebook_shell():
    """Returns the shell of a notebook, if the code runs in one."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell if getattr(shell, "kernel", None) is not None else None


Progress.__module__ = "juggler"
