"""Exceptions and warnings."""


class Problem:
    """A mistake of a scene.

    `path` leads to the value (`objects[0].shape.sphere.radius`), `severity` is "error" or
    "warning", and `file`, `line` and `column` are `None` unless the scene was read from a file.
    `made_at` is the line of code that made the part, if `juggler.trace_nodes` was on.
    """

    _fields = ("path", "message", "help", "severity", "file", "line", "column", "made_at")
    __slots__ = _fields

    def __init__(self, path, message, help=None, severity="error", file=None, line=None, column=None, made_at=None):
        self.path = path
        self.message = message
        self.help = help
        self.severity = severity
        self.file = file
        self.line = line
        self.column = column
        self.made_at = made_at

    def _values(self):
        return tuple(getattr(self, name) for name in self._fields)

    def __eq__(self, other):
        return self._values() == other._values() if isinstance(other, Problem) else NotImplemented

    def __hash__(self):
        return hash(self._values())

    def __reduce__(self):
        return Problem, self._values()

    def __repr__(self):
        values = zip(self._fields, self._values())
        return f"Problem({', '.join(f'{name}={value!r}' for name, value in values)})"

    def __str__(self):
        place = f"{self.file}:{self.line}:{self.column}: " if self.file else ""
        path = f"{self.path}: " if self.path else ""
        help = f"; {self.help}" if self.help else ""
        made = f"; made at {self.made_at}" if self.made_at else ""
        return f"{place}{path}{self.message}{help}{made}"


def problems_from_json(text):
    """Returns the problems of a list that the renderer wrote."""
    import json

    return [Problem(**fields) for fields in json.loads(text)]


class SceneError(ValueError):
    """The scene has mistakes, all of which are in `problems`."""

    def __init__(self, message, problems=()):
        super().__init__(message, problems)
        self.problems = list(problems)

    def __str__(self):
        return self.args[0]


class SettingsError(ValueError):
    """A setting or an argument is wrong.

    `setting` is its name, or `None` if there is no single one, and `help` suggests a fix, or is
    `None`.
    """

    def __init__(self, message="", setting=None, help=None):
        super().__init__(message, setting, help)
        self.setting = setting
        self.help = help

    def __str__(self):
        return str(self.args[0])


class MergeError(ValueError):
    """Partial renders do not fit together, or do not make a whole image."""


class FileError(OSError):
    """A file cannot be read or written."""

    def __str__(self):
        # The message names the file and the cause.
        return str(self.args[-1]) if self.args else ""


class MemoryBudgetError(MemoryError):
    """The render needs more memory than `max_memory`."""


class Cancelled(Exception):
    """The render was cancelled."""


class InternalError(RuntimeError):
    """The renderer failed because of a mistake of its own."""


class SceneWarning(UserWarning):
    """A scene can be rendered, but the result may not be the intended one."""


for _name in (
    "Problem",
    "SceneError",
    "SettingsError",
    "MergeError",
    "FileError",
    "MemoryBudgetError",
    "Cancelled",
    "InternalError",
    "SceneWarning",
):
    globals()[_name].__module__ = "juggler"
del _name
