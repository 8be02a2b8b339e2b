"""Uses of the classes that type checkers accept, and the types that they infer.

pyright --project crates/python/tests/typed
"""

from concurrent.futures import ProcessPoolExecutor
from typing import assert_type

import juggler as jg
from juggler import Object, Scene, animate, cameras, lights, materials, sci, shapes, textures


class Array:
    """Array as NumPy has them."""

    def tolist(self) -> list[list[float]]:
        return [[0, 1, 2]]


scene = Scene(
    render=jg.RenderSettings(size=(640, 360), samples=64),
    camera=cameras.Perspective(eye=(1.6, 2.6, 7), look_at=(0, 0.75, 0), vertical_fov_degrees=27),
    textures={"tiles": textures.Checker(size=1.2, even="#b8ae9c", odd="#34404c")},
    materials={
        "floor": materials.Phong(diffuse="tiles"),
        "gold": materials.Conductor(metal="gold", roughness=0.2),
    },
    lights=[lights.Point(position=(-4, 7, 5), intensity=75)],
    objects=[
        Object(shapes.Plane(), material="floor"),
        Object(shapes.Sphere(), material="gold").translate(0, 1, 0),
    ],
)
assert_type(scene.replace(render=scene.render.replace(samples=256)), Scene)
scene.camera.replace(eye=(0, 2, 6))
scene.objects[0].translate(0, 1, 0).rotate("y", 30).scale(2)

# Arrays, and objects made of them.
tinted = shapes.Mesh(positions=Array(), attributes={"color": Array(), "part": jg.PerFace(Array())})
jg.Instances(matrices=Array(), attributes={"heat": Array()})
textures.Image(array=Array(), color_space="linear")
surface = sci.surface(Array(), Array(), values=[1, 2, 3], cmap="viridis", clim=(0, 5), nan="#808080")
assert_type(surface, Object)
assert_type(jg.from_gltf("car.glb", variant="red", lenient=True), Scene)
view = sci.camera(surface.bounds, view="+x", parallel=True)
jg.render(Scene(objects=[surface, sci.axes(surface)], camera=view), **sci.flat()).plot(colorbar=True)

# Arrays, expressions, value forms, names and dictionaries.
mesh = shapes.Mesh(positions=Array(), triangles=[[0, 1, 2]])
assert_type(mesh.replace(crease_angle_degrees=30), shapes.Mesh)
Object(shapes.Sphere(radius="=frame"), instances=jg.Instances(positions=Array(), scales=[1, 2]))
shapes.Sphere(radius=animate.Keys([(0, 1), (1, 2)], repeat="loop"))
Object("sphere", transform=[{"translate": (0, 1, 0)}, {"rotate": {"axis": (0, 1, 0), "degrees": 30}}])
Object({"sphere": {"radius": "=2 * frame"}}, material={"phong": {"diffuse": "#fff"}})
lights.Area(shape=shapes.Rectangle(size=(1, 2)), radiance=5)
lights.Area(shape={"disk": {"radius": 1}}, radiance=5)

# Lists and dicts that are made elsewhere.
numbers: list[float] = [1, 2, 3]
rows: list[list[float]] = [numbers]
objects: list[Object] = [Object("sphere")]
phongs: dict[str, materials.Phong] = {}
cameras.Perspective(eye=numbers)
shapes.Polygon(rows)
Scene(objects=objects, materials=phongs)

match scene.camera:
    case cameras.Perspective(eye=eye):
        print(eye)
    case _:
        pass
match mesh:
    case shapes.Mesh(file):
        print(file)


def renders() -> None:
    """Renders, images and the other functions, which type checkers read only."""
    image = jg.render(scene, samples=4, size=(64, 36), aovs=["depth", "normal"], progress=False)
    assert_type(image, jg.Image)
    assert_type(image.hash, str)
    image.save("image.png")
    jg.render("juggler", denoise="own", camera=cameras.Perspective(eye=(0, 1, 5)), max_memory="4G")
    jg.render({"version": 1, "objects": []}, progress=lambda progress: print(progress.share))
    renderer = jg.Renderer(scene, threads=2, frame=1.5)
    renderer["materials.gold.conductor.roughness"] = 0.1
    renderer.camera = cameras.Perspective(eye=(0, 2, 6))
    for better in renderer.progressive(every=0.5):
        assert_type(better.size, tuple[int, int])
    parts = [renderer.render_shard(index, 4) for index in range(4)]
    assert_type(jg.merge(parts), jg.Image)
    assert_type(jg.compare(image, "reference.exr").p, float | None)
    assert_type(renderer.submit().result(), jg.Image)
    assert_type(renderer.probe(3, 4), jg.Probe)
    for frame in jg.frames("chess-opening", range(30), shutter=(0, 0.5)):
        print(frame.frame, frame.hash)
    jg.render_movie("chess-opening", "chess.mp4", frames=range(30))
    if image.camera is not None and image.camera.opencv is not None:
        K, R, t = image.camera.opencv
        print(K, R, t)
    try:
        scene.check()
    except jg.SceneError as error:
        print([problem.path for problem in error.problems])


def clusters() -> None:
    """Renders on several workers."""
    with ProcessPoolExecutor(2) as executor:
        assert_type(jg.cluster.render(scene, executor, samples=64, checkpoint="job.jfilm"), jg.Image)
    with jg.cluster.Ray() as farm:
        assert_type(farm.render("juggler", preview=True), jg.Image)
        assert_type([image.frame for image in farm.frames("chess", range(3))], list[float])
