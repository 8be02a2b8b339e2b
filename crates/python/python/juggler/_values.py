"""Values and their color maps, for scientific pictures."""

import math
import sys

from . import _arrays, _color_maps, materials, textures
from ._errors import SceneError

# Name of the attribute that color maps show.
VALUE = "value"
# Greatest number of an attribute.
_MAX_VALUE = 1e18


class ColorMap(textures.Ramp):
    """Color ramp over the values of a mesh or of instances, from the value `clim[0]` to `clim[1]`.

    `cmap` is the name of a color map, or a list of its colors. With `normalized`, the input is 0 at
    `clim[0]` and 1 at `clim[1]`, instead of the values themselves.
    """

    __slots__ = ("clim", "cmap", "label", "normalized")
    _unwritten = ("cmap", "clim", "label", "normalized")

    def colors(self):
        """The colors of the map, evenly spaced, as "#rrggbb"."""
        return _color_maps.colors(self.cmap)

    def _members(self, collect):
        clim = _limits(None, self.clim, "sci.ColorMap")
        low, high = (0.0, 1.0) if self.normalized else clim
        colors = self.colors()
        step = (high - low) / (len(colors) - 1)
        stops = [{"position": low + step * index, "color": color} for index, color in enumerate(colors)]
        return {"stops": stops, **super()._members(collect)}


def number(value, label):
    """A finite number, or an error that names the argument."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = math.nan
    if not math.isfinite(found):
        raise SceneError(f"{label} must be a finite number, not {value!r}")
    return found


def _limits(values, clim, label):
    """The values at both ends of the color map, of those that it shows unless `clim` states them."""
    if clim is None and values is not None:
        low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
        return (low, high) if low < high else _around(low)
    try:
        low, high = (float(limit) for limit in clim)
    except (TypeError, ValueError):
        low, high = math.nan, math.nan
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise SceneError(f"`clim` of {label} must be two finite numbers, the lower first, not {clim!r}")
    return low, high


def _around(value):
    """Limits around the value that all points have."""
    half = max(0.5, abs(value) * 1e-12)
    return max(value - half, -sys.float_info.max), min(value + half, sys.float_info.max)


def _are_resolved(clim):
    """Whether float32 numbers between the limits have at least 16 bits of precision."""
    largest = max(map(abs, clim))
    return clim[1] - clim[0] >= largest / 256 and 1e-30 < largest < _MAX_VALUE


def _normalized(values, clim):
    """Values as float64, 0 and 1 at the limits."""
    low, high = clim
    # The difference of the limits may overflow.
    scale = 1.0 if math.isfinite(high - low) else 0.25
    low = low * scale
    return (values * scale - low) / (high * scale - low)


class Values:
    """Values with their color map."""

    def __init__(self, values, label, cmap, clim, nan, lit):
        np = _arrays.numpy()
        values = _arrays.unmasked(values)
        if values.dtype.kind not in "biuf" or values.ndim != 1:
            raise SceneError(f"`values` of {label} must be an array of shape (n,) of numbers")
        values = values.astype("f8")
        self.finite = np.isfinite(values)
        clim = _limits(values[self.finite], clim, label)
        values = np.where(self.finite, values, clim[0])
        # The renderer has float32 numbers, which may be too coarse for the values.
        normalized = None if _are_resolved(clim) else True
        with np.errstate(over="ignore"):
            values = _normalized(values, clim) if normalized else values
        self.values = np.clip(values, -_MAX_VALUE, _MAX_VALUE).astype("f4")
        cmap = cmap if isinstance(cmap, str) and _color_maps.is_own(cmap) else _color_maps.colors(cmap)
        attribute = textures.Attribute(VALUE, channel="r")
        shown = ColorMap(cmap=cmap, clim=clim, input=attribute, normalized=normalized)
        self.material = material(shown, lit)
        self.missing = material(nan, lit)


def material(color, lit=True):
    """Material of one color, or of a texture: diffuse, or without lighting."""
    return materials.Diffuse(reflectance=color) if lit else materials.Unlit(color=color)


def _with_children(objects):
    """Objects and all objects inside them."""
    for one in () if objects is None else objects:
        yield one
        yield from _with_children(getattr(one, "objects", None))


def maps_of(objects):
    """The different color maps of objects, in their order."""
    maps = {}
    for one in _with_children(objects):
        material = getattr(one, "material", None)
        colors = (getattr(material, name, None) for name in ("reflectance", "color", "base_color"))
        for color_map in (one, *colors):
            if isinstance(color_map, ColorMap):
                key = tuple(color_map.colors()), tuple(color_map.clim), color_map.label
                maps.setdefault(key, color_map)
    return list(maps.values())


def has_unlit(objects):
    """Whether one of the objects, or of those inside them, is shown without lighting."""
    return any(isinstance(getattr(one, "material", None), materials.Unlit) for one in _with_children(objects))
