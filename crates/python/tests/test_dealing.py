"""Dealing of work to workers, scripts of batch systems, and imports of other packages."""

import signal
import subprocess
import sys
import time
import types
import unittest
import unittest.mock

import juggler as jg
from juggler import cluster
from juggler._cluster import dealer as dealing
from support import Folder, environment, python, small_scene


# Renders for minutes in threads or processes until Ctrl-C comes.
ENDLESS = """
import concurrent.futures as futures, multiprocessing, signal, sys
import juggler.cluster

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)
    context = multiprocessing.get_context("spawn")
    with futures.ThreadPoolExecutor(2) if sys.argv[1] == "threads" else futures.ProcessPoolExecutor(
        2, mp_context=context
    ) as pool:
        juggler.cluster.render(
            "juggler", pool, size=(256, 144), samples=100000, progress=lambda p: print(p.share, flush=True)
        )
"""


class Interrupts(Folder):
    def test_ctrl_c_ends_tasks_that_have_begun(self):
        script = self.folder / "endless.py"
        script.write_text(ENDLESS)
        for kind in ("threads", "processes"):
            words = [sys.executable, str(script), kind]
            pipe = subprocess.PIPE
            with subprocess.Popen(words, env=environment(), stdout=pipe, stderr=pipe, text=True) as process:
                while float(process.stdout.readline() or 1) == 0:
                    pass
                start = time.monotonic()
                process.send_signal(signal.SIGINT)
                _, errors = process.communicate(timeout=60)
            self.assertIn("KeyboardInterrupt", errors)
            self.assertLess(time.monotonic() - start, 8, kind)


class Dealing(unittest.TestCase):
    UNITS = [(tile, 0, 64, 64) for tile in range(100)]

    def test_sizes_shrink_and_all_units_are_dealt_once(self):
        dealer = dealing.Dealer([self.UNITS], 2)
        sizes, seen = [], []
        while (task := dealer.next()) is not None:
            seen += task.units
            sizes.append(len(task.units))
            dealer.done(task, 2.0 * len(task.units))
        self.assertEqual(sorted(seen), [unit[:3] for unit in self.UNITS])
        self.assertEqual(sizes[0], 1)
        self.assertEqual(sizes[1], 12)
        self.assertEqual(sizes[1:], sorted(sizes[1:], reverse=True))
        self.assertFalse(dealer.has_more or dealer.in_flight)

    def test_tasks_are_neither_short_nor_long(self):
        for seconds, expected in ((0.01, 50), (0.001, 99), (30, 1), (1000, 1)):
            dealer = dealing.Dealer([self.UNITS], 1)
            dealer.done(dealer.next(), seconds)
            self.assertEqual(len(dealer.next().units), expected, seconds)

    def test_first_tasks_are_small_whatever_the_samples(self):
        units = [(tile, 8, 100_000, 256 * 99_992) for tile in range(3)]
        dealer = dealing.Dealer([units], 2, block=16)
        first, second = dealer.next(), dealer.next()
        self.assertEqual(first.units, [(0, 8, 1024)])
        self.assertEqual(second.units, [(0, 1024, 2048)])
        self.assertEqual(second.cost, 1 << 18)
        dealer.done(first, 1.0)
        dealer.done(second, 1.0)
        while (task := dealer.next()) is not None:
            self.assertLessEqual(task.cost, 31 << 18, "thirty seconds")
            dealer.done(task, task.cost / (1 << 18))
            if task.units[-1][2] == 100_000:
                continue
            self.assertEqual(task.units[-1][2] % 16, 0)
        self.assertAlmostEqual(dealer._remaining, 0)

    def test_rounds_follow_each_other(self):
        self.assertEqual(dealing.rounds_of(100, True), [(0, 16), (16, 64), (64, 100)])
        self.assertEqual(dealing.rounds_of(100, False), [(0, 100)])
        self.assertEqual(dealing.rounds_of(10, True), [(0, 10)])
        dealer = dealing.Dealer([[(0, 0, 16, 1), (1, 0, 16, 1)], [], [(0, 16, 64, 3), (1, 16, 64, 3)]], 1)
        dealt = [dealer.next() for _ in range(4)]
        self.assertEqual([unit for task in dealt for unit in task.units][2], (0, 16, 64))

    def test_old_tasks_are_copied_once(self):
        dealer = dealing.Dealer([self.UNITS[:2]], 2)
        old, new = dealer.next(), dealer.next()
        self.assertIsNone(dealer.copy())
        old.started -= 60
        self.assertIs(dealer.copy(), old)
        self.assertIsNone(dealer.copy())
        dealer.done(old, 1.0)
        self.assertTrue(dealer.lost(old, "a", OSError()))
        dealer.done(new, 1.0)
        self.assertFalse(dealer.in_flight or dealer.has_more)

    def test_a_task_may_be_lost_twice(self):
        dealer = dealing.Dealer([self.UNITS[:1]], 3)
        for number in range(3):
            task = dealer.next()
            self.assertEqual(dealer.lost(task, f"worker {number}", OSError("gone")), number < 2)
        self.assertEqual(str(task), "task 1 (tile 0, samples 0 to 64)")


class Commands(unittest.TestCase):
    def test_scripts_name_scene_shards_and_settings(self):
        script = cluster.commands("my scene.json", shards=40, samples=64, size=(320, 180), aovs=["depth"])
        self.assertIn(
            "render 'my scene.json' --aov=depth --samples=64 --size=320x180 --shard auto/40", script
        )
        self.assertIn("#SBATCH --array=0-39", script)
        self.assertIn("juggler merge 'my scene'-{0..39}.jfilm -o 'my scene.png'", script)
        for system in ("hyperqueue", "ssh"):
            self.assertIn("scene.json", cluster.commands("scene.json", system=system))

    def test_wrong_arguments_are_refused(self):
        for arguments in (
            {"system": "lsf"},
            {"shards": 0},
            {"time": 3},
            {"threads": 3},
            {"sampels": 3},
            {"sampler": "sobol"},
        ):
            with self.assertRaises(jg.SettingsError, msg=arguments):
                cluster.commands("scene.json", **arguments)
        with self.assertRaises(jg.SettingsError):
            cluster.commands(small_scene())


class Imports(unittest.TestCase):
    def test_ray_is_loaded_by_its_class_alone(self):
        code = (
            "import sys, juggler\nassert 'juggler.cluster' not in sys.modules\nimport juggler.cluster as c\n"
        )
        code += "c.Ray()\nassert 'ray' not in sys.modules and 'numpy' not in sys.modules"
        self.assertEqual(python(code).stderr, "")

    def test_without_ray_the_error_names_the_package(self):
        with unittest.mock.patch.dict("sys.modules", {"ray": None}):
            with self.assertRaisesRegex(ImportError, r"pip install 'juggler\[ray\]'"):
                with cluster.Ray():
                    pass
        with self.assertRaises(RuntimeError):
            cluster.Ray().render("juggler")
        self.assertIsInstance(cluster, types.ModuleType)


if __name__ == "__main__":
    unittest.main()
