from collections.abc import Iterable
from os import PathLike
from typing import Any, Self

from ._image import Image

class PartialRender(bytes):
    """Samples of some pixels of an image: the bytes of a `.jfilm` file.

    `juggler.merge` joins partial renders to the whole image. The bytes may come from another machine
    or process.
    """

    def __new__(cls, data: bytes | bytearray | memoryview) -> Self: ...
    @classmethod
    def open(cls, path: bytes | str | PathLike[str]) -> Self:
        """Reads a `.jfilm` file."""
    def save(self, path: bytes | str | PathLike[str]) -> None:
        """Writes a `.jfilm` file."""
    @property
    def description(self) -> dict[str, Any]:
        """What is rendered, and which share of it: a dict."""

def merge(
    partial_renders: Iterable[bytes | str | PathLike[str]] | bytes | str | PathLike[str],
) -> Image:
    """Joins partial renders, or `.jfilm` files, to the whole image, with the bits of an undivided
    render. A single one may be given without a list.
    """
