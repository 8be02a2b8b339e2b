"""Renders on other threads."""

import threading
from concurrent.futures import Future

from juggler import _native
from juggler._image import Image


class RenderFuture(Future):
    """Result of a render on another thread. Until it is there, `cancel` ends the render."""

    def __init__(self):
        super().__init__()
        self._canceler = _native.Canceler()
        self._thread = None

    def cancel(self):
        """Ends the render. Returns whether it was not done yet."""
        is_cancelled = super().cancel()
        if is_cancelled:
            self._canceler.cancel()
        return is_cancelled

    def running(self):
        """Whether the render goes on."""
        return not self.done()


def submit(renderer, color_maps=()):
    """Starts a render of a native renderer, whose images have these color maps."""
    future = RenderFuture()

    def work():
        try:
            image, error = Image(renderer.render(None, future._canceler), color_maps), None
        except BaseException as caught:
            image, error = None, caught
        # The future waits in the state "pending", in which it can be cancelled.
        if future.set_running_or_notify_cancel():
            if error is None:
                future.set_result(image)
            else:
                future.set_exception(error)

    future._thread = threading.Thread(target=work, name="juggler-render", daemon=True)
    future._thread.start()
    return future
