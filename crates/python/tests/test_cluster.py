"""Renders on several workers: the image of one machine, whatever happens to workers and answers."""

import concurrent.futures
import multiprocessing
import os
import pickle
import random
import unittest
import unittest.mock

import juggler as jg
from juggler import Instances, Object, cluster, materials, shapes, textures
from juggler._cluster import worker
from juggler._cluster.executor import ExecutorPool
from juggler._cluster.mark import Ended, Mark, watch
from juggler._cluster.package import Package, unpack
from support import Folder, needs_numpy, needs_program, program_hash, small_scene
from support import numpy as np

SIZE = {"size": (64, 36), "samples": 16}


def leave(job, package, units):
    """Ends the process of a worker."""
    os._exit(1)


class Toy:
    """Executor of this process, whose answers come in random order. `change` gets the number of a task
    and its answer, and returns another answer, raises an exception, or returns `None` for an answer that
    never comes.
    """

    def __init__(self, change=None, seed=1):
        self._change = change or (lambda number, answer: answer)
        self._random = random.Random(seed)
        self._waiting = []
        self.tasks = 0

    def submit(self, function, job, package, units):
        # As other executors do, it pickles everything.
        arguments = pickle.dumps((function, job, package, units))
        self.tasks += bool(units)
        future = ToyFuture(self)
        self._waiting.append((future, self.tasks if units else None, arguments))
        return future

    def finish_one(self):
        if not self._waiting:
            return
        future, number, arguments = self._waiting.pop(self._random.randrange(len(self._waiting)))
        function, *arguments = pickle.loads(arguments)
        try:
            answer = pickle.loads(pickle.dumps(function(*arguments)))
            answer = answer if number is None else self._change(number, answer)
            if answer is not None:
                future.set_result(answer)
        except Exception as error:
            future.set_exception(error)


class ToyFuture(concurrent.futures.Future):
    """Future that does some work when somebody asks whether it is done."""

    def __init__(self, toy):
        super().__init__()
        self._toy = toy

    def done(self):
        self._toy.finish_one()
        return super().done()


