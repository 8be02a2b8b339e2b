from typing import Literal

import numpy
from numpy.typing import ArrayLike, NDArray

def denoise(
    color: ArrayLike,
    *,
    albedo: ArrayLike | None = None,
    normal: ArrayLike | None = None,
    depth: ArrayLike | None = None,
    denoiser: Literal["own", "oidn"] = "own",
) -> NDArray[numpy.float32]:
    """Returns the linear pixels of an image without noise: an array of shape (height, width, 3), float32.

    `color` has the shape (height, width, 3). The shape (2, height, width, 3) means two images, each of
    one half of the samples: their difference is the noise, so that the result is sharper. The features
    keep edges and textures sharp: `albedo` from 0 to 1 (height, width, 3), the `normal` of the surface
    (height, width, 3), and `depth`, the distance along the ray (height, width). `denoiser` is "own" or
    "oidn" (Open Image Denoise, if installed).
    """
