"""The command `stickslip`, as `python -m stickslip` and as the program that pip installs."""

from __future__ import annotations

import sys

from . import _core


def main() -> int:
    """Does what the command line asks for, and gives the exit code."""
    return _core.command(["stickslip", *sys.argv[1:]], [sys.executable, "-m", "stickslip"])


if __name__ == "__main__":
    sys.exit(main())
