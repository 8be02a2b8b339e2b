"""The tasks that docs/python.md teaches, each as a user writes it, with small images."""

import asyncio
import os
import shutil

import juggler as jg
from juggler import Object, Scene, materials, shapes, textures
from support import ROOT, Folder, needs_numpy, numpy, small_scene, typed_scene

SMALL = {"size": (32, 18)}


class Tasks(Folder):
    def setUp(self):
        super().setUp()
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)

    def test_1_render_a_scene_and_a_model(self):
        jg.render("juggler", samples=2, **SMALL).save("juggler.png")
        shutil.copy(ROOT / "scenes/models/robot.glb", "robot.glb")
        images = [
            jg.render("robot.glb", variant=variant, animation=clip, at=0.5, samples=2, denoise=True, **SMALL)
            for variant, clip in (("Lagoon", "Wave"), ("Tangerine", "Wave"), ("Lagoon", "Idle"))
        ]
        images[0].save("robot.png")
        self.assertEqual(len({image.hash for image in images}), 3)
        self.assertEqual(
            sorted(path.name for path in self.folder.glob("*.png")), ["juggler.png", "robot.png"]
        )
        [model] = jg.models("robot.glb")
        self.assertEqual(model["variants"], ["Tangerine", "Lagoon"])
        self.assertEqual([clip["name"] for clip in model["clips"]], ["Wave", "Idle"])

    def test_2_typed_scenes(self):
        scene = typed_scene()
        self.assertEqual(scene.check(), [])
        scene.save("scene.json")
        image = jg.render(scene)
        self.assertEqual(jg.render("scene.json").hash, image.hash)
        self.assertEqual(jg.render(Scene.load("scene.json")).hash, image.hash)
        bigger = scene.replace(render=scene.render.replace(samples=16))
        self.assertEqual((scene.render.samples, bigger.render.samples), (4, 16))
        self.assertEqual(jg.render(bigger).stats["samples"], 16)

    @needs_numpy
    def test_3_arrays(self):
        v = numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "f8")
        f, n, uv = (
            numpy.array([(0, 1, 2)]),
            numpy.array([(0, 0, 1)] * 3),
            numpy.array([(0, 0), (1, 0), (0, 1)]),
        )
        c, ids = numpy.full((3, 3), 200, "u1"), numpy.array([7])
        attributes = {"color": c, "part": jg.PerFace(ids)}
        mesh = shapes.Mesh(positions=v, triangles=f, normals=n, uvs=uv, attributes=attributes)
        wood = textures.Image(array=numpy.zeros((2, 2, 3), "u1"), color_space="srgb")
        dots = Object(shapes.Sphere(radius=0.01), instances=jg.Instances(positions=v, scales=numpy.ones(3)))
        scene = typed_scene()
        scene.objects += [Object(mesh, material=materials.Diffuse(reflectance=wood)), dots]
        self.assertEqual(scene.check(), [])
        image = jg.render(scene)
        scene.save("arrays.json")
        self.assertEqual(jg.render(Scene.load("arrays.json")).hash, image.hash)

    def test_4_edit_and_render_again(self):
        r = jg.Renderer(typed_scene(), samples=8)
        before = r.render()
        r["materials.gold.conductor.roughness"] = 0.05
        r.camera = r.camera.replace(eye=(0, 2, 6))
        after = r.render()
        self.assertEqual(r.changed, {"material", "camera"})
        self.assertNotEqual(before.hash, after.hash)
        *_, last = r.progressive(every=0.5)
        self.assertEqual(last.hash, after.hash)
        with self.assertRaisesRegex(KeyError, "did you mean `roughness`"):
            r["materials.gold.conductor.roughnes"] = 0.1

    def test_5_animations(self):
        settings = {"samples": 1, **SMALL}
        images = list(jg.frames("chess-opening", range(3, 5), shutter=(0, 0.5), **settings))
        self.assertEqual([image.frame for image in images], [3, 4])
        self.assertNotEqual(images[0].hash, images[1].hash)
        jg.render_movie("chess-opening", "chess.gif", frames=range(2), **settings)
        self.assertEqual((self.folder / "chess.gif").read_bytes()[:3], b"GIF")

    @needs_numpy
    def test_6_aovs(self):
        names = ["albedo", "normal", "depth", "object_id", "motion"]
        image = jg.render(typed_scene(), aovs=names)
        self.assertEqual(image.color.shape, (18, 32, 3))
        self.assertEqual(image.aovs["normal"].shape, (18, 32, 3))
        self.assertEqual(image["depth"].shape, (18, 32))
        self.assertEqual(image["object_id"].dtype, numpy.int32)
        self.assertEqual(set(image.aovs), set(names))
        self.assertIn("objects[1]", image.names["object_id"][image["object_id"][9, 16]])
        self.assertEqual(image.camera.world_to_camera.shape, (4, 4))
        intrinsic, rotation, translation = image.camera.opencv
        self.assertEqual((intrinsic.shape, rotation.shape, translation.shape), ((3, 3), (3, 3), (3,)))

    @needs_numpy
    def test_7_denoise(self):
        scene = typed_scene()
        clean = jg.render(scene, samples=8, denoise="own")
        noisy = jg.Renderer(scene, samples=8, aovs=["albedo", "normal", "depth"]).render()
        later = noisy.denoised()
        arrays = jg.denoise(noisy.color, albedo=noisy["albedo"], normal=noisy["normal"], depth=noisy["depth"])
        self.assertEqual(len({image.hash for image in (clean, noisy, later)}), 3)
        self.assertTrue(numpy.array_equal(arrays, later.color))

    def test_8_compare(self):
        a, b = (jg.render(typed_scene(), aovs=["variance"], samples=64, seed=seed) for seed in (1, 2))
        c = jg.compare(a, b)
        self.assertTrue(c.same_but_for_noise, c)
        self.assertGreater(c.p, 0.01)
        self.assertLess(c.flip, 0.2)
        self.assertLess(c.rmse, 0.2)
        self.assertIn(
            "variance", jg.compare(jg.render(small_scene()), jg.render(small_scene(), seed=5)).reason
        )

    def test_9_probe(self):
        p = jg.Renderer(typed_scene()).probe(16, 9)
        self.assertIn("material gold", str(p))
        self.assertTrue(p.lights)
        self.assertTrue(p.paths)

    def test_10_shards(self):
        r = jg.Renderer(typed_scene())
        jg.merge([r.render_shard(i, 4) for i in range(4)]).save("whole.png")
        r.render().save("image.png")
        self.assertEqual((self.folder / "whole.png").read_bytes(), (self.folder / "image.png").read_bytes())
        r.render_shard(0, 1).save("still.jfilm")
        self.assertEqual(jg.PartialRender.open("still.jfilm").description["samples"], 4)
        more = r.extend("still.jfilm", samples=16)
        self.assertEqual(more.hash, jg.render(typed_scene(), samples=16).hash)

    def test_11_progress_and_futures(self):
        shares = []
        image = jg.render(
            typed_scene(), samples=4096, time=0.6, max_memory="4G", progress=lambda p: shares.append(p.share)
        )
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(shares and image.stats["samples"] >= 1, shares)
        r = jg.Renderer(typed_scene(), samples=100_000, size=(640, 360))
        future = r.submit()
        self.assertTrue(future.cancel())
        small = jg.Renderer(typed_scene())
        self.assertEqual(asyncio.run(small.render_async()).hash, small.render().hash)

    @needs_numpy
    def test_14_scientific_pictures(self):
        v, f = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 1)], [(0, 1, 2), (0, 2, 3)]
        obj = jg.sci.surface(v, f, values=[0, 1, 5, numpy.nan], cmap="viridis", clim=(0, 5), nan="#808080")
        scene = Scene(objects=[obj], camera=jg.sci.camera(obj.bounds, view="isometric"))
        image = jg.render(scene, samples=2, **SMALL)
        self.assertGreater(len(numpy.unique(image.color.reshape(-1, 3), axis=0)), 10)
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("Agg")
        self.assertEqual(len(image.plot(colorbar=True).axes), 2)
