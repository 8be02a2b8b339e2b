"""Exceptions of renders on several workers."""


class ClusterError(RuntimeError):
    """A render cannot go on: work was lost on three workers, or a worker does not fit."""


class WorkerLost(Exception):
    """A worker was lost with its work, which goes to other workers. Executors may raise it; every
    exception of a future counts as one.
    """


for _class in (ClusterError, WorkerLost):
    _class.__module__ = "juggler.cluster"
del _class
