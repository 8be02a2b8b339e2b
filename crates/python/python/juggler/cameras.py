# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of cameras."""

from ._node import Node

__all__ = [
    "Perspective",
    "ThinLens",
    "Orthographic",
]


class Perspective(Node):
    """Pinhole camera: objects at all distances are sharp.

    Args:
        eye (3 numbers; scene units; default (0, 0, 5)): Position of the camera, in world space.
        look_at (3 numbers; scene units): Point that the camera looks at before yaw, pitch and roll,
            in world space. The default is the origin, unless `direction` is given.
        direction (3 numbers): View direction, of any length; replaces `look_at`.
        up (3 numbers; default (0, 1, 0)): Direction of the picture's top, of any length. It is
            projected perpendicular to the view direction.
        yaw_degrees (number; default 0): Rotation to the right about the camera's up axis, in
            degrees.
        pitch_degrees (number; default 0): Upward rotation about the camera's right axis, in
            degrees, after yaw.
        roll_degrees (number; default 0): Clockwise rotation of the camera about the view direction,
            in degrees, after pitch; its top leans to the right.
        move (`Move`): Translation along the camera's axes, after the rotations.
        vertical_fov_degrees (number above 0 below 180): Vertical field of view in degrees, between
            0 and 180. At most one of `vertical_fov_degrees`, `horizontal_fov_degrees`, `screen`,
            `view_plane` and `focal_length` may be given; the default is 40.
        horizontal_fov_degrees (number above 0 below 180): Horizontal field of view in degrees,
            between 0 and 180.
        screen (`Screen`): Field of view as a screen of a given width at a given distance; pixels
            are square.
        view_plane (`ViewPlane`): Field of view as a rectangle at a given distance; the picture is
            stretched over it.
        focal_length (number above 0; mm): Focal length in millimeters, above 0, of a lens before a
            sensor of width `sensor_width`: it gives the field of view.
        sensor_width (number above 0; mm): Width of the sensor in millimeters, above 0, which the
            picture's width stands for. The default is 36, a full frame.
        fit_aspect (number above 0): Aspect ratio, width / height, of the narrowest picture that
            keeps `vertical_fov_degrees`. A narrower picture keeps the width that a picture of this
            aspect ratio has and shows more above and below, so nothing at its sides is lost. By
            default `vertical_fov_degrees` holds for every picture.

    Example:
        cameras.Perspective(eye=(0, 2, 6), look_at=(0, 1, 0), vertical_fov_degrees=40)
    """

    __slots__ = (
        "eye",
        "look_at",
        "direction",
        "up",
        "yaw_degrees",
        "pitch_degrees",
        "roll_degrees",
        "move",
        "vertical_fov_degrees",
        "horizontal_fov_degrees",
        "screen",
        "view_plane",
        "focal_length",
        "sensor_width",
        "fit_aspect",
    )
    _kind = "perspective"


