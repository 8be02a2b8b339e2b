"""The process that deals work, collects partial renders and makes the image.

A driver works over a pool of workers with these methods:

- `count()`: number of workers at the moment;
- `start(job, task)`: gives a task to a worker that is free, and returns whether there is one;
- `answers(seconds)`: waits for at most that long, and returns pairs of a task and an answer. In place of
  an answer, a pair may have an exception: the worker was lost;
- `check()`: looks for workers that came and went; `idle()`: number of workers without a task;
- `stop()`: gives up all work.
"""

import time
import warnings

from juggler._arguments import seconds, source
from juggler._cluster.dealer import BLOCK, Dealer, rounds_of
from juggler._cluster.errors import ClusterError
from juggler._cluster.mark import Mark
from juggler._cluster.package import Package
from juggler._cluster.worker import version
from juggler._errors import FileError, SettingsError
from juggler._files import file_name
from juggler._image import Image
from juggler._progress import Progress, checked, display
from juggler._renderer import Renderer
from juggler._scene import warn

# Seconds between looks at answers.
_TICK = 0.05
# Seconds between calls of a progress function, and between pictures.
_REPORT_INTERVAL = 0.1
_PICTURE_INTERVAL = 1.0
# Seconds after which a render without any worker ends.
_NO_WORKER_SECONDS = 120.0


class ClusterProgress(Progress):
    """Progress of a render on several workers: that of other renders, the number of `workers`, and the
    `image` so far.
    """

    _fields = (*Progress._fields, "workers")
    __slots__ = ("_ledger", "workers")

    def __init__(self, stage, share, seconds, seconds_left, samples, workers, ledger):
        super().__init__(stage, share, seconds, seconds_left, samples)
        self.workers = workers
        self._ledger = ledger

    @property
    def image(self):
        """The image so far; pixels without samples are black."""
        return Image(self._ledger.snapshot())


class Job:
    """Render of one image."""

    def __init__(self, scene, settings, checkpoint=None, checkpoint_every=60.0, preview=False):
        scene = source(scene)
        self.progress = checked(settings.pop("progress", None))
        if settings.get("time") is not None:
            raise SettingsError("`time` acts on one machine only; give `samples` or `noise`")
        by_samples_alone = not any(settings.get(name) for name in ("aovs", "denoise", "noise"))
        if preview and not by_samples_alone:
            message = "`preview` renders the samples of a tile in several rounds, which `{}` does not allow"
            raise SettingsError(
                message.format(next(n for n in ("aovs", "denoise", "noise") if settings.get(n)))
            )
        self.checkpoint = None if checkpoint is None else file_name(checkpoint)
        self.every, self.preview = seconds("checkpoint_every", checkpoint_every), preview
        self.package = Package(scene, bool(settings.get("lenient")))
        self.renderer = Renderer(self.package.native, **settings)
        self.frame, self.kind = self.renderer.frame, "still"
        self.settings = _portable(settings)
        self.is_adaptive = settings.get("noise") is not None
        self.start, self.saved, self.ledger = time.monotonic(), time.monotonic(), None
        # Exists while the job goes on.
        self.mark = None

    def description(self, threads=None):
        """What workers need to know, beside the package."""
        settings = dict(self.settings)
        if settings.get("threads") is None and threads is not None:
            settings["threads"] = threads
        fingerprint = self.ledger.fingerprint() if self.ledger is not None else None
        return {
            "kind": self.kind,
            "version": version(),
            "key": self.package.key(settings),
            "settings": settings,
            "frame": float(self.frame),
            "fingerprint": fingerprint,
            "mark": None if self.mark is None else self.mark.place,
        }

    def open(self):
        """Builds the world, and makes the film that partial renders fill. Continues from the checkpoint
        if it exists.
        """
        self.renderer.frame = self.frame
        self.ledger = self.renderer._native.ledger()
        warn(self.renderer._native.take_warnings())
        if self.checkpoint is not None:
            damage = self.ledger.resume(self.checkpoint)
            if damage:
                warnings.warn(
                    f"{damage}; continuing from the previous checkpoint", RuntimeWarning, stacklevel=4
                )

    def dealer(self, workers):
        """Deals what the film lacks."""
        rounds = rounds_of(self.ledger.samples(), self.preview)
        units = [self.ledger.missing(samples, workers) for samples in rounds]
        # The noise of all samples of a tile decides whether it needs more.
        block = None if self.is_adaptive else BLOCK
        return Dealer(units, workers, share=8 if self.is_adaptive else 4, block=block)

    def save(self):
        """Saves the checkpoint, if there is one."""
        if self.checkpoint is not None and self.ledger is not None:
            self.ledger.save()
            self.saved = time.monotonic()


def _portable(settings):
    """Returns settings that every process can read: without the frame, which each task has, and with a
    camera as a dict.
    """
    settings = {
        name: value for name, value in settings.items() if value is not None and name not in ("frame", "at")
    }
    camera = settings.get("camera")
    if hasattr(camera, "to_dict"):
        settings["camera"] = camera.to_dict()
    return settings


