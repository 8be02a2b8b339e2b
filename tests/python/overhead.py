"""Compares the CPU time of whole processes: a render by Python, by the program, and no render.

    tests/python/overhead.py PYTHON PROGRAM

The time of Python's render may exceed that of the program and of a bare interpreter by 2 % and 20
milliseconds. Each time is the least of nine, measured in turns. Both builds have one profile.
"""

import os
import sys

ROUNDS = 9
SHARE, SECONDS = 0.02, 0.020
IMPORT_SECONDS = 0.030
CODE = "import juggler; juggler.render('juggler', size=(640, 360), samples=16).save({path!r})"


def cpu_seconds(command):
    """Time that a process and its threads spend on processors."""
    process = os.posix_spawn(command[0], command, {**os.environ, "JUGGLER_THREADS": "1"})
    _, status, usage = os.wait4(process, 0)
    if status:
        sys.exit(f"error: {command} has failed")
    return usage.ru_utime + usage.ru_stime


def main(python, program):
    folder = os.path.dirname(os.path.abspath(python))
    render = CODE.format(path=os.path.join(folder, "overhead.png"))
    size = ["--size", "640x360", "--samples", "16", "--threads", "1"]
    commands = {
        "Python": [python, "-c", render],
        "program": [
            program,
            "render",
            "juggler",
            *size,
            "-q",
            "-o",
            os.path.join(folder, "overhead-program.png"),
        ],
        "bare": [python, "-c", "pass"],
        "import": [python, "-c", "import juggler"],
    }
    least = dict.fromkeys(commands, float("inf"))
    for _ in range(ROUNDS):
        for name, command in commands.items():
            least[name] = min(least[name], cpu_seconds(command))
    for name, seconds in least.items():
        print(f"{name}: {seconds:.3f} s")
    imported = least["import"] - least["bare"]
    allowed = (least["program"] + least["bare"]) * (1 + SHARE) + SECONDS
    print(f"import juggler: {imported:.3f} s, at most {IMPORT_SECONDS} s")
    print(f"a render by Python: {least['Python']:.3f} s, at most {allowed:.3f} s")
    return 0 if imported <= IMPORT_SECONDS and least["Python"] <= allowed else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
