"""Derive the named metals of crates/bsdf/src/metals.rs from measured tables of n and k.

    python3 -m venv metals && metals/bin/pip install -r tests/metals/requirements.txt
    metals/bin/python tests/metals/derive.py FOLDER             # a row for each metal and channel
    metals/bin/python tests/metals/derive.py FOLDER --rust      # also as lines of metals.rs
    metals/bin/python tests/metals/derive.py FOLDER --table gold=Au.eta.spd

FOLDER holds the tables as the refractiveindex.info database (public domain) publishes them, below
its folder `database/data`; METALS, SECOND and FURTHER name the files. `--table NAME=FILE` takes
another file for a metal: YAML of that database, or a pair of spectra `X.eta.spd` and `X.k.spd` in
nanometers, as Mitsuba has them. The tables themselves are not part of Juggler.

The script
1. interpolates n and k linearly in wavelength, every nanometer from 380 to 780;
2. computes the reflectance of unpolarized light in air (Fresnel's equations for conductors; Born
   and Wolf, section 14.2);
3. integrates it with the CIE 1931 2-degree color matching functions under D65 to linear sRGB, so
   that a perfect reflector is exactly 1, 1, 1; a saturated metal lies outside of sRGB, so each
   channel is clamped to 0..1, at each angle;
4. fits eta and k of each channel to that curve from 0 to 80 degrees: all pairs that meet the
   reflectance at normal incidence lie on a circle; least squares choose one. A channel that is
   clamped to 1 at normal incidence has no such pair with eta > 0: its k is the spectral mean, and
   eta is the one whose largest deviation over all angles is least, which leaves the reflectance of
   such a channel just below 1.

The exit status is 1 if a fit deviates by more than 0.01 anywhere, or if a table of SECOND
differs by more than 0.04 at normal incidence.
"""

import argparse
import re
import sys
import warnings
from pathlib import Path

import numpy as np

with warnings.catch_warnings():
    # The package warns about optional packages that this script does not need.
    warnings.simplefilter("ignore")
    import color

# Source and file of each metal's table.
METALS = {
    "aluminum": ("Rakić 1995", "main/Al/nk/Rakic.yml"),
    "brass": ("Querry 1985, 70 % copper and 30 % zinc", "other/alloys/Cu-Zn/nk/Querry-Cu70Zn30.yml"),
    "chromium": ("Johnson and Christy 1974", "main/Cr/nk/Johnson.yml"),
    "cobalt": ("Johnson and Christy 1974", "main/Co/nk/Johnson.yml"),
    "copper": ("Johnson and Christy 1972", "main/Cu/nk/Johnson.yml"),
    "gold": ("Johnson and Christy 1972", "main/Au/nk/Johnson.yml"),
    "iron": ("Johnson and Christy 1974", "main/Fe/nk/Johnson.yml"),
    "nickel": ("Johnson and Christy 1974", "main/Ni/nk/Johnson.yml"),
    "platinum": ("Rakić et al. 1998, Brendel-Bormann model", "main/Pt/nk/Rakic-BB.yml"),
    "silver": ("Johnson and Christy 1972", "main/Ag/nk/Johnson.yml"),
    "titanium": ("Johnson and Christy 1974", "main/Ti/nk/Johnson.yml"),
    "tungsten": ("Rakić et al. 1998, Brendel-Bormann model", "main/W/nk/Rakic-BB.yml"),
    "zinc": ("Werner et al. 2009", "main/Zn/nk/Werner.yml"),
}
# Independent measurements of the two most colored metals; further tables show the spread of
# samples.
SECOND = {
    "gold": ("Olmon et al. 2012, single crystal", "main/Au/nk/Olmon-sc.yml"),
    "copper": ("Hagemann et al. 1975", "main/Cu/nk/Hagemann.yml"),
}
FURTHER = {
    "gold": ("main/Au/nk/Babar.yml", "main/Au/nk/McPeak.yml", "main/Au/nk/Rakic-BB.yml", "main/Au/nk/Yakubovsky-53nm.yml"),
    "copper": ("main/Cu/nk/Babar.yml", "main/Cu/nk/McPeak.yml", "main/Cu/nk/Rakic-BB.yml", "main/Cu/nk/Querry.yml"),
}
CHANNELS = "red", "green", "blue"
WAVELENGTHS = np.arange(380, 781, dtype=float)
DEGREES = np.arange(0, 81)
# Angles of the rows in the tests of metals.rs.
TESTED_DEGREES = 0, 40, 60, 70, 75, 80
# Chromaticities of the primaries (IEC 61966-2-1), one column per primary.
PRIMARIES = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
FIT_TOLERANCE, SECOND_TOLERANCE = 0.01, 0.04


