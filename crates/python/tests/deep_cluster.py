"""Renders over Ray, Dask and processes, with nodes, workers and drivers that are killed.

Needs `ray` and `distributed`, and takes some minutes:

    PYTHONPATH=FOLDER python crates/python/tests/deep_cluster.py           # tests
    PYTHONPATH=FOLDER python crates/python/tests/deep_cluster.py --table   # times of 1 and 2 nodes

FOLDER holds the package, see `stage.sh`. JUGGLER_SAMPLES changes the length of the renders.
"""

import concurrent.futures
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import juggler as jg
from juggler import cluster
from juggler._cluster.dealer import Dealer
from support import PROGRAM, Folder, needs_program, program_hash

SAMPLES = int(os.environ.get("JUGGLER_SAMPLES", "1024"))
SETTINGS = {"size": (320, 180), "samples": SAMPLES}
FLAGS = ("--size", "320x180", "--samples", str(SAMPLES))
# Seconds until the work of a lost worker is dealt again.
RECOVERY = 15.0

DRIVER = """
import sys, juggler.cluster
with juggler.cluster.Ray(address=sys.argv[1]) as farm:
    image = farm.render("juggler", size=(320, 180), samples=int(sys.argv[3]), checkpoint=sys.argv[2],
        checkpoint_every=0.5)
print(image.hash)
"""


def expected_hash():
    """Hash of the program's render, if the program is built, which is that of the package."""
    found = jg.render("juggler", **SETTINGS).hash
    if os.path.exists(PROGRAM):
        assert found == program_hash("juggler", *FLAGS)
    return found


def temporary_folder():
    """Folder for the files of Ray, which reads the variable when it is imported."""
    folder = os.environ["RAY_TMPDIR"] = tempfile.mkdtemp(prefix="jray")
    return folder


class Losses:
    """Records the tasks that a render lost, and when."""

    def __init__(self):
        self.times = []

    def __enter__(self):
        original = Dealer.lost

        def lost(dealer, task, worker, error):
            self.times.append(time.monotonic())
            return original(dealer, task, worker, error)

        self._patch = unittest.mock.patch.object(Dealer, "lost", lost)
        self._patch.__enter__()
        return self

    def __exit__(self, *error):
        self._patch.__exit__(*error)


class Once:
    """Progress function that does something once, at a share of the render."""

    def __init__(self, action, share=0.25):
        self._action, self._share = action, share
        self.time = None

    def __call__(self, progress):
        if self.time is None and progress.share >= self._share:
            self.time = time.monotonic()
            self._action()


