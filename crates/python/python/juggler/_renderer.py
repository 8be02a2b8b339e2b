"""Renderer of a scene that is edited and rendered again."""

from contextlib import contextmanager

from juggler import _native
from juggler._arguments import seconds, source, whole
from juggler._errors import SettingsError
from juggler._image import Image
from juggler._progress import checked
from juggler._scene import bytes_of, native_scene, to_json, warn
from juggler._trace import Explained


class Renderer:
    """Scene whose world is built once and kept, so that edits and further renders are fast.

        r = juggler.Renderer("juggler", samples=64)
        r["materials.chrome.conductor.roughness"] = 0.1
        r.render().save("juggler.png")

    The settings are those of `juggler.render`. An edited scene has the same pixels, to the bit, as
    one that was so from the start. Several threads may use one renderer: an edit changes the renders
    that begin after it.
    """

    __slots__ = ("__weakref__", "_color_maps", "_native", "_progress", "_settings")

    def __init__(self, scene, **settings):
        scene = source(scene)
        self._progress = checked(settings.pop("progress", None))
        if "max_memory" in settings:
            settings["max_memory"] = bytes_of(settings["max_memory"])
        if getattr(scene, "_lenient", False):
            settings["lenient"] = True
        camera = settings.get("camera")
        own_camera = camera is not None and not isinstance(camera, str)
        if own_camera:
            del settings["camera"]
        _native.check_settings(settings)
        if settings.get("frame") is not None and settings.get("at") is not None:
            raise SettingsError("`frame` and `at` (seconds) both select the frame; give one of them", "at")
        native = native_scene(scene, bool(settings.get("lenient")))
        with Explained(scene):
            self._native = _native.Renderer(native, settings)
        self._settings = settings
        self._color_maps = _color_maps(scene)
        if settings.get("integrator") == "albedo":
            _warn_of_unlit(scene)
        if own_camera:
            self.camera = camera

    def __repr__(self):
        settings = "".join(f", {name}={value!r}" for name, value in self._settings.items())
        return f"Renderer({self._native.scene().name!r}{settings})"

    def __reduce__(self):
        scene = self._native.scene()
        of_models = ("variant", "animation", "model_scene")
        settings = {name: value for name, value in self._settings.items() if name not in of_models}
        state = (scene.to_json_at_name(), scene.name, settings, self.frame, scene.assets(), self._color_maps)
        return _restore, state

    def __getitem__(self, path):
        """Value at a path, as messages print it, or at a JSON pointer."""
        import json

        with _plain_key_errors(path):
            return json.loads(self._native.value(path))

    def __setitem__(self, path, value):
        from juggler._edits import set_value

        with _plain_key_errors(path):
            set_value(self._native, path, value)

    def __delitem__(self, path):
        self[path] = None

    def __contains__(self, path):
        try:
            self._native.value(path)
        except KeyError:
            return False
        return True

    @property
    def camera(self):
        """Camera of the image. It has the method `replace(eye=...)`, and can be set."""
        import json

        from juggler._camera import camera_of

        return camera_of(json.loads(self._native.camera()))

    @camera.setter
    def camera(self, camera):
        path = self._native.camera_path()
        if camera is not None or path in self:
            self._native.set_value(path, *to_json(camera, path))

    @property
    def frame(self):
        """Frame of the animation, which may lie between two, and can be set."""
        frame = self._native.frame()
        return int(frame) if frame.is_integer() else frame

    @frame.setter
    def frame(self, frame):
        self._native.set_frame(frame)

    @property
    def changed(self):
        """Kinds of changes between the last two renders, such as "material" and "camera"."""
        return set(self._native.changed())

    @property
    def fingerprint(self):
        """Fingerprint of everything that determines the pixels."""
        return self._native.fingerprint()

    def check(self):
        """Raises a `SceneError` with all mistakes of the scene, and warns of the rest."""
        warn(self._native.scene().check())

    def to_dict(self):
        """Returns the scene with all edits, in the scene format. Arrays of meshes and instances are
        lists."""
        from juggler._scene import to_dict

        return to_dict(self._native.scene())

    def models(self):
        """Returns a description of each model of the scene, as `juggler.models` does."""
        import json

        return json.loads(self._native.scene().models())

    def render(self, progress=None):
        """Renders the image."""
        from juggler._progress import display

        progress = self._progress if progress is None else progress
        with display(progress) as shown:
            if shown.is_live:
                return self._warned(shown.follow(self.progressive(every=0.25)))
            image = self._image(self._native.render(shown.callback))
            shown.finish(image)
        return self._warned(image)

    def progressive(self, every=0.5):
        """Renders better and better images: yields one each `every` seconds, at last the one that
        `render` returns. A loop that is left ends the render.
        """
        return self._steps(seconds("every", every))

    def _steps(self, every):
        steps = self._native.progressive(every)
        try:
            for image in steps:
                image = self._image(image)
                if steps.is_done():
                    self._native.keep(steps)
                    self._warned(image)
                yield image
        finally:
            steps.cancel()

    def submit(self):
        """Starts the render on another thread, and returns a `concurrent.futures.Future`, whose
        method `cancel` ends the render.
        """
        from juggler._future import submit

        return submit(self._native, self._color_maps)

    async def render_async(self):
        """Renders the image while other tasks of `asyncio` run; the task can be cancelled."""
        import asyncio

        return await asyncio.wrap_future(self.submit())

    def render_shard(self, index, count, progress=None):
        """Renders one of `count` shards of the image, for `juggler.merge`."""
        from juggler._partial_render import PartialRender
        from juggler._progress import display

        count, index = whole("count", count, 1), whole("index", index, 0)
        with display(self._progress if progress is None else progress, live=False) as shown:
            shard = self._native.render_shard(index, count, shown.callback)
            shown.finish()
        return self._warned(PartialRender(shard.bytes()))

    def extend(self, partial_render, samples=None, progress=None):
        """Continues a partial render, which may be a file, up to `samples` samples per pixel, and
        returns the image.
        """
        from juggler._partial_render import native
        from juggler._progress import display

        renderer = self
        if samples is not None:
            renderer = Renderer(self._native.scene(), **{**self._settings, "samples": samples})
            renderer.frame = self.frame
        with display(self._progress if progress is None else progress, live=False) as shown:
            image = self._image(renderer._native.extend(native(partial_render), shown.callback))
            shown.finish(image)
        return renderer._warned(image)

    def probe(self, x, y, *, depth=5, branches=5, brightest=5):
        """Explains the pixel in column `x` and row `y`, counted from 0 at the top left."""
        from juggler._probe import Probe

        pixel = (whole("x", x, 0), whole("y", y, 0))
        detail = {"depth": depth, "branches": branches, "brightest": brightest}
        detail = (whole(name, value, 0) for name, value in detail.items())
        return self._warned(Probe(*self._native.probe(pixel, *detail)))

    def _image(self, native):
        return Image(native, self._color_maps)

    def _warned(self, result):
        warn(self._native.take_warnings())
        return result


