"""Cameras, axes and settings for scientific pictures."""

import math

from . import cameras, shapes
from ._errors import SceneError
from ._node import lists_of, resembles_array
from ._values import material, number
from .scene_types import Object

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

# Direction of the picture's top for views along the vertical axis, by that axis.
_TOPS = {"x": (0.0, 1.0, 0.0), "y": (0.0, 0.0, -1.0), "z": (0.0, 1.0, 0.0)}


def box(bounds):
    """Least and greatest corner: of a pair of corners, of an object, or of a list of objects."""
    if isinstance(bounds, Object):
        return bounds.bounds
    if isinstance(bounds, (list, tuple)) and bounds and all(isinstance(one, Object) for one in bounds):
        return Object(objects=list(bounds)).bounds
    try:
        corners = lists_of(bounds) if resembles_array(bounds) else bounds
        low, high = ([float(number) for number in corner] for corner in corners)
    except (TypeError, ValueError):
        raise SceneError(
            "`bounds` is a pair of corners, such as `object.bounds`, an object or a list of objects"
        ) from None
    if len(low) != 3 or len(high) != 3 or not all(a <= b for a, b in zip(low, high)):
        raise SceneError(f"`bounds` is the least and the greatest corner of a box, not {bounds}")
    if not all(map(math.isfinite, (*low, *high))):
        raise SceneError(f"`bounds` must be finite numbers, not {bounds}")
    return low, high


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return tuple(x / length for x in a)


def _view(view, up):
    """Direction to the camera, and direction of the picture's top."""
    if not isinstance(up, str) or up not in _AXES:
        raise SceneError(f'`up` is "x", "y" or "z", not {up!r}')
    if isinstance(view, str):
        if view == "isometric":
            return _unit((1, 1, 1)), _AXES[up]
        if len(view) != 2 or view[0] not in "+-" or view[1] not in _AXES:
            raise SceneError(
                f'`view` is "isometric", "+x", "-x", "+y", "-y", "+z", "-z" or a direction, not {view!r}'
            )
        sign = 1.0 if view[0] == "+" else -1.0
        direction = tuple(sign * x for x in _AXES[view[1]])
        if view[1] != up:
            return direction, _AXES[up]
        return direction, tuple(sign * x for x in _TOPS[up])
    try:
        direction = tuple(float(x) for x in view)
    except (TypeError, ValueError):
        direction = ()
    if len(direction) != 3 or not 0 < _dot(direction, direction) < math.inf:
        raise SceneError(f"`view` as a direction has three numbers that are not all 0, not {view!r}")
    direction = _unit(direction)
    top = _AXES[up] if abs(_dot(direction, _AXES[up])) < 0.999 else _TOPS[up]
    return direction, top


def camera(bounds, view="isometric", *, up="y", parallel=False, fov_degrees=30, margin=1.1):
    """A camera that sees all of a box from the side of `view`: "isometric", "+x", "-x", ..., or the
    direction from the box to the camera.

    `bounds` is a pair of corners, an object or a list of objects, and `up` is the vertical axis. A
    view from above, such as `view="+z", up="z"`, has y at the picture's top, or -z if `up` is "y".
    With `parallel`, rays are parallel, so that lengths can be compared (`Image.plot(scale_bar=...)`).
    `margin` is the factor on the size of the view.
    """
    margin, fov_degrees = number(margin, "`margin`"), number(fov_degrees, "`fov_degrees`")
    low, high = box(bounds)
    direction, top = _view(view, up)
    center = [(a + b) / 2 for a, b in zip(low, high)]
    right = _unit(_cross(top, direction))
    above = _cross(direction, right)
    corners = [[(low, high)[i >> axis & 1][axis] - center[axis] for axis in range(3)] for i in range(8)]
    size = max((max(map(abs, corner)) for corner in corners), default=0.0) or 1.0
    # Extents of the corners in the picture, and towards the camera.
    sides = [max(abs(_dot(corner, right)), abs(_dot(corner, above))) for corner in corners]
    depths = [_dot(corner, direction) for corner in corners]
    if parallel:
        distance = max(depths) + 2 * size
        height = 2 * margin * (max(sides) or size)
        eye = [c + distance * d for c, d in zip(center, direction)]
        return cameras.Orthographic(eye=eye, look_at=center, up=top, height=height, fit_aspect=1)
    if not 0 < fov_degrees < 180:
        raise SceneError(f"`fov_degrees` is between 0 and 180, not {fov_degrees}")
    slope = math.tan(math.radians(fov_degrees) / 2)
    distance = max(depth + (margin * side or size) / slope for depth, side in zip(depths, sides))
    eye = [c + distance * d for c, d in zip(center, direction)]
    return cameras.Perspective(
        eye=eye, look_at=center, up=top, vertical_fov_degrees=fov_degrees, fit_aspect=1
    )


def axes(bounds, *, radius=None, colors=("#c02020", "#20a020", "#2040d0")):
    """An `Object` of three thin cylinders along the edges of a box at its least corner: x, y and z.

    `radius` is 1/200 of the box's diagonal by default.
    """
    if len(colors) != 3:
        raise SceneError(f"`colors` of sci.axes is three colors, not {colors!r}")
    low, high = box(bounds)
    lengths = [b - a for a, b in zip(low, high)]
    diagonal = math.sqrt(_dot(lengths, lengths))
    if not diagonal > 0:
        raise SceneError("`bounds` of sci.axes is a single point")
    radius = diagonal / 200 if radius is None else radius
    turns = (("z", -90), None, ("x", 90))
    parts = []
    for length, turn, color in zip(lengths, turns, colors):
        if not length > 0:
            continue
        part = Object(shapes.Cylinder(radius=radius, y_min=0, y_max=length), material=material(color))
        part = part if turn is None else part.rotate(*turn)
        parts.append(part.translate(*low))
    return Object(objects=parts, name="axes")


def flat():
    """Settings of `juggler.render` for exact colors without light and shadow:
    `juggler.render(scene, **juggler.sci.flat())`. Objects with `lit=False` have exact colors without
    these settings, and are black with them.
    """
    return {"integrator": "albedo", "tone": "srgb", "dither": False}
