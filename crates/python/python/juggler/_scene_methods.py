"""Methods of scenes that need the renderer."""

from ._files import file_name
from ._node import Node


class SceneMethods(Node):
    """Base class of `Scene`."""

    # Whether missing pictures of models are shown gray.
    __slots__ = ("_lenient",)

    def __init__(self, *arguments, **fields):
        self._lenient = False
        super().__init__(*arguments, **fields)

    def __reduce__(self):
        return (*super().__reduce__(), (None, {"_lenient": self._lenient}))

    def replace(self, **changes):
        """Returns a copy with other values of some fields; `None` removes a field."""
        made = super().replace(**changes)
        made._lenient = self._lenient
        return made

    __replace__ = replace

    @classmethod
    def load(cls, path, lenient=False):
        """Loads a scene file, a model or a mesh, or the built-in scene of this name.

        The sections of the scene are lists and dictionaries, in which names of files are relative to
        the current folder. `lenient` shows missing pictures of models gray, in renders of the scene, too.
        """
        import json

        from ._scene import native_scene

        scene = native_scene(file_name(path), lenient)
        sections = json.loads(scene.to_json_here())
        made = cls(**{name: value for name, value in sections.items() if name in cls.__match_args__})
        made._lenient = lenient
        return made

    def check(self):
        """Returns the warnings of the scene as texts. Raises a `SceneError` with all its mistakes."""
        from ._scene import native_scene
        from ._trace import Explained

        with Explained(self):
            return [message.removeprefix("warning: ") for message in native_scene(self).check()]

    def save(self, path):
        """Saves the scene with its animation as a scene file, and its assets beside it."""
        from ._scene import native_scene

        native_scene(self).save(file_name(path))

    def models(self):
        """Returns a description of each model of the scene, as `juggler.models` does."""
        from ._api import models

        return models(self)
