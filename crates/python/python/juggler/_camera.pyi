from collections.abc import Iterator

import numpy
from numpy.typing import NDArray

class OpenCV:
    """Camera in the convention of OpenCV: x to the right, y down, z forward.

    A point p of the world appears at the pixel K (R p + t), divided by its third component. Pixels
    have their centers at halves: the first one at (0.5, 0.5). Unpacks as `K, R, t`.
    """

    K: NDArray[numpy.float64]
    R: NDArray[numpy.float64]
    t: NDArray[numpy.float64]
    def __iter__(self) -> Iterator[NDArray[numpy.float64]]: ...

class Camera:
    """Matrices of the camera of an image, at the middle of the shutter interval."""

    @property
    def world_to_camera(self) -> NDArray[numpy.float64]:
        """Matrix of shape (4, 4) for column vectors, from the world to the camera, in scene units,
        with x to the right, y down and z forward.
        """
    @property
    def world_to_image(self) -> NDArray[numpy.float64]:
        """Matrix of shape (3, 4) for column vectors, from the world to pixels of this image."""
    @property
    def opencv(self) -> OpenCV | None:
        """The camera as `OpenCV`: K, R and t; `None` for a camera without perspective."""
