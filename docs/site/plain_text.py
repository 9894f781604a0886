"""Markdown of plain text, as docstrings and comments of headers are written."""

import re


def markdown(text):
    """The blocks of a text: columns and indented lines stay as they are, the rest flows."""
    blocks = []
    for paragraph in re.split(r"\n\s*\n", text.strip("\n")):
        part, columns = [], None
        for line in paragraph.splitlines():
            kept = line.startswith("  ") or re.search(r"\S {2,}\S", line) is not None
            if part and kept != columns:
                blocks += block(part, columns)
                part = []
            part.append(line)
            columns = kept
        blocks += block(part, columns)
    return blocks


def block(lines, columns):
    if columns:
        return ["~~~text", *lines, "~~~", ""]
    text = "\n".join(lines).replace("``", "`")
    # Outside of code, marks of Markdown are characters like others.
    pieces = re.split(r"(`[^`]*`)", text)
    return ["".join(piece if piece.startswith("`") else re.sub(r"([*_<\\[\]#|])", r"\\\1", piece)
                    for piece in pieces), ""]
