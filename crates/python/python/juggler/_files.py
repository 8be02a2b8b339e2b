"""Names of files."""

import os


def file_name(path):
    """Returns the name of a file as text: of a text, of bytes or of a path."""
    name = os.fsdecode(path)
    try:
        name.encode()
    except UnicodeEncodeError:
        from juggler._errors import FileError

        raise FileError(f"names of files must be UTF-8, not {os.fsencode(name)!r}") from None
    return name