def read_yaml(path):
    """Reads wavelengths in nanometers, n and k from the database's `tabulated nk`."""
    text = path.read_text(encoding="utf-8")
    if "type: tabulated nk" not in text:
        sys.exit(f"{path}: no `tabulated nk` in it")
    number = r"([0-9.]+(?:[eE][-+]?[0-9]+)?)"
    rows = re.findall(rf"^\s+{number}\s+{number}\s+{number}\s*$", text, re.MULTILINE)
    micrometers, n, k = np.array(rows, dtype=float).T
    return micrometers * 1000, n, k


def read_spectra(path):
    """Reads wavelengths in nanometers, n and k from a pair of spectra."""
    eta, k = np.loadtxt(path), np.loadtxt(str(path).replace(".eta.spd", ".k.spd"))
    return eta[:, 0], eta[:, 1], np.interp(eta[:, 0], k[:, 0], k[:, 1])


def read_table(path):
    """Returns n and k at WAVELENGTHS."""
    try:
        wavelengths, n, k = read_spectra(path) if path.name.endswith(".eta.spd") else read_yaml(path)
    except OSError as error:
        sys.exit(f"cannot read a table: {error}")
    if wavelengths[0] > WAVELENGTHS[0] or wavelengths[-1] < WAVELENGTHS[-1]:
        print(f"note: {path.name} covers {wavelengths[0]:.0f} to {wavelengths[-1]:.0f} nm; its ends are continued")
    return np.interp(WAVELENGTHS, wavelengths, n), np.interp(WAVELENGTHS, wavelengths, k)


def srgb_weights():
    """Returns the weights of each wavelength in the channels of linear sRGB; each column sums to
    1."""
    shape = color.SpectralShape(WAVELENGTHS[0], WAVELENGTHS[-1], 1)
    observer = color.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape).values
    d65 = color.SDS_ILLUMINANTS["D65"]
    xyz = observer * np.interp(WAVELENGTHS, d65.wavelengths, d65.values)[:, None]
    xyz /= xyz[:, 1].sum()
    to_xyz = PRIMARIES * np.linalg.solve(PRIMARIES, xyz.sum(axis=0))
    return xyz @ np.linalg.inv(to_xyz).T


def reflectance(cos, eta, k):
    """Evaluates Fresnel's equations for unpolarized light in air on a conductor."""
    n2 = (eta + 1j * k) ** 2
    behind = np.sqrt(n2 - (1 - cos * cos))
    s = (cos - behind) / (cos + behind)
    p = (n2 * cos - behind) / (n2 * cos + behind)
    return (np.abs(s) ** 2 + np.abs(p) ** 2) / 2


def spectral_curve(table, weights):
    """Returns unclamped linear sRGB at DEGREES, one row per angle."""
    return np.array([reflectance(cos, *table) @ weights for cos in np.cos(np.radians(DEGREES))])


def at_degrees(eta, k):
    """Returns the reflectance of one or more pairs at DEGREES, one row per angle."""
    return np.array([reflectance(cos, eta, k) for cos in np.cos(np.radians(DEGREES))])


def on_circle(normal):
    """Returns the pairs whose reflectance at normal incidence is `normal`:
    ((eta - 1)² + k²) / ((eta + 1)² + k²)."""
    root = np.sqrt(normal)
    eta = np.geomspace((1 - root) / (1 + root), (1 + root) / (1 - root), 20_001)
    k2 = (normal * (eta + 1) ** 2 - (eta - 1) ** 2) / (1 - normal)
    return eta, np.sqrt(np.maximum(k2, 0))


