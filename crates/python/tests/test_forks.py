"""Processes fork and render in any order, without a hang.

JUGGLER_FORKS is the number of random steps, 50 by default.
"""

import functools
import os
import random
import threading
import time
import unittest

import juggler as jg
from support import small_scene

COUNT = int(os.environ.get("JUGGLER_FORKS", "50"))
# Seconds after which a process counts as hanging.
PATIENCE = 60


def child(work):
    """Runs `work` in a forked process; returns its process id. The status is 0 if it returns true."""
    process = os.fork()
    if process == 0:
        status = 2
        try:
            status = 0 if work() else 1
        finally:
            os._exit(status)
    return process


def status_of(process):
    """Status of a process, which is killed if it hangs."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found, status = os.waitpid(process, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.002)
    os.kill(process, 9)
    os.waitpid(process, 0)
    return "a hang"


@unittest.skipUnless(hasattr(os, "fork"), "the system has no fork")
class Forks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.renderer = jg.Renderer(small_scene(), samples=2)
        cls.hash = cls.renderer.render().hash

    def is_right(self, threads=None):
        more = {} if threads is None else {"threads": threads}
        return jg.render(small_scene(), samples=2, **more).hash == self.hash

    def is_kept_right(self):
        return self.renderer.render().hash == self.hash

    def has_right_child(self):
        return self.is_right() and status_of(child(self.is_right)) == 0

    def beside_a_render(self, work):
        """Forks while other threads render and edit; a lock that is held then stays so in the child."""
        busy = jg.Renderer(small_scene(), samples=64)
        is_over = threading.Event()

        def edit():
            while not is_over.is_set():
                busy["materials.gold.conductor.roughness"] = 0.2
                busy.render()

        threads = [threading.Thread(target=edit) for _ in range(2)]
        for thread in threads:
            thread.start()
        try:
            return [status_of(child(work)) for _ in range(3)]
        finally:
            is_over.set()
            for thread in threads:
                thread.join()

    def test_forks_and_renders_in_any_order(self):
        rng = random.Random(1)
        for step in range(COUNT):
            threads = rng.choice([None, 1, 2, 3])
            way = rng.randrange(6)
            with self.subTest(step=step, way=way, threads=threads):
                if way == 0:
                    self.assertTrue(self.is_right(threads))
                elif way == 1:
                    self.assertEqual(status_of(child(functools.partial(self.is_right, threads))), 0)
                elif way == 2:
                    self.assertEqual(status_of(child(self.is_kept_right)), 0)
                elif way == 3:
                    self.assertEqual(status_of(child(self.has_right_child)), 0)
                elif way == 4:
                    several = [child(self.is_right) for _ in range(4)]
                    self.assertEqual([status_of(process) for process in several], [0] * 4)
                else:
                    self.assertEqual(self.beside_a_render(functools.partial(self.is_right, threads)), [0] * 3)


if __name__ == "__main__":
    unittest.main()
