"""Scientific pictures: surfaces, spheres, arrows and tubes colored by values, with views of them.

obj = juggler.sci.surface(vertices, faces, values=pressure, cmap="viridis", clim=(0, 5))
scene = juggler.Scene(objects=[obj], camera=juggler.sci.camera(obj.bounds, view="isometric"))
juggler.render(scene).plot(colorbar=True)
"""

from ._color_maps import NAMES as color_maps
from ._sci import arrows, spheres, surface, tubes
from ._values import ColorMap
from ._views import axes, camera, flat

__all__ = ["ColorMap", "arrows", "axes", "camera", "color_maps", "flat", "spheres", "surface", "tubes"]

for _public in (ColorMap, arrows, axes, camera, flat, spheres, surface, tubes):
    _public.__module__ = __name__
del _public
