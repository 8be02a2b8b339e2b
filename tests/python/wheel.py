"""Checks a wheel before it is shipped: its size, its tag, its license texts, and every ELF file in
it, which must run with the C library of manylinux_2_28.

    tests/python/wheel.py WHEEL
"""

import pathlib
import re
import struct
import sys
import zipfile

MAX_BYTES = 8_000_000
TAG = "cp311-abi3-manylinux_2_28_x86_64"
# Newest version of each kind of symbol (PEP 600), and the libraries that every system has.
NEWEST = {"GLIBC": (2, 28), "GCC": (8, 0, 0)}
LIBRARIES = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libgcc_s.so.1"}
LIBRARIES |= {"libutil.so.1", "ld-linux-x86-64.so.2"}
LICENSES = ("LICENSE-MIT", "LICENSE-APACHE", "third-party.txt", "rust-standard-library")
DYNAMIC, NEEDED_VERSIONS = 6, 0x6FFFFFFE


class Elf:
    """Dynamic section and versions of symbols of a 64-bit little-endian ELF file."""

    def __init__(self, data):
        if data[:6] != b"\x7fELF\x02\x01":
            raise ValueError("not an ELF file of 64 bits")
        self.data = data
        (start,) = struct.unpack_from("<Q", data, 40)
        size, count = struct.unpack_from("<HH", data, 58)
        # Type, offset, size and linked section of each section.
        headers = [struct.unpack_from("<IIQQQQII", data, start + index * size) for index in range(count)]
        self.sections = [(header[1], header[4], header[5], header[6]) for header in headers]

    def text(self, table, offset):
        start = self.sections[table][1] + offset
        return self.data[start : self.data.index(b"\0", start)].decode()

    def libraries(self):
        """Libraries that the file needs."""
        for kind, start, length, strings in self.sections:
            for at in range(start, start + length, 16) if kind == DYNAMIC else ():
                tag, value = struct.unpack_from("<qQ", self.data, at)
                if tag == 1:
                    yield self.text(strings, value)

    def versions(self):
        """Versions of symbols that the file needs."""
        for kind, start, _, strings in self.sections:
            at = start if kind == NEEDED_VERSIONS else None
            while at is not None:
                _, count, _, auxiliary, following = struct.unpack_from("<HHIII", self.data, at)
                entry = at + auxiliary
                for _ in range(count):
                    _, _, _, name, next_entry = struct.unpack_from("<IHHII", self.data, entry)
                    yield self.text(strings, name)
                    entry += next_entry
                at = at + following if following else None


def problems_of_elf(data):
    """What keeps an ELF file from running on the oldest systems."""
    elf = Elf(data)
    versions = set(elf.versions())
    if not versions:
        yield "it names no versions of symbols, so they cannot be checked"
    for version in sorted(versions):
        kind, _, number = version.partition("_")
        newest = NEWEST.get(kind)
        if (
            newest is None
            or not re.fullmatch(r"[\d.]+", number)
            or tuple(map(int, number.split("."))) > newest
        ):
            yield f"it needs {version}"
    yield from (f"it needs the library {name}" for name in sorted(set(elf.libraries()) - LIBRARIES))


def problems(path):
    """What keeps a wheel from being shipped."""
    if not path.stem.endswith(TAG):
        yield f"the name has not the tag {TAG}"
    if path.stat().st_size > MAX_BYTES:
        yield f"it has {path.stat().st_size} bytes, more than {MAX_BYTES}"
    with zipfile.ZipFile(path) as wheel:
        names = wheel.namelist()
        for text in LICENSES:
            if not any(f".dist-info/licenses/licenses/{text}" in name for name in names):
                yield f"the license text {text} is missing"
        elves = [name for name in names if wheel.open(name).read(4) == b"\x7fELF"]
        if not elves:
            yield "it has no ELF file"
        for name in elves:
            yield from (f"{name}: {problem}" for problem in problems_of_elf(wheel.read(name)))


def main(path):
    path = pathlib.Path(path)
    found = list(problems(path))
    for problem in found:
        print(f"error: {path.name}: {problem}", file=sys.stderr)
    print(f"{path.name}: {path.stat().st_size} bytes, {len(found)} problems")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
