"""What the docstrings need on their way to Sphinx: symbols as they are written, annotations as the source has them.

The docstrings are written to be read in an editor: h*_1, |θ| and m* stand there as in the paper, which reST would take
for markup. Names in single backticks become links where there is something to link to.
"""

import ast
import inspect
import re
import textwrap
from importlib import import_module
from typing import Any

from docutils import nodes
from pydantic import BaseModel
from sphinx.application import Sphinx
from sphinx.util.nodes import make_refnode

from rockflex.structure.file import expected

PLACES = (
    "rockflex",
    "rockflex.study.plan",
    "rockflex.papers.silva_stojadinovic_2024.population",
)  # packages whose names the reference has
SPANS = re.compile(r"(``.*?``|`[^`]*`|\*[A-Z][A-Za-z ]+\*)", re.DOTALL)  # literals, links, titles of books
PRIVATE = re.compile(r"rockflex\..*\._|rockflex\._")
COLON = "\x00"
MARKUP = re.compile(r"([*|]|(?<=\w)_(?!\w))")


def escape(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Escape what is not meant as markup, and say what a study's keys are."""
    del app, name, options
    if what == "property" and lines:
        lines[0] = lines[0].replace(": ", COLON)  # or napoleon takes what stands before it for a type
    if isinstance(obj, type) and issubclass(obj, BaseModel):
        lines += ["", "Parameters", "----------"]
        for key, field in obj.model_fields.items():
            default = (
                "" if field.is_required() else f"; ``{field.get_default(call_default_factory=True)!r}`` by default"
            )
            lines += [key, f"    {expected(field)}{default}"]
    # Literals may run over the end of a line, so that the text is split as a whole.
    parts = SPANS.split("\n".join(lines))
    parts = [f"`{part}`" if part.startswith("`.") else part for part in parts]  # an attribute of what was just named
    parts[::2] = [MARKUP.sub(r"\\\1", part) for part in parts[::2]]
    lines[:] = "".join(parts).split("\n")


def restore(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Put the colons back."""
    del app, what, name, obj, options
    lines[:] = [line.replace(COLON, ": ") for line in lines]


def signature(
    app: Sphinx, what: str, name: str, obj: Any, options: object, given: str | None, returned: str | None
) -> tuple[str | None, str | None] | None:
    """Signature with the annotations of the source, short names instead of numpy's unfolded unions."""
    del app, name, options
    if what not in ("function", "method", "class"):
        return None
    if what == "class":
        return (_fields(obj) or _short(given), None)
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(obj))).body[0]
    except (OSError, TypeError, SyntaxError):
        return given, returned
    if not isinstance(tree, ast.FunctionDef):
        return given, returned
    arguments = tree.args
    if what == "method":
        for kind in (arguments.posonlyargs, arguments.args):
            kind[:] = [each for each in kind if each.arg not in ("self", "cls")]
    for each in ast.walk(arguments):
        if isinstance(each, ast.arg) and each.annotation is not None:
            each.annotation = _unquoted(each.annotation)
    result = None if tree.returns is None else ast.unparse(_unquoted(tree.returns))
    return f"({ast.unparse(arguments)})", result


def _unquoted(node: ast.expr) -> ast.expr:
    """An annotation without the quotes that defer it; those of Literal stay."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return ast.parse(node.value, mode="eval").body
    return node


def _fields(obj: Any) -> str | None:
    """Signature of a dataclass, its annotations from the source."""
    if "__dataclass_fields__" not in vars(obj) or any(
        isinstance(node, ast.FunctionDef) and node.name == "__init__" for node in _body(obj)
    ):
        return None
    notes = {
        node.target.id: ast.unparse(_unquoted(node.annotation))
        for base in reversed(obj.__mro__)
        for node in _body(base)
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    }
    parameters, starred = [], False
    for name, parameter in inspect.signature(obj).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY and not starred:
            parameters.append("*")
            starred = True
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        parameters.append(f"{name}: {notes.get(name, 'Any')}{default}")
    return f"({', '.join(parameters)})"


def _body(obj: type) -> list[ast.stmt]:
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(obj))).body[0]
    except (OSError, TypeError, SyntaxError):
        return []
    return tree.body if isinstance(tree, ast.ClassDef) else []


def _short(given: str | None) -> str | None:
    return "()" if given is None or len(given) > 300 else given


def link(app: Sphinx, env: Any, node: Any, content: nodes.Node) -> nodes.Node | None:
    """Find a public name by its last part; leave other names in backticks, and types of elsewhere, as text."""
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
    """Connect them; the escapes come before napoleon, what they hid from it is restored after it."""
    app.connect("autodoc-process-docstring", escape, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
    app.connect("autodoc-process-signature", signature)
    app.connect("missing-reference", link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
