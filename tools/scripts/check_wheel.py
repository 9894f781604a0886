#!/usr/bin/env python3
"""Checks what a Python wheel of ours contains: libraries, the program, pages, licences, bill of materials.

    tools/scripts/check_wheel.py WHEEL

Prints what is wrong; exit 1. On success prints the size and the libraries.
"""

import json
import pathlib
import re
import sys
import zipfile

MAX_MEGABYTES = 12
PLATFORM = "manylinux_2_34_x86_64"  # Debian 12's TBB needs glibc 2.34
# Copied in by auditwheel, which adds a hash to the name.
COPIED = {"fmt": "fmt", "qhull_r": "qhull", "tbb": "TBB", "tinyxml2": "tinyxml2"}


def problems(path):
    archive = zipfile.ZipFile(path)
    names = archive.namelist()
    megabytes = path.stat().st_size / 1e6
    if megabytes > MAX_MEGABYTES:
        yield f"has {megabytes:.1f} MB; expected {MAX_MEGABYTES} MB at most"

    if not path.stem.endswith(f"-{PLATFORM}"):
        yield f"has not the platform {PLATFORM}: something needs newer system libraries"

    # Ours lie in the package, each once; others in manyworlds_sim.libs.
    for wanted in (
        "libmanyworlds.so",
        "libmanyworlds_live.so",
        "libmanyworlds_mjcf.so",
        "libmanyworlds_record.so",
        "viewer.html",
        "report.html",
        "bin/manyworlds",
    ):
        if names.count(f"manyworlds/{wanted}") != 1:
            yield f"has no manyworlds/{wanted}"
    for shell in ("bash-completion/completions/manyworlds", "zsh/site-functions/_manyworlds"):
        if not any(name.endswith(f".data/data/share/{shell}") for name in names):
            yield f"has no share/{shell}"
    copied = [name for name in names if ".libs/" in name and not name.endswith("/")]
    for name in copied:
        if re.sub(r"^lib|-[0-9a-f]{8}.*$", "", name.rpartition("/")[2]) not in COPIED:
            yield f"contains {name}; expected of other projects only {', '.join(COPIED)}"
    program = next(
        (i for i in archive.infolist() if i.filename == "manyworlds/bin/manyworlds"), None
    )
    if program is not None and not program.external_attr >> 16 & 0o111:
        yield "has a manyworlds/bin/manyworlds that is not executable"
    for module in ("_core", "_live", "_mjcf", "_record"):
        found = [name for name in names if re.fullmatch(rf"manyworlds/{module}\..*so", name)]
        suffix = ".abi3.so" if "-abi3-" in path.name else ".so"
        if len(found) != 1 or not found[0].endswith(suffix):
            yield f"has modules {found}; expected one manyworlds/{module}{suffix}"

    # Each component has its licence.
    info = next(name.split("/")[0] for name in names if name.endswith(".dist-info/METADATA"))
    documents = [n for n in names if n.startswith(f"{info}/sboms/") and n.endswith(".json")]
    components = []
    for name in documents:
        document = json.loads(archive.read(name))
        if document.get("bomFormat") != "CycloneDX":
            yield f"{name} is not a CycloneDX document"
        components += document.get("components", [])
    if f"{info}/sboms/manyworlds.cdx.json" not in documents:
        yield "has no bill of materials"
    listed = {component["name"] for component in components}
    for name in copied:
        library = re.sub(r"^lib|-[0-9a-f]{8}.*$", "", name.rpartition("/")[2])
        if COPIED.get(library) not in listed:
            yield f"does not list {name} in its bill of materials"
    pages = f"{info}/licenses/viewer/LICENSES.txt"
    bundled = archive.read(pages).decode() if pages in names else ""
    ours = json.loads(archive.read(f"{info}/sboms/manyworlds.cdx.json"))["components"]
    for component in ours:
        name, purl = component["name"], component["purl"]
        if purl.startswith("pkg:npm/"):
            if f"{name} {component['version']}\n" not in bundled:
                yield f"has no licence of {name}, which a page contains, in {pages}"
        elif not any(n.startswith(f"{info}/licenses/{name}/") for n in names):
            yield f"has no licence of {name}"
    for wanted in (
        "CLI11",
        "fmt",
        "nlohmann-json",
        "Boost",
        "Eigen",
        "xsimd",
        "qhull",
        "TBB",
        "HDF5",
        "zlib",
        "tinyxml2",
        "nanobind",
        "three",
        "@observablehq/plot",
        "d3-array",
    ):
        if wanted not in {component["name"] for component in ours}:
            yield f"does not list {wanted} in its bill of materials"


def main():
    path = pathlib.Path(sys.argv[1])
    found = list(problems(path))
    for problem in found:
        print(f"check_wheel: {path.name} {problem}", file=sys.stderr)
    libraries = [n for n in zipfile.ZipFile(path).namelist() if re.search(r"\.so[.\d]*$", n)]
    print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB; {' '.join(libraries)}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
