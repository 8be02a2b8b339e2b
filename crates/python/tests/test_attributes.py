"""Attributes of meshes and instances, in each of their forms."""

import unittest

import juggler as jg
from juggler import Instances, Object, Scene, shapes
from support import needs_numpy, numpy as np

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]


def rendered(attribute, name="heat"):
    """A render of a mesh with an attribute beside arrays."""
    mesh = shapes.Mesh(positions=np.array(CORNERS), triangles=np.array(FACES), attributes={name: attribute})
    return jg.render(Scene(objects=[Object(mesh)]), size=(4, 4), samples=1)


def described(numbers, kind="f32", **more):
    return {"channels": 1, "data": {kind: numbers}, **more}


@needs_numpy
class Described(unittest.TestCase):
    def test_every_form_is_read(self):
        quarters = [0, 0.25, 0.5, 0.75]
        for attribute in (
            described(quarters),
            described(np.array(quarters), domain="vertex"),
            described(np.zeros((4, 1)), channels=np.int64(1)),
            described(np.arange(4), "u8"),
            described([0, 1, 2, 65535], "u16"),
            described(np.zeros((4, 3), "u1"), "u8", channels=3),
            jg.MeshAttribute(1, {"f32": np.array(quarters)}),
            jg.MeshAttribute(1, {"f32": [0.5, 0.75]}, domain="face"),
        ):
            rendered(attribute)

    def test_mistakes_are_named(self):
        attribute = "the attribute `heat` of shapes.Mesh"
        numbers = f"{attribute} must be an array, or have `channels` from 1 to 4 and `data` of u8, u16 or f32"
        levels = f"`u8` of {attribute} must be whole numbers from 0 to 255, not"
        for wrong, message in (
            (described(np.array([256] * 4), "u8"), f"{levels} 256"),
            (described([300, 1, 1, 1], "u8"), f"{levels} 300"),
            (described([-1, 0, 0, 0], "u8"), f"{levels} -1"),
            (described([0.5] * 4, "u8"), f"{levels} float64"),
            (described([70000] * 4, "u16"), "whole numbers from 0 to 65535, not 70000"),
            (described([0] * 4, domain="fac"), f'`domain` of {attribute} is "vertex" or "face", not \'fac\''),
            (described([0] * 4, foo=1), f"{attribute} has no `foo`"),
            (described([0] * 4, domains="face"), f"{attribute} has no `domains`; did you mean `domain`?"),
            (described(np.ma.masked_equal(np.arange(4.0), 2)), f"`f32` of {attribute} has masked numbers"),
            (jg.MeshAttribute(1, {"f32": np.ma.masked_equal(np.arange(4.0), 2)}), "has masked numbers"),
            (described(np.arange(4) * 1j), f"`f32` of {attribute} must be an array of real numbers"),
            (described(["a"] * 4), f"`f32` of {attribute} must be an array of real numbers"),
            (described([0] * 4, channels=True), numbers),
            (described([0] * 4, channels=1.0), numbers),
            (described([0] * 4, channels=np.array([1, 2])), numbers),
            (described([0] * 4, "f64"), numbers),
            (described(np.zeros((2, 2))), r"must be numbers in a row; its shape is (2, 2)"),
            (described([0] * 4, channels=3), "not a multiple of its 3 channels"),
        ):
            with self.subTest(message), self.assertRaises(jg.SceneError) as caught:
                rendered(wrong)
            self.assertIn(message, str(caught.exception))

    def test_names_are_strings(self):
        with self.assertRaisesRegex(jg.SceneError, "names of attributes of shapes.Mesh are strings, not 1"):
            rendered(np.arange(4), name=1)

    def test_instances_have_no_faces(self):
        many = Instances(positions=np.array(CORNERS), attributes={"heat": described([0] * 4, domain="face")})
        with self.assertRaisesRegex(jg.SceneError, "`heat` of Instances has no `domain`"):
            jg.render(Scene(objects=[Object(shapes.Sphere(), instances=many)]))


if __name__ == "__main__":
    unittest.main()
