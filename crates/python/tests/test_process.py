"""Renderers in processes of Python: edits, threads, signals, forks, imports."""

import array
import asyncio
import concurrent.futures
import io
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
import types
import unittest
import unittest.mock

import juggler as jg
from support import ROOT, python, small_scene

LONG = {"size": (640, 360), "samples": 100_000}


class Renderers(unittest.TestCase):
    def test_values_are_read_set_and_removed(self):
        renderer = jg.Renderer(small_scene())
        self.assertAlmostEqual(renderer["materials.gold.conductor.roughness"], 0.2, places=6)
        self.assertEqual(renderer["objects[0].name"], "ground")
        self.assertIn("materials.gold", renderer)
        del renderer["objects[0].name"]
        self.assertNotIn("objects[0].name", renderer)
        for path in (
            "materials.gld.conductor",
            "materials.gold.conductor.roughnes",
            "objects[9]",
            "objects[",
        ):
            with self.assertRaises(KeyError, msg=path):
                renderer[path] = 1
        with self.assertRaisesRegex(KeyError, "did you mean `gold`"):
            renderer["materials.gld.conductor.roughness"]
        with self.assertRaises(jg.SceneError):
            renderer["materials.gold.conductor.roughness"] = "rough"

    def test_paths_lead_through_textures_of_a_material(self):
        checker = {"diffuse": {"reflectance": {"checker": {"size": 1, "even": "#ff0000"}}}}
        scene = small_scene()
        scene["objects"][1]["material"] = checker
        renderer = jg.Renderer(scene)
        before = renderer.render().hash
        path = "objects[1].material.diffuse.reflectance"
        self.assertEqual(renderer[f"{path}.checker.size"], 1)
        self.assertEqual(renderer[path]["checker"]["size"], 1)
        renderer[f"{path}.checker.size"] = 0.3
        checker["diffuse"]["reflectance"]["checker"]["size"] = 0.3
        self.assertEqual(renderer.render().hash, jg.render(scene).hash)
        self.assertNotEqual(renderer.render().hash, before)
        with self.assertRaisesRegex(KeyError, "did you mean `size`"):
            renderer[f"{path}.checker.sise"] = 2
        renderer[path] = "#ffffff"
        checker["diffuse"]["reflectance"] = "#ffffff"
        self.assertEqual(renderer.render().hash, jg.render(scene).hash)

    def test_a_long_render_does_not_block_others(self):
        long = jg.Renderer("juggler", size=(320, 180), samples=100_000).submit()
        try:
            start = time.monotonic()
            self.assertEqual(jg.render(small_scene()).hash, jg.render(small_scene(), threads=1).hash)
            renderer = jg.Renderer(small_scene())
            self.assertTrue(renderer.fingerprint)
            self.assertIn("pixel", str(renderer.probe(16, 9)))
            self.assertLess(time.monotonic() - start, 20)
            self.assertFalse(long.done())
        finally:
            long.cancel()

    def test_cameras_are_replaced(self):
        renderer = jg.Renderer(small_scene())
        before = renderer.render()
        renderer.camera = renderer.camera.replace(eye=(0, 2, 6))
        after = renderer.render()
        self.assertEqual(renderer.changed, {"camera"})
        self.assertNotEqual(after.hash, before.hash)
        scene = small_scene()
        scene["camera"]["perspective"]["eye"] = [0, 2, 6]
        self.assertEqual(after.hash, jg.render(scene).hash)
        self.assertEqual(after.hash, jg.render(small_scene(), camera=renderer.camera).hash)

    def test_pixels_are_explained(self):
        probe = jg.Renderer(small_scene()).probe(16, 9)
        self.assertTrue(str(probe).startswith("pixel 16,9 of 32x18"))
        self.assertEqual(probe.first_hit.object, "ball")
        self.assertTrue(probe.lights and probe.paths.samples)
        self.assertEqual(str(pickle.loads(pickle.dumps(probe))), str(probe))
        with self.assertRaises(jg.SettingsError):
            jg.Renderer(small_scene()).probe(99, 9)

    def test_renderers_are_pickled(self):
        renderer = jg.Renderer(small_scene(), samples=3, seed=2)
        renderer["materials.gold.conductor.roughness"] = 0.1
        again = pickle.loads(pickle.dumps(renderer))
        self.assertEqual(again.render().hash, renderer.render().hash)
        self.assertEqual(again.fingerprint, renderer.fingerprint)

    def test_threads_share_a_renderer(self):
        renderer = jg.Renderer(small_scene(), samples=64)
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            hashes = set(pool.map(lambda _: renderer.render().hash, range(6)))
        self.assertEqual(hashes, {renderer.render().hash})

    def test_threads_edit_a_renderer(self):
        renderer = jg.Renderer(small_scene(), samples=1)

        def work(number):
            for step in range(20):
                renderer["materials.gold.conductor.roughness"] = (number + step) / 100
                with self.assertRaises(jg.SceneError):
                    renderer["materials.gold.conductor.roughness"] = "rough"
                with self.assertRaises(KeyError):
                    renderer["materials.gld.conductor"] = 1
                renderer.render()

        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            list(pool.map(work, range(4)))
        renderer["materials.gold.conductor.roughness"] = 0.2
        self.assertEqual(renderer.render().hash, jg.render(small_scene(), samples=1).hash)

    def test_futures_are_awaited_and_cancelled(self):
        renderer = jg.Renderer(small_scene())
        self.assertEqual(renderer.submit().result(60).hash, renderer.render().hash)
        self.assertEqual(asyncio.run(renderer.render_async()).hash, renderer.render().hash)
        future = jg.Renderer("juggler", **LONG).submit()
        time.sleep(0.2)
        self.assertTrue(future.running() and future.cancel() and future.cancelled())
        future._thread.join(60)
        self.assertFalse(future._thread.is_alive())

    def test_async_renders_are_cancelled(self):
        async def limited():
            await asyncio.wait_for(jg.Renderer("juggler", **LONG).render_async(), 0.3)

        with self.assertRaises(asyncio.TimeoutError):
            asyncio.run(limited())

    def test_the_last_progress_of_short_renders_has_the_share_1(self):
        seen = []
        renderer = jg.Renderer("juggler", size=(32, 18), samples=2, progress=seen.append)
        renderer.render()
        shard = renderer.render_shard(0, 1)
        renderer.extend(shard, samples=4)
        self.assertEqual([progress.share for progress in seen if progress.share == 1], [1, 1, 1])
        self.assertEqual((seen[-1].stage, seen[-1].samples), ("rendering", 4 * 32 * 18))

    def test_progress_is_reported(self):
        seen = []
        start = time.monotonic()
        jg.render("juggler", size=(320, 180), samples=4096, time=0.7, progress=seen.append)
        self.assertTrue(2 <= len(seen) <= 10 * (time.monotonic() - start) + 2, len(seen))
        self.assertTrue(all(0 <= progress.share <= 1 for progress in seen) and seen[-1].stage == "rendering")
        self.assertEqual(seen[-1].share, 1)
        self.assertLess(seen[-1].seconds_left, 0.7)

    def test_errors_of_callbacks_cancel(self):
        def fail(progress):
            raise LookupError("stop")

        start = time.monotonic()
        with self.assertRaisesRegex(LookupError, "stop"):
            jg.render("juggler", **LONG, progress=fail)
        self.assertLess(time.monotonic() - start, 5)

    def test_errors_of_callbacks_cancel_builds(self):
        side = 500
        corners = array.array("f", (c for y in range(side) for x in range(side) for c in (x, (x * y) % 7, y)))
        faces = array.array("i")
        for corner in (y * side + x for y in range(side - 1) for x in range(side - 1)):
            faces.extend((corner, corner + side, corner + 1, corner + 1, corner + side, corner + side + 1))
        rows = (b"\3" + faces[i : i + 3].tobytes() for i in range(0, len(faces), 3))
        head = f"""ply
format binary_{sys.byteorder}_endian 1.0
element vertex {side * side}
property float x
property float y
property float z
element face {len(faces) // 3}
property list uchar int vertex_indices
end_header
"""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        file = os.path.join(folder.name, "bumps.ply")
        with open(file, "wb") as stream:
            stream.write(head.encode() + corners.tobytes() + b"".join(rows))
        mesh = {"mesh": {"file": file}}
        renderer = jg.Renderer({"version": 1, "objects": [{"shape": mesh}]}, size=(8, 8), samples=1)
        seen = []

        def fail(progress):
            seen.append(progress)
            raise LookupError("stop")

        with self.assertRaisesRegex(LookupError, "stop"):
            renderer.render(progress=fail)
        self.assertIn(seen[0].stage, ("preparing", "building"))
        # The build does not go on.
        time.sleep(0.5)
        before = time.process_time()
        time.sleep(1)
        self.assertLess(time.process_time() - before, 0.5)
        self.assertEqual(len(renderer.render().hash), 64)

    def test_notebooks_show_a_growing_image(self):
        shown = []

        class Handle:
            def update(self, shown_html):
                shown.append(shown_html)

        def display(shown_html, display_id):
            shown.append(shown_html)
            return Handle()

        kernel = types.SimpleNamespace(kernel=object())
        display_module = types.SimpleNamespace(HTML=str, display=display)
        modules = {
            "IPython": types.SimpleNamespace(get_ipython=lambda: kernel, display=display_module),
            "IPython.display": display_module,
        }
        with unittest.mock.patch.dict(sys.modules, modules):
            image = jg.render("juggler", size=(320, 180), samples=4096, time=1.5)
            jg.render(small_scene())
        self.assertGreaterEqual(len(shown), 2)
        self.assertIn("samples,", shown[0])
        self.assertEqual(shown[-1].count("<img"), 1)
        self.assertEqual(image.size, (320, 180))

    def test_a_bar_appears_on_a_terminal_after_a_second(self):
        stream = io.StringIO()
        with unittest.mock.patch("sys.stderr", stream):
            jg.render("juggler", size=(320, 180), samples=4096, time=1.5, progress=True)
        self.assertTrue("━" in stream.getvalue() and " left" in stream.getvalue())
        self.assertTrue(stream.getvalue().endswith("\r\x1b[K"))

    def test_panics_become_exceptions(self):
        done = python(
            "import juggler._native\ntry: juggler._native.panic_on_a_thread()\n"
            "except juggler.InternalError as error: print(error)"
        )
        self.assertIn("a panic for tests", done.stdout)
        self.assertEqual(done.stderr, "")


