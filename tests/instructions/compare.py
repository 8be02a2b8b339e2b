#!/usr/bin/env python3
"""Counts the instructions of rendering seven scenes and compares them with `base.json`.

    tests/instructions/compare.py PROGRAM

PROGRAM is an optimized `juggler`. The test fails if a count differs by more than 2 % in either
direction, so that gains are guarded, too. With JUGGLER_BLESS=1 the counts are written to
`base.json`. Counts of another compiler, processor architecture or level of vector instructions are
not compared: a line in the file that JUGGLER_SKIPPED names says so.
"""

import json
import os
import pathlib
import subprocess
import sys

BASE = pathlib.Path(__file__).resolve().parent / "base.json"
ROOT = BASE.parents[2]
MOST = 0.02
# Python, which runs the program of the package, works alike in every run.
ENVIRONMENT = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONDONTWRITEBYTECODE": "1"}


def count(program):
    """Machine and instructions by scene."""
    command = [program, "bench", "scenes", "--program", program, "--measure", "instructions", "--json"]
    output = subprocess.run(command, cwd=ROOT, env=ENVIRONMENT, stdout=subprocess.PIPE, check=True).stdout
    report = json.loads(output)
    [measured] = report["programs"]
    machine = {"architecture": report["architecture"], "simd": measured["simd"], "compiler": measured["compiler"]}
    scenes = {scene["scene"]: scene["results"][0]["instructions"] for scene in report["scenes"]}
    return {**machine, "scenes": scenes}


def report_skipped(reason):
    """Names a comparison that is not made, for the end of the check."""
    print(f"SKIPPED: {reason}")
    if path := os.environ.get("JUGGLER_SKIPPED"):
        with open(path, "a", encoding="utf-8") as file:
            file.write(f"{reason}\n")


def compare(counts, base):
    """Prints all differences; returns the errors."""
    errors = [f"`{name}` was not counted" for name in base if name not in counts]
    for name, instructions in counts.items():
        if name not in base:
            errors.append(f"`{name}` is not in {BASE.name}")
            continue
        change = instructions / base[name] - 1
        print(f"{name:16} {instructions:15,} instructions, {100 * change:+.2f} %")
        if abs(change) > MOST:
            errors.append(f"`{name}`: {instructions:,} instructions, {base[name]:,} in {BASE.name}")
    return errors


def main(program):
    counts = count(program)
    if os.environ.get("JUGGLER_BLESS"):
        BASE.write_text(json.dumps(counts, indent=2) + "\n", encoding="utf-8")
    base = json.loads(BASE.read_text(encoding="utf-8"))
    for key in ("architecture", "simd", "compiler"):
        if counts[key] != base[key]:
            report_skipped(f"instructions: {key} is {counts[key]}; {BASE.name} is for {base[key]}")
            return 0
    errors = compare(counts["scenes"], base["scenes"])
    for error in errors:
        print(f"error: {error}", file=sys.stderr)
    if errors:
        print(f"help: an intended change is written into {BASE.name} with JUGGLER_BLESS=1", file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
