"""CPU time from a cancellation to the end, of renders and builds, in Python and by the program.

    PYTHON tests/python/cancelling.py PROGRAM

PYTHON has `juggler` and NumPy. A render has 1920x1080 pixels and 100,000 samples, a build a mesh of ten
million triangles. Each is cancelled at five times.
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROUNDS = 5
RENDER_SECONDS, BUILD_SECONDS = 0.1, 0.5
TRIANGLES = 10_000_000
SETTINGS = {"size": (1920, 1080), "samples": 100_000}


def mesh():
    """A wavy surface."""
    import numpy as np

    across = 3163
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, across, dtype="f4")])
    positions = np.stack([x, np.sin(9 * x) * np.cos(7 * y) / 9, y], axis=-1).reshape(-1, 3)
    corner = np.arange(across * (across - 1), dtype="u4").reshape(across - 1, across)[:, :-1].reshape(-1)
    corners = [corner, corner + across, corner + 1, corner + 1, corner + across, corner + across + 1]
    return positions, np.stack(corners, axis=-1).reshape(-1, 3)[:TRIANGLES]


def interrupted(work, seconds):
    """CPU time from a Ctrl-C after these seconds until `work` has ended by it."""
    sent = []

    def press():
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, press)
    timer.start()
    try:
        work()
    except KeyboardInterrupt:
        return time.process_time() - sent[0]
    timer.cancel()
    raise AssertionError("the work ended before Ctrl-C")


def cpu_seconds(process):
    """CPU time of a process so far."""
    with open(f"/proc/{process.pid}/stat") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def program_interrupted(command, seconds):
    """CPU time of the program from a Ctrl-C after these seconds until its end."""
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    before = cpu_seconds(process)
    process.send_signal(signal.SIGINT)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    # The program either ends by the signal, or reports it by its status.
    assert status in (signal.SIGINT, 130 << 8), status
    return usage.ru_utime + usage.ru_stime - before


def main(program):
    import juggler as jg

    signal.signal(signal.SIGINT, signal.default_int_handler)
    jg.render("juggler", size=(8, 8), samples=1)
    positions, triangles = mesh()
    scene = jg.Scene(objects=[jg.Object(jg.shapes.Mesh(positions=positions, triangles=triangles))])
    native = jg._scene.native_scene(scene)
    renderer = jg.Renderer("juggler", **SETTINGS)
    renderer.fingerprint  # noqa: B018
    waits = [0.3 + 0.4 * index for index in range(ROUNDS)]
    renders = [interrupted(renderer.render, wait) for wait in waits]
    builds = [interrupted(lambda: jg.render(native, samples=1), wait) for wait in waits]
    with tempfile.TemporaryDirectory() as folder:
        scene.save(os.path.join(folder, "scene.json"))
        output = ["-q", "-o", os.path.join(folder, "image.png")]
        long = [program, "render", "juggler", "--size", "1920x1080", "--samples", "100000", *output]
        by_program = [program_interrupted(long, wait) for wait in waits]
        large = [program, "render", os.path.join(folder, "scene.json"), "--samples", "1", *output]
        builds_by_program = [program_interrupted(large, wait) for wait in waits]
    found = {
        "render": (renders, RENDER_SECONDS),
        "build": (builds, BUILD_SECONDS),
        "render by the program": (by_program, RENDER_SECONDS),
        "build by the program": (builds_by_program, BUILD_SECONDS),
    }
    for name, (seconds, most) in found.items():
        print(f"{name}: {', '.join(f'{each:.3f}' for each in seconds)} s of CPU, at most {most} s")
    return 0 if all(max(seconds) <= most for seconds, most in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
