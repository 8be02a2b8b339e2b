from collections.abc import Iterable, Iterator
from os import PathLike
from typing import Any, Unpack

from ._image import Image
from ._renderer import SceneLike, Settings

__version__: str

def render(scene: SceneLike, **settings: Unpack[Settings]) -> Image:
    """Renders a scene and returns the `Image`.

    `scene` is a file (scene, model or mesh), the name of a built-in scene (see `examples`), a dict
    of the scene format, or a `Scene`. The settings override those of the scene:

    size=(width, height), samples=, noise= (relative error at which the render ends), time=
    (seconds), seed=, integrator=, sampler=, max_depth=, camera= (name, or a camera), frame= or at=
    (seconds), shutter=(open, close), crop=(left, top, width, height), aovs=[names], denoise=
    (True, "own" or "oidn"), transparent= (hides the background, for files with alpha), tone= (curve),
    exposure= (stops), white_balance=, primaries=, dither=; for model files variant=, animation=, model_scene=, lenient=; threads=, max_memory= ("4G"), and
    progress= (a function that takes a `Progress`, True for a bar, False for nothing).
    """

def frames(scene: SceneLike, frames: Iterable[float], **settings: Unpack[Settings]) -> Iterator[Image]:
    """Renders frames of an animation one after the other, and yields each `Image`."""

def render_movie(
    scene: SceneLike,
    path: bytes | str | PathLike[str],
    frames: Iterable[float] | None = None,
    **settings: Unpack[Settings],
) -> None:
    """Renders frames of an animation as a movie, whose format the ending of `path` selects: .mp4,
    .webp, .apng or .gif.

    `frames` is a range, or a list of consecutive frames; all frames by default. An interrupted movie
    goes on when the same call is repeated.
    """

def models(scene: SceneLike) -> list[dict[str, Any]]:
    """Returns a description of each model of a scene or model file: format, variants, clips with
    their seconds, cameras, materials, warnings and more.
    """

def examples() -> list[str]:
    """Returns the names of the built-in scenes."""

def show_config() -> None:
    """Prints versions and features, for reports of errors."""
