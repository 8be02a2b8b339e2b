"""Images of the package and of the program are equal, to the bit.

JUGGLER_HASHES=all compares all built-in scenes and three models.
"""

import os
import pickle
import unittest
import warnings

import juggler as jg
from support import (
    ROOT,
    SMALL,
    Folder,
    chunks,
    needs_numpy,
    needs_program,
    numpy,
    program,
    program_hash,
    small_scene,
)

SCENES = ["juggler", "material-balls", "sphere-lights", "many-lights-room", "glass-caustics"]
MODELS = [str(ROOT / "scenes/models" / name) for name in ("robot.glb", "room.glb", "still-life.glb")]
if os.environ.get("JUGGLER_HASHES") == "all":
    SCENES = [*jg.examples(), *MODELS]


class Hashes(unittest.TestCase):
    @needs_program
    def test_the_hash_is_that_of_the_program(self):
        for name in SCENES:
            expected = program_hash(name, "--size", "64x36", "--samples", "2")
            for threads in (1, 2, 3):
                renderer = jg.Renderer(name, size=(64, 36), samples=2, threads=threads)
                self.assertEqual(renderer.render().hash, expected, (name, threads))
                shards = [renderer.render_shard(index, 5) for index in range(5)]
                self.assertEqual(jg.merge(shards).hash, expected, (name, threads, "5 shards"))

    @needs_program
    def test_settings_are_those_of_the_program(self):
        cases = [
            ({"noise": 0.2, "samples": 64}, ["--noise", "0.2", "--samples", "64"]),
            ({"denoise": True, "seed": 3}, ["--denoise", "own", "--seed", "3"]),
            ({"integrator": "path"}, ["--integrator", "path"]),
            ({"frame": 7, "shutter": (0, 0.5)}, ["--frame", "7", "--shutter", "0..0.5"]),
            ({"crop": (5, 3, 20, 10), "max_depth": 2}, ["--crop", "5,3,20,10", "--max-depth", "2"]),
            ({"aovs": ["albedo", "depth"]}, ["--aov", "albedo,depth"]),
            ({"transparent": True}, ["--transparent"]),
        ]
        for settings, flags in cases:
            settings = {"size": (32, 18), "samples": 4, **settings}
            samples = [] if "--samples" in flags else ["--samples", "4"]
            expected = program_hash("juggler", "--size", "32x18", *samples, *flags)
            self.assertEqual(jg.render("juggler", **settings).hash, expected, settings)

    def test_edited_scenes_equal_fresh_ones(self):
        renderer = jg.Renderer(small_scene())
        renderer.render()
        self.assertEqual(renderer.changed, set())
        renderer["materials.gold.conductor.roughness"] = 0.05
        renderer["/objects/1/transform/0/translate"] = [0.5, 1, 0]
        edited = renderer.render()
        scene = small_scene()
        scene["materials"]["gold"]["conductor"]["roughness"] = 0.05
        scene["objects"][1]["transform"][0]["translate"] = [0.5, 1, 0]
        self.assertEqual(edited.hash, jg.render(scene).hash)
        self.assertEqual(edited.fingerprint, jg.render(scene).fingerprint)
        self.assertEqual(renderer.changed, {"material", "transform"})

    def test_progressive_renders_end_as_others(self):
        renderer = jg.Renderer(small_scene(), samples=64)
        images = list(renderer.progressive(every=0.02))
        self.assertEqual(images[-1].hash, renderer.render().hash)
        for image in renderer.progressive(every=0.02):
            break
        self.assertEqual(image.size, (32, 18))


