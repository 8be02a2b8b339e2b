"""Cameras of scenes, and camera matrices of images."""


class SceneCamera(dict):
    """Camera in the scene format, such as `{"perspective": {"eye": [0, 1, 5]}}`."""

    def replace(self, **fields):
        """Returns the camera with other values of these fields."""
        ((kind, values),) = self.items()
        return SceneCamera({kind: {**values, **fields}})

    __replace__ = replace

    def __getattr__(self, name):
        for values in self.values():
            if name in values:
                return values[name]
        raise AttributeError(f"the camera has no field {name!r}")


def camera_of(values):
    """Returns the camera of a scene: an object of `juggler.cameras` where the package has it."""
    try:
        from juggler._node import camera_from_dict
    except ImportError:
        return SceneCamera(values)
    return camera_from_dict(values)


class OpenCV:
    """Camera in the convention of OpenCV: x to the right, y down, z forward.

    A point p of the world appears at the pixel K (R p + t), divided by its third component. Pixels
    have their centers at halves: the first one at (0.5, 0.5). Unpacks as `K, R, t`.
    """

    __slots__ = ("K", "R", "t")

    def __init__(self, K, R, t):
        self.K = K
        self.R = R
        self.t = t

    def __iter__(self):
        return iter((self.K, self.R, self.t))

    def __repr__(self):
        return f"OpenCV(K={self.K!r}, R={self.R!r}, t={self.t!r})"


class Camera:
    """Matrices of the camera of an image, at the middle of the shutter interval."""

    __slots__ = ("_corner", "_frame", "_to_camera", "_to_image")

    def __init__(self, viewpoint, window):
        self._to_camera, self._to_image = viewpoint
        self._frame, self._corner = window

    @property
    def world_to_camera(self):
        """Matrix of shape (4, 4) for column vectors, from the world to the camera, in scene units,
        with x to the right, y down and z forward.
        """
        import numpy

        # The file's matrix is for row vectors, and has y up.
        return numpy.diag([1.0, -1.0, 1.0, 1.0]) @ numpy.array(self._to_camera, dtype=float).T

    @property
    def world_to_image(self):
        """Matrix of shape (3, 4) for column vectors, from the world to pixels of this image."""
        import numpy

        rows = numpy.array(self._to_image, dtype=float).T
        (width, height), (left, top) = self._frame, self._corner
        return numpy.array([rows[0] * width - rows[3] * left, rows[1] * height - rows[3] * top, rows[3]])

    @property
    def opencv(self):
        """The camera as `OpenCV`: K, R and t; `None` for a camera without perspective."""
        import numpy

        extrinsic, projection = self.world_to_camera, self.world_to_image
        if not projection[2, :3].any():
            return None
        intrinsic = projection[:, :3] @ extrinsic[:3, :3].T
        intrinsic = intrinsic / intrinsic[2, 2]
        # Rounding leaves traces where a camera has zeros.
        intrinsic[numpy.abs(intrinsic) < 1e-6 * numpy.abs(intrinsic).max()] = 0.0
        return OpenCV(intrinsic, extrinsic[:3, :3], extrinsic[:3, 3])

    def __repr__(self):
        return f"Camera(world_to_camera={self.world_to_camera!r})"


Camera.__module__ = "juggler"
