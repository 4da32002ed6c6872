"""The command `lightmesh`, also as `python -m lightmesh`."""

import sys

from ._lightmesh import command


def main() -> int:
    """Runs the command line program with the arguments of this process."""
    return command(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