class Driver:
    """Renders a job on the workers of a pool."""

    def __init__(self, pool, job):
        self._pool = pool
        self._job = job
        self._dealer = None
        self._description = None
        self._seen = time.monotonic()

    def run(self):
        """Renders, and returns the image."""
        with display(self._progress()) as shown:
            if shown.is_live:
                return shown.follow(self._images(shown))
            for image in self._images(shown):
                pass
            return image

    def _images(self, shown):
        """Yields the image so far once a second where it is shown, and the whole image at last."""
        job = self._job
        try:
            job.mark = Mark()
            self._pool.prepare(job)
            job.open()
            self._description = job.description(self._pool.threads)
            self._dealer = job.dealer(self._pool.count())
            picture, report = time.monotonic(), 0.0
            while not self._is_done():
                self._step()
                now = time.monotonic()
                if shown.callback and now - report >= _REPORT_INTERVAL:
                    report = now
                    self._report(shown)
                if shown.is_live and now - picture >= _PICTURE_INTERVAL:
                    picture = now
                    yield Image(job.ledger.snapshot())
                if job.checkpoint is not None and now - job.saved >= job.every:
                    job.save()
            if shown.callback:
                self._report(shown)
        finally:
            self._stop()
            job.save()
        yield Image(job.ledger.develop())
        job.ledger.close()

    def _stop(self):
        """Gives up all work, also that which has begun on this machine."""
        if self._job.mark is not None:
            self._job.mark.remove()
        self._pool.stop()

    def _progress(self):
        """What the display calls: a function of the user gets the number of workers, too."""
        function = self._job.progress
        if not callable(function):
            return function

        def with_workers(progress):
            values = (getattr(progress, name) for name in Progress._fields)
            function(ClusterProgress(*values, self._pool.count(), self._job.ledger))

        return with_workers

    def _report(self, shown):
        share, samples = self._job.ledger.progress()
        seconds = time.monotonic() - self._job.start
        left = seconds * (1 - share) / share if share > 0 else None
        shown.callback("rendering", share, seconds, left, samples)

    def _is_done(self):
        """Whether the film is complete. If all tasks are done and samples are missing nonetheless, they
        are dealt again.
        """
        if self._dealer.in_flight or self._dealer.has_more:
            return False
        if self._job.ledger.is_finished():
            return True
        self._dealer = self._job.dealer(self._pool.count())
        if not self._dealer.has_more:
            raise ClusterError("the film is incomplete, and no work is left")
        return False

    def _step(self):
        """Deals tasks to free workers, and adds the partial renders that came."""
        self._pool.check()
        self._dealer.workers = self._pool.count()
        while self._may_deal() and self._pool.is_free() and (task := self._dealer.next()) is not None:
            self._pool.start(self._description, task)
        while self._pool.idle() and (task := self._dealer.copy()) is not None:
            self._pool.start(self._description, task)
        for task, answer in self._pool.answers(_TICK):
            self._receive(task, answer)
        self._watch_for_workers()

    def _may_deal(self):
        return True

    def _receive(self, task, answer):
        if isinstance(answer, BaseException):
            self._lose(task, "a worker", answer)
            return
        kind, name = answer["kind"], answer["name"]
        if kind == "failed":
            raise answer["error"]
        if kind == "refused":
            raise ClusterError(f"the worker {name} cannot help: {answer['error']}")
        if kind == "cancelled":
            # The worker does not see the mark of this job.
            self._description = {**self._description, "mark": None}
            if task is not None:
                self._dealer.again(task)
        elif task is None:
            self._greet(answer)
        elif kind == "unknown":
            self._dealer.again(task)
        else:
            self._add(task, answer)

    def _greet(self, answer):
        """Checks the fingerprint of a worker that built its world before the driver did."""
        found, expected = answer["fingerprint"], self._description["fingerprint"]
        if found != expected:
            message = f"its scene has the fingerprint {found}, not {expected}"
            raise ClusterError(f"the worker {answer['name']} cannot help: {message}")

    def _add(self, task, answer):
        name = f"partial render of the worker {answer['name']}"
        try:
            self._job.ledger.add(answer["data"], name)
        except FileError as error:
            # The bytes were damaged on their path.
            self._lose(task, answer["name"], error)
        else:
            self._dealer.done(task, answer["seconds"])

    def _lose(self, task, worker, error):
        if task is not None and not self._dealer.lost(task, worker, error):
            reasons = "; ".join(f"{worker}: {type(error).__name__}: {error}" for worker, error in task.losses)
            raise ClusterError(f"{task} was lost {len(task.losses)} times: {reasons}") from error

    def _watch_for_workers(self):
        now = time.monotonic()
        if self._pool.count():
            self._seen = now
        elif now - self._seen > _NO_WORKER_SECONDS:
            raise ClusterError(f"there was no worker for {_NO_WORKER_SECONDS:g} seconds")
