"""The interactive viewer of `juggler serve`, in a notebook or in a browser."""

import os
import sys

# Settings that the viewer knows, with its flags.
_FLAGS = {
    "size": "--size",
    "threads": "--threads",
    "variant": "--variant",
    "animation": "--animation",
    "model_scene": "--model-scene",
}
# Variables of notebooks whose browser is on another machine, so that it does not reach the viewer.
_REMOTE = ("COLAB_RELEASE_TAG", "JUPYTERHUB_SERVICE_PREFIX", "KAGGLE_KERNEL_RUN_TYPE", "SSH_CONNECTION")
# Height of the viewer in a notebook, in pixels.
_HEIGHT = 540


def view(scene, *, block=None, **settings):
    """Shows a scene in the interactive viewer, and returns the `View`.

    In a notebook the viewer appears below the cell, elsewhere in the browser. A notebook whose browser
    is on another machine shows the picture instead. `block` waits until Ctrl-C; by default, scripts
    wait, since the viewer ends with Python. The settings are size=, threads=, variant=, animation=,
    model_scene= and lenient= of `render`.
    """
    from juggler._progress import notebook_shell

    shown = View(scene, settings)
    if notebook_shell() is not None:
        return shown
    print(f"the viewer is at {shown.url}", file=sys.stderr)
    import webbrowser

    webbrowser.open(shown.url)
    if block or (block is None and not hasattr(sys, "ps1")):
        shown.wait()
    return shown


class View:
    """Viewer of a scene, which runs until it is closed or Python ends."""

    __slots__ = ("__weakref__", "_close", "_folder", "_process", "_scene", "_settings", "url")

    def __init__(self, scene, settings):
        import tempfile
        import weakref

        self._scene, self._settings = scene, settings
        flags = _flags(settings)
        self._folder = tempfile.TemporaryDirectory(prefix="juggler-")
        try:
            self._process, self.url = _serve(_file(scene, self._folder.name), flags, self._folder.name)
        except BaseException:
            self._folder.cleanup()
            raise
        self._close = weakref.finalize(self, _end, self._process, self._folder)

    def __repr__(self):
        return f"<juggler.View at {self.url}>" if self._close.alive else "<juggler.View, closed>"

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def close(self):
        """Ends the viewer."""
        self._close()

    def wait(self):
        """Waits until the viewer ends or Ctrl-C, which ends it."""
        try:
            self._process.wait()
        except KeyboardInterrupt:
            pass
        self.close()

    def _repr_html_(self):
        from html import escape

        if any(name in os.environ for name in _REMOTE):
            from juggler._api import render

            settings = {"time": 2, "samples": 1024, **self._settings}
            return render(self._scene, progress=False, **settings)._repr_html_()
        style = f"width:100%;height:{_HEIGHT}px;border:0"
        return f'<iframe src="{escape(self.url)}" style="{style}" allow="fullscreen"></iframe>'


def _flags(settings):
    """Flags of the program for these settings."""
    from juggler._errors import SettingsError

    flags = []
    for name, value in settings.items():
        if name == "lenient":
            flags += ["--lenient"] if value else []
        elif name not in _FLAGS:
            known = ", ".join([*_FLAGS, "lenient"])
            raise SettingsError(f"the viewer has no setting `{name}`; it has {known}", name)
        elif value is not None:
            flags += [_FLAGS[name], "x".join(map(str, value)) if name == "size" else str(value)]
    return flags


def _file(scene, folder):
    """File or built-in name of a scene, which is written to the folder if it is neither."""
    from juggler._scene import native_scene

    if isinstance(scene, (str, os.PathLike)):
        return os.fspath(scene)
    path = os.path.join(folder, "scene.json")
    native_scene(scene).save(path)
    return path


def _serve(scene, flags, folder):
    """Starts the viewer; returns its process and address. Its messages go to a file of the folder."""
    import subprocess

    words = [sys.executable, "-m", "juggler", "serve", "--addr", "127.0.0.1:0", *flags, "--", scene]
    with open(os.path.join(folder, "messages"), "w+", encoding="utf-8") as messages:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=messages)
        try:
            line = process.stdout.readline().decode()
        except BaseException:
            process.terminate()
            raise
        if line:
            return process, line.split()[-1]
        process.stdout.close()
        process.wait()
        messages.seek(0)
        message = messages.read().strip().removeprefix("error: ")
    from juggler._errors import SceneError

    raise SceneError(message or "the viewer did not start")


def _end(process, folder):
    """Ends the process of a viewer, and removes its scene."""
    process.terminate()
    process.wait()
    process.stdout.close()
    folder.cleanup()


for _public in (view, View):
    _public.__module__ = "juggler"
del _public