@contextmanager
def _plain_key_errors(path):
    """Removes the suggestion of a member that is known but absent."""
    try:
        yield
    except KeyError as error:
        message = error.args[0].removesuffix(f"; did you mean `{path}`?")
        raise KeyError(message) from None


def _objects(scene):
    """Objects of a scene that may be those of `juggler.sci`."""
    import sys

    if "juggler._values" not in sys.modules:
        return ()
    objects = scene.get("objects") if hasattr(scene, "get") else getattr(scene, "objects", None)
    return () if objects is None else objects


def _color_maps(scene):
    """Color maps of `juggler.sci` in a scene."""
    objects = _objects(scene)
    if not len(objects):
        return ()
    from juggler._values import maps_of

    return tuple(maps_of(objects))


def _warn_of_unlit(scene):
    """Warns of objects without lighting, which have no albedo."""
    objects = _objects(scene)
    if not len(objects):
        return
    from juggler._values import has_unlit

    if has_unlit(objects):
        warn(
            [
                "objects without lighting (`lit=False`) are black in renders with sci.flat(); use one of the two"
            ]
        )


def _restore(text, name, settings, frame, assets=(), color_maps=()):
    """Makes the renderer of another process."""
    scene = _native.Scene.from_json(text, bool(settings.get("lenient")), name, list(assets))
    renderer = Renderer(scene, **settings)
    renderer.frame = frame
    renderer._color_maps = color_maps
    return renderer


Renderer.__module__ = "juggler"
