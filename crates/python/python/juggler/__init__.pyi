from . import animate as animate
from . import backgrounds as backgrounds
from . import cameras as cameras
from . import curves as curves
from . import filters as filters
from . import integrators as integrators
from . import lights as lights
from . import materials as materials
from . import samplers as samplers
from . import scene_types as scene_types
from . import shapes as shapes
from . import textures as textures
from .scene_types import *
