"""Compares FLIP by `juggler compare` with the evaluator of its authors.

    python3 -m venv flip && flip/bin/pip install flip-evaluator==1.7
    mkdir pairs
    JUGGLER_FLIP_PICTURES=$PWD/pairs cargo test -p juggler-imaging --lib flip::tests::flip_matches
    flip/bin/python tests/flip/agree.py pairs target/release/juggler

The test writes eleven pairs of procedural pictures, NAME.picture.png or .exr and NAME.reference.png
or .exr. The script prints the mean of each pair by both programs; the exit status is 1 if two means
differ by more than 1e-3. crates/imaging/src/flip/tests.rs contains the means of the column
`evaluator`. Without a program, the script prints only these.
"""

import json
import subprocess
import sys
from pathlib import Path

import flip_evaluator

MOST = 1e-3


def ours(program, picture, reference):
    command = [program, "compare", picture, reference, "--stats", "-"]
    stats = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    return stats["flip"]["mean"], stats["flip"]["range"]


def main():
    folder, program = Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None
    pictures = sorted(folder.glob("*.picture.*"))
    worst = 0.0
    print(f"{'pair':12} range  evaluator   juggler")
    for picture in pictures:
        reference = picture.with_name(picture.name.replace(".picture.", ".reference."))
        kind = "LDR" if picture.suffix == ".png" else "HDR"
        _, mean, _ = flip_evaluator.evaluate(str(reference), str(picture), kind, applyMagma=False)
        line = f"{picture.name.split('.')[0]:12} {kind}    {mean:.6f}"
        if program:
            found, kind_found = ours(program, picture, reference)
            worst = max(worst, abs(found - mean))
            line += f"    {found:.6f}" + ("" if kind_found == kind.lower() else f" ({kind_found}!)")
        print(line)
    if program:
        print(f"{len(pictures)} pairs, the largest difference of means is {worst:.2e}")
    return 0 if pictures and worst <= MOST else 1


if __name__ == "__main__":
    sys.exit(main())
