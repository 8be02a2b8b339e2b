"""Base class of all parts of a scene.

The generated classes list their fields; their behavior is here. A field that is `None` is absent:
the scene format's default applies.
"""

_PLAIN = frozenset({bool, float, int, str, type(None)})

# Modules and classes of the parts of a scene that hold arrays, by their keys.
PARTS_WITH_ARRAYS = {
    "mesh": ("shapes", "Mesh"),
    "instances": ("scene_types", "Instances"),
    "image": ("textures", "Image"),
    "environment": ("backgrounds", "Environment"),
}

# Arrays with more numbers than this are not written out by `repr`.
_MAX_SHOWN = 64


class Unfit(TypeError):
    """A value that the scene format has no form for, with the fields that lead to it."""


def plain(value, collect=None):
    """Converts a value to what `json` can write: dicts, lists, strings, numbers and booleans.

    `collect` is called with each array (an object with `tolist` that is no single number, of any
    library). It returns what stands for the array in the result, or `None` for its numbers as
    lists.
    """
    if type(value) in _PLAIN:
        return value
    if isinstance(value, Node):
        return value.to_json(collect)
    if isinstance(value, (list, tuple)):
        return [plain(item, collect) for item in value]
    if isinstance(value, dict):
        return {_key(key): _member(key, item, collect) for key, item in value.items()}
    if resembles_array(value):
        is_scalar = getattr(value, "ndim", 1) == 0
        found = None if collect is None or is_scalar else collect(value)
        return lists_of(value) if found is None else found
    return _other(value, collect)


def resembles_array(value):
    """Whether a value is an array or a number of a library. Tables of pandas have no `tolist`."""
    return hasattr(value, "tolist") or hasattr(type(value), "__array__")


def lists_of(array):
    """The numbers of an array as nested lists."""
    dtype = getattr(array, "dtype", None)
    if getattr(dtype, "kind", "") == "f" and dtype.itemsize > 8:
        # `tolist` would keep numbers of more than 64 bits, which JSON does not have.
        array = array.astype("f8")
    if hasattr(array, "tolist"):
        return array.tolist()
    from ._arrays import numpy

    return numpy().asarray(array).tolist()


def _member(key, value, collect):
    """Converts a member of a dict. Arrays that a part of a scene holds are collected as those of its class."""
    is_part = collect is not None and isinstance(key, str) and key in PARTS_WITH_ARRAYS
    if not is_part or isinstance(value, Node) or not hasattr(value, "keys"):
        return plain(value, collect)
    value = {key: value[key] for key in value.keys()}
    from ._array_nodes import part_of

    part = part_of(*PARTS_WITH_ARRAYS[key], value)
    return plain(value, collect) if part is None else part._members(collect)


def _key(key):
    if isinstance(key, str):
        return str.__str__(key)
    raise Unfit(f"the key {key!r} is not a string")


def _other(value, collect):
    """Converts values of classes that only resemble those of JSON."""
    if isinstance(value, str):
        return str.__str__(value)
    if hasattr(value, "to_json"):
        return value.to_json(collect)
    if hasattr(value, "__fspath__"):
        return value.__fspath__()
    if hasattr(value, "__index__"):
        return int(value)
    if hasattr(value, "__float__"):
        return float(value)
    if isinstance(value, (bytes, bytearray, set, frozenset)) or not hasattr(value, "__len__"):
        raise Unfit(f"an object of the type {type(value).__name__} cannot be part of a scene")
    if hasattr(value, "keys"):
        return plain({key: value[key] for key in value.keys()}, collect)
    return [plain(item, collect) for item in value]


def shown(value):
    """Expression that gives a value again, except for large arrays."""
    if isinstance(value, list):
        return f"[{', '.join(map(shown, value))}]"
    if isinstance(value, tuple):
        return f"({', '.join(map(shown, value))}{',' if len(value) == 1 else ''})"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key!r}: {shown(item)}' for key, item in value.items())}}}"
    if resembles_array(value):
        shape = tuple(getattr(value, "shape", None) or ())
        count = 1
        for length in shape:
            count *= length
        if count > _MAX_SHOWN:
            return f"<{type(value).__name__} of shape {shape}>"
        return repr(lists_of(value))
    if isinstance(value, Node) or type(value) in _PLAIN:
        return repr(value)
    try:
        return repr(plain(value))
    except TypeError:
        return repr(value)


def same(mine, yours):
    """Whether two values have the same JSON form. Arrays are compared without making lists."""
    if mine is yours:
        return True
    if hasattr(type(mine), "__array__") and type(mine) is type(yours):
        from ._arrays import numpy

        # Comparisons of pandas need equal labels.
        mine, yours = map(numpy().asarray, (mine, yours))
        return mine.shape == yours.shape and bool((mine == yours).all())
    return plain(mine, _compared) == plain(yours, _compared)


def _compared(arrays):
    """What stands for arrays without a JSON form in comparisons."""
    array = getattr(arrays, "array", None)
    return (
        None
        if array is None
        else (getattr(array, "shape", None), str(getattr(array, "dtype", "")), lists_of(array))
    )


