"""Workers on the nodes of a Ray cluster: one actor on each.

Ray repeats nothing by itself: it would repeat work on a node that is about to be lost, and hide what
happened. The driver knows what the film lacks, and deals the work of lost nodes to others.
"""

import time

from juggler._cluster.driver import Driver, Job
from juggler._cluster.errors import ClusterError, WorkerLost
from juggler._cluster.worker import version, work
from juggler._errors import SettingsError

# Tasks that wait for or run on a worker.
_IN_FLIGHT = 2
# Seconds between looks at the nodes.
_CHECK_INTERVAL = 1.0
# Seconds for which a node that lost its worker must be seen alive before it gets another one.
_TRIAL_SECONDS = 10.0


class RemoteWorker:
    """Worker of one node."""

    def __init__(self):
        self._blobs = {}

    def greet(self):
        """Returns the version, and the name of the worker."""
        from juggler._cluster.worker import identity

        return version(), identity()

    def work(self, job, package, units):
        """Renders units of work. The contents of a package are references to Ray's objects, which are
        fetched if the world of the scene is not known.
        """
        import ray

        manifest, references = package

        def blobs():
            return dict(zip(references, ray.get(list(references.values()))))

        return work(job, (manifest, blobs), units)


class _Node:
    """Node of the cluster, with its worker if it has one."""

    def __init__(self, number, cpus):
        self.id = number
        self.cpus = cpus
        self.actor = None
        self.name = f"node {number[:8]}"
        self.greeting = None
        self.is_ready = False
        self.tasks = 0
        self.is_alive = True
        # Time since when the node has been seen alive after it lost its worker.
        self.trial = None

    def lose(self):
        """Notes that the worker was lost."""
        self.actor = self.greeting = None
        self.is_ready = False
        self.tasks = 0
        self.trial = time.monotonic()


class RayPool:
    """Workers on all nodes. `threads` is `None` since each has the cores of its node."""

    threads = None

    def __init__(self, ray, threads=None):
        self._ray = ray
        self._threads = threads
        self._nodes = {}
        self._pending = {}
        self._package = None
        self._job = None
        self._checked = None
        self.check()

    def count(self):
        """Number of workers, including those that start."""
        return sum(node.actor is not None for node in self._nodes.values())

    def idle(self):
        """Number of workers without a task."""
        return sum(node.is_ready and node.tasks == 0 for node in self._nodes.values())

    def is_free(self):
        """Whether a worker takes another task."""
        return any(node.is_ready and node.tasks < _IN_FLIGHT for node in self._nodes.values())

    def prepare(self, job):
        """Puts the package into Ray's object store, once for all nodes, and lets workers build their
        worlds while the driver builds its own.
        """
        references = {digest: self._ray.put(data) for digest, data in job.package.blobs.items()}
        self._package = (job.package.manifest, references)
        self._job = job.description()
        self.check()
        for node in self._nodes.values():
            if node.is_ready:
                self._submit(node, self._job, None)

    def start(self, job, task):
        """Gives a task to the worker with the fewest tasks. A copy goes to a worker that does not have
        the task.
        """
        has_it = {node.id for node, _, other in self._pending.values() if other is task}
        free = [node for node in self._nodes.values() if node.is_ready and node.tasks < _IN_FLIGHT]
        node = min(free, key=lambda node: (node.id in has_it, node.tasks))
        self._submit(node, job, task)

    def _submit(self, node, job, task):
        threads = job["settings"].get("threads") or self._threads or max(1, int(node.cpus))
        job = {**job, "settings": {**job["settings"], "threads": threads}}
        reference = node.actor.work.remote(job, self._package, [] if task is None else task.units)
        self._pending[reference] = (node, node.actor, task)
        node.tasks += task is not None

    def answers(self, seconds):
        """Returns tasks with their answers, or with exceptions if a worker was lost."""
        references = list(self._pending)
        references += [node.greeting for node in self._nodes.values() if node.greeting is not None]
        if not references:
            time.sleep(seconds)
            return []
        done, _ = self._ray.wait(references, num_returns=len(references), timeout=0)
        if not done:
            done, _ = self._ray.wait(references, num_returns=1, timeout=seconds)
        return [found for reference in done if (found := self._take(reference)) is not None]

    def _take(self, reference):
        if reference not in self._pending:
            self._take_greeting(reference)
            return None
        node, actor, task = self._pending.pop(reference)
        try:
            answer = self._ray.get(reference)
        except Exception as error:
            if node.actor is actor:
                self._lose(node)
            return task, error
        if node.actor is actor and task is not None:
            node.tasks -= 1
        return task, answer

    def _take_greeting(self, reference):
        node = next((node for node in self._nodes.values() if node.greeting == reference), None)
        if node is None:
            return
        try:
            found, name = self._ray.get(reference)
        except Exception:
            self._lose(node)
            return
        if found != version():
            raise ClusterError(f"the worker {name} cannot help: it has Juggler {found}, not {version()}")
        node.name, node.greeting, node.is_ready = name, None, True
        if self._job is not None:
            self._submit(node, self._job, None)

    def _lose(self, node):
        actor = node.actor
        node.lose()
        if actor is not None:
            try:
                self._ray.kill(actor)
            except Exception:
                pass

    def check(self):
        """Looks for nodes that came and went, and gives each a worker."""
        now = time.monotonic()
        if self._checked is not None and now - self._checked < _CHECK_INTERVAL:
            return
        self._checked = now
        alive = {}
        for node in self._ray.nodes():
            cpus = node.get("Resources", {}).get("CPU", 0)
            if node["Alive"] and cpus >= 1:
                alive[node["NodeID"]] = cpus
        for number, cpus in alive.items():
            if number not in self._nodes:
                self._nodes[number] = _Node(number, cpus)
        for node in self._nodes.values():
            self._check_node(node, node.id in alive, now)

    def _check_node(self, node, is_alive, now):
        if not is_alive:
            if node.actor is not None:
                self._lose(node)
            node.trial = now
            return
        is_tried = node.trial is None or now - node.trial >= _TRIAL_SECONDS
        if node.actor is None and is_tried:
            node.actor = self._new_actor(node)
            node.greeting = node.actor.greet.remote()

    def _new_actor(self, node):
        from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

        place = NodeAffinitySchedulingStrategy(node_id=node.id, soft=False)
        actor = self._ray.remote(RemoteWorker)
        return actor.options(
            num_cpus=node.cpus,
            max_restarts=0,
            max_task_retries=0,
            scheduling_strategy=place,
        ).remote()

    def stop(self):
        """Forgets all work. Workers finish what they have begun."""
        for reference in self._pending:
            try:
                self._ray.cancel(reference)
            except Exception:
                pass
        self._pending = {}
        self._package = self._job = None
        for node in self._nodes.values():
            node.tasks = 0

    def close(self):
        """Ends all workers."""
        self.stop()
        for node in self._nodes.values():
            self._lose(node)


