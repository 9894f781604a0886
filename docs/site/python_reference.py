"""Writes the Python reference as Markdown pages for Sphinx, one for each public module.

griffe reads sources and stubs of the package without importing it, so that nothing has to be built.
The text of an entry is its docstring, which is what help() shows.
"""

import griffe

from plain_text import markdown

# The public modules, in the order of the contents. `manyworlds` itself has what `import manyworlds as mw` gives.
MODULES = ("manyworlds", "manyworlds.tasks", "manyworlds.query", "manyworlds.scenes", "manyworlds.mjcf",
           "manyworlds.record", "manyworlds.plot", "manyworlds.search", "manyworlds.gym", "manyworlds.sb3",
           "manyworlds.ray")


def members(module):
    """Public names of a module: those in __all__, or what it defines."""
    if module.exports:
        names = [str(name) for name in module.exports]
    else:
        names = [name for name, member in module.members.items()
                 if not name.startswith("_") and not member.is_alias and not member.is_module]
    return [(name, module.members[name]) for name in names
            if name in module.members and not name.startswith("__")]


def resolved(member):
    """The object behind an alias, or None where it is outside of the package (numpy's, say)."""
    try:
        return member.final_target if member.is_alias else member
    except griffe.AliasResolutionError:
        return None


def text_of(target):
    """A blank line between blocks of the docstring, or nothing."""
    return markdown(target.docstring.value) if target.docstring else []


def signature(function, name):
    parts = []
    kinds = griffe.ParameterKind
    keyword_only = False
    for parameter in function.parameters:
        if parameter.name in ("self", "cls"):
            continue
        if parameter.kind is kinds.keyword_only and not keyword_only:
            if not any(part.startswith("*") for part in parts):
                parts.append("*")
            keyword_only = True
        prefix = {kinds.var_positional: "*", kinds.var_keyword: "**"}.get(parameter.kind, "")
        text = prefix + parameter.name
        if parameter.annotation is not None:
            text += f": {parameter.annotation}"
        if parameter.default is not None and not prefix:
            text += f" = {parameter.default}"
        parts.append(text)
    returns = f" -> {function.returns}" if getattr(function, "returns", None) is not None else ""
    return f"{name}({', '.join(parts)}){returns}".replace("\n", " ")


def directive(kind, head, body, depth=0, options=()):
    fence = "`" * (7 - depth)
    return [f"{fence}{{py:{kind}}} {head}", *options, "", *body, fence, ""]


def entry(name, member, depth=0):
    """The lines of a class, function or value."""
    target = resolved(member)
    if target is None:
        return []
    body = text_of(target)
    if target.is_function:
        return directive("function" if depth == 0 else "method", signature(target, name), body, depth)
    if target.is_class:
        # Members of private bases count as the class's own; those of public bases stand there.
        for child_name, child in sorted(target.all_members.items(), key=lambda item: item[0]):
            if not child_name.startswith("_"):
                body += entry(child_name, child, depth + 1)
        constructor = target.all_members.get("__init__")
        head = signature(resolved(constructor) or target, name) if constructor else name
        return directive("class", head, body, depth)
    if target.is_attribute:
        if depth > 0 and target.docstring is None and target.value is not None and target.annotation is None:
            return []  # an alias or a default; the class's signature has the latter
        options = [] if target.annotation is None else [f":type: {target.annotation}".replace("\n", " ")]
        kind = "data" if depth == 0 else ("property" if "property" in target.labels else "attribute")
        return directive(kind, name, body, depth, options)
    return []


def page(module, documented):
    """A module's page; what another module's page has already is a link to it."""
    lines = [f"# {module.path}", "", *text_of(module), f"```{{py:module}} {module.path}", "```", ""]
    for name, member in members(module):
        target = resolved(member)
        if target is None or target.is_module:
            continue
        if target.path in documented:
            lines += [f"{{py:obj}}`{name} <{documented[target.path]}>`", ""]
        else:
            documented[target.path] = f"{module.path}.{name}"
            lines += entry(name, member)
    return "\n".join(lines) + "\n"


def write(package_folder, output):
    """Pages of all modules, and OUTPUT/python.md that lists them."""
    package = griffe.load("manyworlds", search_paths=[package_folder], allow_inspection=False,
                          resolve_aliases=True, resolve_external=False)
    lines = ["# Python reference", "", "The text of each entry is what `help()` shows.", "",
             "| module | subject |", "|---|---|"]
    names, documented = [], {}
    (output / "python").mkdir(parents=True, exist_ok=True)
    for path in MODULES:
        module = package if path == "manyworlds" else package[path.removeprefix("manyworlds.")]
        (output / f"python/{path}.md").write_text(page(module, documented), encoding="utf-8")
        summary = module.docstring.value.strip().splitlines()[0] if module.docstring else ""
        lines.append(f"| [`{path}`](python/{path}.md) | {summary} |")
        names.append(f"python/{path}")
    lines += ["", "```{toctree}", ":hidden:", "", *names, "```", ""]
    (output / "python.md").write_text("\n".join(lines), encoding="utf-8")