class Executors(Folder):
    @classmethod
    def setUpClass(cls):
        cls.expected = jg.render("juggler", **SIZE).hash

    def setUp(self):
        super().setUp()
        # Small images have several tasks, too.
        self.enterContext(unittest.mock.patch("juggler._cluster.dealer._SHORTEST", 0.0))

    def rendered(self, change=None, workers=2, scene="juggler", **settings):
        self.toy = Toy(change)
        return cluster.render(scene, self.toy, workers, **{**SIZE, **settings})

    def test_images_equal_those_of_one_machine(self):
        image = self.rendered()
        self.assertEqual(image.hash, self.expected)
        self.assertEqual(image.fingerprint, jg.Renderer("juggler", **SIZE).fingerprint)
        self.assertGreater(self.toy.tasks, 4)
        path, other = self.folder / "a.png", self.folder / "b.png"
        image.save(path)
        jg.render("juggler", **SIZE).save(other)
        self.assertEqual(path.read_bytes(), other.read_bytes())

    def test_settings_act_on_all_workers(self):
        aovs = {"aovs": ["albedo", "depth", "object_id"], "denoise": True, "samples": 4}
        camera = {"perspective": {"eye": [0, 3, 9], "look_at": [0, 2, 0], "vertical_fov_degrees": 30}}
        for settings in (
            aovs,
            {"noise": 0.3, "samples": 128, "size": (32, 18)},
            {"samples": 100, "preview": True, "size": (20, 20)},
            {"camera": camera, "crop": (5, 3, 30, 20), "seed": 3, "samples": 3},
            {"frame": 3, "samples": 2, "shutter": (0, 0.5)},
        ):
            plain = {name: value for name, value in settings.items() if name != "preview"}
            expected = jg.render("juggler", **{**SIZE, **plain})
            image = self.rendered(**settings)
            self.assertEqual(image, expected, settings)
            self.assertEqual(image.frame, expected.frame)

    def test_few_tiles_are_split_by_samples(self):
        settings = {"size": (16, 16), "samples": 256}
        self.assertEqual(self.rendered(workers=4, **settings).hash, jg.render("juggler", **settings).hash)
        self.assertGreater(self.toy.tasks, 4)

    def test_many_samples_are_split_whatever_travels(self):
        for settings in (
            {"aovs": ["albedo", "depth", "object_id", "variance"], "denoise": True},
            {"preview": True},
            {"noise": 0.01},
        ):
            settings = {"size": (40, 24), "samples": 250, **settings}
            plain = {name: value for name, value in settings.items() if name != "preview"}
            with unittest.mock.patch("juggler._cluster.dealer._FIRST_COST", 100):
                self.assertEqual(self.rendered(**settings), jg.render("juggler", **plain))
            if "noise" not in settings:
                self.assertGreater(self.toy.tasks, 12)

    def test_jobs_leave_no_mark(self):
        with unittest.mock.patch("tempfile.tempdir", str(self.folder)):
            self.rendered()
            self.assertEqual(list(self.folder.iterdir()), [])
        mark = Mark()
        self.assertIsNone(watch(("another machine", "no file")))
        check = watch(mark.place)
        check("rendering", 0.5)
        mark.remove()
        self.assertRaises(Ended, check)
        self.assertRaises(Ended, watch, mark.place)

    def test_workers_that_do_not_see_the_mark_help(self):
        def unseen(mark):
            if mark.place is not None:
                os.remove(mark.place[1])

        prepare = ExecutorPool.prepare
        with unittest.mock.patch.object(
            ExecutorPool, "prepare", lambda pool, job: (unseen(job.mark), prepare(pool, job))
        ):
            self.assertEqual(self.rendered().hash, self.expected)

    def test_lost_work_is_done_again(self):
        lost = []

        def lose(number, answer):
            if number in (1, 2, 5):
                lost.append(number)
                raise cluster.WorkerLost("the node is gone")
            return answer

        self.assertEqual(self.rendered(lose).hash, self.expected)
        self.assertEqual(sorted(lost), [1, 2, 5])

    def test_answers_that_never_come_are_replaced_by_copies(self):
        def silent(number, answer):
            return None if number == 3 else answer

        self.assertEqual(self.rendered(silent).hash, self.expected)

    def test_damaged_answers_are_refused_and_done_again(self):
        damaged = []

        def damage(number, answer):
            if number not in (1, 4, 6):
                return answer
            data = bytearray(answer["data"])
            data[len(data) * number // 7] ^= 16
            damaged.append(number)
            return {**answer, "data": bytes(data if number != 6 else data[:-5])}

        self.assertEqual(self.rendered(damage).hash, self.expected)
        self.assertEqual(sorted(damaged), [1, 4, 6])

    def test_work_that_is_always_lost_stops_the_render(self):
        def lose(number, answer):
            raise cluster.WorkerLost(f"node {number} is gone")

        with self.assertRaisesRegex(
            cluster.ClusterError, r"task \d+ \(tile.* lost 3 times: .*WorkerLost: node"
        ):
            self.rendered(lose)

    def test_answers_of_another_image_stop_the_render(self):
        other = jg.Renderer("juggler", **SIZE, seed=9)._native.render_units([(0, 0, 16)], 0.0)

        def mistake(number, answer):
            return {**answer, "data": other}

        with self.assertRaisesRegex(jg.MergeError, "another picture: render.seed"):
            self.rendered(mistake)

    def test_other_versions_are_refused_by_name(self):
        with unittest.mock.patch.object(worker, "version", lambda: "0.0.9"):
            with self.assertRaisesRegex(cluster.ClusterError, rf"process {os.getpid()} cannot help: .*0.0.9"):
                self.rendered()

    def test_other_fingerprints_are_refused_by_name(self):
        job = {"kind": "still", "version": worker.version(), "key": "k", "settings": SIZE}
        job.update(frame=0.0, fingerprint="f")
        package = Package("juggler")
        answer = worker.work(job, (package.manifest, package.blobs), [(0, 0, 16)])
        self.assertEqual(answer["kind"], "refused")
        self.assertIn("the fingerprint", answer["error"])

    def test_exceptions_of_workers_stop_the_render(self):
        with unittest.mock.patch.object(worker, "_renderer", side_effect=LookupError("of the worker")):
            with self.assertRaisesRegex(LookupError, "of the worker") as caught:
                self.rendered()
        self.assertIn("On the worker", caught.exception.__notes__[0])

    def test_exceptions_that_cannot_be_pickled_are_reported(self):
        error = LookupError("odd", lambda: None)
        self.assertIsInstance(worker._portable(error), RuntimeError)
        self.assertIn("LookupError", str(worker._portable(error)))

    def test_large_packages_travel_when_a_worker_asks(self):
        with unittest.mock.patch("juggler._cluster.executor._SMALL_PACKAGE", 10):
            worker._renderers.clear()
            self.assertEqual(self.rendered().hash, self.expected)
            unknown = []

            def forget(number, answer):
                worker._renderers.clear()
                unknown.append(answer["kind"] == "unknown")
                return answer

            self.assertEqual(self.rendered(forget).hash, self.expected)
            self.assertTrue(any(unknown))

    def test_files_travel_with_the_scene(self):
        folder = self.folder / "models"
        folder.mkdir()
        (folder / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")
        scene = small_scene()
        scene["objects"].append({"shape": {"mesh": {"file": str(folder / "a.obj")}}, "material": "gold"})
        expected = jg.render(scene)
        package = pickle.loads(pickle.dumps((Package(scene).manifest, Package(scene).blobs)))
        (folder / "a.obj").unlink()
        renderer = jg.Renderer(unpack(*package))
        self.assertEqual(
            (renderer.render().hash, renderer.fingerprint), (expected.hash, expected.fingerprint)
        )

    @needs_numpy
    def test_arrays_travel_with_the_scene(self):
        scene = small_scene()
        uvs = np.array([(0, 0), (1, 0), (0, 1)], "f4")
        mesh = shapes.Mesh(positions=np.eye(3, dtype="f4"), triangles=np.array([(0, 1, 2)]), uvs=uvs)
        instances = Instances(
            positions=np.array([(0, 0, 1), (1, 0, 1)]), attributes={"heat": np.array([1, 2])}
        )
        wood = textures.Image(array=np.arange(12, dtype="u1").reshape(2, 2, 3) * 20)
        scene["objects"].append(
            Object(mesh, material=materials.Diffuse(reflectance=wood), instances=instances)
        )
        expected = jg.render(scene)
        package = Package(scene)
        self.assertEqual(len(package.manifest["assets"]), 3)
        self.assertEqual(package.key({}), Package(scene).key({}))
        renderer = jg.Renderer(unpack(*pickle.loads(pickle.dumps((package.manifest, package.blobs)))))
        self.assertEqual(
            (renderer.render().hash, renderer.fingerprint), (expected.hash, expected.fingerprint)
        )

    def test_meshes_and_models_are_scenes(self):
        path = self.folder / "a.obj"
        path.write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")
        settings = {"size": (20, 12), "samples": 2}
        self.assertEqual(self.rendered(scene=str(path), **settings).hash, jg.render(path, **settings).hash)

    def test_checkpoints_are_continued(self):
        path = self.folder / "job.jfilm"

        def stop(number, answer):
            if number > 4:
                raise KeyboardInterrupt
            return answer

        toy = Toy(stop)
        with self.assertRaises(KeyboardInterrupt):
            cluster.render("juggler", toy, 2, checkpoint=path, **SIZE)
        part = jg.PartialRender.open(path)
        self.assertFalse(part.description["finished"])
        image = self.rendered(checkpoint=path)
        self.assertEqual(image.hash, self.expected)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["job.jfilm"])
        self.assertTrue(jg.PartialRender.open(path).description["finished"])
        self.assertEqual(self.rendered(checkpoint=path).hash, self.expected)
        self.assertEqual(self.toy.tasks, 0, "nothing is left to render")
        self.assertEqual(jg.Renderer("juggler", **SIZE).extend(path).hash, self.expected)
        self.assertEqual(jg.merge([path]).hash, self.expected)
        with self.assertRaises(jg.MergeError):
            self.rendered(checkpoint=path, seed=5)

    @needs_program
    def test_the_program_and_workers_continue_each_other(self):
        path = str(self.folder / "job.jfilm")
        flags = ("--size", "64x36", "--checkpoint", path)
        program_hash("juggler", *flags, "--samples", "20")
        settings = {"size": (64, 36), "samples": 40}
        expected = jg.render("juggler", **settings).hash
        self.assertEqual(self.rendered(checkpoint=path, **settings).hash, expected)
        self.assertEqual(program_hash("juggler", *flags, "--samples", "40"), expected)

    def test_progress_has_workers_and_the_image(self):
        seen = []
        self.rendered(progress=seen.append, samples=64)
        self.assertTrue(all(progress.workers == 2 and 0 <= progress.share <= 1 for progress in seen))
        self.assertEqual({progress.stage for progress in seen}, {"rendering"})
        self.assertEqual(seen[-1].share, 1)
        self.assertEqual(seen[-1].image.size, (64, 36))
        with self.assertRaisesRegex(LookupError, "stop"):
            self.rendered(progress=unittest.mock.Mock(side_effect=LookupError("stop")), samples=64)

    def test_settings_that_cannot_act_are_refused(self):
        for settings, message in (
            ({"time": 3}, "one machine"),
            ({"preview": True, "noise": 0.1}, "noise"),
            ({"preview": True, "aovs": ["albedo"]}, "aovs"),
            ({"sampels": 3}, "sampels"),
            ({"workers": 0}, "at least 1"),
        ):
            with self.assertRaisesRegex(jg.SettingsError, message):
                self.rendered(**settings)
        with self.assertRaises(TypeError):
            cluster.render("juggler", object())
        with self.assertRaises(jg.SceneError):
            self.rendered(scene={"version": 1, "objects": [{"shape": "spere"}]})

    def test_frames_come_in_order(self):
        settings = {"size": (32, 18), "samples": 2}

        def lose(number, answer):
            if number == 2:
                raise cluster.WorkerLost("the node is gone")
            return answer

        for count in (1, 2, 5):
            expected = [image.hash for image in jg.frames("chess-opening", range(count), **settings)]
            toy = Toy(lose)
            images = list(cluster.frames("chess-opening", range(count), toy, 2, **settings))
            self.assertEqual([image.hash for image in images], expected)
            self.assertEqual([image.frame for image in images], list(range(count)))
        seen = []
        list(cluster.frames("chess-opening", range(3), Toy(), 2, progress=seen.append, **settings))
        self.assertEqual((seen[-1].stage, seen[-1].share), ("rendering", 1))

    def test_processes_are_workers(self):
        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
            self.assertEqual(cluster.render("juggler", pool, **SIZE).hash, self.expected)

    def test_broken_pools_end_the_render(self):
        path = self.folder / "job.jfilm"
        context = multiprocessing.get_context("fork")
        with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
            with unittest.mock.patch("juggler._cluster.executor.work", leave):
                with self.assertRaises(concurrent.futures.BrokenExecutor):
                    cluster.render("juggler", pool, checkpoint=path, **SIZE)
        self.assertFalse(jg.PartialRender.open(path).description["finished"])


if __name__ == "__main__":
    unittest.main()