class OverRay(Folder):
    """A head and two nodes on this machine, each with one core."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = temporary_folder()
        import ray
        from ray.cluster_utils import Cluster

        cls.ray = ray
        cls.node_arguments = {"num_cpus": 1, "object_store_memory": 80 * 1024 * 1024}
        cls.cluster = Cluster(
            initialize_head=True,
            head_node_args={**cls.node_arguments, "include_dashboard": False},
        )
        cls.nodes = [cls.cluster.add_node(**cls.node_arguments) for _ in range(2)]
        cls.cluster.wait_for_nodes()
        ray.init(address=cls.cluster.address, log_to_driver=False)
        cls.expected = expected_hash()

    @classmethod
    def tearDownClass(cls):
        cls.ray.shutdown()
        cls.cluster.shutdown()
        shutil.rmtree(cls.temporary, ignore_errors=True)

    def farm(self):
        """The workers of all nodes, once they are there."""
        farm = self.enterContext(cluster.Ray(address=self.cluster.address))
        pool, end = farm._pool, time.monotonic() + 120
        while sum(node.is_ready for node in pool._nodes.values()) < len(self.nodes) + 1:
            self.assertLess(time.monotonic(), end, "the workers did not start")
            pool.check()
            pool.answers(0.2)
        return farm

    def render(self, farm, action=None, share=0.25, **settings):
        once = Once(action or (lambda: None), share)
        with Losses() as losses:
            image = farm.render("juggler", **SETTINGS, progress=once, **settings)
        self.assertEqual(image.hash, self.expected)
        self.assertIsNotNone(once.time, "the render was too short for the test")
        self.assertLessEqual(len(losses.times), 2, "more than the tasks in flight were lost")
        for lost in losses.times:
            self.assertLessEqual(lost - once.time, RECOVERY)
        return once, losses

    def process_of(self, farm, number):
        """Process of a worker."""
        nodes = [node for node in farm._pool._nodes.values() if node.is_ready]
        return int(nodes[number].name.rpartition(" ")[2])

    def test_1_images_equal_those_of_the_program(self):
        farm = self.farm()
        _, losses = self.render(farm)
        self.assertEqual(losses.times, [])
        aovs = {"size": (160, 90), "samples": 32, "aovs": ["albedo", "normal", "depth"], "denoise": True}
        self.assertEqual(farm.render("juggler", **aovs), jg.render("juggler", **aovs))
        noise = {"size": (160, 90), "noise": 0.1, "samples": 1024}
        self.assertEqual(farm.render("cornell-box", **noise).hash, jg.render("cornell-box", **noise).hash)

    def test_2_frames_and_movies(self):
        farm = self.farm()
        settings = {"size": (64, 36), "samples": 4}
        for count in (2, 7):
            expected = [image.hash for image in jg.frames("chess-opening", range(count), **settings)]
            self.assertEqual(
                [image.hash for image in farm.frames("chess-opening", range(count), **settings)], expected
            )
        movie, other = self.folder / "a.gif", self.folder / "b.gif"
        farm.render_movie("chess-opening", movie, range(5), **settings)
        jg.render_movie("chess-opening", other, range(5), **settings)
        self.assertEqual(movie.read_bytes(), other.read_bytes())
        self.assertFalse(os.path.exists(f"{movie}.frames"))

    def test_3_a_killed_worker(self):
        farm = self.farm()
        self.render(farm, lambda: os.kill(self.process_of(farm, 0), signal.SIGKILL))

    def test_4_a_slow_node(self):
        farm = self.farm()
        process = self.process_of(farm, 1)
        try:
            self.render(farm, lambda: os.kill(process, signal.SIGSTOP))
        finally:
            os.kill(process, signal.SIGCONT)

    def test_5_a_killed_node_and_a_new_one(self):
        farm = self.farm()

        added = threading.Thread(
            target=lambda: self.nodes.append(self.cluster.add_node(**self.node_arguments))
        )

        def exchange():
            self.cluster.remove_node(self.nodes.pop(0), allow_graceful=False)
            added.start()

        self.render(farm, exchange)
        added.join()
        self.assertGreaterEqual(farm._pool.count(), 2)

    def test_6_a_killed_driver(self):
        checkpoint = self.folder / "job.jfilm"
        words = [sys.executable, "-c", DRIVER, self.cluster.address, str(checkpoint), str(SAMPLES)]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        driver = subprocess.Popen(words, env=environment, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 300
        while not checkpoint.exists() or not self.samples_of(checkpoint):
            self.assertIsNone(driver.poll(), "the driver ended before the test could kill it")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.2)
        driver.kill()
        driver.wait()
        kept = self.samples_of(checkpoint)
        self.assertGreater(kept, 0)
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout.strip(), self.expected, done.stderr)

    def samples_of(self, checkpoint):
        """Number of bytes of the samples of a checkpoint; 0 if there are none."""
        try:
            part = jg.PartialRender.open(checkpoint)
        except jg.FileError:
            return 0
        return max(0, len(part) - 4000)


class OverDask(unittest.TestCase):
    def test_workers_of_dask(self):
        from distributed import Client, LocalCluster

        expected = expected_hash()
        workers = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
        with LocalCluster(**workers) as local, Client(local) as client:
            self.assertEqual(cluster.render("juggler", client, **SETTINGS).hash, expected)
            large = unittest.mock.patch("juggler._cluster.executor._SMALL_PACKAGE", 10)
            with large:
                self.assertEqual(cluster.render("juggler", client, **SETTINGS).hash, expected)

    def test_a_killed_worker_of_dask(self):
        from distributed import Client, LocalCluster

        expected = expected_hash()
        workers = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
        with LocalCluster(**workers) as local, Client(local) as client:
            process = next(iter(client.run(os.getpid).values()))
            once = Once(lambda: os.kill(process, signal.SIGKILL))
            self.assertEqual(cluster.render("juggler", client, progress=once, **SETTINGS).hash, expected)


class OverProcesses(unittest.TestCase):
    def test_all_start_methods(self):
        expected = expected_hash()
        for method in ("fork", "spawn", "forkserver"):
            context = multiprocessing.get_context(method)
            with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
                self.assertEqual(cluster.render("juggler", pool, **SETTINGS).hash, expected, method)

    @needs_program
    def test_the_program_agrees(self):
        expected_hash()


def cpu_seconds(process):
    """CPU seconds of a process so far."""
    with open(f"/proc/{process}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def table():
    """Prints the times of one process, and of 1 and 2 nodes."""
    temporary = temporary_folder()
    import ray
    from ray.cluster_utils import Cluster

    cpu, start = time.process_time(), time.monotonic()
    expected = jg.render("juggler", **SETTINGS, threads=1).hash
    print(f"one process: {time.monotonic() - start:.1f} s, {time.process_time() - cpu:.1f} s of CPU")
    arguments = {"num_cpus": 1, "object_store_memory": 80 * 1024 * 1024}
    local = Cluster(
        initialize_head=True, head_node_args={**arguments, "num_cpus": 0, "include_dashboard": False}
    )
    try:
        for nodes in (1, 2):
            local.add_node(**arguments)
            local.wait_for_nodes()
            ray.init(address=local.address, log_to_driver=False)
            with cluster.Ray(address=local.address) as farm:
                for _ in range(4):
                    measure(farm, nodes, expected)
            ray.shutdown()
    finally:
        local.shutdown()
        shutil.rmtree(temporary, ignore_errors=True)


def measure(farm, count, expected):
    """Prints the times of a render on workers that are ready."""
    pool = farm._pool
    while sum(node.is_ready for node in pool._nodes.values()) < count:
        pool.check()
        pool.answers(0.1)
    workers = [int(node.name.rpartition(" ")[2]) for node in pool._nodes.values() if node.is_ready]
    before, start = [cpu_seconds(process) for process in workers], time.monotonic()
    driver = time.process_time()
    assert farm.render("juggler", **SETTINGS).hash == expected
    seconds, driver = time.monotonic() - start, time.process_time() - driver
    after = [cpu_seconds(process) - spent for process, spent in zip(workers, before)]
    shares = " + ".join(f"{own:.1f}" for own in after)
    print(f"{count} nodes: {seconds:.1f} s; CPU of workers {shares} s, of the driver {driver:.1f} s")


if __name__ == "__main__":
    if "--table" in sys.argv:
        table()
    else:
        unittest.main(verbosity=2)
