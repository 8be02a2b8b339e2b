"""Values of other libraries, and of wrong types, in every place of the package."""

import unittest

import juggler as jg
from juggler import Object, Scene, materials, sci, shapes
from support import needs_numpy, numpy as np

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]


def hash_of(*objects):
    """Hash of a small picture of objects."""
    return jg.render(Scene(objects=list(objects)), size=(8, 8), samples=1).hash


@needs_numpy
class Colors(unittest.TestCase):
    def test_colors_are_arrays_beside_color_maps(self):
        color = (0.8, 0.2, 0.1)
        for kind, field in (
            (materials.Diffuse, "reflectance"),
            (materials.Unlit, "color"),
            (materials.Principled, "base_color"),
        ):
            shown = [
                hash_of(Object(shapes.Sphere(), material=kind(**{field: one})))
                for one in (color, np.array(color))
            ]
            self.assertEqual(*shown)
        for field, values in (("color", None), ("nan", [0, 1, float("nan"), 1])):
            shown = [
                hash_of(sci.surface(CORNERS, FACES, values=values, **{field: one}))
                for one in (color, np.array(color))
            ]
            self.assertEqual(*shown)

    def test_directions_of_cameras_are_arrays(self):
        box = np.array([(0, 0, 0), (1, 2, 3)])
        self.assertEqual(sci.camera(box, view=np.array([1, 2, 3])), sci.camera(box.tolist(), view=(1, 2, 3)))
        with self.assertRaisesRegex(jg.SceneError, "`up` is"):
            sci.camera(box, up=np.array([0, 1, 0]))


if __name__ == "__main__":
    unittest.main()
