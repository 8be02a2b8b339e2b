"""Tests of the typed classes. They need no native module:

PYTHONPATH=crates/python/python python3 -m unittest discover crates/python/tests
"""

import copy
import inspect
import json
import pathlib
import pickle
import subprocess
import sys
import unittest

import juggler
from juggler import (
    Chain,
    ControlSphere,
    InputProduct,
    Instances,
    Object,
    PerFace,
    RenderSettings,
    Scene,
    animate,
    cameras,
    integrators,
    lights,
    materials,
    shapes,
    textures,
)
from juggler._node import Node

# Names that the expressions of `repr` use.
NAMES = {name: getattr(juggler, name) for name in juggler.__all__}


def classes():
    """All generated classes."""
    for module in map(juggler.__getattr__, juggler._MODULES):
        for name in module.__all__:
            yield getattr(module, name)


def example(cls):
    """The line after the last "Example:" of a class's documentation."""
    return inspect.getdoc(cls).rpartition("Example:\n")[2].strip()


class Classes(unittest.TestCase):
    def test_all_families_are_there(self):
        families = "shapes materials textures lights cameras backgrounds integrators samplers filters curves"
        self.assertEqual(set(juggler._MODULES), {*families.split(), "animate", "scene_types"})
        self.assertGreater(len(list(classes())), 100)
        self.assertIs(juggler.scene_types.Scene, Scene)

    def test_every_class_constructs_with_its_required_arguments(self):
        for cls in classes():
            with self.subTest(cls):
                node = cls(**{name: 1 for name in cls._required})
                self.assertEqual(
                    len(node.to_dict().get(cls._kind, node.to_dict())),
                    len(cls._required) + len(cls._constants),
                )
                if cls._required:
                    with self.assertRaisesRegex(TypeError, f"needs `{cls._required[0]}`"):
                        cls()

    def test_every_class_has_documentation_with_an_example(self):
        for cls in classes():
            with self.subTest(cls):
                self.assertIsInstance(eval(example(cls), NAMES), cls)
                self.assertGreater(len(inspect.getdoc(cls).partition("Example:")[0]), 10)
                for name in cls._fields:
                    self.assertRegex(inspect.getdoc(cls), rf"\n    {name}( \(|: )")

    def test_every_node_survives_repr_pickle_copy_replace_and_json(self):
        for cls in classes():
            with self.subTest(cls):
                node = eval(example(cls), NAMES)
                for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
                    self.assertEqual(pickle.loads(pickle.dumps(node, protocol)), node)
                self.assertEqual(eval(repr(node), NAMES), node)
                self.assertEqual(copy.copy(node), node)
                self.assertEqual(copy.deepcopy(node), node)
                self.assertEqual(node.replace(), node)
                self.assertEqual(json.loads(json.dumps(node.to_dict())), node.to_dict())

    def test_no_field_hides_a_method(self):
        for cls in classes():
            bases = [(base, getattr(base, "_fields", ())) for base in cls.__mro__[1:]]
            methods = {name for base, fields in bases for name in vars(base) if name not in fields} - {
                "__slots__"
            }
            self.assertFalse(methods & set(cls._fields), cls)

    def test_signatures_name_all_fields(self):
        self.assertEqual(str(inspect.signature(shapes.Sphere)), "(*, radius=None)")
        self.assertEqual(str(inspect.signature(animate.Along)), "(path, at)")
        parameters = list(inspect.signature(Object).parameters.values())
        self.assertEqual(parameters[0].kind, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        self.assertEqual([p.name for p in parameters], list(Object.__match_args__))


class Nodes(unittest.TestCase):
    def test_json_form(self):
        sphere = (
            Object(shapes.Sphere(radius=0.5), material="gold").translate(0, 1, 0).rotate("y", 30).scale(2)
        )
        scene = Scene(
            render=RenderSettings(size=(640, 360), integrator=integrators.Path(max_depth=8)),
            cameras={"main": cameras.Perspective(eye=[0, 2, 6])},
            materials={
                "gold": materials.Conductor(
                    metal="gold", roughness=InputProduct(texture="scratches", factor=0.2)
                )
            },
            lights=(lights.Point(position=(-4, 7, 5), intensity="=70 + 5"),),
            objects=[
                sphere,
                Object(
                    chain=Chain(from_=ControlSphere((0, 0, 0), 1), to=ControlSphere((1, 0, 0), 1), count=3)
                ),
            ],
        )
        expected = """{
          "version": 1,
          "render": {"size": [640, 360], "integrator": {"path": {"max_depth": 8}}},
          "cameras": {"main": {"perspective": {"eye": [0, 2, 6]}}},
          "materials": {"gold": {"conductor": {"metal": "gold", "roughness": {"texture": "scratches", "factor": 0.2}}}},
          "lights": [{"point": {"position": [-4, 7, 5], "intensity": "=70 + 5"}}],
          "objects": [
            {"shape": {"sphere": {"radius": 0.5}},
             "transform": [{"translate": [0, 1, 0]}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"scale": 2}],
             "material": "gold"},
            {"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [1, 0, 0], "radius": 1}, "count": 3}}
          ]
        }"""
        self.assertEqual(scene.to_dict(), json.loads(expected))
        self.assertEqual(next(iter(scene.to_dict())), "version")

    def test_value_forms(self):
        turning = shapes.Sphere(radius=animate.Keys([(0, 1), (2, 3, "in_out")], repeat="loop"))
        keys = {"keys": [[0, 1], [2, 3, "in_out"]], "repeat": "loop"}
        self.assertEqual(turning.to_dict(), {"sphere": {"radius": {"animate": keys}}})
        joint = animate.Joint(from_=(0, 0, 0), to=(1, 0, 0), lengths=(1, 1), plane_normal=(0, 0, 1))
        self.assertIn("from", joint.to_dict()["joint"])

    def test_equality_compares_the_json_form(self):
        self.assertEqual(shapes.Rectangle(size=(1, 2)), shapes.Rectangle(size=[1.0, 2.0]))
        self.assertNotEqual(shapes.Sphere(radius=1), shapes.Tube(radius=1))
        self.assertNotEqual(shapes.Sphere(radius=1), {"sphere": {"radius": 1}})
        self.assertEqual(Object(shapes.Sphere()), Object({"sphere": {}}))
        with self.assertRaises(TypeError):
            hash(shapes.Sphere())

    def test_repr(self):
        node = Object(shapes.Sphere(radius=0.5), material="gold")
        self.assertEqual(repr(node), "Object(shapes.Sphere(radius=0.5), material='gold')")
        self.assertEqual(repr(Object(group="pair")), "Object(group='pair')")
        self.assertEqual(repr(shapes.Mesh(pathlib.PurePosixPath("a.ply"))), "shapes.Mesh('a.ply')")

    def test_replace_and_match(self):
        camera = cameras.Perspective(eye=(0, 2, 6), look_at=(0, 1, 0))
        moved = camera.replace(eye=(1, 1, 1), look_at=None)
        self.assertEqual(moved, cameras.Perspective(eye=(1, 1, 1)))
        self.assertEqual(camera.eye, (0, 2, 6))
        if hasattr(copy, "replace"):
            self.assertEqual(copy.replace(camera, look_at=None, eye=(1, 1, 1)), moved)
        match Object(shapes.Sphere(radius=3), name="ball"):
            case Object(shapes.Sphere(radius=radius), name=name):
                self.assertEqual((radius, name), (3, "ball"))
            case other:
                self.fail(other)

    def test_messages(self):
        cases = {
            "shapes.Sphere(raduis=1)": "shapes.Sphere has no `raduis`; did you mean `radius`?",
            "shapes.Sphere(zzz=1)": "shapes.Sphere has no `zzz`",
            "shapes.Sphere(1)": "shapes.Sphere() takes keywords only, such as `radius=...`, found 1 positional",
            "Object(1, 2)": "Object() takes at most 1 positional argument, found 2 positional",
            "Object(1, shape=2)": "Object() got `shape` twice: by position and by keyword",
            "shapes.Sphere().replace(raduis=1)": "shapes.Sphere has no `raduis`; did you mean `radius`?",
            "Chain(**{'from': 1})": "Chain has no `from`; did you mean `from_`?",
            "animate.Along()": "animate.Along needs `path` and `at`",
            "Object(shapes.Sphere(radius={1})).to_dict()": "`shape` of Object: `radius` of shapes.Sphere: an object of the type set cannot be part of a scene",
            "Scene(materials={1: 2}).to_dict()": "`materials` of Scene: the key 1 is not a string",
        }
        for code, message in cases.items():
            with self.subTest(code), self.assertRaises(TypeError) as error:
                eval(code, NAMES)
            self.assertEqual(str(error.exception), message)
        with self.assertRaises(AttributeError):
            shapes.Sphere().raduis = 1
        with self.assertRaises(AttributeError):
            juggler.shape

    def test_steps_of_a_transform_follow_each_other(self):
        first = Object(shapes.Sphere(), transform={"scale": 2})
        second = first.orient((0, 0, 0, 1)).matrix([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]])
        self.assertEqual(first.transform, {"scale": 2})
        steps = [{"scale": 2}, {"orient": [0, 0, 0, 1]}, {"matrix": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0]}]
        self.assertEqual(second.to_dict()["transform"], steps)
        self.assertEqual(type(second), Object)

    def test_subclasses_add_fields(self):
        class Ball(shapes.Sphere):
            __slots__ = ("mass", "_cache")

        ball = Ball(radius=2, mass=3)
        self.assertEqual((ball._fields, repr(ball)), (("radius", "mass"), "Ball(radius=2, mass=3)"))
        self.assertEqual(ball.to_dict(), {"sphere": {"radius": 2, "mass": 3}})

    def test_base_classes_may_store_arrays_elsewhere(self):
        class Picture(Node):
            __slots__ = ("array",)
            _unwritten = ("array",)

            def _members(self, collect):
                members = super()._members(collect)
                return members if self.array is None else {**members, "file": collect(self.array)}

        class Image(Picture):
            __slots__ = ("file", "wrap")
            _kind = "image"
            _positional = ("file",)

        self.assertEqual(Image.__match_args__, ("file", "array", "wrap"))
        self.assertEqual(Image("a.png").to_dict(), {"image": {"file": "a.png"}})
        json_form = Image(array=[1], wrap="clamp").to_json(lambda array: f"array {array}")
        self.assertEqual(json_form, {"image": {"wrap": "clamp", "file": "array [1]"}})


