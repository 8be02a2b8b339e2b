"""What the tests share."""

import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import juggler as jg
from juggler import Object, Scene, cameras, lights, materials, shapes, textures

# A shell without job control lets commands in the background, and all that they start, ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = pathlib.Path(__file__).resolve().parents[3]
# The program, built with the same source.
PROGRAM = os.environ.get("JUGGLER_PROGRAM", str(ROOT / "target/debug/juggler"))

try:
    import numpy
except ImportError:
    numpy = None

needs_numpy = unittest.skipUnless(numpy, "NumPy is not installed")
needs_program = unittest.skipUnless(os.path.exists(PROGRAM), "the program is not built")

SMALL = {"size": (32, 18), "samples": 2}


def small_scene(**more):
    """Two spheres over a plane, as a dict."""
    return {
        "version": 1,
        "render": {"size": [32, 18], "samples": 4},
        "camera": {"perspective": {"eye": [0, 1, 5], "look_at": [0, 0.5, 0], "vertical_fov_degrees": 40}},
        "materials": {
            "floor": {"diffuse": {"reflectance": 0.5}},
            "gold": {"conductor": {"metal": "gold", "roughness": 0.2}},
        },
        "lights": [{"point": {"position": [-3, 5, 4], "intensity": 60}}],
        "objects": [
            {"name": "ground", "shape": "plane", "material": "floor"},
            {
                "name": "ball",
                "shape": {"sphere": {"radius": 1}},
                "material": "gold",
                "transform": [{"translate": [0, 1, 0]}],
            },
        ],
        **more,
    }


def typed_scene():
    """Two objects over a tiled floor, as in the documentation."""
    return Scene(
        render=jg.RenderSettings(size=(32, 18), samples=4),
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


def program(*words):
    """Runs the program, and returns its standard output."""
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(done.stderr)
    return done.stdout


def program_hash(scene, *flags):
    """Hash of the pixels that the program renders."""
    with tempfile.TemporaryDirectory() as folder:
        image = os.path.join(folder, "image.exr")
        stats = os.path.join(folder, "stats.json")
        program("render", scene, "-q", "-o", image, "--stats", stats, *flags)
        with open(stats, encoding="utf-8") as file:
            return json.load(file)["film"]["hash"]


def environment():
    """Environment of a process that imports the same modules."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def python(code, *words, timeout=120, **arguments):
    """Runs code in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        timeout=timeout,
        env=environment(),
        check=False,
        **arguments,
    )


def chunks(data):
    """Chunks of a PNG file."""
    found, at = [], 8
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        found.append(data[at + 4 : at + 8 + length])
        assert zlib.crc32(found[-1]) == struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0]
        at += 12 + length
    return found


class Folder(unittest.TestCase):
    """Test with a folder for its files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
