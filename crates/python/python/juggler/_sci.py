"""Scientific pictures: surfaces, spheres, arrows and tubes colored by values."""

import math
import sys

from . import _arrays, _color_maps, materials, shapes, textures
from ._array_nodes import PerFace
from ._errors import SceneError
from ._glyphs import arrow, caps, frames, ring_faces, rings
from .scene_types import Instances, Object

# Name of the attribute that color maps show.
_VALUE = "value"
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
        low, high = (0.0, 1.0) if self.normalized else self.clim
        colors = self.colors()
        step = (high - low) / (len(colors) - 1)
        stops = [{"position": low + step * index, "color": color} for index, color in enumerate(colors)]
        return {"stops": stops, **super()._members(collect)}


def _limits(values, clim, label):
    """The values at both ends of the color map."""
    if clim is None:
        low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
        return (low, high) if low < high else _around(low)
    low, high = (float(limit) for limit in clim)
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise SceneError(f"`clim` of {label} must be two finite numbers, the lower first, not {clim}")
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


class _Values:
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
        attribute = textures.Attribute(_VALUE, channel="r")
        shown = ColorMap(cmap=cmap, clim=clim, input=attribute, normalized=normalized)
        self.material = material(shown, lit)
        self.missing = material(nan, lit)


def material(color, lit=True):
    """Material of one color, or of a texture: diffuse, or without lighting."""
    return materials.Diffuse(reflectance=color) if lit else materials.Unlit(color=color)


def _parts(parts, name):
    """One object: the only part, or all of them as children."""
    if len(parts) == 1:
        return parts[0].replace(name=name)
    return Object(objects=parts, name=name)


