"""Assets: what the renderer keeps of the arrays of a scene."""

from juggler import _native

from . import _arrays
from ._array_nodes import WIDTHS, PerFace
from ._errors import SceneError
from ._node import Node, suggestion


def restore(kind, *arguments):
    """Makes the asset that `pickle` has taken apart."""
    return getattr(_native.Asset, kind)(*arguments)


class Collector:
    """Makes the assets of a scene while its text is written; `assets` has them by name, and
    `warnings` what they do not show.
    """

    def __init__(self):
        self.assets = {}
        self.warnings = []
        # Names by the identity of the arrays, and the arrays, which keep their identity so.
        self._names = {}

    def __call__(self, arrays):
        """Name of the asset; `None` for arrays that are no asset of their own."""
        if not isinstance(arrays, (_Arrays, TexelArray)):
            return None
        key = arrays.key()
        if key not in self._names:
            asset = arrays.asset()
            self.warnings += arrays.warnings
            self.assets[asset.name] = asset
            self._names[key] = asset.name, arrays
        return self._names[key][0]


class _Arrays:
    """Arrays of one part of a scene: fields, and attributes by name."""

    # Keys of attributes in the form of the scene format.
    _attribute_keys = ()
    warnings = ()

    def __init__(self, label, fields, attributes):
        self.label = label
        self.fields = fields
        self.attributes = attributes

    def key(self):
        """The identity of all arrays."""
        fields = ((name, id(value)) for name, value in self.fields.items())
        values = (
            (name, isinstance(value, PerFace), id(_values(value))) for name, value in self.attributes.items()
        )
        return (type(self).__name__, *fields, None, *values)

    def is_asset(self):
        """Whether one of the arrays should not be text."""
        values = [*self.fields.values(), *map(_values, self.attributes.values())]
        if any(map(_arrays.is_array, values)):
            return True
        return any(map(_arrays.is_large, values)) and all(map(_arrays.has_numbers, self.fields.values()))

    def _named(self, name):
        return f"`{name}` of {self.label}"

    def _attributes(self):
        """Each attribute with its name: whether its values belong to faces, channels, type, bytes."""
        return [(name, *self._attribute(name, value)) for name, value in self.attributes.items()]

    def _attribute(self, name, value):
        if not isinstance(name, str):
            raise SceneError(f"names of attributes of {self.label} are strings, not {name!r}")
        label = f"the attribute `{name}` of {self.label}"
        face = isinstance(value, PerFace)
        if isinstance(value, Node):
            fields = ((field, getattr(value, field)) for field in value._fields)
            value = {field: found for field, found in fields if found is not None}
        if not _arrays.is_array(value) and hasattr(value, "keys"):
            face = _is_of_faces(label, value, self._attribute_keys)
            value = _described(label, value)
        channels, kind, array = _arrays.values(_values(value), label)
        return face, channels, kind, _arrays.as_bytes(array)


def _is_of_faces(label, attribute, keys):
    """Whether an attribute in the form of the scene format, which has these keys, belongs to faces."""
    for key in attribute.keys():
        if key not in keys:
            raise SceneError(f"{label} has no `{key}`{suggestion(str(key), keys)}")
    domain = attribute.get("domain")
    if domain is not None and not (isinstance(domain, str) and domain in ("vertex", "face")):
        raise SceneError(f'`domain` of {label} is "vertex" or "face", not {domain!r}')
    return domain == "face"


def _described(label, attribute):
    """Values of an attribute in the form of the scene format, whose arrays may be lists."""
    data, channels = attribute.get("data"), attribute.get("channels")
    kind = next(iter(data), None) if hasattr(data, "keys") and len(data) == 1 else None
    is_count = hasattr(channels, "__index__") and not (
        _arrays.is_array(channels) or isinstance(channels, bool)
    )
    if kind not in ("u8", "u16", "f32") or not is_count or not 1 <= channels <= 4:
        raise SceneError(
            f"{label} must be an array, or have `channels` from 1 to 4 and `data` of u8, u16 or f32"
        )
    channels = int(channels)
    array = _arrays.stored(data[kind], kind, f"`{kind}` of {label}")
    if array.ndim != 1 and array.shape[1:] != (channels,):
        raise SceneError(f"`{kind}` of {label} must be numbers in a row; its shape is {array.shape}")
    if array.size % channels:
        raise SceneError(f"{label} has {array.size} numbers, not a multiple of its {channels} channels")
    return array.reshape(-1, channels)


class MeshArrays(_Arrays):
    """Arrays of a mesh."""

    _attribute_keys = ("domain", "channels", "data")

    def asset(self):
        """The asset."""
        arrays = {}
        for name, value in self.fields.items():
            convert = _arrays.indices if name == "triangles" else _arrays.floats
            arrays[name] = _arrays.as_bytes(convert(value, self._named(name), WIDTHS[name]))
        return _native.Asset.mesh(arrays, self._attributes())


class InstanceArrays(_Arrays):
    """Arrays of instances."""

    _attribute_keys = ("channels", "data")

    def asset(self):
        """The asset."""
        arrays = {}
        for name, value in self.fields.items():
            label = self._named(name)
            if name == "matrices":
                array = _arrays.rows(value, label)
            elif name == "scales":
                name, array = _arrays.scales(value, label)
            else:
                convert = _arrays.colors if name in ("colors", "end_colors") else _arrays.floats
                array = convert(value, label, WIDTHS[name])
            arrays[name] = _arrays.as_bytes(array)
        attributes = self._attributes()
        faces = [name for name, face, *_ in attributes if face]
        if faces:
            raise SceneError(
                f"the attribute `{faces[0]}` of {self.label} is PerFace, but instances have no faces"
            )
        return _native.Asset.instances(arrays, attributes)


def _values(value):
    return value.values if isinstance(value, PerFace) else value


class TexelArray:
    """Texels of an image."""

    def __init__(self, label, array):
        self.label = label
        self.array = array
        self.warnings = []

    def key(self):
        """The identity of the array."""
        return id(self.array)

    def asset(self):
        """The asset."""
        label = f"`array` of {self.label}"
        size, channels, kind, array = _arrays.texels(self.array, label)
        np = _arrays.numpy()
        if kind in ("f2", "f4") and np.isnan(array).any():
            count = int(np.isnan(array).reshape(*size[::-1], -1).any(axis=2).sum())
            found = "1 pixel is no number (NaN)" if count == 1 else f"{count} pixels are no numbers (NaN)"
            self.warnings = [f"{label}: {found}, which is shown as 0"]
        return _native.Asset.texels(size, channels, kind, _arrays.as_bytes(array))
