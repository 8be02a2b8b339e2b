"""Compares the background `sky` with Hosek and Wilkie's model and with the clear sky of CIE.

    python3 -m venv sky && sky/bin/pip install -r tests/sky/requirements.txt
    sky/bin/python tests/sky/agree.py target/release/juggler

The script renders 12 directions and the zenith for each of three turbidities and three elevations
of the sun. It prints the luminance relative to the zenith and blue over red: of `juggler`, of the
plug-in `sunsky` of Mitsuba (Hosek and Wilkie 2012, same ground albedo), and the luminance of CIE's
clear sky, type 12 (ISO 15469:2004). The luminance must lie between both models or within 30 % of the
nearer, blue over red within 30 % of Hosek and Wilkie's; other lines end with `!`, and the exit status
is 1. crates/light/src/background/sky/tests.rs contains a part of the table.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")

ALBEDO = 0.3
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
ZENITH = (0, 90)


def towards(azimuth, elevation):
    """Unit vector for an azimuth from the sun and an elevation, +Y up, azimuth 0 at -Z."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)])


def directions(sun):
    """Twelve directions from 10° of the sun on: above it, at its elevation, and near the horizon."""
    above = [(0, e) if e <= 90 else (180, 180 - e) for e in (sun + 10, sun + 20, sun + 40)]
    beside = [2 * math.degrees(math.asin(math.sin(math.radians(angle / 2)) / math.cos(math.radians(sun))))
              for angle in (10, 25)]
    level = [(azimuth, sun) for azimuth in (*beside, 90, 180)]
    return above + level + [(45, 5), (90, 5), (180, 5), (90, 45), (180, 45)]


def juggler(program, folder, turbidity, sun, at):
    scene = {
        "version": 1,
        "render": {"size": [2, 2], "samples": 1},
        "camera": {"orthographic": {"eye": [0, 0, 0], "direction": towards(*at).tolist(),
                                    "up": [0, 1, 0] if at[1] < 80 else [0, 0, 1]}},
        "background": {"sky": {"sun_elevation_degrees": sun, "sun_azimuth_degrees": 0, "sun": False,
                               "turbidity": turbidity, "ground_albedo": [ALBEDO] * 3}},
    }
    (folder / "sky.json").write_text(json.dumps(scene))
    output = folder / "sky.exr"
    subprocess.run([program, "render", folder / "sky.json", "-o", output, "--quiet"], check=True)
    return np.array(mitsuba.Bitmap(str(output)))[0, 0, :3]


def hosek_wilkie(turbidity, sun):
    x, y, z = (float(v) for v in towards(0, sun))
    sky = mitsuba.load_dict({"type": "sunsky", "turbidity": float(turbidity), "albedo": ALBEDO,
                             "sun_scale": 0.0, "sun_direction": [x, z, y]})

    def radiance(at):
        x, y, z = (float(v) for v in towards(*at))
        hit = mitsuba.SurfaceInteraction3f()
        hit.wi = mitsuba.Vector3f(-x, -z, -y)
        return np.array([float(v) for v in sky.eval(hit)])

    return radiance


def cie(direction, sun):
    def gradation(cos):
        return 1 - math.exp(-0.32 / cos)

    def indicatrix(cos):
        angle = math.acos(min(cos, 1))
        return 1 + 10 * (math.exp(-3 * angle) - math.exp(-1.5 * math.pi)) + 0.45 * cos * cos

    return indicatrix(direction @ sun) * gradation(direction[1]) / (indicatrix(sun[1]) * gradation(1))


def main():
    program, failures, lines = sys.argv[1], 0, 0
    print("turbidity sun  azimuth elevation   juggler Hosek-W.      CIE    blue/red Hosek-W.")
    with tempfile.TemporaryDirectory() as name:
        for turbidity, sun in ((t, s) for t in (2, 3, 5) for s in (20, 40, 60)):
            peer = hosek_wilkie(turbidity, sun)
            zenith = juggler(program, Path(name), turbidity, sun, ZENITH) @ LUMINANCE
            for at in directions(sun):
                found, expected = juggler(program, Path(name), turbidity, sun, at), peer(at)
                ratio, published = found @ LUMINANCE / zenith, expected @ LUMINANCE / (peer(ZENITH) @ LUMINANCE)
                clear = cie(towards(*at), towards(0, sun))
                hue, published_hue = found[2] / found[0], expected[2] / expected[0]
                low, high = min(published, clear), max(published, clear)
                right = 0.7 * low <= ratio <= 1.3 * high and 0.7 <= hue / published_hue <= 1.3
                failures, lines = failures + (not right), lines + 1
                print(f"{turbidity:9} {sun:3} {at[0]:8.1f} {at[1]:9.1f} {ratio:9.2f} {published:8.2f} {clear:8.2f}"
                      f" {hue:11.2f} {published_hue:8.2f}{'' if right else '  !'}")
    print(f"{failures} of {lines} directions differ by more than 30 %")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
