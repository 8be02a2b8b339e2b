"""Runs the tests of the installed package: all, or those of the modules, classes or methods that the
arguments name.

    python crates/python/tests/run.py [NAME...]

The reasons of skipped tests are appended to the file that JUGGLER_SKIPPED names, except those about
packages: `./check.sh deep python` installs all of them.
"""

import os
import pathlib
import re
import sys
import unittest


def main(names):
    loader = unittest.defaultTestLoader
    folder = str(pathlib.Path(__file__).parent)
    tests = loader.loadTestsFromNames(names) if names else loader.discover(folder)
    result = unittest.TextTestRunner().run(tests)
    for reason in sorted({reason for _, reason in result.skipped}):
        if re.search(r"is (not )?installed$", reason):
            print(f"left out with these packages: {reason}")
        else:
            report(reason)
    return 0 if result.wasSuccessful() else 1


def report(reason):
    print(f"SKIPPED: python: {reason}")
    if "JUGGLER_SKIPPED" in os.environ:
        with open(os.environ["JUGGLER_SKIPPED"], "a", encoding="utf-8") as file:
            file.write(f"python: {reason}\n")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
