"""Scenes of typed classes: checked, saved, loaded and rendered."""

import inspect
import os
import pickle
import unittest

import juggler as jg
from juggler import Object, Scene, lights, materials, shapes
from support import SMALL, Folder, small_scene, typed_scene


class TypedScenes(Folder):
    def test_a_typed_scene_is_the_scene_of_its_dict(self):
        scene = typed_scene()
        image = jg.render(scene)
        self.assertEqual(image.hash, jg.render(scene.to_dict()).hash)
        self.assertEqual(image.hash, jg.render(pickle.loads(pickle.dumps(scene))).hash)
        bigger = scene.replace(render=scene.render.replace(samples=8))
        self.assertNotEqual(jg.render(bigger).hash, image.hash)
        self.assertEqual(jg.render(bigger).hash, jg.render(scene, samples=8).hash)

    def test_mistakes_are_all_found(self):
        scene = typed_scene()
        self.assertEqual(scene.check(), [])
        scene = scene.replace(
            lights=[lights.Point(intensity=-1)],
            objects=[Object(shapes.Sphere(radius="wide"), material="gld")],
        )
        with self.assertRaises(jg.SceneError) as caught:
            scene.check()
        self.assertEqual(len(caught.exception.problems), 3)
        self.assertIn("did you mean `gold`", str(caught.exception))
        with self.assertRaisesRegex(TypeError, "did you mean `roughness`"):
            materials.Conductor(roughnes=0.2)

    def test_a_saved_scene_is_loaded(self):
        scene = typed_scene()
        path = os.path.join(self.folder, "scene.json")
        scene.save(path)
        loaded = Scene.load(path)
        self.assertEqual(jg.render(path).hash, jg.render(scene).hash)
        self.assertEqual(jg.render(loaded).hash, jg.render(scene).hash)
        self.assertEqual(loaded.render["samples"], 4)
        self.assertEqual(jg.render(Scene.load("juggler"), **SMALL).hash, jg.render("juggler", **SMALL).hash)
        with self.assertRaises(jg.FileError):
            Scene.load(os.path.join(self.folder, "none.json"))

    def test_dicts_and_classes_mix(self):
        mixed = small_scene()
        mixed["objects"].append(Object(shapes.Sphere(radius=0.3), material="gold").translate(1, 0.3, 1))
        plain = small_scene()
        plain["objects"].append(
            {
                "shape": {"sphere": {"radius": 0.3}},
                "material": "gold",
                "transform": [{"translate": [1, 0.3, 1]}],
            }
        )
        self.assertEqual(jg.render(mixed, **SMALL).hash, jg.render(plain, **SMALL).hash)


class Tracing(unittest.TestCase):
    def tearDown(self):
        jg.trace_nodes(False)

    def problems(self, scene):
        with self.assertRaises(jg.SceneError) as caught:
            scene.check()
        return caught.exception

    def test_mistakes_name_the_line_that_made_the_part(self):
        jg.trace_nodes(True)
        sphere = shapes.Sphere(radius=-1)
        line = inspect.currentframe().f_lineno - 1
        error = self.problems(Scene(objects=[Object(shapes.Plane()), Object(sphere)]))
        [problem] = error.problems
        self.assertEqual(problem.path, "objects[1].shape.sphere.radius")
        self.assertEqual(problem.made_at, f"{__file__}:{line}")
        self.assertTrue(str(error).endswith(f"; made at {__file__}:{line}"), error)
        self.assertEqual(pickle.loads(pickle.dumps(problem)), problem)

    def test_a_part_without_a_class_has_the_line_of_the_part_around_it(self):
        jg.trace_nodes(True)
        material = {"diffuse": {"reflectance": "=1 +"}}
        scene = Scene(materials={"odd name": material}, objects=[Object(shapes.Plane())])
        line = inspect.currentframe().f_lineno - 1
        self.assertEqual(
            {problem.made_at for problem in self.problems(scene).problems}, {f"{__file__}:{line}"}
        )

    def test_nothing_is_traced_at_first(self):
        error = self.problems(Scene(objects=[Object(shapes.Sphere(radius=-1))]))
        self.assertEqual([problem.made_at for problem in error.problems], [None])
        self.assertNotIn("made at", str(error))


if __name__ == "__main__":
    unittest.main()