def fit(curve, mean_k):
    """Fits eta and k of one channel to `curve`, rounded to four digits."""
    if curve[0] < 1:
        eta, k = on_circle(curve[0])
        best = ((at_degrees(eta, k) - curve[:, None]) ** 2).sum(axis=0).argmin()
    else:
        eta = np.geomspace(1e-3, 1, 20_001)
        k = np.full_like(eta, mean_k)
        best = np.abs(at_degrees(eta, k) - curve[:, None]).max(axis=0).argmin()
    return float(f"{eta[best]:.4g}"), float(f"{k[best]:.4g}")


def derive(path, weights):
    """Returns the unclamped and the clamped curve, the pairs of eta and k, and the maximum
    deviation of each."""
    table = read_table(path)
    unclamped = spectral_curve(table, weights)
    curve = unclamped.clip(0, 1)
    pairs = [fit(curve[:, i], table[1] @ weights[:, i]) for i in range(3)]
    off = [np.abs(at_degrees(*pair) - curve[:, i]).max() for i, pair in enumerate(pairs)]
    return unclamped, curve, pairs, off


def numbers(values, digits=4):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def print_table(derived):
    print("metal      channel  integral  clamped      eta        k   fit at 0  off at most")
    for name, (unclamped, curve, pairs, off) in derived.items():
        for i, channel in enumerate(CHANNELS):
            eta, k = pairs[i]
            fitted = reflectance(1.0, eta, k)
            print(f"{name:10} {channel:7} {unclamped[0, i]:9.4f} {curve[0, i]:8.4f} {eta:8.4g} {k:8.4g} {fitted:10.4f} {off[i]:12.4f}")


def print_rust(derived, second):
    for name, (_, curve, pairs, _) in derived.items():
        eta, k = (", ".join(f"{pair[i]}" for pair in pairs) for i in range(2))
        print(f"    // {METALS[name][0]}: {numbers(curve[0])}.\n    metal(\"{name}\", [{eta}], [{k}]),")
    print(f"\nAt {', '.join(map(str, TESTED_DEGREES))} degrees:")
    for name, (_, curve, _, _) in derived.items():
        rows = ", ".join(f"[{numbers(curve[degrees])}]" for degrees in TESTED_DEGREES)
        print(f"    (\"{name}\", [{rows}]),")
    print("\nSecond tables:")
    for name, normal in second.items():
        print(f"    // {SECOND[name][0]}.\n    (\"{name}\", [{numbers(normal)}]),")


def compare(folder, derived, weights):
    """Prints the reflectance at normal incidence by the second tables; returns whether all are
    close enough."""
    second, near = {}, True
    print("\ntables of other samples, clamped, at normal incidence")
    for name, (source, file) in SECOND.items():
        for other in (file, *FURTHER[name]):
            if other != file and not (folder / other).exists():
                continue
            normal = spectral_curve(read_table(folder / other), weights)[0].clip(0, 1)
            apart = np.abs(normal - derived[name][1][0]).max()
            if other == file:
                second[name] = normal
                near &= apart <= SECOND_TOLERANCE
            print(f"{name:10} {other:32} {numbers(normal)}   apart {apart:.4f}{f'   {source}' if other == file else ''}")
    return second, near


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="`database/data` of the refractiveindex.info database")
    parser.add_argument("--rust", action="store_true", help="also print the numbers as Rust")
    parser.add_argument("--table", action="append", default=[], metavar="NAME=FILE", help="another table for a metal")
    arguments = parser.parse_args()
    files = {name: arguments.folder / file for name, (_, file) in METALS.items()}
    for name, separator, file in (table.partition("=") for table in arguments.table):
        if name not in files or not separator:
            sys.exit(f"--table takes NAME=FILE with one of {', '.join(files)}")
        files[name] = Path(file)
    weights = srgb_weights()
    derived = {name: derive(file, weights) for name, file in files.items()}
    print_table(derived)
    second, near = compare(arguments.folder, derived, weights)
    if arguments.rust:
        print()
        print_rust(derived, second)
    fits = all(max(off) <= FIT_TOLERANCE for *_, off in derived.values())
    return 0 if fits and near else 1


if __name__ == "__main__":
    sys.exit(main())