class _Signature:
    """Signature of a class for `inspect`, made when it is read."""

    def __get__(self, node, cls):
        from inspect import Parameter, Signature

        def parameter(name):
            is_positional = name in cls._positional
            kind = Parameter.POSITIONAL_OR_KEYWORD if is_positional else Parameter.KEYWORD_ONLY
            default = Parameter.empty if name in cls._required else None
            return Parameter(name, kind, default=default)

        return Signature([parameter(name) for name in cls.__match_args__])


def suggestion(name, names):
    """End of a message about an unknown name: the most similar known name."""
    from difflib import get_close_matches

    close = [known for known in names if known == f"{name}_"] or get_close_matches(name, names, 1)
    return f"; did you mean `{close[0]}`?" if close else ""


def _restore(cls, fields):
    """Makes the node that `pickle` and `copy` have taken apart."""
    return cls(**fields)


class Node:
    """Part of a scene: a shape, a material, a camera, the whole scene."""

    # File and line of the code that made the node, while nodes are traced.
    __slots__ = ("_made_at",)
    # Finds that line; `None` while nodes are not traced.
    _find_place = None
    __match_args__ = ()
    __signature__ = _Signature()
    # Fields, in the order of the scene format.
    _fields = ()
    # Key of the kind in its family: `{"sphere": {...}}`.
    _kind = None
    # Fields that are also positional arguments.
    _positional = ()
    # Fields that must not be absent.
    _required = ()
    # Keys that differ from the names of their fields.
    _keys = {}
    # Members that have only one possible value.
    _constants = {}
    # Fields that are no members of the JSON form: an override of `_members` writes them.
    _unwritten = ()

    def __init_subclass__(cls, **arguments):
        super().__init_subclass__(**arguments)
        slots = cls.__dict__.get("__slots__", ())
        cls._fields += tuple(name for name in slots if not name.startswith("_"))
        keywords = (name for name in cls._fields if name not in cls._positional)
        cls.__match_args__ = (*cls._positional, *keywords)

    def __init__(self, *arguments, **fields):
        self._made_at = None if self._find_place is None else self._find_place()
        if len(arguments) > len(self._positional):
            raise TypeError(self._too_many(len(arguments)))
        for name, value in zip(self._positional, arguments):
            if name in fields:
                raise TypeError(f"{self._label()}() got `{name}` twice: by position and by keyword")
            fields[name] = value
        for name in self._fields:
            setattr(self, name, fields.pop(name, None))
        for name in fields:
            raise TypeError(f"{self._label()} has no `{name}`{suggestion(name, self._fields)}")
        missing = [f"`{name}`" for name in self._required if getattr(self, name) is None]
        if missing:
            raise TypeError(f"{self._label()} needs {' and '.join(missing)}")

    @classmethod
    def _label(cls):
        """Name of the class as users write it: `shapes.Sphere`, `Object`."""
        package, _, module = cls.__module__.rpartition(".")
        is_kind = cls._kind is not None and package == __name__.rpartition(".")[0]
        return f"{module}.{cls.__name__}" if is_kind else cls.__name__

    @classmethod
    def _too_many(cls, count):
        most = len(cls._positional)
        allowed = f"at most {most} positional argument{'s' * (most != 1)}" if most else "keywords only"
        example = f", such as `{cls._fields[0]}=...`" if cls._fields and not most else ""
        return f"{cls._label()}() takes {allowed}{example}, found {count} positional"

    def __repr__(self):
        arguments = []
        by_position = True
        for name in self.__match_args__:
            value = getattr(self, name)
            by_position = by_position and name in self._positional and value is not None
            if by_position:
                arguments.append(shown(value))
            elif value is not None:
                arguments.append(f"{name}={shown(value)}")
        return f"{self._label()}({', '.join(arguments)})"

    def __eq__(self, other):
        """Whether both are of one class and have the same JSON form."""
        if type(self) is not type(other):
            return NotImplemented
        return all(same(getattr(self, name), getattr(other, name)) for name in self._fields)

    # Nodes can change.
    __hash__ = None

    def __reduce__(self):
        fields = ((name, getattr(self, name)) for name in self._fields)
        return _restore, (type(self), {name: value for name, value in fields if value is not None})

    def _value_of(self, key):
        """Value of the field with this key of the scene format; `None` if there is none."""
        for name in self._fields:
            if self._keys.get(name, name) == key:
                return getattr(self, name)
        return None

    def replace(self, **changes):
        """Returns a copy with other values of some fields; `None` removes a field."""
        return type(self)(**{**{name: getattr(self, name) for name in self._fields}, **changes})

    __replace__ = replace

    def to_dict(self):
        """Returns the JSON form: dicts, lists, strings, numbers and booleans."""
        return self.to_json(None)

    def to_json(self, collect):
        """Returns the JSON form; `collect` may replace arrays, as for `plain`."""
        members = self._members(collect)
        return members if self._kind is None else {self._kind: members}

    def _members(self, collect):
        """The fields in JSON form, by key. Classes that store fields elsewhere override it."""
        members = dict(self._constants)
        for name in self._fields:
            value = getattr(self, name)
            if value is None or name in self._unwritten:
                continue
            try:
                members[self._keys.get(name, name)] = plain(value, collect)
            except Unfit as error:
                raise Unfit(f"`{name}` of {self._label()}: {error}") from None
        return members