class Array:
    """Array as NumPy has them, as far as nodes use it."""

    def __init__(self, numbers, shape):
        self.numbers, self.shape, self.ndim = numbers, shape, len(shape)

    def tolist(self):
        return self.numbers


class Arrays(unittest.TestCase):
    def test_arrays_become_lists(self):
        row, scalar = Array([1, 2, 3], (3,)), Array(0.5, ())
        self.assertEqual(cameras.Perspective(eye=row), cameras.Perspective(eye=(1, 2, 3)))
        self.assertEqual(shapes.Sphere(radius=scalar).to_dict(), {"sphere": {"radius": 0.5}})
        self.assertEqual(eval(repr(shapes.Sphere(radius=scalar)), NAMES), shapes.Sphere(radius=0.5))
        self.assertEqual(
            repr(shapes.Mesh(positions=Array([], (999, 3)))),
            "shapes.Mesh(positions=<Array of shape (999, 3)>)",
        )
        self.assertEqual(Instances(positions=range(3)).to_dict(), {"positions": [0, 1, 2]})

    def test_values_of_attributes_become_lists(self):
        mesh = shapes.Mesh(
            positions=[(0, 0, 0), (1, 0, 0), (0, 1, 0)],
            triangles=[(0, 1, 2)],
            attributes={
                "heat": [0, 0.5, 1],
                "tint": PerFace(Array([[1, 0, 0]], (1, 3))),
                "known": {"channels": 1, "data": {"u8": [1, 2, 3]}},
            },
        )
        self.assertEqual(
            mesh.to_dict()["mesh"]["attributes"],
            {
                "heat": {"channels": 1, "data": {"f32": [0.0, 0.5, 1.0]}},
                "tint": {"domain": "face", "channels": 3, "data": {"f32": [1.0, 0.0, 0.0]}},
                "known": {"channels": 1, "data": {"u8": [1, 2, 3]}},
            },
        )
        self.assertEqual(eval(repr(mesh), {**NAMES, "Array": Array}), mesh)
        self.assertEqual(pickle.loads(pickle.dumps(mesh)), mesh)

    def test_texels_have_no_form_in_text(self):
        picture = textures.Image(array=Array([[0]], (1, 1)))
        self.assertEqual(picture, textures.Image(array=Array([[0]], (1, 1))))
        self.assertNotEqual(picture, textures.Image(array=Array([[1]], (1, 1))))
        self.assertNotEqual(picture, textures.Image("a.png"))
        with self.assertRaisesRegex(TypeError, "`Scene.save` writes it as a file"):
            picture.to_dict()
        with self.assertRaisesRegex(TypeError, "has `file` and `array`"):
            textures.Image("a.png", array=[[0]]).to_dict()

    def test_arrays_of_numpy(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("NumPy is not installed")
        eye = numpy.array([0, 2, 6], dtype=numpy.float32)
        camera = cameras.Perspective(
            eye=eye, vertical_fov_degrees=numpy.float32(40), fit_aspect=numpy.bool_(True)
        )
        self.assertEqual(camera, cameras.Perspective(eye=(0, 2, 6), vertical_fov_degrees=40, fit_aspect=True))
        self.assertEqual(eval(repr(camera), NAMES), camera)
        self.assertEqual(
            Object("sphere").matrix(numpy.eye(4)).to_dict()["transform"][0]["matrix"][:5], [1, 0, 0, 0, 0]
        )
        self.assertEqual(pickle.loads(pickle.dumps(camera)), camera)


class Import(unittest.TestCase):
    HEAVY = {"numpy", "dataclasses", "typing", "json", "IPython", "inspect", "difflib", "re", "enum"}

    def run_python(self, code):
        """Standard output of an interpreter of its own, without what `site` imports."""
        path = str(pathlib.Path(juggler.__file__).parents[1])
        command = [sys.executable, "-I", "-S", "-c", f"import sys; sys.path.insert(0, {path!r})\n{code}"]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout

    def test_modules_load_when_they_are_used(self):
        loaded = "print(*sorted(name for name in sys.modules if name.startswith('juggler')))"
        lines = self.run_python(f"import juggler\n{loaded}\njuggler.shapes.Sphere\n{loaded}").splitlines()
        self.assertEqual(lines[0].split(), ["juggler", "juggler._exports"])
        own = ["juggler", "juggler._array_nodes", "juggler._exports", "juggler._node", "juggler.shapes"]
        self.assertEqual(lines[1].split(), own)

    def test_no_heavy_module_is_loaded(self):
        # Clusters need modules for processes and network addresses.
        names = [name for name in juggler.__all__ if name != "cluster"]
        code = f"import juggler\nfor name in {names}: getattr(juggler, name)\nprint(*sys.modules)"
        loaded = set(self.run_python(f"{code}").split())
        self.assertIn("juggler.materials", loaded)
        self.assertFalse(loaded & self.HEAVY)

    def test_import_takes_little_time(self):
        code = "import time; start = time.process_time()\nimport juggler\nprint(time.process_time() - start)"
        self.assertLess(min(float(self.run_python(code)) for _ in range(5)), 0.015)


if __name__ == "__main__":
    unittest.main()
