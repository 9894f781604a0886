#!/usr/bin/env python3
"""Includes run downward only: fails on every #include that goes up, sideways or out of bounds.

    tools/scripts/check_floors.py [ROOT]

Prints each violation as file:line and exits 1 when there is one. What the floors are is written in
the tables below and drawn in docs/architecture.md. Also fails on files over 400 lines that do not
give their reason near the top.
"""

import re
import sys
from pathlib import Path

# A file in src/ includes its own and lower floors.
SRC_FLOORS = ["base", "lcp", "scene", "plan", "state", "dispatch", "step", "api", "task"]
# Off the column: read models into a Scene, describe worlds to the page, record a Batch, show it live, film the page. They
# may know nothing below the public headers but these.
SRC_SIDE = {
    "mjcf": {"mjcf", "base"}, "page": {"page", "base"}, "record": {"record", "page", "base"},
    "live": {"live", "page", "base"}, "film": {"film", "page", "base"}}
# Floors that may see kernels/data (tables and views, no lanes).
SRC_SEES_KERNELS = {"plan", "state", "dispatch", "step", "api", "task"}
# A geometry's file names the kind of shape that the kernels take it for.
SCENE_SEES_KERNELS = "kernels/data/shape_kinds.hpp"

# The rooms of kernels/, each a floor. Data is plain and shared with src; the others are compiled per
# instruction set. What lies in kernels/ itself puts the rooms together, above all of them.
KERNEL_ROOMS = [
    "data", "lane", "work", "shape", "sleep", "broad", "collide", "rows", "motion", "joint", "direct", "flight",
    "tree", "solver", "observe", "program"]
MAX_KERNEL_FILES_ON_TOP = 12
# Tables without functions, which the kernels' data shares with the public headers.
KERNELS_SEE = {"manyworlds/field_table.hpp", "manyworlds/observed.hpp"}
KERNEL_SYSTEM = {
    "cfloat", "climits", "cmath", "concepts", "cstddef", "cstdint", "immintrin.h",
    "initializer_list", "limits",
    "type_traits", "utility",
}
# The program: what its parts share, models beside MuJoCo's, families of random scenes, the reports, the
# command line.
TOOLS_FLOORS = ["base", "compare", "invariants", "report", "cli"]
# Third-party headers with one home: pattern -> folder whose files may include it, and how many.
ONE_HOME = {
    r"(oneapi/)?tbb[/.].*": ("src", 1),
    r"xsimd/.*": ("kernels", 1),
    r"mujoco/.*": ("src/mjcf", None),
    r"tinyxml2\.h": ("src/mjcf", None),
    r"hdf5\.h": ("src/record", 1),
    r"zlib\.h": ("src/page", 1),
    r"boost/.*": ("src/live", None),
    r"libqhull_r/.*": ("src/scene", 1),
    r"nlohmann/.*": ("src/page", 1),
    r"nanobind/.*": ("python/src", None),
}
# Where third-party headers have to be at home; tests and benchmarks may drive a library themselves.
OF_THE_LIBRARY = ("src/", "kernels/", "include/", "scenes/", "python/")
# Public headers include the standard library (no dot, no slash), Eigen and each other.
PUBLIC_SYSTEM = re.compile(r"[a-z_0-9]+|Eigen/\w+")

FOLDERS = ["include", "src", "kernels", "scenes", "tests", "bench", "tools", "examples", "python"]
# Scenes are made from the public headers, in the mode in which the library computes.
SCENES_SEE = "src/base/float_mode.hpp"

LINE_LIMIT = 400
REASON = "over 400 lines because"
REASON_WITHIN = 15

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def includes(path):
    """(line number, quoted, name) of each include of a file."""
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            found.append((number, match[1] == '"', match[2]))
    return found


def kernel_floor(name):
    """Floor of a file in kernels/, given its path from the root; None where it is in no room."""
    parts = Path(name).parts
    if len(parts) == 2:
        return len(KERNEL_ROOMS)
    return KERNEL_ROOMS.index(parts[1]) if len(parts) == 3 and parts[1] in KERNEL_ROOMS else None


def is_kernel_data(name):
    return name.startswith("kernels/data/")


def check_src(file, name):
    """Why a file of src/ may not include `name`, or None."""
    floor = Path(file).parts[1]
    if name.startswith("src/"):
        target = Path(name).parts[1]
        if floor in SRC_SIDE:
            return None if target in SRC_SIDE[floor] else f"src/{floor} may not include src/{target}"
        if floor not in SRC_FLOORS:
            return f"src/{floor} is not a floor of src"
        if target not in SRC_FLOORS:
            return f"src/{target} is not in the column of floors"
        if SRC_FLOORS.index(target) > SRC_FLOORS.index(floor):
            return f"goes up from src/{floor} to src/{target}"
    elif name.startswith("kernels/"):
        if floor == "scene" and name == SCENE_SEES_KERNELS:
            return None
        if floor not in SRC_SEES_KERNELS:
            return f"src/{floor} may not include the kernels"
        if not is_kernel_data(name):
            return "src may include the kernels' plain data headers only"
    elif name.startswith("scenes/"):
        return "src may not include the scenes"
    return None


