"""Frames of an animation on several workers."""

import os
import time

from juggler._cluster.dealer import Dealer
from juggler._cluster.driver import Driver
from juggler._cluster.mark import Mark
from juggler._movie import file_of, frames_of
from juggler._progress import display

# Frames that may be finished, for each worker, before the first of them is taken.
_AHEAD = 4


class FrameDriver(Driver):
    """Renders whole frames, one worker each."""

    def __init__(self, pool, job, frames):
        super().__init__(pool, job)
        self._all = frames
        self._finished = {}
        self._next = 0

    def images(self):
        """Yields the images in order."""
        job, start = self._job, time.monotonic()
        job.kind = "frames"
        units = [(index, float(frame), 1) for index, frame in enumerate(self._all)]
        with display(job.progress, live=False) as shown:
            try:
                job.mark = Mark()
                self._pool.prepare(job)
                self._description = job.description(self._pool.threads)
                self._dealer = Dealer([units], self._pool.count())
                while self._next < len(self._all):
                    self._step()
                    self._show(shown, start)
                    while self._next in self._finished:
                        yield self._finished.pop(self._next)
                        self._next += 1
            finally:
                self._stop()

    def _show(self, shown, start):
        if not shown.callback:
            return
        seconds, share = time.monotonic() - start, (self._next + len(self._finished)) / len(self._all)
        left = seconds * (1 - share) / share if share else None
        shown.callback("rendering", share, seconds, left, 0)

    def _may_deal(self):
        return len(self._finished) < _AHEAD * max(1, self._pool.count())

    def _greet(self, answer):
        """Takes the answer of a worker that built its world before the first task."""

    def _add(self, task, answer):
        for index, image in answer["images"]:
            if index >= self._next:
                self._finished[index] = image
        self._dealer.done(task, answer["seconds"])


def images(pool, job, frames):
    """Yields the images of frames in order. If there are fewer frames than workers, all workers render
    the tiles of each.
    """
    frames = list(frames)
    if len(frames) >= pool.count():
        yield from FrameDriver(pool, job, frames).images()
        return
    for frame in frames:
        job.frame = frame
        yield Driver(pool, job).run()


def render_movie(pool, job, path, frames):
    """Renders frames as a movie, see `juggler.cluster.Ray.render_movie`."""
    from juggler import _native

    # The clip of a model decides how many frames there are.
    count, frames_per_second = job.renderer._native.scene().animation()
    frames = range(count) if frames is None else frames_of(frames)
    path = file_of(path)
    folder = path + ".frames"
    os.makedirs(folder, exist_ok=True)
    mark = os.path.join(folder, "render")
    key = job.package.key(job.settings)
    names = {frame: os.path.join(folder, f"frame_{frame:04}.png") for frame in frames}
    if _text(mark) != key:
        # The frames of another render are of no use.
        for name in filter(os.path.exists, names.values()):
            os.remove(name)
        with open(mark, "w", encoding="utf-8") as file:
            file.write(key)
    missing = [frame for frame in frames if not os.path.exists(names[frame])]
    for frame, image in zip(missing, images(pool, job, missing)):
        image.save(names[frame])
    _native.encode_movie(path, list(names.values()), frames_per_second)
    for name in (*names.values(), mark):
        os.remove(name)
    os.rmdir(folder)


def _text(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError:
        return None