def _triangles(faces, label):
    """Triangles of an array of triangles or quadrilaterals."""
    np = _arrays.numpy()
    array = np.asarray(faces)
    if array.ndim == 2 and array.shape[1] == 4:
        # The two triangles of a face follow each other.
        array = array[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return _arrays.indices(array, label, 3)


def surface(
    vertices,
    faces,
    *,
    values=None,
    cmap="viridis",
    clim=None,
    nan="#808080",
    color="#c8c8c8",
    normals=None,
    smooth=False,
    lit=True,
    name=None,
):
    """An `Object` of the triangles or quadrilaterals `faces` between `vertices`.

    `values` has a number for each vertex or for each face (`juggler.PerFace` says so where both are
    as many), which `cmap` colors from `clim[0]` to `clim[1]`, by default the least and the greatest
    value. Faces with a value that is not finite have the color `nan`. `smooth` shades edges smoothly
    without `normals`; `lit=False` shows the exact colors of the map, without light and shadow.
    """
    np = _arrays.numpy()
    label = "sci.surface"
    vertices = _arrays.floats(vertices, f"`vertices` of {label}", 3)
    count = len(faces)
    triangles = _triangles(faces, f"`faces` of {label}")
    if not len(triangles):
        raise SceneError(f"`faces` of {label} is empty")
    if int(triangles.max()) >= len(vertices):
        raise SceneError(
            f"`faces` of {label} has the index {triangles.max()}, but there are {len(vertices)} vertices"
        )
    crease = 180 if smooth and normals is None else None

    def mesh(triangles, attributes=None):
        return shapes.Mesh(
            positions=vertices,
            triangles=triangles,
            normals=normals,
            attributes=attributes,
            crease_angle_degrees=crease,
        )

    if values is None:
        return Object(mesh(triangles), material=material(color, lit), name=name)
    on_faces = isinstance(values, PerFace)
    shown = _Values(values.values if on_faces else values, label, cmap, clim, nan, lit)
    on_faces = _are_of_faces(len(shown.values), len(vertices), count, on_faces, label)
    if on_faces:
        repeats = len(triangles) // count
        numbers, whole = np.repeat(shown.values, repeats), np.repeat(shown.finite, repeats)
    else:
        numbers, whole = shown.values, shown.finite[triangles].all(axis=1)
    parts = []
    if whole.any():
        attribute = PerFace(numbers[whole]) if on_faces else numbers
        every = whole.all()
        parts.append(
            Object(
                mesh(triangles if every else triangles[whole], {_VALUE: attribute}), material=shown.material
            )
        )
    if not whole.all():
        parts.append(Object(mesh(triangles[~whole]), material=shown.missing))
    return _parts(parts, name)


def _are_of_faces(found, vertices, faces, is_stated, label):
    """Whether so many values belong to the faces. Without a statement, vertices come first."""
    if is_stated and found != faces:
        raise SceneError(
            f"`values` of {label} must have a number for each of the {faces} faces, it has {found}"
        )
    if found not in (vertices, faces):
        what = f"{vertices} vertices or the {faces} faces"
        raise SceneError(f"`values` of {label} must have a number for each of the {what}, it has {found}")
    return is_stated or found != vertices


def _instances(shape, count, values, label, options, place):
    """Instances of a shape, colored by values; `place` makes the `Instances` of a selection."""
    cmap, clim, nan, color, lit, name = options
    np = _arrays.numpy()
    if values is None:
        return Object(shape, instances=place(slice(None), {}), material=material(color, lit), name=name)
    shown = _Values(values, label, cmap, clim, nan, lit)
    if len(shown.values) != count:
        raise SceneError(f"`values` of {label} must have {count} numbers, it has {len(shown.values)}")
    parts = []
    if shown.finite.any():
        where = slice(None) if shown.finite.all() else np.flatnonzero(shown.finite)
        instances = place(where, {"attributes": {_VALUE: shown.values[where]}})
        parts.append(Object(shape, instances=instances, material=shown.material))
    if not shown.finite.all():
        missing = np.flatnonzero(~shown.finite)
        parts.append(Object(shape, instances=place(missing, {}), material=shown.missing))
    return _parts(parts, name)


def spheres(
    centers,
    radii=1.0,
    *,
    values=None,
    cmap="viridis",
    clim=None,
    nan="#808080",
    color="#c8c8c8",
    lit=True,
    name=None,
):
    """An `Object` of spheres: `radii` is one number, or one for each of the centers. `values` has a
    number for each sphere, which `cmap` colors as in `surface`.
    """
    np = _arrays.numpy()
    label = "sci.spheres"
    centers = _arrays.floats(centers, f"`centers` of {label}", 3)
    if not len(centers):
        raise SceneError(f"`centers` of {label} is empty")
    each = np.ndim(radii) != 0
    scales = _arrays.real_array(radii, f"`radii` of {label}").astype("f4") if each else None
    if each and scales.shape != (len(centers),):
        raise SceneError(
            f"`radii` of {label} must be a number or have {len(centers)} of them, not the shape {scales.shape}"
        )
    shape = shapes.Sphere() if each else shapes.Sphere(radius=float(radii))

    def place(where, attributes):
        return Instances(positions=centers[where], scales=scales[where] if each else None, **attributes)

    return _instances(shape, len(centers), values, label, (cmap, clim, nan, color, lit, name), place)


def arrows(
    starts,
    vectors,
    *,
    scale=1.0,
    values=None,
    cmap="viridis",
    clim=None,
    nan="#808080",
    color="#c8c8c8",
    lit=True,
    name=None,
):
    """An `Object` of arrows from `starts` along `vectors`, whose lengths are multiplied by `scale`.
    `values` has a number for each arrow, which `cmap` colors as in `surface`; "length" stands for
    the lengths of the vectors. Vectors of length 0 have no arrow.
    """
    np = _arrays.numpy()
    label = "sci.arrows"
    starts = _arrays.floats(starts, f"`starts` of {label}", 3)
    vectors = _arrays.floats(vectors, f"`vectors` of {label}", 3)
    if starts.shape != vectors.shape:
        raise SceneError(
            f"{label} has {len(starts)} `starts` and {len(vectors)} `vectors`; they must be as many"
        )
    lengths = np.linalg.norm(vectors.astype("f8"), axis=1)
    seen = lengths != 0
    if not seen.any():
        raise SceneError(f"`vectors` of {label} has no vector of a length other than 0")
    if isinstance(values, str):
        if values != "length":
            raise SceneError(f'`values` of {label} is an array or "length", not {values!r}')
        values = lengths
    elif values is not None and len(values) != len(starts):
        raise SceneError(f"`values` of {label} must have {len(starts)} numbers, it has {len(values)}")
    matrices = frames(vectors[seen].astype("f8"), starts[seen], lengths[seen] * scale)

    def place(where, attributes):
        return Instances(matrices=matrices[where], **attributes)

    values = None if values is None else _arrays.unmasked(values)[seen]
    return _instances(arrow(), len(matrices), values, label, (cmap, clim, nan, color, lit, name), place)


def tubes(
    lines,
    radius=1.0,
    *,
    values=None,
    cmap="viridis",
    clim=None,
    nan="#808080",
    color="#c8c8c8",
    sides=16,
    lit=True,
    name=None,
):
    """An `Object` of tubes along `lines`: an array of points of shape (n, 3), or a list of such
    arrays. `radius` and `values`, which `cmap` colors as in `surface`, are one number for each point:
    an array, or a list of arrays for a list of lines. `radius` may be one number.
    """
    np = _arrays.numpy()
    label = "sci.tubes"
    several = isinstance(lines, (list, tuple)) and len(lines) > 0 and np.ndim(lines[0]) == 2
    lines = [
        _arrays.floats(line, f"`lines` of {label}", 3).astype("f8")
        for line in (lines if several else [lines])
    ]
    values = values if several or values is None else [values]
    radii = radius if several and isinstance(radius, (list, tuple)) else [radius] * len(lines)
    for name_of, found in (("radius", radii), ("values", values)):
        if found is not None and len(found) != len(lines):
            raise SceneError(f"`{name_of}` of {label} is for {len(found)} lines; there are {len(lines)}")
    parts, start = [], 0
    for index, line in enumerate(lines):
        found = None if values is None else values[index]
        parts.append(_tube(line, radii[index], found, sides, start, f"`lines` of {label}: line {index}"))
        start += len(parts[-1][0])
    positions, faces, numbers = (list(of) for of in zip(*parts, strict=True))
    made = surface(
        np.concatenate(positions),
        np.concatenate(faces),
        values=None if values is None else np.concatenate(numbers),
        cmap=cmap,
        clim=clim,
        nan=nan,
        color=color,
        lit=lit,
        name=name,
    )
    return _creased(made, 60)


def _tube(line, radius, values, sides, start, label):
    """Vertices of a tube, its triangles between them and those before `start`, and their values."""
    np = _arrays.numpy()
    # Points that follow their equal add nothing to a line.
    step = np.linalg.norm(np.diff(line, axis=0), axis=1)
    kept = np.concatenate([[True], step > 0]) if len(line) else np.zeros(0, bool)
    if kept.sum() < 2:
        raise SceneError(f"{label} has no two different points")
    radius = _arrays.real_array(radius, f"{label}: its radius").astype("f8")
    if radius.shape not in ((), (len(line),)):
        raise SceneError(f"{label} has {len(line)} points, but its radii have the shape {radius.shape}")
    points, wide = line[kept], np.broadcast_to(radius, len(line))[kept]
    positions = np.concatenate([rings(points, wide, sides), points[[0, -1]]])
    ends = start + len(points) * sides
    closed = caps(start, ends, len(points), sides)
    faces = np.concatenate([start + ring_faces(len(points), sides), *closed])
    if values is None:
        return positions, faces, None
    found = _arrays.unmasked(values).astype("f8")
    if found.shape != (len(line),):
        raise SceneError(f"{label} has {len(line)} points, but its values have the shape {found.shape}")
    found = found[kept]
    return positions, faces, np.concatenate([np.repeat(found, sides), found[[0, -1]]])


def _creased(made, degrees):
    """The object with smooth shading of edges below an angle."""
    if made.objects is not None:
        return made.replace(objects=[_creased(part, degrees) for part in made.objects])
    return made.replace(shape=made.shape.replace(crease_angle_degrees=degrees))


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
