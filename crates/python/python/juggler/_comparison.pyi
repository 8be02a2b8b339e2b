from os import PathLike

import numpy
from numpy.typing import NDArray

from ._image import Image

class Comparison:
    """Difference between two images.

    `rmse`, `relative_mse` and `largest` measure the linear pixels, and `flip` (0 to 1) and
    `flip_map` the difference that people perceive. `same_but_for_noise` tells whether noise explains
    the difference, at the probability `p`; both are `None` where this could not be tested, for a
    `reason`.
    """

    same_bits: bool
    rmse: float
    relative_mse: float
    largest: float
    flip: float | None
    p: float | None
    same_but_for_noise: bool | None
    reason: str | None
    @property
    def flip_map(self) -> NDArray[numpy.float32] | None:
        """Perceived difference of each pixel: an array of shape (height, width)."""

def compare(
    image: Image | bytes | str | PathLike[str],
    reference: Image | bytes | str | PathLike[str],
    *,
    significance: float = 0.01,
    flip: bool = True,
) -> Comparison:
    """Compares an image with a reference; both are images or files.

    The test whether noise explains the difference needs two images that are rendered with
    `aovs=["variance"]` and different seeds.
    """