def check_kernel(file, name, quoted):
    """Why a file of kernels/ may not include `name`, or None."""
    if name.startswith("kernels/"):
        floor, target = kernel_floor(file), kernel_floor(name)
        for path, place in ((file, floor), (name, target)):
            if place is None:
                return f"{Path(path).parent} is not a room of kernels"
        return "goes up inside kernels" if target > floor else None
    if quoted:
        shared = is_kernel_data(file) and name in KERNELS_SEE
        return None if shared else "kernels include kernels only"
    if name not in KERNEL_SYSTEM and not name.startswith("xsimd/"):
        return "kernels may not include this (its code would be compiled per instruction set)"
    return None


def check_public(name, quoted):
    """Why a public header may not include `name`, or None."""
    if quoted:
        return None if name.startswith("manyworlds/") else "public headers include manyworlds/ only"
    return None if PUBLIC_SYSTEM.fullmatch(name) else "public headers include std and Eigen only"


def check_tools(file, name):
    """Why a file of tools/ may not include `name`, or None."""
    floor, target = Path(file).parts[1], Path(name).parts[1]
    for part in (floor, target):
        if part not in TOOLS_FLOORS:
            return f"tools/{part} is not a floor of tools"
    if TOOLS_FLOORS.index(target) > TOOLS_FLOORS.index(floor):
        return f"goes up from tools/{floor} to tools/{target}"
    return None


def check_include(file, name, quoted):
    top = Path(file).parts[0]
    if top == "src":
        return check_src(file, name)
    if top == "kernels":
        return check_kernel(file, name, quoted)
    if top == "include":
        return check_public(name, quoted)
    if top == "tools" and name.startswith("tools/"):
        return check_tools(file, name)
    if top == "python" and name.startswith(("src/", "kernels/", "tools/", "tests/")):
        return "the bindings see the public headers"
    if top == "scenes" and name.startswith(("src/", "kernels/")) and name != SCENES_SEE:
        return "scenes are made from the public headers"
    return None


def homes(graph):
    """Violations of ONE_HOME."""
    found = []
    for pattern, (home, limit) in ONE_HOME.items():
        users = {}
        for file, lines in graph.items():
            for number, _, name in lines:
                if re.fullmatch(pattern, name):
                    users.setdefault(file, (number, name))
        inside = [f for f in users if f.startswith(home + "/")]
        for file, (number, name) in users.items():
            if file not in inside and file.startswith(OF_THE_LIBRARY):
                found.append((file, number, f"<{name}> belongs in {home}"))
            elif limit is not None and file in inside[limit:]:
                found.append((file, number, f"<{name}> is already included by {inside[0]}"))
    return found


def resolve(file, name, graph):
    """The file of the tree that a quoted include means: from the root, include/ or beside it."""
    candidates = (name, f"include/{name}", (Path(file).parent / name).as_posix())
    return next((c for c in candidates if c in graph), None)


def cycles(graph):
    """One violation per include circle, at the include that closes it."""
    found, done, path = [], set(), []

    def visit(file):
        path.append(file)
        for number, _, name in graph[file]:
            target = resolve(file, name, graph)
            if target in path:
                circle = " > ".join(path[path.index(target):] + [target])
                found.append((file, number, f"closes the include cycle {circle}"))
            elif target is not None and target not in done:
                visit(target)
        path.pop()
        done.add(file)

    for file in graph:
        if file not in done:
            visit(file)
    return found


def crowded(files):
    """A violation when more lies in kernels/ itself than what puts its rooms together."""
    top = [file for file in files if len(Path(file).parts) == 2 and file.startswith("kernels/")]
    if len(top) <= MAX_KERNEL_FILES_ON_TOP:
        return []
    return [(top[-1], 1, f"is one of {len(top)} files in kernels/ itself, at most "
                         f"{MAX_KERNEL_FILES_ON_TOP} may be; its rooms are {', '.join(KERNEL_ROOMS)}")]


def too_long(root, files):
    found = []
    for file in files:
        lines = (root / file).read_text(encoding="utf-8").splitlines()
        if len(lines) > LINE_LIMIT and not any(REASON in l for l in lines[:REASON_WITHIN]):
            found.append((file, LINE_LIMIT + 1,
                          f"{len(lines)} lines, and no line near the top says '{REASON} ...'"))
    return found


def check(root):
    """All violations as (file, line, message), and the number of files and includes seen."""
    code, texts = [], []
    for folder in FOLDERS + ["cmake", ".ci", "viewer"]:
        for path in sorted((root / folder).rglob("*")):
            if not path.is_file() or {"__pycache__", "node_modules"} & set(path.parts):
                continue
            file = path.relative_to(root).as_posix()
            if path.suffix in (".cpp", ".hpp", ".h"):
                code.append(file)
            if path.suffix in (".cpp", ".hpp", ".h", ".py", ".sh", ".cmake", ".ts", ".mjs", ""):
                texts.append(file)
    graph = {file: includes(root / file) for file in code}
    found = []
    for file, lines in graph.items():
        for number, quoted, name in lines:
            why = check_include(file, name, quoted)
            if why:
                found.append((file, number, f"{name}: {why}"))
            elif quoted and resolve(file, name, graph) is None:
                found.append((file, number, f"{name}: there is no such file"))
    found += homes(graph) + cycles(graph) + crowded(code) + too_long(root, texts)
    return sorted(found), len(graph), sum(map(len, graph.values()))


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    found, files, count = check(root)
    for file, line, message in found:
        print(f"{file}:{line}: {message}")
    if not files:
        print(f"{root}: no source files here")
        return 1
    print(f"{files} files, {count} includes, {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
