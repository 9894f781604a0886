#!/usr/bin/env python3
"""Compiles the C++ of README.md and docs/*.md as a careful user's project would.

    tools/scripts/check_docs_code.py [--compiler CXX] [--include FOLDER]... [--list] [ROOT]

Every ```cpp block is compiled, without making code, under FLAGS. A block with a main() is a program
and is compiled as it stands. Others are fragments: each becomes the body of a function whose
parameters are the names of PREAMBLE that it uses and does not declare itself, and all of them are one
file. A fragment alone may leave a variable unused. Prints "skipped: ..." and exits 0 where there is
no such compiler. Errors name the line of the document.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FLAGS = ["-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
FRAGMENT_FLAGS = ["-Wno-unused-variable", "-Wno-unused-but-set-variable"]

# What fragments of the docs take as given.
PREAMBLE = {
    "scene": "mw::Scene& scene",
    "body": "mw::Body& body",
    "joint": "mw::Joint& joint",
    "plan": "const mw::Plan& plan",
    "batch": "mw::Batch& batch",
    "world": "int world",
    "crate": "mw::BodyId crate",
    "cabin": "mw::BodyId cabin",
    "hip": "mw::JointId hip",
    "knee": "mw::JointId knee",
    "force": "const mw::Vec3& force",
    "array": "const std::vector<double>& array",
    "actions": "const std::vector<float>& actions",
    "shape": "const mw::Shape& shape",
    "shape_a": "const mw::Shape& shape_a",
    "shape_b": "const mw::Shape& shape_b",
    "pose": "const mw::Pose& pose",
    "pose_a": "const mw::Pose& pose_a",
    "pose_b": "const mw::Pose& pose_b",
}
HEADERS = """#include <cstdio>
#include <optional>
#include <vector>

#include <manyworlds/manyworlds.hpp>
#include <manyworlds/live.hpp>
#include <manyworlds/film.hpp>
#include <manyworlds/gymnasium_mjcf.hpp>
#include <manyworlds/page.hpp>
#include <manyworlds/query.hpp>
#include <manyworlds/record.hpp>
namespace mw = manyworlds;
"""


def blocks(document):
    """(line of the first line of code, code) of each ```cpp block."""
    text = document.read_text(encoding="utf-8")
    for match in re.finditer(r"^```cpp\n(.*?)^```", text, re.S | re.M):
        yield text[: match.start(1)].count("\n") + 1, match[1]


def declares(code, name):
    """Does the code declare a variable of this name?"""
    return re.search(rf"[\w>&*]\s+&?{name}\s*[({{=;:]", re.sub(r"\b(return|else)\b", "", code))


def as_function(number, code):
    plain = re.sub(r'//.*|"[^"]*"', "", code)
    words = set(re.findall(r"(?<![.\w:])\w+", plain))
    given = [p for name, p in PREAMBLE.items() if name in words and not declares(plain, name)]
    return f"void fragment_{number}({', '.join(given)});\nvoid fragment_{number}({', '.join(given)})"


def programs_and_fragments(root):
    """(name, source, flags) of each file to compile."""
    files, fragments = [], HEADERS
    documents = [root / "README.md", *sorted((root / "docs").glob("*.md"))]
    for document in documents:
        name = document.relative_to(root).as_posix()
        for line, code in blocks(document):
            marked = f'#line {line} "{name}"\n{code}'
            if re.search(r"\bint main\(", code):
                files.append((f"{name}:{line}", marked, []))
            else:
                head = as_function(line, code)
                fragments += f'{head.replace("fragment_", f"{document.stem}_")} {{\n{marked}}}\n'
    files.append(("fragments", fragments, FRAGMENT_FLAGS))
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--include", action="append", default=[], help="of other libraries")
    parser.add_argument("--list", action="store_true", help="prints what would be compiled")
    parser.add_argument("root", nargs="?", default=Path(__file__).parents[2])
    arguments = parser.parse_args()
    root = Path(arguments.root).resolve()
    files = programs_and_fragments(root)
    if arguments.list:
        for name, source, _ in files:
            print(f"// ---- {name}\n{source}")
        return 0
    if shutil.which(arguments.compiler) is None:
        print(f"skipped: there is no {arguments.compiler} here")
        return 0
    includes = ["-I", str(root / "include")]
    for folder in arguments.include:
        includes += ["-isystem", folder]
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, source, flags in files:
            file = Path(folder) / "code.cpp"
            file.write_text(source, encoding="utf-8")
            command = [arguments.compiler, *FLAGS, *flags, *includes, "-fsyntax-only", str(file)]
            if subprocess.run(command, check=False).returncode != 0:
                print(f"{name} does not compile under {' '.join(FLAGS)}")
                failed += 1
    print(f"{len(files)} files, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
