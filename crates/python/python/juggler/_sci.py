"""Scientific pictures: surfaces, spheres, arrows and tubes colored by values."""

import math

from . import _arrays, shapes
from ._array_nodes import PerFace
from ._errors import SceneError
from ._glyphs import arrow, caps, frames, ring_faces, rings
from ._values import VALUE, Values, material, number
from .scene_types import Instances, Object


def _parts(parts, name):
    """One object: the only part, or all of them as children."""
    if len(parts) == 1:
        return parts[0].replace(name=name)
    return Object(objects=parts, name=name)


def _triangles(faces, label):
    """Triangles of an array of triangles or quadrilaterals."""
    array = _arrays.real_array(faces, label)
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
    triangles = _triangles(faces, f"`faces` of {label}")
    count = len(faces)
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
    shown = Values(values.values if on_faces else values, label, cmap, clim, nan, lit)
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
                mesh(triangles if every else triangles[whole], {VALUE: attribute}), material=shown.material
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
    shown = Values(values, label, cmap, clim, nan, lit)
    if len(shown.values) != count:
        raise SceneError(f"`values` of {label} must have {count} numbers, it has {len(shown.values)}")
    parts = []
    if shown.finite.any():
        where = slice(None) if shown.finite.all() else np.flatnonzero(shown.finite)
        instances = place(where, {"attributes": {VALUE: shown.values[where]}})
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
    shape = shapes.Sphere() if each else shapes.Sphere(radius=number(radii, f"`radii` of {label}"))

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
    elif values is not None:
        values = _arrays.unmasked(values)
        if values.shape != starts.shape[:1]:
            shape = values.shape
            raise SceneError(f"`values` of {label} must have {len(starts)} numbers, not the shape {shape}")
    sizes = lengths[seen] * number(scale, f"`scale` of {label}")
    matrices = frames(vectors[seen].astype("f8"), starts[seen], sizes)

    def place(where, attributes):
        return Instances(matrices=matrices[where], **attributes)

    values = None if values is None else values[seen]
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
    if not (hasattr(sides, "__index__") and sides >= 3):
        raise SceneError(f"`sides` of {label} must be a whole number from 3, not {sides!r}")
    several = isinstance(lines, (list, tuple)) and len(lines) > 0 and np.ndim(lines[0]) == 2
    lines = [
        _arrays.floats(line, f"`lines` of {label}", 3).astype("f8")
        for line in (lines if several else [lines])
    ]
    values = values if several or values is None else [values]
    radii = radius if several and isinstance(radius, (list, tuple)) else [radius] * len(lines)
    _check_count(radii, lines, f"`radius` of {label}")
    _check_count(values, lines, f"`values` of {label}")
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


def _check_count(found, lines, label):
    """Raises an error unless there is one array for each line, or nothing."""
    if found is None:
        return
    if not hasattr(found, "__len__"):
        raise SceneError(f"{label} is an array, or a list of arrays for a list of lines")
    if len(found) != len(lines):
        raise SceneError(f"{label} is for {len(found)} lines; there are {len(lines)}")


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
    if not (radius >= 0).all():
        raise SceneError(f"{label}: its radius must be 0 or more")
    points, wide = line[kept], np.broadcast_to(radius, len(line))[kept]
    positions = np.concatenate([rings(points, wide, sides), points[[0, -1]]])
    ends = start + len(points) * sides
    closed = caps(start, ends, len(points), sides)
    faces = np.concatenate([start + ring_faces(len(points), sides), *closed])
    if values is None:
        return positions, faces, None
    found = _arrays.unmasked(values)
    if found.shape != (len(line),):
        raise SceneError(f"{label} has {len(line)} points, but its values have the shape {found.shape}")
    if found.dtype.kind not in "biuf":
        raise SceneError(f"{label}: its values must be numbers")
    found = found[kept].astype("f8")
    return positions, faces, np.concatenate([np.repeat(found, sides), found[[0, -1]]])


def _creased(made, degrees):
    """The object with smooth shading of edges below an angle."""
    if made.objects is not None:
        return made.replace(objects=[_creased(part, degrees) for part in made.objects])
    return made.replace(shape=made.shape.replace(crease_angle_degrees=degrees))
