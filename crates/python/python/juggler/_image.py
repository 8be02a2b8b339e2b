"""Rendered images."""

from _collections_abc import Mapping

from juggler import _native
from juggler._files import file_name

# Greatest width of a preview in a notebook, in pixels.
_PREVIEW_WIDTH = 1600
# Names of AOVs in other programs that were looked up, and those of the package.
_foreign_names = {}


def array(data, type_name, shape):
    """Returns the NumPy array of these bytes, without a copy."""
    try:
        import numpy
    except ImportError:
        raise ImportError("arrays need NumPy: pip install numpy") from None
    return numpy.frombuffer(data, dtype=type_name).reshape(shape)


class Image:
    """Rendered image, with linear pixels and AOVs.

    `img.color` is an array of shape (height, width, 3), `img["depth"]` or `img.aovs["depth"]` that
    of an AOV; `img.keys()` are the names. Equal bits have an equal `hash`, which is `film.hash` of the program.
    """

    __slots__ = ("__weakref__", "_arrays", "_color_maps", "_native")

    def __init__(self, native, color_maps=()):
        if not isinstance(native, _native.Image):
            raise TypeError("images are made by juggler.render")
        self._native = native
        self._arrays = {}
        # Color maps of `juggler.sci` in the scene.
        self._color_maps = color_maps

    def __reduce__(self):
        return _restore, (self._native.state(), self._color_maps)

    def __repr__(self):
        width, height = self.size
        return f"<juggler.Image {width}x{height}, {self.stats['samples']:g} samples, hash {self.hash[:12]}>"

    def __eq__(self, other):
        if not isinstance(other, Image):
            return NotImplemented
        return self.size == other.size and self.hash == other.hash and self._layers() == other._layers()

    def __hash__(self):
        return hash(self.hash)

    def _layers(self):
        return [(name, self._native.layer(name)) for name, _, _ in self._native.layers()]

    @property
    def size(self):
        """Width and height in pixels."""
        return tuple(self._native.size)

    @property
    def color(self):
        """Linear pixels: a read-only array of shape (height, width, 3), float32."""
        if "color" not in self._arrays:
            width, height = self.size
            self._arrays["color"] = array(self._native.pixels(), "float32", (height, width, 3))
        return self._arrays["color"]

    @property
    def alpha(self):
        """Alpha of the pixels of a transparent image, by which their colors are multiplied: a
        read-only array of shape (height, width), float32. `None` for an opaque image.
        """
        # The AOV `alpha`, the coverage by surfaces, has the plain name.
        if ".alpha" not in self._arrays:
            data, (width, height) = self._native.alpha(), self.size
            self._arrays[".alpha"] = None if data is None else array(data, "float32", (height, width))
        return self._arrays[".alpha"]

    @property
    def aovs(self):
        """Arrays of the AOVs by name, of shape (height, width) or (height, width, channels)."""
        return Layers(self)

    def __getitem__(self, name):
        if name == "color":
            return self.color
        return self.aovs[name]

    def __contains__(self, name):
        return name == "color" or name in self.aovs

    def __iter__(self):
        return iter(self.keys())

    def keys(self):
        """Names of the arrays of the image: "color", and those of its AOVs."""
        return ["color", *self.aovs]

    @property
    def names(self):
        """Names that the AOVs `object_id` and `material_id` number: `names["object_id"][id]`. The
        number 0 is nothing.
        """
        found = {name: self._native.names(name) for name, _, _ in self._native.layers()}
        return {name: [None, *names] for name, names in found.items() if names is not None}

    @property
    def hash(self):
        """Hash of the linear pixels, in hexadecimal."""
        return self._native.hash

    @property
    def fingerprint(self):
        """Fingerprint of everything that determines the pixels."""
        return self._native.fingerprint

    @property
    def frame(self):
        """Frame of the animation."""
        frame = self._native.frame
        return int(frame) if frame.is_integer() else frame

    @property
    def stats(self):
        """Mean of the pixels, and numbers of samples, rays and seconds."""
        return self._native.stats()

    @property
    def metadata(self):
        """Metadata of an image file, such as program, fingerprint and seed."""
        return dict(self._native.metadata)

    @property
    def camera(self):
        """Matrices of the camera; `None` for a camera without finite ones."""
        from juggler._camera import Camera

        viewpoint = self._native.viewpoint
        return None if viewpoint is None else Camera(viewpoint, self._native.window)

    def denoised(self, denoiser="own"):
        """Returns the image without noise, by the denoiser "own" or "oidn" (Open Image Denoise).

        The denoiser uses the AOVs `albedo`, `normal` and `depth` if the image has them, and should have
        them: they keep edges and textures sharp. A render with `denoise=` knows more of the noise and
        gives a sharper image; such an image stays as it is.
        """
        return Image(self._native.denoised(denoiser))

    def save(self, path):
        """Saves the image to a file, whose ending selects the format. An EXR file has the AOVs."""
        self._native.save(file_name(path))

    def to_uint8(self, tone=None, exposure=None):
        """Levels from 0 to 255 as an image file without dithering has them (`dither=False`), with
        another tone curve or exposure in stops if given: an array of shape (height, width, 3).
        """
        width, height = self.size
        return array(self._native.to_rgb8(tone, exposure), "uint8", (height, width, 3))

    def plot(self, colorbar=False, scale_bar=None, *, title=None, label=None, ax=None):
        """Draws the image by matplotlib, and returns the figure.

        `colorbar=True` adds a bar for each color map of `juggler.sci` in the scene, with `label`
        beside it; an object of `juggler.sci` may be given instead. `scale_bar` is a length in scene
        units with its unit, such as "1 mm", for orthographic cameras. `ax` are axes of matplotlib.
        """
        from juggler._plot import plot

        return plot(self, colorbar, scale_bar, title, label, ax)

    def __array__(self, dtype=None, copy=None):
        color = self.color if dtype is None else self.color.astype(dtype)
        return color.copy() if copy else color

    def __dlpack__(self, **arguments):
        # The consumer may write, so it gets a copy.
        return self.color.copy().__dlpack__(**arguments)

    def __dlpack_device__(self):
        return (1, 0)

    def _repr_png_(self):
        return self._native.encode("png", _PREVIEW_WIDTH)

    def _repr_html_(self):
        from juggler._notebook import html

        return html(self)


