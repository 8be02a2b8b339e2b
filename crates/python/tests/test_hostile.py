"""Random and wrong input gives an image or an exception: no crash, no panic, no hang.

JUGGLER_INPUTS is the number of inputs, 2,000 by default.
"""

import os
import pathlib
import subprocess
import sys
import unittest

from support import environment

COUNT = int(os.environ.get("JUGGLER_INPUTS", "2000"))
# Inputs of one process.
BATCH = 2000
PROGRAM = pathlib.Path(__file__).with_name("hostile.py")


@unittest.skipIf(os.name == "nt", "limits of Unix")
class Hostile(unittest.TestCase):
    def test_no_input_crashes(self):
        images = 0
        for first in range(0, COUNT, BATCH):
            count = min(BATCH, COUNT - first)
            command = [sys.executable, str(PROGRAM), str(first), str(count)]
            done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment())
            lines = done.stdout.splitlines()
            last = lines[-1] if lines else "none"
            self.assertEqual(done.returncode, 0, f"input {last}: {done.stderr[-3000:]}")
            images += int(last)
        # Inputs that are all wrong would test nothing but messages.
        self.assertTrue(COUNT / 10 < images < COUNT, f"{images} of {COUNT} inputs gave an image")


if __name__ == "__main__":
    unittest.main()
