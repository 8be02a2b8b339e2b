from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from os import PathLike
from typing import Any, Literal, TypedDict, Unpack

from . import typing as t
from ._image import Image
from ._partial_render import PartialRender
from ._probe import Probe
from ._progress import Progress

SceneLike = str | PathLike[str] | t.SceneLike | Mapping[str, Any]

class Settings(TypedDict, total=False):
    """Settings of a render, which `juggler.render` describes. `None` counts as absent."""

    size: Sequence[int] | None
    samples: int | None
    noise: float | None
    time: float | None
    seed: int | None
    integrator: str | None
    sampler: str | None
    max_depth: int | None
    camera: str | t.CameraLike | None
    frame: float | None
    at: float | None
    shutter: Sequence[float] | None
    crop: Sequence[int] | None
    aovs: str | Sequence[str] | None
    denoise: bool | Literal["own", "oidn"] | None
    tone: str | None
    exposure: float | None
    white_balance: float | Sequence[float] | None
    primaries: str | None
    dither: bool | None
    transparent: bool | None
    variant: str | int | None
    animation: str | int | None
    model_scene: str | int | None
    lenient: bool | None
    threads: int | None
    max_memory: int | str | None
    progress: Callable[[Progress], object] | bool | None

class Renderer:
    """Scene whose world is built once and kept, so that edits and further renders are fast.

        r = juggler.Renderer("juggler", samples=64)
        r["materials.chrome.conductor.roughness"] = 0.1
        r.render().save("juggler.png")

    The settings are those of `juggler.render`. An edited scene has the same pixels, to the bit, as
    one that was so from the start. Several threads may use one renderer: an edit changes the renders
    that begin after it.
    """

    def __init__(self, scene: SceneLike, **settings: Unpack[Settings]) -> None: ...
    def __getitem__(self, path: str) -> Any:
        """Value at a path, as messages print it, or at a JSON pointer."""
    def __setitem__(self, path: str, value: object) -> None: ...
    def __delitem__(self, path: str) -> None: ...
    def __contains__(self, path: object) -> bool: ...
    camera: Any
    """Camera of the image. It has the method `replace(eye=...)`, and can be set."""
    @property
    def frame(self) -> float:
        """Frame of the animation, which may lie between two, and can be set."""
    @frame.setter
    def frame(self, frame: float) -> None: ...
    @property
    def changed(self) -> set[str]:
        """Kinds of changes between the last two renders, such as "material" and "camera"."""
    @property
    def fingerprint(self) -> str:
        """Fingerprint of everything that determines the pixels."""
    def check(self) -> None:
        """Raises a `SceneError` with all mistakes of the scene, and warns of the rest."""
    def to_dict(self) -> dict[str, Any]:
        """Returns the scene with all edits, in the scene format."""
    def models(self) -> list[dict[str, Any]]:
        """Returns a description of each model of the scene, as `juggler.models` does."""
    def render(self, progress: Callable[[Progress], object] | bool | None = None) -> Image:
        """Renders the image."""
    def progressive(self, every: float = 0.5) -> Iterator[Image]:
        """Renders better and better images: yields one each `every` seconds, at last the one that
        `render` returns. A loop that is left ends the render.
        """
    def submit(self) -> Future[Image]:
        """Starts the render on another thread, and returns a `concurrent.futures.Future`, whose
        method `cancel` ends the render.
        """
    async def render_async(self) -> Image:
        """Renders the image while other tasks of `asyncio` run; the task can be cancelled."""
    def render_shard(
        self, index: int, count: int, progress: Callable[[Progress], object] | bool | None = None
    ) -> PartialRender:
        """Renders one of `count` shards of the image, for `juggler.merge`."""
    def extend(
        self,
        partial_render: bytes | str | PathLike[str],
        samples: int | None = None,
        progress: Callable[[Progress], object] | bool | None = None,
    ) -> Image:
        """Continues a partial render, which may be a file, up to `samples` samples per pixel, and
        returns the image.
        """
    def probe(self, x: int, y: int, *, depth: int = 5, branches: int = 5, brightest: int = 5) -> Probe:
        """Explains the pixel in column `x` and row `y`, counted from 0 at the top left."""
