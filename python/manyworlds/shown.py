"""Text of values: a line for repr(), tables for notebooks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from html import escape
from reprlib import Repr
from typing import Any

MAX_ROWS = 50  # rows of a table
_MAX_LINE = 100  # characters
_short = Repr()
_short.maxstring = _short.maxother = 32


def short(value: Any) -> str:
    """repr() of a name or a number, at most 32 characters."""
    return _short.repr(value)


def count(things: Any, one: str, many: str) -> str:
    """ "1 body", "3 bodies"; the type of a value that is not a list."""
    try:
        n = len(things)
    except TypeError:
        return f"{many}: {type(things).__name__}"
    return f"{n} {one if n == 1 else many}"


def line(kind: str, name: Any, *parts: str) -> str:
    """ "<manyworlds.Scene 'towers': spatial, 6 bodies>"."""
    text = f"<manyworlds.{kind}{f' {short(name)}' if name else ''}: {', '.join(parts)}"
    return (text if len(text) < _MAX_LINE else text[: _MAX_LINE - 4] + "...") + ">"


def attempt(f: Callable[[], Any]) -> Any:
    """The result of f; "?" if a value has a wrong type."""
    try:
        return f()
    except (AttributeError, TypeError):
        return "?"


def table(caption: str, head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """An HTML table of at most MAX_ROWS rows, with escaped texts."""
    rows = list(rows)
    if not rows:
        return f"<p>{escape(caption)}: none</p>"

    def row(cells: Iterable[Any], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(str(c))}</{tag}>" for c in cells) + "</tr>"

    shown = [row(r, "td") for r in rows[:MAX_ROWS]]
    if len(rows) > MAX_ROWS:
        shown.append(f'<tr><td colspan="{len(head)}">... {len(rows) - MAX_ROWS} more</td></tr>')
    body = "".join(shown)
    return (
        f"<table><caption>{escape(caption)}</caption><thead>{row(head, 'th')}</thead>"
        f"<tbody>{body}</tbody></table>"
    )
