"""The program `juggler`."""

import sys


def main():
    """Runs the program with the words of the command line, and exits with its status."""
    from juggler import _native

    sys.exit(_native.main(["juggler", *sys.argv[1:]]))
