from collections.abc import Iterator, Mapping
from os import PathLike
from typing import Any, Literal

import numpy
from numpy.typing import NDArray

from ._camera import Camera
from .scene_types import Object
from .sci import ColorMap

class Image:
    """Rendered image, with linear pixels and AOVs.

    `img.color` is an array of shape (height, width, 3), `img["depth"]` or `img.aovs["depth"]` that
    of an AOV; `img.keys()` are the names. Equal bits have an equal `hash`, which is `film.hash` of the program.
    """

    def __getitem__(self, name: str) -> NDArray[Any]: ...
    def __contains__(self, name: object) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]:
        """Names of the arrays of the image: "color", and those of its AOVs."""
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...
    def plot(
        self,
        colorbar: bool | Object | ColorMap = False,
        scale_bar: str | None = None,
        *,
        title: str | None = None,
        label: str | None = None,
        ax: Any = None,
    ) -> Any:
        """Draws the image by matplotlib, and returns the figure.

        `colorbar=True` adds a bar for each color map of `juggler.sci` in the scene, with `label`
        beside it; an object of `juggler.sci` may be given instead. `scale_bar` is a length in scene
        units with its unit, such as "1 mm", for orthographic cameras. `ax` are axes of matplotlib.
        """
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]: ...
    def __dlpack__(self, **arguments: Any) -> Any: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...
    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
    @property
    def color(self) -> NDArray[numpy.float32]:
        """Linear pixels: a read-only array of shape (height, width, 3), float32."""
    @property
    def alpha(self) -> NDArray[numpy.float32] | None:
        """Alpha of the pixels of a transparent image, by which their colors are multiplied: a
        read-only array of shape (height, width), float32. `None` for an opaque image.
        """
    @property
    def aovs(self) -> Mapping[str, NDArray[Any]]:
        """Arrays of the AOVs by name, of shape (height, width) or (height, width, channels)."""
    @property
    def names(self) -> dict[str, list[str | None]]:
        """Names that the AOVs `object_id` and `material_id` number: `names["object_id"][id]`. The
        number 0 is nothing.
        """
    @property
    def hash(self) -> str:
        """Hash of the linear pixels, in hexadecimal."""
    @property
    def fingerprint(self) -> str:
        """Fingerprint of everything that determines the pixels."""
    @property
    def frame(self) -> float:
        """Frame of the animation."""
    @property
    def stats(self) -> dict[str, Any]:
        """Mean of the pixels, and numbers of samples, rays and seconds."""
    @property
    def metadata(self) -> dict[str, str]:
        """Metadata of an image file, such as program, fingerprint and seed."""
    @property
    def camera(self) -> Camera | None:
        """Matrices of the camera; `None` for a camera without finite ones."""
    def denoised(self, denoiser: Literal["own", "oidn"] = "own") -> Image:
        """Returns the image without noise, by the denoiser "own" or "oidn" (Open Image Denoise).

        The denoiser uses the AOVs `albedo`, `normal` and `depth` if the image has them, and should have
        them: they keep edges and textures sharp. A render with `denoise=` knows more of the noise and
        gives a sharper image; such an image stays as it is.
        """
    def save(self, path: bytes | str | PathLike[str]) -> None:
        """Saves the image to a file, whose ending selects the format. An EXR file has the AOVs."""
    def to_uint8(self, tone: str | None = None, exposure: float | None = None) -> NDArray[numpy.uint8]:
        """Levels from 0 to 255 as an image file without dithering has them (`dither=False`), with
        another tone curve or exposure in stops if given: an array of shape (height, width, 3).
        """
