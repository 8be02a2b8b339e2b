"""Collects the license texts of everything that the Python module links, for its wheel (PEP 639).

    tests/python/licenses.py FOLDER [TARGET]

FOLDER receives the texts of this repository, of all packages in one file, each text once, and of
Rust's standard library. A package without a text is an error, unless it belongs to a repository
with one, or offers the Apache License 2.0, whose text is the same for all. TARGET is a target
triple, by default Linux on x86-64.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The module as it is shipped.
MODULE = [
    "--locked",
    "--manifest-path",
    str(ROOT / "crates/python/Cargo.toml"),
    "--features",
    "av1,serve,ktx2",
]
TEXT = re.compile(r"(licen[cs]e|copying|copyright|notice|unlicense|authors|patents)", re.IGNORECASE)
APACHE = ROOT / "LICENSE-APACHE"


def output(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout


def linked(target):
    """Name and version of the packages that are linked. Macros run in the compiler, and build
    scripts before it."""
    edges = ["--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"]
    lines = output("cargo", "tree", *MODULE, "--target", target, *edges).splitlines()
    return sorted({tuple(line.split()[:2]) for line in lines if line})


def packages(target):
    """The packages that are linked, as `cargo metadata` describes them."""
    found = json.loads(output("cargo", "metadata", "--format-version", "1", *MODULE))["packages"]
    by_name = {(package["name"], f"v{package['version']}"): package for package in found}
    return [by_name[each] for each in linked(target)]


def own_texts(package):
    """The files with license texts in the archive of a package."""
    folder = pathlib.Path(package["manifest_path"]).parent
    return sorted(path for path in folder.rglob("*") if path.is_file() and TEXT.match(path.name))


def texts(package, others):
    """The files with the license texts of a package: its own, else those of a package of the same
    repository, else the Apache License 2.0 if the package offers it."""
    repository = package["repository"]
    siblings = [other for other in others if repository and other["repository"] == repository]
    for each in [package, *siblings]:
        if own_texts(each):
            return own_texts(each)
    return [APACHE] if "Apache-2.0" in re.split(r" OR |/", package["license"] or "") else []


def standard_library():
    """The files with the licenses of Rust's standard library."""
    folder = pathlib.Path(output("rustc", "--print", "sysroot").strip()) / "share/doc/rust"
    return [path for path in (folder / "COPYRIGHT-library.html", folder / "COPYRIGHT") if path.exists()][:1]


def third_party(found):
    """All texts, each once, after the packages to which it applies."""
    packages_of, texts = {}, {}
    for package, files in found.items():
        for path in files:
            text = "\n".join(line.rstrip() for line in path.read_text(errors="replace").splitlines()).strip()
            # Texts whose spaces alone differ are one text.
            words = " ".join(text.split())
            packages_of.setdefault(words, []).append(package)
            texts.setdefault(words, text)
    line = "=" * 80
    # Texts that resemble each other stand side by side, where they compress well.
    alike = sorted(packages_of, key=lambda words: re.sub(r"\W+", " ", words).lower())
    return "".join(
        f"{line}\n{chr(10).join(packages_of[words])}\n{line}\n\n{texts[words]}\n\n" for words in alike
    )


def main(folder, target="x86_64-unknown-linux-gnu"):
    every = [package for package in packages(target) if package["source"]]
    found = {f"{each['name']} {each['version']}: {each['license']}": texts(each, every) for each in every}
    missing = [name for name, files in found.items() if not files]
    if missing or not standard_library():
        sys.exit(f"error: no license text: {', '.join(missing) or 'the standard library of Rust'}")
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path in (ROOT / "LICENSE-MIT", APACHE):
        shutil.copy(path, folder)
    shutil.copy(standard_library()[0], folder / f"rust-standard-library{standard_library()[0].suffix}")
    (folder / "third-party.txt").write_text(third_party(found), encoding="utf-8")
    print(f"license texts of {len(found)} packages")


if __name__ == "__main__":
    main(*sys.argv[1:])
