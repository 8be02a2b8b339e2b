"""Time and memory of large arrays, each case in a process of its own.

    PYTHON tests/python/arrays.py [FOLDER]

PYTHON has `juggler` and NumPy. Prints a line for each case: the CPU time until the arrays are in a
scene, their hash included; that until the picture is ready to render and of one pixel is rendered;
and the peak of the memory beside the arrays of the user. FOLDER receives a PLY file and a picture.
"""

import os
import subprocess
import sys
import time

TRIANGLES, SPHERES = 1_000_000, 1_000_000
SPHERE_MEBIBYTES, SPHERE_SECONDS, TRIANGLE_SECONDS = 450, 2.0, 0.100
CASES = ("triangles", "ply", "spheres", "radii", "colors")


def memory(key):
    """Memory of this process in MiB: `VmRSS` now, `VmHWM` at its peak."""
    with open("/proc/self/status") as status:
        line = next(line for line in status if line.startswith(key))
    return int(line.split()[1]) / 1024


def grid():
    """Positions and triangles of a wavy surface."""
    import numpy as np

    across, along = 1001, TRIANGLES // 2000 + 1
    x, y = np.meshgrid(np.linspace(-1, 1, across, dtype="f4"), np.linspace(-1, 1, along, dtype="f4"))
    positions = np.stack([x, np.sin(9 * x) * np.cos(7 * y) / 9, y], axis=-1).reshape(-1, 3)
    corner = np.arange(across * (along - 1), dtype="u4").reshape(along - 1, across)[:, :-1].reshape(-1)
    triangles = np.stack(
        [corner, corner + across, corner + 1, corner + 1, corner + across, corner + across + 1], -1
    )
    return positions, triangles.reshape(-1, 3)


def surface(folder):
    import juggler as jg

    positions, triangles = grid()
    assert len(triangles) == TRIANGLES
    mesh = jg.shapes.Mesh(positions=positions, triangles=triangles)
    return shown(mesh), positions.nbytes + triangles.nbytes


def shown(shape, **fields):
    """A scene that shows a shape from above."""
    import juggler as jg

    camera = jg.cameras.Perspective(eye=(0, 2, 3), look_at=(0, 0, 0), vertical_fov_degrees=45)
    return jg.Scene(background="#c0c8d0", camera=camera, objects=[jg.Object(shape, **fields)])


def dots(with_radii=False):
    """A million spheres in a ball, each with a number that colors it."""
    import numpy as np

    import juggler as jg

    numbers = np.random.default_rng(1)
    places = numbers.normal(size=(SPHERES, 3)).astype("f4")
    places *= (
        numbers.random((SPHERES, 1)) ** (1 / 3) / np.linalg.norm(places, axis=1, keepdims=True)
    ).astype("f4")
    values = np.linalg.norm(places * (1, 2, 0.5), axis=1).astype("f4")
    radii = numbers.uniform(0.002, 0.008, SPHERES).astype("f4") if with_radii else 0.005
    scene = jg.Scene(
        background=jg.backgrounds.Studio(),
        camera=jg.cameras.Perspective(eye=(0, 1.6, 2.4), look_at=(0, 0, 0), vertical_fov_degrees=42),
        objects=[jg.sci.spheres(places, radii, values=values, cmap="turbo")],
    )
    return scene, places.nbytes + values.nbytes + (radii.nbytes if with_radii else 0)


def measure(case, folder):
    import juggler as jg
    from juggler._scene import native_scene

    if case == "ply":
        scene, size = shown({"mesh": {"file": os.path.join(folder, "surface.ply")}}), 0
    else:
        scene, size = surface(folder) if case == "triangles" else dots(case == "radii")
    settings = {"size": (64, 36), "samples": 1}
    if case == "colors":
        jg.render(scene, size=(1280, 960), samples=16).save(os.path.join(folder, "colors.png"))
        return f"a picture of {SPHERES} colors in {folder}"
    # The first scene loads code and starts threads.
    jg.render("juggler", size=(8, 8), samples=1)
    before, start = memory("VmRSS"), time.process_time()
    native = native_scene(scene, False)
    copied = time.process_time() - start
    wall, start = time.monotonic(), time.process_time()
    image = jg.Renderer(native, **settings).render()
    built, wall = time.process_time() - start, time.monotonic() - wall
    report = (
        f"{copied:.3f} s into the scene, then {built:.2f} s ({wall:.2f} s of wall time) until the picture"
    )
    report += f"; peak {memory('VmHWM') - before:.0f} MiB beside {size / 2**20:.1f} MiB of arrays; {image.hash[:16]}"
    if case == "triangles":
        folder_of_scene = os.path.join(folder, "scene")
        os.makedirs(folder_of_scene, exist_ok=True)
        scene.save(os.path.join(folder_of_scene, "scene.json"))
        (name,) = (name for name in os.listdir(folder_of_scene) if name.endswith(".ply"))
        os.replace(os.path.join(folder_of_scene, name), os.path.join(folder, "surface.ply"))
    return report


def main(folder="arrays"):
    os.makedirs(folder, exist_ok=True)
    for case in CASES:
        command = [sys.executable, __file__, folder, case]
        print(
            f"{case}: {subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()}"
        )


if __name__ == "__main__":
    if len(sys.argv) == 3:
        print(measure(sys.argv[2], sys.argv[1]))
    else:
        main(*sys.argv[1:])
