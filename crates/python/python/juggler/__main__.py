"""The program: `python -m juggler` is the command `juggler`."""

from juggler._program import main

main()