class Processes(unittest.TestCase):
    def test_import_is_light(self):
        code = (
            "import sys\nbefore = set(sys.modules)\nimport juggler\nnative = juggler.render\n"
            "print(*sorted(set(sys.modules) - before))"
        )
        loaded = python(code).stdout.split()
        heavy = {
            "numpy",
            "typing",
            "json",
            "dataclasses",
            "IPython",
            "asyncio",
            "concurrent",
            "ray",
            "inspect",
            "re",
        }
        self.assertFalse(heavy & set(loaded), loaded)
        self.assertIn("juggler._native", loaded)

    @unittest.skipUnless(hasattr(os, "fork"), "the system has no fork")
    def test_forked_processes_render(self):
        expected = jg.render(small_scene()).hash
        for number in range(10):
            child = os.fork()
            if child == 0:
                is_equal = jg.render(small_scene()).hash == expected
                os._exit(0 if is_equal else 1)
            self.assertEqual(os.waitpid(child, 0)[1], 0, number)

    @unittest.skipUnless(hasattr(os, "fork"), "the system has no fork")
    def test_a_fork_during_a_render_answers_with_an_error(self):
        code = (
            "import juggler, os, sys, time\n"
            "parent, forked = os.getpid(), []\n"
            "def fork(progress):\n"
            "    if not forked: forked.append(os.fork())\n"
            "try: juggler.render('juggler', size=(320, 180), time=0.5, samples=100000, progress=fork)\n"
            "except RuntimeError as error:\n"
            "    os._exit(7 if os.getpid() != parent and 'forked' in str(error) else 8)\n"
            "sys.exit(0 if os.waitstatus_to_exitcode(os.waitpid(forked[0], 0)[1]) == 7 else 9)"
        )
        self.assertEqual(python(code).returncode, 0)

    def test_spawned_processes_render(self):
        import multiprocessing

        expected = jg.render(small_scene()).hash
        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
            image = pool.submit(jg.render, small_scene()).result(120)
        self.assertEqual(image.hash, expected)

    def interrupted(self, code):
        """Seconds from an interrupt to the end, and the output."""
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        process = subprocess.Popen(
            [sys.executable, "-c", code],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.assertEqual(process.stdout.readline(), "ready\n")
        time.sleep(0.5)
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        return time.monotonic() - start, process.returncode, output, errors

    @unittest.skipIf(os.name == "nt", "signals of Unix")
    def test_an_interrupt_ends_a_render(self):
        code = (
            "import juggler, sys\nprint('ready', flush=True)\n"
            "try: juggler.render('juggler', size=(1920, 1080), samples=100_000)\n"
            "except KeyboardInterrupt: print('interrupted')"
        )
        seconds, status, output, errors = self.interrupted(code)
        self.assertEqual((status, output, errors), (0, "interrupted\n", ""))
        # The limit is generous: other processes may be busy.
        self.assertLess(seconds, 5)

    @unittest.skipIf(os.name == "nt", "signals of Unix")
    def test_an_interrupt_ends_the_program(self):
        code = (
            "import juggler._native, sys\nprint('ready', flush=True)\n"
            "sys.exit(juggler._native.main(['juggler', 'render', 'juggler', '--size', '1920x1080', '-o', "
            "'/dev/null', '--format', 'pfm', '--samples', '100000']))"
        )
        _, status, _, errors = self.interrupted(code)
        self.assertNotIn("Traceback", errors)
        # A program that has not begun to render ends by the signal.
        self.assertIn(status, (130, -signal.SIGINT))

    def test_the_module_is_the_program(self):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        done = subprocess.run(
            [sys.executable, "-m", "juggler", "scenes"],
            capture_output=True,
            text=True,
            env=environment,
            check=False,
        )
        self.assertEqual(done.returncode, 0)
        self.assertTrue(all(name in done.stdout for name in jg.examples()))

    def test_examples_and_configuration(self):
        self.assertIn("juggler", jg.examples())
        self.assertEqual(jg.models("juggler"), [])
        self.assertEqual(set(jg.__all__) - set(dir(jg)), set())
        for name in jg.__all__:
            getattr(jg, name)
        with self.assertRaises(AttributeError):
            getattr(jg, "rendr")
        stub = (ROOT / "crates/python/python/juggler/__init__.pyi").read_text()
        missing = [name for name in jg.__all__ if f"{name} as {name}" not in stub]
        self.assertEqual(set(missing) - set(jg.scene_types.__all__), set())


if __name__ == "__main__":
    unittest.main()
