"""Renders on the machines of a cluster, with the bits of one machine."""

from collections.abc import Callable, Iterable, Iterator
from os import PathLike
from types import TracebackType
from typing import Any, Literal, Protocol, Self, Unpack

from ._image import Image
from ._progress import Progress
from ._renderer import SceneLike, Settings

__all__ = ["ClusterError", "ClusterProgress", "Ray", "WorkerLost", "commands", "frames", "render"]

class Future(Protocol):
    """Future of an executor."""

    def done(self) -> bool: ...
    def result(self) -> Any: ...
    def cancel(self) -> Any: ...

class Executor(Protocol):
    """Executor, such as those of `concurrent.futures` and a client of Dask."""

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Future: ...

class ClusterError(RuntimeError):
    """A render cannot go on: work was lost on three workers, or a worker does not fit."""

class WorkerLost(Exception):
    """A worker was lost with its work, which goes to other workers. Executors may raise it; every
    exception of a future counts as one.
    """

class ClusterProgress(Progress):
    """Progress of a render on several workers: that of other renders, the number of `workers`, and the
    `image` so far.
    """

    workers: int
    @property
    def image(self) -> Image:
        """The image so far; pixels without samples are black."""

def render(
    scene: SceneLike,
    executor: Executor,
    workers: int | None = None,
    *,
    checkpoint: bytes | str | PathLike[str] | None = None,
    checkpoint_every: float = 60.0,
    preview: bool = False,
    **settings: Unpack[Settings],
) -> Image:
    """Renders a scene on the workers of an executor and returns the `Image`, which equals that of
    `juggler.render` to the bit.

    `executor` has a method `submit(function, *arguments)` that returns a future: an executor of
    `concurrent.futures`, a `distributed.Client` of Dask, or another one. `workers` is the number of tasks
    that it runs at a time, where the executor does not state it.

    `checkpoint` is a `.jfilm` file that is saved every `checkpoint_every` seconds and at the end; the same
    call, or the program with `--checkpoint`, goes on with it. `preview=True` renders all pixels with few
    samples first. The other arguments are those of `juggler.render`, except `time`.
    """

def frames(
    scene: SceneLike,
    frames: Iterable[float],
    executor: Executor,
    workers: int | None = None,
    **settings: Unpack[Settings],
) -> Iterator[Image]:
    """Renders frames of an animation on the workers of an executor, and yields each `Image` in order."""

def commands(
    scene: str | PathLike[str],
    shards: int = 16,
    system: Literal["slurm", "hyperqueue", "ssh"] = "slurm",
    output: str | PathLike[str] | None = None,
    **settings: Unpack[Settings],
) -> str:
    """Returns a script that renders a scene file in `shards` jobs of a batch system with the program, and
    merges them to the file `output`.
    """

class Ray:
    """Ray cluster whose nodes render, as a context.

        with juggler.cluster.Ray(address="auto") as farm:
            farm.render("scene.json", samples=4096).save("scene.png")

    `address` is that of the cluster, "auto" for the one that this machine belongs to, "local" for a new
    one on this machine alone. `max_nodes` asks an autoscaler for that many nodes. `threads` is the number
    of threads of a worker, by default that of its node's cores. Nodes that come later render, too, and
    the work of lost ones is done by others.
    """

    def __init__(
        self, address: str = "auto", max_nodes: int | None = None, threads: int | None = None
    ) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
    def render(
        self,
        scene: SceneLike,
        *,
        checkpoint: bytes | str | PathLike[str] | None = None,
        checkpoint_every: float = 60.0,
        preview: bool = False,
        **settings: Unpack[Settings],
    ) -> Image:
        """Renders a scene and returns the `Image`, which equals that of `juggler.render` to the bit. The
        arguments are those of `juggler.cluster.render`.
        """

    def frames(
        self, scene: SceneLike, frames: Iterable[float], **settings: Unpack[Settings]
    ) -> Iterator[Image]:
        """Renders frames of an animation, and yields each `Image` in order."""

    def render_movie(
        self,
        scene: SceneLike,
        path: bytes | str | PathLike[str],
        frames: Iterable[float] | None = None,
        **settings: Unpack[Settings],
    ) -> None:
        """Renders frames of an animation as a movie, whose format the ending of `path` selects. `frames`
        is a range, or a list of consecutive frames; all frames by default. An interrupted movie goes on when
        the same call is repeated.
        """
