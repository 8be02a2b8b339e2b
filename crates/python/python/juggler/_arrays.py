"""Conversion of arrays to those that the renderer keeps. NumPy is loaded when one is converted."""

from ._errors import SceneError

# A plain list of more items becomes an array; a shorter one stays in the text of the scene.
_MAX_LIST = 1000

# Types of numbers that the renderer keeps as they are, by the names of NumPy.
_KEPT = {"uint8": "u1", "uint16": "u2", "float16": "f2", "float32": "f4"}


def numpy():
    """NumPy, or an error that says how to install it."""
    try:
        import numpy
    except ImportError:
        raise ImportError("arrays need NumPy: pip install numpy") from None
    return numpy


def is_array(value):
    """Whether a value is an array of a library, and no single number."""
    return hasattr(type(value), "__array__") and getattr(value, "ndim", 1) != 0


def is_large(value):
    """Whether a plain list has so many items that it should not be text."""
    return isinstance(value, (list, tuple, range)) and len(value) > _MAX_LIST


def has_numbers(value):
    """Whether a plain list is one of numbers alone. Expressions and value forms must be text."""
    try:
        return numpy().asarray(value).dtype.kind in "biuf"
    except (ImportError, ValueError, TypeError, OverflowError):
        return False


def real_array(value, label):
    """The NumPy array of a value, of any type of real numbers."""
    np = numpy()
    if np.ma.is_masked(value):
        raise SceneError(f"{label} has masked numbers; fill them, such as by `.filled(0)`")
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError) as error:
        raise SceneError(f"{label} is no array of numbers: {error}") from None
    if array.dtype.kind not in "biuf":
        found = (
            "numbers and other values" if array.dtype.kind in "OSU" else f"values of the type {array.dtype}"
        )
        raise SceneError(f"{label} must be an array of real numbers; it has {found}")
    return array


def unmasked(values):
    """The array of values, in which masked ones are no numbers (NaN)."""
    np = numpy()
    if np.ma.isMaskedArray(values):
        return values.astype("f8").filled(np.nan)
    return np.asarray(values)


def _contiguous(array, type_name):
    """The array with its numbers in a row, in little-endian order."""
    np = numpy()
    with np.errstate(over="ignore", invalid="ignore"):
        return np.ascontiguousarray(array, dtype=f"<{type_name}")


def as_bytes(array):
    """The bytes of a contiguous array, without a copy."""
    return array.reshape(-1).view("u1")


def _shaped(value, label, width):
    """An array of shape (n, width)."""
    array = real_array(value, label)
    if array.size == 0:
        return array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise SceneError(f"{label} must be an array of shape (n, {width}); its shape is {array.shape}")
    return array


def floats(value, label, width):
    """An array of shape (n, width) as float32. Numbers of 64 bits are rounded."""
    return _contiguous(_shaped(value, label, width), "f4")


def colors(value, label, width):
    """An array of shape (n, width) of finite numbers as float32."""
    np = numpy()
    array = floats(value, label, width)
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        row, column = wrong[0]
        raise SceneError(f"{label} must be finite numbers; it has {array[row, column]} in row {row}")
    return array


def indices(value, label, width):
    """An array of whole numbers from 0, of shape (n, width), as uint32."""
    array = _shaped(value, label, width)
    if array.size == 0:
        return _contiguous(array, "u4")
    if array.dtype.kind not in "iu":
        raise SceneError(f"{label} must be whole numbers, not {array.dtype}")
    if array.min() < 0 or array.max() > 0xFFFFFFFF:
        wrong = int(array.min() if array.min() < 0 else array.max())
        raise SceneError(f"{label} must be indices from 0 to 4294967295, not {wrong}")
    return _contiguous(array, "u4")


def values(value, label):
    """Values with 1 to 4 numbers each, of shape (n,) or (n, channels): channels, type and array.

    uint8 and uint16 stay, and stand for 0 to 1; all other numbers become float32.
    """
    array = real_array(value, label)
    if array.size == 0:
        array = array.reshape(0, array.shape[1] if array.ndim == 2 and 1 <= array.shape[1] <= 4 else 1)
    if array.ndim == 1:
        array = array.reshape(-1, 1)
    if array.ndim != 2 or not 1 <= array.shape[1] <= 4:
        shape = tuple(numpy().shape(value))
        raise SceneError(f"{label} must be an array of shape (n,) or (n, 1) to (n, 4); its shape is {shape}")
    kind = _KEPT.get(array.dtype.name, "f4")
    kind = "f4" if kind == "f2" else kind
    return array.shape[1], kind, _contiguous(array, kind)


def stored(value, kind, label):
    """Numbers of the type u8, u16 or f32 of the scene format."""
    array = real_array(value, label)
    if kind == "f32":
        return _contiguous(array, "f4")
    most = 255 if kind == "u8" else 65535
    if array.size:
        ends = (array.dtype,) if array.dtype.kind not in "iu" else (int(array.min()), int(array.max()))
        wrong = [end for end in ends if not isinstance(end, int) or not 0 <= end <= most]
        if wrong:
            raise SceneError(f"{label} must be whole numbers from 0 to {most}, not {wrong[0]}")
    return _contiguous(array, "u1" if kind == "u8" else "u2")


def texels(value, label):
    """Texels of shape (height, width) or (height, width, channels): size, channels, type and array."""
    array = real_array(value, label)
    shape = tuple(array.shape)
    if array.ndim not in (2, 3) or array.ndim == 3 and not 1 <= shape[2] <= 4:
        raise SceneError(
            f"{label} must be an array of shape (height, width) or (height, width, 1 to 4 channels); its shape is {shape}"
        )
    kind = "f4" if array.dtype.name == "float64" else _KEPT.get(array.dtype.name)
    if kind is None:
        kept = "uint8, uint16, float16, float32 or float64"
        raise SceneError(
            f'{label} must be of the type {kept}, not {array.dtype}; convert it, such as by `.astype("uint8")`'
        )
    return (shape[1], shape[0]), shape[2] if array.ndim == 3 else 1, kind, _contiguous(array, kind)


def rows(value, label):
    """Affine maps of shape (n, 3, 4), (n, 4, 4), (n, 12) or (n, 16) as 12 numbers each, row by row."""
    array = real_array(value, label)
    if array.size == 0:
        return _contiguous(array.reshape(0, 12), "f4")
    if array.ndim == 3 and array.shape[1:] in ((3, 4), (4, 4)):
        array = array.reshape(len(array), -1)
    if array.ndim != 2 or array.shape[1] not in (12, 16):
        raise SceneError(
            f"{label} must be an array of shape (n, 3, 4) or (n, 4, 4); its shape is {tuple(array.shape)}"
        )
    if array.shape[1] == 16 and not (array[:, 12:] == (0, 0, 0, 1)).all():
        raise SceneError(f"{label} must be affine: the last row of each is (0, 0, 0, 1)")
    return _contiguous(array[:, :12], "f4")


def scales(value, label):
    """Scale factors: one for each instance, shape (n,), or one for each axis, (n, 3). Lists may have
    both.
    """
    if isinstance(value, (list, tuple)) and any(hasattr(item, "__len__") for item in value):
        value = [item if hasattr(item, "__len__") else (item, item, item) for item in value]
    array = real_array(value, label)
    if array.ndim == 1:
        return "uniform_scales", _contiguous(array, "f4")
    if array.ndim != 2 or array.shape[1] != 3:
        raise SceneError(
            f"{label} must be an array of shape (n,) or (n, 3); its shape is {tuple(array.shape)}"
        )
    return "scales", _contiguous(array, "f4")
