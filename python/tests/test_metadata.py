"""One version everywhere, and the files about the project."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import manyworlds as mw

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
VERSION = PROJECT["version"]
STATED = {
    "CMakeLists.txt": r"project\(manyworlds VERSION (\S+)",
    "python/CMakeLists.txt": r"project\(manyworlds_python VERSION (\S+)",
    "tools/base/version.hpp": r'#define MW_VERSION "([^"]+)"',
    "CITATION.cff": r"(?m)^version: (\S+)$",
    "viewer/package.json": r'(?m)^  "version": "([^"]+)"',
    "viewer/package-lock.json": r'(?m)^  "version": "([^"]+)"',
    "CHANGELOG.md": r"(?m)^## (\S+)$",
}


@pytest.mark.parametrize("file", STATED)
def test_the_version_is_that_of_the_project(file):
    found = re.search(STATED[file], (ROOT / file).read_text())
    assert found and found[1] == VERSION


def test_the_package_has_it():
    assert mw.__version__ == VERSION


def test_users_ask_cmake_for_it():
    files = [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("examples/*/CMakeLists.txt")]
    files.append(ROOT / "python/CMakeLists.txt")
    asked = {
        str(file.relative_to(ROOT)): re.findall(r"find_package\(manyworlds (\S+)", file.read_text())
        for file in files
    }
    assert sum(bool(versions) for versions in asked.values()) >= 7
    minor = VERSION.rpartition(".")[0]
    for file, versions in asked.items():
        assert set(versions) <= {minor}, file


def test_the_metadata_name_what_is_supported():
    assert PROJECT["license"] == "MIT" and (ROOT / PROJECT["license-files"][0]).is_file()
    assert not [c for c in PROJECT["classifiers"] if c.startswith("License ::")]  # PEP 639
    for version in ("3.10", "3.11", "3.12", "3.13"):
        assert f"Programming Language :: Python :: {version}" in PROJECT["classifiers"]
    assert PROJECT["requires-python"] == ">=3.10"


def test_the_citation_is_complete():
    """The members that the schema of citation files 1.2.0 requires."""
    text = (ROOT / "CITATION.cff").read_text()
    for member in ("cff-version: 1.2.0", "message: ", "title: ", "authors:\n  - name: ", "license: MIT"):
        assert f"\n{member}" in f"\n{text}", member


def test_the_changelog_has_five_sections_of_single_facts():
    text = (ROOT / "CHANGELOG.md").read_text()
    newest = text.split(f"## {VERSION}\n")[1].split("\n## ")[0]
    sections = ["Added", "Changed", "Fixed", "Performance", "Removed"]
    assert re.findall(r"(?m)^### (.*)$", newest) == sections
    lines = [line for line in newest.splitlines() if line and not line.startswith("#")]
    assert len(lines) > 100
    for line in lines:
        assert line.startswith("- ") and line.endswith("."), line
        assert len(line[2:].split()) <= 25, line


@pytest.mark.parametrize("file", ["CONTRIBUTING.md", "SECURITY.md"])
def test_files_that_are_named_exist(file):
    """What is in backquotes with a folder in front is a file or a folder of the repository."""
    text = (ROOT / file).read_text()
    for name in re.findall(r"`([a-z.][\w.-]*/[\w./-]*)[ `]", text):
        if "NAME" in name or name.startswith("build") or "x.py" in name:
            continue
        assert (ROOT / name).exists(), name


def test_every_fuzzer_is_named():
    text = (ROOT / "SECURITY.md").read_text()
    for source in ROOT.glob("fuzz/*_fuzz.cpp"):
        assert f"`{source.stem}`" in text
