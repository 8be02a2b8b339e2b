"""Partial renders, and images that they make."""

import os

from juggler import _native
from juggler._files import file_name


class PartialRender(bytes):
    """Samples of some pixels of an image: the bytes of a `.jfilm` file.

    `juggler.merge` joins partial renders to the whole image. The bytes may come from another machine
    or process.
    """

    __slots__ = ()

    def __new__(cls, data):
        # Fails for bytes that are no partial render.
        _native.PartialRender(bytes(data))
        return super().__new__(cls, data)

    def __repr__(self):
        share = self.description["share"]
        return f"<juggler.PartialRender {share['index']} of {share['count']}, {len(self)} bytes>"

    __str__ = __repr__

    def __reduce__(self):
        return PartialRender, (bytes(self),)

    @classmethod
    def open(cls, path):
        """Reads a `.jfilm` file."""
        return cls(_native.PartialRender.open(file_name(path)).bytes())

    def save(self, path):
        """Writes a `.jfilm` file."""
        _native.PartialRender(bytes(self)).save(file_name(path))

    @property
    def description(self):
        """What is rendered, and which share of it: a dict."""
        import json

        return json.loads(_native.PartialRender(bytes(self)).description())


def native(partial_render):
    """Returns the partial render of a file or of bytes."""
    if not isinstance(partial_render, (str, os.PathLike, bytes, bytearray, memoryview)):
        kind = type(partial_render).__name__
        raise TypeError(f"a partial render is a PartialRender, its bytes or a file, not {kind}")
    if isinstance(partial_render, (str, os.PathLike)):
        return _native.PartialRender.open(file_name(partial_render))
    return _native.PartialRender(bytes(partial_render))


def merge(partial_renders):
    """Joins partial renders, or `.jfilm` files, to the whole image, with the bits of an undivided
    render. A single one may be given without a list.
    """
    from juggler._image import Image

    if isinstance(partial_renders, (str, os.PathLike, bytes, bytearray, memoryview)):
        partial_renders = [partial_renders]
    return Image(_native.merge([native(one) for one in partial_renders]))


PartialRender.__module__ = merge.__module__ = "juggler"
