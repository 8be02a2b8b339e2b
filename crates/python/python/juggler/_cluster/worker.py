"""Work of one worker, a process on any machine. It keeps the worlds of the last two scenes."""

import os
import pickle
import socket
import threading
import time
import traceback
from collections import OrderedDict

from juggler._cluster.mark import Ended, watch

# Number of scenes whose worlds a worker keeps.
_KEPT = 2

_renderers = OrderedDict()
_lock = threading.Lock()


def version():
    """Version of the package, which all workers share."""
    from juggler import _api

    return _api.__version__


def identity():
    """Name of this worker, for messages."""
    return f"{socket.gethostname()}, process {os.getpid()}"


def work(job, package, units):
    """Renders units of work, and returns an answer: a dict with the worker's `name` and `kind`.

    - "done": `data` has the bytes of the partial render, and `seconds` the time that it took. Without
      units, the worker only builds the world. Units that are frames have `images`.
    - "unknown": the worker needs the package, which is a pair of manifest and contents or `None`.
    - "cancelled": the job has ended, or the worker does not see its mark.
    - "refused": the worker does not fit, for the reason in `error`.
    - "failed": `error` is the exception.

    The function raises no exception, so that one of the future means that the worker was lost.
    """
    answer = {"name": identity(), "kind": "done"}
    try:
        return {**answer, **_render(job, package, units)}
    except Ended:
        return {**answer, "kind": "cancelled"}
    except Exception as error:
        return {**answer, "kind": "failed", "error": _portable(error)}


def _render(job, package, units):
    if job["version"] != version():
        return {"kind": "refused", "error": f"it has Juggler {version()}, not {job['version']}"}
    start, callback = time.monotonic(), watch(job.get("mark"))
    renderer = _renderer(job, package)
    if renderer is None:
        return {"kind": "unknown"}
    if job["fingerprint"] is not None and units:
        fingerprint = renderer._native.fingerprint(job["frame"])
        if fingerprint != job["fingerprint"]:
            message = f"its scene has the fingerprint {fingerprint}, not {job['fingerprint']}"
            return {"kind": "refused", "error": message}
    built = time.monotonic()
    if job["kind"] == "frames":
        from juggler import Image

        images = [(index, Image(renderer._native.render(callback, frame=frame))) for index, frame in units]
        return {"images": images, "seconds": time.monotonic() - built}
    if not units:
        fingerprint = renderer._native.fingerprint(job["frame"])
        return {"data": None, "fingerprint": fingerprint, "seconds": time.monotonic() - start}
    data = renderer._native.render_units(units, job["frame"], callback)
    return {"data": data, "build": built - start, "seconds": time.monotonic() - built}


def _renderer(job, package):
    """Returns the renderer of a job; `None` if the worker needs the package for it."""
    key = job["key"]
    with _lock:
        if key in _renderers:
            _renderers.move_to_end(key)
            return _renderers[key]
    if package is None:
        return None
    from juggler import Renderer
    from juggler._cluster.package import unpack

    manifest, blobs = package
    renderer = Renderer(unpack(manifest, blobs() if callable(blobs) else blobs), **job["settings"])
    with _lock:
        # Another thread of this process may have been faster.
        renderer = _renderers.setdefault(key, renderer)
        while len(_renderers) > _KEPT:
            _renderers.popitem(last=False)
    return renderer


def _portable(error):
    """Returns an exception that can be pickled, with the traceback of the worker as a note."""
    note = f"On the worker {identity()}:\n{''.join(traceback.format_exception(error)).rstrip()}"
    error = error.with_traceback(None)
    error.__cause__ = error.__context__ = None
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        error = RuntimeError(f"{type(error).__name__}: {error}")
    error.add_note(note)
    return error
