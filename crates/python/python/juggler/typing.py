# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Types of the scene format for type checkers: dictionaries, and what fields accept.

Import this module under `TYPE_CHECKING`: nothing needs it at run time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol, Required, SupportsFloat, SupportsIndex
from typing import TypeAlias, TypedDict

if TYPE_CHECKING:
    from . import animate
    from . import backgrounds
    from . import cameras
    from . import curves
    from . import filters
    from . import integrators
    from . import lights
    from . import materials
    from . import samplers
    from . import scene_types
    from . import shapes
    from . import textures


class ArrayLike(Protocol):
    """Array of any library, such as NumPy, that converts itself to lists."""

    def tolist(self) -> Any: ...


Number: TypeAlias = "float | SupportsFloat | str | ValueForm"
"""Number, expression such as "=2 * radius", or value form."""
Integer: TypeAlias = "int | SupportsIndex | str | ValueForm"
"""Whole number, expression or value form."""
VectorLike: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Array of numbers, expression or value form."""
Vec2Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Two numbers, expression or value form."""
Vec3Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Three numbers, expression or value form."""
Vec4Like: TypeAlias = "Sequence[Number] | ArrayLike | str | ValueForm"
"""Four numbers, expression or value form."""
ColorLike: TypeAlias = "str | Number | Sequence[Number] | ArrayLike"
"""Color: "#rrggbb", a gray as one number, or three numbers in linear light."""
ColorInput: TypeAlias = "ColorLike | InputProductLike | TextureLike"
NumberInput: TypeAlias = "Number | InputProductLike | TextureLike"


class IntegratorDict(TypedDict, total=False):
    classic: ClassicIntegratorDict | ValueForm
    path: PathIntegratorDict | ValueForm
    direct: DirectIntegratorDict | ValueForm
    ambient_occlusion: AmbientOcclusionIntegratorDict | ValueForm
    albedo: AlbedoIntegratorDict | ValueForm
    normals: NormalsIntegratorDict | ValueForm
    depth: DepthIntegratorDict | ValueForm


Integrator: TypeAlias = "integrators.Classic | integrators.Path | integrators.Direct | integrators.AmbientOcclusion | integrators.Albedo | integrators.Normals | integrators.Depth"
IntegratorLike: TypeAlias = "Integrator | IntegratorDict | Literal['classic', 'path', 'direct', 'ambient_occlusion', 'albedo', 'normals', 'depth'] | ValueForm"


class ClassicIntegratorDict(TypedDict, total=False):
    max_depth: Integer
    min_weight: Number
    occlusion_distance: Number


class PathIntegratorDict(TypedDict, total=False):
    max_depth: Integer
    max_diffuse: Integer
    max_glossy: Integer
    max_specular: Integer
    max_volume: Integer
    roulette_depth: Integer
    light_samples: Integer
    camera_rays: Integer
    sampling: Literal["mis", "light", "bsdf"] | ValueForm
    clamp_direct: Number
    clamp_indirect: Number


class DirectIntegratorDict(TypedDict, total=False):
    pass


class AmbientOcclusionIntegratorDict(TypedDict, total=False):
    distance: Number


class AlbedoIntegratorDict(TypedDict, total=False):
    pass


class NormalsIntegratorDict(TypedDict, total=False):
    pass


class DepthIntegratorDict(TypedDict, total=False):
    far: Number


class SamplerDict(TypedDict, total=False):
    sobol: SobolSamplerDict | ValueForm
    stratified: StratifiedSamplerDict | ValueForm
    independent: IndependentSamplerDict | ValueForm
    blue_noise: BlueNoiseSamplerDict | ValueForm


Sampler: TypeAlias = "samplers.Sobol | samplers.Stratified | samplers.Independent | samplers.BlueNoise"
SamplerLike: TypeAlias = "Sampler | SamplerDict | Literal['sobol', 'stratified', 'independent', 'blue_noise'] | ValueForm"


class SobolSamplerDict(TypedDict, total=False):
    pass


class StratifiedSamplerDict(TypedDict, total=False):
    side: Integer


class IndependentSamplerDict(TypedDict, total=False):
    pass


class BlueNoiseSamplerDict(TypedDict, total=False):
    pass


class FilterDict(TypedDict, total=False):
    box: BoxFilterDict | ValueForm
    tent: TentFilterDict | ValueForm
    gaussian: GaussianFilterDict | ValueForm
    mitchell: MitchellFilterDict | ValueForm
    juggler: JugglerFilterDict | ValueForm


Filter: TypeAlias = "filters.Box | filters.Tent | filters.Gaussian | filters.Mitchell | filters.Juggler"
FilterLike: TypeAlias = "Filter | FilterDict | Literal['box', 'tent', 'gaussian', 'mitchell', 'juggler'] | ValueForm"


class BoxFilterDict(TypedDict, total=False):
    pass


class TentFilterDict(TypedDict, total=False):
    radius: Number


class GaussianFilterDict(TypedDict, total=False):
    radius: Number
    sigma: Number


class MitchellFilterDict(TypedDict, total=False):
    b: Number
    c: Number


class JugglerFilterDict(TypedDict, total=False):
    pass


class CurveDict(TypedDict, total=False):
    srgb: SrgbCurveDict | ValueForm
    gamma: GammaCurveDict | ValueForm
    linear: LinearCurveDict | ValueForm
    reinhard: ReinhardCurveDict | ValueForm
    aces: AcesCurveDict | ValueForm
    agx: AgxCurveDict | ValueForm
    pbr_neutral: PbrNeutralCurveDict | ValueForm


Curve: TypeAlias = "curves.Srgb | curves.Gamma | curves.Linear | curves.Reinhard | curves.Aces | curves.Agx | curves.PbrNeutral"
CurveLike: TypeAlias = "Curve | CurveDict | Literal['srgb', 'gamma', 'linear', 'reinhard', 'aces', 'agx', 'pbr_neutral'] | ValueForm"


class SrgbCurveDict(TypedDict, total=False):
    pass


class GammaCurveDict(TypedDict, total=False):
    gamma: Number


class LinearCurveDict(TypedDict, total=False):
    pass


class ReinhardCurveDict(TypedDict, total=False):
    white: Number


class AcesCurveDict(TypedDict, total=False):
    pass


class AgxCurveDict(TypedDict, total=False):
    look: Literal["base", "punchy", "golden"] | ValueForm


class PbrNeutralCurveDict(TypedDict, total=False):
    pass


class CameraDict(TypedDict, total=False):
    perspective: PerspectiveCameraDict | ValueForm
    thin_lens: ThinLensCameraDict | ValueForm
    orthographic: OrthographicCameraDict | ValueForm


Camera: TypeAlias = "cameras.Perspective | cameras.ThinLens | cameras.Orthographic"
CameraLike: TypeAlias = "Camera | CameraDict | Literal['perspective', 'thin_lens', 'orthographic'] | ValueForm"


class PerspectiveCameraDict(TypedDict, total=False):
    eye: Vec3Like
    look_at: Vec3Like
    direction: Vec3Like
    up: Vec3Like
    yaw_degrees: Number
    pitch_degrees: Number
    roll_degrees: Number
    move: MoveLike
    vertical_fov_degrees: Number
    horizontal_fov_degrees: Number
    screen: ScreenLike
    view_plane: ViewPlaneLike
    focal_length: Number
    sensor_width: Number
    fit_aspect: Number


class ThinLensCameraDict(TypedDict, total=False):
    eye: Vec3Like
    look_at: Vec3Like
    direction: Vec3Like
    up: Vec3Like
    yaw_degrees: Number
    pitch_degrees: Number
    roll_degrees: Number
    move: MoveLike
    vertical_fov_degrees: Number
    horizontal_fov_degrees: Number
    screen: ScreenLike
    view_plane: ViewPlaneLike
    focal_length: Number
    sensor_width: Number
    fit_aspect: Number
    lens_radius: Number
    f_stop: Number
    unit: Number
    focus_on: str | ValueForm
    focus_distance: Number


class OrthographicCameraDict(TypedDict, total=False):
    eye: Vec3Like
    look_at: Vec3Like
    direction: Vec3Like
    up: Vec3Like
    yaw_degrees: Number
    pitch_degrees: Number
    roll_degrees: Number
    move: MoveLike
    height: Number
    width: Number
    fit_aspect: Number


class BackgroundDict(TypedDict, total=False):
    solid: SolidBackgroundDict | ValueForm
    gradient: GradientBackgroundDict | ValueForm
    dome: DomeBackgroundDict | ValueForm
    environment: EnvironmentBackgroundDict | ValueForm
    sky: SkyBackgroundDict | ValueForm
    studio: StudioBackgroundDict | ValueForm


Background: TypeAlias = "backgrounds.Solid | backgrounds.Gradient | backgrounds.Dome | backgrounds.Environment | backgrounds.Sky | backgrounds.Studio"
BackgroundLike: TypeAlias = "Background | BackgroundDict | Literal['solid', 'gradient', 'dome', 'sky', 'studio'] | ValueForm"


class SolidBackgroundDict(TypedDict, total=False):
    color: ColorLike


class GradientBackgroundDict(TypedDict, total=False):
    horizon: ColorLike
    zenith: ColorLike
    nadir: ColorLike
    axis: Vec3Like
    blend: Literal["sine", "sine_squared"] | ValueForm


class DomeBackgroundDict(TypedDict, total=False):
    radius: Number
    bottom: ColorLike
    top: ColorLike


class EnvironmentBackgroundDict(TypedDict, total=False):
    file: Required[str | ValueForm]
    scale: Number
    rotation_degrees: Number
    up: Vec3Like
    visible_as: ColorLike


class SkyBackgroundDict(TypedDict, total=False):
    sun_elevation_degrees: Number
    sun_azimuth_degrees: Number
    sun_direction: Vec3Like
    turbidity: Number
    ground_albedo: ColorLike
    intensity: Number
    sun: bool | ValueForm
    up: Vec3Like


class StudioBackgroundDict(TypedDict, total=False):
    scale: Number
    rotation_degrees: Number
    up: Vec3Like
    visible_as: ColorLike


class TextureDict(TypedDict, total=False):
    image: ImageTextureDict | ValueForm
    attribute: AttributeTextureDict | ValueForm
    constant: ConstantTextureDict | ValueForm
    direction: DirectionTextureDict | ValueForm
    checker: CheckerTextureDict | ValueForm
    gradient: GradientTextureDict | ValueForm
    ramp: RampTextureDict | ValueForm
    mix: MixTextureDict | ValueForm
    noise: NoiseTextureDict | ValueForm
    fbm: FbmTextureDict | ValueForm
    turbulence: TurbulenceTextureDict | ValueForm
    marble: MarbleTextureDict | ValueForm
    wood: WoodTextureDict | ValueForm
    voronoi: VoronoiTextureDict | ValueForm
    brick: BrickTextureDict | ValueForm
    dots: DotsTextureDict | ValueForm
    wave: WaveTextureDict | ValueForm
    triplanar: TriplanarTextureDict | ValueForm
    uv: UvTextureDict | ValueForm


Texture: TypeAlias = "textures.Image | textures.Attribute | textures.Constant | textures.Direction | textures.Checker | textures.Gradient | textures.Ramp | textures.Mix | textures.Noise | textures.Fbm | textures.Turbulence | textures.Marble | textures.Wood | textures.Voronoi | textures.Brick | textures.Dots | textures.Wave | textures.Triplanar | textures.Uv"
TextureLike: TypeAlias = "Texture | TextureDict | Literal['attribute', 'constant', 'direction', 'checker', 'gradient', 'ramp', 'mix', 'noise', 'fbm', 'turbulence', 'marble', 'wood', 'voronoi', 'brick', 'dots', 'wave', 'triplanar', 'uv'] | ValueForm"


class ImageTextureDict(TypedDict, total=False):
    file: Required[str | ValueForm]
    color_space: Literal["auto", "srgb", "linear"] | ValueForm
    channel: Literal["rgb", "r", "g", "b", "a", "luminance"] | ValueForm
    invert: bool | ValueForm
    factor: Number
    wrap: Literal["repeat", "mirror", "clamp", "black"] | ValueForm
    wrap_v: Literal["repeat", "mirror", "clamp", "black"] | ValueForm
    filter: Literal["nearest", "bilinear", "trilinear"] | ValueForm
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class AttributeTextureDict(TypedDict, total=False):
    name: str | ValueForm
    channel: Literal["rgb", "r", "g", "b", "a", "luminance"] | ValueForm


class ConstantTextureDict(TypedDict, total=False):
    color: ColorInput


class DirectionTextureDict(TypedDict, total=False):
    of: ColorInput
    turns: Number


class CheckerTextureDict(TypedDict, total=False):
    size: Number
    even: ColorInput
    odd: ColorInput
    space: Literal["uv", "local", "world"] | ValueForm
    axes: Literal["xyz", "xz", "xy", "yz"] | ValueForm
    offset: Vec3Like


class GradientTextureDict(TypedDict, total=False):
    stops: Sequence[StopLike] | ValueForm
    space: Literal["uv", "local", "world"] | ValueForm
    start: Vec3Like
    end: Vec3Like
    shape: Literal["linear", "radial"] | ValueForm


class RampTextureDict(TypedDict, total=False):
    input: NumberInput
    stops: Sequence[StopLike] | ValueForm
    interpolation: Literal["linear", "smooth", "hold"] | ValueForm


class MixTextureDict(TypedDict, total=False):
    a: ColorInput
    b: ColorInput
    amount: NumberInput
    mode: Literal["mix", "add", "subtract", "multiply", "screen", "difference", "lighten", "darken"] | ValueForm


class NoiseTextureDict(TypedDict, total=False):
    low: ColorInput
    high: ColorInput
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class FbmTextureDict(TypedDict, total=False):
    low: ColorInput
    high: ColorInput
    octaves: Integer
    lacunarity: Number
    gain: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class TurbulenceTextureDict(TypedDict, total=False):
    low: ColorInput
    high: ColorInput
    octaves: Integer
    lacunarity: Number
    gain: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class MarbleTextureDict(TypedDict, total=False):
    stone: ColorInput
    vein: ColorInput
    distortion: Number
    sharpness: Number
    octaves: Integer
    lacunarity: Number
    gain: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class WoodTextureDict(TypedDict, total=False):
    light: ColorInput
    dark: ColorInput
    distortion: Number
    grain: Number
    octaves: Integer
    lacunarity: Number
    gain: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class VoronoiTextureDict(TypedDict, total=False):
    low: ColorInput
    high: ColorInput
    feature: Literal["f1", "f2", "f2_minus_f1", "cell"] | ValueForm
    metric: Literal["euclidean", "manhattan", "chebyshev"] | ValueForm
    jitter: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class BrickTextureDict(TypedDict, total=False):
    brick: ColorInput
    mortar: ColorInput
    width: Number
    height: Number
    mortar_width: Number
    shift: Number
    variation: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class DotsTextureDict(TypedDict, total=False):
    dot: ColorInput
    ground: ColorInput
    radius: Number
    softness: Number
    jitter: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class WaveTextureDict(TypedDict, total=False):
    low: ColorInput
    high: ColorInput
    shape: Literal["bands", "rings"] | ValueForm
    profile: Literal["sine", "saw", "triangle", "square"] | ValueForm
    distortion: Number
    octaves: Integer
    lacunarity: Number
    gain: Number
    seed: Integer
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class TriplanarTextureDict(TypedDict, total=False):
    texture: ColorInput
    sharpness: Number
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class UvTextureDict(TypedDict, total=False):
    space: Literal["uv", "local", "world"] | ValueForm
    uv_set: Integer
    scale: Number | Vec3Like
    rotate_degrees: Vec3Like
    offset: Vec3Like
    matrix: VectorLike


class MaterialDict(TypedDict, total=False):
    phong: PhongMaterialDict | ValueForm
    diffuse: DiffuseMaterialDict | ValueForm
    conductor: ConductorMaterialDict | ValueForm
    dielectric: DielectricMaterialDict | ValueForm
    plastic: PlasticMaterialDict | ValueForm
    velvet: VelvetMaterialDict | ValueForm
    translucent: TranslucentMaterialDict | ValueForm
    principled: PrincipledMaterialDict | ValueForm
    emissive: EmissiveMaterialDict | ValueForm
    unlit: UnlitMaterialDict | ValueForm
    checkerboard: CheckerboardMaterialDict | ValueForm
    mask: MaskMaterialDict | ValueForm
    mix: MixMaterialDict | ValueForm
    normal_map: NormalMapMaterialDict | ValueForm
    bump_map: BumpMapMaterialDict | ValueForm
    boundary: BoundaryMaterialDict | ValueForm


Material: TypeAlias = "materials.Phong | materials.Diffuse | materials.Conductor | materials.Dielectric | materials.Plastic | materials.Velvet | materials.Translucent | materials.Principled | materials.Emissive | materials.Unlit | materials.Checkerboard | materials.Mask | materials.Mix | materials.NormalMap | materials.BumpMap | materials.Boundary"
MaterialLike: TypeAlias = "Material | MaterialDict | Literal['phong', 'diffuse', 'conductor', 'dielectric', 'plastic', 'velvet', 'translucent', 'principled', 'emissive', 'unlit', 'checkerboard', 'mask', 'mix', 'normal_map', 'bump_map', 'boundary'] | ValueForm"


class PhongMaterialDict(TypedDict, total=False):
    emission: ColorInput
    ambient: ColorInput
    occlusion: Number
    diffuse: ColorInput
    diffuse_weight: Number
    diffuse_normalization: Literal["one", "inverse_pi"] | ValueForm
    specular: NumberInput
    highlight_color: ColorInput
    shininess: Number
    highlight: Literal["phong", "phong_cosine"] | ValueForm
    reflection: ColorInput
    glossy: SpreadLike
    transparency: ColorInput
    blurry: SpreadLike
    ior: Number
    fresnel: bool | ValueForm
    both_sides: bool | ValueForm


class DiffuseMaterialDict(TypedDict, total=False):
    reflectance: ColorInput
    roughness: NumberInput
    sides: Literal["both", "front", "black_behind"] | ValueForm


class ConductorMaterialDict(TypedDict, total=False):
    metal: Literal["aluminum", "brass", "chromium", "cobalt", "copper", "gold", "iron", "nickel", "platinum", "silver", "titanium", "tungsten", "zinc", "aluminium"] | ValueForm
    eta: ColorLike
    k: ColorLike
    reflectance: ColorInput
    edge_tint: ColorInput
    grazing: ColorLike
    roughness: NumberInput
    anisotropy: NumberInput
    anisotropy_rotation: NumberInput
    energy_compensation: bool | ValueForm
    sides: Literal["both", "front", "black_behind"] | ValueForm


class DielectricMaterialDict(TypedDict, total=False):
    ior: Number
    dispersion: Number
    roughness: NumberInput
    anisotropy: NumberInput
    anisotropy_rotation: NumberInput
    reflection_tint: ColorInput
    transmission_tint: ColorInput
    thin: bool | ValueForm
    medium: MediumLike
    priority: Integer
    energy_compensation: bool | ValueForm


class PlasticMaterialDict(TypedDict, total=False):
    reflectance: ColorInput
    diffuse_roughness: NumberInput
    ior: Number
    roughness: NumberInput
    anisotropy: NumberInput
    anisotropy_rotation: NumberInput
    reflection_tint: ColorInput
    nonlinear: bool | ValueForm
    sides: Literal["both", "front", "black_behind"] | ValueForm


class VelvetMaterialDict(TypedDict, total=False):
    sheen_color: ColorInput
    sheen_roughness: NumberInput
    reflectance: ColorInput
    roughness: NumberInput
    sides: Literal["both", "front", "black_behind"] | ValueForm


class TranslucentMaterialDict(TypedDict, total=False):
    reflectance: ColorInput
    transmittance: ColorInput


class PrincipledMaterialDict(TypedDict, total=False):
    base_color: ColorInput
    metallic: NumberInput
    roughness: NumberInput
    ior: Number
    dispersion: Number
    specular: NumberInput
    specular_color: ColorInput
    anisotropy: NumberInput
    anisotropy_rotation: NumberInput
    clearcoat: NumberInput
    clearcoat_roughness: NumberInput
    clearcoat_ior: Number
    clearcoat_normal: ColorInput
    clearcoat_normal_scale: Number
    sheen_color: ColorInput
    sheen_roughness: NumberInput
    iridescence: NumberInput
    iridescence_ior: Number
    iridescence_thickness: NumberInput
    transmission: NumberInput
    diffuse_transmission: NumberInput
    diffuse_transmission_color: ColorInput
    thin: bool | ValueForm
    medium: MediumLike
    priority: Integer
    emissive: ColorInput
    emissive_strength: Number
    opacity: NumberInput
    alpha_cutoff: Number
    sides: Literal["both", "front", "black_behind"] | ValueForm
    energy_compensation: bool | ValueForm


class EmissiveMaterialDict(TypedDict, total=False):
    radiance: ColorInput
    scale: Number
    sides: Literal["front", "both"] | ValueForm
    material: str | MaterialLike


class UnlitMaterialDict(TypedDict, total=False):
    color: ColorInput
    opacity: NumberInput


class CheckerboardMaterialDict(TypedDict, total=False):
    size: Number
    plane: Literal["xz", "xy", "yz"] | ValueForm
    even: str | MaterialLike
    odd: str | MaterialLike


class MaskMaterialDict(TypedDict, total=False):
    opacity: NumberInput
    cutoff: Number
    material: str | MaterialLike


class MixMaterialDict(TypedDict, total=False):
    amount: NumberInput
    a: str | MaterialLike
    b: str | MaterialLike


class NormalMapMaterialDict(TypedDict, total=False):
    texture: ColorInput
    strength: NumberInput
    material: str | MaterialLike


class BumpMapMaterialDict(TypedDict, total=False):
    height: NumberInput
    distance: Number
    material: str | MaterialLike


class BoundaryMaterialDict(TypedDict, total=False):
    medium: MediumLike
    priority: Integer


class ShapeDict(TypedDict, total=False):
    sphere: SphereShapeDict | ValueForm
    plane: PlaneShapeDict | ValueForm
    disk: DiskShapeDict | ValueForm
    rectangle: RectangleShapeDict | ValueForm
    triangle: TriangleShapeDict | ValueForm
    polygon: PolygonShapeDict | ValueForm
    cuboid: CuboidShapeDict | ValueForm
    cylinder: CylinderShapeDict | ValueForm
    tube: TubeShapeDict | ValueForm
    mesh: MeshShapeDict | ValueForm


Shape: TypeAlias = "shapes.Sphere | shapes.Plane | shapes.Disk | shapes.Rectangle | shapes.Triangle | shapes.Polygon | shapes.Cuboid | shapes.Cylinder | shapes.Tube | shapes.Mesh"
ShapeLike: TypeAlias = "Shape | ShapeDict | Literal['sphere', 'plane', 'disk', 'rectangle', 'cuboid', 'cylinder', 'tube', 'mesh'] | ValueForm"


class SphereShapeDict(TypedDict, total=False):
    radius: Number


class PlaneShapeDict(TypedDict, total=False):
    pass


class DiskShapeDict(TypedDict, total=False):
    radius: Number
    inner_radius: Number


class RectangleShapeDict(TypedDict, total=False):
    size: Vec2Like


class TriangleShapeDict(TypedDict, total=False):
    vertices: Required[Sequence[Vec3Like] | ArrayLike | str | ValueForm]
    normals: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    uvs: Sequence[Vec2Like] | ArrayLike | str | ValueForm


class PolygonShapeDict(TypedDict, total=False):
    vertices: Required[Sequence[Vec3Like] | ArrayLike | str | ValueForm]


class CuboidShapeDict(TypedDict, total=False):
    min: Vec3Like
    max: Vec3Like


class CylinderShapeDict(TypedDict, total=False):
    radius: Number
    y_min: Number
    y_max: Number
    capped: bool | ValueForm


class TubeShapeDict(TypedDict, total=False):
    radius: Number


class MeshShapeDict(TypedDict, total=False):
    file: str | ValueForm
    positions: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    triangles: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    normals: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    uvs: Sequence[Vec2Like] | ArrayLike | str | ValueForm
    uvs1: Sequence[Vec2Like] | ArrayLike | str | ValueForm
    tangents: Sequence[Vec4Like] | ArrayLike | str | ValueForm
    attributes: Mapping[str, MeshAttributeLike] | ValueForm
    crease_angle_degrees: Number
    morphs: Sequence[MorphLike] | ValueForm


class LightDict(TypedDict, total=False):
    ambient: AmbientLightDict | ValueForm
    area: AreaLightDict | ValueForm
    directional: DirectionalLightDict | ValueForm
    point: PointLightDict | ValueForm
    spot: SpotLightDict | ValueForm


Light: TypeAlias = "lights.Ambient | lights.Area | lights.Directional | lights.Point | lights.Spot"
LightLike: TypeAlias = "Light | LightDict | Literal['ambient', 'area', 'directional', 'point', 'spot'] | ValueForm"


class AmbientLightDict(TypedDict, total=False):
    color: ColorLike
    intensity: Number


class AreaLightDict(TypedDict, total=False):
    shape: AreaShapeLike
    position: Vec3Like
    direction: Vec3Like
    look_at: Vec3Like
    color: ColorLike
    radiance: Number
    power: Number
    light_group: str | ValueForm


class DirectionalLightDict(TypedDict, total=False):
    direction: Vec3Like
    color: ColorLike
    intensity: Number
    angle_degrees: Number
    samples: Integer
    light_group: str | ValueForm


class PointLightDict(TypedDict, total=False):
    position: Vec3Like
    color: ColorLike
    intensity: Number
    power: Number
    attenuation: AttenuationLike
    range: Number
    extent: ExtentLike
    samples: Integer
    ies: IesLike
    light_group: str | ValueForm


class SpotLightDict(TypedDict, total=False):
    position: Vec3Like
    direction: Vec3Like
    color: ColorLike
    intensity: Number
    power: Number
    attenuation: AttenuationLike
    range: Number
    beam_degrees: Number
    cutoff_degrees: Number
    falloff: Literal["linear", "squared_cosine", "smooth_cosine"] | ValueForm
    beam_exponent: Number
    extent: ExtentLike
    samples: Integer
    ies: IesLike
    light_group: str | ValueForm


class ValueFormDict(TypedDict, total=False):
    animate: Mapping[str, Any]
    along: Mapping[str, Any]
    joint: Mapping[str, Any]
    posed: Mapping[str, Any]


ValueForm: TypeAlias = "animate.Keys | animate.Along | animate.Joint | animate.Posed | ValueFormDict"


class KeysDict(TypedDict, total=False):
    keys: Required[Sequence[tuple[float | str, Any] | tuple[float | str, Any, Any] | list[Any] | ValueForm] | ValueForm]
    at: Number
    interpolation: Literal["step", "linear", "smooth", "slerp"] | ValueForm
    ease: Literal["linear", "in", "out", "in_out", "step"] | Vec4Like
    repeat: Literal["once", "loop", "ping_pong"] | ValueForm


class AlongDict(TypedDict, total=False):
    path: Required[str | ValueForm]
    at: Required[Number]


JointDict = TypedDict(
    "JointDict",
    {
        "from": "Required[Vec3Like]",
        "to": "Required[Vec3Like]",
        "lengths": "Required[Vec2Like]",
        "plane_normal": "Required[Vec3Like]",
        "keep_lengths": "bool | ValueForm",
    },
    total=False,
)


class PosedDict(TypedDict, total=False):
    file: Required[str | ValueForm]
    node: Required[str | ValueForm]
    animation: Integer
    at: Number
    repeat: Literal["loop", "once"] | ValueForm
    point: Vec3Like
    vector: Vec3Like


class SceneDict(TypedDict, total=False):
    version: Required[Literal[1]]
    title: str
    description: str
    include: str | Sequence[str]
    animation: AnimationLike
    variables: Mapping[str, Number | VectorLike]
    paths: Mapping[str, PathLike]
    render: RenderSettingsLike
    tone: ToneLike
    camera: CameraLike
    cameras: Mapping[str, CameraLike]
    background: ColorLike | BackgroundLike
    background_light_group: str | ValueForm
    textures: Mapping[str, TextureLike]
    materials: Mapping[str, MaterialLike]
    groups: Mapping[str, Sequence[ObjectLike] | ValueForm]
    lights: Sequence[LightLike] | ValueForm
    objects: Sequence[ObjectLike] | ValueForm


SceneLike: TypeAlias = "scene_types.Scene | SceneDict"


class PathDict(TypedDict, total=False):
    points: Required[Sequence[Vec3Like] | ArrayLike | str | ValueForm]
    closed: bool | ValueForm


PathLike: TypeAlias = "scene_types.Path | PathDict | ValueForm"


class RenderSettingsDict(TypedDict, total=False):
    size: Vec2Like
    samples: Integer
    seed: Integer
    camera: str | ValueForm
    shutter: Vec2Like
    transparent: bool | ValueForm
    integrator: IntegratorLike
    sampler: SamplerLike
    filter: FilterLike


RenderSettingsLike: TypeAlias = "scene_types.RenderSettings | RenderSettingsDict | ValueForm"


class ToneDict(TypedDict, total=False):
    curve: CurveLike
    exposure_stops: Number
    white_balance: WhiteBalanceLike
    primaries: Literal["srgb", "display_p3", "rec2020", "acescg"] | ValueForm
    dither: bool | ValueForm
    backdrop: ColorLike


ToneLike: TypeAlias = "scene_types.Tone | ToneDict | ValueForm"


class WhiteBalanceDict(TypedDict, total=False):
    kelvin: Number
    tint: Number


WhiteBalanceLike: TypeAlias = "scene_types.WhiteBalance | WhiteBalanceDict | ValueForm"


class MoveDict(TypedDict, total=False):
    right: Number
    up: Number
    forward: Number


MoveLike: TypeAlias = "scene_types.Move | MoveDict | ValueForm"


class ScreenDict(TypedDict, total=False):
    width: Required[Number]
    distance: Required[Number]


ScreenLike: TypeAlias = "scene_types.Screen | ScreenDict | ValueForm"


class ViewPlaneDict(TypedDict, total=False):
    width: Required[Number]
    height: Required[Number]
    distance: Required[Number]


ViewPlaneLike: TypeAlias = "scene_types.ViewPlane | ViewPlaneDict | ValueForm"


class InputProductDict(TypedDict, total=False):
    texture: str | TextureLike
    factor: ColorLike
    attribute: str | ValueForm


InputProductLike: TypeAlias = "scene_types.InputProduct | InputProductDict | ValueForm"


class StopDict(TypedDict, total=False):
    position: Required[Number]
    color: Required[ColorInput]


StopLike: TypeAlias = "scene_types.Stop | StopDict | ValueForm"


class SpreadDict(TypedDict, total=False):
    half_angle_degrees: Number
    rays: Integer


SpreadLike: TypeAlias = "scene_types.Spread | SpreadDict | ValueForm"


class MediumDict(TypedDict, total=False):
    absorption: ColorLike
    scattering: ColorLike
    anisotropy: Number
    color: ColorLike
    distance: Number


MediumLike: TypeAlias = "scene_types.Medium | MediumDict | ValueForm"


class ObjectDict(TypedDict, total=False):
    name: str | ValueForm
    shape: ShapeLike
    group: str | ValueForm
    objects: Sequence[ObjectLike] | ValueForm
    chain: ChainLike
    limb: LimbLike
    model: ModelLike
    instances: InstancesLike
    transform: Sequence[TransformStepLike] | TransformStepLike
    material: str | MaterialLike
    light_group: str | ValueForm
    shadow_catcher: bool | ValueForm
    visible: bool | Number


ObjectLike: TypeAlias = "scene_types.Object | ObjectDict | ValueForm"


class MeshAttributeDict(TypedDict, total=False):
    domain: Literal["vertex", "face"] | ValueForm
    channels: Required[Integer]
    data: Required[AttributeArrayLike]


MeshAttributeLike: TypeAlias = "scene_types.MeshAttribute | MeshAttributeDict | ValueForm"


class MorphDict(TypedDict, total=False):
    file: str | ValueForm
    positions: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    normals: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    tangents: Sequence[Vec4Like] | ArrayLike | str | ValueForm
    weight: Number


MorphLike: TypeAlias = "scene_types.Morph | MorphDict | ValueForm"


ChainDict = TypedDict(
    "ChainDict",
    {
        "from": "Required[ControlSphereLike]",
        "to": "Required[ControlSphereLike]",
        "count": "Required[Integer]",
        "include_last": "bool | ValueForm",
    },
    total=False,
)


ChainLike: TypeAlias = "scene_types.Chain | ChainDict | ValueForm"


class ControlSphereDict(TypedDict, total=False):
    center: Required[Vec3Like]
    radius: Required[Number]


ControlSphereLike: TypeAlias = "scene_types.ControlSphere | ControlSphereDict | ValueForm"


LimbDict = TypedDict(
    "LimbDict",
    {
        "from": "Required[Vec3Like]",
        "to": "Required[Vec3Like]",
        "lengths": "Required[Vec2Like]",
        "plane_normal": "Required[Vec3Like]",
        "counts": "Vec2Like",
        "keep_lengths": "bool | ValueForm",
        "radii": "Required[Vec3Like]",
    },
    total=False,
)


LimbLike: TypeAlias = "scene_types.Limb | LimbDict | ValueForm"


class ModelDict(TypedDict, total=False):
    file: Required[str | ValueForm]
    scene: Integer
    variant: Integer
    animation: Integer
    at: Number
    repeat: Literal["loop", "once"] | ValueForm
    materials: Mapping[str, str | MaterialLike] | ValueForm
    nodes: Sequence[str | ValueForm] | ValueForm
    hide: Sequence[str | ValueForm] | ValueForm
    lights: bool | ValueForm
    photometric: bool | ValueForm


ModelLike: TypeAlias = "scene_types.Model | ModelDict | ValueForm"


class InstancesDict(TypedDict, total=False):
    file: str | ValueForm
    positions: Sequence[Vec3Like] | ArrayLike | str | ValueForm
    rotations: Sequence[Vec4Like] | ArrayLike | str | ValueForm
    scales: Sequence[Number | Vec3Like] | ArrayLike | ValueForm
    matrices: Sequence[VectorLike] | ArrayLike | str | ValueForm
    colors: Sequence[Vec4Like] | ArrayLike | str | ValueForm
    end_colors: Sequence[Vec4Like] | ArrayLike | str | ValueForm
    attributes: Mapping[str, InstanceAttributeLike] | ValueForm


InstancesLike: TypeAlias = "scene_types.Instances | InstancesDict | ValueForm"


class InstanceAttributeDict(TypedDict, total=False):
    channels: Required[Integer]
    data: Required[AttributeArrayLike]


InstanceAttributeLike: TypeAlias = "scene_types.InstanceAttribute | InstanceAttributeDict | ValueForm"


class AxisRotationDict(TypedDict, total=False):
    axis: Required[Vec3Like]
    degrees: Required[Number]


AxisRotationLike: TypeAlias = "scene_types.AxisRotation | AxisRotationDict | ValueForm"


class AttenuationDict(TypedDict, total=False):
    constant: Number
    linear: Number
    quadratic: Number


AttenuationLike: TypeAlias = "scene_types.Attenuation | AttenuationDict | ValueForm"


class IesDict(TypedDict, total=False):
    file: Required[str | ValueForm]
    direction: Vec3Like
    rotation_degrees: Number
    absolute: bool | ValueForm


IesLike: TypeAlias = "scene_types.Ies | IesDict | ValueForm"


class AnimationDict(TypedDict, total=False):
    frames: int
    frames_per_second: float


AnimationLike: TypeAlias = "scene_types.Animation | AnimationDict"


class AttributeArrayDict(TypedDict, total=False):
    u8: VectorLike
    u16: VectorLike
    f32: VectorLike


AttributeArrayLike: TypeAlias = "AttributeArrayDict | ValueForm"


class TransformStepDict(TypedDict, total=False):
    translate: Vec3Like
    rotate: AxisRotationLike | Vec3Like
    scale: Number | Vec3Like
    orient: Vec4Like
    look_at: LookAtLike
    matrix: VectorLike


TransformStepLike: TypeAlias = "TransformStepDict | ValueForm"


LookAtDict = TypedDict(
    "LookAtDict",
    {
        "from": "Vec3Like",
        "to": "Required[Vec3Like]",
        "up": "Vec3Like",
        "forward": "Vec3Like",
    },
    total=False,
)


LookAtLike: TypeAlias = "LookAtDict | ValueForm"


class AreaShapeRectangleDict(TypedDict, total=False):
    size: Required[Vec2Like]


class AreaShapeDiskDict(TypedDict, total=False):
    radius: Required[Number]


class AreaShapeSphereDict(TypedDict, total=False):
    radius: Required[Number]


class AreaShapeDict(TypedDict, total=False):
    rectangle: AreaShapeRectangleDict | ValueForm
    disk: AreaShapeDiskDict | ValueForm
    sphere: AreaShapeSphereDict | ValueForm


AreaShapeLike: TypeAlias = "shapes.Rectangle | shapes.Disk | shapes.Sphere | AreaShapeDict | ValueForm"


class ExtentSphereDict(TypedDict, total=False):
    radius: Required[Number]


class ExtentSquareDict(TypedDict, total=False):
    side: Required[Number]


class ExtentDict(TypedDict, total=False):
    sphere: ExtentSphereDict | ValueForm
    square: ExtentSquareDict | ValueForm


ExtentLike: TypeAlias = "ExtentDict | ValueForm"
