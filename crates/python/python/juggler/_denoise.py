"""Denoising of arrays of any origin."""

from juggler import _native
from juggler._image import array


def denoise(color, *, albedo=None, normal=None, depth=None, denoiser="own"):
    """Returns the linear pixels of an image without noise: an array of shape (height, width, 3), float32.

    `color` has the shape (height, width, 3). The shape (2, height, width, 3) means two images, each of
    one half of the samples: their difference is the noise, so that the result is sharper. The features
    keep edges and textures sharp: `albedo` from 0 to 1 (height, width, 3), the `normal` of the surface
    (height, width, 3), and `depth`, the distance along the ray (height, width). `denoiser` is "own" or
    "oidn" (Open Image Denoise, if installed).
    """
    color = _floats("color", color)
    has_halves = color.ndim == 4 and color.shape[0] == 2
    if color.ndim != (4 if has_halves else 3) or color.shape[-1] != 3 or not color.size:
        raise _settings_error("color", f"`color` must have the shape (height, width, 3), not {color.shape}")
    height, width = color.shape[-3:-1]
    features = [
        _feature("albedo", albedo, (height, width, 3)),
        _feature("normal", normal, (height, width, 3)),
        _feature("depth", depth, (height, width)),
    ]
    pixels = _native.denoise((width, height), color.tobytes(), has_halves, *features, denoiser)
    return array(pixels, "float32", (height, width, 3))


def _floats(name, values):
    from juggler import _arrays
    from juggler._errors import SceneError

    try:
        return _arrays.real_array(values, f"`{name}`").astype("float32")
    except SceneError as error:
        raise _settings_error(name, str(error)) from None


def _feature(name, values, shape):
    """Bytes of a feature, or `None`."""
    if values is None:
        return None
    values = _floats(name, values)
    if values.shape == (*shape, 1):
        values = values.reshape(shape)
    if values.shape != shape:
        raise _settings_error(name, f"`{name}` must have the shape {shape}, as `color`, not {values.shape}")
    return values.tobytes()


def _settings_error(name, message):
    from juggler._errors import SettingsError

    return SettingsError(message, name)


denoise.__module__ = "juggler"
