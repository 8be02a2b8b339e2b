"""Makes the glTF models of the gallery, each of them by formulas and always with the same bytes.

    python3 scenes/models/make.py            # writes robot.glb, room.glb and still-life.glb
    python3 scenes/models/make.py robot      # writes one of them
    python3 scenes/models/make.py --check    # compares with the committed files; status 1 if they differ

The script needs Python 3 and nothing else.
"""
import sys
from pathlib import Path

import robot
import room
import still_life

FOLDER = Path(__file__).resolve().parent
MODELS = {"robot": robot.make, "room": room.make, "still-life": still_life.make}


def main(arguments):
    check = "--check" in arguments
    names = [name for name in arguments if name != "--check"] or list(MODELS)
    unknown = [name for name in names if name not in MODELS]
    if unknown:
        sys.exit(f"no model `{unknown[0]}`; the models are {', '.join(MODELS)}")
    different = []
    for name in names:
        path, data = FOLDER / f"{name}.glb", MODELS[name]()
        if not check:
            path.write_bytes(data)
            print(f"{path.name}: {len(data):,} bytes")
        elif not path.exists() or path.read_bytes() != data:
            different.append(path.name)
    if different:
        sys.exit(f"other than what the script makes: {', '.join(different)}")


if __name__ == "__main__":
    main(sys.argv[1:])
