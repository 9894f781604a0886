#!/usr/bin/env python3
"""Collects what the documentation site is made of: pages of the repository and the API reference.

    docs/site/collect.py ROOT OUTPUT

Every Markdown page keeps its path below OUTPUT, so that links between pages work there as they do in
the repository. README.md becomes the front page. The Python reference comes from the package's
sources and stubs, which are read, not imported; the C++ reference lists the public headers for
Doxygen's output (docs/site/Doxyfile).
"""

import pathlib
import re
import shutil
import subprocess
import sys

import header_filter
import python_reference
from plain_text import markdown

# Pages of the contents, in order, by their part of it. Pages that are not named follow in "More".
PARTS = {
    "Use": ["docs/python.md", "docs/cli.md", "docs/view.md", "docs/search.md", "docs/scale.md", "docs/embedding.md"],
    "Learn": ["docs/rl.md", "docs/gymnasium.md", "docs/training.md", "docs/planning.md", "docs/rl-speed.md"],
    "Model": ["docs/conventions.md", "docs/batch.md", "docs/variations.md", "docs/observers.md", "docs/recordings.md",
              "docs/robots.md", "docs/mujoco.md", "docs/plan.md", "docs/determinism.md", "docs/limits.md",
              "docs/glossary.md", "scenes/README.md"],
    "Measurements": ["docs/throughput.md", "docs/accuracy.md", "docs/stability.md", "docs/invariants.md",
                     "docs/reports.md", "bench/README.md"],
    "Reference": ["reference/python.md", "reference/cpp.md", "docs/cli-json.md"],
    "Project": ["docs/architecture.md", "docs/design.md", "docs/kernels.md", "docs/joint-solvers.md",
                "docs/extending.md", "docs/testing.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"],
}


def tracked(root, *patterns):
    """Files of the repository, also those that are not committed yet."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *patterns],
                            cwd=root, check=True, stdout=subprocess.PIPE, text=True)
    return [path for path in listed.stdout.splitlines() if (root / path).is_file()]


def copy_pages(root, output):
    pages = [page for page in tracked(root, "*.md") if not page.startswith("docs/site/")]
    pictures = tracked(root, "docs/*.svg", "docs/*.png")
    for path in pages + pictures:
        (output / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / path, output / path)
    return [page for page in pages if page != "README.md"]


def cpp_pages(root, output):
    """A page for each public header, and one that lists them with their first sentence."""
    lines = ["# C++ reference", "", "`#include <manyworlds/manyworlds.hpp>` includes all of these but `mjcf.hpp`,",
             "`record.hpp` and `live.hpp`, which belong to libraries of their own.", "",
             "| header | subject |", "|---|---|"]
    names = []
    for header in tracked(root, "include/manyworlds/*.hpp"):
        name = pathlib.PurePath(header).stem
        text = header_filter.top_comment((root / header).read_text(encoding="utf-8").splitlines())
        summary = re.split(r"\.(?:\s|$)", " ".join(text))[0].replace("|", "\\|")
        about = "\n".join(markdown("\n".join(text)))
        (output / f"reference/cpp/{name}.md").write_text(
            f"# {name}.hpp\n\n{about}\n```{{doxygenfile}} {name}.hpp\n:project: manyworlds\n"
            ":sections: briefdescription detaileddescription innernamespace innerclass enum typedef func var "
            "public-type public-func public-static-func public-attrib public-static-attrib user-defined\n```\n",
            encoding="utf-8")
        lines.append(f"| [`{name}.hpp`](cpp/{name}.md) | {summary} |")
        names.append(f"cpp/{name}")
    lines += ["", "```{toctree}", ":hidden:", "", *names, "```", ""]
    (output / "reference/cpp.md").write_text("\n".join(lines), encoding="utf-8")


def contents(output, pages):
    """The tables of contents at the end of the front page."""
    named = {page for part in PARTS.values() for page in part}
    parts = dict(PARTS)
    more = [page for page in pages if page not in named]
    if more:
        parts["More"] = more
    text = []
    for part, members in parts.items():
        there = [page.removesuffix(".md") for page in members if (output / page).is_file()]
        text += ["", "```{toctree}", ":hidden:", f":caption: {part}", "", *there, "```"]
    return "\n".join(text) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    root, output = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    shutil.rmtree(output, ignore_errors=True)
    (output / "reference/cpp").mkdir(parents=True)
    pages = copy_pages(root, output)
    cpp_pages(root, output)
    python_reference.write(root / "python", output / "reference")
    front = (root / "README.md").read_text(encoding="utf-8")
    (output / "README.md").write_text(front + contents(output, pages), encoding="utf-8")


if __name__ == "__main__":
    main()
