"""Names of the package, for editors and type checkers; `__init__.py` loads them when they are first used."""

from . import animate as animate
from . import backgrounds as backgrounds
from . import cameras as cameras
from . import cluster as cluster
from . import curves as curves
from . import filters as filters
from . import integrators as integrators
from . import lights as lights
from . import materials as materials
from . import samplers as samplers
from . import scene_types as scene_types
from . import sci as sci
from . import shapes as shapes
from . import textures as textures
from .scene_types import *
from juggler._array_nodes import PerFace as PerFace
from juggler._api import (
    __version__ as __version__,
    examples as examples,
    frames as frames,
    models as models,
    render as render,
    render_movie as render_movie,
    show_config as show_config,
)
from juggler._camera import Camera as Camera
from juggler._comparison import Comparison as Comparison, compare as compare
from juggler._denoise import denoise as denoise
from juggler._errors import (
    Cancelled as Cancelled,
    FileError as FileError,
    InternalError as InternalError,
    MemoryBudgetError as MemoryBudgetError,
    MergeError as MergeError,
    Problem as Problem,
    SceneError as SceneError,
    SceneWarning as SceneWarning,
    SettingsError as SettingsError,
)
from juggler._image import Image as Image
from juggler._partial_render import PartialRender as PartialRender, merge as merge
from juggler._interop import (
    from_gltf as from_gltf,
    from_meshio as from_meshio,
    from_open3d as from_open3d,
    from_trimesh as from_trimesh,
)
from juggler._probe import Probe as Probe
from juggler._progress import Progress as Progress
from juggler._pyvista import from_pyvista as from_pyvista
from juggler._renderer import Renderer as Renderer
from juggler._trace import trace_nodes as trace_nodes
from juggler._view import View as View, view as view
