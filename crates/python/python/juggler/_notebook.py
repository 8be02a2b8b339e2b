"""Images in notebooks."""

import base64
import html as escapes

from juggler._progress import Display, duration

# Seconds before the first preview, so that short renders show nothing but the image.
_DELAY = 0.75
# Width of previews and of thumbnails of AOVs, in pixels.
_PREVIEW_WIDTH = 800
_THUMBNAIL_WIDTH = 160


def png(data, width=None):
    """Returns the HTML of a PNG file."""
    style = f' style="width:{width}px"' if width else ' style="max-width:100%"'
    return f'<img{style} src="data:image/png;base64,{base64.b64encode(data).decode()}">'


def html(image):
    """Returns the HTML of an image with thumbnails of its AOVs."""
    thumbnails = []
    for name in image.aovs:
        picture = png(image._native.thumbnail(name, _THUMBNAIL_WIDTH), _THUMBNAIL_WIDTH)
        name = escapes.escape(name)
        figure = f"{picture}<figcaption>{name}</figcaption>"
        thumbnails.append(f'<figure style="display:inline-block;margin:4px">{figure}</figure>')
    width, height = image.size
    caption = f"{width} × {height}, {image.stats['samples']:g} samples, hash {image.hash[:12]}"
    return f"<div>{png(image._repr_png_())}<div><small>{caption}</small></div>{''.join(thumbnails)}</div>"


class LiveImage(Display):
    """Image that grows in a notebook, with a bar. At the end the image stays."""

    is_live = True

    def follow(self, steps):
        """Shows the images of a progressive render, and returns the last one."""
        import time

        from IPython.display import HTML, display

        start, handle, image = time.monotonic(), None, None
        for image in steps:
            seconds = time.monotonic() - start
            if handle is None and seconds >= _DELAY:
                handle = display(HTML(self._html(image, seconds)), display_id=True)
            elif handle is not None:
                handle.update(HTML(self._html(image, seconds)))
        if handle is not None:
            handle.update(HTML(png(image._repr_png_())))
        return image

    def _html(self, image, seconds):
        samples = image.stats["samples"]
        return (
            f"{png(image._native.encode('png', _PREVIEW_WIDTH))}"
            f"<div><small>{samples:.1f} samples, {duration(seconds)}</small></div>"
        )
