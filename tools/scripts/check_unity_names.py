#!/usr/bin/env python3
"""Functions in unnamed namespaces of one folder have names of their own.

With MW_UNITY the files of a folder are compiled as one. Two of the same signature are an error there. Two of
different ones are overloads: a call may take that of another file, with no word from the compiler.

    check_unity_names.py ROOT
"""
import re
import sys
from collections import defaultdict
from pathlib import Path

FOLDERS = ("tests", "tools/invariants", "tools/report")
UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
FUNCTION = re.compile(r"^(?!return\b|using\b|#|//)[\w:][\w:<>,&* ]*[ &*]([a-z]\w*)\(", re.M)


def functions(text):
    """Names of the functions that unnamed namespaces of a file define."""
    return {name for part in UNNAMED.findall(text) for name in FUNCTION.findall(part)}


def problems(root):
    for top in FOLDERS:
        folders = defaultdict(lambda: defaultdict(list))
        for file in sorted((root / top).rglob("*.cpp")):
            for name in functions(file.read_text()):
                folders[file.parent][name].append(file.name)
        for folder, names in folders.items():
            for name, files in sorted(names.items()):
                if len(files) > 1:
                    yield f"{folder.relative_to(root)}: {name}() is in {', '.join(files)}"


def main():
    found = list(problems(Path(sys.argv[1]).resolve()))
    print("\n".join(found + [f"{len(found)} names that files of a folder share"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
