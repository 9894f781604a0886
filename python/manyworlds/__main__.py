"""``python -m manyworlds`` and the command ``manyworlds``: run the program in this package."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path

_PROGRAM = Path(__file__).with_name("bin") / "manyworlds"


def _mujoco_library() -> Path | None:
    """The libmujoco of the installed package mujoco-core. The program opens it to read MJCF."""
    found = importlib.util.find_spec("mujoco")
    folders = (found.submodule_search_locations or []) if found else []
    libraries = sorted(
        library for folder in folders for library in Path(folder).glob("libmujoco.so.*")
    )
    return libraries[-1] if libraries else None


def main() -> None:
    """Replaces this process by the program, which then sets the exit status and handles signals.

    Exits with status 3 if this build of the package has no program.
    """
    if not os.access(_PROGRAM, os.X_OK):
        print(
            f"manyworlds: error: {_PROGRAM} does not exist: this package was built without the program. "
            "Wheels made by tools/wheel contain it; tools/run in the repository builds it",
            file=sys.stderr,
        )
        sys.exit(3)
    library = _mujoco_library()
    if library is not None:
        os.environ.setdefault("MANYWORLDS_MUJOCO", str(library))
    os.execv(_PROGRAM, ["manyworlds", *sys.argv[1:]])


if __name__ == "__main__":
    main()