class ThinLens(Node):
    """Thin-lens camera: a plane in focus, depth-of-field blur before and behind it.

    Args:
        eye (3 numbers; scene units; default (0, 0, 5)): Position of the camera, in world space.
        look_at (3 numbers; scene units): Point that the camera looks at before yaw, pitch and roll,
            in world space. The default is the origin, unless `direction` is given.
        direction (3 numbers): View direction, of any length; replaces `look_at`.
        up (3 numbers; default (0, 1, 0)): Direction of the picture's top, of any length. It is
            projected perpendicular to the view direction.
        yaw_degrees (number; default 0): Rotation to the right about the camera's up axis, in
            degrees.
        pitch_degrees (number; default 0): Upward rotation about the camera's right axis, in
            degrees, after yaw.
        roll_degrees (number; default 0): Clockwise rotation of the camera about the view direction,
            in degrees, after pitch; its top leans to the right.
        move (`Move`): Translation along the camera's axes, after the rotations.
        vertical_fov_degrees (number above 0 below 180): Vertical field of view in degrees, between
            0 and 180. At most one of `vertical_fov_degrees`, `horizontal_fov_degrees`, `screen`,
            `view_plane` and `focal_length` may be given; the default is 40.
        horizontal_fov_degrees (number above 0 below 180): Horizontal field of view in degrees,
            between 0 and 180.
        screen (`Screen`): Field of view as a screen of a given width at a given distance; pixels
            are square.
        view_plane (`ViewPlane`): Field of view as a rectangle at a given distance; the picture is
            stretched over it.
        focal_length (number above 0; mm): Focal length in millimeters, above 0, of a lens before a
            sensor of width `sensor_width`: it gives the field of view.
        sensor_width (number above 0; mm): Width of the sensor in millimeters, above 0, which the
            picture's width stands for. The default is 36, a full frame.
        fit_aspect (number above 0): Aspect ratio, width / height, of the narrowest picture that
            keeps `vertical_fov_degrees`. A narrower picture keeps the width that a picture of this
            aspect ratio has and shows more above and below, so nothing at its sides is lost. By
            default `vertical_fov_degrees` holds for every picture.
        lens_radius (number from 0; default 0.05): Radius of the lens in scene units, 0 or more.
            Larger lenses blur more outside the focal plane; 0 is a pinhole.
        f_stop (number above 0): f-number of the lens, above 0: the focal length divided by the
            diameter of the lens. It replaces `lens_radius`. Without `focal_length`, the focal
            length is the one that gives the field of view with `sensor_width`.
        unit (number above 0): Length of a scene unit in meters, above 0, for `f_stop`. The default
            is 1.
        focus_on (string): Name of an object whose middle is in focus; it replaces `focus_distance`.
            The object must be in front of the camera.
        focus_distance (number above 0; default 5): Distance from the eye to the plane in focus
            along the view direction, in scene units. It must be above 0.

    Example:
        cameras.ThinLens(eye=(0, 2, 6), look_at=(0, 1, 0), lens_radius=0.05, focus_distance=6)
    """

    __slots__ = (
        "eye",
        "look_at",
        "direction",
        "up",
        "yaw_degrees",
        "pitch_degrees",
        "roll_degrees",
        "move",
        "vertical_fov_degrees",
        "horizontal_fov_degrees",
        "screen",
        "view_plane",
        "focal_length",
        "sensor_width",
        "fit_aspect",
        "lens_radius",
        "f_stop",
        "unit",
        "focus_on",
        "focus_distance",
    )
    _kind = "thin_lens"


class Orthographic(Node):
    """Orthographic camera: all rays are parallel.

    Args:
        eye (3 numbers; scene units; default (0, 0, 5)): Position of the camera, in world space.
        look_at (3 numbers; scene units): Point that the camera looks at before yaw, pitch and roll,
            in world space. The default is the origin, unless `direction` is given.
        direction (3 numbers): View direction, of any length; replaces `look_at`.
        up (3 numbers; default (0, 1, 0)): Direction of the picture's top, of any length. It is
            projected perpendicular to the view direction.
        yaw_degrees (number; default 0): Rotation to the right about the camera's up axis, in
            degrees.
        pitch_degrees (number; default 0): Upward rotation about the camera's right axis, in
            degrees, after yaw.
        roll_degrees (number; default 0): Clockwise rotation of the camera about the view direction,
            in degrees, after pitch; its top leans to the right.
        move (`Move`): Translation along the camera's axes, after the rotations.
        height (number above 0): Height of the visible area in scene units, above 0. If only `width`
            is given, the aspect ratio of the picture gives the height, so pixels are square. If
            both are given, the picture is stretched. The default is 4.
        width (number above 0): Width of the visible area in scene units, above 0. The default
            follows from `height`.
        fit_aspect (number above 0): Aspect ratio, width / height, of the narrowest picture that
            keeps `height`. A narrower picture keeps the width that a picture of this aspect ratio
            has and shows more above and below, so nothing at its sides is lost. By default `height`
            holds for every picture.

    Example:
        cameras.Orthographic(eye=(0, 2, 6), look_at=(0, 1, 0), height=4)
    """

    __slots__ = (
        "eye",
        "look_at",
        "direction",
        "up",
        "yaw_degrees",
        "pitch_degrees",
        "roll_degrees",
        "move",
        "height",
        "width",
        "fit_aspect",
    )
    _kind = "orthographic"
