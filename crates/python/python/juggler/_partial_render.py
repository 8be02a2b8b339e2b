"""Partial renders, and images that they make."""

import os

from juggler import _native


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
        return cls(_native.PartialRender.open(os.fspath(path)).bytes())

    def save(self, path):
        """Writes a `.jfilm` file."""
        _native.PartialRender(bytes(self)).save(os.fspath(path))

    @property
    def description(self):
        """What is rendered, and which share of it: a dict."""
        import json

        return json.loads(_native.PartialRender(bytes(self)).description())


def native(partial_render):
    """Returns the partial render of a file or of bytes."""
    if isinstance(partial_render, (str, os.PathLike)):
        return _native.PartialRender.open(os.fspath(partial_render))
    return _native.PartialRender(bytes(partial_render))


def merge(partial_renders):
    """Joins partial renders, or `.jfilm` files, to the whole image, with the bits of an undivided
    render.
    """
    from juggler._image import Image

    return Image(_native.merge([native(one) for one in partial_renders]))


PartialRender.__module__ = merge.__module__ = "juggler"