class Layers(Mapping):
    """AOVs of an image by name."""

    __slots__ = ("_image",)

    def __init__(self, image):
        self._image = image

    def _all(self):
        return {name: (channels, is_index) for name, channels, is_index in self._image._native.layers()}

    def __getitem__(self, name):
        arrays, known = self._image._arrays, self._all()
        name = _own_name(name, known)
        if name not in known:
            raise KeyError(_unknown(name, known))
        if name not in arrays:
            channels, is_index = known[name]
            width, height = self._image.size
            shape = (height, width) if channels == 1 else (height, width, channels)
            data = self._image._native.layer(name)
            arrays[name] = array(data, "int32" if is_index else "float32", shape)
        return arrays[name]

    def __contains__(self, name):
        known = self._all()
        return _own_name(name, known) in known

    def __iter__(self):
        return iter(self._all())

    def __len__(self):
        return len(self._all())

    def __repr__(self):
        return f"<AOVs {', '.join(self) or 'none'}>"


def _own_name(name, known):
    """Returns the name of an AOV for one that other programs use, such as "planar_depth" for "Z"."""
    if not isinstance(name, str) or name in known:
        return name
    names = _aovs_of(name)
    return names[0] if len(names) == 1 else name


def _aovs_of(name):
    """Names of the AOVs that a render with `aovs=[name]` has; none if there is no such AOV."""
    if name not in _foreign_names:
        from juggler._errors import SettingsError
        from juggler._renderer import Renderer

        try:
            empty = {"version": 1, "objects": []}
            image = Renderer(empty, size=(1, 1), samples=1, aovs=[name], threads=1).render(progress=False)
            _foreign_names[name] = list(image.aovs)
        except SettingsError:
            return []
    return _foreign_names[name]


def _unknown(name, known):
    has = f"it has {', '.join(known)}" if known else "it has none"
    is_aov = isinstance(name, str) and _aovs_of(name)
    help = f"; render it with aovs=[{name!r}]" if is_aov else ""
    return f"the image has no AOV {name!r}, {has}{help}"


def _restore(state, color_maps=()):
    """Makes the image of another process."""
    return Image(_native.Image.from_state(state), color_maps)


Image.__module__ = "juggler"
