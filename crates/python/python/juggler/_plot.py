"""Images with color bar, scale bar and title, drawn by matplotlib around the pixels."""

import math

from ._errors import SceneWarning, SettingsError


def plot(image, colorbar, scale_bar, title, label, ax):
    """Draws an image, see `Image.plot`."""
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError("plots need matplotlib: pip install matplotlib") from None
    maps = _maps(image, colorbar)
    width, height = image.size
    if ax is None:
        # One pixel of the image is about one pixel of the figure.
        figure, ax = pyplot.subplots(
            figsize=(width / 100 + 1.3 * len(maps), height / 100), dpi=100, layout="constrained"
        )
    ax.imshow(image.to_uint8(), interpolation="antialiased")
    ax.set_axis_off()
    if title is not None:
        ax.set_title(title)
    for one in maps:
        _color_bar(ax, one, label)
    if scale_bar is not None:
        _scale_bar(ax, image, scale_bar)
    return ax.figure


def _maps(image, colorbar):
    if colorbar is None or colorbar is False:
        return []
    if colorbar is not True:
        from ._values import maps_of

        maps = maps_of([colorbar])
        if not maps:
            raise SettingsError(
                "`colorbar` is True, False, a sci.ColorMap or an object of juggler.sci with values"
            )
    else:
        maps = list(image._color_maps)
    if not maps:
        raise SettingsError(
            "the scene of the image has no color map of juggler.sci; give `colorbar` the object whose values it shows"
        )
    if image._native.tone_curve != "srgb":
        import warnings

        warnings.warn(
            f"the tone curve `{image._native.tone_curve}` shifts the colors of the picture from those of the color bar; "
            'render with tone="srgb"',
            SceneWarning,
            stacklevel=4,
        )
    return maps


def _color_bar(ax, color_map, label):
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    mappable = ScalarMappable(Normalize(*color_map.clim), ListedColormap(color_map.colors()))
    ax.figure.colorbar(mappable, ax=ax, label=label or color_map.label or "")


def _scale_bar(ax, image, text):
    """Draws a bar at the lower left, as long as the number of `text` in scene units."""
    number = str(text).split()[0] if str(text).split() else ""
    try:
        length = float(number)
    except ValueError:
        length = math.nan
    if not 0 < length < math.inf:
        raise SettingsError(
            f'`scale_bar` begins with its length in scene units, such as "1 mm", not {text!r}'
        )
    camera = image.camera
    if camera is None or camera.world_to_image[2, :3].any():
        raise SettingsError(
            "`scale_bar` needs an orthographic camera, such as sci.camera(bounds, parallel=True)"
        )
    to_image = camera.world_to_image
    pixels = length * math.sqrt(sum(float(x) ** 2 for x in to_image[0, :3])) / float(to_image[2, 3])
    width, height = image.size
    if pixels > width:
        raise SettingsError(f"a scale bar of {text} is {pixels:.0f} pixels long, the image only {width}")
    left, bottom = 0.04 * width, 0.94 * height
    line = {"color": "white", "linewidth": 5, "solid_capstyle": "butt"}
    ax.plot([left, left + pixels], [bottom, bottom], **line)
    ax.plot([left, left + pixels], [bottom, bottom], **{**line, "color": "black", "linewidth": 3})
    box = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 1.5}
    ax.text(left + pixels / 2, bottom - 0.02 * height, str(text), ha="center", va="bottom", bbox=box)
