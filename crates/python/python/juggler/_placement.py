"""Placement of objects: each method returns a new object with one more step of its transform."""

from ._node import Node, plain

_AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


class Placement(Node):
    """Base class of objects. Steps of a transform are applied in the order of the calls."""

    __slots__ = ()

    @property
    def bounds(self):
        """Bounding box of the object with its transform: the least and the greatest corner, each x, y
        and z. Objects of infinite extent have none.
        """
        from ._bounds import bounds

        return bounds(self)

    def translate(self, x, y, z):
        """Moves the object by a vector, in scene units."""
        return self._with_step({"translate": (x, y, z)})

    def rotate(self, axis, degrees):
        """Rotates the object about an axis through the origin: three numbers, or "x", "y" or "z".

        Positive angles turn counterclockwise, seen from the tip of the axis.
        """
        axis = _AXES.get(axis, axis) if isinstance(axis, str) else axis
        return self._with_step({"rotate": {"axis": axis, "degrees": degrees}})

    def scale(self, factor):
        """Scales the object about the origin: by one factor, or by one for each axis."""
        return self._with_step({"scale": factor})

    def orient(self, quaternion):
        """Rotates the object about the origin by a quaternion (x, y, z, w), as in glTF."""
        return self._with_step({"orient": quaternion})

    def matrix(self, matrix):
        """Transforms the object by an affine matrix that multiplies column vectors.

        It has 3 or 4 rows of 4 numbers, as nested lists or an array, or the 12 or 16 numbers in a
        row.
        """
        rows = plain(matrix)
        if isinstance(rows, list) and all(isinstance(row, list) for row in rows):
            rows = [number for row in rows for number in row]
        return self._with_step({"matrix": rows})

    def _with_step(self, step):
        steps = self.transform
        if steps is None:
            steps = ()
        elif not isinstance(steps, (list, tuple)):
            steps = (steps,)
        return self.replace(transform=[*steps, step])