class Files(Folder):
    @needs_program
    def test_files_are_equal_but_for_the_command(self):
        jg.render("juggler", **SMALL).save(self.folder / "a.png")
        program(
            "render", "juggler", "--size", "32x18", "--samples", "2", "-q", "-o", str(self.folder / "b.png")
        )
        ours, theirs = (chunks((self.folder / name).read_bytes()) for name in ("a.png", "b.png"))
        self.assertEqual([chunk for chunk in theirs if b"Command" not in chunk], ours)

    def test_merged_files_are_those_of_whole_renders(self):
        renderer = jg.Renderer("juggler", **SMALL)
        jg.merge([renderer.render_shard(index, 3) for index in range(3)]).save(self.folder / "a.png")
        renderer.render().save(self.folder / "b.png")
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "b.png").read_bytes())

    def test_partial_renders_are_files_and_bytes(self):
        renderer = jg.Renderer(small_scene())
        shard = renderer.render_shard(1, 4)
        shard.save(self.folder / "shard.jfilm")
        self.assertEqual((self.folder / "shard.jfilm").read_bytes(), shard)
        again = jg.PartialRender.open(self.folder / "shard.jfilm")
        self.assertEqual(pickle.loads(pickle.dumps(again)), shard)
        self.assertEqual(memoryview(again).nbytes, len(shard))
        self.assertEqual(repr(again), f"<juggler.PartialRender 1 of 4, {len(shard)} bytes>")
        self.assertEqual(again.description["samples"], 4)
        with self.assertRaisesRegex(jg.MergeError, "still to do"):
            jg.merge([shard])
        with self.assertRaises(jg.FileError):
            jg.PartialRender(b"nothing")
        with self.assertRaisesRegex(jg.SettingsError, "no shard 4"):
            renderer.render_shard(4, 4)

    def test_partial_renders_are_extended(self):
        few = jg.Renderer(small_scene(), samples=16, sampler="independent")
        few.render_shard(0, 1).save(self.folder / "still.jfilm")
        image = few.extend(self.folder / "still.jfilm", samples=48)
        self.assertEqual(image.hash, jg.render(small_scene(), samples=48, sampler="independent").hash)
        other = jg.Renderer("juggler", **SMALL)
        with self.assertRaisesRegex(jg.MergeError, "another picture"):
            other.extend(self.folder / "still.jfilm")

    def test_errors_of_files_name_them(self):
        image = jg.render(small_scene())
        with self.assertRaises(OSError) as caught:
            image.save(self.folder / "none" / "a.png")
        self.assertIsInstance(caught.exception, jg.FileError)
        self.assertEqual(caught.exception.errno, 2)
        self.assertIn("a.png", str(caught.exception))
        with self.assertRaises(jg.SettingsError):
            image.save(self.folder / "a.docx")


class Images(unittest.TestCase):
    @needs_numpy
    def test_arrays_have_the_pixels(self):
        aovs = ["albedo", "normal", "depth", "object_id", "material_id"]
        image = jg.render(small_scene(), aovs=aovs)
        self.assertEqual(image.color.shape, (18, 32, 3))
        self.assertEqual(image.color.dtype, numpy.float32)
        self.assertEqual(image["normal"].shape, (18, 32, 3))
        self.assertEqual(image.aovs["depth"].shape, (18, 32))
        ids = image["object_id"]
        self.assertEqual(ids.dtype, numpy.int32)
        self.assertEqual(
            {image.names["object_id"][number] for number in numpy.unique(ids)} - {None}, {"ground", "ball"}
        )
        self.assertEqual(image.names["material_id"][image["material_id"][9, 16]], "gold")
        self.assertEqual(list(image.aovs), aovs)
        self.assertEqual(numpy.asarray(image).tolist(), image.color.tolist())
        levels = image.to_uint8()
        self.assertEqual((levels.shape, levels.dtype), ((18, 32, 3), numpy.uint8))
        self.assertTrue((image.to_uint8(exposure=2) >= levels).all())
        self.assertAlmostEqual(float(image.color.mean(axis=(0, 1))[0]), image.stats["mean"][0], places=5)
        with self.assertRaisesRegex(KeyError, "aovs="):
            image["uv"]

    @needs_numpy
    def test_materials_without_names_have_an_index(self):
        scene = small_scene()
        for entry, level in zip(scene["objects"], (0.2, 0.7)):
            entry["material"] = {"diffuse": {"reflectance": level}}
        image = jg.render(scene, aovs=["material_id"])
        shown = {image.names["material_id"][number] for number in numpy.unique(image["material_id"])}
        self.assertEqual(len(shown), len(numpy.unique(image["material_id"])))
        self.assertTrue(all(name is None or name for name in shown))

    @needs_numpy
    def test_camera_matrices_project_points(self):
        image = jg.render(small_scene(), aovs=["position", "depth"])
        K, R, t = image.camera.opencv
        point = image["position"][12, 20]
        x, y, z = K @ (R @ point + t)
        self.assertTrue(abs(x / z - 20.5) < 0.5 and abs(y / z - 12.5) < 0.5, (x / z, y / z))
        self.assertTrue(numpy.allclose(R @ R.T, numpy.eye(3), atol=1e-5))
        self.assertAlmostEqual(float(numpy.linalg.det(R)), 1.0, places=5)
        self.assertTrue(numpy.allclose(image.camera.world_to_camera[:3, :3], R))

    def test_images_are_pickled(self):
        for settings in ({}, {"aovs": ["normal", "object_id"]}, {"crop": (2, 2, 9, 9), "tone": "agx"}):
            image = jg.render(small_scene(), **settings)
            again = pickle.loads(pickle.dumps(image))
            self.assertEqual(again, image)
            self.assertEqual(
                (again.metadata, again.stats, again.names), (image.metadata, image.stats, image.names)
            )
            self.assertEqual(again._repr_png_(), image._repr_png_())

    def test_notebooks_show_images(self):
        image = jg.render(small_scene(), aovs=["normal", "depth"])
        self.assertTrue(image._repr_png_().startswith(b"\x89PNG"))
        html = image._repr_html_()
        self.assertTrue("data:image/png;base64," in html and "<figcaption>depth" in html)

    def test_images_are_compared(self):
        settings = {"aovs": ["variance"], "samples": 64, "integrator": "path"}
        one, two = (jg.render(small_scene(), seed=seed, **settings) for seed in (1, 2))
        found = jg.compare(one, two)
        self.assertTrue(found.same_but_for_noise and found.p > 0.01, found)
        self.assertTrue(0 < found.rmse and 0 < found.flip < 1)
        brighter = jg.render(
            small_scene(lights=[{"point": {"position": [-3, 5, 4], "intensity": 90}}]), seed=3, **settings
        )
        self.assertIs(jg.compare(one, brighter).same_but_for_noise, False)
        self.assertIsNone(jg.compare(one, jg.render(small_scene())).p)
        self.assertTrue(jg.compare(one, one).same_bits)
        again = jg.render(small_scene(), seed=1, denoise=True, **settings)
        self.assertIn("denoised", jg.compare(one, again).reason)