class Ray:
    """Ray cluster whose nodes render, as a context.

        with juggler.cluster.Ray(address="auto") as farm:
            farm.render("scene.json", samples=4096).save("scene.png")

    `address` is that of the cluster, "auto" for the one that this machine belongs to, "local" for a new
    one on this machine alone. `max_nodes` asks an autoscaler for that many nodes. `threads` is the number
    of threads of a worker, by default that of its node's cores. Nodes that come later render, too, and
    the work of lost ones is done by others.
    """

    def __init__(self, address="auto", max_nodes=None, threads=None):
        if max_nodes is not None and max_nodes < 1:
            raise SettingsError(f"`max_nodes` must be at least 1, not {max_nodes}")
        self._address = address
        self._max_nodes = max_nodes
        self._threads = threads
        self._is_own = False
        self._pool = None

    def __enter__(self):
        try:
            import ray
        except ImportError:
            raise ImportError("the class Ray needs the package ray: pip install 'juggler[ray]'") from None
        if not ray.is_initialized():
            ray.init(address=self._address, log_to_driver=False)
            self._is_own = True
        self._ray = ray
        self._pool = RayPool(ray, self._threads)
        if self._max_nodes is not None:
            self._request(self._max_nodes)
        return self

    def __exit__(self, *error):
        if self._pool is not None:
            self._pool.close()
            self._pool = None
        if self._max_nodes is not None:
            self._request(0)
        if self._is_own:
            self._ray.shutdown()
            self._is_own = False

    def _request(self, count):
        """Asks the autoscaler for nodes as large as the largest one."""
        from ray.autoscaler.sdk import request_resources

        cpus = max((node.cpus for node in self._pool._nodes.values()), default=1) if self._pool else 1
        request_resources(bundles=[{"CPU": int(cpus)}] * count)

    def render(self, scene, *, checkpoint=None, checkpoint_every=60.0, preview=False, **settings):
        """Renders a scene and returns the `Image`, which equals that of `juggler.render` to the bit. The
        arguments are those of `juggler.cluster.render`.
        """
        pool = self._open_pool()
        return Driver(pool, Job(scene, settings, checkpoint, checkpoint_every, preview)).run()

    def frames(self, scene, frames, **settings):
        """Renders frames of an animation, and yields each `Image` in order."""
        from juggler._arguments import numbers_of_frames
        from juggler._cluster.animation import images

        frames = numbers_of_frames(frames, settings)
        return images(self._open_pool(), Job(scene, settings), frames)

    def render_movie(self, scene, path, frames=None, **settings):
        """Renders frames of an animation as a movie, whose format the ending of `path` selects. `frames`
        is a range, or a list of consecutive frames; all frames by default. An interrupted movie goes on when
        the same call is repeated.
        """
        from juggler._cluster.animation import render_movie

        # Dithering would make still areas flicker.
        job = Job(scene, {**settings, "dither": False})
        render_movie(self._open_pool(), job, path, frames)

    def _open_pool(self):
        if self._pool is None:
            raise RuntimeError("the workers of a Ray cluster are there in a context: with Ray() as farm:")
        return self._pool


Ray.__module__ = "juggler.cluster"
