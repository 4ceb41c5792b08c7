"""Docstrings for Sphinx: symbols are escaped, and names become links.

The docstrings are written to be read in an editor: they contain h*_1, |θ| and m* as in the paper, which reST would take
for markup. Names in single backticks become links where there is a target.
"""

import re
from importlib import import_module
from typing import Any

from docutils import nodes
from pydantic import BaseModel
from signatures import parameter_types
from sphinx.application import Sphinx
from sphinx.util.nodes import make_refnode

from rockflex.structure.file._toml_table import valid_value_description

PLACES = (
    "rockflex",
    "rockflex.studies",
    "rockflex.papers.silva_stojadinovic_2024.population",
)  # packages whose names the reference has
SPANS = re.compile(r"(``.*?``|`[^`]*`|\*[A-Z][A-Za-z ]+\*)", re.DOTALL)  # literals, links, titles of books
PRIVATE = re.compile(r"rockflex\..*\._|rockflex\._")
EXAMPLE = re.compile(r"(^>>> .*(?:\n.+)*)", re.MULTILINE)  # code and its output, up to a blank line
COLON = "\x00"
MARKUP = re.compile(r"([*|]|(?<=\w)_(?!\w))")


def escape(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Escape characters that are not markup, and list the keys of a study."""
    del app, name, options
    if what == "property" and lines:
        lines[0] = lines[0].replace(": ", COLON)  # or napoleon takes the text before it for a type
    if isinstance(obj, type) and issubclass(obj, BaseModel):
        lines += ["", "Parameters", "----------"]
        for key, field in obj.model_fields.items():
            default = (
                "" if field.is_required() else f"; ``{field.get_default(call_default_factory=True)!r}`` by default"
            )
            lines += [key, f"    {valid_value_description(field)}{default}"]
    if what in ("function", "method", "class"):
        lines[:] = _with_types(lines, parameter_types(obj))
    pieces = EXAMPLE.split("\n".join(lines))
    pieces[::2] = [_escaped(piece) for piece in pieces[::2]]
    lines[:] = "".join(pieces).split("\n")


def _with_types(lines: list[str], types: dict[str, str]) -> list[str]:
    """Return the lines of a docstring, each entry of its parameters with its type, where it states none."""
    found, inside = list[str](), False
    for line, rule in zip(lines, [*lines[1:], ""], strict=True):
        if rule and not rule.strip("-"):
            inside = line in ("Parameters", "Attributes")
        names = line.split(", ")
        kinds = {types.get(name) for name in names}
        if inside and line.replace(", ", "").isidentifier() and len(kinds) == 1 and None not in kinds:
            line += f" : {kinds.pop()}"
        found.append(line)
    return found


def _escaped(text: str) -> str:
    """Return prose with its symbols escaped; literals may continue on the next line, so it is split as a whole."""
    parts = SPANS.split(text)
    parts = [f"`{part}`" if part.startswith("`.") else part for part in parts]  # an attribute of the object just named
    parts[::2] = [MARKUP.sub(r"\\\1", part) for part in parts[::2]]
    return "".join(parts)


def restore(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Put the colons back."""
    del app, what, name, obj, options
    lines[:] = [line.replace(COLON, ": ") for line in lines]


def link(app: Sphinx, env: Any, node: Any, content: nodes.Node) -> nodes.Node | None:
    """Find a public name by its last part; leave other names in backticks, and types from elsewhere, as text."""
    if node.get("refdomain") != "py" or node.get("reftype") not in ("obj", "class"):
        return None
    target = node.get("reftarget", "").removesuffix("()")
    if PRIVATE.match(target):
        target = target.rpartition(".")[2]
    head = target.split(".")[0]
    place = next((package for package in PLACES if head in import_module(package).__all__), None)
    if place is not None:
        found = env.domains.python_domain.find_obj(env, None, None, f"{place}.{target}", None, 0)
        if len(found) == 1:
            name, entry = found[0]
            return make_refnode(app.builder, node["refdoc"], entry.docname, entry.node_id, content, name)
    return None if target.startswith("rockflex.") else content


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the handlers; escaping runs before napoleon, and restoring after it."""
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
    app.connect("missing-reference", link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
