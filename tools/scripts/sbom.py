#!/usr/bin/env python3
"""Writes the software bill of materials of a Python wheel: CycloneDX 1.6, validated.

    tools/scripts/sbom.py --hdf5 .deps/hdf5 --viewer build/release/viewer --nanobind VERSION OUT.json

It lists what cmake/third_party.txt names, with the versions of Debian's packages that are installed, HDF5 of
its own, nanobind, and the npm packages that the pages bundle. auditwheel adds a second document about the
files of shared libraries that it copies. Needs cyclonedx-python-lib[json-validation]. Exit 1: not valid, or a
version is unknown.
"""

import argparse
import json
import pathlib
import platform
import re
import subprocess
import sys
import tomllib

from cyclonedx.model import ExternalReference, ExternalReferenceType, Property, XsUri
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from packageurl import PackageURL

ROOT = pathlib.Path(__file__).resolve().parents[2]
DISTRIBUTION = "{ID}-{VERSION_ID}".format(**platform.freedesktop_os_release())


def component(name, version, license_id, purl, how, home=None):
    """A library, how it is contained ("headers", "static", "shared" or "bundled"), and its home page."""
    references = (
        [ExternalReference(type=ExternalReferenceType.WEBSITE, url=XsUri(home))] if home else []
    )
    return Component(
        type=ComponentType.LIBRARY,
        name=name,
        version=version,
        bom_ref=str(purl),
        purl=purl,
        licenses=[LicenseExpression(license_id)],
        external_references=references,
        properties=[Property(name="manyworlds:contained_as", value=how)],
    )


def debian_version(package):
    command = ["dpkg-query", "--show", "--showformat=${Version}", package]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def listed(hdf5):
    """The components of cmake/third_party.txt; HDF5 is that of tools/scripts/build_hdf5.sh where it is given."""
    for line in (ROOT / "cmake/third_party.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        name, package, license_id, _, how, home = line.split()
        if name == "HDF5" and hdf5:
            version, how = (hdf5 / "hdf5_version").read_text().strip(), "static"
            crate, crate_version = (hdf5 / "version").read_text().replace(",", "").split()[:2]
            purl = PackageURL("cargo", None, crate, crate_version)
        else:
            version = debian_version(package)
            purl = PackageURL("deb", "debian", package, version, {"distro": DISTRIBUTION})
        yield component(name, version, license_id, purl, how, home)


def of_nanobind(version):
    home = "https://github.com/wjakob/nanobind"
    yield component(
        "nanobind",
        version,
        "BSD-3-Clause",
        PackageURL("pypi", None, "nanobind", version),
        "static",
        home,
    )
    robin_map = PackageURL("github", "Tessil", "robin-map")
    yield component(
        "robin-map", None, "MIT", robin_map, "headers", "https://github.com/Tessil/robin-map"
    )


def bundled(viewer):
    """The npm packages of viewer.html and report.html: each has its licence in LICENSES.txt."""
    lock = json.loads((ROOT / "viewer/package-lock.json").read_text())["packages"]
    text = (viewer / "LICENSES.txt").read_text()
    for name, version in re.findall(
        r"^((?:@[\w.-]+/)?[\w.-]+) (\d+\.\d+\.\d+[\w.-]*)$", text, re.M
    ):
        entry = lock.get(f"node_modules/{name}")
        if entry is None or entry["version"] != version:
            sys.exit(f"sbom: viewer/package-lock.json has no {name} {version}")
        namespace, _, short = name.rpartition("/")
        purl = PackageURL("npm", namespace or None, short, version)
        yield component(name, version, entry["license"], purl, "bundled")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--hdf5", type=pathlib.Path, help="what tools/scripts/build_hdf5.sh made")
    parser.add_argument("--viewer", type=pathlib.Path, help="folder with LICENSES.txt of the pages")
    parser.add_argument("--nanobind", help="its version")
    given = parser.parse_args()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    purl = PackageURL("pypi", None, project["name"], project["version"])
    root = Component(
        type=ComponentType.LIBRARY,
        name=project["name"],
        version=project["version"],
        bom_ref=str(purl),
        purl=purl,
        licenses=[LicenseExpression("MIT")],
    )
    parts = list(listed(given.hdf5))
    if given.nanobind:
        parts += of_nanobind(given.nanobind)
    if given.viewer:
        parts += bundled(given.viewer)
    bom = Bom(components=parts)
    bom.metadata.component = root
    bom.register_dependency(root, parts)
    text = JsonV1Dot6(bom).output_as_string(indent=2)
    problem = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if problem is not None:
        sys.exit(f"sbom: not valid CycloneDX 1.6: {problem}")
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_text(text + "\n")


if __name__ == "__main__":
    main()
