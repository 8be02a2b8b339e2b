"""Comparison of images."""

import os

from juggler import _native


class Comparison:
    """Difference between two images.

    `rmse`, `relative_mse` and `largest` measure the linear pixels, and `flip` (0 to 1) and
    `flip_map` the difference that people perceive. `same_but_for_noise` tells whether noise explains
    the difference, at the probability `p`; both are `None` where this could not be tested, for a
    `reason`.
    """

    __slots__ = (
        "_flip_map",
        "_size",
        "flip",
        "largest",
        "p",
        "reason",
        "relative_mse",
        "rmse",
        "same_bits",
        "same_but_for_noise",
    )

    def __init__(self, results):
        self._size, self._flip_map = results.pop("size"), results.pop("flip_map")
        for name, value in results.items():
            setattr(self, name, value)

    @property
    def flip_map(self):
        """Perceived difference of each pixel: an array of shape (height, width)."""
        from juggler._image import array

        width, height = self._size
        return None if self._flip_map is None else array(self._flip_map, "float32", (height, width))

    def __repr__(self):
        names = ("same_bits", "rmse", "flip", "same_but_for_noise", "p", "reason")
        return f"Comparison({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"


def compare(image, reference, *, significance=0.01, flip=True):
    """Compares an image with a reference; both are images or files.

    The test whether noise explains the difference needs two images that are rendered with
    `aovs=["variance"]` and different seeds.
    """
    from juggler._files import file_name
    from juggler._image import Image

    def native(image):
        if isinstance(image, Image):
            return image._native
        if isinstance(image, (str, bytes, os.PathLike)):
            return file_name(image)
        raise TypeError(f"images of Juggler or files are compared, not {type(image).__name__}")

    return Comparison(_native.compare(native(image), native(reference), significance, flip))


Comparison.__module__ = compare.__module__ = "juggler"