class Scenes(Folder):
    def test_scenes_come_as_names_files_and_objects(self):
        class Typed:
            def to_dict(self):
                return small_scene()

        import json

        (self.folder / "scene.json").write_text(json.dumps(small_scene()))
        hashes = {jg.render(scene).hash for scene in (small_scene(), Typed(), self.folder / "scene.json")}
        self.assertEqual(len(hashes), 1)
        with self.assertRaises(TypeError):
            jg.render(3)

    @needs_numpy
    def test_scenes_may_hold_arrays(self):
        scene = small_scene()
        scene["objects"][1]["transform"][0]["translate"] = numpy.array([0, 1, 0])
        self.assertEqual(jg.render(scene).hash, jg.render(small_scene()).hash)
        scene["objects"][1]["transform"][0]["translate"] = numpy.array([0, numpy.nan, 0])
        with self.assertRaises(jg.SceneError):
            jg.render(scene)

    def test_all_mistakes_are_reported_at_once(self):
        scene = small_scene()
        scene["objects"][0]["shape"] = "spere"
        scene["materials"]["gold"]["conductor"]["roughnes"] = 0.1
        with self.assertRaises(ValueError) as caught:
            jg.render(scene)
        problems = {problem.path: problem for problem in caught.exception.problems}
        self.assertEqual(set(problems), {"objects[0].shape", "materials.gold.conductor.roughnes"})
        self.assertEqual(problems["objects[0].shape"].severity, "error")
        self.assertIn("did you mean `roughness`?", str(caught.exception))
        self.assertEqual(pickle.loads(pickle.dumps(caught.exception)).problems, caught.exception.problems)

    def test_mistakes_of_files_have_lines(self):
        (self.folder / "scene.json").write_text('{"version": 1,\n "objects": [{"shape": "spere"}]}')
        with self.assertRaises(jg.SceneError) as caught:
            jg.render(self.folder / "scene.json")
        (problem,) = caught.exception.problems
        self.assertEqual((problem.line, problem.column), (2, 24))
        self.assertTrue(problem.file.endswith("scene.json") and "-->" in str(caught.exception))

    def test_warnings_point_to_the_user(self):
        scene = small_scene(lights=[{"ambient": {"color": 0.1}}, {"point": {}}])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            jg.render(scene, integrator="path")
        self.assertTrue(caught and all(issubclass(one.category, jg.SceneWarning) for one in caught))
        self.assertEqual({one.filename for one in caught}, {__file__})

    def test_settings_are_checked(self):
        cases = [
            ("sampels", 3),
            ("size", "big"),
            ("noise", -1),
            ("integrator", "pth"),
            ("camera", "top"),
            ("crop", (0, 0, 99, 9)),
            ("variant", "red"),
            ("threads", 0),
            ("max_memory", "lots"),
            ("aovs", ["depht"]),
            ("shutter", (1, 0)),
            ("shutter", (0, 1e9)),
            ("size", (0, 9)),
            ("size", (10**6, 10**6)),
            ("samples", 0),
            ("exposure", 1000),
            ("exposure", float("nan")),
            ("crop", (0, 0, 0, 9)),
        ]
        for name, value in cases:
            with self.assertRaises(jg.SettingsError, msg=name):
                jg.render(small_scene(), **{name: value})
            with self.assertRaises(jg.SettingsError) as caught:
                jg.Renderer(small_scene(), **{name: value}).render()
            self.assertEqual(caught.exception.setting, name)
        with self.assertRaisesRegex(jg.SettingsError, "did you mean `samples`") as caught:
            jg.render("does-not-exist.json", sampels=3)
        error = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((error.setting, error.help), ("sampels", "did you mean `samples`?"))
        self.assertEqual(str(error), "there is no setting `sampels`; did you mean `samples`?")
        with self.assertRaises(MemoryError):
            jg.render(small_scene(), max_memory="1M")
        jg.render(small_scene(), max_memory="4G")

    @needs_program
    def test_models_are_chosen(self):
        models = ROOT / "scenes/models"
        (robot,) = jg.models(models / "robot.glb")
        clips = [clip["name"] for clip in robot["clips"]]
        self.assertTrue(clips and robot["format"].startswith("glTF"))
        renderer = jg.Renderer(models / "robot.glb", animation=clips[-1], frame=3, **SMALL)
        flags = ["--animation", clips[-1], "--frame", "3", "--size", "32x18", "--samples", "2"]
        image = renderer.render()
        self.assertEqual(image.hash, program_hash(str(models / "robot.glb"), *flags))
        self.assertEqual(pickle.loads(pickle.dumps(renderer)).render().hash, image.hash)
        with self.assertRaisesRegex(jg.SettingsError, "`variant` is for model files"):
            jg.Renderer("juggler", variant="red")

    @needs_numpy
    def test_images_have_the_names_of_their_arrays(self):
        image = jg.render("juggler", aovs=["Z", "albedo"], **SMALL)
        self.assertEqual(list(image), ["color", "albedo", "planar_depth"])
        self.assertEqual(dict(image)["color"].shape, (18, 32, 3))
        for name in ("color", "albedo", "planar_depth", "Z"):
            self.assertIn(name, image)
        for name in ("depth", "normal", "cryptomatte", "beauty", 0, None):
            self.assertNotIn(name, image)
        self.assertIs(image["Z"], image["planar_depth"])
        for name, help in (("depth", "depth"), ("N", "normal"), ("cryptomatte", "cryptomatte")):
            with self.assertRaisesRegex(KeyError, rf"render it with aovs=\['{help}'\]"):
                image[name]
        with self.assertRaisesRegex(KeyError, r"no AOV 'fo', it has albedo, planar_depth\"$"):
            image["fo"]

    @needs_numpy
    def test_levels_are_those_of_a_file_without_dithering(self):
        image = jg.render("juggler", dither=False, **SMALL)
        image.save(self.folder / "a.png")
        try:
            from PIL import Image
        except ImportError:
            self.skipTest("Pillow is not installed")
        with Image.open(self.folder / "a.png") as saved:
            self.assertTrue(numpy.array_equal(numpy.asarray(saved), image.to_uint8()))

    def test_transparent_images_have_alpha(self):
        scene = small_scene()
        image = jg.render(scene, transparent=True, **SMALL)
        width, height = image.size
        self.assertEqual((image.alpha.shape, image.alpha.dtype), ((height, width), numpy.float32))
        self.assertTrue(0 <= image.alpha.min() < image.alpha.max() <= 1)
        self.assertFalse(image.color[image.alpha == 0].any())
        self.assertNotEqual(image.hash, jg.render(scene, **SMALL).hash)
        self.assertIsNone(jg.render(scene, **SMALL).alpha)
        again = pickle.loads(pickle.dumps(image))
        self.assertEqual((again, again.hash), (image, image.hash))
        self.assertTrue(numpy.array_equal(again.alpha, image.alpha))
        merged = jg.merge([jg.Renderer(scene, transparent=True, **SMALL).render_shard(index, 3) for index in range(3)])
        self.assertEqual(merged.hash, image.hash)
        self.assertTrue(numpy.array_equal(merged.alpha, image.alpha))
        with self.assertRaisesRegex((ValueError, OSError), "a JPEG file cannot be transparent"):
            image.save(self.folder / "a.jpg")
        image.save(self.folder / "a.png")
        # Bit 2 of the color type in the head of a PNG file is alpha.
        self.assertEqual((self.folder / "a.png").read_bytes()[25], 6)

    def test_cameras_can_be_removed(self):
        renderer = jg.Renderer(small_scene(), **SMALL)
        renderer.camera = None
        renderer.camera = None
        self.assertNotIn("camera", renderer)
        expected = small_scene()
        del expected["camera"]
        self.assertEqual(renderer.render().hash, jg.render(expected, **SMALL).hash)
        for absent in (lambda: renderer["camera"], lambda: renderer.__delitem__("camera")):
            with self.assertRaisesRegex(KeyError, "has no `camera`'$"):
                absent()

    def test_frames_are_those_of_fresh_renders(self):
        images = list(jg.frames("juggler", range(3, 6), **SMALL))
        self.assertEqual([image.frame for image in images], [3, 4, 5])
        for image in images:
            self.assertEqual(image.hash, jg.render("juggler", frame=image.frame, **SMALL).hash)


if __name__ == "__main__":
    unittest.main()
