"""Base classes of the parts of a scene that hold arrays: meshes, images and instances.

A part refers to its arrays. They are copied when the scene is given to the renderer, is checked or
is saved: a `Renderer` has its own copy, which later changes of the arrays do not reach.
"""

from ._node import Node, Unfit, plain, resembles_array, same, suggestion


class PerFace:
    """Values of an attribute of a mesh, one for each triangle instead of each vertex."""

    __slots__ = ("values",)

    def __init__(self, values):
        self.values = values

    def __eq__(self, other):
        return same(self.values, other.values) if isinstance(other, PerFace) else NotImplemented

    __hash__ = None

    def __reduce__(self):
        return PerFace, (self.values,)

    def __repr__(self):
        from ._node import shown

        return f"PerFace({shown(self.values)})"

    def to_json(self, collect):
        """Returns the attribute in the scene format, with lists."""
        return _attribute_lists(self)


PerFace.__module__ = "juggler"


_MESH = ("positions", "triangles", "normals", "uvs", "uvs1", "tangents")
_INSTANCES = ("positions", "rotations", "scales", "matrices", "colors", "end_colors")

# How many numbers each value of an array has.
WIDTHS = {
    "positions": 3,
    "triangles": 3,
    "normals": 3,
    "uvs": 2,
    "uvs1": 2,
    "tangents": 4,
    "rotations": 4,
    "colors": 4,
    "end_colors": 4,
}


def _is_values(value):
    """Whether an attribute is given by its values alone."""
    return isinstance(value, (PerFace, list, tuple, range)) or resembles_array(value)


def _attribute_lists(value):
    """JSON form of an attribute that is given by its values."""
    face = isinstance(value, PerFace)
    value = value.values if face else value
    kind = {"uint8": "u8", "uint16": "u16"}.get(str(getattr(value, "dtype", "")), "f32")
    numbers = plain(value)
    channels = 1
    if numbers and isinstance(numbers[0], list):
        channels = len(numbers[0])
        numbers = [number for value in numbers for number in value]
    if kind == "f32":
        numbers = [number if isinstance(number, str) else float(number) for number in numbers]
    return {**({"domain": "face"} if face else {}), "channels": channels, "data": {kind: numbers}}


class _ArrayNode(Node):
    """Base class of parts whose arrays and attributes an asset may hold."""

    __slots__ = ()

    # Fields that are arrays, and the class of the asset's arrays in `_assets`.
    _arrays = ()
    _asset = None

    def _members(self, collect):
        fields = {name: getattr(self, name) for name in self._arrays if getattr(self, name, None) is not None}
        attributes = getattr(self, "attributes", None)
        named = dict(attributes) if hasattr(attributes, "keys") else {}
        # What is no file may be an asset.
        if collect is not None and getattr(self, "file", "") is None:
            from . import _assets

            arrays = getattr(_assets, self._asset)(self._label(), fields, named)
            if arrays.is_asset():
                others = self.replace(**dict.fromkeys((*fields, *(["attributes"] if named else ()))))
                return {"file": collect(arrays), **Node._members(others, collect)}
        if any(map(_is_values, named.values())):
            named = {
                name: _attribute_lists(value) if _is_values(value) else value for name, value in named.items()
            }
            return Node._members(self.replace(attributes=named), collect)
        return super()._members(collect)


class ArrayMesh(_ArrayNode):
    """Base class of meshes."""

    __slots__ = ()
    _arrays = _MESH
    _asset = "MeshArrays"


class ArrayImage(Node):
    """Base class of textures and backgrounds that show an image."""

    __slots__ = ("array",)
    _unwritten = ("array",)

    def _members(self, collect):
        members = super()._members(collect)
        if self.array is None:
            return members
        if self.file is not None:
            raise Unfit(f"{self._label()} has `file` and `array`; give one of them")
        from ._assets import TexelArray

        found = None if collect is None else collect(TexelArray(self._label(), self.array))
        if found is None:
            raise Unfit(f"`array` of {self._label()} has no form in text; `Scene.save` writes it as a file")
        return {"file": found, **members}


class ArrayInstances(_ArrayNode):
    """Base class of instances."""

    __slots__ = ()
    _arrays = _INSTANCES
    _asset = "InstanceArrays"

    def _members(self, collect):
        members = super()._members(collect)
        matrices = members.get("matrices")
        if isinstance(matrices, list):
            members["matrices"] = [_row(matrix) for matrix in matrices]
        return members


def part_of(module, name, members):
    """The part of a scene with these members; `None` if they have no arrays, or are not those of the part."""
    from ._arrays import is_array

    attributes = members.get("attributes")
    names = attributes.keys() if hasattr(attributes, "keys") else ()
    values = [*members.values(), *(attributes[name] for name in names)]
    if "array" not in members and not any(is_array(value) or isinstance(value, PerFace) for value in values):
        return None
    from importlib import import_module

    part = getattr(import_module(f"juggler.{module}"), name)
    if all(member in part._fields for member in members):
        return part(**members)
    # The reader of scenes names unknown members, but knows no arrays of texels.
    if "array" in members and "array" in part._fields:
        wrong = next(member for member in members if member not in part._fields)
        raise Unfit(f"{part._label()} has no `{wrong}`{suggestion(str(wrong), part._fields)}")
    return None


def _row(matrix):
    """The 12 numbers of an affine map, of a matrix with 3 or 4 rows."""
    if not isinstance(matrix, list):
        return matrix
    if matrix and all(isinstance(row, list) for row in matrix):
        matrix = [number for row in matrix for number in row]
    if len(matrix) == 16 and list(matrix[12:]) == [0, 0, 0, 1]:
        return matrix[:12]
    return matrix
