"""Renders on the machines of a cluster, with the bits of one machine.

    import concurrent.futures, juggler.cluster
    with concurrent.futures.ProcessPoolExecutor(4) as executor:
        juggler.cluster.render("juggler", executor, samples=256).save("juggler.png")

Any executor with a method `submit` has workers: processes, a client of Dask, and others. `Ray` finds the
machines of a Ray cluster and goes on without those that are lost. `commands` writes a script for a
batch system, whose machines run the program.
"""

from juggler._cluster.driver import ClusterProgress, Driver, Job
from juggler._cluster.errors import ClusterError, WorkerLost

__all__ = ["ClusterError", "ClusterProgress", "Ray", "WorkerLost", "commands", "frames", "render"]


def render(
    scene, executor, workers=None, *, checkpoint=None, checkpoint_every=60.0, preview=False, **settings
):
    """Renders a scene on the workers of an executor and returns the `Image`, which equals that of
    `juggler.render` to the bit.

    `executor` has a method `submit(function, *arguments)` that returns a future: an executor of
    `concurrent.futures`, a `distributed.Client` of Dask, or another one. `workers` is the number of tasks
    that it runs at a time, where the executor does not state it.

    `checkpoint` is a `.jfilm` file that is saved every `checkpoint_every` seconds and at the end; the same
    call, or the program with `--checkpoint`, goes on with it. `preview=True` renders all pixels with few
    samples first. The other arguments are those of `juggler.render`, except `time`.
    """
    from juggler._cluster.executor import ExecutorPool

    job = Job(scene, settings, checkpoint, checkpoint_every, preview)
    return Driver(ExecutorPool(executor, workers), job).run()


def frames(scene, frames, executor, workers=None, **settings):
    """Renders frames of an animation on the workers of an executor, and yields each `Image` in order. The
    arguments are those of `render`.
    """
    from juggler._arguments import numbers_of_frames
    from juggler._cluster.animation import images
    from juggler._cluster.executor import ExecutorPool

    frames = numbers_of_frames(frames, settings)
    return images(ExecutorPool(executor, workers), Job(scene, settings), frames)


def commands(scene, shards=16, system="slurm", output=None, **settings):
    """Returns a script that renders a scene file in `shards` jobs of a batch system with the program, and
    merges them to the file `output`: for the system "slurm", "hyperqueue" or "ssh".
    """
    from juggler._cluster.commands import script

    return script(scene, shards, system, output, settings)


def __getattr__(name):
    if name == "Ray":
        from juggler._cluster.ray import Ray

        return Ray
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


for _value in (render, frames, commands, ClusterProgress):
    _value.__module__ = "juggler.cluster"
del _value
