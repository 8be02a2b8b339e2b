"""Dealing of units of work to workers of unknown speed.

Tasks are dealt in guided sizes (Polychronopoulos and Kuck 1987): each takes a share of what remains,
so that all workers end at about the same time. The first answers calibrate the sizes. Units with more
samples than a task may have are split.
"""

import time

# Share of the remaining work of a task, for one worker.
_SHARE = 4
# Share of the whole work of a task before the first answer.
_FIRST_SHARE = 64
# Maximum cost of a task before the first answer, in samples of pixels: a second of work or so.
_FIRST_COST = 1 << 18
# Samples of a block. Units may be split where a block ends, and the pixels stay the same to the bit.
BLOCK = 16
# Seconds that a task takes at least and at most.
_SHORTEST = 0.5
_LONGEST = 30.0
# Number of workers on which a task may be lost.
_MOST_LOSSES = 3
# A task that takes this many times its estimated seconds is copied to an idle worker.
_PATIENCE = 1.5


class Task:
    """Units of work that one worker renders at a time."""

    __slots__ = ("cost", "is_done", "losses", "number", "running", "started", "units")

    def __init__(self, number, units, cost):
        self.number = number
        self.units = units
        self.cost = cost
        self.losses = []
        self.running = 0
        self.started = None
        self.is_done = False

    def __str__(self):
        if len(self.units[0]) == 2:
            return f"task {self.number} (frames {', '.join(f'{frame:g}' for _, frame in self.units)})"
        tiles = sorted({tile for tile, _, _ in self.units})
        starts = min(start for _, start, _ in self.units)
        ends = max(end for _, _, end in self.units)
        shown = f"tile {tiles[0]}" if len(tiles) == 1 else f"tiles {tiles[0]} to {tiles[-1]}"
        return f"task {self.number} ({shown}, samples {starts} to {ends})"


class Dealer:
    """Deals the units of `rounds`, lists of units with their costs, one round after the other. With
    `block`, the samples of a unit may be split at multiples of this number.
    """

    def __init__(self, rounds, workers, share=_SHARE, block=None):
        self._rounds = [list(reversed(units)) for units in rounds if units]
        self._remaining = self._total = sum(cost for units in rounds for *_, cost in units)
        self._share = share
        self._block = block
        self._count = 0
        self._lost = []
        self._running = []
        self._answers = []
        self.workers = workers

    def next(self):
        """Returns the next task: a lost one, or a new one; `None` if all are dealt."""
        task = self._lost.pop(0) if self._lost else self._cut()
        if task is not None:
            self._start(task)
        return task

    def copy(self):
        """Returns the oldest task that takes too long and runs once, to run it again; else `None`."""
        now = time.monotonic()
        for task in self._running:
            if task.running == 1 and now - task.started > self._patience(task):
                self._start(task)
                return task
        return None

    def done(self, task, seconds=None):
        """Notes an answer, which took `seconds`."""
        if seconds is not None:
            self._answers.append((task.cost, seconds))
        task.running -= 1
        task.is_done = True
        if task in self._running:
            self._running.remove(task)

    def again(self, task):
        """Notes that a worker could not begin a task, which is dealt again."""
        task.running -= 1
        if task.running == 0 and not task.is_done:
            self._running.remove(task)
            self._lost.insert(0, task)

    def lost(self, task, worker, error):
        """Notes that a worker was lost with a task. Returns whether it may be tried again."""
        task.running -= 1
        if task.is_done:
            return True
        task.losses.append((worker, error))
        if task.running == 0:
            self._running.remove(task)
            self._lost.append(task)
        return len(task.losses) < _MOST_LOSSES

    @property
    def has_more(self):
        """Whether tasks wait to be dealt."""
        return bool(self._lost) or any(self._rounds)

    @property
    def in_flight(self):
        """Number of tasks that run."""
        return len(self._running)

    def _start(self, task):
        if task.running == 0:
            self._running.append(task)
            task.started = time.monotonic()
        task.running += 1

    def speed(self):
        """Cost that a worker renders in a second, from the last answers; `None` before the first."""
        answers = self._answers[-4 * max(self.workers, 1) :]
        seconds = sum(seconds for _, seconds in answers)
        return sum(cost for cost, _ in answers) / seconds if seconds > 0 else None

    def _patience(self, task):
        speed = self.speed()
        expected = task.cost / speed if speed else 0.0
        # Two tasks may wait for one worker.
        return max(_SHORTEST, _PATIENCE * 2 * expected)

    def _size(self):
        workers, speed = max(self.workers, 1), self.speed()
        guided = self._remaining / (self._share * workers)
        if speed is None:
            return min(guided, self._total / (_FIRST_SHARE * workers), _FIRST_COST)
        return min(max(guided, speed * _SHORTEST), speed * _LONGEST)

    def _cut(self):
        """Cuts a task from the round that is dealt."""
        while self._rounds and not self._rounds[0]:
            self._rounds.pop(0)
        if not self._rounds:
            return None
        queue, size, units, cost = self._rounds[0], self._size(), [], 0
        self._split(queue, size)
        while queue and (not units or cost + queue[-1][-1] <= size):
            *unit, own = queue.pop()
            units.append(tuple(unit))
            cost += own
        self._remaining -= cost
        self._count += 1
        return Task(self._count, units, cost)

    def _split(self, queue, size):
        """Splits the next unit of a queue if it costs more than `size`."""
        if self._block is None or queue[-1][-1] <= size:
            return
        tile, start, end, cost = queue.pop()
        pixels = cost // (end - start)
        blocks = max(1, int(size / (pixels * self._block)))
        # A checkpoint may end within a block.
        middle = start - start % self._block + blocks * self._block
        if middle < end:
            queue.append((tile, middle, end, pixels * (end - middle)))
            end = middle
        queue.append((tile, start, end, pixels * (end - start)))


def rounds_of(samples, preview):
    """Ranges of samples that are dealt one after the other: all, or short ones first for a preview."""
    if not preview:
        return [(0, samples)]
    ends = [0, BLOCK]
    while ends[-1] < samples:
        ends.append(ends[-1] * 4)
    return [(start, min(end, samples)) for start, end in zip(ends, ends[1:])]
