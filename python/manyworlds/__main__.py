"""``python -m manyworlds``, and the command ``manyworlds``: runs the program that this package contains."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from .film import encoder_program
from .mjcf import _library as mujoco_library

_PROGRAM = Path(__file__).with_name("bin") / "manyworlds"


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
    try:
        os.environ.setdefault("MANYWORLDS_MUJOCO", str(mujoco_library()))
    except ImportError as error:  # the program reports it if it reads a model
        os.environ["MANYWORLDS_NO_MUJOCO"] = str(error)
    if encoder := encoder_program():
        os.environ["FFMPEG"] = encoder
    os.execv(_PROGRAM, ["manyworlds", *sys.argv[1:]])


if __name__ == "__main__":
    main()
