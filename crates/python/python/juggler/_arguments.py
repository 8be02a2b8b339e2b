"""Checks of arguments."""

import operator

from juggler._errors import SettingsError

# Greatest whole number that an argument may be.
_MOST = 2**32 - 1


def whole(name, value, least):
    """Returns the argument `name` if it is a whole number from `least` on."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"`{name}` must be a whole number, not {value!r}") from None
    if not least <= number <= _MOST:
        limit = f"at least {least}" if number < least else f"at most {_MOST}"
        raise SettingsError(f"`{name}` must be {limit}, not {number}", name)
    return number


def seconds(name, value):
    """Returns the argument `name` if it is a number of seconds."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"`{name}` must be a number of seconds, not {value!r}") from None
    if not number >= 0:
        raise SettingsError(f"`{name}` must be a number of seconds from 0 on, not {value!r}", name)
    return number


def source(scene):
    """Returns the argument `scene` if it is no class, and the name of a file as text."""
    if isinstance(scene, type):
        raise TypeError(f"a scene is an object such as `{scene.__name__}(...)`, not the class itself")
    if isinstance(scene, str) or hasattr(scene, "__fspath__"):
        from juggler._files import file_name

        return file_name(scene)
    return scene


def numbers_of_frames(frames, settings):
    """Returns an iterator over the argument `frames`, in which case no setting selects a frame."""
    for name in ("frame", "at"):
        if settings.get(name) is not None:
            raise SettingsError(f"`{name}` cannot act, since `frames` selects the frames", name)
    try:
        return iter(frames)
    except TypeError:
        raise TypeError(f"`frames` are numbers of frames, such as range(0, 30), not {frames!r}") from None
