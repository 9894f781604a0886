#!/usr/bin/env python3
"""Turns a header's plain comments into Doxygen's, line by line, so that lines keep their numbers.

    docs/site/header_filter.py HEADER

`//` before a declaration becomes `///`, `//` after one becomes `///<`. Lines that are indented in a
comment, such as formulas, stay as they are. Doxygen's own marks are escaped. The comment at the top
of a file is left out: docs/site/collect.py puts it on the header's page.
"""

import re
import sys

COMMENT = re.compile(r"^(\s*)//(?!/) ?(.*)$")
TRAILING = re.compile(r"^(.*\S\s*)//(?!/) ?(.*)$")
HEADING = re.compile(r"^\s*// -")


def top_comment(lines):
    """The comment at the top of a file, as lines of text."""
    text = []
    for line in lines:
        comment = COMMENT.match(line)
        if not comment:
            break
        text.append(comment[2])
    return text


def escaped(text):
    text = re.sub(r"([\\@<>#])", r"\\\1", text)
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", text)


def block(lines):
    """The lines of one comment, as (indentation, text)."""
    indented = [text.startswith("  ") for _, text in lines]
    for i, (margin, text) in enumerate(lines):
        if not indented[i]:
            yield f"{margin}/// {escaped(text)}"
            continue
        first = i == 0 or not indented[i - 1]
        last = i + 1 == len(lines) or not indented[i + 1]
        yield f"{margin}/// " + "\\verbatim " * first + text + " \\endverbatim" * last


def filtered(lines):
    yield from ("" for _ in top_comment(lines))
    lines = lines[len(top_comment(lines)):]
    comment = []
    for line in [*lines, ""]:
        match = COMMENT.match(line)
        if match and not HEADING.match(line):
            comment.append((match[1], match[2]))
            continue
        yield from block(comment)
        comment = []
        trailing = TRAILING.match(line)
        if trailing and trailing[1].rstrip().endswith((";", ",", "{", "}")) and '"' not in trailing[2]:
            line = f"{trailing[1]}///< {escaped(trailing[2])}"
        yield line


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(filtered(file.read().splitlines())))


if __name__ == "__main__":
    main()
