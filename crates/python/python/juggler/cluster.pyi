"""Renders on the machines of a cluster, with the bits of one machine."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, Literal, Protocol, Self, TypedDict, Unpack

from juggler._image import Image
from juggler._progress import Progress

class Future(Protocol):
    """Future of an executor."""

    def done(self) -> bool: ...
    def result(self) -> Any: ...
    def cancel(self) -> Any: ...

class Executor(Protocol):
    """Executor, such as those of `concurrent.futures` and a client of Dask."""

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Future: ...

class RenderSettings(TypedDict, total=False):
    """Settings of `juggler.render` that act on several machines."""

    size: tuple[int, int]
    samples: int
    noise: float
    seed: int
    integrator: str
    sampler: str
    max_depth: int
    camera: object
    frame: float
    at: float
    shutter: tuple[float, float]
    crop: tuple[int, int, int, int]
    aovs: str | Sequence[str]
    denoise: bool | str
    tone: str
    exposure: float
    white_balance: float | tuple[float, float]
    primaries: str
    dither: bool
    variant: str | int
    animation: str | int
    model_scene: str | int
    lenient: bool
    threads: int
    max_memory: int | str
    progress: Callable[[ClusterProgress], object] | bool | None

class ClusterError(RuntimeError):
    """A render cannot go on: work was lost on three workers, or a worker does not fit."""

class WorkerLost(Exception):
    """A worker was lost with its work, which goes to other workers."""

class ClusterProgress(Progress):
    """Progress of a render on several workers."""

    workers: int
    @property
    def image(self) -> Image:
        """The image so far; pixels without samples are black."""

def render(
    scene: str | os.PathLike[str] | Mapping[str, Any] | object,
    executor: Executor,
    workers: int | None = None,
    *,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: float = 60.0,
    preview: bool = False,
    **settings: Unpack[RenderSettings],
) -> Image:
    """Renders a scene on the workers of an executor and returns the `Image`, which equals that of
    `juggler.render` to the bit.
    """

def frames(
    scene: str | os.PathLike[str] | Mapping[str, Any] | object,
    frames: Iterable[float],
    executor: Executor,
    workers: int | None = None,
    **settings: Unpack[RenderSettings],
) -> Iterator[Image]:
    """Renders frames of an animation on the workers of an executor, and yields each `Image` in order."""

def commands(
    scene: str | os.PathLike[str],
    shards: int = 16,
    system: Literal["slurm", "hyperqueue", "ssh"] = "slurm",
    output: str | os.PathLike[str] | None = None,
    **settings: Unpack[RenderSettings],
) -> str:
    """Returns a script that renders a scene file in `shards` jobs of a batch system with the program, and
    merges them to the file `output`.
    """

class Ray:
    """Ray cluster whose nodes render, as a context."""

    def __init__(self, address: str = "auto", max_nodes: int | None = None, threads: int | None = None) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
    def render(
        self,
        scene: str | os.PathLike[str] | Mapping[str, Any] | object,
        *,
        checkpoint: str | os.PathLike[str] | None = None,
        checkpoint_every: float = 60.0,
        preview: bool = False,
        **settings: Unpack[RenderSettings],
    ) -> Image:
        """Renders a scene and returns the `Image`, which equals that of `juggler.render` to the bit."""

    def frames(
        self,
        scene: str | os.PathLike[str] | Mapping[str, Any] | object,
        frames: Iterable[float],
        **settings: Unpack[RenderSettings],
    ) -> Iterator[Image]:
        """Renders frames of an animation, and yields each `Image` in order."""
