"""The command `pontoon`, and `python -m pontoon`: the command line of the program."""

import sys

from ._pontoon import main as command_line


def main() -> int:
    """Runs the command line and returns the exit code."""
    return command_line(["pontoon", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
