"""Arguments that are wrong, each with an error that says what is expected."""

import math
import os
import unittest

import juggler as jg
from juggler import Scene, cluster
from support import SMALL, Folder, needs_numpy, numpy, small_scene

# A name of a file that Linux allows and that is no UTF-8.
NOT_UTF8 = "\udc80"


class Settings(unittest.TestCase):
    def refused(self, setting, act, message="must be"):
        with self.assertRaisesRegex(jg.SettingsError, message) as caught:
            act()
        self.assertEqual(caught.exception.setting, setting)

    def test_numbers_out_of_range(self):
        renderer = jg.Renderer(small_scene(), **SMALL)
        self.refused("x", lambda: renderer.probe(-1, 0), "`x` must be at least 0, not -1")
        self.refused("y", lambda: renderer.probe(0, 1 << 40), "at most")
        for name in ("depth", "branches", "brightest"):
            self.refused(name, lambda name=name: renderer.probe(0, 0, **{name: -1}))
        self.refused("index", lambda: renderer.render_shard(-1, 3))
        self.refused("count", lambda: renderer.render_shard(0, 0))
        for every in (math.nan, -1, -math.inf):
            self.refused("every", lambda every=every: renderer.progressive(every=every))
            self.refused(
                "checkpoint_every",
                lambda every=every: cluster.render("juggler", Executor(), 1, checkpoint_every=every),
            )
        with self.assertRaisesRegex(TypeError, r"`x` must be a whole number, not 0\.5"):
            renderer.probe(0.5, 0)
        with self.assertRaisesRegex(TypeError, "`every` must be a number of seconds, not 'x'"):
            renderer.progressive(every="x")

    def test_progress_is_a_function_or_a_switch(self):
        renderer = jg.Renderer(small_scene(), **SMALL)
        for progress in (1, "x", []):
            for act in (
                lambda progress: jg.Renderer("juggler", progress=progress),
                lambda progress: renderer.render(progress=progress),
                lambda progress: renderer.render_shard(0, 2, progress=progress),
                lambda progress: jg.render_movie("juggler", "a.gif", progress=progress),
                lambda progress: cluster.render("juggler", Executor(), 1, progress=progress),
            ):
                with self.assertRaisesRegex(TypeError, "`progress` must be a function, True, False or None"):
                    act(progress)

    def test_one_setting_selects_the_frame(self):
        self.refused("at", lambda: jg.render("juggler", frame=1, at=0.5, **SMALL), "one of them")
        self.assertEqual(jg.Renderer("juggler", frame=1, at=None, **SMALL).frame, 1)
        for name in ("frame", "at"):
            self.refused(name, lambda name=name: jg.frames("juggler", range(2), **{name: 1}), "cannot act")
            self.refused(
                name,
                lambda name=name: cluster.frames("juggler", [1], Executor(), 1, **{name: 1}),
                "cannot act",
            )

    def test_frames_check_their_arguments_at_the_call(self):
        self.refused("sampels", lambda: jg.frames("juggler", range(2), sampels=7), "did you mean")
        self.refused(
            "sampels", lambda: cluster.frames("juggler", [1], Executor(), 1, sampels=7), "did you mean"
        )
        with self.assertRaisesRegex(
            TypeError, r"`frames` are numbers of frames, such as range\(0, 30\), not 3"
        ):
            jg.frames("juggler", 3)
        self.assertEqual(list(jg.frames("juggler", [])), [])


class Executor:
    """Executor that does nothing."""

    def submit(self, function, *arguments):
        raise AssertionError("no work was expected")


class Types(Folder):
    def test_scenes_are_no_classes(self):
        for act in (jg.render, jg.Renderer, lambda scene: jg.render_movie(scene, "a.gif")):
            with self.assertRaisesRegex(TypeError, r"`Scene\(\.\.\.\)`, not the class"):
                act(Scene)

    @needs_numpy
    def test_objects_of_other_kinds(self):
        for value in (None, 3, "x"):
            with self.assertRaisesRegex(TypeError, "from_meshio takes a mesh of meshio"):
                jg.from_meshio(value)
        with self.assertRaisesRegex(TypeError, "images of Juggler or files are compared, not ndarray"):
            jg.compare(numpy.zeros((2, 2, 3)), numpy.zeros((2, 2, 3)))
        with self.assertRaisesRegex(TypeError, "a PartialRender, its bytes or a file, not int"):
            jg.merge([1])

    def test_a_single_partial_render_is_merged(self):
        renderer = jg.Renderer(small_scene(), **SMALL)
        whole = renderer.render_shard(0, 1)
        whole.save(self.folder / "a.jfilm")
        for one in (whole, bytes(whole), self.folder / "a.jfilm", str(self.folder / "a.jfilm")):
            self.assertEqual(jg.merge(one).hash, renderer.render().hash)
        with self.assertRaisesRegex(jg.MergeError, "still to do"):
            jg.merge(renderer.render_shard(0, 2))

    def test_names_of_files_are_bytes_too(self):
        image = jg.render(small_scene(), **SMALL)
        for save, name in ((image.save, "a.png"), (Scene(objects=[]).save, "a.json")):
            save(os.fsencode(self.folder / name))
            self.assertTrue((self.folder / name).exists())
            with self.assertRaisesRegex(TypeError, "expected str, bytes or os.PathLike object, not int"):
                save(3)
        Scene.load(os.fsencode(self.folder / "a.json"))
        path = os.fsencode(self.folder / "a.png")
        self.assertTrue(jg.compare(path, path).same_bits)

    def test_names_of_files_are_utf8(self):
        image = jg.render(small_scene(), **SMALL)
        shard = jg.Renderer(small_scene(), **SMALL).render_shard(0, 1)
        for act, ending in (
            (jg.render, ".json"),
            (image.save, ".png"),
            (Scene(objects=[]).save, ".json"),
            (Scene.load, ".json"),
            (shard.save, ".jfilm"),
            (jg.PartialRender.open, ".jfilm"),
            (jg.merge, ".jfilm"),
            (lambda name: jg.compare(image, name), ".png"),
            (lambda name: jg.render_movie("juggler", name), ".gif"),
            (lambda name: cluster.render("juggler", Executor(), 1, checkpoint=name), ".jfilm"),
        ):
            with self.assertRaisesRegex(jg.FileError, r"must be UTF-8, not b'.*\\x80"):
                act(NOT_UTF8 + ending)


if __name__ == "__main__":
    unittest.main()
