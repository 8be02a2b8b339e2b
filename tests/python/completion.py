"""Checks that an editor completes the fields of classes, by Jedi.

    tests/python/completion.py

runs in a virtual environment with the package and Jedi.
"""

import sys

import jedi

CASES = {
    "from juggler import materials\nmaterials.Principled(": "roughness=",
    "from juggler import shapes\nshapes.Sphere(": "radius=",
    "import juggler as jg\njg.RenderSettings(": "samples=",
    "import juggler as jg\njg.": "render",
    "import juggler as jg\njg.materials.": "Principled",
    "import juggler as jg\njg.render('juggler').": "save",
    "import juggler as jg\njg.Renderer('juggler').": "progressive",
}


def main():
    failed = 0
    for code, expected in CASES.items():
        names = [completion.name for completion in jedi.Script(code).complete()]
        if expected not in names:
            print(f"error: {code!r} is not completed by {expected}: {names[:20]}", file=sys.stderr)
            failed += 1
    print(f"{len(CASES) - failed} of {len(CASES)} completions")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
