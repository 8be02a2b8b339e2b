"""Memory stays flat over many scenes in one process.

JUGGLER_SCENES is the number of scenes, 1,000 by default.
"""

import os
import unittest

from support import python

COUNT = int(os.environ.get("JUGGLER_SCENES", "1000"))
# Scenes after which memory is measured first.
FIRST = 500
STATM = "/proc/self/statm"

CODE = f"""
import os, math, juggler as jg
from support import small_scene

def mesh(number, rows=12):
    corners = range(rows + 1)
    height = lambda x, y: 0.2 * math.sin(x + number) * math.cos(y)
    positions = [[x / rows - 0.5, height(x, y), y / rows - 0.5] for y in corners for x in corners]
    faces = []
    for y in range(rows):
        for x in range(rows):
            corner = y * (rows + 1) + x
            opposite = corner + rows + 2
            faces += [[corner, corner + 1, opposite - 1], [corner + 1, opposite, opposite - 1]]
    return {{"mesh": {{"positions": positions, "triangles": faces}}}}

def resident():
    with open("{STATM}") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

def render(number):
    scene = small_scene()
    scene["objects"][1]["shape"] = mesh(number)
    scene["materials"]["gold"]["conductor"]["roughness"] = 0.1 + number % 7 / 10
    return jg.render(scene, size=(64, 64), samples=1, aovs=["depth", "normal", "object_id"])

for number in range({COUNT}):
    render(number)
    if number == {FIRST}:
        print(resident())
print(resident())
"""


@unittest.skipUnless(os.path.exists(STATM), "the system does not say how much memory a process has")
class Memory(unittest.TestCase):
    def test_memory_stays_flat(self):
        done = python(CODE, timeout=None)
        self.assertEqual(done.returncode, 0, done.stderr)
        first, last = map(int, done.stdout.split())
        growth = last / first - 1
        print(f"memory: {first / 2**20:.1f} MiB after {FIRST} scenes, {last / 2**20:.1f} MiB after {COUNT}")
        self.assertLess(growth, 0.01)


if __name__ == "__main__":
    unittest.main()
