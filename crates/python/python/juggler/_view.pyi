from os import PathLike
from types import TracebackType
from typing import Self, TypedDict, Unpack

from . import typing as t

class ViewSettings(TypedDict, total=False):
    """Settings of a viewer, which `juggler.view` describes."""

    size: tuple[int, int] | None
    threads: int | None
    variant: str | int | None
    animation: str | int | None
    model_scene: str | int | None
    lenient: bool | None

def view(
    scene: str | PathLike[str] | t.SceneLike, *, block: bool | None = None, **settings: Unpack[ViewSettings]
) -> View:
    """Shows a scene in the interactive viewer, and returns the `View`.

    In a notebook the viewer appears below the cell, elsewhere in the browser. A notebook whose browser
    is on another machine shows the picture instead. `block` waits until Ctrl-C; by default, scripts
    wait, since the viewer ends with Python. The settings are size=, threads=, variant=, animation=,
    model_scene= and lenient= of `render`.
    """

class View:
    """Viewer of a scene, which runs until it is closed or Python ends."""

    url: str
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        exception: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
    def close(self) -> None:
        """Ends the viewer."""
    def wait(self) -> None:
        """Waits until the viewer ends or Ctrl-C, which ends it."""
