"""Tests of the package that pip has installed: its first image by the module and by the program, and
Ctrl-C. They need no NumPy.

    python crates/python/tests/run.py installed
"""

import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest
import zlib

import juggler as jg
from support import Folder, chunks, python

# The console script that pip installs beside Python.
SCRIPT = pathlib.Path(sys.executable).with_name("juggler")
LONG = "size=(1920, 1080), samples=100_000"


def pixels(path):
    """Size and bytes of the rows of a PNG file."""
    found = chunks(path.read_bytes())
    rows = b"".join(chunk[4:] for chunk in found if chunk.startswith(b"IDAT"))
    return found[0], zlib.decompress(rows)


class Installed(Folder):
    def test_the_first_image_is_that_of_the_program(self):
        code = "import juggler; juggler.render('juggler').save('j.png')"
        subprocess.run([sys.executable, "-c", code], cwd=self.folder, check=True)
        subprocess.run([SCRIPT, "render", "juggler", "-q", "-o", "k.png"], cwd=self.folder, check=True)
        self.assertEqual(pixels(self.folder / "j.png"), pixels(self.folder / "k.png"))

    def interrupted(self, file, *command):
        """Exit status as a shell has it, and standard error, of a process that receives Ctrl-C once it
        has written a file."""
        process = subprocess.Popen(
            command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        end = time.monotonic() + 60
        while not (self.folder / file).exists() and time.monotonic() < end:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        return 128 - process.returncode if process.returncode < 0 else process.returncode, errors

    def test_an_interrupt_ends_the_module_and_the_program(self):
        code = f"import juggler; juggler.render('juggler', {LONG}, progress=lambda _: open('begun', 'w').close())"
        status, errors = self.interrupted("begun", sys.executable, "-c", code)
        self.assertEqual((status, errors.splitlines()[-1]), (130, "KeyboardInterrupt"))
        flags = ["--size", "1920x1080", "--samples", "100000", "-o", "long.png"]
        flags += ["--checkpoint", "long.jfilm", "--checkpoint-every", "1"]
        status, errors = self.interrupted("long.jfilm", SCRIPT, "render", "juggler", *flags)
        self.assertEqual((status, "Traceback" in errors), (130, False), errors)
        self.assertFalse((self.folder / "long.png").exists())

    def test_versions_agree(self):
        done = subprocess.run([SCRIPT, "--version"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split(), ["juggler", jg.__version__])
        self.assertTrue(re.fullmatch(r"\d+\.\d+\.\d+\S*", jg.__version__))

    def test_arrays_ask_for_numpy(self):
        code = (
            "import sys; sys.modules['numpy'] = None\n"
            "import juggler\n"
            "image = juggler.render('juggler', size=(32, 18), samples=1, aovs=['depth'])\n"
            "for take in (lambda: image.color, lambda: image['depth'], image.to_uint8):\n"
            "    try: take()\n"
            "    except ImportError as error: print(error)\n"
            "print(len(image._repr_png_()) > 100)"
        )
        message = "arrays need NumPy: pip install numpy"
        self.assertEqual(python(code).stdout.splitlines(), [message] * 3 + ["True"])


if __name__ == "__main__":
    unittest.main()
