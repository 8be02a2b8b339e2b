"""Workers behind a method `submit`: processes of `concurrent.futures`, a client of Dask, and others."""

import os
import time

from juggler._arguments import whole
from juggler._cluster.worker import work

# Bytes of packages that travel with each task; larger ones travel when a worker asks for them.
_SMALL_PACKAGE = 1 << 20
# Tasks that wait for or run on a worker.
_IN_FLIGHT = 2
# Seconds between looks at futures.
_TICK = 0.01
# Seconds between looks at the number of workers.
_CHECK_INTERVAL = 1.0


class ExecutorPool:
    """Workers of an executor, of which only `submit` is used, and of its futures `done`, `result` and
    `cancel`. Their number is known from the executor or is given.
    """

    def __init__(self, executor, workers=None):
        if not callable(getattr(executor, "submit", None)):
            raise TypeError(f"an executor has a method `submit`; {type(executor).__name__} has none")
        self._executor = executor
        self._given = None if workers is None else whole("workers", workers, 1)
        self._is_dask = type(executor).__module__.split(".")[0] == "distributed"
        self._futures = []
        self._package = self._dask_package = None
        self._is_small = True
        self._wanting = set()
        self._checked = None
        self.check()
        self.threads = _threads_of(executor, self._is_dask, self._count)

    def count(self):
        """Number of workers."""
        return self._count

    def idle(self):
        """Number of workers without a task."""
        return max(0, self._count - len(self._futures))

    def is_free(self):
        """Whether a worker takes another task."""
        return len(self._futures) < _IN_FLIGHT * self._count

    def check(self):
        """Notes the number of workers."""
        now = time.monotonic()
        if self._checked is None or now - self._checked >= _CHECK_INTERVAL:
            self._checked = now
            self._count = self._given or _workers_of(self._executor, self._is_dask)

    def prepare(self, job):
        """Lets workers build their worlds while the driver builds its own."""
        self._package = (job.package.manifest, job.package.blobs)
        self._is_small = job.package.size <= _SMALL_PACKAGE
        description = job.description(self.threads)
        for _ in range(self._count):
            self._submit(description, None)

    def start(self, job, task):
        """Gives a task to a worker."""
        self._submit(job, task)

    def _submit(self, job, task):
        units = [] if task is None else task.units
        is_wanted = self._is_small or task is None or task.number in self._wanting
        package = self._packed() if is_wanted else None
        if self._is_dask:
            future = self._executor.submit(work, job, package, units, pure=False, retries=0)
        else:
            future = self._executor.submit(work, job, package, units)
        self._futures.append((future, task))

    def _packed(self):
        """The package as an argument. Dask sends a large one to each worker once."""
        if not self._is_dask or self._is_small:
            return self._package
        if self._dask_package is None:
            self._dask_package = self._executor.scatter(self._package, hash=False)
        return self._dask_package

    def answers(self, seconds):
        """Returns tasks with their answers, or with exceptions if a worker was lost."""
        end = time.monotonic() + seconds
        while not any(future.done() for future, _ in self._futures) and time.monotonic() < end:
            time.sleep(_TICK)
        found, waiting = [], []
        for future, task in self._futures:
            if future.done():
                found.append((task, self._answer(future, task)))
            else:
                waiting.append((future, task))
        self._futures = waiting
        return found

    def _answer(self, future, task):
        try:
            answer = future.result()
        except Exception as error:
            # The package may have been on the lost worker.
            self._dask_package = None
            return error
        if task is not None and answer["kind"] == "unknown":
            self._wanting.add(task.number)
        return answer

    def stop(self):
        """Gives up all work that has not begun."""
        for future, _ in self._futures:
            future.cancel()
        self._futures = []


def _workers_of(executor, is_dask):
    """Number of tasks that an executor runs at a time."""
    if is_dask:
        return sum(executor.nthreads().values())
    for name in ("_max_workers", "max_workers", "num_workers"):
        count = getattr(executor, name, None)
        if isinstance(count, int) and count > 0:
            return count
    return os.cpu_count() or 1


def _threads_of(executor, is_dask, workers):
    """Number of threads of a task; `None` for all cores of its process."""
    if is_dask:
        # Dask runs a task on each thread of a worker.
        return 1
    if type(executor).__module__.split(".")[0] == "concurrent":
        return max(1, (os.cpu_count() or 1) // workers)
    return None
