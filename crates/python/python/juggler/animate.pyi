# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Value forms, which replace a value that changes over time."""

from collections.abc import Sequence
from typing import Any, Literal, Self

from . import typing as t
from ._node import Node

__all__ = [
    "Keys",
    "Along",
    "Joint",
    "Posed",
]

class Keys(Node):
    """Value interpolated between keys: a number, an array of numbers, a color or a rotation. With
    `step` interpolation, any value.

    Args:
        keys (1 to 100000 `(time, value)` or `(time, value, ease)`; required): Keys `[time, value]`
            or `[time, value, ease]`, in the order of strictly increasing times. Times are in
            seconds unless `at` is set. All values have the same form. An ease applies between its
            key and the next.
        at (number): Time at which the keys are evaluated. Defaults to the scene's time in seconds.
            `"=seconds - 2"` delays the animation by two seconds, `"=2 * seconds"` doubles its
            speed.
        interpolation ("step", "linear", "smooth" or "slerp"; default "linear"): Interpolation
            between the keys.
        ease ("linear", "in", "out", "in_out", "step" or 4 numbers; default "linear"): Easing after
            each key that does not state its own easing.
        repeat ("once", "loop" or "ping_pong"; default "once"): Extrapolation before the first and
            after the last key.

    Example:
        animate.Keys([(0, 0), (2, 360)], repeat="loop")
    """
    __match_args__ = ("keys", "at", "interpolation", "ease", "repeat")
    keys: Any
    at: float | Any
    interpolation: Literal["step", "linear", "smooth", "slerp"] | Any
    ease: Literal["linear", "in", "out", "in_out", "step"] | list[float | Any] | Any
    repeat: Literal["once", "loop", "ping_pong"] | Any
    def __init__(
        self,
        keys: Sequence[tuple[float | str, Any] | tuple[float | str, Any, Any] | list[Any] | t.ValueForm] | t.ValueForm,
        *,
        at: t.Number | None = None,
        interpolation: Literal["step", "linear", "smooth", "slerp"] | t.ValueForm | None = None,
        ease: Literal["linear", "in", "out", "in_out", "step"] | t.Vec4Like | None = None,
        repeat: Literal["once", "loop", "ping_pong"] | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        keys: Sequence[tuple[float | str, Any] | tuple[float | str, Any, Any] | list[Any] | t.ValueForm] | t.ValueForm = ...,
        at: t.Number | None = ...,
        interpolation: Literal["step", "linear", "smooth", "slerp"] | t.ValueForm | None = ...,
        ease: Literal["linear", "in", "out", "in_out", "step"] | t.Vec4Like | None = ...,
        repeat: Literal["once", "loop", "ping_pong"] | t.ValueForm | None = ...,
    ) -> Self: ...

class Along(Node):
    """Point at a fraction of a path's arc length. A fraction that increases linearly gives motion
    of constant speed.

    Args:
        path (string; required): Name of a path in the scene's `paths`.
        at (number; required): Fraction of the path's arc length: 0 is the start, 1 the end. A
            closed path wraps around; an open path stays at its ends.

    Example:
        animate.Along("track", "=seconds / 10")
    """
    __match_args__ = ("path", "at")
    path: str | Any
    at: float | Any
    def __init__(
        self,
        path: str | t.ValueForm,
        at: t.Number,
    ) -> None: ...
    def replace(
        self,
        *,
        path: str | t.ValueForm = ...,
        at: t.Number = ...,
    ) -> Self: ...

class Joint(Node):
    """Position of the joint of two bones, as in a `limb`: an elbow or a knee, to place shapes along
    the bones.

    The bones bend from the line between the ends toward the direction of the cross product (to −
    from) × `plane_normal`. The distance between the ends must not exceed the sum of the lengths,
    nor fall below their difference.

    Args:
        from_ (3 numbers; scene units; required): One end: a hand or a foot.
        to (3 numbers; scene units; required): Other end: a shoulder or a hip.
        lengths (2 numbers above 0; scene units; required): Lengths of the bones at `from` and at
            `to`.
        plane_normal (3 numbers; required): Normal of the plane in which the bones bend, in the
            space of `from` and `to`. It has any length except zero and must not be parallel to `to
            − from`.
        keep_lengths (True or False; default True): Whether the bones keep their lengths if
            `plane_normal` is not perpendicular to `to − from`. With `false`, the joint moves closer
            to the line between the ends.

    Example:
        animate.Joint(from_=(0, 0, 0), to=(1.5, 0, 0), lengths=(1, 1), plane_normal=(0, 0, 1))
    """
    __match_args__ = ("from_", "to", "lengths", "plane_normal", "keep_lengths")
    from_: list[float | Any] | Any
    to: list[float | Any] | Any
    lengths: list[float | Any] | Any
    plane_normal: list[float | Any] | Any
    keep_lengths: bool | Any
    def __init__(
        self,
        *,
        from_: t.Vec3Like,
        to: t.Vec3Like,
        lengths: t.Vec2Like,
        plane_normal: t.Vec3Like,
        keep_lengths: bool | t.ValueForm | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        from_: t.Vec3Like = ...,
        to: t.Vec3Like = ...,
        lengths: t.Vec2Like = ...,
        plane_normal: t.Vec3Like = ...,
        keep_lengths: bool | t.ValueForm | None = ...,
    ) -> Self: ...

class Posed(Node):
    """Position, direction or matrix of a node of a model (glTF) in an animation clip.

    The value is in the space of the model file. If the model's object has a transform, the follower
    needs the same transform.

    Args:
        file (string; required): Model file, relative to the scene file.
        node (string; required): Name of the node, or the names of its ancestors and its own,
            separated by `/`, if several nodes have the name.
        animation (whole number from 0 or string): Animation clip, by name or index; `"none"` for
            the rest pose. Defaults to the first clip.
        at (number; seconds): Time in the clip. Defaults to the time of the scene.
        repeat ("loop" or "once"; default "loop"): What happens after the end of the clip.
        point (3 numbers; scene units): Point in the space of the node. The value is then its
            position: three numbers.
        vector (3 numbers): Vector in the space of the node. The value is then the transformed
            vector, three numbers: a direction. Without `point` and `vector`, the value has 12
            numbers: the rows of the matrix from the space of the node to that of the file, as the
            transform step `matrix` takes them.

    Example:
        animate.Posed("fox.glb", "head", point=(0, 0, 0))
    """
    __match_args__ = ("file", "node", "animation", "at", "repeat", "point", "vector")
    file: str | Any
    node: str | Any
    animation: int | str | Any
    at: float | Any
    repeat: Literal["loop", "once"] | Any
    point: list[float | Any] | Any
    vector: list[float | Any] | Any
    def __init__(
        self,
        file: str | t.ValueForm,
        node: str | t.ValueForm,
        *,
        animation: t.Integer | None = None,
        at: t.Number | None = None,
        repeat: Literal["loop", "once"] | t.ValueForm | None = None,
        point: t.Vec3Like | None = None,
        vector: t.Vec3Like | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        file: str | t.ValueForm = ...,
        node: str | t.ValueForm = ...,
        animation: t.Integer | None = ...,
        at: t.Number | None = ...,
        repeat: Literal["loop", "once"] | t.ValueForm | None = ...,
        point: t.Vec3Like | None = ...,
        vector: t.Vec3Like | None = ...,
    ) -> Self: ...
