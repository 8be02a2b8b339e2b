"""Compresses a wheel again with Zopfli, which makes it 3 % smaller for the same readers.

    PYTHON tests/python/pack.py WHEEL

PYTHON has the package `zopflipy`.
"""

import os
import sys
import zipfile

import zopfli

ITERATIONS = 5


def main(path):
    packed = f"{path}.packed"
    with (
        zipfile.ZipFile(path) as wheel,
        zopfli.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, iterations=ITERATIONS) as smaller,
    ):
        for entry in wheel.infolist():
            smaller.writestr(entry, wheel.read(entry), zipfile.ZIP_DEFLATED)
    with zipfile.ZipFile(packed) as smaller:
        damaged = smaller.testzip()
    if damaged is not None:
        sys.exit(f"error: {damaged} is damaged")
    os.replace(packed, path)


if __name__ == "__main__":
    main(*sys.argv[1:])
