"""Mark of a job that goes on: a file of the driver's machine.

The driver removes it at the end, also after Ctrl-C and errors. Workers on the same machine then end the
tasks that they have begun, which no executor does by itself. Workers on other machines finish them.
"""

import os
import socket


class Ended(Exception):
    """The job has ended."""


class Mark:
    """Mark of one job. Without a folder for temporary files, workers finish the tasks that they began."""

    def __init__(self):
        import tempfile

        try:
            handle, self._path = tempfile.mkstemp(prefix="juggler-", suffix=".job")
            os.close(handle)
        except OSError:
            self._path = None

    @property
    def place(self):
        """Machine and path; `None` if there is no mark."""
        return None if self._path is None else (socket.gethostname(), self._path)

    def remove(self):
        """Ends the job."""
        if self._path is not None:
            try:
                os.remove(self._path)
            except OSError:
                pass


def watch(place):
    """Returns a function that the renderer calls with its progress, and that raises `Ended` once the
    mark at this place is gone; `None` for marks of other machines. Raises `Ended` if it is gone now.
    """
    if place is None or place[0] != socket.gethostname():
        return None

    def check(*progress):
        if not os.path.exists(place[1]):
            raise Ended

    check()
    return check
